# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The one call from arrays to all results."""

import pickle

import numpy as np
import pytest
from body_moments.core import MeasureError, mass_properties
from body_moments.core.measurement.settings import Settings

from tests.close import close
from tests.core.bodies import box, moved, rotation, without
from tests.core.findings import refused


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_turned_brick_has_its_closed_forms(size):
    turn, place = rotation(3), np.array([30.0, -20.0, 7.0]) * size
    brick = moved(box((0.0, 0.0, 0.0), np.array([1.0, 2.0, 3.0]) * size), turn, place)
    body = mass_properties(*brick, density=2.0)
    found, mass = body.mass_properties, 12.0 * size**3
    assert (
        str(body.method) == "exact" and body.findings == () and close(found.mass, mass, rel=1e-12)
    )
    np.testing.assert_allclose(
        found.center, turn @ (np.array([0.5, 1.0, 1.5]) * size) + place, rtol=1e-12
    )
    squares = np.array([1.0, 4.0, 9.0]) * size**2
    inertia = turn @ np.diag(squares.sum() - squares) @ turn.T * mass / 12.0
    np.testing.assert_allclose(found.inertia, inertia, atol=1e-10 * inertia.max())
    assert close(body.area, 22.0 * size**2, rel=1e-12)
    assert abs(found.mass - mass) <= body.error_bound["volume"] * 2.0 + 4e-16 * mass
    principal = pickle.loads(pickle.dumps(body)).mass_properties.principal
    assert np.allclose(np.abs(turn.T @ principal.axes), np.eye(3)[::-1], atol=1e-12)
    assert np.array_equal(principal.axes, found.principal.axes)


def test_open_box_is_capped_and_says_so():
    body = mass_properties(*without(box(), 2, 3), density=1.0)
    assert str(body.method) == "capped" and [str(found.code) for found in body.findings] == [
        "holes_capped"
    ]
    assert close(body.mass_properties.mass, 1.0, rel=1e-12)


def test_float32_far_away_warns_or_is_refused():
    """Half an ulp is 3e-5 there: the center of a cube of 10 cm is uncertain, and the volume of a
    plate of 1 mm.
    """
    cube, plate = (
        box((1e3, 1e3, 1e3), (1e3 + thick, 1e3 + 0.1, 1e3 + 0.1)) for thick in (0.1, 1e-3)
    )
    (found,) = mass_properties(cube[0].astype(np.float32), cube[1], density=1.0).findings
    assert found.code == "large_bound" and found.values["quantity"] == "center of mass"
    with refused("no_certain_volume"):
        mass_properties(plate[0].astype(np.float32), plate[1], density=1.0)


@pytest.mark.parametrize("density", [0.0, -1.0, float("nan")])
def test_density_that_is_not_positive_is_refused(density):
    with pytest.raises(MeasureError, match="density"):
        mass_properties(*box(), density=density)


USED = {
    "kind": "solid",
    "density": 1000.0,
    "mass": None,
    "thickness": 0.0123456,
    "overlap": "signed",
    "unit": 1.0,
}


def digest(**changes):
    return Settings(**{**USED, **changes}).digest


def test_unused_settings_of_a_kind_do_not_count():
    for kind, same, other in (
        ("solid", ({"thickness": 5.0}, {"wall": "inward"}), ({"overlap": "union"},)),
        (
            "shell",
            ({"overlap": "union"}, {"wall": "thin"}),
            ({"thickness": 5.0}, {"wall": "inward"}),
        ),
        ("wire", ({"thickness": 5.0}, {"overlap": "union"}, {"wall": "inward"}), ()),
    ):
        known = digest(kind=kind)
        assert all(digest(kind=kind, **change) == known for change in same)
        other = [
            *other,
            {"density": 1001.0},
            {"mass": 1.0},
            {"density": None},
            {"unit": 2.0},
            {"varying": "a"},
        ]
        found = [digest(kind=kind, **change) for change in other]
        assert len({known, *found}) == len(found) + 1
        varying = digest(kind=kind, varying="a")
        assert (
            varying == digest(kind=kind, varying="a", density=5.0) != digest(kind=kind, varying="b")
        )
    assert len({digest(kind=kind) for kind in ("solid", "shell", "wire")}) == 3


def test_digest_of_saved_files_is_unchanged():
    assert digest() == "ed2979b47ccf"
    assert digest(kind="shell", wall="inward", varying="a") == "479050371f99"
