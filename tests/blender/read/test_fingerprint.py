# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What numbers are known to be of: each thing that they depend on makes another text, and nothing else does."""

from types import SimpleNamespace

import numpy as np
import pytest
from body_moments.blender.read import fingerprint
from body_moments.core.mesh.surface import Surface

from tests.blender.robot_truth import about

pytestmark = pytest.mark.usefixtures("scene")
SCALES = np.array([0.5, 3.0, 40.0])
WITHIN, BEYOND = 1.8e-6, 2.2e-6  # float32 matrices change scales by as much where an object turns


def standing(linear, place=(0.0, 0.0, 0.0), kind="MESH", systems=(), **settings):
    """As an object, with a matrix in float64."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = linear, place
    values = {"mass_from": "DENSITY", "density_from": "VALUE", "density_frame": "OBJECT", **settings}
    return SimpleNamespace(
        matrix_world=matrix, type=kind, particle_systems=systems, body_moments=SimpleNamespace(**values)
    )


def keys_of(obj):
    return fingerprint.transform_key(obj), fingerprint.transform_keys(np.array(obj.matrix_world)[None])[0]


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_transform_is_known_by_how_it_scales_and_mirrors_alone(sign):
    turns = [np.eye(3), about((1, 2, 3), 0.7), about((3, -1, 0.5), -2.5)]
    signs = [np.array(row) for row in ((sign, 1, 1), (1, sign, 1), (-sign, -1, 1))]
    for turn in turns:
        for mirror in signs:
            for key in keys_of(standing(turn @ np.diag(mirror * SCALES), (1, 2, 3))):
                assert key[0] == ("+" if sign > 0 else "-")
                for other in turns:
                    now = other @ np.diag(signs[0] * SCALES)
                    assert fingerprint.has_transform(standing(now, (9, 0, -7)), key)
                    assert not fingerprint.has_transform(standing(-now), key)
                    for axis in range(3):
                        for off, is_same in ((WITHIN, True), (-WITHIN, True), (BEYOND, False), (-BEYOND, False)):
                            grown = np.ones(3)
                            grown[axis] += off
                            assert fingerprint.has_transform(standing(now * grown), key) == is_same


@pytest.mark.parametrize("pair", [(0, 1), (1, 2), (2, 0)])
@pytest.mark.parametrize("swapped", [False, True])
def test_what_is_sheared_flat_or_of_no_size_is_known_by_all_of_its_matrix(pair, swapped):
    first, second = pair[::-1] if swapped else pair
    for off, is_known in ((WITHIN, True), (-WITHIN, True), (BEYOND, False), (-BEYOND, False)):
        linear = (
            about((1, 2, 3), 0.7) @ (np.eye(3) + off * np.outer(np.eye(3)[first], np.eye(3)[second])) @ np.diag(SCALES)
        )
        obj = standing(linear, (1, 2, 3))
        for key in keys_of(obj):
            assert (key[0] in "+-") == is_known
            assert fingerprint.has_transform(obj, key)
            moved = standing(linear, (1, 2, 4))
            assert fingerprint.has_transform(moved, key) == is_known
            assert is_known or key == fingerprint.matrix_hash(obj) != fingerprint.matrix_hash(moved)
    for length in (0.0, np.inf, np.nan):
        scales = SCALES.copy()
        scales[first] = length
        obj = standing(np.diag(scales) if length == 0.0 else np.where(np.eye(3) > 0, scales, 0.0))
        for key in keys_of(obj):
            assert key == fingerprint.matrix_hash(obj) and not fingerprint.has_transform(standing(np.diag(SCALES)), key)
        assert not fingerprint.has_transform(obj, keys_of(standing(np.diag(SCALES)))[0])


@pytest.mark.parametrize(
    "options, moves_along",
    [
        ({}, True),
        ({"kind": "META"}, False),
        ({"systems": (1,)}, False),
        ({"density_from": "MATERIALS"}, True),
        ({"density_from": "POLYNOMIAL"}, True),
        ({"density_from": "POLYNOMIAL", "density_frame": "WORLD"}, False),
        ({"density_from": "POLYNOMIAL", "density_frame": "WORLD", "mass_from": "MASS"}, True),
        ({"density_from": "VOLUME"}, False),
        ({"density_from": "VOLUME", "mass_from": "MASS"}, True),
    ],
)
def test_the_numbers_of_a_body_that_does_not_move_along_depend_on_where_its_object_is(options, moves_along):
    linear = about((1, 2, 3), 0.7) @ np.diag(SCALES)
    key = fingerprint.transform_key(standing(linear, **options))
    assert (key[0] in "+-") == moves_along
    assert fingerprint.has_transform(standing(linear, (0, 0, 1e-3), **options), key) == moves_along
    scale = fingerprint.transform_key(standing(linear))
    assert fingerprint.has_transform(standing(linear, **options), scale) == moves_along


def test_a_scale_is_known_to_five_digits_and_by_nothing_else():
    linear = about((1, 2, 3), 0.7) @ np.diag(SCALES)
    known = fingerprint.scale_hash(standing(linear))
    assert known == fingerprint.scale_hash(standing(2.0 * about((1, 0, 1), 2.0) @ linear, (1, 2, 3)))
    exact = fingerprint.scale_hash(standing(np.diag([1.0, 0.5, 1.0])))
    for off, is_same in ((4e-6, True), (8e-6, False)):  # of its square, half a step
        assert (fingerprint.scale_hash(standing(np.diag([1.0, 0.5 + off, 1.0]))) == exact) == is_same
        shear = np.diag([1.0, 0.5, 1.0])
        shear[0, 2] = off
        assert (fingerprint.scale_hash(standing(shear)) == exact) == is_same
    assert fingerprint.scale_hash(standing(np.zeros((3, 3)))) not in (known, exact)
    assert fingerprint.scale_hash(standing(np.diag([-1.0, 1.0, 1.0]) @ linear)) == known


GEOMETRY, SETTINGS, OTHER_SETTINGS = "50d4ad0b3a2b", "ed2979b47ccf", "479050371f99"  # BLAKE2s, six bytes
USED = {
    "kind": "SOLID",
    "density": 1000.0,
    "mass": None,
    "thickness": 0.0123456,
    "overlap": "SIGNED",
    "unit_scale": 1.0,
}


def settings(**changes):
    return fingerprint.effective_hash(**{**USED, **changes})


def test_settings_that_a_kind_has_no_use_for_do_not_count():
    for kind, same, other in (
        ("SOLID", ({"thickness": 5.0}, {"wall": "INWARD"}), ({"overlap": "UNION"},)),
        ("SHELL", ({"overlap": "UNION"}, {"wall": "THIN"}), ({"thickness": 5.0}, {"wall": "INWARD"})),
        ("WIRE", ({"thickness": 5.0}, {"overlap": "UNION"}, {"wall": "INWARD"}), ()),
    ):
        known = settings(kind=kind)
        assert all(settings(kind=kind, **change) == known for change in same)
        other = [*other, {"density": 1001.0}, {"mass": 1.0}, {"density": None}, {"unit_scale": 2.0}, {"varying": "a"}]
        found = [settings(kind=kind, **change) for change in other]
        assert len({known, *found}) == len(found) + 1
        varying = settings(kind=kind, varying="a")
        assert varying == settings(kind=kind, varying="a", density=5.0) != settings(kind=kind, varying="b")
    assert len({settings(kind=kind) for kind in ("SOLID", "SHELL", "WIRE")}) == 3


def test_fingerprints_of_files_that_were_saved_are_known_for_ever():
    assert fingerprint.fingerprint(b"geometry", "matrix", "settings") == "v1:{}:matrix:settings".format(GEOMETRY)
    assert fingerprint.digest(np.frombuffer(b"geometry", np.uint8)) == GEOMETRY
    assert settings() == SETTINGS and settings(kind="SHELL", wall="INWARD", varying="a") == OTHER_SETTINGS


def test_shapes_are_told_apart_by_points_triangles_and_quads():
    points = np.arange(12, dtype=np.float32).reshape(4, 3)
    triangle, quad = np.array([[0, 1, 2]], np.int32), np.array([[0, 1, 2, 3]], np.int32)
    shapes = [
        Surface(points, triangles=triangle),
        Surface(points + 1, triangles=triangle),
        Surface(points, triangles=triangle[:, ::-1]),
        Surface(points, quads=quad),
        Surface(points, quads=quad, triangles=triangle),
        Surface(points, triangles=np.array([[0, 1, 2], [3, 0, 1]], np.int32)),
    ]
    found = [fingerprint.surface_digest(shape, 50_000) for shape in shapes]
    assert None not in found and len(set(found)) == len(shapes)
    assert fingerprint.surface_digest(Surface(points.copy(), triangles=triangle.copy()), 1) == found[0]
    assert fingerprint.surface_digest(shapes[0], 50_001) is None
