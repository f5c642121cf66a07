# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The frames of many bodies at once: the search of `canonical_frame`, and the choice of half turns.

Equal bodies with equal second moments share one search for their axes. The search takes their
normalized moments, in coordinates in which each extent is one, rounded to a tenth of the noise
level. Copies whose coordinates differ by rounding have mostly the same rounded moments, and the
solution is remembered; it depends on the body alone, not on earlier measurements. The frames are
then refined for the body's own moments: Newton's steps refine the directions of extreme moments,
and the phase of the harmonic that fixed the turns about them refines these turns.

Two kinds of bodies need no search: if only the signs of axes are left to choose, and if no moment
fixes the turn about an axis. A frame turned by half a turn about one of its axes has the same
normalized moments, except for the signs of the moments that are odd in both other axes. So among
frames that differ by half turns, the first moment above noise of each odd kind decides which have
the largest moments.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..moments.affine_maps import rotate_moments
from ..moments.exponents import (
    monomial_count,
    monomial_index,
    monomial_values,
    monomials,
    order_from_count,
    tensor_index,
)
from ..moments.moments import Measure, Moments
from ..moments.solid_harmonics import circular_coefficients
from ..numerics.arrays import cross_rows, lengths
from .canonical_frame import (
    FLAT_EXTENT_RTOL,
    MAX_ORDER,
    NOISE_GROWTH,
    EquivalentFrames,
    FrameRule,
    SecondMomentAxes,
    canonical_frames,
    check_range,
    extents_of,
)
from .plain_body import EQUAL_AXES, SYMMETRIES
from .third_moment_frames import FIXED_AXIS, HALF_TURN_SIGNS, ThirdMomentFrames

GRID = 1e-6  # step of normalized moments, times NOISE_GROWTH: a tenth of NOISE_LEVEL
LEAST_BOUND = (
    2.0**-30
)  # least bound; larger ones are rounded up to three binary digits, so that copies agree
MAX_KNOWN = 1024  # problems that are remembered
# times NOISE_GROWTH: for larger moments, as of spikes, rounding turns axes by more than noise
MAX_TAIL = 4.0
MAX_CORRECTION = 1e-4  # a body whose frames a refinement turns by more is searched alone
REFINEMENTS = 2  # each squares the error, at first the grid's 1e-6
# A body whose directions turn by less is refined: another step would move them by rounding alone.
CONVERGED = 1e-9
NO_VALUES = np.empty(0)
IDENTITY = np.eye(3)[None]
THIRD = monomial_count(2)  # index of the first moment of third order
POWERS = monomials(MAX_ORDER)
DEGREE = POWERS.sum(axis=1)
STEP = GRID * np.array(NOISE_GROWTH)[DEGREE[THIRD:]]
BELOW_THIRD = np.where(
    (POWERS[:THIRD] % 2 == 0).all(axis=1), 1.0, 0.0
)  # for a body with extents of one
# By the parity of p, q and r: 0 if half turns change no sign, else 1 to 3 for the exponent of other
# parity.
ODD_KIND = np.array([[[0, 3], [2, 1]], [[1, 2], [3, 0]]])
# Signs of the moments of each such kind after no half turn, and after half turns about axes 1, 2
# and 3.
HALF_TURN_PARITY = np.array(
    [[1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0], [1.0, -1.0, -1.0, 1.0]]
)


def shared_frames(
    moments: Moments, fixed: ThirdMomentFrames, bodies: NDArray[np.intp]
) -> list[EquivalentFrames]:
    """Find `canonical_frames`, without values, of the bodies (indices) with two or three equal
    second moments.
    """
    check_range(moments, fixed.size[bodies])
    found: list[EquivalentFrames | None] = [None] * len(bodies)
    symmetry = fixed.symmetry[bodies]
    for number in set(symmetry.tolist()) - {SYMMETRIES.index("asymmetric")}:
        rows = np.flatnonzero(symmetry == number)
        alike = _frames_alike(moments.at(rows), fixed, bodies[rows], SYMMETRIES[number])
        for row, frames in zip(rows.tolist(), alike):
            found[row] = frames
    return [
        canonical_frames(moments.at(i), fixed.spread(int(body)), fixed.frames(int(body)))
        if frames is None
        else frames
        for i, (body, frames) in enumerate(zip(bodies, found))
    ]


