# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A body of patches that is measured again and again while its control points move.

Orientation and caps are decided anew each time, as in `measure_patches`; only the moments come from
tables (`IncrementalPatchMoments`). For rational patches the tables' rule is fixed and has no error
estimate. Its error depends on the weights, so the rule is compared with the measured moments of the
body, and of patches with its weights and random points, because a flat body says little about later
shapes. If the weights change, or the body moves far from the reference point of its moments,
everything is measured anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from ..moments.raw import Measure, Moments, monomials, sum_moments
from ..numerics import Array, NDArray, SplineSpace
from ..verdict import Procedure, welding_tolerance
from .bezier import MAX_CELLS, cells_of_nets
from .patch_moments import area_slope, exact_points, flux_sums, integrand_in_blocks, volume_moments
from .patch_topology import PatchTopology, find_topology
from .solid import PatchIntegrals, assess, measure_patches, oriented_parts
from .splines import Patch, homogeneous, patches_center, patches_size

MAX_RULE_ERROR = (
    1e-10  # Relative to the largest possible moment: rules with larger errors are not used.
)
RULE_ERROR_GROWTH = 8.0  # Estimated growth of the rule's error as control points move.
RATIONAL_GAUSS_POINTS = 16  # Gauss points in a span of a rational patch


class TrackedSolid:
    """The body that patches bound, measured again while control points move; stored: as for
    `measure_patches`.

    `measure`: the current measurement, with volume moments to order 3. After an `update` from
    tables its error bounds are estimates, and the area is an approximation. `_error` and
    `_area_error` are relative to the largest moments and to the area.
    """

    def __init__(self, patches: Sequence[Patch], stored: float = 0.0):
        self._measure_anew(patches, stored)

    def _measure_anew(self, patches: Sequence[Patch], stored: float) -> None:
        """Measure the patches exactly, and prepare the tables for updates if they are closed.

        The tables are tried at once, which needs all other attributes: they count as long as they
        come near the exact moments.
        """
        self.measure: PatchIntegrals = measure_patches(patches, stored=stored)
        self._is_tracking = self.measure.method is not Procedure.OPEN
        if not self._is_tracking:
            return
        volume = self.measure.volume
        area = self.measure.area
        self._slope = area_slope(patches)
        self._fixed = _fixed_part(patches)
        self._evaluators = [IncrementalPatchMoments(patch, 3, volume.about) for patch in patches]
        self._fluxes = [
            evaluator.moments(patch.points) for evaluator, patch in zip(self._evaluators, patches)
        ]
        largest = _largest_moments(patches, volume.about, area.total)
        self._error = volume.rounding_error / largest
        self._area_error = area.rounding_error[:1] / area.total
        if any(patch.weights is not None for patch in patches):
            tables = self._assess(patches, self.measure.topology, stored).volume
            # The worst of all moments stands for each, because a symmetric body may have a single
            # one right by chance.
            off = float((np.abs(tables.raw - volume.raw) / largest).max())
            off = max(
                [off]
                + [_rule_error_at_random(patch) for patch in patches if patch.weights is not None]
            )
            self._error = self._error + RULE_ERROR_GROWTH * off
            self._is_tracking = off <= MAX_RULE_ERROR

    def update(self, patches: Sequence[Patch], stored: float = 0.0) -> bool:
        """Measure the patches in their current shape; return True if tables sufficed, False if all
        is measured anew.
        """
        size = patches_size(patches)
        about = self.measure.volume.about
        if not (
            self._is_tracking
            and _fixed_part(patches) == self._fixed
            and np.linalg.norm(patches_center(patches) - about) <= size
        ):
            self._measure_anew(patches, stored)
            return False
        self._fluxes = [
            evaluator.moments(patch.points) for evaluator, patch in zip(self._evaluators, patches)
        ]
        measure = self._assess(
            patches, find_topology(patches, welding_tolerance(size, stored)), stored
        )
        if measure.method is Procedure.OPEN:
            self._measure_anew(patches, stored)
            return False
        self.measure = measure
        return True

    def _assess(
        self, patches: Sequence[Patch], topology: PatchTopology, stored: float
    ) -> PatchIntegrals:
        """Return the measurement of the present fluxes of all patches, with the decisions of
        `measure_patches`.
        """
        about = self.measure.volume.about
        total = sum(evaluator.area for evaluator in self._evaluators)
        area = Moments(np.array([total]), about, Measure.AREA, self._area_error * total)
        fluxes: list[list[Moments]] = [[] for _ in range(topology.number)]
        for flux, turn, part in zip(self._fluxes, topology.flipped, topology.component):
            fluxes[part].append(flux * -1.0 if turn else flux)
        for loop in topology.loops:
            fluxes[loop.component].append(volume_moments(loop.caps, 3, about)[0])
        measure = assess(
            patches,
            topology,
            oriented_parts(patches, topology),
            [(sum_moments(part), True) for part in fluxes],  # A fixed rule has nothing to converge.
            area,
            self._slope,
            stored,
        )
        error = self._error * _largest_moments(patches, about, total)
        return replace(measure, volume=replace(measure.volume, rounding_error=error))


