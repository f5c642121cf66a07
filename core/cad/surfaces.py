# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The contents of a file of surfaces: bodies of patches, and the names of refused surfaces;
surfaces of revolution.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..files import FILE_TOO_LARGE, FILE_WITHOUT_OBJECTS
from ..numerics import Array, ArrayLike, NDArray, SplineSpace, clamped_space
from ..nurbs import (
    CONTROL_POINTS_INVALID,
    NON_FINITE,
    NON_POSITIVE_WEIGHTS,
    TURN,
    Curve,
    Face,
    Patch,
    bezier_patches,
)
from ..verdict import FileError, Finding, MeasureError, finding, truncate_findings
from .findings import (
    NO_SURFACE_KEPT,
    SURFACE_BEYOND_LIMIT,
    SURFACE_DAMAGED,
    SURFACE_POINTS,
)
from .sweeps import join_pieces, revolve

MISSING = "a reference to an entity that is not in the file"
RECURSION = "references to itself, or nested too deeply"
MAX_ORDER = 6  # largest order of the surfaces that are kept
MAX_POINTS = 1 << 18  # control points of one patch in Bézier form
MAX_SURFACES = 10_000  # surfaces placed by a file
MAX_TOTAL_POINTS = 1 << 22  # Control points of all patches of a file.
MAX_NAMES = 1000  # names in a refusal
MAX_REASONS = 8  # reasons in one refusal
MAX_COORDINATE = 3e38  # Just below the largest float32.


@dataclass(frozen=True, eq=False)
class SurfaceBody:
    """Faces of one object in a file, in the file's unit; patches for Blender's flags *Bézier* and
    *Endpoint*.

    rounding: largest effect of the file's decimals on a point. color: red, green and blue in sRGB.
    source: returns the compressed file of this body alone, which `matrix` (4, 4) places.
    """

    name: str
    patches: tuple[Face, ...]
    rounding: float = 0.0
    color: tuple[float, ...] | None = None
    source: Callable[[], bytes] | None = None
    matrix: Array | None = None


@dataclass(frozen=True, eq=False)
class SurfaceFile:
    """The surfaces of a file. unit: m, None if it is not stated. refused: the reasons, with the
    names of surfaces.

    unread: the number of surfaces that could not be kept.
    """

    bodies: tuple[SurfaceBody, ...]
    unit: float | None = None
    refused: tuple[Finding, ...] = ()
    notes: tuple[Finding, ...] = ()
    unread: int = 0


class SurfaceRefusedError(MeasureError):
    """A surface that cannot be kept: a finding without the surface's kind and name."""


def refuse(fault: str) -> SurfaceRefusedError:
    """Return the refusal of a surface or another entity for a fault."""
    return SurfaceRefusedError(SURFACE_DAMAGED, fault=fault)


def reason(error: Exception) -> tuple[str, Mapping[str, Any]]:
    """Return a finding's code and values for an error that reading an entity raised."""
    if isinstance(error, SurfaceRefusedError):
        return error.finding.code, error.finding.values
    if isinstance(error, MeasureError):
        # Other errors of measurements can only be about the control points here.
        return SURFACE_POINTS, {"cause": error.finding}
    is_missing = isinstance(error, KeyError) and isinstance(error.args[0], int)
    fault = MISSING if is_missing else "numbers that are missing or not possible"
    return SURFACE_DAMAGED, {"fault": fault}


