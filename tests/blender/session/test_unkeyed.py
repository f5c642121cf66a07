# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Values that have keys, and were changed without a new one, stay as they are: Blender puts them
back wherever it evaluates animation, and nothing here may make it do so.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.session import memory
from body_moments.blender.session.live import measuring as live
from body_moments.blender.session.tracking import staleness

from tests.blender.objects import add, measure, measured, mesh_body, only
from tests.blender.operator_calls import OPERATORS

pytestmark = pytest.mark.usefixtures("scene")

CHANGED = 0.5
CHANNELS = {
    "location": "location",
    "rotation": "rotation_euler",
    "modifier": 'modifiers["Solidify"].thickness',
    "property": '["own"]',
    "influence": 'constraints["Copy Location"].influence',
    "shape key": 'data.shape_keys.key_blocks["Key"].value',
}


def value(obj, channel):
    found = obj.path_resolve(CHANNELS[channel])
    return found if isinstance(found, float) else found[0]


def change(obj, channel, number):
    """Set it, as a person would, without a key."""
    path = CHANNELS[channel]
    if channel == "property":
        obj["own"] = number
        obj.update_tag()
    elif isinstance(obj.path_resolve(path), float):
        owner, _, name = path.rpartition(".")
        setattr(obj.path_resolve(owner), name, number)
    else:
        obj.path_resolve(path)[0] = number
    bpy.context.view_layer.update()


def keyed(channel):
    """A measured object with one keyed channel that was changed since, and a copy of it beside
    it.
    """
    obj = add(mesh_body())
    obj["own"] = 0.25
    obj.vertex_groups.new(name="Group").add([0, 1, 2], 1.0, "REPLACE")
    if channel == "modifier":
        obj.modifiers.new("Solidify", "SOLIDIFY").thickness = 0.01
    if channel == "influence":
        constraint = obj.constraints.new("COPY_LOCATION")
        constraint.target, constraint.influence = add(None, "Target", (4, 5, 6), select=False), 0.0
    if channel == "shape key":
        obj.shape_key_add(name="Basis")
        obj.shape_key_add(name="Key").data[0].co.x -= 1.0
        obj.data.shape_keys.key_blocks["Key"].value = 0.0
    path = CHANNELS[channel].removeprefix("data.shape_keys.")
    (obj.data.shape_keys if channel == "shape key" else obj).keyframe_insert(path, frame=1)
    active = add(mesh_body("Active"), "Active", (0, 30, 0), (0.3, 0.2, 0.1))
    measure(obj)
    only(active, obj)
    return obj


def is_right(obj):
    """Whether the stored numbers are those of what is shown, or are said not to be."""
    before = staleness.stale_reason(obj, bpy.context.scene)
    now = measured(obj)
    return (
        before
        or np.isclose(obj["body_mass"], now.mass_properties.mass, rtol=1e-6, atol=0)
        and np.allclose(
            obj["body_center_of_mass"], now.in_object_frame().center, rtol=1e-5, atol=1e-6
        )
    )


@pytest.mark.parametrize("name", OPERATORS)
@pytest.mark.parametrize("channel", CHANNELS)
def test_unkeyed_values_survive_operators(channel, name):
    obj = keyed(channel)
    change(obj, channel, CHANGED)
    if name != "match":
        bpy.context.view_layer.objects.active = obj
    OPERATORS[name]()
    bpy.context.view_layer.update()
    assert value(obj, channel) == CHANGED
    assert name == "clear" or is_right(obj)
    if name == "measure":
        assert staleness.stale_reason(obj, bpy.context.scene) is None


def test_drivers_follow_storing_without_evaluating_geometry():
    obj = add(mesh_body())
    obj["own"] = 0.0
    other = add(None, "Other", select=False)
    # shown anew with whatever moves its operand
    user = add(mesh_body("User"), "User", select=False)
    user.modifiers.new("Boolean", "BOOLEAN").object = obj
    add(mesh_body("Child"), "Child", select=False, parent=obj)
    measure(obj)
    for owner, path, source in (
        (other, "location", '["body_mass"]'),
        (obj, '["own"]', '["body_center_of_mass"][1]'),
    ):
        driver = (
            owner.driver_add(path, 0).driver
            if path == "location"
            else owner.driver_add(path).driver
        )
        variable = driver.variables.new()
        driver.expression = variable.name
        variable.targets[0].id, variable.targets[0].data_path = obj, source
    obj.keyframe_insert("scale", frame=1)
    obj.scale.x = 2.0
    told = []
    bpy.app.handlers.depsgraph_update_post.append(
        lambda _scene, graph: told.extend(
            one.id.name
            for one in graph.updates
            if one.is_updated_geometry or one.is_updated_transform
        )
    )
    try:
        for density in (2000.0, 3000.0):
            obj.body_moments.density = density
            bpy.context.view_layer.update()
            told.clear()
            bpy.ops.object.body_moments_measure()
            bpy.context.view_layer.update()
            assert other.location.x == pytest.approx(obj["body_mass"], rel=1e-6)
            assert obj["own"] == pytest.approx(obj["body_center_of_mass"][1], rel=1e-6)
            assert set(told) == {"Other"}
        bpy.ops.object.body_moments_clear()
        bpy.context.view_layer.update()
        assert other.animation_data.drivers[0].driver.is_valid is False
    finally:
        bpy.app.handlers.depsgraph_update_post.pop()
    assert obj.scale.x == 2.0


def test_live_keeps_unkeyed_values_and_stops(monkeypatch):
    monkeypatch.setattr(live, "IDLE", 0.0)
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    obj = bpy.context.object
    obj.keyframe_insert("scale", frame=1)
    bpy.ops.object.body_moments_live()
    obj.scale.x = 2.0
    bpy.context.view_layer.update()
    live._tick()
    bpy.ops.object.body_moments_measure()
    live._tick()
    bpy.context.view_layer.update()
    assert obj.scale.x == 2.0 and not memory.followed[obj].is_pending
    assert memory.followed[obj].measurement.volume == pytest.approx(obj["body_volume"], rel=1e-9)
    assert memory.followed[obj].measurement.volume == pytest.approx(measured(obj).volume, rel=1e-9)


def test_wall_slider_keeps_unkeyed_values():
    obj = keyed("rotation")
    obj.body_moments.kind, obj.body_moments.wall, obj.body_moments.thickness = (
        "SHELL",
        "INWARD",
        0.01,
    )
    change(obj, "rotation", CHANGED)
    measure(obj)
    before = obj["body_mass"]
    obj.body_moments.thickness = 0.02
    bpy.context.view_layer.update()
    assert obj["body_mass"] > 1.5 * before and value(obj, "rotation") == CHANGED
    assert staleness.stale_reason(obj, bpy.context.scene) is None and is_right(obj)
