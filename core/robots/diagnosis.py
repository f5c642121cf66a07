# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The one change that makes a stated inertial agree with its geometry.

A link's geometry, filled evenly, has a center and an inertia for each kilogram. If the stated
values differ, each of a list of common mistakes is undone; agreement to the digits of files is no
coincidence. If none agrees, the mass may be distributed unevenly: that is no error, and only noted
with the factor of the inertia.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import permutations, product
from math import degrees, hypot, radians
from typing import Any

import numpy as np

from ..density import POUND
from ..numerics import Array, ArrayLike, NDArray, rotation_matrix, second_of_inertia
from ..verdict import Finding, finding
from .findings import (
    AUDIT_ANGLES,
    AUDIT_DENSITY,
    AUDIT_FRAME_NOT_MEANT,
    AUDIT_INERTIA_ELSEWHERE,
    AUDIT_INERTIA_OF_UNIT,
    AUDIT_NOT_UNIFORM,
    AUDIT_ORDER,
    AUDIT_SIGN,
    AUDIT_TRANSPOSED,
    AUDIT_TURNED,
    AUDIT_UNIT,
)
from .model import Effect, compare
from .stated import StatedInertial, rotation_of_angles

# Relative differences: below the first equal; above the second not by rounded digits.
AGREES = 5e-3
DIFFERS = 1e-2
UNEQUAL = 0.05  # Least difference of principal moments that were exchanged.
MIXED = 0.618  # Factor of one of two tensors in a sum, in which equal sums are unlikely.
ROUNDING = 1e-9  # Relative differences below are none, and do not choose between changes.
INCH = 0.0254
LENGTH_UNITS = (1e-3, 1e-2, 1e3, 1e2, INCH, 1.0 / INCH)
# lb·in², lb·ft², oz·in²
IMPERIAL_INERTIAS = (
    POUND * INCH**2,
    POUND * (12.0 * INCH) ** 2,
    POUND / 16.0 * INCH**2,
)
INERTIA_UNITS = (1e-6, 1e-3, 1e-9, 1e-4, INCH**2, 1e-7, 1e6, 1e3, 1e9, 1e4, 1e7)
# kg/m³, possible range of a robot: from foam to above the heaviest metal.
DENSITIES = (
    10.0,
    30_000.0,
)
# Typical range; a change that only the density shows must lead into it.
USUAL_DENSITIES = (
    100.0,
    12_000.0,
)
AXES = np.array(list(permutations(range(3))))[1:]
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
SAME = 1e-6  # Relative difference below which two changes lead to one inertial.
# Parts of an inertial, as the findings name them.
CENTER = "center of mass"
PRODUCTS = "products of inertia"
CENTER_AXES = "axes of the center of mass"
LENGTHS = "lengths of the inertial, the inertia twice,"
GRAMS = "mass by 0.001 and the inertia, in g·mm² or g·cm²,"
PER_MASS = "inertia, which is that of mass 1 in other units, by the mass and"
IMPERIAL = "mass by 0.453592 and the inertia, in lb·in²,"
WHOLE_IMPERIAL = "mass by 0.453592, the center by 0.0254 and the inertia, in lb·in²,"
# Changes of units of pounds: part, factor, and the factors of mass, center and inertia. The inertia
# comes with a mass in pounds, and often with a center in inches.
POUNDS = (
    ("mass, which is in pounds,", POUND, POUND),
    *(("inertia", unit, 1.0, 1.0, unit) for unit in IMPERIAL_INERTIAS),
    (IMPERIAL, IMPERIAL_INERTIAS[0], POUND, 1.0, IMPERIAL_INERTIAS[0]),
    (WHOLE_IMPERIAL, IMPERIAL_INERTIAS[0], POUND, INCH, IMPERIAL_INERTIAS[0]),
)