def _frames_alike(
    moments: Moments, fixed: ThirdMomentFrames, bodies: NDArray[np.intp], name: str
) -> list[EquivalentFrames | None]:
    """Return the frames of bodies of one symmetry; None for bodies that have to be searched one by
    one.
    """
    axis = FIXED_AXIS.get(name)
    basis = (
        _bases(fixed.axes[bodies, :, axis], axis)
        if axis is not None
        else IDENTITY.repeat(len(bodies), 0)
    )
    raw, bound, extent = _whitened(moments, fixed, bodies, basis, name)
    usable = np.isfinite(raw).all(axis=1) & np.isfinite(bound).all(axis=1)
    usable &= extent.min(axis=1) > FLAT_EXTENT_RTOL * extent.max(axis=1)
    usable &= (np.abs(raw[:, THIRD:]) <= MAX_TAIL / GRID * STEP).all(axis=1)
    step = _rounded_up(fixed.step[bodies] / extent.min(axis=1))
    tilt = _rounded_up(fixed.tilt[bodies]) * (fixed.tilt[bodies] > 0.0)
    cells = np.where(usable[:, None], np.rint(raw[:, THIRD:] / STEP), 0.0).astype(np.int32)
    ways = [3] * len(bodies) if axis is None else _ways(fixed, bodies, axis).tolist()
    keys = zip(ways, cells, bound, step.tolist(), tilt.tolist())
    together: dict[tuple, list[int]] = {}
    for row, (way, own_cells, own_bound, own_step, own_tilt) in enumerate(keys):
        if usable[row]:
            key = (
                name,
                fixed.noise,
                way,
                own_cells.tobytes(),
                own_bound.tobytes(),
                own_step,
                own_tilt,
            )
            together.setdefault(key, []).append(row)
    results: list[EquivalentFrames | None] = [None] * len(bodies)
    for key, rows in together.items():
        alike = _search(*key)
        if alike.rule is None:
            continue
        frames, is_near = _refined(alike.frames, alike.rule, raw[rows])
        frames = basis[rows][:, None] @ frames
        for row, own, near in zip(rows, frames, is_near.tolist()):
            if near:
                results[row] = EquivalentFrames(
                    own, NO_VALUES, NO_VALUES, alike.revolution_axes, alike.tilt, alike.rule
                )
    return results


@lru_cache(maxsize=MAX_KNOWN)
def _search(
    name: str, noise: float, ways: int, cells: bytes, bound: bytes, step: float, tilt: float
) -> EquivalentFrames:
    """Return the frames of a body with these rounded moments. ways: of its fixed axis, coded as by
    `_ways`.
    """
    raw = np.concatenate([BELOW_THIRD, STEP * np.frombuffer(cells, np.int32)])
    central = Moments(raw, np.zeros(3), Measure.MASS, np.frombuffer(bound)[DEGREE])
    starts = np.eye(3)[None]
    if name in FIXED_AXIS:  # half a turn about the axis after it
        turned = np.full(3, -1.0)
        turned[(FIXED_AXIS[name] + 1) % 3] = 1.0
        starts = np.array([np.eye(3), np.diag(turned)])[[bool(ways & 1), bool(ways & 2)]]
    spread = SecondMomentAxes(np.eye(3), np.ones(3), EQUAL_AXES[name], step, tilt, noise)
    return replace(canonical_frames(central, spread, starts), values=NO_VALUES, noise=NO_VALUES)


def _bases(fixed: NDArray, axis: int) -> NDArray[np.float64]:
    """Return (n, 3, 3) right-handed frames with these vectors as axis number `axis`."""
    helper = np.eye(3)[
        np.round(np.abs(fixed), 3).argmin(axis=1)
    ]  # equal for axes that differ by rounding
    first = helper - fixed * np.add.reduce(fixed * helper, axis=1, keepdims=True)
    first /= lengths(first)
    basis = np.empty((len(fixed), 3, 3))
    basis[:, :, axis] = fixed
    basis[:, :, (axis + 1) % 3] = first
    basis[:, :, (axis + 2) % 3] = cross_rows(fixed, first)
    return basis


def _ways(fixed: ThirdMomentFrames, bodies: NDArray[np.intp], axis: int) -> NDArray[np.intp]:
    """Return (n,) codes of the directions in which the bodies' fixed axes may point: 1 ahead, 2
    back, 3 both.
    """
    allowed = fixed.allowed[bodies]
    ahead = HALF_TURN_SIGNS[:, axis] > 0.0
    return np.asarray(allowed[:, ahead].any(axis=1) + 2 * allowed[:, ~ahead].any(axis=1), np.intp)


