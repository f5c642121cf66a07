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

import math
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TypeAlias, TypeVar

import numpy as np

from ..files import FILE_TOO_LARGE
from ..numerics import Array, NDArray, lengths
from ..nurbs import (
    TURN,
    Curve,
    Face,
    FlatFace,
    Patch,
    Quadric,
    closed_parts,
    patches_size,
    reverse_curves,
)
from ..verdict import FileError, MeasureError, finding
from .findings import (
    CURVES_LEFT_OUT,
    SURFACE_DAMAGED,
    SURFACE_TRIMMED,
    SURFACE_UNSUPPORTED,
    SURFACES_HIDDEN,
)
from .iges_entities import (
    MAX_DEPTH,
    CurveReader,
    Entry,
    IgesText,
    integers,
    numbers,
    padded,
)
from .iges_sweeps import join_pieces, revolve, revolved_quadric, rule
from .surfaces import (
    MAX_SURFACES,
    Refusals,
    SurfaceBody,
    SurfaceFile,
    SurfaceRefusedError,
    bezier_surface,
    is_storable,
    placed_surface,
)
from .trimmed import face_within, flat_region, is_flat, lifted, patch_sides

TURNING = 3.0  # the norm of a matrix (3, 3) of ones
MATRIX = 124
SURFACE = 128
OFFSET = 140
BOUNDARY = 141
BOUNDED = 143
TRIMMED = 144
DEFINITION = 308
INSTANCE = 408
PLANE = 108
PLANE_SURFACE = 190
DIRECTION = 123
SOLID = 186
EDGES = 504
LOOP = 508
FACE = 510
SHELL = 514
RECURSION = "references to itself, or nested too deeply"
# Surfaces and solids that Blender's surfaces cannot represent, by the names of the specification.
# All other types are curves, points, annotation or structure.
REFUSED = {
    108: "Plane",
    114: "Parametric Spline Surface",
    140: "Offset Surface",
    150: "Block",
    152: "Wedge",
    154: "Cylinder",
    156: "Cone Frustum",
    158: "Sphere",
    160: "Torus",
    162: "Solid of Revolution",
    164: "Solid of Linear Extrusion",
    168: "Ellipsoid",
    180: "Boolean Tree",
    184: "Solid Assembly",
    190: "Plane Surface",
    192: "Cylindrical Surface",
    194: "Conical Surface",
    196: "Spherical Surface",
    198: "Toroidal Surface",
    412: "Rectangular Array",
    414: "Circular Array",
    416: "External Reference",
    430: "Solid Instance",
}
RULED = 118
REVOLVED = 120
EXTRUDED = 122
SWEPT = {
    RULED: "Ruled Surface",
    REVOLVED: "Surface of Revolution",
    EXTRUDED: "Tabulated Cylinder",
}
CYLINDER = 192
CONE = 194
BALL = 196
TORUS = 198
ANALYTIC = (CYLINDER, CONE, BALL, TORUS)
POINT = 116
PARTS = {FACE: "Face", SHELL: "Shell"}  # A solid or a file has them.
NAMES = (
    {
        SURFACE: "Rational B-Spline Surface",
        TRIMMED: "Trimmed Surface",
        BOUNDED: "Bounded Surface",
        INSTANCE: "Subfigure Instance",
        SOLID: "Manifold Solid B-Rep",
    }
    | PARTS
    | SWEPT
    | REFUSED
)
# Index of the parameter that points to the surface or solid which an entity refers to.
REFERENCES = {TRIMMED: 0, OFFSET: 4, BOUNDED: 1, 430: 0, FACE: 0}
CURVES = {100, 102, 104, 106, 110, 112, 116, 126, 130}  # Curves and points, which bound nothing.
PARAMETER_CURVE = 142
Value = TypeVar("Value")
Pair: TypeAlias = tuple[Value, Value]