@dataclass(frozen=True, eq=False)
class Reference:
    """A link's geometry, filled evenly: volume, m³; (3,) center in the link's frame, m; inertia
    about it of 1 kg, m².

    origins: (3,) the origins of its shapes.
    """

    volume: float
    center: Array
    inertia: Array
    origins: tuple[Array, ...] = ()

    def compare(self, stated: StatedInertial) -> float:
        """Return the larger relative difference: of the centers, per radius of gyration, or of the
        inertia.
        """
        turned = np.linalg.norm(stated.inertia / stated.mass - self.inertia) / np.linalg.norm(
            self.inertia
        )
        return max(self.compare_centers(stated), float(turned))

    def compare_centers(self, stated: StatedInertial) -> float:
        """Return the center's difference per radius of gyration."""
        radius = np.sqrt(np.trace(self.inertia) / 2.0)
        return float(np.linalg.norm(stated.center - self.center) / radius)

    def effect(self, stated: StatedInertial, drawn_volume: float | None) -> Effect:
        """Return the mass properties of this geometry, filled evenly with the stated mass, beside
        the stated ones.
        """
        second = stated.mass * second_of_inertia(self.inertia)
        volume_ratio = None if drawn_volume is None else self.volume / drawn_volume
        return compare(
            stated.principal(), stated.mass, self.center - stated.center, second, volume_ratio
        )

    def describe_effect(self, stated: StatedInertial, effect: Effect, part: str) -> Finding:
        """Return the note about an effect of this geometry. part: its name."""
        first, second, third = effect.moment_ratios
        return finding(
            AUDIT_NOT_UNIFORM,
            part=part,
            factor=float(np.trace(stated.inertia) / stated.mass / np.trace(self.inertia)),
            volume=effect.volume_ratio,
            first=first,
            second=second,
            third=third,
            distance=hypot(*effect.center_shift),
            turn=degrees(effect.axes_turn),
        )

    def uniform(self, mass: float) -> StatedInertial:
        """Return the inertial of this geometry, filled evenly with a mass in kg."""
        return StatedInertial(mass, self.center, mass * self.inertia)


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """Diagnosis of an inertial: a finding that names the change, and the corrected inertial, None
    if it stays.

    is_of_geometry: True if the geometry has to change. is_certain: False if another change would
    agree as well.
    """

    finding: Finding
    repaired: StatedInertial | None = None
    is_of_geometry: bool = False
    is_certain: bool = True

    @property
    def is_change(self) -> bool:
        """True if something has to change; False for a mere note."""
        return self.repaired is not None or self.is_of_geometry


def diagnose(
    stated: StatedInertial,
    references: Sequence[Reference],
    otherwise: Iterable[tuple[Finding, Reference]] = (),
    center_is_wrong: bool = False,
) -> list[Diagnosis]:
    """Return the changes that correct an inertial, or a note about the place of the mass; empty if
    it agrees.

    That is one change, or one of the center with one of the rest or the note; each has the inertial
    corrected so far. references: candidates for the geometry, such as visual and collision shapes.
    otherwise: geometries with a corrected fault of the description, each with its finding.
    center_is_wrong: True if a change of the center alone is certain.
    """
    if not references:
        return []
    nearest = min(references, key=lambda reference: reference.compare(stated))
    if nearest.compare(stated) <= DIFFERS:
        return diagnose_density(stated, nearest)
    for change, reference in otherwise:
        if reference.compare(stated) < AGREES:
            return [Diagnosis(change, is_of_geometry=True)]
    best = _best_change(stated, references)
    if best is not None:
        return [best]
    alone = []
    for first in _center_changes(stated, references):
        assert first.repaired is not None
        second = _best_change(first.repaired, references)
        if second is not None:
            return [first, second]
        if center_is_wrong:
            alone = [replace(first, is_certain=False)]
            stated = first.repaired
            break
    return [
        *alone,
        Diagnosis(
            nearest.describe_effect(stated, nearest.effect(stated, nearest.volume), "geometry")
        ),
    ]


