# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the coordinates in a file are finite numbers, before Blender imports them.

Blender's importers of .stl, .obj, .ply, .glb, .gltf and .fbx put 0, or the vertex before, where a coordinate is NaN,
infinite, or too large for float32, and say nothing: a body that nobody made would be measured as exact. Files are
mapped and looked at in blocks. Numbers that place no point (normals, colors, weights) may be anything. A file that is
damaged otherwise is left to Blender, which says so.
"""

from __future__ import annotations

import base64
import json
import mmap
import os
import re
import struct
import zlib
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.verdict.finding import FileError, Finding, finding

MAX_FLOAT32 = 3.4028235677973366e38  # what is as large or larger is infinite in float32

_BLOCK = 1 << 18  # bytes of text at a time, and numbers, so that what is computed of them stays in the cache
_THREADS = min(4, os.cpu_count() or 1)
_REACH = 1 << 12  # bytes to either side in which a line is looked for
_OVERLAP = 64  # bytes that blocks of text share, so that none cuts what makes a number suspicious
_MALFORMED = (ValueError, KeyError, IndexError, TypeError, AttributeError, RecursionError, struct.error, zlib.error)

Data = mmap.mmap | bytes


def check_numbers(path: str, kind: str) -> None:
    """Raise FileError where a coordinate in the file is no finite number. kind: the file's suffix."""
    check = _CHECKS.get(kind)
    if check is None:
        return
    try:
        data = _mapped(path)
    except OSError as error:
        raise FileError("file_unreadable", error=error.strerror or str(error)) from error
    check(data, path)


def _mapped(path: str) -> mmap.mmap:
    """The bytes of a file that is not empty, until nothing refers to them any more."""
    with open(path, "rb") as file:
        return mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)


def _refuse(count: int, place: Finding) -> None:
    if count:
        raise FileError("non_finite_coordinates", count=count, place=place.as_record())


# Tables of numbers