@dataclass(frozen=True, eq=False)
class Boundary:
    """A closed boundary of a face: its curves in space, and in the surface's parameters; None if
    they are unknown. prefers_parameters: True if the file says so.
    """

    curves: list[Curve] | None
    parameters: list[Curve] | None = None
    prefers_parameters: bool = False


class IgesReader:
    """A reader of the faces of a file."""

    def __init__(self, path: Path, data: bytes | None = None) -> None:
        self._data = path.read_bytes() if data is None else data
        self._text = IgesText(self._data)
        self._entries = self._text.entries
        self._refusals = Refusals()
        # (4, 4) and the effect of the decimals of its directions on points at a unit's distance
        self._matrices: dict[int, tuple[Array, float]] = {0: (np.eye(4), 0.0)}
        self._name = path.stem
        self._placed = 0
        self._rounding = 0.0
        self._turning = 0.0  # Largest effect of the decimals of directions, relative to the size.
        self._curves = CurveReader(self._text, self._matrix_and_turning)

    def read(self) -> SurfaceFile:
        """Read the faces as one body, named after the file. FileError if no face can be kept."""
        used = set(self._references())
        patches: list[Face] = []
        hidden = others = 0
        for entry in self._entries.values():
            if entry.type not in NAMES:
                others += entry.type in CURVES and not entry.dependent
            elif (
                entry.number in used
                or entry.dependent
                and (entry.type in REFUSED or entry.type in PARTS)
            ):
                continue
            elif entry.hidden:
                hidden += 1
            else:
                patches += self._place(entry, np.eye(4), ())
        if self._refusals.names and patches:
            # A part of a body is no body: what closes without the refused faces is another one.
            patches = closed_parts(patches, self._rounding)
        notes = [
            finding(code, count=n)
            for code, n in ((SURFACES_HIDDEN, hidden), (CURVES_LEFT_OUT, others))
            if n
        ]
        if self._turning and patches:
            reach = max(float(np.abs(face.points).max()) for face in patches)
            self._rounding += self._turning * reach
        source = None if all(map(is_storable, patches)) else partial(zlib.compress, self._data)
        body = SurfaceBody(
            self._name, tuple(patches), self._rounding, source=source, matrix=np.eye(4)
        )
        return self._refusals.file([body], self._text.unit, notes)

    def _references(self) -> Iterator[int]:
        """Yield the numbers of entities that are parts of other entities, and so are not placed by
        themselves.
        """
        for entry in self._entries.values():
            try:
                if entry.type == DEFINITION:
                    yield from self._members(self._text.fields(entry))
                elif entry.type in (SOLID, SHELL):
                    kind = SHELL if entry.type == SOLID else FACE
                    yield from (part.number for part, _ in self._parts(entry, kind))
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

    def _parts(self, entry: Entry, kind: int) -> list[tuple[Entry, bool]]:
        """Return a solid's shells or a shell's faces, each with True if it faces as the part itself
        does.
        """
        fields = self._text.fields(entry)
        if entry.type == SOLID:
            *first, count = integers(fields, 3)
            pairs = [*first, *integers(fields[3:], 2 * count)]
        else:
            (count,) = integers(fields, 1)
            pairs = integers(fields[1:], 2 * count)
        if not pairs:
            raise ValueError("no parts")
        return [
            (self._entry(part, kind), bool(flag)) for part, flag in zip(pairs[::2], pairs[1::2])
        ]

    def _place(self, entry: Entry, above: NDArray, path: tuple[int, ...]) -> list[Face]:
        """Return an entity's faces in place. above, path: (4, 4) matrix and pointers of the
        subfigures around it.
        """
        kind = NAMES[entry.type]
        line = "D{}".format(entry.number)
        name = "{} ({})".format(entry.label, line) if entry.label else line
        if entry.type in REFUSED:
            self._refusals.add(
                SURFACE_UNSUPPORTED, "{} ({})".format(kind, entry.type), name, base=kind
            )
            return []
        self._placed += 1
        if self._placed > MAX_SURFACES:
            raise FileError(FILE_TOO_LARGE, limit=MAX_SURFACES, content="surfaces")

        def make() -> list[Face]:
            if entry.type == INSTANCE:
                return self._instance(entry, above, path)
            if entry.type in (SOLID, SHELL):
                return self._shells(entry, above)
            if entry.type == SURFACE or entry.type in SWEPT:
                return self._within(entry, above, [], True)
            kinds = {TRIMMED: self._trimmed, BOUNDED: self._bounded, FACE: self._face}
            return kinds[entry.type](entry, above @ self._matrix(entry))

        return self._refusals.keep("{} ({})".format(kind, entry.type), name, make)

    def _shells(self, entry: Entry, above: NDArray) -> list[Face]:
        """Return the faces of a solid or a shell, turned outward if a flag says that they face
        inward.
        """
        matrix = above @ self._matrix(entry)
        kind = SHELL if entry.type == SOLID else FACE
        faces: list[Face] = []
        for part, is_outward in self._parts(entry, kind):
            made = self._place(part, matrix, ())
            faces += made if is_outward else [face.reverse_orientation() for face in made]
        return faces

    def _instance(self, entry: Entry, above: NDArray, path: tuple[int, ...]) -> list[Face]:
        fields = self._text.fields(entry)
        (pointer,) = integers(fields, 1)
        x, y, z, scale = numbers(padded(fields[1:], 4))
        definition = self._entry(pointer, DEFINITION)
        if pointer in path or len(path) >= MAX_DEPTH:
            raise SurfaceRefusedError(SURFACE_DAMAGED, fault=RECURSION)
        local = np.diag([*[scale or 1.0] * 3, 1.0])
        local[:3, 3] = x, y, z
        matrix = above @ self._matrix(entry) @ local @ self._matrix(definition)
        patches = []
        for member in self._members(self._text.fields(definition)):
            one = self._entries[member]
            if one.type in NAMES and not one.hidden:
                patches += self._place(one, matrix, (*path, pointer))
        return patches

    def _entry(self, pointer: int, kind: int) -> Entry:
        entry = self._entries[pointer]
        if entry.type != kind:
            raise ValueError("another entity")
        return entry

    def _matrix(self, entry: Entry) -> Array:
        """Return the (4, 4) matrix of a part of the structure, and note its decimals."""
        matrix, turning = self._matrix_and_turning(entry)
        self._turning = max(self._turning, turning)
        return matrix

    def _matrix_and_turning(self, entry: Entry) -> tuple[Array, float]:
        """Return the (4, 4) matrix of an entity: its transformation, followed by the ones that this
        refers to; and how far its decimals move points at a unit's distance.
        """
        chain = []
        pointer = entry.matrix
        while pointer not in self._matrices and len(chain) < MAX_DEPTH:
            chain.append(self._entry(pointer, MATRIX))
            pointer = chain[-1].matrix
        if pointer not in self._matrices:
            raise SurfaceRefusedError(SURFACE_DAMAGED, fault=RECURSION)
        known, turning = self._matrices[pointer]
        for one in reversed(chain):
            fields = self._text.fields(one)[:12]
            self._rounding = max(self._rounding, self._text.rounding(fields[3::4]))
            turning += TURNING * self._text.rounding([w for k, w in enumerate(fields) if k % 4 < 3])
            matrix = np.eye(4)
            matrix[:3] = numbers(fields).reshape(3, 4)
            known = known @ matrix
            self._matrices[one.number] = known, turning
        if not abs(np.linalg.det(known[:3, :3])) > 0.0:
            raise SurfaceRefusedError(SURFACE_DAMAGED, fault="a transformation that flattens")
        return known, turning

    def _trimmed(self, entry: Entry, matrix: NDArray) -> list[Face]:
        """Return the faces of a trimmed surface."""
        fields = self._text.fields(entry)
        pointer, has_outer, holes = integers(fields, 3)
        base = self._entries[pointer]
        loops = ([fields[3]] if has_outer else []) + fields[4 : 4 + holes]
        if len(loops) != bool(has_outer) + holes:
            raise ValueError("too few boundaries")
        boundaries = [self._boundary(loop, base, matrix) for loop in integers(loops, len(loops))]
        return self._within(base, matrix, boundaries, bool(has_outer))

    def _boundary(self, pointer: int, base: Entry, matrix: NDArray) -> Boundary:
        """Return the boundary given by a curve on a surface (142), unknown if the curve lies on
        another surface.
        """
        try:
            entry = self._entry(pointer, PARAMETER_CURVE)
        except (ValueError, LookupError):
            return Boundary(None, None)
        _, surface, by_parameters, in_space, preferred = integers(self._text.fields(entry), 5)
        if surface != base.number:
            return Boundary(None, None)
        space = self._curves.read(in_space, matrix @ self._matrix(entry))
        return Boundary(space, self._curves.read(by_parameters, None), preferred == 1)

    def _bounded(self, entry: Entry, matrix: NDArray) -> list[Face]:
        """Return the faces of a surface within boundaries (141), the first of which is the outer
        one.
        """
        _, pointer, count = integers(self._text.fields(entry), 3)
        base = self._entries[pointer]
        boundaries = []
        for number in integers(self._text.fields(entry)[3:], count):
            fields = self._text.fields(self._entry(number, BOUNDARY))
            (curves,) = integers(fields[3:], 1)
            at = 4
            in_space, by_parameters = [], []
            for _ in range(curves):
                curve, sense, uses = integers(fields[at:], 3)
                pieces = self._curves.read(curve, matrix)
                in_space.append(reverse_curves(pieces) if pieces and sense == 2 else pieces)
                ways = integers(fields[at + 3 :], uses)
                by_parameters += [self._curves.read(way, None) for way in ways] or [None]
                at += 3 + uses
            boundaries.append(Boundary(_join_curves(in_space), _join_curves(by_parameters)))
        return self._within(base, matrix, boundaries, True)

    def _face(self, entry: Entry, matrix: NDArray) -> list[Face]:
        """Return the faces of a face of a solid: a surface within loops of edges."""
        fields = self._text.fields(entry)
        pointer, count, _ = integers(fields, 3)
        loops = integers(fields[3:], count)
        base = self._entries[pointer]
        return self._within(base, matrix, [self._loop(loop, matrix) for loop in loops], True)

    def _loop(self, pointer: int, matrix: NDArray) -> Boundary:
        """Return a boundary of edges; edges that are a vertex, such as a pole, have no curve in
        space.
        """
        entry = self._entry(pointer, LOOP)
        fields = self._text.fields(entry)
        matrix = matrix @ self._matrix(entry)
        (count,) = integers(fields, 1)
        at = 1
        in_space = []
        by_parameters = []
        for _ in range(count):
            is_vertex, edges, index, forward, uses = integers(fields[at:], 5)
            ways = integers(fields[at + 5 :], 2 * uses)[1::2]
            at += 5 + 2 * uses
            if not is_vertex:
                in_space.append(self._edge(edges, index, bool(forward), matrix))
            if uses or not is_vertex:
                by_parameters += [self._curves.read(way, None) for way in ways] or [None]
        return Boundary(_join_curves(in_space), _join_curves(by_parameters))

    def _edge(self, pointer: int, index: int, forward: bool, matrix: NDArray) -> list[Curve] | None:
        """Return an edge of a list, in the direction of its use."""
        entry = self._entry(pointer, EDGES)
        (curve,) = (
            integers(self._text.fields(entry)[1 + 5 * (index - 1) :], 1) if index > 0 else (0,)
        )
        curves = self._curves.read(curve, matrix @ self._matrix(entry))
        return reverse_curves(curves) if curves and not forward else curves

    def _within(
        self, base: Entry, matrix: NDArray, boundaries: Sequence[Boundary], has_outer: bool
    ) -> list[Face]:
        """Return the faces of a surface within boundaries. matrix: (4, 4), of all that is around
        it.
        """
        own, turning = self._matrix_and_turning(base)
        matrix = matrix @ own
        if base.type == OFFSET:
            plane = self._entries[integers(self._text.fields(base)[4:], 1)[0]]
            if plane.type in (PLANE, PLANE_SURFACE):  # It is where its boundary is.
                base = plane
        of_edges = self._curves.rounding
        self._curves.rounding = 0.0
        if base.type in (PLANE, PLANE_SURFACE):
            loops = _loops(boundaries if has_outer else [Boundary(None)], None)
            faces: list[Face] = [flat_region(loops, self._plane_normal(base, matrix), of_edges)]
        elif base.type in ANALYTIC:
            quadric, moved, tilt, has_seam = self._quadric(base, matrix)
            degrees = np.diag([TURN / 360.0, TURN / 360.0 if quadric.minor else 1.0, 1.0, 1.0])
            in_degrees = [
                replace(
                    one, parameters=[curve.transform(degrees) for curve in one.parameters or ()]
                )
                for one in boundaries
            ]
            loops = _loops(in_degrees, quadric if has_seam else None)
            faces = [face_within(quadric, loops, self._rounding)]
            # A turn moves a sphere along itself, and a torus or a cylinder as it is long.
            reach = quadric.radius if quadric.minor or quadric.slope else 0.0
            if not quadric.minor:
                points = faces[0].points.reshape(-1, 3)
                reach += float(np.abs(quadric.project(points)[:, 1]).max())
            self._rounding = max(self._rounding, moved + (tilt + turning) * reach)
        elif base.type in SWEPT:
            surface, quadric = self._swept(base)
            moved = self._curves.rounding + turning * float(lengths(surface.points).max())
            self._rounding = max(self._rounding, moved)
            surface = surface.transform(matrix)
            # Parameters of other surfaces than splines are those of no exact form.
            whole = quadric.transform(matrix) if quadric else None
            patches = bezier_surface(surface, (None, None), False)
            in_space = [replace(one, parameters=None) for one in boundaries]
            faces = _trimmed_faces(whole, patches, in_space, has_outer, self._rounding)
        elif base.type != SURFACE:
            raise SurfaceRefusedError(
                SURFACE_UNSUPPORTED, base=NAMES.get(base.type, str(base.type))
            )
        else:
            fields = self._text.fields(base)
            knots, orders, points, weights, domain = _spline(fields)
            surface = placed_surface(knots, orders, points, weights, matrix)
            reach = float(lengths(surface.points - matrix[:3, 3]).max())
            rounding = self._note_rounding(fields, surface, matrix) + turning * reach
            patches = bezier_surface(surface, domain, False)
            faces = _trimmed_faces(surface, patches, boundaries, has_outer, rounding)
        if any(isinstance(face, FlatFace) for face in faces):
            # Its plane is that of its edges; other edges only part one surface from another.
            self._rounding = max(self._rounding, of_edges)
        self._curves.rounding = 0.0
        return faces

    def _swept(self, base: Entry) -> tuple[Patch, Quadric | None]:
        """Return a surface of revolution, a tabulated cylinder or a ruled surface, and the quadric
        that it is a part of.
        """
        fields = self._text.fields(base)
        first = integers(fields, 1)[0]
        quadric = None
        if base.type == REVOLVED:
            begin, end = self._curve(first).evaluate([0.0, 1.0])
            start, stop = numbers(fields[2:4]).tolist()
            profile = self._curve(integers(fields, 2)[1])
            unsure = self._text.rounding(fields[2:4])
            if abs(stop - start - TURN) <= 4.0 * unsure:
                stop = start + TURN
            else:
                arms = np.cross(profile.points - begin, end - begin) / np.linalg.norm(end - begin)
                self._rounding = max(self._rounding, unsure * float(lengths(arms).max()))
            patch = revolve(profile, begin, end - begin, start, stop)
            quadric = revolved_quadric(profile, begin, end - begin)
        elif base.type == EXTRUDED:
            profile = self._curve(first)
            self._rounding = max(self._rounding, self._text.rounding(fields[1:4]))
            shift = numbers(fields[1:4]) - profile.evaluate(profile.space.domain[:1])[0]
            patch = rule(profile, replace(profile, points=profile.points + shift))
        else:
            _, second, is_backward = integers(fields, 3)
            other = self._curve(second)
            patch = rule(self._curve(first), other.reverse() if is_backward else other)
        return patch, quadric

    def _curve(self, pointer: int) -> Curve:
        """Return a curve that sweeps a surface, in one piece."""
        pieces = self._curves.read(pointer, np.eye(4))
        if not pieces:
            raise ValueError("a curve of another kind")
        return join_pieces(pieces)

    def _quadric(self, base: Entry, matrix: NDArray) -> tuple[Quadric, float, float, bool]:
        """Return a cylinder, cone, sphere or torus, the effect of the decimals of its place and
        sizes, that of its directions at a unit's distance, and whether its angles are known.
        """
        fields = self._text.fields(base)
        radii = 1 if base.type in (CYLINDER, BALL) else 2
        if base.type == BALL:
            location, axis, toward = integers([fields[0], *padded(fields[2:], 2)], 3)
            sizes = fields[1:2]
        else:
            location, axis = integers(fields, 2)
            sizes = fields[2 : 2 + radii]
            (toward,) = integers(padded(fields[2 + radii :], 1), 1)
        radius, last = numbers(sizes)[[0, -1]].tolist()
        place = self._text.fields(self._entry(location, POINT))[:3]
        frame = np.eye(4)
        frame[:3, 3] = numbers(place)
        tilt = 0.0
        if axis:
            along = self._text.fields(self._entry(axis, DIRECTION))[:3]
            tilt = math.sqrt(2.0) * self._text.rounding(along)
            up = numbers(along) / np.linalg.norm(numbers(along))
            side = np.cross(up, np.eye(3)[np.abs(up).argmin()])
            if toward:  # The seam is there, and shows that a boundary follows the whole surface.
                side = numbers(self._text.fields(self._entry(toward, DIRECTION))[:3])
                side = side - (side @ up) * up
            side /= np.linalg.norm(side)
            frame[:3, :3] = np.stack([side, np.cross(up, side), up], axis=1)
        slope = 0.0
        if base.type == CONE:
            tilt += math.radians(self._text.rounding([sizes.pop()]))
            slope = math.tan(math.radians(last))
        minor = last if base.type in (BALL, TORUS) else 0.0
        radius = 0.0 if base.type == BALL else radius
        moved = self._text.rounding([*place, *sizes])
        return Quadric(matrix @ frame, radius, minor, slope), moved, tilt, bool(axis and toward)

    def _note_rounding(self, fields: list[str], surface: Patch, matrix: NDArray) -> float:
        """Note and return the uncertainty of a surface's points by the decimals of its points and
        weights.
        """
        count = surface.points.size // 3
        start = 9 + sum(len(space.knots) for space in surface.spaces)
        moved = float(np.linalg.norm(matrix[:3, :3], 2)) * self._text.rounding(
            fields[start + count : start + 4 * count]
        )
        # A point is a mean of control points: it moves by twice its weights' share.
        if surface.weights is not None:
            share = self._text.rounding(fields[start : start + count]) / float(
                surface.weights.min()
            )
            moved += 2.0 * share * patches_size([surface])
        self._rounding = max(self._rounding, moved)
        return moved

    def _plane_normal(self, base: Entry, matrix: NDArray) -> Array:
        """Return a vector (3,) across a plane, on the side that it faces."""
        fields = self._text.fields(base)
        if base.type == PLANE_SURFACE:
            fields = self._text.fields(self._entry(integers(fields, 2)[1], DIRECTION))
        return np.linalg.solve(matrix[:3, :3].T, numbers(fields[:3])) * np.sign(
            np.linalg.det(matrix[:3, :3])
        )


