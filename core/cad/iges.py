# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces of an IGES file, Initial Graphics Exchange Specification 5.3: B-spline surfaces (128),
swept ones (118, 120, 122), cylinders, cones, spheres and tori (192 to 198), and planes.

They stand alone, in trimmed or bounded surfaces (144, 143), in solids (186) of shells (514) of
faces (510), or in subfigures (308, 408).
Transformations (124) and the unit of the global section are applied. Other surfaces and solids are
refused by name; curves, points and annotation bound nothing and are left out.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np

from ..files import FILE_TOO_LARGE
from ..numerics import NDArray
from ..nurbs import Face, closed_parts
from ..verdict import FileError, finding
from .findings import CURVES_LEFT_OUT, SURFACE_UNSUPPORTED, SURFACES_HIDDEN
from .iges_boundaries import BoundaryReader
from .iges_curves import CurveReader
from .iges_entities import MAX_DEPTH, Entry, IgesText, Places, integers, numbers, padded
from .iges_surfaces import SurfaceReader
from .iges_types import (
    BOUNDED,
    CURVES,
    DEFINITION,
    FACE,
    INSTANCE,
    NAMES,
    OFFSET,
    REFUSED,
    SHELL,
    SOLID,
    SOLID_INSTANCE,
    TRIMMED,
)
from .surfaces import (
    MAX_SURFACES,
    RECURSION,
    Refusals,
    SurfaceBody,
    SurfaceFile,
    is_storable,
    refuse,
)

# Index of the parameter that points to the surface or solid which an entity refers to.
REFERENCES = {TRIMMED: 0, OFFSET: 4, BOUNDED: 1, SOLID_INSTANCE: 0, FACE: 0}


