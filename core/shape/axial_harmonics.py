# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Harmonics that fix the turn of a body about its axis.

They are needed if its moments to sixth order are those of a body of revolution, as for a prism of
seven sides or more.

The harmonics ∫ (x+iy)^m and ∫ (x+iy)^m z about the axis are moments of order m and m + 1; no others
are needed. They are powers of linear forms. The mean of w^m over a triangle is a complete
homogeneous polynomial of w at the corners,

    E[w^m] = 2 m! / (m+2)! h_m(w_a, w_b, w_c),

found by the recursion of `any_order`; the factor z comes with the derivative by ε of (w + ε
z)^(m+1). The frame is turned so that the first harmonic above noise is positive. The other
harmonics decide between the m turns that make it positive.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ..inertia import NOISE_LEVEL
from ..mesh import Surface
from ..numerics import Array, NDArray, cross, dot
from .canonical_frame import EquivalentFrames, lexicographic_maximum

MAX_AXIAL_ORDER = 30
MAX_TILT = 1e-2  # rad; harmonics about an axis with a larger tilt say nothing about the body
# Relative to the radius: the least unit of height, as float32 makes flat bodies uneven.
LEAST_HEIGHT = 1e-2
TRIANGLES_PER_BLOCK = 1 << 13


@dataclass(frozen=True, eq=False)
class AxialHarmonics:
    """Harmonics about an axis, as shares of the largest possible ones.

    The largest possible ones are those of a body with this radius and height, at least LEAST_HEIGHT
    radii. `frame`: a rotation with the axes x, y, z as columns; z is the axis. `values`: (2, n + 1)
    ∫ (x+iy)^m z^k for k = 0 and 1 and m from 0 to n.
    """

    frame: Array
    values: NDArray[np.complex128]

    @property
    def order(self) -> int:
        """The largest m."""
        return self.values.shape[1] - 1

    def in_frame(self, frame: Array) -> AxialHarmonics:
        """Return the harmonics in another frame with the same or the opposite axis."""
        values = self.values
        base = self.frame
        if frame[:, 2] @ base[:, 2] < 0.0:  # half a turn about x
            base = base * (1.0, -1.0, -1.0)
            values = values.conj() * [[1.0], [-1.0]]
        turn = np.arctan2(frame[:, 0] @ base[:, 1], frame[:, 0] @ base[:, 0])
        return AxialHarmonics(frame, values * np.exp(-1j * turn * np.arange(values.shape[1])))

    def inverted(self) -> AxialHarmonics:
        """Return the harmonics of the body's point reflection in its center."""
        m = np.arange(self.values.shape[1])
        return replace(self, values=self.values * np.stack([(-1.0) ** m, (-1.0) ** (m + 1)]))


def axial_harmonics(
    surfaces: Iterable[Surface],
    center: NDArray,
    frame: NDArray,
    *,
    area: bool,
    order: int = MAX_AXIAL_ORDER,
) -> AxialHarmonics:
    """Find harmonics, to m = order, about the axis frame[:, 2] through the center: of the body in
    closed surfaces, or if `area` of the surfaces.
    """
    pieces = [
        ((piece.points.astype(np.float64) - center) @ frame, piece.all_triangles()[0])
        for piece in surfaces
    ]
    reach = max(float(np.hypot(points[:, 0], points[:, 1]).max()) for points, _ in pieces)
    height = max(float(np.abs(points[:, 2]).max()) for points, _ in pieces)
    scale = np.array([reach, reach, max(height, LEAST_HEIGHT * reach)])
    sums = np.zeros((2, order + 1), np.complex128)
    total = 0.0
    for points, triangles in pieces:
        for start in range(0, len(triangles), TRIANGLES_PER_BLOCK):
            block = triangles[start : start + TRIANGLES_PER_BLOCK]
            corners = points[block].transpose(1, 2, 0)  # (corner, axis, k)
            normal = np.array(cross(corners[1] - corners[0], corners[2] - corners[0]))
            weight = np.sqrt(dot(normal, normal)) if area else dot(corners[0], normal)
            total += float(weight.sum())
            # Weights are multiples of the areas, or of the volumes of the cones from the center.
            sums += _means(corners / scale[:, None], order) @ weight
    if not area:
        # The mean of a function of degree n over the cone on a triangle is 3 / (n + 3) times that
        # over the triangle.
        degree = np.arange(order + 1) + np.array([[0], [1]])
        sums *= 3.0 / (degree + 3.0)
    return AxialHarmonics(np.asarray(frame, np.float64), sums / total)


