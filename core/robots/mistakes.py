# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Common mistakes of stated inertials, each undone: the changes that may correct an inertial."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import permutations, product
from math import degrees, radians
from typing import Any, NamedTuple

import numpy as np

from ..density import POUND
from ..numerics import Array, ArrayLike, NDArray, rotation_matrix
from ..verdict import Finding, finding
from .comparison import AGREES, DIFFERS, LARGEST_DENSITY, Reference, is_possible
from .findings import (
    AUDIT_ANGLES,
    AUDIT_FRAME_NOT_MEANT,
    AUDIT_INERTIA_ELSEWHERE,
    AUDIT_INERTIA_OF_UNIT,
    AUDIT_ORDER,
    AUDIT_SIGN,
    AUDIT_TRANSPOSED,
    AUDIT_TURNED,
    AUDIT_UNIT,
)
from .stated import StatedInertial, parallel_axis_term, rotation_of_angles

UNEQUAL = 0.05  # Least difference of principal moments that were exchanged.
MIXED = 0.618  # Factor of one of two tensors in a sum, in which equal sums are unlikely.
INCH = 0.0254
LENGTH_UNITS = (1e-3, 1e-2, 1e3, 1e2, INCH, 1.0 / INCH)
INERTIA_UNITS = (1e-6, 1e-3, 1e-9, 1e-4, INCH**2, 1e-7, 1e6, 1e3, 1e9, 1e4, 1e7)
# lb·in², lb·ft², oz·in²
IMPERIAL_INERTIAS = (
    POUND * INCH**2,
    POUND * (12.0 * INCH) ** 2,
    POUND / 16.0 * INCH**2,
)
AXES = np.array(list(permutations(range(3))))[1:]
SIGNS = [*product((1.0, -1.0), repeat=3)][1:]
PRODUCT_NAMES = ("xy", "xz", "yz")
# Six entries of a tensor as programs list them: URDF (the upper triangle row by row), MuJoCo, the
# lower triangle row by row, Fusion, Simscape.
SEQUENCES = (
    ("xx", "xy", "xz", "yy", "yz", "zz"),
    ("xx", "yy", "zz", "xy", "xz", "yz"),
    ("xx", "xy", "yy", "xz", "yz", "zz"),
    ("xx", "yy", "zz", "xy", "yz", "xz"),
    ("xx", "yy", "zz", "yz", "xz", "xy"),
)
# Parts of an inertial, as the findings name them.
CENTER = "center of mass"
PRODUCTS = "products of inertia"
CENTER_AXES = "axes of the center of mass"
LENGTHS = "lengths of the inertial, the inertia twice,"
GRAMS = "mass by 0.001 and the inertia, in g·mm² or g·cm²,"
PER_MASS = "inertia, which is that of mass 1 in other units, by the mass and"
IMPERIAL = "mass by 0.453592 and the inertia, in lb·in²,"
WHOLE_IMPERIAL = "mass by 0.453592, the center by 0.0254 and the inertia, in lb·in²,"
OWN_FRAME = " in its own frame"
# Parts that agree after a change of units, as the findings name them.
ALL_AGREE = "inertial and geometry"
CENTERS_AGREE = "the centers"


class Change(NamedTuple):
    """A change that may correct an inertial: its finding, and the corrected inertial."""

    finding: Finding
    repaired: StatedInertial


def _change(repaired: StatedInertial, code: str, **values: Any) -> Change:
    return Change(finding(code, **values), repaired)


class Unit(NamedTuple):
    """A change of units. part, factor: as the finding names them. mass, center, inertia: the
    factors of each.
    """

    part: str
    factor: float
    mass: float = 1.0
    center: float = 1.0
    inertia: float = 1.0

    def change(self, stated: StatedInertial, agree: str = ALL_AGREE) -> Change:
        """Return the change of an inertial. agree: the parts that then agree."""
        repaired = scaled(stated, self.mass, self.center, self.inertia)
        return _change(repaired, AUDIT_UNIT, part=self.part, factor=self.factor, agree=agree)


