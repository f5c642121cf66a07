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
_MAX_DEPTH = 64  # Chosen: more than files need, and far fewer than the calls that Python nests.
_ARRAY_HEAD = 13  # bytes before an array's numbers: its type, and three whole numbers of four bytes
# a node of a text file, or the end of one
_TEXT_NODE = re.compile(
    rb"^[ \t]*(?:([A-Za-z_][\w|+-]*)[ \t]*:([^\n\"{}]*(?:\"[^\"]*\"[^\n\"{}]*)*)(\{)?|(\}))",
    re.MULTILINE,
)
_TEXT_VALUE = re.compile(rb'"([^"]*)"|([^,\s"]+)')


@dataclass
class FbxNode:
    """A node: its name, its values, and the nodes in it.

    source: of its array, the data and the offset of its type in them, or the text of its numbers;
    None without an array.
    """

    name: str
    values: list[Any] = field(default_factory=list)
    children: list[FbxNode] = field(default_factory=list)
    source: tuple[Data, int] | bytes | None = None

    def child(self, name: str) -> FbxNode:
        """Return the first node in it with a name, an empty one if there is none."""
        return next((node for node in self.children if node.name == name), FbxNode(""))

    def first(self, other: Any) -> Any:
        """Return its first value, or `other` if it has none."""
        return self.values[0] if self.values else other

    def properties(self) -> dict[str, Any]:
        """Return the values of its properties by their names, without type, label and flags."""
        return {line.values[0]: line.values[4:] for line in self.child("Properties70").children}

    def numbers(self) -> Array:
        """Return the (n,) numbers of its array, n = 0 if it has none."""
        if isinstance(self.source, bytes):
            return np.array(self.source.replace(b",", b" ").split(), np.float64)
        if self.source is None:  # In a text, the array is in a node “a” inside.
            return self.child("a").numbers() if self.children else np.empty(0)
        blocks = [block for _, block in fbx_array(*self.source)]
        return np.concatenate([np.empty(0), *blocks])


def fbx_array(data: Data, at: int) -> Iterator[tuple[int, NDArray]]:
    """Yield the numbers of a binary array in (n,) blocks, each after the count of numbers before
    it. at: the offset of the array's type.
    """
    kind = np.dtype(_ARRAYS[data[at : at + 1]])
    count, is_packed, size = struct.unpack_from("<3I", data, at + 1)  # size: in packed bytes
    start = at + _ARRAY_HEAD
    if not is_packed:
        yield 0, np.frombuffer(data, kind, count, start)
        return
    unpacker = zlib.decompressobj()
    rest = b""  # the beginning of a number that a block cuts
    done = 0
    for begin in range(start, start + size, BLOCK):
        piece = data[begin : min(begin + BLOCK, start + size)]
        while piece and done < count:
            block = rest + unpacker.decompress(piece, BLOCK)
            piece = unpacker.unconsumed_tail
            whole = len(block) // kind.itemsize
            yield done, np.frombuffer(block, kind, whole)
            rest = block[whole * kind.itemsize :]
            done += whole


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
    """Add the nodes of a part of a binary file, from `at` to `stop`, to the node that they are in.

    head: the form of a node's first bytes: where it ends, the count and the size of its values, and
    the length of its name. An end of 0 marks the end of a list of nodes.
    """
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
    """Add the value at an offset of a binary file to its node, and return where the next value
    begins.
    """
    kind = data[at : at + 1]
    if kind in _SCALARS:
        node.values += struct.unpack_from(_SCALARS[kind], data, at + 1)
        return at + 1 + struct.calcsize(_SCALARS[kind])
    if kind in _ARRAYS:
        node.source = data, at
        count, is_packed, size = struct.unpack_from("<3I", data, at + 1)
        array_size = size if is_packed else count * np.dtype(_ARRAYS[kind]).itemsize
        return at + _ARRAY_HEAD + array_size
    if kind not in (b"S", b"R"):
        raise ValueError("value")
    (size,) = struct.unpack_from("<I", data, at + 1)
    text = data[at + 5 : at + 5 + size] if kind == b"S" else b""
    # The name ends before its class; in text files it follows the class.
    node.values.append(text.partition(b"\0\1")[0].decode("utf-8", "replace"))
    return at + 5 + size


def _read_text(data: Data, root: FbxNode) -> None:
    """Add the nodes of a text file to its root."""
    open_nodes = [root]
    array = None  # the node of an array whose numbers, from `start` on, go on to the next node
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
    """Return the value of a word, `text` in quotation marks or `bare`: the other one is empty."""
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