def _best_change(stated: StatedInertial, references: Sequence[Reference]) -> Diagnosis | None:
    """Return the one change after which an inertial agrees with a reference, None if there is
    none.
    """
    apart = min(reference.compare(stated) for reference in references)
    best: tuple[float, Diagnosis] | None = None
    fits: list[tuple[dict, StatedInertial, bool]] = []
    for reference in references:
        for code, values, repaired in _changes(stated, reference):
            now = reference.compare(repaired)
            if now < AGREES and now < 0.1 * apart:
                density = repaired.mass / reference.volume
                fits.append((values, repaired, _is_possible(density)))
                if best is None or max(now, ROUNDING) < 0.1 * best[0]:
                    best = (
                        now,
                        _with_density(
                            Diagnosis(_finding(code, values), repaired), stated, reference
                        ),
                    )
    if best is None:
        return None
    # A density that no robot has excludes a change, if another one leads to a possible density.
    usable = [fit for fit in fits if fit[2]] or fits
    masses = [one.mass for _, one, _ in usable]  # Inertials per kg agree, but the masses need not.
    part = best[1].finding.values.get("part")
    # Equal moments have no order of their own.
    orders = {values.get("order") for values, _, _ in usable if values.get("part") == part}
    first = best[1].repaired
    is_certain = (
        max(masses) <= (1.0 + DIFFERS) * min(masses)
        and len(orders) <= 1
        and (first is None or all(_is_same(first, one) for _, one, _ in usable))
    )
    return replace(best[1], is_certain=is_certain)


def _is_same(first: StatedInertial, other: StatedInertial) -> bool:
    body = Reference(1.0, first.center, first.inertia / first.mass)
    return body.compare(other) <= SAME


def _center_changes(stated: StatedInertial, references: Sequence[Reference]) -> Iterator[Diagnosis]:
    """Yield the first change for each reference that corrects a wrong center alone."""
    for reference in references:
        if reference.compare_centers(stated) <= DIFFERS:
            continue
        for code, values, repaired in _centers(stated, reference):
            if reference.compare_centers(repaired) < AGREES:
                yield Diagnosis(_finding(code, values, "the centers"), repaired)
                break


def diagnose_density(stated: StatedInertial, reference: Reference) -> list[Diagnosis]:
    """Diagnose an unusual density of an inertial, such as a wrong unit of the mass; empty if it is
    usual.
    """
    density = stated.mass / reference.volume
    if _is_possible(density):
        return []
    for factor in (1e-3, 1e3):
        if USUAL_DENSITIES[0] <= density * factor <= USUAL_DENSITIES[1]:
            repaired = _scaled(stated, mass=factor, inertia=factor)
            values = {"part": "mass and inertia", "factor": factor, "density": density}
            return [Diagnosis(_finding(AUDIT_UNIT, values), repaired, is_certain=False)]
    return [Diagnosis(finding(AUDIT_DENSITY, density=density))]


def _with_density(found: Diagnosis, stated: StatedInertial, reference: Reference) -> Diagnosis:
    """Return a diagnosis, or one of the mesh's lengths if the density shows that these are wrong
    instead.
    """
    if found.finding.values.get("part") != LENGTHS:
        return found
    factor = found.finding.values["factor"]
    density = stated.mass / reference.volume
    other = density * factor**3  # were the mesh scaled by 1/factor
    # Both cannot be in the range: a cube of a factor exceeds it.
    if _is_possible(other):
        return Diagnosis(
            _finding(AUDIT_UNIT, {"part": "lengths of the mesh", "factor": 1.0 / factor}),
            is_of_geometry=True,
        )
    if factor == INCH:  # Programs that state inches state pounds.
        part, factor, *factors = POUNDS[-1]
        values = {"part": part, "factor": factor}
        return Diagnosis(_finding(AUDIT_UNIT, values), _scaled(stated, *factors))
    return found


def _finding(code: str, values: dict, agree: str = "inertial and geometry") -> Finding:
    """Return the finding about a change. agree: what agrees after a change of units."""
    more: dict[str, Any] = (values | {"agree": agree}) if code == AUDIT_UNIT else values
    return finding(code, **more)


def _times(values: ArrayLike, factor: float) -> Array:
    """Return values times a factor; divide by its inverse if that is whole, to keep the decimals of
    the file.
    """
    inverse = round(1.0 / factor)
    values = np.asarray(values, np.float64)
    return values / inverse if inverse and 1.0 / inverse == factor else values * factor