WHOLE_POUNDS = Unit(
    WHOLE_IMPERIAL, IMPERIAL_INERTIAS[0], mass=POUND, center=INCH, inertia=IMPERIAL_INERTIAS[0]
)
# The inertia comes with a mass in pounds, and often with a center in inches.
POUNDS = (
    Unit("mass, which is in pounds,", POUND, mass=POUND),
    *(Unit("inertia", unit, inertia=unit) for unit in IMPERIAL_INERTIAS),
    Unit(IMPERIAL, IMPERIAL_INERTIAS[0], mass=POUND, inertia=IMPERIAL_INERTIAS[0]),
    WHOLE_POUNDS,
)


def changes(stated: StatedInertial, reference: Reference) -> Iterator[Change]:
    """Yield each change that may correct an inertial; likelier changes come first."""
    # Changes that keep a wrong center cannot make it agree.
    center_agrees = reference.compare_centers(stated) <= AGREES
    yield from _units(stated, reference, center_agrees)
    if center_agrees:
        yield from _points(stated, reference)
        yield from _frames(stated)
    else:
        yield from center_changes(stated, reference)
    yield from _signs(stated, center_agrees)
    yield from _orders(stated, center_agrees)
    if center_agrees:
        yield from _moments(stated, reference)
        yield from _transposed(stated)


def center_changes(
    stated: StatedInertial, reference: Reference, agree: str = ALL_AGREE
) -> Iterator[Change]:
    """Yield changes of the center alone. agree: the parts that agree after a change of its unit."""
    # Any center becomes that of geometry at the origin, if it is only made small enough.
    is_away = np.linalg.norm(reference.center) > DIFFERS * reference.radius
    for unit in LENGTH_UNITS if is_away else ():
        yield Unit(CENTER, unit, center=unit).change(stated, agree)
    for signs in SIGNS:
        negative = [axis for axis, sign in zip("xyz", signs) if sign == -1.0]
        moved = replace(stated, center=stated.center * signs)
        yield _change(moved, AUDIT_SIGN, part=CENTER, axes=negative)
    for order in AXES:
        moved = replace(stated, center=stated.center[order])
        yield _change(moved, AUDIT_ORDER, part=CENTER_AXES, order=_axis_names(order))


def scaled(
    stated: StatedInertial, mass: float = 1.0, center: float = 1.0, inertia: float = 1.0
) -> StatedInertial:
    """Return an inertial with its mass, center and inertia times these factors."""
    result = replace(
        stated, mass=float(_times(stated.mass, mass)), center=_times(stated.center, center)
    )
    return result if inertia == 1.0 else result.along_link(_times(stated.inertia, inertia))


def _times(values: ArrayLike, factor: float) -> Array:
    """Return values times a factor; divide by its inverse if that is whole, to keep the decimals of
    the file.
    """
    inverse = round(1.0 / factor)
    values = np.asarray(values, np.float64)
    return values / inverse if inverse and 1.0 / inverse == factor else values * factor


def _axis_names(order: NDArray) -> str:
    return "".join("xyz"[axis] for axis in order)


def _units(stated: StatedInertial, reference: Reference, center_agrees: bool) -> Iterator[Change]:
    density = reference.density(stated)
    units = []
    for factor in (1e-3, 1e3):
        if is_possible(density * factor) and not is_possible(density):
            units.append(Unit("mass", factor, mass=factor))
            if density > LARGEST_DENSITY:
                units += [Unit(GRAMS, unit, mass=factor, inertia=unit) for unit in (1e-9, 1e-7)]
    if center_agrees:
        units += [Unit("inertia", unit, inertia=unit) for unit in INERTIA_UNITS]
    units += [Unit(LENGTHS, unit, center=unit, inertia=unit**2) for unit in LENGTH_UNITS]
    for unit in (*units, *POUNDS):
        yield unit.change(stated)
    if not center_agrees:
        return
    for part, factor in (("mass", stated.mass), ("density", density)):
        repaired = scaled(stated, inertia=factor)
        yield _change(repaired, AUDIT_INERTIA_OF_UNIT, part=part, factor=factor)
    for factor in (INCH**2, 1e-4, 1e-6):
        repaired = scaled(stated, inertia=factor * stated.mass)
        yield _change(repaired, AUDIT_UNIT, part=PER_MASS, factor=factor, agree=ALL_AGREE)


