# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inertials that no non-negative density within a hull can have.

A mass is positive. The second moments S = tr(I)/2 - I are no less than zero in any direction, which
is the triangle inequality of the principal moments. The center lies in the convex hull. Along any
direction n, in which the hull reaches from a to b, the variance of the mass is at most (b -
mean)(mean - a) (Bhatia and Davis, Amer. Math. Monthly 107, 2000). All of these are necessary; an
inertial that breaks one is impossible for any density.

No matter is denser than osmium. Let s = S/m be the second moments per kilogram about the center.
The mean of xᵀs⁻¹x over the mass is tr(s⁻¹s) = 3. With x = √s y, it is the mean of |y|². Among the
bodies of mass m and at most density ρ, that mean is least for the ball |y| <= R of density ρ: mass
moved into it from outside comes nearer (the bathtub principle). The ball has the mass
ρ √(det s) (4/3)πR³ and the mean 3R²/5. So 3R²/5 <= 3, R² <= 5, and m/ρ <= (4/3)π √(125 det s).
Digits that were rounded away may hide a thickness: before the comparison, each eigenvalue of s is
raised by the rounding of the largest moment. So of nearly flat or thin tensors only a mass that is
too dense for that thickness is decided.
"""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from ..numerics import Array, NDArray, second_of_inertia, spread_directions
from ..verdict import Finding, finding
from .findings import (
    INERTIAL_CENTER_OUTSIDE,
    INERTIAL_NOT_FINITE,
    INERTIAL_NOT_POSITIVE,
    INERTIAL_SPREAD_OUTSIDE,
    INERTIAL_TOO_DENSE,
    INERTIAL_TRIANGLE,
    INERTIAL_TRIANGLE_SLIGHTLY,
)
from .stated import StatedInertial

ROUNDING = 1e-3  # Relative excess that numbers printed with few digits may cause.
# SI units: products of two such numbers stay in the range of float64.
LEAST_MASS = 1e-60
LARGEST = 1e60
ZERO_RTOL = 1e-14  # Relative to the largest moment: zero after finding the principal axes.
CENTER_RTOL = 1e-3  # Relative to the hull's size.
SPREAD_RTOL = 5e-3
OSMIUM = 22_590.0  # kg/m³
MAX_STEPS = 200  # towards the nearest point of a hull
DIRECTIONS = 400


@dataclass(frozen=True, eq=False)
class Hull:
    """Points (n, 3) along a link's axes, in m, with a convex hull that contains the link's mass."""

    points: Array

    @property
    def size(self) -> float:
        """The diagonal of the points' bounding box, m."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0)))

    def distance(self, point: NDArray) -> float:
        """Return a lower bound, proven by a separating plane, of a point's distance from the hull
        in m, zero within.

        Wolfe's algorithm (Math. Programming 11, 1976): find the nearest point of the hull of at
        most four points, and exchange them until the plane through that nearest point has all
        points of the hull behind it.
        """
        shifted = self.points - point
        chosen = [int(np.argmin((shifted**2).sum(axis=1)))]
        shares = np.ones(1)
        bound = 0.0
        for _ in range(MAX_STEPS):
            nearest = shares @ shifted[chosen]
            length = float(np.linalg.norm(nearest))
            if length <= 1e-12 * self.size:  # Rounding: the point is in the hull.
                return 0.0
            heights = shifted @ nearest
            lowest = int(np.argmin(heights))
            bound = max(bound, float(heights[lowest]) / length)
            # No point is nearer, or the bound is known to nine digits: chosen, as tolerances are
            # 1e-3.
            if lowest in chosen or length - heights[lowest] / length <= 1e-9 * self.size:
                break
            chosen, shares = _nearest_shares(shifted, [*chosen, lowest], np.append(shares, 0.0))
        return bound


def impossible(stated: StatedInertial, hull: Hull | None) -> list[Finding]:
    """Return all reasons why no body, or no body within a known hull, has an inertial; empty if it
    is possible.
    """
    numbers = np.concatenate([[stated.mass], stated.center, stated.inertia.ravel()])
    if not (np.abs(numbers) <= LARGEST).all():
        return [finding(INERTIAL_NOT_FINITE)]
    findings = []
    if not stated.mass > LEAST_MASS:
        findings.append(
            finding(INERTIAL_NOT_POSITIVE, part="mass", value=float(stated.mass), unit="kg")
        )
    if stated.mass or stated.inertia.any():  # A mere placeholder has one fault.
        findings += _impossible_tensor(stated.inertia, stated.mass)
    if hull is None:
        return findings
    distance = hull.distance(stated.center)
    is_outside = distance > CENTER_RTOL * hull.size
    if is_outside:
        findings.append(finding(INERTIAL_CENTER_OUTSIDE, distance=distance))
    if all(one.code in (INERTIAL_TRIANGLE_SLIGHTLY, INERTIAL_CENTER_OUTSIDE) for one in findings):
        findings += _excess_spread(stated, hull, is_outside)
    return findings


