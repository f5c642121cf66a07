# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A body of patches that is measured again and again while its control points move.

What measuring decided (which patches face which way, which rims are capped) is kept as long as its patches close in the
same manner; then only the moments follow, from tables (`reevaluation`), and where few control points have moved only
the spans that they act on. The tables' rule for rational patches is fixed and has no estimate of its own: how far it is
off depends on the weights, so it is compared with what measuring found, and other weights are measured anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .closure import Closure, close_patches
from .moments import Moments, monomials, sum_moments
from .patch import Patch
from .patch_moments import volume_moments
from .patch_solid import PatchMeasure, measure_patches, patches_size
from .reevaluation import Evaluator
from .weld import TOLERANCE

FEW = 6  # moved control points that are updated one by one
COARSE = 1e-10  # of the largest that a moment could be: a rule that is off by more does not follow
GROWS = 8.0  # by how much moved control points may let the rule's error grow: an estimate


class FollowedBody:
    """The body that patches bound. measure: as it was when all was decided. volume: its Moments to order 3 as it is,
    their bounds those of when all was decided. area: of the patches, an approximation."""

    def __init__(self, patches: Sequence[Patch], stored: float = 0.0):
        self._decide(patches, stored)

    def _decide(self, patches: Sequence[Patch], stored: float) -> None:
        self.measure: PatchMeasure = measure_patches(patches, stored=stored)
        self.volume, self.area = self.measure.volume, self.measure.area.total
        self._patches = list(patches)
        self._evaluators = [Evaluator(patch, 3, self.volume.about) for patch in patches]
        self._fluxes = [evaluator.moments(patch.points, patch.weights)
                        for evaluator, patch in zip(self._evaluators, patches)]
        self._off = np.zeros_like(self.volume.raw)
        self._follows = self.measure.method != "open"
        if self._follows and any(patch.weights is not None for patch in patches):
            largest = patches_size(patches) ** (monomials(3).sum(axis=1) + 1.0) * self.area
            # The worst of all moments stands for each: of a symmetric body one may be right by chance.
            off = float((np.abs(self._sum(self.measure.closure).raw - self.volume.raw) / largest).max())
            self._off, self._follows = GROWS * off * largest, off <= COARSE

    def follow(self, patches: Sequence[Patch], stored: float = 0.0) -> bool:
        """Measure the patches as they are now; whether what was decided before still holds."""
        if not self._follows or not self._same_spaces(patches):
            self._decide(patches, stored)
            return False
        tolerance = max(TOLERANCE * patches_size(patches), 4.0 * stored)
        closure = close_patches(patches, tolerance)
        if not _alike(closure, self.measure.closure):
            self._decide(patches, stored)
            return False
        self._fluxes = [self._flux(k, patch) for k, patch in enumerate(patches)]
        volume = self._sum(closure)
        if not volume.total > 0.0:
            self._decide(patches, stored)
            return False
        # The bounds are those of when all was decided: an estimate for what has moved since.
        self.volume = replace(volume, error=self.measure.volume.error + self._off, input=self.measure.volume.input)
        self.area = sum(evaluator.area for evaluator in self._evaluators)
        self._patches = list(patches)
        return True

    def _sum(self, closure: Closure) -> Moments:
        """What the patches' fluxes and the caps of their holes add up to."""
        parts = [flux * float(sign) for flux, sign in zip(self._fluxes, self.measure.signs)]
        for loop in closure.loops:
            sign = self.measure.signs[loop.patch] * (-1.0 if closure.turned[loop.patch] else 1.0)
            parts.append(volume_moments(loop.caps, 3, self.volume.about)[0] * float(sign))
        return sum_moments(parts)

    def _same_spaces(self, patches: Sequence[Patch]) -> bool:
        """Whether their function spaces are the same, those of rational patches being made by their weights too."""
        return len(patches) == len(self._patches) and all(
            new.spaces == old.spaces and (new.weights is None if old.weights is None
                                          else np.array_equal(new.weights, old.weights))
            for new, old in zip(patches, self._patches))

    def _flux(self, k: int, patch: Patch) -> Moments:
        old = self._patches[k]
        rows = np.argwhere((patch.points != old.points).any(axis=2))
        if not len(rows):
            return self._fluxes[k]
        if len(rows) > FEW:
            return self._evaluators[k].moments(patch.points, patch.weights)
        for i, j in rows:
            weight = 1.0 if patch.weights is None else float(patch.weights[i, j])
            found = self._evaluators[k].move(int(i), int(j), patch.points[i, j], weight)
        return found


def _alike(one: Closure, other: Closure) -> bool:
    """Whether patches close in the same manner."""
    return (np.array_equal(one.component, other.component) and np.array_equal(one.turned, other.turned)
            and np.array_equal(one.broken, other.broken)
            and [(loop.patch, loop.slim) for loop in one.loops] == [(loop.patch, loop.slim) for loop in other.loops])
