# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files read together with the named ones; no result may replace one of them.

They are the samples of a detached NRRD, buffers and textures of a glTF, the libraries of a .blend, and layers of USD.
"""

from __future__ import annotations

import json
import re
import struct
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from pathlib import Path

import bpy

from ...core.scans.limits import Limits
from ...core.scans.nrrd import data_file, read_header
from ...core.verdict.finding import MeasureError
from .files import STREAMED, file_suffix, open_file
from .finite import unquote

_CRATE = b"PXR-USDC"  # start of a binary USD layer


def files_read(paths: Iterable[str]) -> Iterator[Path]:
    """Yield the existing files that the named files, or else the open scene, refer to directly or indirectly.

    Opens the named files in Blender. Unreadable files refer to nothing.
    """
    paths = list(paths)
    waiting = [Path(path) for path in paths] or _open_files()
    for path in paths:
        if file_suffix(path) in STREAMED:
            continue  # it refers to nothing, and may be larger than memory
        with suppress(MeasureError, RuntimeError):
            open_file(path)
            waiting += _open_files()
    return (path for path in _reached(waiting, _NAMES) if _holds(path.is_file))


def references(path: str, is_open: bool) -> Iterator[Path]:
    """Yield the files, existing or not, that a file refers to and that may change its measurements.

    is_open: whether the file is the open scene.
    """
    first = Path(path)
    waiting = [first, *(_open_files(packed=False) if is_open else ())]
    with suppress(OSError, ValueError, RuntimeError):
        first = first.resolve()
    found = (one for one in _reached(waiting, _NAMES_THAT_COUNT) if one != first)
    return (one for one in found if "." in one.name or _holds(one.exists))  # most words of USD name no file


def _holds(question: Callable[[], bool]) -> bool:
    """Return whether the question is true; no if no file can have such a path."""
    with suppress(OSError, ValueError):
        return question()
    return False


def _reached(waiting: list[Path], readers: dict[str, Callable[[Path], Iterator[str]]]) -> Iterator[Path]:
    """Yield these files and the files that they refer to, directly or indirectly, each once, existing or not."""
    known: set[Path] = set()
    while waiting:
        with suppress(OSError, ValueError, RuntimeError):  # too long, with a zero byte, links in a circle
            path = waiting.pop().resolve()
            if path in known:
                continue
            known.add(path)
            yield path
            with suppress(struct.error, RecursionError, MeasureError):
                waiting += _named_in(path, readers)


def _open_files(packed: bool = True) -> list[Path]:
    """Return the files that the open scene refers to. packed: include files with a copy packed into the scene."""
    paths = bpy.utils.blend_paths(absolute=True, packed=packed)
    return [file for path in paths for file in _tiles(Path(path))]


def _named_in(path: Path, readers: dict[str, Callable[[Path], Iterator[str]]]) -> list[Path]:
    names = readers.get(path.suffix.lower()) if path.is_file() else None
    return [] if names is None else [file for name in names(path) for file in _tiles(path.parent / name)]


def _tiles(path: Path) -> Iterable[Path]:
    """Return the file, or all tiles of an image that is cut into them."""
    if "<UDIM>" not in path.name:
        return [path]
    tile = re.compile(re.escape(path.name).replace(re.escape("<UDIM>"), r"\d+"))
    return [one for one in path.parent.iterdir() if tile.fullmatch(one.name)] if _holds(path.parent.is_dir) else []


def _of_nrrd(path: Path) -> Iterator[str]:
    fields, _ = read_header(path, Limits(header_bytes=sys.maxsize))
    yield data_file(fields) or path.name


def _of_gltf(path: Path) -> Iterator[str]:
    with open(path, "rb") as file:
        data = file.read(20)
        if data.startswith(b"glTF"):  # a .glb: its first chunk is the text
            (length,) = struct.unpack_from("<I", data, 12)
            data = file.read(length)
        else:
            data += file.read()
    document = json.loads(data)
    for group in ("buffers", "images"):
        listed = document.get(group) if isinstance(document, dict) else None
        for one in listed if isinstance(listed, list) else ():
            uri = one.get("uri") if isinstance(one, dict) else None
            if isinstance(uri, str) and not uri.startswith("data:"):
                yield unquote(uri)


def _of_obj(path: Path) -> Iterator[str]:
    """Yield the names on each line: one name, which may hold spaces, or several."""
    with open(path, "rb") as file:
        found = [line.strip() for line in file if line.lstrip().startswith(b"mtllib")]
    for words in found:
        line = words.decode("utf-8", "surrogateescape")
        yield line.removeprefix("mtllib").strip()
        yield from line.split()[1:]


def _of_usd(path: Path) -> Iterator[str]:
    """All texts that may be the name of a file."""
    data = path.read_bytes()
    if data.startswith(_CRATE):
        texts = _tokens(data).split(b"\0")
    else:
        texts = [long or short for long, short in re.findall(rb"@@@(.+?)@@@|@([^@\n]+)@", data)]
    for text in texts:
        if text:
            yield text.decode("utf-8", "surrogateescape")


def _tokens(data: bytes) -> bytes:
    """Return the words of a binary USD layer, each with a zero byte behind it. Raises ValueError and struct.error."""
    (contents,) = struct.unpack_from("<q", data, 16)
    (count,) = struct.unpack_from("<Q", data, contents)
    for number in range(min(count, 64)):
        name, start, _ = struct.unpack_from("<16sqq", data, contents + 8 + 32 * number)
        if name.rstrip(b"\0") == b"TOKENS":
            (packed,) = struct.unpack_from("<Q", data, start + 16)
            return _unpacked(data[start + 24 : start + 24 + packed])
    raise ValueError("The layer has no words.")


def _unpacked(packed: bytes) -> bytes:
    """Unpack the LZ4 blocks of USD: their number, and if it is not 0, each block with its size before it."""
    if not packed[0]:
        return _lz4(packed[1:])
    blocks, at = [], 1
    for _ in range(packed[0]):
        (length,) = struct.unpack_from("<i", packed, at)
        blocks.append(_lz4(packed[at + 4 : at + 4 + length]))
        at += 4 + length
    return b"".join(blocks)


def _lz4(block: bytes) -> bytes:
    """Unpack an LZ4 block (https://github.com/lz4/lz4/blob/dev/doc/lz4_Block_format.md)."""
    text = bytearray()
    at = 0

    def length(short: int) -> int:
        nonlocal at
        total = short
        while short == 15 or short == 255:
            short = block[at]
            total += short
            at += 1
        return total

    try:
        while True:  # the last of its sequences has no match
            token = block[at]
            at += 1
            count = length(token >> 4)
            text += block[at : at + count]
            at += count
            if at >= len(block):
                break
            back = block[at] | block[at + 1] << 8
            at += 2
            count = length(token & 15) + 4
            start = len(text) - back
            if not 0 < back <= len(text):
                raise ValueError("The layer is damaged.")
            text += (text[start : start + count] * (count // back + 1))[:count]
    except IndexError:
        raise ValueError("The layer is cut short.") from None
    return bytes(text)


_NAMES: dict[str, Callable[[Path], Iterator[str]]] = {
    **dict.fromkeys((".nrrd", ".nhdr"), _of_nrrd),
    **dict.fromkeys((".gltf", ".glb"), _of_gltf),
    ".obj": _of_obj,
    **dict.fromkeys((".usd", ".usda", ".usdc"), _of_usd),
}
_NAMES_THAT_COUNT = {suffix: names for suffix, names in _NAMES.items() if suffix != ".obj"}  # colors alone