@dataclass
class Refusals:
    """Surfaces that could not be kept, gathered by reason and kind."""

    # Names of surfaces by the code of a finding, their kind, and the items of its other values.
    names: dict[tuple, list[str]] = field(default_factory=dict)
    points: int = 0  # points of all patches that were kept

    def keep(self, kind: str, name: str, make: Callable[[], list[Face]]) -> list[Face]:
        """Return the patches of a surface; note a refusal, and return no patches then. kind, name:
        for messages.
        """
        points_before = self.points
        try:
            patches = make()
        except FileError:
            raise
        except (MeasureError, ValueError, OverflowError, LookupError) as error:
            code, values = reason(error)
            self.add(code, kind, name, **values)
            return []
        # A nested call for other surfaces of this file has counted their points.
        self.points = max(
            self.points, points_before + sum(patch.points.size // 3 for patch in patches)
        )
        if self.points > MAX_TOTAL_POINTS:
            raise FileError(FILE_TOO_LARGE, limit=MAX_TOTAL_POINTS, content="control points")
        return patches

    def add(self, code: str, kind: str, name: str, **values: object) -> None:
        """Note that one surface, or another entity, was refused, with the finding's code and
        values.
        """
        self.names.setdefault((code, kind, tuple(values.items())), []).append(name)

    def file(
        self,
        bodies: Sequence[SurfaceBody],
        unit: float | None = None,
        notes: Sequence[Finding] = (),
    ) -> SurfaceFile:
        """Return the file's bodies with patches, and its refusals.

        FileError if no body has patches.
        """
        refused = []
        kept = tuple(body for body in bodies if body.patches)
        # One finding for each reason and kind.
        for (code, kind, reason_values), names in self.names.items():
            values = dict(reason_values)
            if "cause" in values:
                values["cause"] = values["cause"].as_record()
            refused.append(
                finding(code, kind=kind, count=len(names), names=names[:MAX_NAMES], **values)
            )
        if not kept and refused:
            causes = [cause.as_record() for cause in truncate_findings(refused, MAX_REASONS)]
            raise FileError(NO_SURFACE_KEPT, causes=causes)
        if not kept:
            raise FileError(FILE_WITHOUT_OBJECTS, content="surfaces")
        return SurfaceFile(
            kept, unit, tuple(refused), tuple(notes), sum(map(len, self.names.values()))
        )


def placed_surface(
    knots: tuple[Sequence[float], Sequence[float]],
    orders: tuple[int, int],
    points: ArrayLike,
    weights: Array | None,
    matrix: NDArray,
) -> Patch:
    """Return a surface with any knots; ValueError if its data are inconsistent.

    points: (count_s, count_t, 3), weights: (count_s, count_t) or None, matrix: (4, 4) from the
    points to the file's coordinates.
    """
    points = np.asarray(points, np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    if not (np.abs(points) < MAX_COORDINATE).all():
        raise SurfaceRefusedError(
            SURFACE_POINTS, cause=finding(CONTROL_POINTS_INVALID, fault=NON_FINITE)
        )
    s_space, t_space = (
        SplineSpace(tuple(np.asarray(row, np.float64).tolist()), order, count)
        for row, order, count in zip(knots, orders, points.shape)
    )
    return Patch((s_space, t_space), points, weights)


def bezier_surface(
    surface: Patch,
    domain: tuple[tuple[float, float] | None, tuple[float, float] | None],
    for_blender: bool,
) -> list[Patch]:
    """Return a part of a surface as Bézier patches. for_blender: refuse patches that Blender cannot
    hold.
    """
    order = max(space.order for space in surface.spaces)
    if for_blender and order > MAX_ORDER:
        raise SurfaceRefusedError(
            SURFACE_BEYOND_LIMIT, quantity="order", value=order, limit=MAX_ORDER
        )
    sizes = [len(space.spans) * (space.order - 1) + 1 for space in surface.spaces]
    if sizes[0] * sizes[1] > MAX_POINTS:
        raise SurfaceRefusedError(
            SURFACE_BEYOND_LIMIT,
            quantity="number of control points",
            value=sizes[0] * sizes[1],
            limit=MAX_POINTS,
        )
    patches = bezier_patches(surface, domain)
    if for_blender and not all(map(is_storable, patches)):
        raise SurfaceRefusedError(
            SURFACE_POINTS, cause=finding(CONTROL_POINTS_INVALID, fault=NON_POSITIVE_WEIGHTS)
        )
    return patches


def is_storable(face: Face) -> bool:
    """Return whether Blender's splines can hold a face: a patch of a low order, whose weights are
    positive in float32.
    """
    return (
        isinstance(face, Patch)
        and max(space.order for space in face.spaces) <= MAX_ORDER
        # With margin above the smallest float32, 1e-38, for weights relative to the largest.
        and (face.weights is None or bool(face.weights.min() >= 1e-30 * face.weights.max()))
    )


def revolved_solid(
    bottom: float, top: float, height: float, axis: str, is_round: bool
) -> Patch | None:
    """Return a solid's surface about an axis "X", "Y" or "Z", facing outward, or None if it has no
    volume.

    bottom, top: the radii at the ends of its straight part, which is `height` long; with a negative
    height the ends change places. is_round: whether half balls close it, not disks. Other axes are
    taken as Z.
    """
    bottom, top = (abs(top), abs(bottom)) if height < 0.0 else (abs(bottom), abs(top))
    half = abs(height) / 2.0
    if not (
        math.isfinite(bottom + top + half) and max(bottom, top) > 0.0 and (half > 0.0 or is_round)
    ):
        return None
    # Radius and height at the ends of the three curves of the profile.
    ends = [
        (0.0, -half - bottom * is_round),
        (bottom, -half),
        (top, half),
        (0.0, half + top * is_round),
    ]
    profile = []
    for begin, end, is_arc in zip(ends[:-1], ends[1:], (is_round, False, is_round)):
        if begin != end:
            # The middle control point of a quarter of a circle is the meet of its tangents.
            outer, inner = max(begin, end), min(begin, end)
            middle = (outer[0], inner[1]) if is_arc else np.mean([begin, end], axis=0)
            points = np.insert([begin, middle, end], 1, 0.0, axis=1)
            weights = np.array([1.0, math.sqrt(0.5) if is_arc else 1.0, 1.0])
            profile.append(Curve(clamped_space(3), points, weights))
    solid = revolve(join_pieces(profile), np.zeros(3), np.eye(3)[2], 0.0, TURN)
    # Rotated so that the third axis becomes the wanted one.
    points = np.roll(solid.points, max("ZXY".find(axis), 0), axis=2)
    return replace(solid, points=points).reverse_orientation()
