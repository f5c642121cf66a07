# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many objects measured together are each of them measured alone: numbers, bounds, findings,
frames, fingerprints.
"""

import numpy as np
import pytest
from body_moments.blender.bodies import measure_object
from body_moments.blender.bodies.measure_body import measure_body
from body_moments.blender.settings.options import AS_SET, MeasureOptions
from body_moments.core.solid import SmallSolid
from mathutils import Matrix

from tests.blender.many_objects import bpy, shards
from tests.corpus import scenes
from tests.corpus import shapes as s

pytestmark = pytest.mark.usefixtures("scene")
MESHES = (
    "closed",
    "faulty",
    "overlaps",
    "shapes",
    "shells",
    "booleans",
    "millimeters",
    "kilometers",
    "refused",
)
SAME = (
    "name",
    "type",
    "kind",
    "thickness",
    "density",
    "volume",
    "area",
    "fingerprint",
    "findings",
    "error_bound",
)


def alone(obj, depsgraph, options=AS_SET):
    try:
        return measure_body(obj, depsgraph, options)
    except Exception as error:
        return error


def assert_same(found, expected):
    """To the bit; the fingerprints' digests of areas under uneven maps, whose sums have another
    order, aside.
    """
    if isinstance(expected, Exception):
        assert isinstance(found, Exception) and str(found) == str(expected)
        return
    assert np.array_equal(found.reading.matrix, expected.reading.matrix)
    assert found.reading.matrix.dtype == np.float64
    places, own_places = (
        [matrices for _, matrices in getattr(each.body, "solids", ())] for each in (found, expected)
    )
    assert np.array_equal(places, own_places)
    one, other = found.measurement, expected.measurement
    for name in SAME:
        assert getattr(one, name) == getattr(other, name), (one.name, name)
    assert str(one.method) == str(other.method) and one.density_from == other.density_from
    assert one.health.as_record() == other.health.as_record(), one.name
    first, second = one.mass_properties, other.mass_properties
    assert (first.mass, first.rounding_error, first.input_error) == (
        second.mass,
        second.rounding_error,
        second.input_error,
    ), one.name
    for name in ("center", "inertia"):
        assert np.array_equal(getattr(first, name), getattr(second, name)), (one.name, name)
    assert np.array_equal(one.rotation, other.rotation) and np.array_equal(
        one.location, other.location
    )
    frame, own = first.principal, second.principal
    assert np.array_equal(frame.moments, own.moments)
    assert np.abs(frame.axes - own.axes).max() < 1e-11, one.name
    for name in ("symmetry", "is_unique", "finding", "undetermined_axes"):
        assert getattr(frame, name) == getattr(own, name), (one.name, name)
    for name in ("raw", "about", "rounding_error", "input_error") if one.volume_moments else ():
        assert np.array_equal(
            getattr(one.volume_moments, name), getattr(other.volume_moments, name)
        ), one.name


def _is_stacked(found):
    return not isinstance(found, Exception) and found.index is not None


def all_outcomes(objects, options=AS_SET):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    pairs = [
        pair
        for together in measure_object.measure_many(objects, depsgraph, options)
        for pair in together
    ]
    assert [obj for obj, _ in pairs] == list(objects)
    return pairs, depsgraph


def test_stacked_shards_equal_single_measurements():
    objects = shards()
    pairs, depsgraph = all_outcomes(objects)
    stacked = {obj.name.split()[0] for obj, found in pairs if _is_stacked(found)}
    together = {
        obj.name.split()[0]
        for obj, found in pairs
        if _is_stacked(found) and isinstance(found.shapes[found.member.shape], SmallSolid)
    }
    assert together >= {"shard", "box", "cylinder", "L", "two", "scattered"}
    assert together >= {"open", "tube", "holed", "halves", "warped"}
    assert not together & {"touching", "nested", "cavity", "inside", "with", "cracked"}
    assert stacked >= {
        "shard",
        "box",
        "cylinder",
        "L",
        "open",
        "two",
        "flipped",
        "inverted",
        "bent",
        "unwelded",
    }
    for obj, found in pairs:
        assert_same(found, alone(obj, depsgraph))


@pytest.mark.parametrize("name", MESHES)
def test_the_corpus_together_is_the_corpus_alone(name):
    scenes.SCENES[name]()
    bpy.context.view_layer.update()
    objects = [obj for obj in bpy.context.view_layer.objects if obj.type == "MESH"]
    pairs, depsgraph = all_outcomes(objects)
    for obj, found in pairs:
        expected = alone(obj, depsgraph)
        if _is_stacked(found) and np.ptp(obj.scale) > 1e-3 * max(obj.scale):
            continue  # areas under uneven maps: compared above
        assert_same(found, expected)


def object_of(points, faces, name="Object"):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(
        np.asarray(points, float).tolist(), [], [list(map(int, face)) for face in faces]
    )
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.update()
    return obj


def test_meshes_of_equal_corners_and_other_faces_differ():
    """A triangle and five corners, or five corners and a triangle, and what closes either of
    them.
    """
    points = [
        (0, 0, 0),
        (2, 0, 0.5),
        (3, 2, -0.5),
        (1, 3, 0),
        (-1, 2, 0.5),
        (2, 4, 1),
        (1, 1, 3),
        (2, 3, -3),
    ]
    a, b, c, d, e, g, p, q = range(8)
    rest = [(a, e, p), (e, d, p), (d, c, p), (c, b, p), (b, a, p), (a, c, q), (c, g, q), (g, a, q)]
    objects = [
        object_of(points, [*first, *rest])
        for first in ([(a, b, c, d, e), (a, g, c)], [(a, b, c), (d, e, a, g, c)])
    ]
    pairs, depsgraph = all_outcomes(objects)
    volumes = [found.measurement.volume for _, found in pairs]
    assert abs(volumes[0] - volumes[1]) > 0.01
    for obj, found in pairs:
        assert_same(found, alone(obj, depsgraph))


@pytest.mark.filterwarnings("error")
def test_overflowing_axes_are_refused_in_stacks_too(capfd):
    """A ring of many faces, whose sixth moments are no numbers."""
    points, faces = s.torus(48, 16)
    obj = object_of(1e36 * np.asarray(points), faces)
    ((_, found),), depsgraph = all_outcomes([obj])
    assert_same(found, alone(obj, depsgraph))
    assert not capfd.readouterr().err


@pytest.mark.parametrize(
    "settings",
    [
        {},
        {"mass_from": "MASS", "mass": 3.0},
        {"mass_from": "MASS", "mass": 0.0},
        {"mass_from": "MASS", "use_center": True, "given_center": (0.1, 0.2, 0.3)},
        {"mass_from": "MASS", "use_inertia": True, "given_inertia_diagonal": (3.0, 4.0, 5.0)},
        {"density_from": "POLYNOMIAL", "density_polynomial": "100 + x"},
        {"kind": "SHELL"},
        {"overlap": "UNION"},
    ],
)
def test_object_settings_and_options_hold_in_stacks(settings):
    obj = object_of(*s.box())
    for name, value in settings.items():
        setattr(obj.body_moments, name, value)
    bpy.context.view_layer.update()
    for options in (
        {},
        {"mass": 5.0},
        {"mass": 0.0},
        {"density": 7.0, "unit_scale": 0.001},
        {"density": 0.0},
        {"kind": "solid", "overlap": "signed"},
        {"kind": "shell", "thickness": 0.001},
        {"overlap": "union"},
        {"order": 2},
    ):
        pairs, depsgraph = all_outcomes([obj], MeasureOptions(**options))
        assert_same(pairs[0][1], alone(obj, depsgraph, MeasureOptions(**options)))


@pytest.mark.parametrize("modifier", [None, "TRIANGULATE"])
def test_edited_mesh_is_integrated_again(modifier):
    obj = object_of(*s.box())
    if modifier:
        obj.modifiers.new("", modifier)
    volumes = []
    for height in (1.0, 3.0, 1.0):
        obj.data.transform(Matrix.Diagonal((1.0, 1.0, height, 1.0)))
        obj.data.update()
        bpy.context.view_layer.update()
        ((_, found),), _ = all_outcomes([obj])
        volumes.append(found.measurement.volume)
    assert volumes == pytest.approx([1.0, 3.0, 3.0], rel=1e-12)


def test_a_stack_that_fails_measures_each_alone(monkeypatch, capfd):
    objects = shards(1)
    whole, _ = all_outcomes(objects)
    monkeypatch.setattr(measure_object, "measure_again", lambda *_: 1 / 0)
    again, _ = all_outcomes(objects)
    assert not any(_is_stacked(found) for _, found in again)
    assert "ZeroDivisionError" in capfd.readouterr().err
    for (_, found), (_, other) in zip(whole, again):
        assert_same(found, other)
