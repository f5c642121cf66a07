# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Live numbers are those of what is shown: after a move without measuring, while it deforms, and in
full afterwards.
"""

import itertools
from math import dist, isclose

import bpy
import numpy as np
import pytest
from body_moments.blender.session import memory
from body_moments.blender.session.displayed import Verdict, displayed, drawn, total
from body_moments.blender.session.live import following, mapping
from body_moments.blender.session.live import measuring as live
from body_moments.blender.session.tracking import armatures
from body_moments.core.inertia.plain_body import add_bodies
from mathutils import Euler, Matrix

from tests.blender.boxes import armature_with, update
from tests.blender.grids import vdb_grid, volume_object
from tests.blender.objects import add, after, arrays, dent, measured, mesh_body, only
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


@pytest.fixture(autouse=True)
def _enough_time(monkeypatch):
    """A budget that a busy machine keeps."""
    monkeypatch.setattr(live, "_budget", lambda: 1.0)


def start(*objects):
    only(*objects)
    assert bpy.ops.object.body_moments_live() == {"FINISHED"}
    assert all(obj in memory.followed for obj in objects)


def tick(monkeypatch, idle=True):
    """Let the timer come, after a while without updates."""
    with monkeypatch.context() as patch:
        patch.setattr(live, "IDLE", 0.0 if idle else 1e9)
        return live._tick()


def forbid_measuring(monkeypatch):
    monkeypatch.setattr(live, "measure_body", lambda *_args: pytest.fail("It was measured."))


def assert_current(obj, inertia=True, rel=1e-6):
    """What is shown is what measuring would give."""
    truth = measured(obj)
    shown = displayed(obj, bpy.context.scene).world
    body, found = truth.mass_properties, arrays(shown)
    assert close([shown.volume, shown.mass], [truth.volume, body.mass], rel)
    reach = np.linalg.norm(body.center) + np.linalg.norm(body.radii_of_gyration)
    assert np.linalg.norm(found.center - body.center) <= rel * reach
    if inertia:
        assert (
            np.abs(found.inertia - body.inertia).max() <= 10.0 * rel * body.principal.moments.max()
        )
        assert close(found.moments, body.principal.moments, 10.0 * rel)


def with_key(name="Body"):
    obj = add(mesh_body(), name, location=(3, -1, 2), rotation=(0.3, 0.2, 1.0), scale=(1, 2, -0.7))
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Key")
    for i in range(3):
        key.data[i].co.x -= 1.0 + i
    for frame, value in ((1, 0.0), (11, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    bpy.context.scene.frame_set(1)
    return obj


@pytest.mark.parametrize("given_mass", [False, True])
@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_an_object_that_moves_is_not_measured(unit, given_mass, monkeypatch):
    bpy.context.scene.unit_settings.scale_length = unit
    obj = add(mesh_body(), location=(3, -2, 5), rotation=(0.3, -0.7, 2.1), scale=(1, 2, -0.7))
    if given_mass:
        obj.body_moments.mass_from, obj.body_moments.mass = "MASS", 3.5
    start(obj)
    assert_current(obj)
    with monkeypatch.context() as patch:
        forbid_measuring(patch)
        for matrix in (Matrix.Translation((5, 6, -70)), Euler((1, 2, 3)).to_matrix().to_4x4()):
            obj.matrix_world = matrix @ obj.matrix_world
            update()
            assert_current(obj)
            assert (
                drawn(obj, bpy.context.scene).verdict == Verdict.EXACT
                and mapping.lag(obj) == following.Lag.NONE
            )
            assert tick(patch) is None
        obj.scale = (0.5, -3.0, 2.0)
        update()
        assert_current(obj)
    assert tick(monkeypatch) is None
    assert_current(obj)
    assert close(memory.followed[obj].measurement.area, measured(obj).area, 1e-12)


def test_stretched_object_keeps_direction_of_axes():
    obj = add(mesh_body(), rotation=(0.3, -0.7, 2.1), scale=(1, 2, -0.7))
    start(obj)
    for turn in ((1, 2, 3), (2, 0, 1), (2.5, 0, 0)):
        before = arrays(displayed(obj, bpy.context.scene).world).axes
        matrix = Euler(turn).to_matrix()
        obj.matrix_world = matrix.to_4x4() @ obj.matrix_world
        obj.scale.x *= 1.02
        update()
        axes = arrays(displayed(obj, bpy.context.scene).world).axes
        assert np.abs(axes - np.array(matrix) @ before).max() < 0.1


@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_deforming_object_has_live_volume_and_center(unit, monkeypatch):
    bpy.context.scene.unit_settings.scale_length = unit
    obj = with_key()
    start(obj)
    before = list(obj.keys())
    with monkeypatch.context() as patch:
        forbid_measuring(patch)
        for frame in (3, 7, 11):
            bpy.context.scene.frame_set(frame)
            assert mapping.lag(obj) == following.Lag.FIRST_ORDER
            assert_current(obj, inertia=False)
            obj.location.x += 1.0
            update()
            assert_current(obj, inertia=False)
    assert tick(monkeypatch) is None and mapping.lag(obj) == following.Lag.NONE
    assert_current(obj)
    assert list(obj.keys()) == before


def test_update_beyond_budget_is_late_and_marked(monkeypatch):
    objects = [with_key("A"), with_key("B")]
    start(*objects)
    memory.followed.get(objects[0]).pass_seconds = 10.0
    bpy.context.scene.frame_set(5)
    assert [mapping.lag(obj) for obj in objects] == [
        following.Lag.BEHIND,
        following.Lag.FIRST_ORDER,
    ]
    assert [drawn(obj, bpy.context.scene).verdict for obj in objects] == [
        Verdict.OUT_OF_DATE,
        Verdict.EXACT,
    ]
    for obj in objects:
        memory.followed[obj].seconds = 5.0
    assert tick(monkeypatch, idle=False) == live.POLL and memory.followed[objects[0]].is_pending
    assert tick(monkeypatch) is None
    for obj in objects:
        assert_current(obj)


def other_faces(obj):
    obj.modifiers.new("Solidify", "SOLIDIFY").thickness = 0.01


def in_edit_mode(obj):
    only(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.transform.resize(value=(2, 1, 1))


def sculpted(obj):
    only(obj)
    bpy.ops.object.mode_set(mode="SCULPT")
    dent(obj, -1.0)


def flipped(obj):
    obj.data.polygons[0].flip()
    obj.data.update()


@pytest.mark.parametrize("change", [other_faces, in_edit_mode, sculpted, flipped])
def test_an_edit_measures_that_object_alone(change, monkeypatch):
    obj, other = add(mesh_body()), add(mesh_body(), "Other", (9, 0, 0))
    start(obj, other)
    kept = memory.followed[other].measurement
    change(obj)
    update()
    assert memory.followed[obj].is_pending and not memory.followed[other].is_pending
    assert tick(monkeypatch) is None
    assert_current(obj)
    assert memory.followed[other].measurement is kept
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize(
    "settings",
    [
        {},
        {"kind": "SHELL", "thickness": 0.01},
        {"overlap": "UNION"},
        {"density_from": "POLYNOMIAL", "density_polynomial": "1000 + 20*x"},
    ],
)
def test_live_patches_are_tracked_as_uniform_solids_only(settings, monkeypatch):
    bpy.context.scene.unit_settings.scale_length = 0.5
    bpy.ops.surface.primitive_nurbs_surface_sphere_add(location=(1, 2, 3), rotation=(0.3, 0.2, 0.1))
    obj = bpy.context.object
    obj.scale = (-1, 2, 0.5)
    for name, value in settings.items():
        setattr(obj.body_moments, name, value)
    start(obj)
    assert_current(obj)
    assert (memory.followed[obj].tracked is not None) == (not settings)
    obj.data.splines[0].points[9].co.x -= 0.25
    obj.data.update_tag()
    update()
    assert tick(monkeypatch) is None
    assert_current(obj, rel=1e-6 if settings else 1e-4)  # patches are tracked in triangles


def shell(obj):
    obj.body_moments.kind, obj.body_moments.thickness = "SHELL", 0.01


def capped(obj):
    obj.data.polygons[0].flip()


def varying(obj):
    obj.body_moments.density_from, obj.body_moments.density_frame = "POLYNOMIAL", "WORLD"
    obj.body_moments.density_polynomial = "1000 + 20*x"


@pytest.mark.parametrize("kind", [shell, capped, varying])
def test_live_kinds_are_current_after_move_stretch_and_edit(kind, monkeypatch):
    obj = add(mesh_body(), location=(1, 2, 3))
    kind(obj)
    start(obj)
    for change in (
        lambda: setattr(obj, "location", (5, 6, 7)),
        lambda: setattr(obj, "scale", (1, 2, 3)),
        lambda: setattr(obj.data.vertices[0].co, "x", -1.0),
    ):
        change()
        obj.data.update()
        update()
        assert tick(monkeypatch) is None
        assert_current(obj)


def assert_bounds_hold(shown, parts):
    """Each body moved, grown and turned by as much as its bounds allow stays within those of the
    sum; hardly less.
    """
    allowed = shown.error_bound["input"]
    bounds = [part.error_bound["input"] for part in parts]
    assert allowed["volume"] == sum(bound["volume"] for bound in bounds)
    assert allowed["area"] == sum(bound["area"] for bound in bounds)
    largest = {"center_of_mass": 0.0, "inertia": 0.0}
    for signs in itertools.product((-1.0, 1.0), repeat=len(parts)):
        changed = []
        for part, bound, sign in zip(parts, bounds, signs):
            mass = part.mass * (1.0 + sign * bound["volume"] / part.volume)
            arm = np.subtract(part.center, shown.center)
            center = part.center + sign * bound["center_of_mass"] * arm / np.linalg.norm(arm)
            inertia = np.add(part.inertia, sign * bound["inertia"])
            changed.append(part._replace(mass=mass, center=center, inertia=inertia))
        whole = add_bodies(changed)
        off = np.subtract(whole.inertia, shown.inertia)
        largest["center_of_mass"] = max(largest["center_of_mass"], dist(whole.center, shown.center))
        largest["inertia"] = max(largest["inertia"], np.abs(off).max())
    for name, off in largest.items():
        assert 0.1 * allowed[name] < off <= allowed[name], name


def test_in_pose_mode_the_armature_stands_for_its_meshes(monkeypatch):
    meshes = [add(mesh_body(), "A"), add(mesh_body(), "B", (4, 0, 0))]
    armature, other = armature_with(*meshes), add(mesh_body(), "Other", (0, 9, 0))
    assert armatures.subjects([armature]) == [armature]
    only(armature)
    bpy.ops.object.mode_set(mode="POSE")
    assert armatures.subjects([armature]) == meshes
    assert bpy.ops.object.body_moments_live() == {"FINISHED"}
    assert [obj in memory.followed for obj in (*meshes, other, armature)] == [
        True,
        True,
        False,
        False,
    ]
    with monkeypatch.context() as patch:
        forbid_measuring(patch)
        armature.pose.bones["Bone"].location = (0.0, 1.0, 0.0)
        update()
        parts = [measured(mesh) for mesh in meshes]
        shown = displayed(armature, bpy.context.scene).world
        mass = sum(part.mass_properties.mass for part in parts)
        center = (
            sum(part.mass_properties.mass * part.mass_properties.center for part in parts) / mass
        )
        assert isclose(shown.mass, mass, rel_tol=1e-6)
        assert np.linalg.norm(shown.center - center) <= 1e-6 * np.linalg.norm(center)
        assert drawn(armature, bpy.context.scene).world.center == shown.center
        assert total(bpy.context).count == 2
        assert_bounds_hold(shown, [displayed(mesh, bpy.context.scene).world for mesh in meshes])
    bpy.ops.object.body_moments_live()
    assert not any(obj in memory.followed for obj in meshes)
    bpy.ops.object.mode_set(mode="OBJECT")


def test_undo_is_followed(monkeypatch):
    obj = add(mesh_body())
    start(obj)
    bpy.ops.ed.undo_push(message="Before")
    dent(obj, -1.0)
    bpy.ops.ed.undo_push(message="Edited")
    tick(monkeypatch)
    obj = after(bpy.ops.ed.undo)
    assert obj in memory.followed
    tick(monkeypatch)
    assert_current(obj)
    assert memory.followed.get(obj).number == memory.state.updates


@pytest.mark.parametrize("kind", ["SOLID", "SHELL"])
def test_scaled_wall_is_stale_until_measured(kind, monkeypatch):
    obj = add(mesh_body(), location=(3, -1, 2), rotation=(0.3, 0.2, 1.0))
    obj.body_moments.kind, obj.body_moments.thickness = kind, 0.01
    start(obj)
    measured_so = drawn(obj, bpy.context.scene).verdict
    assert measured_so != Verdict.OUT_OF_DATE
    obj.scale.y = 1.7
    update()
    assert drawn(obj, bpy.context.scene).verdict == (
        Verdict.OUT_OF_DATE if kind == "SHELL" else measured_so
    )
    tick(monkeypatch)
    assert_current(obj)
    obj.rotation_euler = (1.0, 2.0, 3.0)
    update()
    assert drawn(obj, bpy.context.scene).verdict == measured_so
    assert_current(obj)


def test_stretched_grid_keeps_its_given_mass(tmp_path):
    grid = volume_object(tmp_path / "fog.vdb", vdb_grid(np.ones((4, 4, 4), np.float32)))
    grid.body_moments.mass_from, grid.body_moments.mass = "MASS", 5.0
    update()
    start(grid)
    grid.scale.x = 2.0
    update()
    shown = displayed(grid, bpy.context.scene)
    assert shown.live is not None and close(
        [shown.world.mass, shown.world.center[0]], [5.0, 3.0], 1e-6
    )
