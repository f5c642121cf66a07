# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of IGES files within boundaries: B-spline surfaces (128), swept ones (118, 120, 122),
cylinders, cones, spheres and tori (192 to 198), and planes (108, 190).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..numerics import Array, NDArray, lengths
from ..nurbs import TURN, Curve, Face, FlatFace, Patch, Quadric, patches_size
from ..verdict import MeasureError
from .findings import SURFACE_TRIMMED, SURFACE_UNSUPPORTED
from .iges_boundaries import Boundary, loops_in_space
from .iges_curves import CurveReader
from .iges_entities import Entry, IgesText, Places, integers, numbers, padded
from .iges_types import (
    BALL,
    CONE,
    CYLINDER,
    DIRECTION,
    EXTRUDED,
    NAMES,
    OFFSET,
    PLANE_SURFACE,
    PLANES,
    POINT,
    QUADRICS,
    REVOLVED,
    SPLINE_SURFACE,
    SWEPT_SURFACES,
    TORUS,
)
from .surfaces import SurfaceRefusedError, bezier_surface, placed_surface
from .sweeps import join_pieces, revolve, revolved_quadric, rule
from .trimmed import face_within, flat_region, is_flat, patch_sides


class SurfaceReader:
    """A reader of the surfaces of a file."""

    def __init__(self, text: IgesText, places: Places, curves: CurveReader) -> None:
        self._text = text
        self._places = places
        self._curves = curves

    def faces_within(
        self, surface: Entry, matrix: NDArray, boundaries: Sequence[Boundary], has_outer: bool
    ) -> list[Face]:
        """Return the faces of a surface within boundaries that the curve reader has just read.

        matrix: (4, 4), of all that is around the surface. has_outer: False if the outer boundary is
        that of the surface.
        """
        own_matrix, turning = self._places.matrix_and_turning(surface)
        matrix = matrix @ own_matrix
        surface = self._plane_of_offset(surface)
        edge_rounding = self._curves.take_rounding()
        if surface.type in PLANES:
            loops = loops_in_space(boundaries if has_outer else [Boundary()], None)
            normal = self._plane_normal(surface, matrix)
            faces: list[Face] = [flat_region(loops, normal, edge_rounding)]
        elif surface.type in QUADRICS:
            faces = [self._quadric_face(surface, matrix, boundaries, turning)]
        elif surface.type in SWEPT_SURFACES:
            faces = self._swept_faces(surface, matrix, boundaries, has_outer, turning)
        elif surface.type == SPLINE_SURFACE:
            faces = self._spline_faces(surface, matrix, boundaries, has_outer, turning)
        else:
            name = NAMES.get(surface.type, str(surface.type))
            raise SurfaceRefusedError(SURFACE_UNSUPPORTED, base=name)
        if any(isinstance(face, FlatFace) for face in faces):
            # Its plane is that of its edges; other edges only part one surface from another.
            self._places.note_rounding(edge_rounding)
        return faces

    def _plane_of_offset(self, surface: Entry) -> Entry:
        """Return the plane from which an offset surface is offset, else the surface itself. The
        boundary tells at which distance the face is.
        """
        if surface.type != OFFSET:
            return surface
        base = self._text.entries[integers(self._text.fields(surface)[4:], 1)[0]]
        return base if base.type in PLANES else surface

    def _plane_normal(self, plane: Entry, matrix: NDArray) -> Array:
        """Return a vector (3,) across a plane, on the side that it faces."""
        fields = self._text.fields(plane)
        if plane.type == PLANE_SURFACE:
            fields = self._direction(integers(fields, 2)[1])
        normal = np.linalg.solve(matrix[:3, :3].T, numbers(fields[:3]))
        return normal * np.sign(np.linalg.det(matrix[:3, :3]))

    def _direction(self, pointer: int) -> list[str]:
        """Return the three fields of a direction."""
        return self._text.fields(self._text.entry(pointer, DIRECTION))[:3]

    def _quadric_face(
        self, surface: Entry, matrix: NDArray, boundaries: Sequence[Boundary], turning: float
    ) -> Face:
        """Return a part of a cylinder, cone, sphere or torus."""
        quadric, has_seam, moved, tilt = self._quadric(surface, matrix)
        # The file's angles are in degrees; the second parameter of a line is a length.
        degrees = np.diag([TURN / 360.0, TURN / 360.0 if quadric.minor else 1.0, 1.0, 1.0])
        in_radians = [
            replace(
                boundary,
                parameters=[curve.transform(degrees) for curve in boundary.parameters or ()],
            )
            for boundary in boundaries
        ]
        loops = loops_in_space(in_radians, quadric if has_seam else None)
        face = face_within(quadric, loops, self._places.rounding)
        # A turn moves a sphere along itself, and a torus or a cylinder as it is long.
        reach = quadric.radius if quadric.minor or quadric.slope else 0.0
        if not quadric.minor:
            heights = quadric.project(face.points.reshape(-1, 3))[:, 1]
            reach += float(np.abs(heights).max())
        self._places.note_rounding(moved + (tilt + turning) * reach)
        return face

    def _quadric(self, surface: Entry, matrix: NDArray) -> tuple[Quadric, bool, float, float]:
        """Return a whole cylinder, cone, sphere or torus, placed by a (4, 4) matrix, and whether
        its angle of zero is given; the effect of the decimals of its place and sizes on its points,
        and of those of its directions at a unit's distance.
        """
        fields = self._text.fields(surface)
        if surface.type == BALL:
            location, axis, toward = integers([fields[0], *padded(fields[2:], 2)], 3)
            sizes = fields[1:2]
        else:
            size_count = 1 if surface.type == CYLINDER else 2
            location, axis = integers(fields, 2)
            sizes = fields[2 : 2 + size_count]
            (toward,) = integers(padded(fields[2 + size_count :], 1), 1)
        first_size, last_size = numbers(sizes)[[0, -1]].tolist()
        place = self._text.fields(self._text.entry(location, POINT))[:3]
        frame = np.eye(4)
        frame[:3, 3] = numbers(place)
        tilt = 0.0
        if axis:
            axis_fields = self._direction(axis)
            tilt = math.sqrt(2.0) * self._text.rounding(axis_fields)
            up = numbers(axis_fields) / np.linalg.norm(numbers(axis_fields))
            side = np.cross(up, np.eye(3)[np.abs(up).argmin()])
            if toward:  # The seam is there, and shows that a boundary follows the whole surface.
                side = numbers(self._direction(toward))
                side = side - (side @ up) * up
            side /= np.linalg.norm(side)
            frame[:3, :3] = np.stack([side, np.cross(up, side), up], axis=1)
        radius, minor, slope = first_size, 0.0, 0.0
        if surface.type == BALL:
            radius, minor = 0.0, first_size
        elif surface.type == TORUS:
            minor = last_size
        elif surface.type == CONE:
            slope = math.tan(math.radians(last_size))
            # The angle is no size: it turns the lines of the cone.
            tilt += math.radians(self._text.rounding([sizes.pop()]))
        moved = self._text.rounding([*place, *sizes])
        return Quadric(matrix @ frame, radius, minor, slope), bool(axis and toward), moved, tilt

    def _swept_faces(
        self,
        surface: Entry,
        matrix: NDArray,
        boundaries: Sequence[Boundary],
        has_outer: bool,
        turning: float,
    ) -> list[Face]:
        """Return the parts of a surface that a curve sweeps."""
        local_patch, local_quadric = self._swept(surface)
        reach = float(lengths(local_patch.points).max())
        self._places.note_rounding(self._curves.take_rounding() + turning * reach)
        patches = bezier_surface(local_patch.transform(matrix), (None, None), False)
        # The file's parameters, such as an angle, are not those of the patches in exact form.
        in_space = [replace(boundary, parameters=None) for boundary in boundaries]
        quadric = local_quadric.transform(matrix) if local_quadric else None
        return _trimmed_faces(quadric, patches, in_space, has_outer, self._places.rounding)

    def _swept(self, surface: Entry) -> tuple[Patch, Quadric | None]:
        """Return a surface of revolution, a tabulated cylinder or a ruled surface, and the quadric
        that it is a part of.
        """
        fields = self._text.fields(surface)
        (first,) = integers(fields, 1)
        if surface.type == REVOLVED:
            return self._revolved(fields)
        if surface.type == EXTRUDED:
            profile = self._curve(first)
            self._places.note_rounding(self._text.rounding(fields[1:4]))
            shift = numbers(fields[1:4]) - profile.evaluate(profile.space.domain[:1])[0]
            return rule(profile, replace(profile, points=profile.points + shift)), None
        _, second, is_backward = integers(fields, 3)
        other = self._curve(second)
        return rule(self._curve(first), other.reverse() if is_backward else other), None

    def _revolved(self, fields: list[str]) -> tuple[Patch, Quadric | None]:
        """Return a surface of revolution, and the quadric that it is a part of."""
        axis_line, profile_pointer = integers(fields, 2)
        begin, end = self._curve(axis_line).evaluate([0.0, 1.0])
        profile = self._curve(profile_pointer)
        start, stop = numbers(fields[2:4]).tolist()
        angle_rounding = self._text.rounding(fields[2:4])
        if abs(stop - start - TURN) <= 4.0 * angle_rounding:
            stop = start + TURN
        else:
            arms = np.cross(profile.points - begin, end - begin) / np.linalg.norm(end - begin)
            self._places.note_rounding(angle_rounding * float(lengths(arms).max()))
        return (
            revolve(profile, begin, end - begin, start, stop),
            revolved_quadric(profile, begin, end - begin),
        )

    def _curve(self, pointer: int) -> Curve:
        """Return a curve that sweeps a surface, in one piece."""
        pieces = self._curves.read(pointer, np.eye(4))
        if not pieces:
            raise ValueError("a curve of another kind")
        return join_pieces(pieces)

    def _spline_faces(
        self,
        surface: Entry,
        matrix: NDArray,
        boundaries: Sequence[Boundary],
        has_outer: bool,
        turning: float,
    ) -> list[Face]:
        """Return the parts of a B-spline surface."""
        fields = self._text.fields(surface)
        patch, domain = _spline(fields, matrix)
        decimals = self._spline_rounding(fields, patch, matrix)
        self._places.note_rounding(decimals)
        reach = float(lengths(patch.points - matrix[:3, 3]).max())
        patches = bezier_surface(patch, domain, False)
        return _trimmed_faces(patch, patches, boundaries, has_outer, decimals + turning * reach)

    def _spline_rounding(self, fields: list[str], patch: Patch, matrix: NDArray) -> float:
        """Return the effect of the decimals of a surface's points and weights on its points."""
        count = patch.points.size // 3
        weights_start = 9 + sum(len(space.knots) for space in patch.spaces)
        points_start = weights_start + count
        points = fields[points_start : points_start + 3 * count]
        moved = float(np.linalg.norm(matrix[:3, :3], 2)) * self._text.rounding(points)
        if patch.weights is not None:
            weight_rounding = self._text.rounding(fields[weights_start:points_start])
            # A point is a mean of control points: it moves by twice its weights' share.
            share = weight_rounding / float(patch.weights.min())
            moved += 2.0 * share * patches_size([patch])
        return moved


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
    # Each attempt is a surface, and boundaries whose curves in space are to be used if known.
    attempts: list[tuple[Patch | Quadric, Sequence[Boundary]]] = [(patch, boundaries)]
    if isinstance(surface, Quadric):
        attempts.insert(0, (surface, boundaries))
    elif surface and all(boundary.curves and boundary.parameters for boundary in boundaries):
        attempts.append((patch, [replace(boundary, curves=None) for boundary in boundaries]))
        prefers_parameters = any(boundary.prefers_parameters for boundary in boundaries)
        if prefers_parameters and is_flat(patch, rounding):
            attempts.reverse()
    errors = []
    for base, base_boundaries in attempts:
        try:
            loops = [*outer, *loops_in_space(base_boundaries, surface)]
            # A face that goes beyond a seam of its surface has this seam among its boundaries.
            return [face_within(base, loops, rounding, seams)]
        except MeasureError as error:
            errors.append(error)
    raise errors[0]


def _spline(
    fields: list[str], matrix: NDArray
) -> tuple[Patch, tuple[tuple[float, float], tuple[float, float]]]:
    """Return a B-spline surface, placed by a (4, 4) matrix, and the domain of its used part."""
    last_s, last_t, degree_s, degree_t = integers(fields, 4)
    counts = (last_s + 1, last_t + 1)
    degrees = (degree_s, degree_t)
    if min(degrees) < 1:
        raise ValueError("degrees")
    knot_counts = [count + degree + 1 for count, degree in zip(counts, degrees)]
    total = counts[0] * counts[1]
    values = numbers(fields[9 : 9 + sum(knot_counts) + 4 * total + 4])
    s_knots, t_knots, weights, points, ends = np.split(
        values, np.cumsum([knot_counts[0], knot_counts[1], total, 3 * total])
    )
    # The first direction runs fastest.
    patch = placed_surface(
        (s_knots.tolist(), t_knots.tolist()),
        (degree_s + 1, degree_t + 1),
        points.reshape(*counts[::-1], 3).swapaxes(0, 1),
        weights.reshape(counts[::-1]).T,
        matrix,
    )
    return patch, ((float(ends[0]), float(ends[1])), (float(ends[2]), float(ends[3])))
