# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Keep Spin and Put on Parabola on somersaults: momenta between frames by differences of evaluated
parts, and curves outside of the flight to the last bit.
"""

import bpy
import numpy as np
import pytest

from tests.blender.gymnast import centers_at, curves_of, gymnast, momenta_at, somersault
from tests.blender.objects import add

SPIN = bpy.ops.pose.body_moments_keep_spin
PARABOLA = bpy.ops.pose.body_moments_parabola
WITHIN = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
MODES = ("XYZ", "QUATERNION", "AXIS_ANGLE", "ZYX", "YZX")
ORDINARY = [
    {
        "seed": seed,
        "fps": (24, 30, 60, 120)[seed % 4],
        "mode": MODES[seed % 5],
        "carrier": "root" if seed % 3 else "object",
        "turns": (1, 1, 2, -1)[seed // 4],
    }
    for seed in range(16)
]
TWISTING = [
    {"seed": 20, "fps": 24, "mode": "QUATERNION", "twist": 1.0, "asymmetry": 1.5},
    {"seed": 21, "fps": 30, "mode": "XYZ", "twist": 1.0, "asymmetry": 1.5},
    # The somersault is about the middle axis, and the twist leads close past the gimbal lock.
    {"seed": 22, "fps": 30, "mode": "YXZ", "asymmetry": 0.5},
    {"seed": 3, "fps": 120, "mode": "ZXY", "carrier": "object"},
]


def typed(flight):
    return {"use_contacts": False, "take_off": flight[0], "landing": flight[1]}


def times_of(flight):
    return (np.arange(*flight)[:, None] + WITHIN).ravel()


@pytest.mark.parametrize(
    "case", ORDINARY + TWISTING, ids=lambda case: "{seed}-{mode}".format(**case)
)
def test_somersault_keeps_its_momentum_between_frames(scene, reported, case):
    rig = gymnast(root=case.get("carrier") != "object")
    flight = somersault(rig, **case)
    times = times_of(flight)
    before = momenta_at(rig, times, case["fps"])
    kept = before[: len(WITHIN)].mean(axis=0)
    assert np.abs(before - kept).max() > 0.5 * np.linalg.norm(kept)
    assert SPIN(**typed(flight)) == {"FINISHED"}
    assert ("rotation" in curves_of(rig)[0].data_path[:8]) == (case.get("carrier") == "object")
    after = momenta_at(rig, times, case["fps"])
    assert np.linalg.norm(after - kept, axis=1).max() < 0.005 * np.linalg.norm(kept)
    assert "constraints" not in " ".join(reported.texts)


@pytest.mark.parametrize("layer", [False, True], ids=["action", "layer"])
@pytest.mark.parametrize("mode", ["XYZ", "QUATERNION"])
def test_parented_and_layered_somersault_keeps_its_momentum(scene, mode, layer):
    parent = add(None, "Parent", (3.0, 2.0, 1.0), (0.4, -0.3, 1.0), select=False)
    rig = gymnast()
    rig.parent = parent
    flight = somersault(rig, 3, 24, mode)
    times = times_of(flight)
    kept = momenta_at(rig, times[: len(WITHIN)], 24).mean(axis=0)
    assert SPIN(use_layer=layer, lead=0, **typed(flight)) == {"FINISHED"}
    after = momenta_at(rig, times, 24)
    assert np.linalg.norm(after - kept, axis=1).max() < 0.0075 * np.linalg.norm(kept)


def test_uneven_scale_above_the_character_is_named(scene):
    rig = gymnast()
    rig.parent = add(None, "Stage", scale=(1.0, 2.0, 1.0), select=False)
    flight = somersault(rig, 3, 24, "QUATERNION")
    with pytest.raises(RuntimeError, match="uneven scale.*“Stage”"):
        SPIN(**typed(flight))


def test_falling_cat_turns_without_momentum(scene):
    """The halves of the body swing around each other, bent; then they are stretched again."""
    rig = gymnast()
    first, last = somersault(rig, 1, 30, "QUATERNION", turns=0.0, seconds=1.2)
    for curve in curves_of(rig):
        if "root" not in curve.data_path or "rotation" in curve.data_path:
            rig.animation_data.action.layers[0].strips[0].channelbags[0].fcurves.remove(curve)
    for frame in range(first, last + 1, 3):
        phase = 2.0 * np.pi * (frame - first) / (last - first)
        bend = 0.7 * np.sin(phase / 2.0) ** 2
        for name, sign in (("chest", 1.0), ("thigh.L", -1.0), ("thigh.R", -1.0)):
            bone = rig.pose.bones[name]
            bone.rotation_euler = sign * bend * np.cos(phase), 0.0, bend * np.sin(phase)
            bone.keyframe_insert("rotation_euler", frame=frame)
    for frame in (1, first):
        scene.frame_set(frame)
    times = times_of((first, last))
    before = momenta_at(rig, times, 30)
    assert SPIN(lead=0, **typed((first, last))) == {"FINISHED"}
    kept = momenta_at(rig, times[: len(WITHIN)], 30).mean(axis=0)
    after = momenta_at(rig, times, 30)
    size = np.linalg.norm(before, axis=1).max()
    assert np.linalg.norm(kept) < 0.1 * size
    assert np.linalg.norm(after - kept, axis=1).max() < 0.01 * size
    scene.frame_set(last)
    turn = rig.pose.bones["root"].matrix_basis.to_quaternion().angle
    assert 0.1 < turn < 3.0


def test_stepped_pose_is_refused_and_keyed_anyway(scene):
    rig = gymnast()
    flight = somersault(rig, 2, 24, "XYZ")
    for curve in curves_of(rig):
        if "thigh" in curve.data_path:
            for point in curve.keyframe_points:
                point.interpolation = "CONSTANT"
    before = everything(rig)
    with pytest.raises(RuntimeError, match=r"momentum of “root” by [\d.]+%.*frame \d"):
        SPIN(**typed(flight))
    assert everything(rig) == before and "body_balance_group" not in rig
    assert SPIN(anyway=True, **typed(flight)) == {"FINISHED"}
    assert everything(rig) != before


def everything(rig):
    """Return all keys by their frames, with all that decides on the evaluated curves."""
    names = ("co", "handle_left", "handle_right", "amplitude", "back", "period")
    return {
        (curve.data_path, curve.array_index): {
            point.co.x: (
                point.interpolation,
                point.easing,
                *(repr(np.array(getattr(point, name)).tolist()) for name in names),
            )
            for point in curve.keyframe_points
        }
        for curve in curves_of(rig)
    }


NEIGHBORS = {
    "auto": ("BEZIER", "AUTO"),
    "clamped": ("BEZIER", "AUTO_CLAMPED"),
    "aligned": ("BEZIER", "ALIGNED"),
    "vector": ("BEZIER", "VECTOR"),
    "free": ("BEZIER", "FREE"),
    "linear": ("LINEAR", "AUTO"),
    "constant": ("CONSTANT", "AUTO"),
    "sine": ("SINE", "AUTO"),
    "elastic": ("ELASTIC", "AUTO_CLAMPED"),
}


@pytest.mark.parametrize("operator", [PARABOLA, SPIN], ids=["parabola", "spin"])
@pytest.mark.parametrize("extrapolation", ["CONSTANT", "LINEAR"])
@pytest.mark.parametrize("kind, handles", NEIGHBORS.values(), ids=NEIGHBORS)
def test_curves_outside_stay_to_the_last_bit(scene, kind, handles, extrapolation, operator):
    rig = gymnast()
    flight = somersault(rig, 5, 24, "XYZ")
    root = rig.pose.bones["root"]
    ends = flight if operator == PARABOLA else (flight[0] - 4, flight[1] + 5)
    rng = np.random.default_rng(1)
    for frame in (ends[0] - 9, ends[0] - 3, ends[0], ends[1], ends[1] + 4, ends[1] + 12):
        for channel in ("location", "rotation_euler"):
            setattr(root, channel, rng.uniform(-0.3, 0.3, 3))
            root.keyframe_insert(channel, frame=frame)
    for curve in curves_of(rig):
        curve.extrapolation = extrapolation
        for point in curve.keyframe_points:
            point.interpolation = kind
            point.handle_left_type = point.handle_right_type = handles
        if handles == "FREE":
            for point in curve.keyframe_points:
                point.handle_right.y += 0.2
        if "arm" in curve.data_path:
            curve.modifiers.new("CYCLES")
        curve.update()
    outside = [
        time
        for time in np.arange(ends[0] - 25, ends[1] + 25, 0.1)
        if not ends[0] + 1e-6 < time < ends[1] - 1e-6
    ]
    outside += [*ends]

    def evaluated():
        return {
            (curve.data_path, curve.array_index): [curve.evaluate(time) for time in outside]
            for curve in curves_of(rig)
        }

    before = evaluated()
    keys = everything(rig)
    options = {} if operator == PARABOLA else {"lead": 4, "blend": 5, "anyway": True}
    assert operator(**options, **typed(flight)) == {"FINISHED"}
    after = evaluated()
    assert after.keys() == before.keys()
    assert {channel for channel in before if before[channel] != after[channel]} == set()
    kept = everything(rig)
    for channel, points in keys.items():
        beyond = {
            key: key_point for key, key_point in points.items() if not ends[0] <= key <= ends[1]
        }
        assert beyond.items() <= kept[channel].items()
    for curve in curves_of(rig):  # as Blender does after an edit
        curve.update()
    for channel, values in evaluated().items():
        assert np.abs(np.subtract(values, before[channel])).max() < 2e-3


@pytest.mark.parametrize("reach", [None, 0.65], ids=["automatic", "overlapping"])
def test_take_off_between_keys_divides_the_curve(scene, reach):
    """The curves before and after pass as before, up to the rounding of the keys to float32.

    reach: of free handles, relative to the distance of the keys, which they may pass together.
    """
    rig = gymnast()
    flight = somersault(rig, 6, 24, "QUATERNION")
    for points in (curve.keyframe_points for curve in curves_of(rig) if reach):
        for one, two in zip(points[:-1], points[1:]):
            one.handle_right_type = two.handle_left_type = "FREE"
            length = reach * (two.co.x - one.co.x)
            one.handle_right = one.co.x + length, one.co.y + 0.2
            two.handle_left = two.co.x - length, two.co.y + 0.1
    inner = flight[0] + 3, flight[1] - 2
    outside = [*np.arange(1.0, inner[0], 0.1), *np.arange(inner[1] + 0.0, flight[1] + 9.0, 0.1)]
    before = {
        (curve.data_path, curve.array_index): [curve.evaluate(time) for time in outside]
        for curve in curves_of(rig)
    }
    assert PARABOLA(**typed(inner)) == {"FINISHED"}
    for curve in curves_of(rig):
        after = [curve.evaluate(time) for time in outside]
        assert np.abs(np.subtract(after, before[curve.data_path, curve.array_index])).max() < 1e-6


def test_line_beyond_the_last_key_goes_on_from_a_held_key(scene):
    """The flight ends within the last segment, which holds a value."""
    rig = gymnast()
    first, last = somersault(rig, 6, 24, "QUATERNION")
    for curve in curves_of(rig):
        curve.extrapolation = "LINEAR"
        curve.keyframe_points.insert(last + 12, 0.7).interpolation = "LINEAR"
        curve.keyframe_points[-2].interpolation = "CONSTANT"
        curve.update()
    beyond = np.arange(last + 4.0, last + 40.0, 0.5)
    before = [[curve.evaluate(time) for time in beyond] for curve in curves_of(rig)]
    assert PARABOLA(**typed((first, last + 4))) == {"FINISHED"}
    after = [[curve.evaluate(time) for time in beyond] for curve in curves_of(rig)]
    assert np.abs(np.subtract(after, before)).max() < 1e-5


def test_easing_across_the_take_off_is_refused_by_name(scene):
    rig = gymnast()
    first, last = somersault(rig, 6, 24, "XYZ")
    for curve in curves_of(rig):
        for point in curve.keyframe_points:
            point.interpolation = "BOUNCE"
    before = everything(rig)
    with pytest.raises(RuntimeError, match="root.*Bézier"):
        PARABOLA(**typed((first + 2, last)))
    assert everything(rig) == before


@pytest.mark.parametrize(
    "operator, layer",
    [(PARABOLA, False), (PARABOLA, True), (SPIN, False)],
    ids=["parabola", "layer", "spin"],
)
@pytest.mark.parametrize("old, new", [(100, 200), (100, 50), (50, 75)])
def test_keys_are_at_the_times_of_a_stretched_scene(scene, old, new, layer, operator):
    rig = gymnast()
    flight = somersault(rig, 8, 24, "QUATERNION")
    factor = old / new
    scene.render.frame_map_old, scene.render.frame_map_new = old, new
    first, last = (int(np.ceil(frame / factor)) for frame in flight)
    scene.frame_end = last + 9
    assert operator(use_layer=layer, **typed((first, last))) == {"FINISHED"}
    if operator == SPIN:
        times = times_of((first, last))
        found = momenta_at(rig, times, 24)
        assert np.abs(found - found[0]).max() < 0.01 * np.linalg.norm(found[0])
        return
    path = centers_at(rig, range(first, last + 1))
    share = np.linspace(0.0, 1.0, len(path))[:, None]
    fall = 0.5 * share * (1.0 - share) * ((last - first) / 24.0) ** 2 * np.array([0, 0, 9.81])
    assert np.abs(path - path[0] - share * (path[-1] - path[0]) - fall).max() < 1e-5
    assert bpy.ops.pose.body_moments_trace() == {"FINISHED"}
    (empty,) = (obj for obj in scene.objects if "body_balance_group" in obj)
    for frame in (first, first + 3, last):
        scene.frame_set(frame)
        assert np.abs(np.subtract(empty.location, centers_at(rig, [frame])[0])).max() < 1e-5


def test_action_of_two_characters_is_refused_by_name(scene):
    """The root has no keys yet."""
    rig = gymnast()
    flight = somersault(rig, 8, 24, "XYZ")
    for curve in curves_of(rig):
        if "root" in curve.data_path:
            rig.animation_data.action.layers[0].strips[0].channelbags[0].fcurves.remove(curve)
    other = bpy.data.objects.new("Twin", rig.data)
    animation = other.animation_data_create()
    animation.action = rig.animation_data.action
    animation.action_slot = rig.animation_data.action_slot
    before = everything(rig)
    for operator in (PARABOLA, SPIN):
        with pytest.raises(RuntimeError, match="“Twin”.*single user"):
            operator(**typed(flight))
    assert everything(rig) == before
