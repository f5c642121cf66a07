# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""FBX files, binary and text, as trees of nodes; arrays are read on request."""

from __future__ import annotations

import re
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..numerics import Array, NDArray
from .text_fields import BLOCK, Data

FBX_MAGIC = b"Kaydara FBX Binary  \0\x1a\0"
_ARRAYS = {b"d": "<f8", b"f": "<f4", b"l": "<i8", b"i": "<i4", b"b": "i1", b"c": "i1"}
_SCALARS = {b"Y": "<h", b"C": "<b", b"B": "<b", b"I": "<i", b"F": "<f", b"D": "<d", b"L": "<q"}
_MAX_DEPTH = 64
# a node of a text file, or the end of one
_TEXT_NODE = re.compile(
    rb"^[ \t]*(?:([A-Za-z_][\w|+-]*)[ \t]*:([^\n\"{}]*(?:\"[^\"]*\"[^\n\"{}]*)*)(\{)?|(\}))",
    re.MULTILINE,
)
_TEXT_VALUE = re.compile(rb'"([^"]*)"|([^,\s"]+)')


@dataclass
class FbxNode:
    """A node: its name, its values, and the nodes in it. source: of its array, None without one."""

    name: str
    values: list[Any] = field(default_factory=list)
    children: list[FbxNode] = field(default_factory=list)
    source: tuple[Data, int] | bytes | None = None

    def child(self, name: str) -> FbxNode:
        """Return the first node in it with a name, an empty one if there is none."""
        return next((node for node in self.children if node.name == name), FbxNode(""))

    def first(self, other: Any) -> Any:
        """Return its first value, or another one if it has none."""
        return self.values[0] if self.values else other

    def properties(self) -> dict[str, Any]:
        """Return the values of its properties."""
        return {line.values[0]: line.values[4:] for line in self.child("Properties70").children}

    def numbers(self) -> Array:
        """Return the numbers of its array, none if it has none."""
        if isinstance(self.source, bytes):
            return np.array(self.source.replace(b",", b" ").split(), np.float64)
        if self.source is None:
            return self.child("a").numbers() if self.children else np.empty(0)
        blocks = [block for _, block in fbx_array(*self.source)]
        return np.concatenate([np.empty(0), *blocks])


def fbx_array(data: Data, at: int) -> Iterator[tuple[int, NDArray]]:
    """Yield the numbers of a binary array in blocks, each after the count of numbers before it."""
    kind = np.dtype(_ARRAYS[data[at : at + 1]])
    count, packed, size = struct.unpack_from("<3I", data, at + 1)
    at += 13
    if not packed:
        yield 0, np.frombuffer(data, kind, count, at)
        return
    unpacker = zlib.decompressobj()
    rest = b""
    done = 0
    for begin in range(at, at + size, BLOCK):
        piece = data[begin : min(begin + BLOCK, at + size)]
        while piece and done < count:
            block = rest + unpacker.decompress(piece, BLOCK)
            piece = unpacker.unconsumed_tail
            whole = len(block) // kind.itemsize
            yield done, np.frombuffer(block, kind, whole)
            rest = block[whole * kind.itemsize :]
            done = done + whole


def fbx_tree(data: Data) -> FbxNode:
    """Return a file's root, a node without name. ValueError or struct.error if it is damaged."""
    root = FbxNode("")
    if data[: len(FBX_MAGIC)] != FBX_MAGIC:
        _read_text(data, root)
        return root
    (version,) = struct.unpack_from("<I", data, len(FBX_MAGIC))
    head = struct.Struct("<QQQB" if version >= 7500 else "<IIIB")
    _read_binary(data, len(FBX_MAGIC) + 4, len(data), head, root, 0)
    return root


def _read_binary(
    data: Data, at: int, stop: int, head: struct.Struct, parent: FbxNode, depth: int
) -> None:
    """Add the nodes of a part of a binary file to the node that they are in."""
    if depth > _MAX_DEPTH:
        raise ValueError("nodes")
    while at + head.size <= stop:
        end, count, _, length = head.unpack_from(data, at)
        if end == 0:
            return
        begin = at + head.size
        if not begin <= end <= stop:
            raise ValueError("nodes")
        node = FbxNode(data[begin : begin + length].decode("utf-8", "replace"))
        parent.children.append(node)
        at = begin + length
        for _ in range(count):
            at = _read_value(data, at, node)
        _read_binary(data, at, end, head, node, depth + 1)
        at = end


def _read_value(data: Data, at: int, node: FbxNode) -> int:
    """Add a value of a binary file to its node, and return where the next one begins."""
    kind = data[at : at + 1]
    if kind in _SCALARS:
        node.values += struct.unpack_from(_SCALARS[kind], data, at + 1)
        return at + 1 + struct.calcsize(_SCALARS[kind])
    if kind in _ARRAYS:
        node.source = data, at
        count, packed, size = struct.unpack_from("<3I", data, at + 1)
        return at + 13 + (size if packed else count * np.dtype(_ARRAYS[kind]).itemsize)
    if kind not in (b"S", b"R"):
        raise ValueError("value")
    (size,) = struct.unpack_from("<I", data, at + 1)
    text = data[at + 5 : at + 5 + size] if kind == b"S" else b""
    # The class stands behind the name, and in text files before it.
    node.values.append(text.partition(b"\0\1")[0].decode("utf-8", "replace"))
    return at + 5 + size


def _read_text(data: Data, root: FbxNode) -> None:
    """Add the nodes of a text file to its root."""
    open_nodes = [root]
    array = None  # The node whose numbers go on to the next node.
    start = 0
    for match in _TEXT_NODE.finditer(data):
        name, text, opens, closes = match.groups()
        if array is not None:
            array.source = bytes(data[start : match.start()])
            array = None
        if closes:
            if len(open_nodes) > 1:
                open_nodes.pop()
            continue
        node = FbxNode(name.decode())
        open_nodes[-1].children.append(node)
        if node.name == "a":
            array = node
            start = match.start(2)
        else:
            node.values = [_text_value(*value) for value in _TEXT_VALUE.findall(text)]
        if opens:
            open_nodes.append(node)
        if len(open_nodes) > _MAX_DEPTH:
            raise ValueError("nodes")


def _text_value(text: bytes, bare: bytes) -> Any:
    if not bare:
        return text.decode("utf-8", "replace").rpartition("::")[2].replace("&quot;", '"')
    try:
        return int(bare)
    except ValueError:
        pass
    try:
        return float(bare)
    except ValueError:
        return bare.decode("utf-8", "replace")