def _whitened(
    moments: Moments, fixed: ThirdMomentFrames, bodies: NDArray[np.intp], basis: NDArray, name: str
) -> tuple[NDArray, NDArray, NDArray]:
    """Return (n, K) central moments along (n, 3, 3) axes, divided by total and extents; bounds by
    degree; extents.
    """
    central = moments.about_center()
    free = list(EQUAL_AXES[name])
    extent = fixed.size[bodies].copy()
    extent[:, free] = np.sqrt((extent[:, free] ** 2).mean(axis=1, keepdims=True))
    total = central.raw[:, :1]
    raw = central.raw / total
    error = central.rounding_error / total
    if len(free) == 2:
        turned = basis.transpose(0, 2, 1)
        raw = rotate_moments(raw, MAX_ORDER, turned)
        error = rotate_moments(error, MAX_ORDER, np.abs(turned))
    with np.errstate(all="ignore"):
        unit = monomial_values(extent, MAX_ORDER)
        raw, error = raw / unit, error / unit
    starts = [monomial_count(degree - 1) for degree in range(1, MAX_ORDER + 1)]
    bound = np.maximum.reduceat(error, [0, *starts], axis=1)
    return raw, _rounded_up(bound), extent


def _rounded_up(values: NDArray) -> NDArray[np.float64]:
    """Round positive numbers up to three binary digits."""
    mantissa, exponent = np.frexp(np.maximum(values, LEAST_BOUND))
    return np.ldexp(np.ceil(8.0 * mantissa) / 8.0, exponent)