class IgesReader:
    """A reader of the faces of a file."""

    def __init__(self, path: Path, data: bytes | None = None) -> None:
        self._data = path.read_bytes() if data is None else data
        self._text = IgesText(self._data)
        self._entries = self._text.entries
        self._refusals = Refusals()
        self._name = path.stem
        self._placed = 0
        self._places = Places(self._text)
        curves = CurveReader(self._text, self._places)
        self._surfaces = SurfaceReader(self._text, self._places, curves)
        self._boundaries = BoundaryReader(self._text, self._places, curves)

    def read(self) -> SurfaceFile:
        """Read the faces as one body, named after the file. FileError if no face can be kept."""
        parts = set(self._part_numbers())
        faces: list[Face] = []
        hidden_count = 0
        curve_count = 0
        for entry in self._entries.values():
            is_unused_part = entry.dependent and (
                entry.type in REFUSED or entry.type in (FACE, SHELL)
            )
            if entry.type not in NAMES:
                curve_count += entry.type in CURVES and not entry.dependent
            elif entry.number in parts or is_unused_part:
                continue
            elif entry.hidden:
                hidden_count += 1
            else:
                faces += self._place(entry, np.eye(4), ())
        if self._refusals.names and faces:
            # A part of a body is no body: what closes without the refused faces is another one.
            faces = closed_parts(faces, self._places.rounding)
        counts = ((SURFACES_HIDDEN, hidden_count), (CURVES_LEFT_OUT, curve_count))
        notes = [finding(code, count=count) for code, count in counts if count]
        reach = max((float(np.abs(face.points).max()) for face in faces), default=0.0)
        body = SurfaceBody(
            self._name,
            tuple(faces),
            self._places.rounding + self._places.turning * reach,
            source=None if all(map(is_storable, faces)) else partial(zlib.compress, self._data),
            matrix=np.eye(4),
        )
        return self._refusals.file([body], self._text.unit, notes)

    def _part_numbers(self) -> Iterator[int]:
        """Yield the numbers of entities that are parts of other entities, and so are not placed by
        themselves.
        """
        for entry in self._entries.values():
            try:
                if entry.type == DEFINITION:
                    yield from self._members(self._text.fields(entry))
                elif entry.type in (SOLID, SHELL):
                    yield from (part.number for part, _ in self._parts(entry))
                elif entry.type in REFERENCES:
                    yield from integers(self._text.fields(entry)[REFERENCES[entry.type] :], 1)
            except (ValueError, LookupError):
                continue  # It is refused when it is placed.

    @staticmethod
    def _members(fields: list[str]) -> list[int]:
        """Return the pointers to a subfigure's members, which follow its depth, its name and the
        member count.
        """
        (count,) = integers(fields[2:], 1)
        return integers(fields[3:], count)

    def _parts(self, entry: Entry) -> list[tuple[Entry, bool]]:
        """Return a solid's shells or a shell's faces, each with True if it faces as the part itself
        does.
        """
        fields = self._text.fields(entry)
        if entry.type == SOLID:
            # Its outer shell stands before the count of the others.
            kind = SHELL
            *first, count = integers(fields, 3)
            pairs = [*first, *integers(fields[3:], 2 * count)]
        else:
            kind = FACE
            (count,) = integers(fields, 1)
            pairs = integers(fields[1:], 2 * count)
        if not pairs:
            raise ValueError("no parts")
        return [
            (self._text.entry(part, kind), bool(flag))
            for part, flag in zip(pairs[::2], pairs[1::2])
        ]

    def _place(self, entry: Entry, outer_matrix: NDArray, path: tuple[int, ...]) -> list[Face]:
        """Return an entity's faces in place; none if it is refused, which is noted. outer_matrix,
        path: (4, 4) matrix and pointers of the subfigures around it.
        """
        name = NAMES[entry.type]
        kind = "{} ({})".format(name, entry.type)
        line = "D{}".format(entry.number)
        label = "{} ({})".format(entry.label, line) if entry.label else line
        if entry.type in REFUSED:
            self._refusals.add(SURFACE_UNSUPPORTED, kind, label, base=name)
            return []
        self._placed += 1
        if self._placed > MAX_SURFACES:
            raise FileError(FILE_TOO_LARGE, limit=MAX_SURFACES, content="surfaces")
        read = partial(self._faces, entry, outer_matrix, path)
        return self._refusals.keep(kind, label, read)

    def _faces(self, entry: Entry, outer_matrix: NDArray, path: tuple[int, ...]) -> list[Face]:
        """Return an entity's faces in place, or raise the error of one that cannot be kept."""
        if entry.type == INSTANCE:
            return self._instance(entry, outer_matrix, path)
        if entry.type in (SOLID, SHELL):
            return self._shells(entry, outer_matrix)
        makers = {TRIMMED: self._trimmed, BOUNDED: self._bounded, FACE: self._face}
        if entry.type in makers:
            return makers[entry.type](entry, outer_matrix @ self._places.matrix(entry))
        return self._surfaces.faces_within(entry, outer_matrix, [], True)

    def _shells(self, entry: Entry, outer_matrix: NDArray) -> list[Face]:
        """Return the faces of a solid or a shell, turned outward if a flag says that they face
        inward.
        """
        matrix = outer_matrix @ self._places.matrix(entry)
        faces: list[Face] = []
        # Parts are shells and faces, which hold no subfigures, so no path is needed.
        for part, is_outward in self._parts(entry):
            part_faces = self._place(part, matrix, ())
            faces += (
                part_faces if is_outward else [face.reverse_orientation() for face in part_faces]
            )
        return faces

    def _instance(self, entry: Entry, outer_matrix: NDArray, path: tuple[int, ...]) -> list[Face]:
        """Return the faces of a subfigure where an instance places it."""
        fields = self._text.fields(entry)
        (pointer,) = integers(fields, 1)
        x, y, z, scale = numbers(padded(fields[1:], 4))
        definition = self._text.entry(pointer, DEFINITION)
        if pointer in path or len(path) >= MAX_DEPTH:
            raise refuse(RECURSION)
        local = np.diag([*[scale or 1.0] * 3, 1.0])
        local[:3, 3] = x, y, z
        matrix = outer_matrix @ self._places.matrix(entry) @ local @ self._places.matrix(definition)
        faces = []
        for number in self._members(self._text.fields(definition)):
            member = self._entries[number]
            if member.type in NAMES and not member.hidden:
                faces += self._place(member, matrix, (*path, pointer))
        return faces

    def _trimmed(self, entry: Entry, matrix: NDArray) -> list[Face]:
        """Return the faces of a trimmed surface."""
        fields = self._text.fields(entry)
        pointer, has_outer, hole_count = integers(fields, 3)
        surface = self._entries[pointer]
        pointers = integers(fields[3:], 1 if has_outer else 0) + integers(fields[4:], hole_count)
        boundaries = [self._boundaries.on_surface(one, surface, matrix) for one in pointers]
        return self._surfaces.faces_within(surface, matrix, boundaries, bool(has_outer))

    def _bounded(self, entry: Entry, matrix: NDArray) -> list[Face]:
        """Return the faces of a surface within boundaries, the first of which is the outer one."""
        fields = self._text.fields(entry)
        _, pointer, count = integers(fields, 3)
        boundaries = [
            self._boundaries.of_curves(boundary, matrix) for boundary in integers(fields[3:], count)
        ]
        return self._surfaces.faces_within(self._entries[pointer], matrix, boundaries, True)

    def _face(self, entry: Entry, matrix: NDArray) -> list[Face]:
        """Return the faces of a face of a solid: a surface within loops of edges."""
        fields = self._text.fields(entry)
        pointer, count, _ = integers(fields, 3)
        loops = [self._boundaries.of_edges(loop, matrix) for loop in integers(fields[3:], count)]
        return self._surfaces.faces_within(self._entries[pointer], matrix, loops, True)