def _is_possible(density: float) -> bool:
    return DENSITIES[0] <= density <= DENSITIES[1]


def _scaled(
    stated: StatedInertial, mass: float = 1.0, center: float = 1.0, inertia: float = 1.0
) -> StatedInertial:
    """Return an inertial with its mass, center and inertia times these factors."""
    scaled = replace(
        stated, mass=float(_times(stated.mass, mass)), center=_times(stated.center, center)
    )
    return scaled if inertia == 1.0 else scaled.along_link(_times(stated.inertia, inertia))


Change = tuple[str, dict, StatedInertial]


def _changes(stated: StatedInertial, reference: Reference) -> Iterator[Change]:
    """Yield each change that may correct an inertial, with the corrected inertial; likelier changes
    come first.
    """
    # Changes that keep a wrong center cannot make it agree.
    keeps = reference.compare_centers(stated) <= AGREES
    yield from _units(stated, reference, keeps)
    if not keeps:
        yield from _centers(stated, reference)
    if keeps:
        yield from _points(stated, reference)
        yield from _frames(stated)
    yield from _signs(stated, keeps)
    yield from _orders(stated, keeps)
    if keeps:
        yield from _moments(stated, reference)
        yield from _transposed(stated)


def _units(stated: StatedInertial, reference: Reference, keeps: bool) -> Iterator[Change]:
    """Yield changes of units. keeps: True if changes that keep the center may help."""
    density = stated.mass / reference.volume
    changes = []
    for factor in (1e-3, 1e3):
        if _is_possible(density * factor) and not _is_possible(density):
            changes.append(("mass", factor, factor))
            if density > DENSITIES[1]:
                changes += [(GRAMS, unit, factor, 1.0, unit) for unit in (1e-9, 1e-7)]
    changes += [("inertia", unit, 1.0, 1.0, unit) for unit in INERTIA_UNITS if keeps]
    changes += [(LENGTHS, unit, 1.0, unit, unit**2) for unit in LENGTH_UNITS]
    for part, factor, *factors in (*changes, *POUNDS):
        yield AUDIT_UNIT, {"part": part, "factor": factor}, _scaled(stated, *factors)
    for part, factor in (("mass", stated.mass), ("density", density)):
        values = {"part": part, "factor": factor}
        yield AUDIT_INERTIA_OF_UNIT, values, _scaled(stated, inertia=factor)
    for factor in (INCH**2, 1e-4, 1e-6) if keeps else ():
        values = {"part": PER_MASS, "factor": factor}
        yield AUDIT_UNIT, values, _scaled(stated, inertia=factor * stated.mass)


def _points(stated: StatedInertial, reference: Reference) -> Iterator[Change]:
    """Yield changes for an inertia about another point than the center, or a parallel-axis term of
    the wrong sign.
    """
    term = stated.mass * _square(stated.center)
    for part, changed in (
        ("the origin of the link", stated.inertia - term),
        ("another point, by a parallel-axis term of the wrong sign", stated.inertia + term),
    ):
        yield AUDIT_INERTIA_ELSEWHERE, {"part": part}, stated.along_link(changed)
    for origin in reference.origins:
        term = stated.mass * _square(stated.center - origin)
        changed = stated.along_link(stated.inertia - term)
        yield (
            AUDIT_INERTIA_ELSEWHERE,
            {"part": "the origin of the mesh", "point": origin.tolist()},
            changed,
        )


def _square(arm: NDArray) -> Array:
    return arm @ arm * np.eye(3) - np.outer(arm, arm)