def _bad_in_table(rows: NDArray) -> tuple[int, int]:
    """How many numbers of (n, k) are not finite in float32, and the first row that has one."""
    if rows.dtype.kind != "f":
        return 0, 0
    count, first = 0, 0
    step = max(1, _BLOCK // (8 * rows.shape[1]))
    with np.errstate(over="ignore", invalid="ignore"):
        for start in range(0, len(rows), step):
            block = np.ascontiguousarray(rows[start : start + step])
            # A block's smallest and largest are NaN where one of its numbers is.
            if block.max() < MAX_FLOAT32 and block.min() > -MAX_FLOAT32:
                continue
            bad = ~(np.abs(block) < MAX_FLOAT32)
            if not count:
                first = start + int(np.argmax(bad.any(axis=1)))
            count += int(np.count_nonzero(bad))
    return count, first


# Text


def _suspicious(data: Data, start: int = 0) -> Iterator[int]:
    """Places in a text, ascending, of what may be a number that is not finite: nan, inf, 1.#IND, and large exponents
    or many digits, of which there is little in a sound file.
    """
    view = np.frombuffer(data, np.uint8)
    with ThreadPoolExecutor(_THREADS) as threads:
        for places in threads.map(partial(_suspicious_in_block, view), range(start, len(view), _BLOCK)):
            yield from places


def _suspicious_in_block(view: NDArray[np.uint8], begin: int) -> list[int]:
    text = view[begin : begin + _BLOCK + _OVERLAP]
    if len(text) < _BLOCK + _OVERLAP:
        text = np.concatenate([text, np.zeros(_OVERLAP, np.uint8)])
    lower = text | np.uint8(0x20)
    places = np.unique(np.concatenate([_words(text, lower), _large(text, lower)]))
    # At _BLOCK too: the next block does not see what is before its first byte.
    return (begin + places[places <= _BLOCK]).tolist()


def _words(text: NDArray[np.uint8], lower: NDArray[np.uint8]) -> NDArray[np.intp]:
    """Where the n of nan or inf is, or the # of 1.#IND and its like."""
    at = 1 + np.flatnonzero(lower[1:-2] == ord("n"))
    after = lower[at + 1]
    nan, inf = at[after == ord("a")], at[after == ord("f")]
    nan, inf = nan[lower[nan + 2] == ord("n")], inf[lower[inf - 1] == ord("i")]
    at = 1 + np.flatnonzero(text[1:] == ord("#"))
    return np.concatenate([nan, inf, at[text[at - 1] == ord(".")]])


def _large(text: NDArray[np.uint8], lower: NDArray[np.uint8]) -> NDArray[np.intp]:
    """Where numbers of 1e38 and more may be: those with an exponent of at least 9, or with 31 digits in a row."""
    digit = (text - ord("0")) < 10  # uint8: what is below wraps around
    plus = text == ord("+")
    at = np.flatnonzero((lower[:-4] == ord("e")) & (digit | plus)[1:-3])
    after = at + 1 + plus[at + 1]
    one, two, three = (digit[after + shift] for shift in range(3))
    small = one & ~two | two & ~three & (text[after] == ord("0")) & (text[after + 1] != ord("9"))
    exponents = at[one & ~small]
    whole = np.flatnonzero(digit[: len(digit) // 8 * 8].view(np.uint64) == 0x0101010101010101)
    runs = whole[:-2][whole[2:] == whole[:-2] + 2]  # 31 digits hold three words of eight
    return np.concatenate([exponents, 8 * runs])


def _is_finite(word: bytes) -> bool:
    try:
        return abs(float(word)) < MAX_FLOAT32 and b"_" not in word
    except ValueError:
        return False


def _line(data: Data, start: int, place: int) -> tuple[int, int]:
    """Where the line begins and ends that holds a place, as far as it reaches. A backslash at its end continues it."""
    lowest, highest = max(start, place - _REACH), min(place + _REACH, len(data))
    begin = max(data.rfind(b"\n", lowest, place) + 1, lowest)
    while begin - 2 > lowest and data[begin - 2 : begin] == b"\\\n":
        begin = max(data.rfind(b"\n", lowest, begin - 1) + 1, lowest)
    end = place
    while end < highest:
        end = data.find(b"\n", end, highest) + 1 or highest
        if data[end - 2 : end] != b"\\\n":
            break
    return begin, end


def _bad_in_text(
    data: Data, coordinates: Callable[[bytes, int], Iterable[bytes]], start: int = 0
) -> tuple[int, int | None]:
    """How many coordinates in a text's lines are not finite, and where the first of their lines begins.

    coordinates: of a line that begins there, the words of its coordinates.
    """
    count, first, done = 0, None, 0
    for place in _suspicious(data, start):
        if place < done:
            continue
        begin, done = _line(data, start, place)
        line = data[begin:done].replace(b"\\\n", b" ")
        bad = sum(not _is_finite(word) for word in coordinates(line, begin))
        if bad and not count:
            first = begin
        count += bad
    return count, first


def _count(data: Data, what: re.Pattern[bytes], end: int) -> int:
    return sum(1 for _ in what.finditer(data, 0, end))


# The formats


def _check_stl(data: Data, _path: str) -> None:
    if len(data) >= 84 and len(data) == 84 + 50 * struct.unpack_from("<I", data, 80)[0]:
        facets = np.frombuffer(
            data, np.dtype({"names": ["at"], "formats": ["9<f4"], "offsets": [12], "itemsize": 50}), -1, 84
        )
        count, first = _bad_in_table(facets["at"])
        _refuse(count, finding("at_triangle", triangle=first))
        return
    vertices = re.compile(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)
    count, first = _bad_in_text(data, lambda line, _: (word for words in vertices.findall(line) for word in words))
    if first is not None:
        before = _count(data, vertices, first)
        _refuse(count, finding("at_triangle", triangle=before // 3))


def _check_obj(data: Data, _path: str) -> None:
    def coordinates(line: bytes, _begin: int) -> list[bytes]:
        words = line.split()
        return words[1:4] if words[:1] == [b"v"] else []

    count, first = _bad_in_text(data, coordinates)
    if first is not None:
        before = _count(data, re.compile(rb"^[ \t]*v[ \t]", re.MULTILINE), first)
        _refuse(count, finding("at_vertex", vertex=before))


_PLY_TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
_MAX_PLY_HEADER = 1 << 20


def _check_ply(data: Data, _path: str) -> None:
    # Properties of an element: (name, type), or (name, type of the count, type) of a list.
    elements: list[tuple[str, int, list[tuple[str, ...]]]] = []
    order = ""
    header = re.search(rb"^end_header[ \t]*\r?\n", data[:_MAX_PLY_HEADER], re.MULTILINE)
    if header is None:
        return
    with suppress(*_MALFORMED):
        for line in data[: header.start()].decode("latin-1").splitlines():
            words = line.split()
            if words[:1] == ["format"]:
                order = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}[words[1]]
            elif words[:1] == ["element"]:
                elements.append((words[1], int(words[2]), []))
            elif words[:2] == ["property", "list"]:
                elements[-1][2].append((words[4], _PLY_TYPES[words[2]], _PLY_TYPES[words[3]]))
            elif words[:1] == ["property"]:
                elements[-1][2].append((words[2], _PLY_TYPES[words[1]]))
        check = _check_binary_ply if order else _check_ascii_ply
        count, first = check(data, header.end(), elements, order)
        _refuse(count, finding("at_vertex", vertex=first))


def _check_ascii_ply(data: Data, start: int, elements: list, _order: str) -> tuple[int, int]:
    names = [name for name, _, _ in elements]
    if "vertex" not in names:
        return 0, 0
    number = names.index("vertex")
    _, rows, properties = elements[number]
    line_before = sum(rows for _, rows, _ in elements[:number])
    columns = [[one[0] for one in properties].index(axis) for axis in "xyz"]
    here, line_number = start, 0

    def coordinates(line: bytes, begin: int) -> list[bytes]:
        nonlocal here, line_number
        line_number += _byte_count(data, b"\n", here, begin)
        here = begin
        words = line.split() if 0 <= line_number - line_before < rows else []
        return [words[column] for column in columns if column < len(words)]

    count, first = _bad_in_text(data, coordinates, start)
    return count, 0 if first is None else _byte_count(data, b"\n", start, first) - line_before


def _byte_count(data: Data, byte: bytes, begin: int, end: int) -> int:
    view = np.frombuffer(data, np.uint8, end - begin, begin)
    return sum(int(np.count_nonzero(view[i : i + _BLOCK] == byte[0])) for i in range(0, len(view), _BLOCK))


def _check_binary_ply(data: Data, start: int, elements: list, order: str) -> tuple[int, int]:
    for name, rows, properties in elements:
        if any(len(one) == 3 for one in properties):
            ragged = _ragged_rows(data, start, rows, properties, order)
            if name == "vertex":
                return _bad_in_table(np.array([[row[axis] for axis in "xyz"] for row, _ in ragged]))
            start = max((end for _, end in ragged), default=start)
            continue
        row = np.dtype([(one[0], order + one[1]) for one in properties])
        if name == "vertex":
            rows = min(rows, (len(data) - start) // row.itemsize)
            table = np.frombuffer(data, row, rows, start)
            found = [_bad_in_table(table[axis][:, None]) for axis in "xyz"]
            return sum(count for count, _ in found), min((first for count, first in found if count), default=0)
        start += rows * row.itemsize
    return 0, 0


def _ragged_rows(data: Data, start: int, rows: int, properties: list, order: str) -> Iterator[tuple[dict, int]]:
    """The numbers of rows that hold lists, and where each ends. Lists themselves are passed over."""
    kinds = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "f4": "f", "f8": "d"}
    columns = [(one[0], struct.Struct(order + kinds[one[1]]), int(one[-1][1]) if one[2:] else 0) for one in properties]
    for _ in range(rows):
        row = {}
        for name, column, size in columns:
            (row[name],) = column.unpack_from(data, start)
            start += column.size + (size * row[name] if size else 0)
        yield row, start


_GLTF_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_GLTF_FLOAT = 5126
_OF_NODES = ("matrix", "translation", "rotation", "scale")


def _check_gltf(data: Data, path: str) -> None:
    with suppress(*_MALFORMED):
        buffers = Buffers(data, path)
        document = buffers.document
        nodes = document.get("nodes", [])
        for number, node in enumerate(nodes):
            numbers = [one for key in _OF_NODES for one in node.get(key, ())]
            _refuse(_bad_numbers(numbers), finding("at_node", node=node.get("name") or str(number)))
        for number, mesh in _placing_accessors(document).items():
            accessor = document["accessors"][number]
            count, first = _bad_in_accessor(buffers, accessor)
            if mesh is None:
                place = finding("at_accessor", accessor=number, element=first)
            else:
                place = finding("at_mesh_vertex", mesh=mesh, vertex=first)
            _refuse(count + _bad_numbers([*accessor.get("min", ()), *accessor.get("max", ())]), place)


def _bad_numbers(numbers: Iterable[float]) -> int:
    return sum(not abs(number) < MAX_FLOAT32 for number in numbers)


def _placing_accessors(document: dict[str, Any]) -> dict[int, str | None]:
    """The accessors whose numbers place points, each with the mesh whose vertices they are."""
    found: dict[int, str | None] = {}
    for number, mesh in enumerate(document.get("meshes", [])):
        for primitive in mesh["primitives"]:
            for attributes in (primitive["attributes"], *primitive.get("targets", ())):
                if "POSITION" in attributes:
                    found[attributes["POSITION"]] = mesh.get("name") or str(number)
    others = [skin.get("inverseBindMatrices") for skin in document.get("skins", [])]
    for animation in document.get("animations", []):
        others += [sampler[key] for sampler in animation["samplers"] for key in ("input", "output")]
    for node in document.get("nodes", []):
        others += node.get("extensions", {}).get("EXT_mesh_gpu_instancing", {}).get("attributes", {}).values()
    return found | {number: None for number in others if number is not None and number not in found}


def _bad_in_accessor(buffers: Buffers, accessor: dict[str, Any]) -> tuple[int, int]:
    if accessor["componentType"] != _GLTF_FLOAT:
        return 0, 0
    sparse = accessor.get("sparse")
    found = (
        [(accessor["bufferView"], accessor.get("byteOffset", 0), accessor["count"])] if "bufferView" in accessor else []
    )
    if sparse:
        found.append((sparse["values"]["bufferView"], sparse["values"].get("byteOffset", 0), sparse["count"]))
    width = _GLTF_WIDTHS[accessor["type"]]
    bad = [_bad_in_table(table) for table in (buffers.table(*one, width) for one in found) if table is not None]
    return sum(count for count, _ in bad), min((first for count, first in bad if count), default=0)


def unquote(uri: str) -> str:
    """Replace %20 and the like in a glTF's reference by the characters that they stand for."""
    data = re.sub(rb"%([0-9a-fA-F]{2})", lambda match: bytes.fromhex(match[1].decode()), uri.encode())
    return data.decode("utf-8", "surrogateescape")


class Buffers:
    """The document of a glTF file, and its buffers, those in other files too."""

    def __init__(self, data: Data, path: str) -> None:
        self.folder = os.path.dirname(path)
        self.binary: tuple[Data, int] | None = None
        self.opened: dict[int, tuple[Data, int]] = {}
        text = data
        if data[:4] == b"glTF":  # chunks of the text and of the first buffer, each behind its length and type
            end = 20 + struct.unpack_from("<I", data, 12)[0]
            text = data[20:end]
            self.binary = (data, end + 8)
        self.document = json.loads(text[:])

    def table(self, view_number: int, offset: int, count: int, width: int) -> NDArray[np.float32] | None:
        """Rows of numbers; None where only an extension knows how to unpack them."""
        view = self.document["bufferViews"][view_number]
        if "EXT_meshopt_compression" in view.get("extensions", {}):
            return None
        data, start = self._buffer(view["buffer"])
        start += view.get("byteOffset", 0) + offset
        return np.ndarray((count, width), "<f4", data, start, (view.get("byteStride", 4 * width), 4))

    def _buffer(self, number: int) -> tuple[Data, int]:
        """A buffer's bytes, and where in them it begins. Raises FileError where it is missing or too short."""
        if number not in self.opened:
            buffer = self.document["buffers"][number]
            self.opened[number] = self._open(buffer, buffer["byteLength"])
        return self.opened[number]

    def _open(self, buffer: dict[str, Any], size: int) -> tuple[Data, int]:
        uri = buffer.get("uri")
        if uri is None:
            name = "BIN"
            if self.binary is None:
                raise FileError("gltf_buffer_missing", buffer=name)
            data, start = self.binary
        elif uri.startswith("data:"):
            name, data, start = "data:", base64.b64decode(uri.partition(",")[2]), 0
        else:
            name = unquote(uri)
            try:
                data, start = _mapped(os.path.join(self.folder, name)), 0
            except (OSError, ValueError) as error:  # ValueError: it is empty
                raise FileError("gltf_buffer_missing", buffer=name) from error
        if len(data) - start < size:
            raise FileError("gltf_buffer_short", buffer=name, size=len(data) - start, expected=size)
        return data, start


_FBX_MAGIC = b"Kaydara FBX Binary  \0\x1a\0"
_FBX_TYPES = {b"d": np.dtype("<f8"), b"f": np.dtype("<f4")}


@dataclass(frozen=True)
class FbxNode:
    """A node of a binary FBX file: where its properties begin, its children, and what follows it."""

    name: bytes
    properties: int
    children: int
    end: int


def _check_fbx(data: Data, _path: str) -> None:
    """The vertices of meshes and of their shapes."""
    if data[:23] != _FBX_MAGIC:
        _check_ascii_fbx(data)
        return
    with suppress(*_MALFORMED):
        wide = struct.unpack_from("<I", data, 23)[0] >= 7500
        file = FbxNode(b"", 27, 27, len(data))
        for objects in _fbx_children(data, file, wide, b"Objects"):
            for geometry in _fbx_children(data, objects, wide, b"Geometry"):
                for vertices in _fbx_children(data, geometry, wide, b"Vertices"):
                    count, first = 0, 0
                    for begin, numbers in _fbx_array(data, vertices.properties):
                        more, row = _bad_in_table(numbers[:, None])
                        first = first if count else (begin + row) // 3
                        count += more
                    _refuse(count, finding("at_vertex", vertex=first))


_FBX_ARRAY = re.compile(rb"\bVertices\s*:(?:\s*\*\d+\s*\{\s*a:)?$")
_FBX_NUMBER = re.compile(rb"[^\s,:{}]+")


def _check_ascii_fbx(data: Data) -> None:
    count, first, before, done = 0, 0, 0, 0
    begin, of_vertices = 0, False  # of the last array that was met
    for place in _suspicious(data):
        if place < done:
            continue
        colon = data.rfind(b":", before, place)
        if colon >= 0:
            begin, before = colon + 1, colon
            of_vertices = _FBX_ARRAY.search(data[max(0, colon - 100) : begin]) is not None
        window = max(begin, place - _OVERLAP)
        words = _FBX_NUMBER.finditer(data[window : place + _OVERLAP])
        word = next((word for word in words if window + word.end() > place), None)
        done = place + 1 if word is None else window + word.end()
        if of_vertices and word is not None and not _is_finite(word[0]):
            first = first if count else _byte_count(data, b",", begin, place) // 3
            count += 1
    _refuse(count, finding("at_vertex", vertex=first))


def _fbx_children(data: Data, parent: FbxNode, wide: bool, name: bytes) -> Iterator[FbxNode]:
    """Those of one name."""
    head = struct.Struct("<QQQB" if wide else "<IIIB")
    at = parent.children
    while at + head.size <= parent.end:
        end, _, length, name_length = head.unpack_from(data, at)
        begin = at + head.size + name_length
        if end <= at:  # nothing follows
            return
        if data[at + head.size : begin] == name:
            yield FbxNode(name, begin, begin + length, end)
        at = end


def _fbx_array(data: Data, at: int) -> Iterator[tuple[int, NDArray]]:
    """The numbers of an array in blocks, each with how many were before it."""
    kind = _FBX_TYPES[data[at : at + 1]]
    count, packed, size = struct.unpack_from("<3I", data, at + 1)
    at += 13
    if not packed:
        yield 0, np.frombuffer(data, kind, count, at)
        return
    unpacker, rest, done = zlib.decompressobj(), b"", 0
    for begin in range(at, at + size, _BLOCK):
        piece = data[begin : min(begin + _BLOCK, at + size)]
        while piece and done < count:
            block = rest + unpacker.decompress(piece, _BLOCK)
            piece = unpacker.unconsumed_tail
            whole = len(block) // kind.itemsize
            yield done, np.frombuffer(block, kind, whole)
            rest, done = block[whole * kind.itemsize :], done + whole


_CHECKS: dict[str, Callable[[Data, str], None]] = {
    ".stl": _check_stl,
    ".obj": _check_obj,
    ".ply": _check_ply,
    **dict.fromkeys((".glb", ".gltf"), _check_gltf),
    ".fbx": _check_fbx,
}
