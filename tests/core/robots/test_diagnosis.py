# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Each mistake that a robot description may have is made, found, named and repaired; from both
sides of each limit.
"""

from dataclasses import replace
from itertools import compress, permutations, product
from math import degrees, radians

import numpy as np
import pytest
from body_moments.core.density import POUND
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.mesh import Surface, convex_hull
from body_moments.core.numerics.rotations import quaternion
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.robots.comparison import Reference
from body_moments.core.robots.diagnosis import diagnose
from body_moments.core.robots.mistakes import (
    IMPERIAL_INERTIAS,
    INCH,
    LENGTHS,
    WHOLE_IMPERIAL,
    _times,
)
from body_moments.core.robots.stated import StatedInertial, rotation_of_angles

from tests.close import close
from tests.core import bodies

MASS, DENSITY = 2.3, 1234.5
CENTERS = ("center of mass", "axes of the center of mass")
CENTER, ORIGIN, ANGLES = (
    np.array([0.21, -0.34, 0.55]),
    np.array([-0.1, 0.45, 0.3]),
    (0.4, -0.7, 1.1),
)
AXES = bodies.rotation(5)
INERTIA = MASS * AXES @ np.diag([0.017, 0.029, 0.036]) @ AXES.T
TRUTH = StatedInertial(MASS, CENTER, INERTIA)
REFERENCE = Reference(MASS / DENSITY, CENTER, INERTIA / MASS, (ORIGIN,))
# mm, cm, inches, and the other way round
LENGTH_UNITS = (
    1e-3,
    1e-2,
    0.0254,
    1e3,
    1e2,
    1.0 / 0.0254,
)
# g·m², kg·mm², g·mm², kg·cm², g·cm²
INERTIA_UNITS = (
    1e-3,
    1e-6,
    1e-9,
    1e-4,
    1e-7,
    1e3,
    1e6,
    1e9,
    1e4,
    1e7,
)


def square(arm):
    return MASS * (arm @ arm * np.eye(3) - np.outer(arm, arm))


def of_inertia(inertia, center=CENTER):
    return StatedInertial(MASS, center, inertia)


def along(rotation, stated_rotation, **more):
    """The truth along other axes, stated in another way by the file."""
    return StatedInertial(MASS, CENTER, rotation.T @ INERTIA @ rotation, stated_rotation, **more)


def with_products(signs, tensor):
    flipped = tensor.copy()
    for (i, j), sign in zip(((0, 1), (0, 2), (1, 2)), signs):
        flipped[i, j] = flipped[j, i] = tensor[i, j] * sign
    return flipped


def mistakes():
    """The code, the values, and the numbers of a file."""
    for factor in (1e-3, 1e3):
        yield "unit", {"part": "mass", "factor": factor}, replace(TRUTH, mass=MASS / factor)
    for factor in INERTIA_UNITS:
        yield "unit", {"part": "inertia", "factor": factor}, of_inertia(INERTIA / factor)
    for factor in LENGTH_UNITS:
        yield (
            "unit",
            {"part": "center of mass", "factor": factor},
            of_inertia(INERTIA, CENTER / factor),
        )
        if factor != INCH:
            yield (
                "unit",
                {"part": LENGTHS, "factor": factor},
                of_inertia(INERTIA / factor**2, CENTER / factor),
            )
    yield (
        "unit",
        {"part": "mass, which is in pounds,", "factor": POUND},
        replace(TRUTH, mass=MASS / POUND),
    )
    for factor in IMPERIAL_INERTIAS:
        yield "unit", {"part": "inertia", "factor": factor}, of_inertia(INERTIA / factor)
    in_pounds = {"factor": IMPERIAL_INERTIAS[0]}
    stated = StatedInertial(MASS / POUND, CENTER, INERTIA / IMPERIAL_INERTIAS[0])
    yield "unit", {"part": WHOLE_IMPERIAL, **in_pounds}, replace(stated, center=CENTER / INCH)
    yield "inertia_of_unit", {"part": "mass", "factor": MASS}, of_inertia(INERTIA / MASS)
    yield "inertia_of_unit", {"part": "density", "factor": DENSITY}, of_inertia(INERTIA / DENSITY)
    values = {"part": "the origin of the link"}
    yield "inertia_elsewhere", values, of_inertia(INERTIA + square(CENTER))
    values = {"part": "another point, by a parallel-axis term of the wrong sign"}
    yield "inertia_elsewhere", values, of_inertia(INERTIA - square(CENTER))
    yield (
        "inertia_elsewhere",
        {"part": "the origin of the mesh", "point": ORIGIN.tolist()},
        of_inertia(INERTIA + square(CENTER - ORIGIN)),
    )
    turn = rotation_of_angles(*ANGLES)
    for unit, wanted, convert in (("degrees", "radians", degrees), ("radians", "degrees", radians)):
        angles = tuple(map(convert, ANGLES))
        values = {"part": "inertial", "unit": unit, "wanted": wanted}
        yield "angles", values, along(turn, rotation_of_angles(*angles), angles=angles)
    w, x, y, z = quaternion(turn).tolist()
    for wrong, wanted in (((x, y, z, w), "w x y z"), ((z, w, x, y), "x y z w")):
        values = {"part": "quaternion of the inertial", "order": wanted}
        yield "order", values, along(turn, np.eye(3), quaternion=wrong)
    yield "transposed", {"part": "rotation of the inertial"}, along(turn, turn.T)
    yield "frame_not_meant", {}, replace(TRUTH, rotation=turn)
    own = along(turn, turn)
    for signs in list(product((1.0, -1.0), repeat=3))[1:]:
        is_wrong = np.array(signs) < 0.0
        names = [*compress(("xy", "xz", "yz"), is_wrong)]
        values, along_link = (
            {"part": "products of inertia", "axes": names},
            with_products(signs, INERTIA),
        )
        yield "sign", values, of_inertia(along_link)
        for tensor in (with_products(signs, own.tensor), turn.T @ along_link @ turn):
            yield "sign", values, replace(own, tensor=tensor)
        yield (
            "sign",
            {"part": "center of mass", "axes": [*compress("xyz", is_wrong)]},
            of_inertia(INERTIA, CENTER * signs),
        )
    for axis, way in product(range(3), (np.pi / 2.0, -np.pi / 2.0)):
        mirror, values = np.diag(1.0 - 2.0 * np.eye(3)[axis]), {"axis": "xyz"[axis]}
        mirrored = {"part": "inertial", "change": "mirrored along", **values}
        yield "turned", mirrored, of_inertia(mirror @ INERTIA @ mirror, mirror @ CENTER)
        values["change"] = "turned by 90 degrees about"
        turned = rotation_of_angles(*way * np.eye(3)[axis])
        tensor = turned @ INERTIA @ turned.T
        yield "turned", {"part": "inertial", **values}, of_inertia(tensor, turned @ CENTER)
        yield "turned", {"part": "inertia", **values}, of_inertia(tensor)
    diagonal = np.diag(np.diag(INERTIA))
    for order in list(permutations(range(3)))[1:]:
        axes, back = "".join("xyz"[axis] for axis in order), np.argsort(order)
        pairs = " ".join("".join(sorted(axes[i] + axes[j])) for i, j in ((0, 1), (0, 2), (1, 2)))
        swapped = INERTIA[np.ix_(back, back)]
        other = np.diag(np.diag(swapped))
        for part, names, stated in (
            ("axes of the inertia", axes, of_inertia(swapped)),
            ("axes of the center of mass", axes, of_inertia(INERTIA, CENTER[back])),
            ("axes of the inertial", axes, of_inertia(swapped, CENTER[back])),
            ("diagonal of the inertia", axes, of_inertia(INERTIA - diagonal + other)),
            ("products of inertia", pairs, of_inertia(swapped - other + diagonal)),
        ):
            yield "order", {"part": part, "order": names}, stated
    moments, axes = np.linalg.eigh(INERTIA)
    for order, signs in product(
        permutations(range(3)), ((1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1))
    ):
        rows = np.diag(signs) @ axes[:, order].T  # the tensor's own axes may then point either way
        tensor = rows @ np.diag(moments[list(order)]) @ rows.T
        if np.abs(tensor - INERTIA).max() > 1e-3:  # the axes are all but symmetric
            yield "transposed", {"part": "principal axes that make the tensor"}, of_inertia(tensor)


def said(stated=TRUTH, *references, otherwise=()):
    (found,) = diagnose(stated, references or [REFERENCE], otherwise)
    values = dict(found.finding.values)
    agree = values.pop("agree", None)
    is_center = values.get("part") == "center of mass"
    assert agree in (None, "the centers" if is_center else "inertial and geometry") or is_center
    return found.finding.code.removeprefix("audit_"), values


def test_two_mistakes_are_both_named():
    """A wrong center beside another mistake: each has its change, and the second one the inertial
    of both.
    """
    for wrong in (CENTER / 1e-2, CENTER * (1, -1, 1), CENTER[[1, 0, 2]]):
        for tensor in (
            INERTIA / 1e-6,
            INERTIA + square(CENTER),
            with_products((-1, -1, -1), INERTIA),
        ):
            first, second = diagnose(of_inertia(tensor, wrong), [REFERENCE])
            assert (
                first.finding.values["part"] in CENTERS
                and second.finding.values.get("part") not in CENTERS
            )
            assert REFERENCE.compare(second.repaired) < 1e-12
    uneven = of_inertia(INERTIA * 0.8, CENTER * (1, -1, 1))  # The mass is not spread evenly.
    assert [one.finding.code for one in diagnose(uneven, [REFERENCE])] == ["audit_not_uniform"]
    found, note = diagnose(uneven, [REFERENCE], (), True)
    assert note.finding.code == "audit_not_uniform" and abs(note.finding.values["distance"]) < 1e-15
    assert not found.is_certain and close(found.repaired.center, CENTER, 1e-15)


def test_center_repaired_alone_claims_agreement_of_centers_only():
    """The mass is not spread evenly: no change of the center makes the inertias agree."""
    found, note = diagnose(of_inertia(INERTIA * 0.8, CENTER / 1e-3), [REFERENCE], (), True)
    assert found.finding.values["agree"] == "the centers"
    assert note.finding.code == "audit_not_uniform"


def test_square_inches_of_kg_or_pounds_keep_the_mass_uncertainly():
    """kg·in², and lb·in² with pounds, are the same per kilogram: neither is certain."""
    for mass in (MASS, MASS / POUND):
        stated = StatedInertial(mass, CENTER, mass / MASS * INERTIA / INCH**2)
        (found,) = diagnose(stated, [REFERENCE])
        assert found.finding.values["factor"] == INCH**2 and not found.is_certain
        assert found.repaired.mass == mass and REFERENCE.compare(found.repaired) < 1e-12


SEQUENCES = {
    "urdf": "00 01 02 11 12 22",
    "mujoco": "00 11 22 01 02 12",
    "lower": "00 10 11 20 21 22",
    "fusion": "00 11 22 01 12 02",
}


@pytest.mark.parametrize("read, listed", [*permutations(SEQUENCES, 2)])
@pytest.mark.parametrize("turn", [np.eye(3), rotation_of_angles(*ANGLES)])
def test_six_numbers_in_another_order_are_certain(read, listed, turn):
    truth = turn.T @ INERTIA @ turn
    tensor = np.empty((3, 3))
    for (i, j), (k, m) in zip(SEQUENCES[read].split(), SEQUENCES[listed].split()):
        tensor[int(i), int(j)] = tensor[int(j), int(i)] = truth[int(k), int(m)]
    found = diagnose(StatedInertial(MASS, CENTER, tensor, turn), [REFERENCE])[0]
    assert found.finding.code == "audit_order" and found.is_certain
    assert REFERENCE.compare(found.repaired) < 1e-12


@pytest.mark.parametrize("unit", [INCH**2, 1e-4, 1e-6])
def test_inertia_of_mass_1_in_square_lengths_is_found(unit):
    (found,) = diagnose(of_inertia(INERTIA / MASS / unit), [REFERENCE])
    assert found.finding.values["factor"] == unit and REFERENCE.compare(found.repaired) < 1e-12


@pytest.mark.parametrize("unit", [1e-9, 1e-7])
def test_grams_and_their_inertia_are_one_certain_change(unit):
    stated = StatedInertial(MASS * 1e3, CENTER, INERTIA / unit)
    (found,) = diagnose(stated, [REFERENCE])
    assert found.is_certain and close(found.repaired.mass, MASS, 1e-14)
    assert close(found.repaired.inertia, INERTIA, 1e-14)


def of_density(density):
    return replace(REFERENCE, volume=MASS / density)


def test_a_mistake_is_found_named_and_repaired():
    for code, values, stated in mistakes():
        assert said(stated) == (code, values)
        repaired = diagnose(stated, [REFERENCE])[0].repaired
        assert REFERENCE.compare(repaired) <= 1e-12 < 1e-2 < REFERENCE.compare(stated) and close(
            repaired.mass, MASS, 1e-14
        )


@pytest.mark.parametrize("size", LENGTH_UNITS)
def test_a_mesh_in_another_unit_shows_in_the_density(size):
    scaled = Reference(REFERENCE.volume * size**3, CENTER * size, INERTIA / MASS * size**2)
    assert said(TRUTH, scaled) == ("unit", {"part": "lengths of the mesh", "factor": 1.0 / size})
    assert diagnose(TRUTH, [scaled])[0].repaired is None
    # with a density that is usual for the mesh as it is, the file is wrong
    stated = {"part": LENGTHS, "factor": size}
    if size == INCH:
        stated = {"part": WHOLE_IMPERIAL, "factor": IMPERIAL_INERTIAS[0]}
    assert said(TRUTH, replace(scaled, volume=MASS / DENSITY)) == ("unit", stated)
    mesh = "lengths of the mesh"
    for density, part in (
        (9.0, stated["part"]),
        (11.0, mesh),
        (29e3, mesh),
        (31e3, stated["part"]),
    ):
        assert said(TRUTH, replace(scaled, volume=MASS / density * size**3))[1]["part"] == part


@pytest.mark.parametrize(
    "density, code, factor",
    [
        *((density, None, None) for density in (10.01, 29_990.0)),
        *((density, "unit", 1e3) for density in (9.99, 0.1001)),
        *((density, "unit", 1e-3) for density in (100_010.0, 11_990_000.0)),
        *((density, "density", None) for density in (0.0999, 30_010.0, 99_900.0, 12_010_000.0)),
    ],
)
def test_impossible_density_is_reported(density, code, factor):
    found = diagnose(TRUTH, [of_density(density)])
    if code is None:
        assert not found
        return
    (found,) = found
    assert found.finding.code == "audit_" + code and close(
        found.finding.values["density"], density, 1e-12
    )
    assert found.finding.values.get("factor") == factor
    if factor is None:
        assert found.repaired is None
    else:
        assert close(found.repaired.mass, MASS * factor, 1e-14)
        assert (
            close(found.repaired.inertia, INERTIA * factor, 1e-14)
            and (found.repaired.center == CENTER).all()
        )


def test_mass_unit_is_blamed_only_for_impossible_density():
    for density, part in (
        (10.01, "mass"),
        (9.99, "inertia"),
        (9_990.0, "mass"),
        (10_010.0, "inertia"),
    ):
        code, values = said(replace(TRUTH, mass=MASS / 1e3), of_density(density))
        assert (code, values["part"]) == ("unit", part)
    for density, part in (
        (29.9, "inertia"),
        (30.1, "mass"),
        (29_990.0, "mass"),
        (30_010.0, "inertia"),
    ):
        code, values = said(replace(TRUTH, mass=MASS * 1e3), of_density(density))
        assert (code, values["part"]) == ("unit", part)


@pytest.mark.parametrize("value", [9.0, 0.029])
def test_a_number_of_a_file_keeps_its_decimals_in_another_unit(value):
    """A thousandth is a division by a thousand, not a product with 0.001, which rounds twice."""
    parts = [(1e-3, value / 1000.0), (1e-2, value / 100.0), (1e-6, value / 1e6)]
    for factor, truth in (
        *parts,
        *((whole, value * whole) for whole in (1.0, 0.0254, 1000.0, 1e6, 1.5, 0.6)),
    ):
        assert _times([value, -value], factor).tolist() == [truth, -truth]
    assert value * 1e-3 != value / 1000.0


def random_body(rng, symmetric=False):
    """The evenly filled geometry of a random brick or hull of points, in a turned frame."""
    points = rng.normal(size=(int(rng.integers(8, 20)), 3)) * rng.uniform(0.05, 0.3, 3)
    hull = convex_hull(points)
    volume = polyhedron_moments(Surface.from_triangles(hull.points, hull.triangles))[0]
    body = MassProperties.from_moments(volume, 1.0)
    moments, axes = np.linalg.eigh(body.inertia / body.mass)
    if symmetric:
        moments[:2] = moments[:2].mean()
    turn = bodies.rotation(int(rng.integers(1 << 30)))
    axes = turn @ axes
    inertia = (axes * moments) @ axes.T
    return Reference(body.mass, rng.normal(size=3), inertia), moments, axes


def swaps(moments):
    """The orders of principal moments that make another body."""
    for order in list(permutations(range(3)))[1:]:
        if np.abs(moments[list(order)] - moments).max() > 0.1 * moments[2]:
            yield list(order)


@pytest.mark.parametrize("seed", range(40))
def test_principal_moments_swapped_in_any_frame_are_found(seed):
    """Of random bodies, given along the link, in the principal frame, or in any other one."""
    rng = np.random.default_rng(seed)
    reference, moments, axes = random_body(rng)
    mass, center = 1000.0 * reference.volume, reference.center
    for order in swaps(moments):
        wrong = mass * (axes * moments[order]) @ axes.T
        frame = bodies.rotation(seed)
        for stated in (
            StatedInertial(mass, center, wrong),
            StatedInertial(mass, center, np.diag(mass * moments[order]), axes),
            StatedInertial(mass, center, frame.T @ wrong @ frame, frame),
        ):
            (found,) = diagnose(stated, [reference])
            assert found.finding.code == "audit_order" and found.is_certain
            assert reference.compare(found.repaired) < 1e-9
        turned = frame.T @ (mass * reference.inertia) @ frame
        back = np.argsort(order)
        stated = StatedInertial(mass, center, turned[np.ix_(back, back)], frame)
        if reference.compare(stated) < 0.02:
            continue  # The exchange happens to change nothing.
        (found,) = diagnose(stated, [reference])
        assert found.finding.values["order"] == "".join("xyz"[axis] for axis in order)
        assert found.finding.values["part"] == "axes of the inertia in its own frame"


@pytest.mark.parametrize("seed", range(20))
def test_swapped_moments_of_a_round_body_are_not_certain(seed):
    reference, moments, axes = random_body(np.random.default_rng(seed), symmetric=True)
    mass = 1000.0 * reference.volume
    for order in swaps(moments):
        wrong = StatedInertial(mass, reference.center, mass * (axes * moments[order]) @ axes.T)
        (found,) = diagnose(wrong, [reference])
        assert not found.is_certain and reference.compare(found.repaired) < 1e-9


def test_right_inertials_of_random_bodies_have_no_change():
    """Even fillings have no finding in any frame; uneven ones are no mistake that has a name."""
    changes = 0
    for seed in range(300):
        rng = np.random.default_rng(seed)
        reference, moments, axes = random_body(rng, seed % 3 == 0)
        mass, frame = 1000.0 * reference.volume, bodies.rotation(seed)
        inertia = mass * frame.T @ reference.inertia @ frame
        assert not diagnose(StatedInertial(mass, reference.center, inertia, frame), [reference])
        # Some of the mass is moved, and the moments change by some percent along any axes.
        tilt = bodies.rotation(seed + 1000) if seed % 2 else np.eye(3)
        bend = np.eye(3) + tilt @ np.diag(rng.uniform(-0.06, 0.06, 3)) @ tilt.T
        uneven = frame.T @ (bend @ (mass * reference.inertia) @ bend.T) @ frame
        center = reference.center + rng.normal(size=3) * 0.02 * np.sqrt(moments[2])
        found = diagnose(StatedInertial(mass, center, uneven, frame), [reference])
        changes += any(one.is_change for one in found)
    assert changes <= 1