def _refined(
    frames: NDArray[np.float64], rule: FrameRule, raw: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return (n, k, 3, 3) frames turned by the rule for moments (n, K), and (n,) whether they
    hardly turned.
    """
    start = frames
    frames = frames[None].repeat(len(raw), 0)
    third = rule.axis
    first = (rule.axis + 1) % 3
    second = (rule.axis + 2) % 3
    if rule.extreme:
        pole = _extreme(frames[..., third], rule.extreme, raw)
        side = frames[..., first]
        side = side - pole * np.add.reduce(pole * side, axis=-1, keepdims=True)
        side /= lengths(side)
        frames[..., first] = side
        frames[..., second] = cross_rows(pole, side)
        frames[..., third] = pole
    if rule.harmonic:
        degree, m, k = rule.harmonic
        turning = frames[..., first] + 1j * frames[..., second]
        j = (degree - m - k) // 2
        c = _contracted(raw, [turning] * (m + j) + [turning.conj()] * j + [frames[..., third]] * k)
        angle = (np.angle(rule.sign * c) / m)[..., None]
        cos, sin = np.cos(angle), np.sin(angle)
        a = frames[..., first].copy()
        b = frames[..., second].copy()
        frames[..., first] = cos * a + sin * b
        frames[..., second] = cos * b - sin * a
    return frames, np.abs(frames - start).max(axis=(1, 2, 3)) < MAX_CORRECTION


def _extreme(points: NDArray, degree: int, raw: NDArray) -> NDArray[np.float64]:
    """Return (n, k, 3) directions near the points in which the moments of a degree are extreme, by
    Newton's method.
    """
    is_moving = np.ones((len(points), 1, 1), bool)
    for _ in range(REFINEMENTS):
        twice = _contracted(raw, [points] * (degree - 2), degree)
        once = np.einsum("nkij,nkj->nki", twice, points)
        height = np.add.reduce(once * points, axis=-1, keepdims=True)
        curved = (degree - 1) * twice - height[..., None] * IDENTITY
        turned = points + np.linalg.solve(curved, (height * points - once)[..., None])[..., 0]
        turned /= lengths(turned)
        off = np.abs(turned - points)
        points = np.where(is_moving, turned, points)
        is_moving &= off.max(axis=(1, 2), keepdims=True) > CONVERGED
        if not is_moving.any():
            break
    return points


def _contracted(raw: NDArray, forms: list[NDArray], degree: int | None = None) -> NDArray:
    """Return (n, k, ...) moment tensors contracted with forms (n, k, 3); degree: by default the
    number of forms.
    """
    out = np.einsum("n...i,nki->nk...", raw[:, tensor_index(degree or len(forms))], forms[0])
    for form in forms[1:]:
        out = np.einsum("nk...i,nki->nk...", out, form)
    return out


def choose_half_turns(
    moments: Moments, fixed: ThirdMomentFrames, bodies: NDArray[np.intp]
) -> NDArray[np.bool_]:
    """Return the (n, 4) HALF_TURN_SIGNS that `canonical_frames` chooses for bodies without axes of
    equal moments.
    """
    values, least, _ = _along_axes(moments, fixed, bodies)
    return _choose(values, least, fixed.allowed[bodies])


def choose_about_axis(
    moments: Moments, fixed: ThirdMomentFrames, bodies: NDArray[np.intp]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Choose the half turns as `canonical_frames` does, for bodies with two axes of equal moments.

    Return an (n,) mask of the bodies whose moments do not fix the directions of these two axes, and
    an (n, 4) mask of half turns, at most one for each direction of the third axis. The half turns
    hold for the masked bodies only; the other bodies have to be searched one by one.
    """
    values, least, raw = _along_axes(moments, fixed, bodies)
    is_round = np.ones(len(bodies), bool)
    allowed = fixed.allowed[bodies]
    for name, axis in FIXED_AXIS.items():
        rows = np.flatnonzero(fixed.symmetry[bodies] == SYMMETRIES.index(name))
        weights, columns, forms = _harmonics(axis, moments.order)
        size = fixed.size[bodies[rows]]
        unit = monomial_values(extents_of(size), moments.order)[:, columns + THIRD]
        harmonic = np.abs(raw[rows][:, THIRD:] @ forms.T) / unit
        is_round[rows] = ~(harmonic > weights * least[rows][:, columns]).any(axis=1)
        # keep only the first frame for each direction of the axis
        ahead = HALF_TURN_SIGNS[:, axis] > 0.0
        for way in (ahead, ~ahead):
            later = np.cumsum(allowed[np.ix_(rows, np.flatnonzero(way))], axis=1) > 1
            kept = allowed[np.ix_(rows, np.flatnonzero(way))] & ~later
            allowed[np.ix_(rows, np.flatnonzero(way))] = kept
    return is_round, _choose(values, least, allowed)


def _choose(values: NDArray, least: NDArray, allowed: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return an (n, 4) mask of the allowed half turns with the largest (n, columns) moments, equal
    within `least`.
    """
    kind = ODD_KIND[tuple(monomials(order_from_count(THIRD + values.shape[1]))[THIRD:].T % 2)]
    clear = (2.0 * np.abs(values) > least)[:, None] & (
        kind == np.arange(1, 4)[:, None]
    )  # (n, 3, columns)
    count = values.shape[1]
    bodies = np.arange(len(values))
    first = np.where(clear.any(axis=2), clear.argmax(axis=2), count)
    for deciding in first.argsort(axis=1).T:
        column = first[bodies, deciding]
        value = values[bodies, np.minimum(column, count - 1)]
        positive = allowed & (HALF_TURN_PARITY[deciding] * value[:, None] > 0.0)
        decides = (column < count) & positive.any(axis=1)
        allowed = np.where(decides[:, None], positive, allowed)
    return allowed


def _along_axes(
    moments: Moments, fixed: ThirdMomentFrames, bodies: NDArray[np.intp]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return (n, columns) normalized moments of order ≥ 3 along the axes, their noise, and (n, K)
    central moments.
    """
    central = moments.about_center()
    order = central.order
    total = central.raw[:, :1]
    size = fixed.size[bodies]
    check_range(central, size)
    turned = fixed.axes[bodies].transpose(0, 2, 1)
    raw = rotate_moments(central.raw / total, order, turned)
    error = rotate_moments(central.rounding_error / total, order, np.abs(turned))[:, THIRD:]
    powers = monomials(order)[THIRD:]
    degree = powers.sum(axis=1)
    extents = extents_of(size)
    unit = monomial_values(extents, order)[:, THIRD:]
    thin = np.minimum.reduce(np.where(powers > 0, extents[:, None], np.inf), axis=2)
    noise = fixed.noise + 4.0 * fixed.step[bodies, None] / thin + degree * fixed.tilt[bodies, None]
    return raw[:, THIRD:] / unit, np.array(NOISE_GROWTH)[degree] * noise + error / unit, raw


@lru_cache
def _harmonics(
    axis: int, order: int
) -> tuple[NDArray[np.float64], NDArray[np.intp], NDArray[np.complex128]]:
    """Return the harmonics E[(x+iy)^m (x²+y²)^j z^k] for all degrees m + 2j + k from 3 to `order`
    with m > 0.

    z is along this axis, x and y along the next. Return three arrays. The noise of each harmonic is
    a factor, (h,), times the noise of a moment, whose column from third order on is in the second
    array, (h,). The third has (h, columns) coefficients.
    """
    weights = []
    columns = []
    forms = []
    for degree in range(3, order + 1):
        for m in range(1, degree + 1):
            for k in range((degree - m) % 2, degree - m + 1, 2):
                form = np.zeros(monomial_count(order) - THIRD, complex)
                j = (degree - m - k) // 2
                where = [
                    monomial_index(*np.roll((degree - k - power, power, k), axis + 1)) - THIRD
                    for power in range(degree - k + 1)
                ]
                form[where] = circular_coefficients(m + j, j)
                weights.append(2.0 ** (degree - k))
                columns.append(where[0])
                forms.append(form)
    return np.array(weights), np.array(columns), np.array(forms)
