# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Put on Parabola, Keep Spin, Bake Curves and Trace: keyed figures against independent sums over
their bones.
"""

from pathlib import Path

import bpy
import numpy as np
import pytest
from mathutils import Matrix, Quaternion, Vector

from tests.blender.box_character import HEIGHT
from tests.blender.figure import figure
from tests.blender.objects import add, mesh_of
from tests.operators.rig import simulate_jump
from tests.operators.standing import QUADS

PARABOLA, SPIN = bpy.ops.pose.body_moments_parabola, bpy.ops.pose.body_moments_keep_spin
BAKE, TRACE = bpy.ops.pose.body_moments_bake_curves, bpy.ops.pose.body_moments_trace
STEP, GRAVITY = 1.0 / 24.0, np.array([0.0, 0.0, -9.81])
TAKE_OFF, LANDING, END = 8, 24, 32
FLIGHT = range(TAKE_OFF, LANDING + 1)
TYPED = {"use_contacts": False, "take_off": TAKE_OFF, "landing": LANDING}
EULER, QUATERNION = "rotation_euler", "rotation_quaternion"


def jumper(mode="XYZ", spin=0.0, held=True, gravity=-9.81):
    """A figure that floats from frame 8 to 24, draws in its arms and turns."""
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end, scene.gravity = 1, END, (0.0, 0.0, gravity)
    rig, _body = figure(held=held)
    bpy.ops.object.mode_set(mode="POSE")
    root = rig.pose.bones["root"]
    root.rotation_mode = mode
    for frame, place in (
        (TAKE_OFF, (0, 0, 0)),
        (16, (0.2, -0.6, 0.9)),
        (LANDING, (0, -1.5, 0)),
        (END, (0, -1.5, 0)),
    ):
        root.location = place
        root.keyframe_insert("location", frame=frame)
    channel = {"QUATERNION": QUATERNION, "AXIS_ANGLE": "rotation_axis_angle"}.get(mode, EULER)
    for frame in range(1, END + 1):
        turn = Quaternion((0.3, 0.1, 1.0), spin * np.clip((frame - TAKE_OFF) / 16.0, 0.0, 1.0))
        axis, angle = Vector((0.3, 0.1, 1.0)).normalized(), turn.to_axis_angle()[1]
        value = {
            QUATERNION: turn,
            EULER: turn.to_euler("XYZ"),
            "rotation_axis_angle": (angle, *axis),
        }[channel]
        setattr(root, channel, value)
        root.keyframe_insert(channel, frame=frame)
    for name in ("arm.L", "arm.R", "head"):
        bone = rig.pose.bones[name]
        for frame, angle in ((TAKE_OFF, 0.0), (16, 1.2), (LANDING, 0.0)):
            bone.rotation_euler = 0.3 * angle, 0, -angle if name == "arm.L" else angle
            bone.keyframe_insert(EULER, frame=frame)
    scene.frame_set(1)
    assert bpy.ops.object.body_moments_measure_bones() == {"FINISHED"}
    return rig


def curves_of(obj):
    animation = obj.animation_data
    return list(animation.action.layers[0].strips[0].channelbag(animation.action_slot).fcurves)


def keyed(obj):
    return {
        (curve.data_path, curve.array_index): [tuple(point.co) for point in curve.keyframe_points]
        for curve in curves_of(obj)
    }


def followed(rig, frames):
    """Return masses (p,), tensors (p, 3, 3), and (f, p, 4, 4) places of the bones' parts, by their
    stored results.
    """
    bones = [bone for bone in rig.pose.bones if "body_mass" in bone]
    xx, yy, zz, xy, xz, yz = np.array([bone["body_inertia"] for bone in bones]).T
    tensors = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)
    places = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        places.append(
            [
                rig.matrix_world @ bone.matrix @ Matrix.Translation(bone["body_center_of_mass"])
                for bone in bones
            ]
        )
    return np.array([bone["body_mass"] for bone in bones]), tensors, np.array(places)


def centers(rig, frames):
    masses, _, places = followed(rig, frames)
    return np.einsum("p,fpi->fi", masses, places[:, :, :3, 3]) / masses.sum()


def angular_momenta(rig, frames):
    """Return (f - 1, 3) from the turns and moves of the parts between two frames each."""
    masses, tensors, places = followed(rig, frames)
    result = []
    for one, two in zip(places, places[1:]):
        middle, rates = (one + two)[:, :3, 3] / 2.0, (two - one)[:, :3, 3] / STEP
        arms = middle - masses @ middle / masses.sum()
        total = (masses[:, None] * np.cross(arms, rates)).sum(axis=0)
        for before, after, tensor in zip(one, two, tensors):
            first, last = (Matrix(place).to_quaternion() for place in (before, after))
            axis, angle = (last @ first.inverted()).to_axis_angle()
            angle = (angle + np.pi) % (2.0 * np.pi) - np.pi
            half = np.array(first.slerp(last, 0.5).to_matrix())
            total += half @ tensor @ half.T @ np.array(axis) * angle / STEP
        result.append(total)
    return np.array(result)


def arc(path):
    share = np.linspace(0.0, 1.0, len(path))[:, None]
    time = STEP * (len(path) - 1)
    return path[0] + share * (path[-1] - path[0]) - 0.5 * share * (1.0 - share) * GRAVITY * time**2


def poses(rig, frames):
    """Return (f, b, 4, 4) matrices of the bones relative to the root."""
    found = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        found.append(
            [rig.pose.bones["root"].matrix.inverted() @ bone.matrix for bone in rig.pose.bones]
        )
    return np.array(found)


def balance():
    (empty,) = [obj for obj in bpy.data.objects if "body_balance_group" in obj]
    return empty


def signal(name):
    """Return the (k, 2) keys of each component of a baked property."""
    found = keyed(balance())
    return [
        np.array(found[path, axis])
        for path, axis in sorted(found)
        if path == '["body_balance_{:s}"]'.format(name)
    ]


@pytest.mark.parametrize("mode", ["XYZ", "QUATERNION", "AXIS_ANGLE"])
@pytest.mark.parametrize("layer", [False, True], ids=["action", "layer"])
def test_center_is_on_the_parabola_and_poses_stay(scene, mode, layer):
    rig = jumper(mode, spin=1.0)
    outside = [*range(1, TAKE_OFF + 1), *range(LANDING, END + 1)]
    ends, before = centers(rig, outside), poses(rig, range(1, END + 1))
    around = [poses_in_world(rig, outside)]
    assert PARABOLA(use_layer=layer, **TYPED) == {"FINISHED"}
    path = centers(rig, FLIGHT)
    assert np.abs(path - arc(path)).max() < 1e-6 * HEIGHT
    assert np.ptp(path[:, 2]) > 0.5
    assert np.abs(poses(rig, range(1, END + 1)) - before).max() < 1e-5
    assert np.abs(poses_in_world(rig, outside) - around[0]).max() < 1e-5
    assert np.abs(centers(rig, outside) - ends).max() < 1e-5 * HEIGHT
    assert bool(rig.animation_data.nla_tracks) == layer


def poses_in_world(rig, frames):
    found = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        found.append([rig.matrix_world @ bone.matrix for bone in rig.pose.bones])
    return np.array(found)


def test_kept_height_moves_the_landing(scene, reported):
    rig = jumper()
    before, pose = centers(rig, FLIGHT), poses(rig, [1, TAKE_OFF, 16, LANDING, END])
    assert PARABOLA(keep="HEIGHT") == {"FINISHED"}
    top = before[:, 2].max()
    seconds = sum(np.sqrt(2.0 * (top - end) / 9.81) for end in before[[0, -1], 2])
    landing = TAKE_OFF + round(seconds / STEP)
    assert landing != LANDING and "to {}".format(landing) in reported.texts[-2]
    path = centers(rig, range(TAKE_OFF, landing + 1))
    assert np.abs(path - arc(path)).max() < 1e-6 * HEIGHT
    assert abs(path[:, 2].max() - top) < 0.1
    moved = [1, TAKE_OFF, landing, END + landing - LANDING]
    assert np.abs(poses(rig, moved) - pose[[0, 1, 3, 4]]).max() < 1e-5


@pytest.mark.parametrize("mode", ["XYZ", "QUATERNION", "AXIS_ANGLE"])
@pytest.mark.parametrize("layer", [False, True], ids=["action", "layer"])
def test_angular_momentum_is_that_of_take_off(scene, mode, layer):
    rig = jumper(mode, spin=2.0)
    assert PARABOLA(**TYPED) == {"FINISHED"}
    before, spun = centers(rig, range(1, END + 1)), angular_momenta(rig, FLIGHT)
    pose = poses(rig, range(1, END + 1))
    assert SPIN(blend=5, use_layer=layer, **TYPED) == {"FINISHED"}
    found = angular_momenta(rig, FLIGHT)
    size = np.linalg.norm(found[0])
    assert np.abs(spun - spun[0]).max() > 0.1 * size
    assert np.abs(found - found[0]).max() < 0.01 * size
    assert np.abs(found[0] - spun[0]).max() < 0.02 * size
    # The NLA takes powers of quaternions in float32, by their arc cosines.
    tolerance = 1e-4 if layer and mode == "QUATERNION" else 1e-5
    assert np.abs(centers(rig, range(1, END + 1)) - before).max() < tolerance * HEIGHT
    assert np.abs(poses(rig, range(1, END + 1)) - pose).max() < 1e-5


@pytest.mark.parametrize("lead", [0, 5, 8])
def test_turn_is_blended_at_both_ends(scene, lead):
    rig, frames = jumper("QUATERNION", spin=2.0), range(1, END + 1)
    before, spun = poses_in_world(rig, frames), angular_momenta(rig, FLIGHT)
    given = {} if lead == 8 else {"lead": lead}  # the default
    assert SPIN(blend=5, **given, **TYPED) == {"FINISHED"}
    after, found = poses_in_world(rig, frames), angular_momenta(rig, FLIGHT)
    size = np.linalg.norm(spun[0])
    assert (
        np.abs(found - found[0]).max() < 0.01 * size
        and np.abs(found[0] - spun[0]).max() < 0.03 * size
    )
    kept = [*range(TAKE_OFF - lead), *range(LANDING + 4, END)]
    assert np.abs(after - before)[kept].max() < 1e-5
    ends = [
        Matrix(after[frame - 1, 0] @ np.linalg.inv(before[frame - 1, 0]))
        for frame in (TAKE_OFF, LANDING)
    ]
    first, last = (end.to_quaternion().angle for end in ends)
    assert (first < 1e-3) if lead == 0 else 0.1 < first < last


def test_thrown_rigid_body_keeps_its_momentum(scene):
    rig, _body = figure(held=False)
    scene.frame_start, scene.frame_end = 1, 40
    assert bpy.ops.object.body_moments_measure_bones() == {"FINISHED"}
    center = Matrix.Translation(centers(rig, [1])[0])
    rig.rotation_mode = "QUATERNION"
    velocity = np.array([0.5, 1.0, 8.0])
    for frame in range(1, 41):
        time = STEP * (frame - 1)
        fall = Matrix.Translation(velocity * time + GRAVITY * time**2 / 2.0 + (0.0, 0.0, 1.0))
        turn = Quaternion((0.0, 0.0, 1.0), 3.0 * time)
        rig.matrix_basis = fall @ center @ turn.to_matrix().to_4x4() @ center.inverted()
        rig.keyframe_insert("location", frame=frame)
        rig.keyframe_insert(QUATERNION, frame=frame)
    scene.frame_set(1)
    assert BAKE() == {"FINISHED"}
    assert "body_balance_spans" not in balance()
    speed = np.stack([curve[:, 1] for curve in signal("velocity")], axis=1)
    exact = velocity + GRAVITY * STEP * np.arange(40)[:, None]
    assert np.abs(speed - exact).max() < 3e-6 * 8.0  # matrices are float32
    spin = np.stack([curve[:, 1] for curve in signal("angular_momentum")], axis=1)
    assert np.ptp(spin[:, 2]) < 3e-5 * spin[:, 2].mean()


def test_floaty_jump_is_listed_and_its_parabola_is_not(scene):
    jumper()
    assert BAKE() == {"FINISHED"}
    first, last, impulse, _twist = balance()["body_balance_spans"]
    assert TAKE_OFF < first <= last < LANDING and impulse > 100.0
    contact, unexplained = (signal(name)[0] for name in ("contact", "unexplained"))
    assert np.flatnonzero(contact[:, 1] == 0.0).tolist() == [frame - 1 for frame in FLIGHT[1:-1]]
    assert unexplained[:, 1].sum() == last - first + 1
    (margin,), zero = signal("margin"), signal("zero_moment_point")
    assert (
        margin[:, 0].tolist() == [*range(1, TAKE_OFF + 1), *range(LANDING, END + 1)]
        and len(zero) == 3
    )
    assert PARABOLA() == {"FINISHED"} and "body_balance_spans" not in balance()
    fall = np.stack([curve[TAKE_OFF:LANDING, 1] for curve in signal("velocity")], axis=1)
    assert np.abs(np.diff(fall, axis=0) / STEP - GRAVITY).max() < 0.01
    path = np.stack([np.array(keyed(balance())["location", axis])[:, 1] for axis in range(3)])
    assert np.abs(path.T - centers(bpy.data.objects["Figure"], range(1, END + 1))).max() < 1e-5
    assert TRACE() == {"FINISHED"}
    assert "body_balance_momentum" not in balance() and "body_balance_contact" in balance()


def test_simulated_jump_is_plausible_and_floats_if_slowed(scene):
    """A recording from MuJoCo, whose boxes are built around the imported bones; slowed, it takes
    1.7 times as long.
    """
    bpy.ops.preferences.addon_enable(module="io_anim_bvh")
    path = str(Path(__file__).with_name("jump.bvh"))
    bpy.ops.import_anim.bvh(filepath=path, axis_forward="Y", axis_up="Z", update_scene_fps=True)
    rig, parts = bpy.context.object, simulate_jump.parts()
    corners = np.array(list(np.ndindex(2, 2, 2))) * 2.0 - 1.0
    points = [np.add(joint, center) + corners * half for _, _, joint, half, center in parts]
    several = [
        tuple(corner + 8 * box for corner in face) for box in range(len(parts)) for face in QUADS
    ]
    body = add(mesh_of(np.concatenate(points), several, "Boxes"), "Boxes", select=False, parent=rig)
    for box, (name, *_) in enumerate(parts):
        body.vertex_groups.new(name=name).add(range(8 * box, 8 * box + 8), 1.0, "REPLACE")
    body.modifiers.new("Armature", "ARMATURE").object = rig
    body.body_moments.density = simulate_jump.DENSITY
    scene.frame_start, scene.frame_end = 1, round(simulate_jump.RATE * simulate_jump.SECONDS) + 1
    assert (scene.render.fps, scene.render.fps_base) == (simulate_jump.RATE, 1.0)
    scene.frame_set(1)
    bpy.ops.object.mode_set(mode="POSE")
    assert BAKE() == {"FINISHED"}
    spin, contact = (signal(name) for name in ("angular_momentum", "contact"))
    flight = contact[0][:, 1] == 0.0
    assert flight.sum() > 30 and contact[0][0, 1] == contact[0][-1, 1] == 1.0
    spin = np.stack([curve[flight, 1] for curve in spin], axis=1)[2:-2]
    assert np.abs(spin - spin.mean(axis=0)).max() < 0.01 * np.linalg.norm(spin[0])
    assert "body_balance_spans" not in balance()
    scene.render.fps_base = 1.7
    assert BAKE() == {"FINISHED"}
    assert len(balance()["body_balance_spans"]) == 4


def test_unkeyed_root_and_armature_object_are_keyed(scene):
    rig = jumper()
    for curve in curves_of(rig):
        if "root" in curve.data_path:
            rig.animation_data.action.layers[0].strips[0].channelbags[0].fcurves.remove(curve)
    rig.pose.bones["root"].location = 0, 0, 1.0
    for target in ("hold.L", "hold.R"):  # nothing carries the character any more but the object
        bpy.ops.object.mode_set(mode="EDIT")
        rig.data.edit_bones[target].parent = None
        bpy.ops.object.mode_set(mode="POSE")
    assert PARABOLA(use_contacts=False, take_off=5, landing=20) == {"FINISHED"}
    path = centers(rig, range(5, 21))
    assert np.abs(path - arc(path)).max() < 1e-6 * HEIGHT
    assert ("location", 2) in keyed(rig)


def share_action(rig):
    other = bpy.data.objects.new("Other", rig.data).animation_data_create()
    other.action, other.action_slot = rig.animation_data.action, rig.animation_data.action_slot


def test_layer_keeps_cycles_ranges_and_influence_below(scene):
    """A manual frame range and the blending of an action act otherwise once it is a strip."""
    rig = jumper()
    action = rig.animation_data.action
    action.use_frame_range, action.frame_start, action.frame_end = True, 10, 14
    for curve in curves_of(rig):
        if "arm" in curve.data_path:
            curve.modifiers.new("CYCLES")
    action.update_tag()
    for top in (None, bpy.data.actions.new("Top")):
        if top is not None:
            rig.animation_data.action, rig.animation_data.action_slot = (
                top,
                top.slots.new("OBJECT", "Top"),
            )
            rig.animation_data.action_blend_type, rig.animation_data.action_influence = "ADD", 0.5
            rig.pose.bones["head"].rotation_euler = 1, 0, 0
            rig.pose.bones["head"].keyframe_insert(EULER, frame=1)
        rig.update_tag()
        before = poses(rig, range(1, END + 1))
        assert PARABOLA(use_layer=True, **TYPED) == {"FINISHED"}
        path = centers(rig, FLIGHT)
        assert np.abs(path - arc(path)).max() < 1e-6 * HEIGHT
        assert np.abs(poses(rig, range(1, END + 1)) - before).max() < 1e-5


def test_extrapolated_motion_outside_the_flight_stays(scene):
    rig = jumper()
    for curve in curves_of(rig):
        curve.extrapolation = "LINEAR"
    outside = [-5, 0, 1, END, END + 5]
    before = poses_in_world(rig, outside)
    assert PARABOLA(use_contacts=False, take_off=2, landing=20) == {"FINISHED"}
    assert np.abs(poses_in_world(rig, outside) - before).max() < 1e-5


def test_delta_transforms_of_the_object_are_refused(scene):
    rig = jumper()
    rig.delta_location = 1, 0, 0
    for target in ("hold.L", "hold.R"):
        bpy.ops.object.mode_set(mode="EDIT")
        rig.data.edit_bones[target].parent = None
        bpy.ops.object.mode_set(mode="POSE")
    with pytest.raises(RuntimeError, match="Delta"):
        PARABOLA(**TYPED)


@pytest.mark.parametrize("operator", [PARABOLA, SPIN], ids=["parabola", "spin"])
def test_refusal_leaves_no_results_and_no_ground(scene, operator):
    rig = jumper()
    bpy.ops.object.body_moments_clear_bones()
    rig.body_moments_weight.ground = -5.0
    scene.frame_end = 5
    with pytest.raises(RuntimeError, match="leave the ground"):
        operator()
    assert "body_mass" not in rig and rig.body_moments_weight.ground == -5.0
    assert BAKE() == {"FINISHED"} and "body_mass" in rig and rig.body_moments_weight.ground > -1.0


REFUSALS = {
    "no gravity": (lambda rig: setattr(bpy.context.scene, "use_gravity", False), {}),
    "locked": (
        lambda rig: setattr(rig.pose.bones["root"], "lock_location", (False, True, False)),
        {},
    ),
    "driven": (lambda rig: rig.pose.bones["root"].driver_add("location", 1), {}),
    "constrained": (lambda rig: rig.pose.bones["root"].constraints.new("LIMIT_LOCATION"), {}),
    "locked curve": (lambda rig: setattr(curves_of(rig)[0], "lock", True), {}),
    "curve with noise": (lambda rig: curves_of(rig)[0].modifiers.new("NOISE"), {}),
    "action of two": (lambda rig: share_action(rig), {}),
    "landing first": (lambda rig: None, {"use_contacts": False, "take_off": 20, "landing": 10}),
    "no such bone": (lambda rig: None, {"bone": "tail"}),
    "bone carries a part": (lambda rig: None, {"bone": "head"}),
    "always in the air": (lambda rig: setattr(rig.body_moments_weight, "ground", -5.0), {}),
    "noise and moved landing": (
        lambda rig: curves_of(rig)[-1].modifiers.new("NOISE"),
        {"keep": "HEIGHT"},
    ),
    "layer moves landing": (lambda rig: None, {"use_layer": True, "keep": "HEIGHT"}),
}


@pytest.mark.parametrize("prepare, options", REFUSALS.values(), ids=REFUSALS)
def test_refusal_keys_nothing(scene, prepare, options):
    rig = jumper()
    bpy.ops.pose.body_moments_show_weight()
    prepare(rig)
    bpy.context.view_layer.update()
    before = keyed(rig), [tuple(bone.location) for bone in rig.pose.bones]
    with pytest.raises(RuntimeError, match=r"\.$"):
        PARABOLA(**options)
    assert (keyed(rig), [tuple(bone.location) for bone in rig.pose.bones]) == before
    assert not rig.animation_data.nla_tracks and scene.frame_current == 1


def linked(tmp_path, rig, override):
    """Save the file, link the character from it into an empty one, and return it, or its
    override.
    """
    path = str(tmp_path / "jumper.blend")
    bpy.ops.object.mode_set(mode="OBJECT")
    collection = bpy.data.collections.new("Jumper")
    bpy.context.scene.collection.children.link(collection)
    for obj in (rig, bpy.data.objects["Body"]):
        collection.objects.link(obj)
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.collections = ["Jumper"]
    scene, layer = bpy.context.scene, bpy.context.view_layer
    scene.collection.children.link(wanted.collections[0])
    root = wanted.collections[0]
    if override:
        root = root.override_hierarchy_create(scene, layer, do_fully_editable=True)
    scene.frame_start, scene.frame_end = 1, END
    (rig,) = [obj for obj in root.all_objects if obj.type == "ARMATURE"]
    layer.objects.active = rig
    return rig


def test_linked_character_is_read_and_not_keyed(scene, tmp_path):
    linked(tmp_path, jumper(), override=False)
    assert BAKE() == {"FINISHED"} and len(signal("velocity")) == 3
    with pytest.raises(RuntimeError, match="linked"):
        PARABOLA()


def test_override_gets_the_keys(scene, tmp_path):
    rig = linked(tmp_path, jumper(), override=True)
    assert rig.library is None and rig.override_library is not None
    assert PARABOLA() == {"FINISHED"}
    assert rig.animation_data.action.library is None
    path = centers(rig, FLIGHT)
    assert np.abs(path - arc(path)).max() < 1e-6 * HEIGHT
    bpy.ops.wm.save_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    (rig,) = [
        obj for obj in bpy.context.scene.objects if obj.type == "ARMATURE" and obj.library is None
    ]
    assert np.abs(centers(rig, FLIGHT) - path).max() < 1e-6 * HEIGHT


def test_one_undo_brings_the_old_keys_back(scene):
    rig = jumper()
    name, before = rig.name, keyed(rig)
    bpy.ops.ed.undo_push(message="before")
    assert PARABOLA("EXEC_DEFAULT", True) == {"FINISHED"}
    bpy.ops.ed.undo()
    assert keyed(bpy.data.objects[name]) == before
