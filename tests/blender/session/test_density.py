# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stored results follow a density that is one number, as measuring again would make them; what
changes more than a factor leaves them, out of date.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.session import displayed
from body_moments.blender.session.displayed import Verdict, drawn
from body_moments.blender.session.tracking import staleness
from body_moments.blender.session.tracking.stamps import Stale
from body_moments.blender.write import properties

from tests.blender.objects import add, dent, measured, mesh_body, only
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def reason(obj):
    bpy.context.view_layer.update()
    return staleness.stale_reason(obj, bpy.context.scene)


def measure(*objects):
    only(*objects)
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}
    assert [reason(obj) for obj in objects] == [None] * len(objects)


def stored(obj):
    values = {key: obj[key] for key in properties.DESCRIPTIONS if key in obj}
    return {
        key: value.to_list() if hasattr(value, "to_list") else value
        for key, value in values.items()
    }


def assert_as_measured(obj):
    """What is stored is up to date, and what Measure would store."""
    assert reason(obj) is None
    followed = stored(obj)
    measure(obj)
    again = stored(obj)
    assert followed.keys() == again.keys()
    for key, value in again.items():
        if isinstance(value, str):
            assert value == followed[key], key
        elif key != "body_error_bound":
            assert np.linalg.norm(np.subtract(value, followed[key])) <= 1e-13 * np.linalg.norm(
                value
            ), key
    for bound, least in zip(followed["body_error_bound"], again["body_error_bound"], strict=True):
        assert least * (1.0 - 1e-12) <= bound <= 2.0 * least


def thin(settings):
    settings.kind, settings.thickness = "SHELL", 0.01


def wall(settings):
    settings.kind, settings.wall, settings.thickness = "SHELL", "INWARD", 0.01


def wire(settings):
    settings.kind = "WIRE"


def as_set(_settings):
    pass


def circle():
    bpy.ops.curve.primitive_bezier_circle_add(radius=2.0)
    return bpy.context.object


@pytest.mark.parametrize("kind", [as_set, thin, wall, wire])
def test_density_and_given_mass_update_results_as_measured(kind):
    obj = (
        circle()
        if kind is wire
        else add(mesh_body(), location=(40, -3, 2), rotation=(1, 2, 3), scale=(1, 2, -3))
    )
    settings = obj.body_moments
    kind(settings)
    measure(obj)
    note = "density_defaulted"
    assert note in obj["body_findings"]
    for name, value in (
        ("linear_density" if kind is wire else "density", 7850.0),
        ("mass", 4.2),
        ("mass_from", "MASS"),
        ("mass", 1e-9),
        ("density", 300.0),
        ("mass_from", "DENSITY"),
        ("linear_density", 0.25),
    ):
        setattr(settings, name, value)
        assert reason(obj) is None, (name, value)
        assert note not in obj["body_findings"]
    assert_as_measured(obj)
    settings.mass_from, settings.mass = "MASS", 12.5
    assert_as_measured(obj)


def test_thousand_density_changes_stay_within_bound():
    obj = add(mesh_body(), location=(40, -3, 2), rotation=(1, 2, 3))
    measure(obj)
    for i in range(1000):
        obj.body_moments.density = 1000.0 + 7.3 * ((i * 37) % 101)
    now = measured(obj)
    assert reason(obj) is None
    found = np.array(obj["body_principal_moments"])
    assert (
        np.linalg.norm(found - now.mass_properties.principal.moments)
        <= 3.0 * obj["body_error_bound"][3]
    )
    assert close(obj["body_mass"], now.mass_properties.mass, 1e-15)


def test_drivers_of_stored_numbers_see_the_new_ones():
    obj, other = add(mesh_body()), add(mesh_body(), "Other", select=False)
    measure(obj)
    curve = other.driver_add("location", 2)
    variable = curve.driver.variables.new()
    variable.targets[0].id, variable.targets[0].data_path = obj, '["body_mass"]'
    curve.driver.expression = variable.name
    bpy.context.view_layer.update()
    before = other.location.z
    obj.body_moments.density = 2000.0
    bpy.context.view_layer.update()
    assert close(other.location.z, 2.0 * before, 1e-6)


def test_undo_brings_back_numbers_and_setting_together():
    obj = add(mesh_body())
    measure(obj)
    bpy.ops.ed.undo_push(message="Measured")
    before = stored(obj)
    obj.body_moments.density = 2500.0
    bpy.context.view_layer.update()
    bpy.ops.ed.undo_push(message="Density")
    after = stored(obj)
    for step, numbers, density in (("undo", before, 1000.0), ("redo", after, 2500.0)):
        assert getattr(bpy.ops.ed, step)() == {"FINISHED"}
        obj = bpy.data.objects["Body"]
        assert (
            stored(obj) == numbers and obj.body_moments.density == density and reason(obj) is None
        )


def edited(obj):
    dent(obj, -1.0)
    return Stale.GEOMETRY


def scaled(obj):
    obj.scale.x = 2.0
    return Stale.TRANSFORM


def other_kind(obj):
    obj.body_moments.kind, obj.body_moments.thickness = "SHELL", 0.1
    return Stale.SETTINGS