def _frames(stated: StatedInertial) -> Iterator[Change]:
    """Yield changes of the inertial frame's rotation: other units or order, transposed, or left
    out.
    """
    if stated.angles is not None:
        for unit, wanted, convert in (
            ("degrees", "radians", radians),
            ("radians", "degrees", degrees),
        ):
            turned = rotation_of_angles(*map(convert, stated.angles))
            values = {"part": "inertial", "unit": unit, "wanted": wanted}
            yield AUDIT_ANGLES, values, replace(stated, rotation=turned)
    if stated.quaternion is not None:
        w, x, y, z = stated.quaternion
        for order, wanted in (((z, w, x, y), "w x y z"), ((x, y, z, w), "x y z w")):
            values = {"part": "quaternion of the inertial", "order": wanted}
            yield AUDIT_ORDER, values, replace(stated, rotation=rotation_matrix(order))
    yield (
        AUDIT_TRANSPOSED,
        {"part": "rotation of the inertial"},
        replace(stated, rotation=stated.rotation.T),
    )
    yield AUDIT_FRAME_NOT_MEANT, {}, replace(stated, rotation=np.eye(3))


def _centers(stated: StatedInertial, reference: Reference) -> Iterator[Change]:
    # Any center becomes that of geometry at the origin, if it is only made small enough.
    is_away = np.linalg.norm(reference.center) > DIFFERS * np.sqrt(np.trace(reference.inertia) / 2)
    for factor in LENGTH_UNITS if is_away else ():
        yield AUDIT_UNIT, {"part": CENTER, "factor": factor}, _scaled(stated, center=factor)
    *some, all_of_them = [*product((1.0, -1.0), repeat=3)][1:]
    for signs in (*some, all_of_them):
        names = [axis for axis, sign in zip("xyz", signs) if sign == -1.0]
        moved = replace(stated, center=stated.center * signs)
        yield AUDIT_SIGN, {"part": CENTER, "axes": names}, moved
    for order in AXES:
        axes = "".join("xyz"[axis] for axis in order)
        moved = replace(stated, center=stated.center[order])
        yield AUDIT_ORDER, {"part": CENTER_AXES, "order": axes}, moved


def _signs(stated: StatedInertial, keeps: bool) -> Iterator[Change]:
    rows = np.array([0, 0, 1])
    columns = np.array([1, 2, 2])
    _, *some, all_of_them = product((1.0, -1.0), repeat=3)
    for signs in (all_of_them, *some) if keeps else ():
        for along_link in (True, False):
            tensor = (stated.inertia if along_link else stated.tensor).copy()
            tensor[rows, columns] = tensor[columns, rows] = tensor[rows, columns] * signs
            changed = stated.along_link(tensor) if along_link else replace(stated, tensor=tensor)
            names = [name for name, sign in zip(PRODUCT_NAMES, signs) if sign == -1.0]
            yield AUDIT_SIGN, {"part": PRODUCTS, "axes": names}, changed
    for axis in range(3):
        values = {"part": "inertial", "change": "mirrored along", "axis": "xyz"[axis]}
        yield AUDIT_TURNED, values, _mapped(stated, np.diag(1.0 - 2.0 * np.eye(3)[axis]))[2]


def _mapped(
    stated: StatedInertial, linear: NDArray
) -> tuple[StatedInertial, StatedInertial, StatedInertial]:
    """Return an inertial with the inertia, the center, and both mapped by a (3, 3) orthogonal
    matrix.
    """
    inertia = linear @ stated.inertia @ linear.T
    center = linear @ stated.center
    return (
        stated.along_link(inertia),
        replace(stated, center=center),
        stated.along_link(inertia, center=center),
    )


def _orders(stated: StatedInertial, keeps: bool) -> Iterator[Change]:
    """Yield changes that reorder the axes of the tensor, the center or both, or turn them by 90
    degrees; and six entries in another program's sequence.
    """
    if keeps:
        yield from _sequences(stated)
    for order in AXES:
        axes = {"order": "".join("xyz"[axis] for axis in order)}
        _, _, both = _mapped(stated, np.eye(3)[order])
        for values, tensor in _reordered(stated.inertia, order, "") if keeps else ():
            yield AUDIT_ORDER, values, stated.along_link(tensor)
        yield AUDIT_ORDER, {"part": "axes of the inertial", **axes}, both
    # A quarter turn, such as y up instead of z up.
    for axis, way in product(range(3), (1.0, -1.0)):
        along = np.eye(3)[axis]
        tensor, _, both = _mapped(
            stated, np.outer(along, along) + way * np.cross(along, np.eye(3)).T
        )
        for part, turned in (("inertial", both), ("inertia", tensor)):
            values = {"part": part, "change": "turned by 90 degrees about", "axis": "xyz"[axis]}
            yield AUDIT_TURNED, values, turned
    if keeps and (stated.rotation != np.eye(3)).any():
        for order in AXES:
            for values, tensor in _reordered(stated.tensor, order, " in its own frame"):
                yield AUDIT_ORDER, values, replace(stated, tensor=tensor)


