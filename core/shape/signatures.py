# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that find a shape again, however it is moved, turned, scaled, mirrored or cut into faces.

    invariants   of central moments to sixth order, over V s^n with the radius of gyration s: the
                 products
                 Σ a_m conj(b_m) of harmonic moments of one degree l, and their couplings to a
                 scalar in threes (Lo and Don, 3-D moment forms, PAMI 1989).
    zernike      the norms ‖Ω_nl‖ in the ball about the center that just holds the body (see
                 `zernike`).
    fourier      the mean of |F(q)|² over all directions by V², at q = 1, 2, … over the ball's
                 radius.
    chirality    couplings in threes with degrees that add up to an odd number: a mirror image has
                 the same with the
                 opposite sign, and a body that is its own mirror image has none.

Size is kept apart, as the radius of gyration. The compared numbers are smooth in the shape: noise
of the points changes it little, and nothing switches.

A flat shape has a front, and is seen from there: turned over it is its mirror image; a sheet has no
front. Its `invariants` are c_pp, and the real parts of products of complex moments with p - q that
add up to zero, c_a conj(c_b) and c_a c_b conj(c_c), of central moments over A s^n; `chirality` are
the imaginary parts; `zernike` the |A_nm| in the disc about the centroid that just holds the shape.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, combinations_with_replacement
from math import hypot, log, pi, sqrt, tanh

import numpy as np

from ..moments import (
    Measure,
    Moments,
    U,
    along_first,
    complex_moments,
    couple,
    harmonic_moments,
    monomial_count,
    monomials,
)
from ..numerics import Array, Mask, NDArray, PerBody, check_type
from ..verdict import FileError
from .findings import SIGNATURE_INVALID
from .zernike import (
    MAX_ORDER_BY_MOMENTS,
    Multiplets,
    degrees,
    descriptor_error,
    descriptors,
    disc_zernike,
    radial_power,
    zernike_moments,
)

Key = tuple[int, int]  # (n, l) of a multiplet, or (p, q) of a complex moment of a flat shape, p ≥ q
ARRAYS = "invariants", "zernike", "fourier", "chirality"
INVARIANT_ORDER = 6
# largest order of the moments that are coupled in threes; of a flat shape, of two of the three
COUPLED_ORDER = 4
CHIRAL_ORDER = 6
FREQUENCIES = np.arange(1.0, 13.0)  # frequencies that orders to 20 resolve to a millionth
MAX_SIMILAR_DIFFERENCE = 0.1  # beyond this nobody would call two shapes similar
MAX_SIZE = 1e150  # meters; the ratio of two sizes is still a number
MAX_DESCRIPTOR = 1e100  # its square is still a number
MIN_CHIRALITY = 1e-11  # a chirality below this is rounding
CHIRALITY_NOISE_FACTOR = 10.0  # noise that changes the shape by 1 may cause this much chirality
# chiralities with a difference below this share of their sum, or the reverse, decide the hand
CLEAR_CHIRALITY_SHARE = 0.2