def _points(stated: StatedInertial, reference: Reference) -> Iterator[Change]:
    """Yield changes for an inertia about another point than the center, or a parallel-axis term of
    the wrong sign.
    """
    term = parallel_axis_term(stated.mass, stated.center)
    for part, inertia in (
        ("the origin of the link", stated.inertia - term),
        ("another point, by a parallel-axis term of the wrong sign", stated.inertia + term),
    ):
        yield _change(stated.along_link(inertia), AUDIT_INERTIA_ELSEWHERE, part=part)
    for origin in reference.origins:
        term = parallel_axis_term(stated.mass, stated.center - origin)
        yield _change(
            stated.along_link(stated.inertia - term),
            AUDIT_INERTIA_ELSEWHERE,
            part="the origin of the mesh",
            point=origin.tolist(),
        )


def _frames(stated: StatedInertial) -> Iterator[Change]:
    """Yield changes of the inertial frame's rotation: other units or order, transposed, or left
    out.
    """
    if stated.angles is not None:
        for unit, wanted, convert in (
            ("degrees", "radians", radians),
            ("radians", "degrees", degrees),
        ):
            turned = replace(stated, rotation=rotation_of_angles(*map(convert, stated.angles)))
            yield _change(turned, AUDIT_ANGLES, part="inertial", unit=unit, wanted=wanted)
    if stated.quaternion is not None:
        w, x, y, z = stated.quaternion
        for quaternion, wanted in (((z, w, x, y), "w x y z"), ((x, y, z, w), "x y z w")):
            turned = replace(stated, rotation=rotation_matrix(quaternion))
            yield _change(turned, AUDIT_ORDER, part="quaternion of the inertial", order=wanted)
    transposed = replace(stated, rotation=stated.rotation.T)
    yield _change(transposed, AUDIT_TRANSPOSED, part="rotation of the inertial")
    yield _change(replace(stated, rotation=np.eye(3)), AUDIT_FRAME_NOT_MEANT)


def _signs(stated: StatedInertial, center_agrees: bool) -> Iterator[Change]:
    """Yield changes of signs of the products, all of them first, and mirror images."""
    for signs in (SIGNS[-1], *SIGNS[:-1]) if center_agrees else ():
        factors = np.ones((3, 3))
        for (i, j), sign in zip(((0, 1), (0, 2), (1, 2)), signs):
            factors[i, j] = factors[j, i] = sign
        negative = [name for name, sign in zip(PRODUCT_NAMES, signs) if sign == -1.0]
        wrong = finding(AUDIT_SIGN, part=PRODUCTS, axes=negative)
        yield Change(wrong, stated.along_link(stated.inertia * factors))
        yield Change(wrong, replace(stated, tensor=stated.tensor * factors))
    for axis in range(3):
        mirror = np.diag(1.0 - 2.0 * np.eye(3)[axis])
        yield _change(
            _turned(stated, mirror),
            AUDIT_TURNED,
            part="inertial",
            change="mirrored along",
            axis="xyz"[axis],
        )


def _turned(stated: StatedInertial, linear: NDArray) -> StatedInertial:
    """Return an inertial whose inertia and center are mapped by a (3, 3) orthogonal matrix."""
    return stated.along_link(linear @ stated.inertia @ linear.T, center=linear @ stated.center)


def _orders(stated: StatedInertial, center_agrees: bool) -> Iterator[Change]:
    """Yield changes that reorder the axes of the tensor, the center or both, or turn them by 90
    degrees; and six entries in another program's sequence.
    """
    if center_agrees:
        yield from _sequences(stated)
    for order in AXES:
        for reordered, tensor in _reordered(stated.inertia, order, "") if center_agrees else ():
            yield Change(reordered, stated.along_link(tensor))
        permuted = _turned(stated, np.eye(3)[order])
        axes = _axis_names(order)
        yield _change(permuted, AUDIT_ORDER, part="axes of the inertial", order=axes)
    # A quarter turn, such as y up instead of z up: exact, which sines and cosines are not.
    for axis, way in product(range(3), (1.0, -1.0)):
        along = np.eye(3)[axis]
        turn = np.outer(along, along) + way * np.cross(along, np.eye(3)).T
        both = _turned(stated, turn)
        for part, repaired in (
            ("inertial", both),
            ("inertia", replace(both, center=stated.center)),
        ):
            yield _change(
                repaired,
                AUDIT_TURNED,
                part=part,
                change="turned by 90 degrees about",
                axis="xyz"[axis],
            )
    if center_agrees and stated.is_turned:
        for order in AXES:
            for reordered, tensor in _reordered(stated.tensor, order, OWN_FRAME):
                yield Change(reordered, replace(stated, tensor=tensor))


