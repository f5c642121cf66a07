# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Float, its positions and righting arms: places through Blender's matrices, tanks, refusals."""

import bpy
import numpy as np
import pytest
from body_moments.blender.session.live import measuring
from body_moments.blender.session.stored import floating

from tests.blender import objects
from tests.operators.standing import box
from tests.panels.drawing import shown

BLENDER = 2e-6  # of the size, through float32 matrices


def hull(sides=(6.0, 2.0, 1.0), density=500.0, **place):
    obj = objects.add(box(sides, offset=-np.array(sides) / 2.0), **place)
    obj.body_moments.density = density
    return obj


def water(scene, density=1000.0, level=0.0):
    scene.body_moments_liquid.liquid = "OTHER"
    scene.body_moments_liquid.density = density
    scene.body_moments_liquid.level = level


def held(obj):
    bpy.context.view_layer.update()
    return floating.held_body(obj, bpy.context.scene)


@pytest.mark.parametrize("scale", [1.0, 0.01])
def test_box_floats_at_its_draught(scene, scale):
    scene.unit_settings.scale_length = scale
    water(scene, level=3.0)
    obj = hull(location=(4.0, 5.0, 9.0), rotation=(0.2, -0.1, 0.7))
    assert bpy.ops.object.body_moments_float() == {"FINISHED"}
    found = held(obj)
    assert found.is_at_rest
    assert tuple(obj.matrix_world.col[2][:3]) == pytest.approx((0.0, 0.0, 1.0), abs=BLENDER)
    assert tuple(obj.location) == pytest.approx((4.0, 5.0, 3.0), abs=1e-5)
    assert obj.rotation_euler.z == pytest.approx(0.7, abs=0.05)
    assert found.state.draught == pytest.approx(0.5 * scale, rel=1e-6)
    assert found.to_world(found.state.center_of_buoyancy) / scale == pytest.approx(
        (4.0, 5.0, 2.75), abs=1e-5
    )
    bpy.ops.ed.undo_push()
    bpy.ops.ed.undo_push()
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Body"]
    assert held(obj).is_at_rest
    assert bpy.ops.object.body_moments_float() == {"CANCELLED"}  # already at rest
    assert tuple(obj.location) == pytest.approx((4.0, 5.0, 3.0), abs=1e-5)


def test_turned_body_shows_its_righting_arm(scene):
    water(scene)
    obj = hull()
    bpy.ops.object.body_moments_float()
    obj.rotation_euler.x = 0.2
    found = held(obj)
    assert not found.is_at_rest
    assert found.heel == pytest.approx(0.2, abs=1e-6)
    arm = np.sin(0.2) * (2.0 / 3.0 - 0.25 + 2.0 / 3.0 * np.tan(0.2) ** 2 / 2.0)
    assert np.linalg.norm(found.state.slope) == pytest.approx(arm, rel=1e-5)
    scene.body_moments_liquid.density = 800.0
    assert held(obj).state.displacement == pytest.approx(7.5, rel=1e-6)
    objects.dent(obj, -1.0)
    assert held(obj) is None


def test_live_body_is_read_by_the_timer_and_never_by_a_draw(scene, monkeypatch):
    water(scene)
    boat, cargo = hull(density=300.0), hull((1.0, 1.0, 0.2), density=300.0)
    cargo.parent = boat
    cargo.location.z = 1.0
    objects.only(boat)
    assert bpy.ops.object.body_moments_float() == {"FINISHED"}
    bpy.ops.object.body_moments_live()
    depth = held(boat).state.draught
    for vertex in cargo.data.vertices:
        vertex.co.z *= 2.0
    cargo.data.update()
    with monkeypatch.context() as patch:
        patch.setattr(floating, "read", lambda *_args: pytest.fail("It was read in a draw."))
        assert held(boat).state.draught == depth
    monkeypatch.setattr(measuring, "IDLE", 0.0)
    assert measuring._tick() is None
    assert held(boat).state.draught == pytest.approx(depth + 0.06 / 12.0, rel=1e-5)
    boat.body_moments.density = 3000.0
    measuring._tick()
    assert held(boat).code == "sinks"


def test_children_and_tanks_float_as_one_body(scene):
    water(scene)
    boat = hull(density=300.0)
    tank = hull((2.0, 1.6, 0.8), density=800.0)
    tank.parent = boat
    tank.body_moments_tank.role = "TANK"
    assert bpy.ops.object.body_moments_float() == {"FINISHED"}
    found = held(boat)
    mass = 3600.0 + 800.0 * 1.28
    assert found.state.body.total_mass == pytest.approx(mass, rel=1e-6)
    assert boat.location.z == pytest.approx(0.5 - mass / 12000.0, abs=1e-5)
    tank.body_moments_tank.role = "FLOODED"
    assert held(boat) is None
    bpy.ops.object.body_moments_float()
    # The part of the flooded space below the waterline displaces nothing.
    depth = 0.5 + (3.6 - 12.0 * 0.1) / (12.0 - 3.2) - 0.4
    assert held(boat).state.draught == pytest.approx(depth, rel=1e-5)