def varying(obj):
    obj.body_moments.density_from = "POLYNOMIAL"
    return Stale.SETTINGS


@pytest.mark.parametrize("change", [edited, scaled, other_kind, varying])
def test_stale_results_stay_stale_after_density_change(change):
    obj = add(mesh_body())
    measure(obj)
    code = change(obj)
    assert reason(obj) == code
    obj.body_moments.density = 2000.0
    assert reason(obj) == code


def test_a_density_that_varies_is_measured_again():
    obj = add(mesh_body())
    obj.body_moments.density_from = "POLYNOMIAL"
    obj.body_moments.density_polynomial = "1000 + 20*z"
    measure(obj)
    before = stored(obj)
    obj.body_moments.density_from = "VALUE"
    obj.body_moments.mass_from = "MASS"
    assert reason(obj) == Stale.SETTINGS and stored(obj) == before
    obj.body_moments.density_from, obj.body_moments.mass_from = "POLYNOMIAL", "DENSITY"
    assert reason(obj) is None
    obj.body_moments.mass = 3.0  # is not what it weighs
    assert reason(obj) is None and stored(obj) == before


def by_keyframes(obj, name, values):
    for frame, value in enumerate(values, start=1):
        setattr(obj.body_moments, name, value)
        obj.keyframe_insert("body_moments." + name, frame=frame)


def by_driver(obj, name, values):
    curve = obj.driver_add("body_moments." + name)
    curve.driver.expression = "{!r} if frame < 2 else {!r}".format(*values)


@pytest.mark.parametrize("change", [by_keyframes, by_driver])
@pytest.mark.parametrize("mass_from, name", [("DENSITY", "density"), ("MASS", "mass")])
def test_animated_setting_makes_results_stale(mass_from, name, change):
    scene, obj, other = bpy.context.scene, add(mesh_body()), add(mesh_body(), "Other")
    obj.body_moments.mass_from = mass_from
    scene.frame_set(1)
    change(obj, name, (1000.0, 3000.0))
    scene.frame_set(1)
    measure(obj, other)
    before = stored(obj)
    scene.frame_set(2)
    assert close(getattr(obj.body_moments, name), 3000.0, 1e-7)
    assert reason(obj) == Stale.SETTINGS and stored(obj) == before
    assert drawn(obj, scene).verdict == Verdict.OUT_OF_DATE  # in the list and the panel
    assert displayed.total(bpy.context).stale == (obj.name,)
    if name == "density":
        scene.body_moments.default_material = "Copper"  # which is not its own
        assert reason(obj) == Stale.SETTINGS and stored(obj) == before
    other.body_moments.density = 2.0  # what is set beside it is followed as ever
    assert reason(other) is None and reason(obj) == Stale.SETTINGS and stored(obj) == before
    scene.frame_set(1)
    assert reason(obj) is None and drawn(obj, scene).verdict == Verdict.EXACT


def test_zero_and_unheard_of_densities_leave_the_numbers():
    obj = add(mesh_body())
    measure(obj)
    before = stored(obj)
    obj.body_moments.density = 0.0
    assert reason(obj) == Stale.SETTINGS and stored(obj) == before
    obj.body_moments.density = 500.0
    assert_as_measured(obj)


def linked_and_local(folder):
    """Two measured objects, one of another file."""
    path = str(folder / "library.blend")
    obj = add(mesh_body(), "Linked")
    measure(obj)
    bpy.data.libraries.write(path, {obj})
    bpy.data.objects.remove(obj)
    with bpy.data.libraries.load(path, link=True) as (_source, target):
        target.objects = ["Linked"]
    linked, local = target.objects[0], add(mesh_body(), "Local")
    bpy.context.scene.collection.objects.link(linked)
    measure(local)
    return linked, local


def test_linked_and_overriding_objects_are_skipped_and_named(tmp_path, reported):
    linked, local = linked_and_local(tmp_path)
    only(local, linked)
    before = stored(linked)
    assert bpy.ops.object.body_moments_set_material(material="Aluminum 6061") == {"FINISHED"}
    assert reported.codes.count("failure") == 1 and reported.values("failure")["object"].startswith(
        "Linked"
    )
    assert (
        stored(linked) == before and local["body_density"] == local.body_moments.density != 1000.0
    )
    assert_as_measured(local)


def test_reference_inertia_follows_density_and_not_motion():
    obj = add(mesh_body(), location=(4, -3, 2), rotation=(1, 2, 3))
    measure(obj)
    assert bpy.ops.object.body_moments_store_reference() == {"FINISHED"}
    before, mark = obj["body_reference_inertia"].to_list(), obj["body_fingerprint"]
    obj.body_moments.density = 3000.0
    assert reason(obj) is None and close(
        obj["body_reference_inertia"].to_list(), np.multiply(before, 3.0), 1e-9
    )
    obj.location.x += 1.0
    assert reason(obj) == Stale.TRANSFORM
    assert_as_measured_after(obj, mark)


def assert_as_measured_after(obj, mark):
    """Measuring stores what is about the reference again, for the place where the object is."""
    measure(obj)
    assert obj["body_fingerprint"] != mark and "body_reference_inertia" in obj
    obj.location.x -= 1.0
    assert reason(obj) == Stale.TRANSFORM