def _loops(boundaries: Sequence[Boundary], surface: Patch | Quadric | None) -> list[list[Curve]]:
    """Return the curves of boundaries in space, through points of the surface of their parameters
    if they are known in these alone; SurfaceRefusedError if they are not known at all.
    """
    loops = [
        one.curves or (lifted(surface, one.parameters) if surface and one.parameters else [])
        for one in boundaries
    ]
    if not all(loops):
        raise SurfaceRefusedError(SURFACE_TRIMMED)
    return loops


def _trimmed_faces(
    surface: Patch | Quadric | None,
    patches: Sequence[Patch],
    boundaries: Sequence[Boundary],
    has_outer: bool,
    rounding: float,
) -> list[Face]:
    """Return the faces of a surface within boundaries.

    surface: of the boundaries' parameters, or the quadric that the patch is a part of. patches: the
    used part of the surface, in one piece unless it may be torn. has_outer: False if the outer
    boundary is that of the patch. rounding: largest effect of the file's decimals on a point.
    """
    if not boundaries:
        return [*patches]
    if len(patches) > 1:
        raise SurfaceRefusedError(SURFACE_TRIMMED)
    (patch,) = patches
    around, seams = patch_sides(patch)
    outer = [] if has_outer else [around]
    choices: list[tuple[Patch | Quadric, Sequence[Boundary]]] = [(patch, boundaries)]
    if isinstance(surface, Quadric):
        choices.insert(0, (surface, boundaries))
    elif surface and all(one.curves and one.parameters for one in boundaries):
        choices.append((patch, [replace(one, curves=None) for one in boundaries]))
        if any(one.prefers_parameters for one in boundaries) and is_flat(patch, rounding):
            choices.reverse()
    faults = []
    for base, some in choices:
        try:
            # A face that goes beyond a seam of its surface has this seam among its boundaries.
            return [face_within(base, [*outer, *_loops(some, surface)], rounding, seams)]
        except MeasureError as error:
            faults.append(error)
    raise faults[0]