@pytest.mark.parametrize("kind", ["CHILD_OF", "COPY_LOCATION"])
@pytest.mark.parametrize("follower", [0, 1])
def test_constrained_root_is_moved_once(scene, kind, follower):
    water(scene)
    boat = hull(density=300.0, location=(1.0, 0.0, 4.0))
    cargo = hull((1.0, 1.0, 0.2), density=300.0, location=(1.0, 0.0, 5.0))
    bodies = [boat, cargo]
    constraint = bodies[follower].constraints.new(kind)
    constraint.target = bodies[1 - follower]
    if kind == "CHILD_OF":
        constraint.inverse_matrix = constraint.target.matrix_world.inverted()
    else:
        constraint.use_offset = True
        bodies[follower].location -= constraint.target.location
    bpy.context.view_layer.update()
    for obj in bodies:
        obj.select_set(True)
    assert bpy.ops.object.body_moments_float(as_one=True) == {"FINISHED"}
    bpy.context.view_layer.update()
    height = 0.5 - (3600.0 + 60.0) / 12000.0
    for obj, z in ((boat, height), (cargo, height + 1.0)):
        assert tuple(obj.matrix_world.translation) == pytest.approx((1.0, 0.0, z), abs=1e-5)


def test_second_draw_looks_at_no_object_of_the_scene(scene, monkeypatch):
    water(scene)
    boat = hull(density=300.0)
    bpy.ops.object.body_moments_float()
    first = held(boat)
    monkeypatch.setattr(floating, "_read_held", None)
    assert floating.held_body(boat, scene) is first
    boat.body_moments_tank.role = "TANK"
    monkeypatch.undo()
    assert held(boat) is None


@pytest.mark.parametrize("asked", ["boat", "part"])
def test_heel_is_that_of_the_root_whichever_part_is_asked(scene, asked):
    water(scene)
    boat = hull(density=300.0)
    part = hull((0.2, 0.2, 0.2), rotation=(0.0, 0.0, 1.2))
    part.parent = boat
    part.name = "Part"
    boat.scale.x = -1.0
    objects.only(boat)
    assert bpy.ops.object.body_moments_float() == {"FINISHED"}
    assert held(boat).heel == pytest.approx(0.0, abs=BLENDER)
    boat.rotation_euler.x = 0.2
    found = held({"boat": boat, "part": part}[asked])
    assert (found.heel, found.trim) == pytest.approx((0.2, 0.0), abs=BLENDER)


@pytest.mark.parametrize("role", ["TANK", "FLOODED"])
def test_space_in_the_body_gets_no_mass_of_its_own(scene, role):
    water(scene)
    boat = hull(density=300.0)
    space = hull((2.0, 1.6, 0.8), density=800.0)
    space.parent = boat
    space.body_moments_tank.role = role
    assert bpy.ops.object.body_moments_float() == {"FINISHED"}
    assert boat["body_mass"] == pytest.approx(3600.0)
    assert "body_mass" not in space


def test_positions_and_righting_arms_move_nothing(scene):
    water(scene)
    obj = hull((6.0, 1.0, 1.0), density=250.0)
    before = [*obj.matrix_world]
    assert bpy.ops.object.body_moments_float_positions() == {"FINISHED"}
    assert len(held(obj).afloat.rests) >= 4
    assert bpy.ops.object.body_moments_righting_arms(add_curve=True) == {"FINISHED"}
    assert [*obj.matrix_world] == before
    curve = held(obj).afloat.curve
    (empty,) = [one for one in scene.objects if one.type == "EMPTY"]
    scene.frame_set(10)
    arm = np.interp(np.radians(10.0), curve.angles, curve.arms)
    assert empty["body_righting_arm"] == pytest.approx(arm, abs=1e-6)
    texts = [entry[1] for entry in shown() if entry[0] == "label"]
    assert "Righting Arms" in texts


def test_float_keeps_rests_and_curve_until_the_shape_changes(scene):
    water(scene)
    obj = hull(location=(1.0, 2.0, 3.0), rotation=(0.3, 0.2, 0.1))
    bpy.ops.object.body_moments_float_positions()
    bpy.ops.object.body_moments_righting_arms()
    before = held(obj).afloat
    assert bpy.ops.object.body_moments_float() == {"FINISHED"}
    after = held(obj).afloat
    assert after.curve is before.curve
    metacenters = [rest.metacentric_heights for rest in before.rests]
    assert len(metacenters) == 2  # upright and upside-down
    found = [rest.metacentric_heights for rest in after.rests]
    assert np.array(found) == pytest.approx(np.array(metacenters), rel=1e-5)
    other = next(i for i, rest in enumerate(after.rests, 1) if not rest.is_near(after.rest, 0.1))
    assert bpy.ops.object.body_moments_float(position=other) == {"FINISHED"}
    assert obj.matrix_world.col[2].z == pytest.approx(-1.0, abs=BLENDER)
    there = held(obj).afloat
    assert len(there.rests) == 2 and there.curve is None  # it was of the other position
    objects.dent(obj, -1.0)
    bpy.ops.object.body_moments_float()
    assert not held(obj).afloat.rests


