# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes as .stl and .ply files."""

import struct

import numpy as np

FACET = np.dtype(
    {
        "names": ["normal", "at"],
        "formats": ["(3,)<f4", "(3,3)<f4"],
        "offsets": [0, 12],
        "itemsize": 50,
    }
)


def stl(part) -> bytes:
    """Binary."""
    points, triangles = part
    facets = np.zeros(len(triangles), FACET)
    facets["at"] = np.asarray(points)[triangles]
    return struct.pack("<80xI", len(facets)) + facets.tobytes()


def stl_text(part, name="part") -> bytes:
    points, triangles = part
    lines = ["solid {}".format(name)]
    for corners in np.asarray(points)[triangles].tolist():
        lines += ["facet normal 0 0 1", " outer loop"]
        lines += ["  vertex {!r} {!r} {!r}".format(*corner) for corner in corners]
        lines += [" endloop", "endfacet"]
    return "\n".join([*lines, "endsolid {}".format(name), ""]).encode()


def ply(points, faces, order="<", kind="f4", extra=False) -> bytes:
    """order: "<", ">" or "" for text. faces: lists of vertices. extra: with properties and elements
    that say nothing of the shape.
    """
    name = {"<": "binary_little_endian", ">": "binary_big_endian", "": "ascii"}[order]
    number = {"f4": "float", "f8": "double"}[kind]
    head = ["ply", "format {} 1.0".format(name), "comment a test"]
    if extra:
        head += ["element camera 2", "property list uchar short path"]
    head += [
        "element vertex {}".format(len(points)),
        *["property {} {}".format(number, axis) for axis in "xy"],
    ]
    head += ["property uchar red"] * extra + [
        "property {} z".format(number),
        "element face {}".format(len(faces)),
    ]
    head += ["property list uchar float texcoord"] * extra
    head += [
        "property list uchar int vertex_indices",
        *["property int flags"] * extra,
        "end_header",
        "",
    ]
    rows = [[("u1", [2]), ("i2", [7, 8])], [("u1", [0])]] if extra else []
    for x, y, z in points:
        rows.append([(kind, [x, y]), ("u1", [9] * extra), (kind, [z])])
    for number, face in enumerate(faces):
        textures = [0.5] * (number % 3)
        before = [("u1", [len(textures)]), ("f4", textures)] if extra else []
        rows.append([*before, ("u1", [len(face)]), ("i4", face), ("i4", [5] * extra)])
    start = "\n".join(head).encode()
    if order:
        return start + b"".join(
            np.array(values, order + form).tobytes() for row in rows for form, values in row
        )
    texts = [
        " ".join(repr(getattr(value, "item", lambda v=value: v)()) for _, vs in row for value in vs)
        for row in rows
    ]
    return start + "\n".join([*texts, ""]).encode()


def write_large_torus(path, rows: int, columns: int) -> float:
    """An .stl of 2 rows columns triangles, written row by row, and its volume."""
    radius = (
        np.arange(rows + 1) % rows * (2 * np.pi / rows),
        np.arange(columns + 1) % columns * (2 * np.pi / columns),
    )
    tube = np.stack([1.0 + 0.3 * np.cos(radius[1]), 0.3 * np.sin(radius[1])], axis=1)
    volume = 0.0
    with open(path, "wb") as file:
        file.write(struct.pack("<80xI", 2 * rows * columns))
        for first, second in zip(radius[0], radius[0][1:]):
            rings = [
                np.stack([tube[:, 0] * np.cos(u), tube[:, 0] * np.sin(u), tube[:, 1]], axis=1)
                for u in (first, second)
            ]
            (a, b) = (ring.astype("<f4") for ring in rings)
            facets = np.zeros((columns, 2), FACET)
            facets["at"][:, 0] = np.stack([a[:-1], b[:-1], b[1:]], axis=1)
            facets["at"][:, 1] = np.stack([a[:-1], b[1:], a[1:]], axis=1)
            file.write(facets.tobytes())
            corners = facets["at"].reshape(-1, 3, 3).astype(float)
            volume += (
                np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
            )
    return float(volume)