def least_density(mass: float, moments: NDArray) -> float:
    """Return the least density of a body of this mass and (3,) ascending moments, in kg/m³, by the
    bound above.
    """
    spreads = np.maximum(moments.sum() / 2.0 - moments, 0.0) + ROUNDING * moments[2]
    # Roots before the product: it stays in the range of float64.
    first, second, third = map(sqrt, (spreads / mass).tolist())
    return mass / (4.0 / 3.0 * pi * sqrt(125.0) * first * second * third)


def _impossible_tensor(inertia: NDArray, mass: float) -> list[Finding]:
    """Return the reason why no body of a mass has a (3, 3) tensor; empty if one may have it."""
    moments = np.linalg.eigvalsh(inertia)
    if not moments[0] > ZERO_RTOL * moments[2]:
        moment = 0.0 if abs(moments[0]) <= ZERO_RTOL * abs(moments[2]) else float(moments[0])
        return [
            finding(
                INERTIAL_NOT_POSITIVE, part="least principal moment", value=moment, unit="kg·m²"
            )
        ]
    excess = float(moments[2] / (moments[0] + moments[1]) - 1.0)
    if excess > ROUNDING:
        return [finding(INERTIAL_TRIANGLE, moments=moments.tolist(), excess=excess)]
    density = least_density(mass, moments) if mass > LEAST_MASS else 0.0
    if density > OSMIUM:
        return [finding(INERTIAL_TOO_DENSE, density=density, limit=OSMIUM)]
    # A flat body's excess is 0 up to the rounding of float64.
    return [finding(INERTIAL_TRIANGLE_SLIGHTLY, excess=excess)] if excess > 1e-12 else []


def _nearest_shares(points: NDArray, chosen: list[int], shares: NDArray) -> tuple[list[int], Array]:
    """Drop chosen points until the foot from zero on their plane is in their hull; return their
    indices and shares.
    """
    while True:
        corners = points[chosen]
        # The foot on the plane through them, as shares of the corners that add up to one.
        rest = np.linalg.lstsq((corners[1:] - corners[0]).T, -corners[0], rcond=None)[0]
        wanted = np.append(1.0 - rest.sum(), rest)
        if (wanted > 0.0).all():
            return chosen, wanted
        # Go towards the foot until the first falling share is zero.
        falls = wanted <= 0.0
        rates = np.maximum(shares[falls] - wanted[falls], np.finfo(float).tiny)
        shares = shares + float((shares[falls] / rates).min()) * (wanted - shares)
        stays = shares > 1e-14  # False for at least that share, which is zero to rounding.
        chosen = [index for index, is_used in zip(chosen, stays) if is_used]
        shares = shares[stays] / shares[stays].sum()


def _excess_spread(stated: StatedInertial, hull: Hull, is_outside: bool) -> list[Finding]:
    """Return the reason why no body within the hull has a possible tensor, empty if one may have
    it. is_outside: True if the stated center is not in the hull.
    """
    second = second_of_inertia(stated.inertia) / stated.mass
    directions = np.concatenate([np.linalg.eigh(second)[1].T, spread_directions(DIRECTIONS)])
    # Along the axes that the tensor itself has, and (k, 3) others.
    variance = np.einsum("ki,ij,kj->k", directions, second, directions)
    heights = (hull.points - stated.center) @ directions.T
    if is_outside:  # Half of the mass at either end has the largest variance about any center.
        limit = (np.ptp(heights, axis=0) / 2.0) ** 2
    else:
        limit = np.maximum(heights.max(axis=0), 0.0) * np.maximum(-heights.min(axis=0), 0.0)
    # The center may be off by its own tolerance.
    tolerance = SPREAD_RTOL * limit + CENTER_RTOL * hull.size**2
    worst = int(np.argmax((variance - limit) / (limit + tolerance)))
    if variance[worst] > limit[worst] + tolerance[worst]:
        factor = float(variance[worst] / max(limit[worst], tolerance[worst]))
        return [
            finding(INERTIAL_SPREAD_OUTSIDE, factor=factor, direction=directions[worst].tolist())
        ]
    return []