def test_each_listed_position_is_reached(scene):
    water(scene)
    obj = hull((6.0, 2.0, 1.0), rotation=(0.3, 0.2, 0.1))
    bpy.ops.object.body_moments_float_positions()
    for place in range(1, len(held(obj).afloat.rests) + 1):
        # Turned away each time: those of equal energy are listed in any order.
        obj.rotation_euler = (0.3, 0.2, 0.1)
        bpy.context.view_layer.update()
        bpy.ops.object.body_moments_float_positions()
        rests = held(obj).afloat.rests
        assert bpy.ops.object.body_moments_float(position=place) == {"FINISHED"}
        found = held(obj)
        assert found.is_at_rest
        assert found.state.draught == pytest.approx(rests[place - 1].draught, rel=1e-4)


def test_boat_on_its_side_floats_dry_in_upright_position(scene):
    water(scene)
    outer, inner = (
        np.array([[-x, -y], [x, -y], [x, y], [-x, y]]) for x, y in ((2.0, 1.0), (1.9, 0.9))
    )
    rings = [(outer, 0.0), (outer, 0.5), (inner, 0.5), (inner, 0.1)]
    points = [(*corner, z) for ring, z in rings for corner in ring.tolist()]
    quads = [
        (low + i, low + (i + 1) % 4, low + 4 + (i + 1) % 4, low + 4 + i)
        for low in (0, 4, 8)
        for i in range(4)
    ]
    boat = objects.add(
        objects.mesh_of(points, [(3, 2, 1, 0), (12, 13, 14, 15), *quads], "Boat"),
        rotation=(1.6, 0.0, 0.0),
    )
    boat.body_moments.density = 900.0
    bpy.ops.object.body_moments_float_positions()
    draughts = [rest.draught for rest in held(boat).afloat.rests]
    place = int(np.argmin(draughts)) + 1
    assert bpy.ops.object.body_moments_float(position=place) == {"FINISHED"}
    depth = 0.9 * (4.0 - 3.8 * 1.8 * 0.4) / 8.0
    assert held(boat).state.draught == pytest.approx(depth, rel=1e-5)
    assert held(boat).is_at_rest and not held(boat).afloat.rest.findings


@pytest.mark.parametrize(
    ("change", "code", "word"),
    [
        (lambda scene, _: water(scene, 400.0), "sinks", "remove"),
        (lambda scene, _: water(scene, 0.0), "float_unavailable", "density"),
        (lambda scene, _: setattr(scene, "use_gravity", False), "float_unavailable", "gravity"),
        (lambda _, obj: setattr(obj, "lock_location", (True,) * 3), "channel_locked", "lock"),
    ],
)
def test_refused_float_moves_nothing(scene, reported, change, code, word):
    water(scene)
    obj = hull(location=(0.0, 0.0, 2.0), rotation=(0.3, 0.0, 0.0))
    change(scene, obj)
    bpy.context.view_layer.update()
    before = [*obj.matrix_world]
    assert bpy.ops.object.body_moments_float() == {"CANCELLED"}
    assert code in reported.codes
    assert any(word in str(found) for found in reported)
    assert [*obj.matrix_world] == before
    assert held(obj) is None and "body_mass" not in obj


def test_child_held_by_a_constraint_is_refused(scene, reported):
    water(scene)
    boat = hull(location=(0.0, 0.0, 3.0))
    child = hull((0.2, 0.2, 0.2), location=(0.0, 0.0, 3.0))
    child.name = "Held"
    child.parent = boat
    child.matrix_parent_inverse = boat.matrix_basis.inverted()
    limit = child.constraints.new("LIMIT_LOCATION")
    limit.use_min_z, limit.min_z = True, 3.0
    objects.only(boat)
    bpy.context.view_layer.update()
    before = [*boat.matrix_world, *child.matrix_world]
    assert bpy.ops.object.body_moments_float() == {"CANCELLED"}
    assert reported.values("child_not_held")["object"] == "Held"
    bpy.context.view_layer.update()
    assert [*boat.matrix_world, *child.matrix_world] == before


def test_far_body_is_at_rest_once_it_floats(scene):
    water(scene)
    obj = hull(location=(1e6, 2e6, 5.0), rotation=(0.2, -0.1, 0.7))
    assert bpy.ops.object.body_moments_float() == {"FINISHED"}
    assert held(obj).is_at_rest
    assert obj.location.z == pytest.approx(0.0, abs=1e-5)
    obj.location.z += 0.01
    assert not held(obj).is_at_rest


def test_overlapping_parts_are_refused(scene, reported):
    water(scene)
    boat = hull()
    cargo = hull((2.0, 4.0, 0.5))
    cargo.parent = boat
    objects.only(boat)
    assert bpy.ops.object.body_moments_float() == {"CANCELLED"}
    assert "overlap" in reported.values("float_unavailable")["fault"]