@dataclass(frozen=True, eq=False)
class Signature:
    """Numbers that recognize a shape, however it is moved, rotated, scaled or cut into faces.

    `size`: the radius of gyration, in the body's unit. `invariants`, `zernike`, `fourier`,
    `chirality`: see the module; `fourier` is empty for moments of a surface. `error`: an estimate
    of the rounding of the descriptors. `dimension`: 3, or 2 for a flat shape (`flat_signature`),
    which is unlike every body.
    """

    size: float
    invariants: Array
    zernike: Array
    fourier: Array
    chirality: Array
    error: float = 0.0
    dimension: int = 3

    def as_record(self) -> dict:
        """Return the arrays and the size by name, for JSON."""
        dimension = {} if self.dimension == 3 else {"dimension": self.dimension}
        return dimension | {"size": self.size} | {name: getattr(self, name) for name in ARRAYS}

    @classmethod
    def from_record(cls, record: dict) -> Signature:
        """Read a signature from JSON. FileError if the record is not a signature."""
        try:
            arrays = [np.array(record[name], np.float64).reshape(-1) for name in ARRAYS]
            dimension = record.get("dimension", 3)
            result = cls(
                size=float(record["size"]), dimension=dimension, **dict(zip(ARRAYS, arrays))
            )
            couplings = len(FLAT_PAIRS) + len(FLAT_TRIPLES)
            # The numbers of invariants and of chiralities, by dimension.
            lengths = {
                2: (INVARIANT_ORDER // 2 - 1 + couplings, int(IS_CHIRAL.sum())),
                3: (2 + len(PAIRS) + len(EVEN_TRIPLES), len(CHIRAL_TRIPLES)),
            }[dimension]
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            raise FileError(SIGNATURE_INVALID, fault="was not written by --signature") from error
        is_complete = (
            (np.abs(np.concatenate(arrays)) < MAX_DESCRIPTOR).all()  # false if one is NaN
            and 1.0 / MAX_SIZE < result.size < MAX_SIZE
            and len(result.zernike)
            and (len(result.invariants), len(result.chirality)) == lengths
        )
        if not is_complete:
            raise FileError(SIGNATURE_INVALID, fault="is incomplete")
        return result


@dataclass(frozen=True)
class Likeness:
    """The likeness of two bodies.

    `shape`: the difference of the shapes irrespective of size and hand, 0 for equal shapes.
    `scale`: the second body's size divided by the first one's. `chirality_difference`: the norm of
    the difference of their chiralities. `is_mirror_image`: False also if neither has a hand, None
    if noise as large as the shapes' difference could make up their hands.
    """

    shape: float
    scale: float
    chirality_difference: float
    is_mirror_image: bool | None

    def distance(self, any_size: bool = False, any_hand: bool = False) -> float:
        """Return the norm of the differences of shape, size and hand, 0 for a copy.

        The differences of size and of hand count as at most MAX_SIMILAR_DIFFERENCE, and not at all
        with `any_size` or `any_hand`.
        """
        size, hand = (
            MAX_SIMILAR_DIFFERENCE * tanh(abs(value) / MAX_SIMILAR_DIFFERENCE)
            for value in (log(self.scale), self.chirality_difference)
        )
        return hypot(self.shape, 0.0 if any_size else size, 0.0 if any_hand else hand)


def signature(moments: Moments, radius: float, zernike: Multiplets | None = None) -> Signature:
    """Return the signature of a shape.

    Parameters
    ----------
    moments : Moments
        About the center, of volume or area, to order 6 at least and 20 at most.
    radius : float
        Radius of the ball about the center that just holds the body.
    zernike : dict, optional
        The Zernike moments Ω_nlm in that ball if they are known otherwise; by default from the
        moments.

    Returns
    -------
    Signature

    Notes
    -----
    Moment invariants (Lo and Don, PAMI 1989), 3-D Zernike descriptors (Novotni and Klein 2003), and
    the power of the Fourier transform; see the module.

    Examples
    --------
    >>> from body_moments.core import Surface, polyhedron_moments, signature
    >>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), faces)
    >>> volume = polyhedron_moments(surface, 20)[0].about_center()
    >>> radius = float(np.linalg.norm(surface.points - volume.about, axis=1).max())
    >>> round(signature(volume, radius).size, 6)
    0.33541
    """
    check_type("moments", moments, Moments)
    size = sqrt(moments.second().trace() / moments.total)
    return Signature(size, *_numbers(moments.raw, moments, size, radius, zernike))


def signatures(moments: Moments, radius: Array) -> list[Signature]:
    """Return the signatures of a stack of shapes with balls of (n,) radii: as `signature` of each,
    to rounding.
    """
    raw = np.ascontiguousarray(moments.raw.T)
    size = np.sqrt(np.trace(moments.second(), axis1=-2, axis2=-1) / raw[0])
    *arrays, error = _numbers(raw, moments, size, radius)
    of_each = [np.ascontiguousarray(array.T) for array in arrays]
    return [Signature(*numbers) for numbers in zip(size.tolist(), *of_each, error.tolist())]


def _numbers(
    raw: NDArray,
    moments: Moments,
    size: PerBody,
    radius: PerBody,
    zernike: Multiplets | None = None,
) -> tuple[Array, Array, Array, Array, PerBody]:
    """Return invariants, descriptors, power, chirality and error, each with the axes (…) of bodies
    after its own.

    raw: (K, …) central moments. moments: those of the same body or stack, for their order and
    measure. size, radius: (…). zernike: as for `signature`.
    """
    total = raw[0]
    order = min(moments.order, MAX_ORDER_BY_MOMENTS)
    degree = along_first(monomials(moments.order).sum(axis=1), raw)
    low = len(monomials(INVARIANT_ORDER))
    harmonic = harmonic_moments(
        (raw / size**degree / total)[:low] * sqrt(4.0 * pi), INVARIANT_ORDER
    )
    error = 0.0
    if zernike is None:
        dimension = 3 if moments.measure != Measure.AREA else 2
        scaled = raw / radius ** (degree + dimension)
        zernike = zernike_moments(scaled, order)
        error = descriptor_error(scaled, order)
    power = np.empty((0, *raw.shape[1:]))
    if moments.measure == Measure.VOLUME:
        volume = zernike[0, 0].real[0] * 4.0 * pi / 3.0
        power = radial_power(zernike, FREQUENCIES) / volume**2
    scalars = [harmonic[n, 0].real[0] for n in (4, 6)]
    products = [np.add.reduce((harmonic[a].conj() * harmonic[b]).real) for a, b in PAIRS]
    invariants = np.array(scalars + products + _couplings(harmonic, EVEN_TRIPLES))
    chirality = np.array(_couplings(harmonic, CHIRAL_TRIPLES))
    return invariants, descriptors(zernike), power, chirality, error


def similarity(a: Signature, b: Signature) -> Likeness:
    """Compare two signatures.

    Parameters
    ----------
    a, b : Signature
        Descriptors of orders that one of them lacks are left out.

    Returns
    -------
    Likeness
        The differences of the shapes, of their sizes and of their hands.

    Examples
    --------
    >>> from body_moments.core.mesh import Surface
    >>> from body_moments.core.polyhedron import polyhedron_moments
    >>> from body_moments.core.shape import signature, similarity
    >>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), faces)
    >>> small, large = (
    ...     signature(
    ...         polyhedron_moments(surface.transform(size * np.eye(3)), 20)[0].about_center(), size
    ...     )
    ...     for size in (1.0, 3.0)
    ... )
    >>> likeness = similarity(small, large)
    >>> round(likeness.shape, 6), round(likeness.scale, 6)
    (0.0, 3.0)
    """
    check_type("a", a, Signature)
    check_type("b", b, Signature)
    if a.dimension != b.dimension:
        return Likeness(1.0, b.size / a.size, 0.0, None)
    n = min(len(a.zernike), len(b.zernike))
    zernike_difference = _relative_difference(a.zernike[:n], b.zernike[:n])
    invariant_difference = _relative_difference(a.invariants, b.invariants)
    shape = sqrt((zernike_difference**2 + invariant_difference**2) / 2.0)
    difference = np.linalg.norm(a.chirality - b.chirality)
    sum_of_both = np.linalg.norm(a.chirality + b.chirality)  # 0 for mirror images
    hand = max(np.linalg.norm(a.chirality), np.linalg.norm(b.chirality))
    is_mirror_image = False if hand <= MIN_CHIRALITY else None
    smaller, larger = sorted((difference, sum_of_both))
    is_clear = smaller < CLEAR_CHIRALITY_SHARE * larger
    if is_clear and hand > MIN_CHIRALITY + shape * CHIRALITY_NOISE_FACTOR:
        is_mirror_image = bool(sum_of_both < difference)
    return Likeness(float(shape), b.size / a.size, float(difference), is_mirror_image)


def _relative_difference(a: NDArray, b: NDArray) -> float:
    """Return the norm of the difference over the larger norm."""
    scale = max(np.linalg.norm(a), np.linalg.norm(b))
    return float(np.linalg.norm(a - b) / scale) if scale else 0.0


def _couplings(harmonic: Multiplets, triples: list[tuple[Key, Key, Key]]) -> list[Array]:
    """Return the scalars of triples of multiplets, (…) each."""
    return [couple(*(harmonic[key] for key in triple)) for triple in triples]


def _multiplets(order: int) -> list[Key]:
    """Return (n, l) of the harmonic moments of order 2 to `order` that a rotation changes: those
    with l > 0.
    """
    return [(n, l) for n, l in degrees(order) if l and n > 1]


def _can_couple(triple: tuple[Key, Key, Key]) -> bool:
    """Return whether three multiplets have a scalar: their degrees are the sides of a triangle."""
    a, b, c = sorted(l for _, l in triple)
    return c <= a + b


def _turning(order: int) -> list[Key]:
    """Return (p, q) of the complex moments of order 2 to `order` that a rotation changes; first
    moments are zero.
    """
    return [(n - q, q) for n in range(2, order + 1) for q in range((n + 1) // 2)]


PAIRS = [
    (a, b)
    for a, b in combinations_with_replacement(_multiplets(INVARIANT_ORDER), 2)
    if a[1] == b[1]
]
EVEN_TRIPLES = [
    triple
    for triple in combinations_with_replacement(_multiplets(COUPLED_ORDER), 3)
    if _can_couple(triple) and sum(l for _, l in triple) % 2 == 0
]
# Three different multiplets: with two alike, an odd coupling is zero.
CHIRAL_TRIPLES = [
    triple
    for triple in combinations(_multiplets(CHIRAL_ORDER), 3)
    if _can_couple(triple) and sum(l for _, l in triple) % 2
]
FLAT_PAIRS = [
    (a, b)
    for a, b in combinations_with_replacement(_turning(INVARIANT_ORDER), 2)
    if a[0] - a[1] == b[0] - b[1]
]
# Two moments, and a third with p - q equal to the sum of theirs.
FLAT_TRIPLES = [
    (a, b, d)
    for a, b in combinations_with_replacement(_turning(COUPLED_ORDER), 2)
    for d in _turning(INVARIANT_ORDER)
    if a[0] - a[1] + b[0] - b[1] == d[0] - d[1]
]
# True for couplings that have an imaginary part: all but the squares of one moment.
IS_CHIRAL: Mask = np.array([a != b for a, b in FLAT_PAIRS] + [True] * len(FLAT_TRIPLES))


def flat_signature(moments: Moments, radius: float) -> Signature:
    """Return the signature of a flat shape, of dimension 2.

    moments: of area, about the centroid, with z = 0, to order 6 at least; orders above 20 are not
    used. radius: of the disc about the centroid that just holds the shape. The invariants are
    Flusser's (Pattern Recognition 33, 2000), the Zernike descriptors those of Khotanzad and Hong
    (PAMI 12, 1990).
    """
    order = min(moments.order, MAX_ORDER_BY_MOMENTS)
    moments = moments.truncate(order)
    size = sqrt((moments[2, 0, 0] + moments[0, 2, 0]) / moments.total)
    low = moments.truncate(INVARIANT_ORDER)
    degree = monomials(INVARIANT_ORDER).sum(axis=1)
    scaled = Moments(low.raw / size**degree / moments.total, low.about, low.measure)
    c = {key: entry.value for key, entry in complex_moments(scaled).items()}
    couplings: NDArray[np.complex128] = np.array(
        [c[a] * c[b].conjugate() for a, b in FLAT_PAIRS]
        + [c[a] * c[b] * c[d].conjugate() for a, b, d in FLAT_TRIPLES]
    )
    scalars = [c[p, p].real for p in range(2, INVARIANT_ORDER // 2 + 1)]
    zernike = np.abs(disc_zernike(moments, radius))
    # As in `descriptor_error`: the change of the descriptors if moments change by a few roundings.
    rounding = np.random.default_rng(0).uniform(-8.0 * U, 8.0 * U, monomial_count(order))
    rounded = Moments(moments.raw * (1.0 + rounding), moments.about, moments.measure)
    error = float(np.abs(np.abs(disc_zernike(rounded, radius)) - zernike).max())
    return Signature(
        size,
        np.concatenate([scalars, couplings.real]),
        zernike,
        np.empty(0),
        couplings.imag[IS_CHIRAL],
        error,
        dimension=2,
    )
