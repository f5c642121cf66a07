# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Check for finite coordinates in a file, before Blender imports it.

Blender's importers silently replace a coordinate that is no finite float32 by 0 or the vertex
before: a wrong body would be measured as exact. Numbers that place no point may be NaN. Other
damage is left to Blender, which reports it.
"""

import re
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core import cad, files

# The end of a node's head: its name behind its length, and the type of its first property, an
# array.
_FBX_VERTICES = re.compile(rb"\x08Vertices(?=[df])")
_FBX_ARRAY = re.compile(rb"Vertices(?<!\wVertices)\s*:(?:\s*\*\d+\s*\{\s*a\s*:)?")
_FBX_NUMBERS = re.compile(rb"(?>(?:[\s,]*+%b(?=[\s,}]|\Z))*)[\s,]*+" % files.SHORT)
_FBX_WORD = re.compile(rb"[^\s,:{}]++(?!\s*:)")  # not the name of what follows
_VALUES = ("matrix", "translation", "rotation", "scale", "weights")  # numbers of nodes and meshes


def check_numbers(path: str, kind: str) -> None:
    """Raise FileError if a coordinate in the file is not a finite number. kind: the file's suffix.

    Raises OSError.
    """
    check = _CHECKS.get(kind)
    if check is not None:
        check(files.map_file(path), path)


def check_fbx(data: files.Data, _path: str) -> None:
    """Raise FileError if a vertex of a mesh or of its shape keys is not finite."""
    if data[: len(files.FBX_MAGIC)] != files.FBX_MAGIC:
        _check_ascii_fbx(data)
        return
    for vertices in _FBX_VERTICES.finditer(data):
        with suppress(*files.MALFORMED):
            count = first_vertex = 0
            for begin, numbers in files.fbx_array(data, vertices.end()):
                fault_count, row = bad_in_table(numbers[:, None])
                first_vertex = first_vertex if count else (begin + row) // 3
                count += fault_count
            files.refuse_non_finite(count, "vertex", first_vertex)


def _check_ascii_fbx(data: files.Data) -> None:
    """Raise FileError if a vertex in a text file is not finite.

    The expression passes over numbers without a fault; the next word is checked by itself.
    """
    for array in _FBX_ARRAY.finditer(data):
        # A node begins its line. Chosen: more than 100 letters of indentation do not occur.
        _, _, before = data[max(0, array.start() - 100) : array.start()].rpartition(b"\n")
        numbers = None if before.strip() else _FBX_NUMBERS.match(data, array.end())
        while numbers and (word := _FBX_WORD.match(data, numbers.end())):
            fault = files.find_number_fault(word[0], True)
            if fault is not None:
                files.refuse_line(data, numbers.end(), fault)
            numbers = _FBX_NUMBERS.match(data, word.end())


def check_gltf(data: files.Data, path: str) -> None:
    """Raise FileError if a number in a node or in an accessor that places points is not finite."""
    with suppress(*files.MALFORMED):
        file = files.GltfFile(data, path)
        for number, node in enumerate(file.document.get("nodes", [])):
            _check_values(node, "node", number)
        for number, mesh in enumerate(file.document.get("meshes", [])):
            _check_values(mesh, "mesh", number)
        for number, mesh in _placing_accessors(file.document).items():
            where = "accessor {}".format(number) if mesh is None else "mesh “{}”".format(mesh)
            with suppress(*files.MALFORMED):  # The other accessors are checked after a damaged one.
                accessor = file.document["accessors"][number]
                count, first = bad_in_table(file.table(accessor))
                sparse_rows, values = file.sparse(accessor)
                sparse_faults, row = bad_in_table(values)
                if sparse_faults and not count:
                    first = int(sparse_rows[row])
                count += sparse_faults
                files.refuse_non_finite(count, where + ", row", first)


def _check_values(entry: dict[str, Any], kind: str, number: int) -> None:
    """Raise FileError if a number of a node or mesh is not finite. kind: its name in the message.
    number: its index, which stands for a missing name.
    """
    count = sum(
        not abs(value) < files.MAX_FLOAT32 for key in _VALUES for value in entry.get(key, ())
    )
    files.refuse_non_finite(count, kind, entry.get("name") or number)


def _placing_accessors(document: dict[str, Any]) -> dict[int, str | None]:
    """Return the accessors that place points, each with its mesh's name: None for skins, animations
    and instances.
    """
    mesh_names = {
        attributes["POSITION"]: mesh.get("name") or str(number)
        for number, mesh in enumerate(document.get("meshes", []))
        for primitive in mesh["primitives"]
        for attributes in (primitive["attributes"], *primitive.get("targets", ()))
        if "POSITION" in attributes
    }
    other_accessors = [skin.get("inverseBindMatrices") for skin in document.get("skins", [])]
    for animation in document.get("animations", []):
        other_accessors += [
            sampler[key] for sampler in animation["samplers"] for key in ("input", "output")
        ]
    for node in document.get("nodes", []):
        instancing = node.get("extensions", {}).get("EXT_mesh_gpu_instancing", {})
        other_accessors += instancing.get("attributes", {}).values()
    return mesh_names | {
        number: None
        for number in other_accessors
        if number is not None and number not in mesh_names
    }


def bad_in_table(table: NDArray) -> tuple[int, int]:
    """Return the count of numbers in an (n, k) table that are not finite in float32, and the first
    row with such a number.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        # If a number is NaN, so are the smallest and the largest, and no comparison holds.
        if (
            table.dtype.kind != "f"
            or not table.size
            or table.max() < files.MAX_FLOAT32
            and table.min() > -files.MAX_FLOAT32
        ):
            return 0, 0
        bad = ~(np.abs(table) < files.MAX_FLOAT32)
    return int(np.count_nonzero(bad)), int(np.argmax(bad.any(axis=1)))


_CHECKS: dict[str, Callable[[files.Data, str], None]] = {
    ".obj": lambda data, _path: cad.check_obj_text(data),
    **dict.fromkeys((".glb", ".gltf"), check_gltf),
    ".fbx": check_fbx,
}