def _sequences(stated: StatedInertial) -> Iterator[Change]:
    """Yield tensors whose six entries were listed in one sequence and read in another one."""
    places = {name: tuple("xyz".index(axis) for axis in name) for name in SEQUENCES[0]}
    where = " in its own frame" if (stated.rotation != np.eye(3)).any() else ""
    seen: set[tuple[str, ...]] = {SEQUENCES[0]}
    for listed, read in permutations(SEQUENCES, 2):
        names = tuple(listed[read.index(name)] for name in SEQUENCES[0])
        # Orders of the products alone have a change of their own.
        if names in seen or (names[0], names[3], names[5]) == ("xx", "yy", "zz"):
            continue
        seen.add(names)
        tensor = np.empty((3, 3))
        for name, other in zip(SEQUENCES[0], names):
            i, j = places[other]
            tensor[i, j] = tensor[j, i] = stated.tensor[places[name]]
        values = {"part": "entries of the inertia" + where, "order": " ".join(names)}
        yield AUDIT_ORDER, values, replace(stated, tensor=tensor)


def _moments(stated: StatedInertial, reference: Reference) -> Iterator[Change]:
    """Yield changes that exchange the principal moments along axes that the inertia shares with
    the geometry.
    """
    tensor = stated.inertia
    # Tensors with the same axes share them with their sums, also if each has equal moments.
    axes = np.linalg.eigh(reference.inertia + MIXED / stated.mass * tensor)[1]
    moments = np.diag(axes.T @ tensor @ axes)
    rising = np.argsort(moments)
    axes = axes[:, rising]
    moments = moments[rising]
    for order in AXES:
        swapped = moments[order]
        if np.abs(swapped - moments).max() > UNEQUAL * moments[2]:
            values = {"part": "principal moments", "order": " ".join(map(str, order + 1))}
            yield AUDIT_ORDER, values, stated.along_link((axes * swapped) @ axes.T)


def _reordered(tensor: NDArray, order: NDArray, where: str) -> Iterator[tuple[dict, Array]]:
    """Yield a (3, 3) tensor with its axes, its diagonal or its products in another order, each
    after the values of the finding. where: the frame, as it is named there.
    """
    swapped = tensor[np.ix_(order, order)]
    diagonal = np.diag(np.diag(tensor))
    other = np.diag(np.diag(swapped))
    axes = "".join("xyz"[axis] for axis in order)
    # Products alone, such as ixz before ixy, have the order of the pairs of axes.
    pairs = " ".join("".join(sorted(axes[i] + axes[j])) for i, j in ((0, 1), (0, 2), (1, 2)))
    yield {"part": "axes of the inertia" + where, "order": axes}, swapped
    yield {"part": "diagonal of the inertia" + where, "order": axes}, tensor - diagonal + other
    yield {"part": PRODUCTS + where, "order": pairs}, diagonal + (swapped - other)


def _transposed(stated: StatedInertial) -> Iterator[Change]:
    """Yield changes for a tensor that was made with its principal axes as rows instead of
    columns.
    """
    moments, axes = np.linalg.eigh(stated.inertia)
    for order in permutations(range(3)):
        for signs in ((1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1)):
            rows = axes[:, order] * signs
            tensor = rows.T @ (moments[list(order)][:, None] * rows)
            yield (
                AUDIT_TRANSPOSED,
                {"part": "principal axes that make the tensor"},
                stated.along_link(tensor),
            )