def _sequences(stated: StatedInertial) -> Iterator[Change]:
    """Yield tensors whose six entries were listed in one sequence and read in another one."""
    part = "entries of the inertia" + (OWN_FRAME if stated.is_turned else "")
    entries = {name: ("xyz".index(name[0]), "xyz".index(name[1])) for name in SEQUENCES[0]}
    tried: set[tuple[str, ...]] = {SEQUENCES[0]}
    for listed, read in permutations(SEQUENCES, 2):
        # For each entry in the order of URDF, the name of the number that was read as it.
        names = tuple(listed[read.index(name)] for name in SEQUENCES[0])
        # Orders of the products alone have a change of their own.
        if names in tried or (names[0], names[3], names[5]) == ("xx", "yy", "zz"):
            continue
        tried.add(names)
        tensor = np.empty((3, 3))
        for read_as, name in zip(SEQUENCES[0], names):
            i, j = entries[name]
            tensor[i, j] = tensor[j, i] = stated.tensor[entries[read_as]]
        reread = replace(stated, tensor=tensor)
        yield _change(reread, AUDIT_ORDER, part=part, order=" ".join(names))


def _moments(stated: StatedInertial, reference: Reference) -> Iterator[Change]:
    """Yield changes that exchange the principal moments along axes that the inertia shares with
    the geometry.
    """
    tensor = stated.inertia
    # Tensors with the same axes share them with their sums, also if each has equal moments.
    axes = np.linalg.eigh(reference.inertia + MIXED / stated.mass * tensor)[1]
    moments = np.diag(axes.T @ tensor @ axes)
    ascending = np.argsort(moments)
    axes, moments = axes[:, ascending], moments[ascending]
    for order in AXES:
        exchanged = moments[order]
        if np.abs(exchanged - moments).max() > UNEQUAL * moments[2]:
            repaired = stated.along_link((axes * exchanged) @ axes.T)
            numbers = " ".join(map(str, order + 1))
            yield _change(repaired, AUDIT_ORDER, part="principal moments", order=numbers)


def _reordered(tensor: NDArray, order: NDArray, where: str) -> Iterator[tuple[Finding, Array]]:
    """Yield a (3, 3) tensor with its axes, its diagonal or its products in another order, each
    after its finding. where: the frame, as the finding names it.
    """
    permuted = tensor[np.ix_(order, order)]
    diagonal = np.diag(np.diag(tensor))
    permuted_diagonal = np.diag(np.diag(permuted))
    axes = _axis_names(order)
    # Products alone, such as ixz before ixy, have the order of the pairs of axes.
    pairs = " ".join("".join(sorted(axes[i] + axes[j])) for i, j in ((0, 1), (0, 2), (1, 2)))
    for part, names, result in (
        ("axes of the inertia", axes, permuted),
        ("diagonal of the inertia", axes, tensor - diagonal + permuted_diagonal),
        (PRODUCTS, pairs, diagonal + (permuted - permuted_diagonal)),
    ):
        yield finding(AUDIT_ORDER, part=part + where, order=names), result


def _transposed(stated: StatedInertial) -> Iterator[Change]:
    """Yield changes for a tensor that was made with its principal axes as rows instead of
    columns: QᵀDQ instead of QDQᵀ, with the moments D.
    """
    part = "principal axes that make the tensor"
    moments, axes = np.linalg.eigh(stated.inertia)
    # The file's own order and signs of the axes are unknown.
    for order in permutations(range(3)):
        for signs in ((1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1)):
            columns = axes[:, order] * signs
            tensor = columns.T @ (moments[list(order)][:, None] * columns)
            yield _change(stated.along_link(tensor), AUDIT_TRANSPOSED, part=part)
