# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Boundaries of the faces of IGES files: curves on a surface (142), boundaries (141), and loops
(508) of edges (504).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..numerics import NDArray
from ..nurbs import Curve, Patch, Quadric, reverse_curves
from .findings import SURFACE_TRIMMED
from .iges_curves import CurveReader
from .iges_entities import Entry, IgesText, Places, integers
from .iges_types import BOUNDARY, CURVE_ON_SURFACE, EDGES, LOOP
from .surfaces import SurfaceRefusedError
from .trimmed import lifted

PREFERS_PARAMETERS = 1  # the flag of a curve on a surface
AGAINST_CURVE = 2  # the flag of a curve of a boundary that runs backward


@dataclass(frozen=True, eq=False)
class Boundary:
    """A closed boundary of a face: its curves in space, and in the surface's parameters; None if
    they are unknown. prefers_parameters: True if the file says so.
    """

    curves: list[Curve] | None = None
    parameters: list[Curve] | None = None
    prefers_parameters: bool = False


class BoundaryReader:
    """A reader of the boundaries of faces. A pointer is the number of an entity."""

    def __init__(self, text: IgesText, places: Places, curves: CurveReader) -> None:
        self._text = text
        self._places = places
        self._curves = curves

    def on_surface(self, pointer: int, surface: Entry, matrix: NDArray) -> Boundary:
        """Return the boundary given by a curve on a surface (142), unknown if the curve lies on
        another surface.
        """
        try:
            entry = self._text.entry(pointer, CURVE_ON_SURFACE)
        except (ValueError, LookupError):
            return Boundary()
        _, base, parameters, in_space, preferred = integers(self._text.fields(entry), 5)
        if base != surface.number:
            return Boundary()
        return Boundary(
            self._curves.read(in_space, matrix @ self._places.matrix(entry)),
            self._curves.read(parameters, None),
            preferred == PREFERS_PARAMETERS,
        )

    def of_curves(self, pointer: int, matrix: NDArray) -> Boundary:
        """Return a boundary (141)."""
        fields = self._text.fields(self._text.entry(pointer, BOUNDARY))
        (curve_count,) = integers(fields[3:], 1)
        in_space = []
        parameters = []
        # A curve has a pointer, its sense, and a count of curves in parameters, which follow.
        at = 4
        for _ in range(curve_count):
            curve, sense, parameter_count = integers(fields[at:], 3)
            pieces = self._curves.read(curve, matrix)
            in_space.append(reverse_curves(pieces) if pieces and sense == AGAINST_CURVE else pieces)
            pointers = integers(fields[at + 3 :], parameter_count)
            # None: a curve without parameters leaves those of the boundary unknown.
            parameters += self._parameter_curves(pointers) or [None]
            at += 3 + parameter_count
        return Boundary(_join_curves(in_space), _join_curves(parameters))

    def of_edges(self, pointer: int, matrix: NDArray) -> Boundary:
        """Return a loop (508); edges that are a vertex, such as a pole, have no curve in space."""
        entry = self._text.entry(pointer, LOOP)
        fields = self._text.fields(entry)
        matrix = matrix @ self._places.matrix(entry)
        (edge_count,) = integers(fields, 1)
        in_space = []
        parameters = []
        # A use of an edge has five numbers, then pairs of a flag and a curve in parameters.
        at = 1
        for _ in range(edge_count):
            is_vertex, edges, index, is_forward, parameter_count = integers(fields[at:], 5)
            pointers = integers(fields[at + 5 :], 2 * parameter_count)[1::2]
            if not is_vertex:
                in_space.append(self._edge(edges, index, bool(is_forward), matrix))
            if parameter_count or not is_vertex:
                parameters += self._parameter_curves(pointers) or [None]
            at += 5 + 2 * parameter_count
        return Boundary(_join_curves(in_space), _join_curves(parameters))

    def _parameter_curves(self, pointers: Sequence[int]) -> list[list[Curve] | None]:
        return [self._curves.read(pointer, None) for pointer in pointers]

    def _edge(
        self, pointer: int, index: int, is_forward: bool, matrix: NDArray
    ) -> list[Curve] | None:
        """Return an edge of a list, by its index from 1, in the direction of its use."""
        entry = self._text.entry(pointer, EDGES)
        curve = 0  # no entity: an unknown curve
        if index > 0:
            # An edge has five numbers, the first of which points to its curve.
            (curve,) = integers(self._text.fields(entry)[1 + 5 * (index - 1) :], 1)
        curves = self._curves.read(curve, matrix @ self._places.matrix(entry))
        return reverse_curves(curves) if curves and not is_forward else curves


def loops_in_space(
    boundaries: Sequence[Boundary], surface: Patch | Quadric | None
) -> list[list[Curve]]:
    """Return the curves of boundaries in space, through points of the surface of their parameters
    if they are known in these alone; SurfaceRefusedError if they are not known at all.
    """
    loops = [
        boundary.curves
        or (lifted(surface, boundary.parameters) if surface and boundary.parameters else [])
        for boundary in boundaries
    ]
    if not all(loops):
        raise SurfaceRefusedError(SURFACE_TRIMMED)
    return loops


def _join_curves(parts: Sequence[list[Curve] | None]) -> list[Curve] | None:
    """Return the curves of all parts in turn, None if one is unknown."""
    curves: list[Curve] = []
    for part in parts:
        if part is None:
            return None
        curves += part
    return curves