def _means(corners: Array, order: int) -> NDArray[np.complex128]:
    """Return the (2, order + 1, k) means of w^m and w^m z, w = x + iy, over k triangles with
    corners (3, 3, k): corner, axis, triangle.
    """
    w = corners[:, 0] + 1j * corners[:, 1]
    z = corners[:, 2]
    # h_m of the first corner, of two and of three, and their derivatives by ε at 0; here m = 0.
    power = [np.ones(w.shape[1], np.complex128)] * 3
    slope = [np.zeros(w.shape[1], np.complex128)] * 3
    means = np.empty((2, order + 1, w.shape[1]), np.complex128)
    means[0, 0] = 1.0
    for m in range(1, order + 2):
        fewer_power = fewer_slope = 0.0  # h_m and its derivative of one corner less
        for i in range(3):  # h_m(.., w_i) = h_m(..) + w_i h_{m-1}(.., w_i)
            fewer_slope = fewer_slope + z[i] * power[i] + w[i] * slope[i]
            fewer_power = fewer_power + w[i] * power[i]
            power[i] = fewer_power
            slope[i] = fewer_slope
        if m <= order:
            means[0, m] = power[2] * (2.0 / ((m + 1.0) * (m + 2.0)))
        means[1, m - 1] = slope[2] * (2.0 / ((m + 1.0) * (m + 2.0) * m))
    return means


def axis_last(alike: EquivalentFrames) -> Array:
    """Return a (3, 3) frame with the axis of revolution as its third axis."""
    (axis,) = alike.revolution_axes
    return alike.frames[0][:, np.roll([0, 1, 2], 2 - axis)]


def turn_by_harmonics(
    alike: EquivalentFrames, harmonics: AxialHarmonics, noise: float = NOISE_LEVEL
) -> EquivalentFrames:
    """Return frames turned about one axis so that the first clear harmonic is positive; `alike` if
    no harmonic is clear, or the axis is too uncertain.

    alike: frames of a body with one axis of revolution. harmonics: about that axis.
    """
    (axis,) = alike.revolution_axes
    if alike.tilt > MAX_TILT:
        return alike
    order = np.roll([0, 1, 2], 2 - axis)  # the axis last, as in the frames of harmonics
    bases = [harmonics.in_frame(frame[:, order]) for frame in alike.frames]
    if len(alike.noise):
        noise = max(noise, float(alike.noise.min()))
    # Degrees m + k above 2: such a body's moments to second order have no harmonic.
    m, k = np.meshgrid(np.arange(harmonics.order + 1), [0, 1])
    clear = np.argwhere((np.abs(harmonics.values) > 2.0 * noise) & (m > 0) & (m + k > 2))
    if not len(clear):
        return alike
    k, m = clear[np.argmin(clear.sum(axis=1))]  # the clear harmonic of the lowest degree
    frames = []
    values = []
    for base in bases:
        angles = (np.angle(base.values[k, m]) + 2.0 * np.pi * np.arange(m)) / m
        for angle in angles:
            cos = np.cos(angle)
            sin = np.sin(angle)
            turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
            turned = base.in_frame(base.frame @ turn)
            frames.append(turned.frame[:, np.argsort(order)])
            values.append(np.concatenate([turned.values.real.ravel(), turned.values.imag.ravel()]))
    least = np.full(len(values[0]), 2.0 * noise)  # the noise of a difference of two values
    frames, known = lexicographic_maximum(np.array(frames), np.array(values), least)
    tilt = noise / (float(m) * float(np.abs(harmonics.values[k, m])))
    return EquivalentFrames(
        frames,
        np.concatenate([alike.values, known]),
        np.concatenate([alike.noise, least]),
        (),
        alike.tilt + tilt,
    )
