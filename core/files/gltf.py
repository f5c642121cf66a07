# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""glTF files: the JSON document, text or first chunk of a binary file, and the buffers."""

import base64
import json
import os
import re
import struct
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..numerics import NDArray, rotation_matrix
from ..verdict import FileError, finding
from .findings import DAMAGE_SIZE, FILE_DAMAGED, MISSING_REFERENCES
from .text_fields import Data, map_file

_HEAD = struct.Struct("<4sIIII")  # magic, version, size; length and kind of the first chunk
_MAGIC = b"glTF"
_JSON = 0x4E4F534A  # the letters “JSON”
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_TYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}


def gltf_document(data: Data) -> dict[str, Any]:
    """Return the JSON document of the bytes of a .gltf or .glb file, without values that are null.

    ValueError if they have none.
    """
    text = data[_HEAD.size : _end_of_text(data)] if data[:4] == _MAGIC else data[:]
    # An exporter may write null for a value that it leaves out.
    return json.loads(
        text,
        object_hook=lambda values: {
            key: value for key, value in values.items() if value is not None
        },
    )


def to_glb(text: str, chunks: bytes = b"") -> bytes:
    """Return the JSON text of a document, and the chunks behind it, as the bytes of a .glb file."""
    body = text.encode()
    body += b" " * (-len(body) % 4)
    size = _HEAD.size + len(body) + len(chunks)
    return _HEAD.pack(_MAGIC, 2, size, len(body), _JSON) + body + chunks


def replace_gltf_document(data: bytes, document: dict[str, Any]) -> bytes:
    """Return the bytes of a .glb file with another document; its other chunks stay."""
    text = json.dumps(document, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return to_glb(text, data[_end_of_text(data) :])


def _end_of_text(data: Data) -> int:
    """Return the offset behind the JSON text of a .glb file. ValueError if it does not begin with
    one.
    """
    if len(data) < _HEAD.size:
        raise ValueError("glTF")
    *_, length, kind = _HEAD.unpack_from(data)
    if kind != _JSON:
        raise ValueError("glTF")
    return _HEAD.size + length


def _unquote(uri: str) -> str:
    """Return a reference with escapes such as %20 replaced by their characters."""
    data = re.sub(
        rb"%([0-9a-fA-F]{2})", lambda match: bytes.fromhex(match[1].decode()), uri.encode()
    )
    return data.decode("utf-8", "surrogateescape")


def node_matrix(node: dict[str, Any]) -> NDArray:
    """Return the (4, 4) place of a node in the node above it."""
    if "matrix" in node:  # by columns
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    matrix = np.eye(4)
    # Quaternions are x, y, z, w in the file.
    rotation = np.roll(node.get("rotation", (0.0, 0.0, 0.0, 1.0)), 1)
    matrix[:3, :3] = rotation_matrix(rotation) * np.array(node.get("scale", (1.0,) * 3), np.float64)
    matrix[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return matrix


class GltfFile:
    """The document of a glTF file, and its buffers, including external files."""

    def __init__(self, data: Data, path: str) -> None:
        self._data = data
        self._folder = os.path.dirname(path)
        self._opened: dict[int, Data | memoryview] = {}
        self.document = gltf_document(data)

    def references(self) -> Iterator[str]:
        """Yield the names of the external files."""
        for buffer in self.document.get("buffers", ()):
            uri = buffer.get("uri")
            if uri and not uri.startswith("data:"):
                yield _unquote(uri)

    def table(self, accessor: dict[str, Any]) -> NDArray:
        """Return the (n, k) numbers of an accessor without sparse ones, n = 0 if the file has no
        other, or an extension has compressed them.
        """
        kind = np.dtype(_TYPES[accessor["componentType"]])
        width = _WIDTHS[accessor["type"]]
        nothing = np.empty((0, width), kind)
        if "bufferView" not in accessor:
            return nothing
        view = self.document["bufferViews"][accessor["bufferView"]]
        if any("meshopt_compression" in name for name in view.get("extensions", {})):
            return nothing
        data = self._buffer(view.get("buffer", 0))
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        size = width * kind.itemsize
        stride = view.get("byteStride") or size
        if stride < size:
            raise ValueError("byteStride")
        return np.ndarray((accessor["count"], width), kind, data, start, (stride, kind.itemsize))

    def sparse(self, accessor: dict[str, Any]) -> tuple[NDArray, NDArray]:
        """Return the (n,) rows of an accessor whose numbers are replaced, and their (n, k)
        numbers.
        """
        if "sparse" not in accessor:
            return np.empty(0, np.intp), np.empty((0, 1))
        sparse = accessor["sparse"]
        size = {"count": sparse["count"]}
        rows = self.table({"type": "SCALAR"} | sparse["indices"] | size)[:, 0]
        # The accessor's own offset is one in another buffer view.
        return rows, self.table(accessor | {"byteOffset": 0} | sparse["values"] | size)

    def numbers(self, number: int) -> NDArray:
        """Return the (n, k) numbers of an accessor in float64, normalized ones as fractions.

        ValueError if an extension has compressed them.
        """
        accessor = self.document["accessors"][number]
        table = self.table(accessor)
        shape = accessor["count"], table.shape[1]
        full = table.astype(np.float64) if "bufferView" in accessor else np.zeros(shape)
        if full.shape != shape:
            raise ValueError("compressed")
        rows, values = self.sparse(accessor)
        full[rows] = values
        if accessor.get("normalized"):  # By the format, the least of 8 bits is -1, not -128/127.
            full = np.maximum(full / np.iinfo(table.dtype).max, -1.0)
        return full

    def _buffer(self, number: int) -> Data | memoryview:
        """Return the bytes of a buffer. FileError if they are missing or too few."""
        if number in self._opened:
            return self._opened[number]
        buffer = self.document["buffers"][number]
        uri = buffer.get("uri")
        data: Data | memoryview
        if uri is None:
            name = "BIN"
            if self._data[:4] != _MAGIC:
                raise FileError(MISSING_REFERENCES, names=[name])
            # The second chunk: its length, its kind, its bytes.
            chunk = memoryview(self._data)[_end_of_text(self._data) :]
            data = chunk[8 : 8 + int.from_bytes(chunk[:4], "little")]
        elif uri.startswith("data:"):
            name = "data:"
            data = base64.b64decode(uri.partition(",")[2])
        else:
            name = _unquote(uri)
            try:
                data = map_file(os.path.join(self._folder, name))
            except (OSError, ValueError) as error:  # ValueError: it is empty
                raise FileError(MISSING_REFERENCES, names=[name]) from error
        if len(data) < buffer["byteLength"]:
            cause = finding(DAMAGE_SIZE, bytes=len(data), total=buffer["byteLength"])
            raise FileError(FILE_DAMAGED, file=name, cause=cause.as_record())
        self._opened[number] = data
        return data