def _join_curves(parts: Sequence[list[Curve] | None]) -> list[Curve] | None:
    """Return the curves of all parts in turn, None if one is unknown."""
    known = [part for part in parts if part is not None]
    return [curve for part in known for curve in part] if len(known) == len(parts) else None


def _spline(
    fields: list[str],
) -> tuple[Pair[list[float]], Pair[int], NDArray, NDArray, Pair[Pair[float]]]:
    """Return knots, orders, (count_s, count_t, 3) points, (count_s, count_t) weights and domain of
    a surface.
    """
    last_s, last_t, degree_s, degree_t = integers(fields, 4)
    counts = (last_s + 1, last_t + 1)
    degrees = (degree_s, degree_t)
    if min(degrees) < 1:
        raise ValueError("degrees")
    knot_counts = [count + degree + 1 for count, degree in zip(counts, degrees)]
    total = counts[0] * counts[1]
    values = numbers(fields[9 : 9 + sum(knot_counts) + 4 * total + 4])
    s_knots, t_knots, weights, points, part = np.split(
        values, np.cumsum([knot_counts[0], knot_counts[1], total, 3 * total])
    )
    domain = (float(part[0]), float(part[1])), (float(part[2]), float(part[3]))
    knots = (s_knots.tolist(), t_knots.tolist())
    orders = (degree_s + 1, degree_t + 1)
    # The first direction runs fastest.
    return (
        knots,
        orders,
        points.reshape(*counts[::-1], 3).swapaxes(0, 1),
        weights.reshape(counts[::-1]).T,
        domain,
    )
