# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of primitives, in closed form; and primitives with the mass, center and inertia of a
body.

Twice the second moments of a body along its principal axes are q_i = I_j + I_k - I_i = 2 ∫x_i² dm.
A box has ∫x_i² dm = m s_i²/12 and an ellipsoid m a_i²/5, so each body has one of each. A capsule
has two parameters for three moments: it takes the mean of the two across its axis.
"""

from math import pi, sqrt

import numpy as np

from ..moments.raw import Moments
from ..numerics import Array, NDArray
from ..polyhedron import integrate
from .model import Inertial, Pose, Shape, second_moments

LEAST_SPREAD = float(np.finfo(np.float64).eps)  # Relative to the largest one.
BISECTIONS = 200  # more than the digits of a float64 need: then both bounds stay


def box_sides(mass: float, moments: NDArray) -> Array:
    """Return the (3,) sides s_i = sqrt(6 (I_j + I_k - I_i) / m) of the box of this mass and these
    principal moments.
    """
    return np.sqrt(6.0 * _spreads(moments) / mass)


def ellipsoid_axes(mass: float, moments: NDArray) -> Array:
    """Return the (3,) semi-axes a_i = sqrt(5 (I_j + I_k - I_i) / (2 m)) of the ellipsoid of these
    principal moments.
    """
    return np.sqrt(2.5 * _spreads(moments) / mass)


def capsule_size(mass: float, moments: NDArray) -> tuple[float, float]:
    """Return radius and length, without its caps, of the capsule along the first principal axis;
    moments ascend.

    It has the least moment along its axis and the mean of the others across it, if possible; else
    it is a ball. With the ratio t of L to r and r = 1, V is π(t + 4/3), and ∫x² dV is
    π(t/4 + 4/15) across and π(t³/12 + t²/3 + t/2 + 4/15) along the axis. Their ratio grows with t
    from 1, the ratio of a ball.
    """
    along = (moments[1] + moments[2] - moments[0]) / 2.0  # ∫x² dm
    across = max(moments[0] / 2.0, LEAST_SPREAD * along)
    if not along > across:
        return sqrt(5.0 * float(moments.mean()) / (2.0 * mass)), 0.0
    ratio = along / across
    # The ratio of any capsule is larger than its t, so that the wanted t is below the wanted ratio.
    low = 0.0
    high = ratio
    for _ in range(BISECTIONS):
        t = (low + high) / 2.0
        wide, far = _capsule(t)
        low, high = (t, high) if far < ratio * wide else (low, t)
    t = (low + high) / 2.0
    # The mass m has ∫x² dm = m r² (∫x² dV)/V across, with the latter two at the radius 1.
    radius = sqrt(across / mass * (pi * t + 4.0 * pi / 3.0) / _capsule(t)[0])
    return radius, t * radius


def equal_inertia_shape(inertial: Inertial, kind: str) -> Shape:
    """Return the "box", "ellipsoid" or "capsule" with a link's mass, center and inertia, in the
    link's frame; for a capsule without length, the sphere.
    """
    mass, moments, axes = inertial.mass, inertial.moments, inertial.axes
    if kind == "capsule":
        along_z = axes[:, [1, 2, 0]]  # the long axis last, and still a rotation
        radius, length = capsule_size(mass, moments)
        if not length > 0.0:  # no format has a capsule without length
            return Shape("sphere", (radius,), Pose(inertial.center))
        return Shape("capsule", (radius, length), Pose(inertial.center, along_z))
    size = box_sides(mass, moments) if kind == "box" else ellipsoid_axes(mass, moments)
    return Shape(kind, tuple(size.tolist()), Pose(inertial.center, axes))


def _capsule(t: float) -> tuple[float, float]:
    """Return ∫x² dV across and along the axis of a capsule of unit radius whose cylinder has length
    t.
    """
    return pi * (t / 4.0 + 4.0 / 15.0), pi * (t**3 / 12.0 + t * t / 3.0 + t / 2.0 + 4.0 / 15.0)


def _spreads(moments: NDArray) -> Array:
    """Return (3,) I_j + I_k - I_i, raised to a least value that changes no moment, so that no side
    is zero.
    """
    first, second, third = moments
    spreads = np.array([second + third - first, third + first - second, first + second - third])
    return np.maximum(spreads, LEAST_SPREAD * spreads.max())


def moments_of(shape: Shape) -> Moments:
    """Return the moments of a shape at density 1, in the link's frame; a mesh must have its
    surface.
    """
    if shape.surface is not None:
        surface = shape.surface.transform(np.diag(shape.size))
        own = integrate(surface, 1, area=False, area_moments=False, exact=True)[0]
    else:
        own = primitive_moments(shape)
    return own.transform(shape.pose.matrix)


def primitive_moments(shape: Shape) -> Moments:
    """Return the moments of a box, ellipsoid, sphere, capsule or cylinder about its middle, in its
    own axes: its volume, and the integrals of x², y² and z² over it.
    """
    if shape.kind == "box":
        sides = np.array(shape.size)
        volume = float(sides.prod())
        second = volume * sides * sides / 12.0
    elif shape.kind in ("sphere", "ellipsoid"):
        axes = np.array(shape.size * 3 if shape.kind == "sphere" else shape.size)
        volume = 4.0 / 3.0 * pi * float(axes.prod())
        second = volume * axes * axes / 5.0
    else:
        radius, length = shape.size
        volume = pi * radius**2 * length
        across = pi * radius**4 * length / 4.0
        along = pi * radius**2 * length**3 / 12.0
        # Both halves of a ball, moved by ±L/2: ∫z² dV is the ball's own, L πr⁴/2 by the first
        # moments πr⁴/4 of the halves about their flat sides, and (L/2)² times the ball's volume.
        if shape.kind == "capsule":
            volume += 4.0 / 3.0 * pi * radius**3
            across += 4.0 / 15.0 * pi * radius**5
            along += (
                pi * radius**3 * (4.0 / 15.0 * radius**2 + length * radius / 2.0 + length**2 / 3.0)
            )
        second = np.array([across, across, along])
    return second_moments(volume, np.zeros(3), np.diag(second))