def _fixed_part(patches: Sequence[Patch]) -> list[tuple[tuple[SplineSpace, SplineSpace], bytes]]:
    """Return the function spaces and the weights of patches, which must stay as they are."""
    return [
        (patch.spaces, b"" if patch.weights is None else patch.weights.tobytes())
        for patch in patches
    ]


def _largest_moments(patches: Sequence[Patch], about: NDArray, area: float) -> Array:
    """Return (K,) upper bounds of the moments of a body."""
    reach = max(
        float(np.sqrt(((patch.points - about) ** 2).sum(axis=2).max())) for patch in patches
    )
    return np.asarray(area * reach ** (monomials(3).sum(axis=1) + 1.0), np.float64)


def _rule_error_at_random(patch: Patch) -> float:
    """Return the error of the tables' rule for a patch's weights and random points, relative to the
    largest moment.
    """
    points = np.random.default_rng(0).uniform(-1.0, 1.0, patch.points.shape)
    perturbed = replace(patch, points=points)
    about = np.zeros(3)
    evaluator = IncrementalPatchMoments(perturbed, 3, about)
    off = np.abs(evaluator.moments(points).raw - volume_moments([perturbed], 3, about)[0].raw)
    return float((off / _largest_moments([perturbed], about, evaluator.area)).max())


class IncrementalPatchMoments:
    """Moments of a patch in a fixed function space and with fixed weights, its control points free
    to move.

    Only the matrices from control points to Bézier ones (`bezier`) are precomputed: the integrals
    of products of basis functions Φ of Soldea, Elber and Rivlin (section 3) need up to 10,000 times
    as much memory. Gauss rules are exact for polynomial patches; for rational ones there is no
    error estimate. `area` is the area of the patch as last evaluated, an approximation by the same
    points.
    """

    def __init__(self, patch: Patch, order: int, about: NDArray):
        self.spaces = patch.spaces
        self.weights = patch.weights
        self.about = about
        s_rule, t_rule = (
            (exact_points(space.order, order) if self.weights is None else RATIONAL_GAUSS_POINTS,)
            for space in self.spaces
        )
        self._rule = s_rule, t_rule
        self._flux = partial(flux_sums, order=order, area=True)
        self._divisor = monomials(order).sum(axis=1) + 3.0
        self._points = np.full_like(patch.points, np.nan)
        self._anchor = about
        self._sums = np.zeros(
            (len(self._divisor) + 1, *(len(space.spans) for space in self.spaces))
        )
        self.area = 0.0

    def moments(self, points: NDArray) -> Moments:
        """Return the patch's flux as moments; only spans on which moved control points act are
        evaluated anew.
        """
        moved = (points != self._points).any(axis=2)
        self._points = points.copy()
        if moved.all():
            self._anchor = self._points[0, 0]
        net = homogeneous(self._points - self._anchor, self.weights)
        anchor = (self._anchor - self.about)[None]
        s_spans, t_spans = (
            np.flatnonzero(moved.any(axis=1 - axis)[space.active_controls].any(axis=1))
            for axis, space in enumerate(self.spaces)
        )
        step = max(1, MAX_CELLS // max(1, len(t_spans)))
        for start in range(0, len(s_spans) if len(t_spans) else 0, step):
            spans = s_spans[start : start + step], t_spans
            # A fixed rule needs neither the constant weights nor the reach.
            cells = cells_of_nets(net[None], anchor, self.spaces, spans, (False, False), 0.0)
            sums = integrand_in_blocks(cells, self._rule, self._flux)[0]
            self._sums[:, spans[0][:, None], t_spans] = sums.reshape(len(sums), len(spans[0]), -1)
        total = np.add.reduce(self._sums, axis=(1, 2))
        self.area = float(total[-1])
        return Moments(total[:-1] / self._divisor, self.about)
