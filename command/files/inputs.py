# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that a measured file refers to: --resume measures the file again if one of these has changed."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from pathlib import Path

from ...blender.settings.limits import scan_limits
from ...core.scans.nrrd import data_file, read_header
from ...core.streams.misread import map_file
from ...core.verdict.finding import MeasureError
from .finite import Buffers, unquote
from .finite.numbers import MALFORMED

# Errors about a file with an impossible name, unreadable or damaged, which counts as without references.
_UNREADABLE = (OSError, RuntimeError, MeasureError, *MALFORMED)
_ASSET = re.compile(rb"@@@(.+?)@@@|@([^@\n]+)@")


def references(path: str, opened: Iterable[str] = ()) -> set[Path]:
    """Return the files, existing or not, that a file refers to directly or indirectly.

    opened: the files that Blender has read with it. Layers in binary USD layers are not found, nor are missing tiles.
    """
    waiting, known = [Path(path), *map(Path, opened)], set()
    while waiting:
        file = waiting.pop()
        with suppress(*_UNREADABLE):
            file = Path(os.path.realpath(file))
            if file not in known:
                known.add(file)
                names = _NAMES.get(file.suffix.lower())
                waiting += [file.parent / name for name in names(file)] if names else []
    return known - {Path(os.path.realpath(path))}


def _of_nrrd(path: Path) -> Iterator[str]:
    fields, _ = read_header(path, scan_limits())
    yield data_file(fields) or path.name


def _of_gltf(path: Path) -> Iterator[str]:
    uris = [buffer.get("uri") for buffer in Buffers(map_file(str(path)), str(path)).document.get("buffers", ())]
    yield from (unquote(uri) for uri in uris if uri and not uri.startswith("data:"))


def _of_usd(path: Path) -> Iterator[str]:
    for long, short in _ASSET.findall(path.read_bytes()):
        yield (long or short).decode("utf-8", "surrogateescape")


_NAMES: dict[str, Callable[[Path], Iterator[str]]] = {
    **dict.fromkeys((".nrrd", ".nhdr"), _of_nrrd),
    **dict.fromkeys((".gltf", ".glb"), _of_gltf),
    **dict.fromkeys((".usd", ".usda"), _of_usd),
}
