# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What each kind of change makes of all that is remembered of each kind of thing, kept as text.

Every page is one thing; to a fresh scene each change is made alone: what then differs of what is said and shown.
"""

import bpy
import numpy as np
import pytest

from tests.blender.actions.assembly.test_assembly import assembly_of_boxes
from tests.blender.actions.measure.test_section import I_BEAM, flat_mesh
from tests.blender.actions.rig.test_rig import character
from tests.blender.actions.scene_state import difference, shown
from tests.blender.actions.setup.test_remedy_buttons import boxes
from tests.blender.actions.test_stability import wedge
from tests.blender.grids import vdb_grid, volume_object
from tests.blender.objects import add, mesh_body, only

pytestmark = pytest.mark.usefixtures("scene")


def body(**settings):
    obj = add(mesh_body(), "Body", (1, 2, 3), (0.3, 0.2, 0.1))
    for name, value in settings.items():
        setattr(obj.body_moments, name, value)
    bpy.ops.object.body_moments_measure()
    return obj


def all_of_a_body():
    obj = body(density=500.0)
    bpy.ops.object.body_moments_stability()
    bpy.ops.object.body_moments_compute_moments()
    bpy.ops.object.body_moments_find_symmetry()
    bpy.ops.object.body_moments_store_reference()
    return obj


def live():
    obj = body()
    bpy.ops.object.body_moments_live()
    return obj


def faulty():
    obj = add(boxes(2.0, 1.0, reverse=[0]), "Body", (1, 0, 0))
    bpy.ops.object.body_moments_measure()
    return obj


def wall():
    return body(kind="SHELL", wall="INWARD", thickness=0.01)


def by_materials():
    made = bpy.data.materials.new("Steel")
    made.body_moments.density = 7000.0
    mesh = mesh_body()
    mesh.materials.append(made)
    obj = add(mesh, "Body")
    obj.body_moments.density_from = "MATERIALS"
    bpy.ops.object.body_moments_measure()
    return obj


def section():
    obj = add(flat_mesh(I_BEAM), "Body", (1, 2, 3), (0.5, 0, 0))
    bpy.ops.object.body_moments_measure_section()
    return obj


def rig():
    armature, _ = character()
    bpy.ops.object.body_moments_measure_bones()
    return armature


def posed():
    armature, skin = character()
    only(skin)
    bpy.ops.object.body_moments_measure()
    only(armature)
    bpy.ops.object.mode_set(mode="POSE")
    return armature


def assembly():
    assembly_of_boxes()
    obj = bpy.data.objects["b0"]
    only(obj)
    bpy.ops.object.body_moments_measure_assembly()
    return obj


def threshold():
    index = np.arange(6) - 2.5
    values = 2.2 - np.sqrt(index[:, None, None] ** 2 + index[:, None] ** 2 + index**2)
    path = bpy.app.tempdir + "what_is_remembered.vdb"
    obj = volume_object(path, vdb_grid(values.astype(np.float32), background=-30.0), name="Body")
    obj.body_moments.grid_as, obj.body_moments.threshold = "THRESHOLD", 0.25
    only(obj)
    bpy.ops.object.body_moments_measure()
    return obj


def wire():
    bpy.ops.curve.primitive_nurbs_circle_add()
    bpy.context.object.body_moments.kind = "WIRE"
    bpy.ops.object.body_moments_measure()
    return bpy.context.object


def patches():
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    bpy.ops.object.body_moments_measure()
    bpy.ops.object.body_moments_live()
    return bpy.context.object


def leaning():
    obj = add(wedge(), "Body", (1, 0, 0))
    bpy.ops.object.body_moments_measure()
    bpy.ops.object.body_moments_stability()
    return obj


THINGS = (
    all_of_a_body,
    live,
    faulty,
    wall,
    by_materials,
    section,
    rig,
    posed,
    assembly,
    threshold,
    wire,
    patches,
    leaning,
)


def said(obj):
    """All that the session says of an object."""
    from body_moments.operators.session import (
        assembly,
        faults,
        live,
        moments,
        posed,
        reference,
        results,
        rig,
        stability,
        staleness,
        trust,
        walls,
    )
    from body_moments.operators.session import shown as drawn

    scene = bpy.context.scene
    yield "stale", staleness.stale_reason(obj, scene)
    yield "edited", staleness.is_edited(obj)
    yield "section stale", staleness.section_stale_reason(obj)
    yield "symmetry stale", staleness.symmetry_stale_reason(obj)
    yield "moments stale", moments.stale_reason(obj, scene)
    yield "assembly stale", [assembly.stale_reason(root) for root in (obj, bpy.context.collection)]
    if obj.type == "ARMATURE":
        yield "rig stale", rig.stale_reason(obj, scene)
        yield "meshes measured", results.are_meshes_measured(obj, scene)
        yield "meshes", [mesh.name for mesh in posed.deformed_meshes(obj)]
        for bone in list(obj.pose.bones)[:2]:
            part = drawn.shown_bone(bone, scene)
            yield "bone " + bone.name, part and [part.mass, *part.center.tolist(), str(part.verdict)]
    if "body_mass" in obj or live.is_live(obj) or posed.stands_for_meshes(obj):
        yield "trust", str(trust.trust(obj, scene))
    yield "live", [live.is_live(obj), str(live.lag(obj)), live.is_stale(obj, scene)] if live.is_live(obj) else None
    yield "stability", [stability.is_known(obj), stability.is_stale(obj)]
    support = stability.support(obj, scene)
    yield "support", support and [support.stands, float(support.margin), *support.foot.tolist()]
    poses = stability.poses(obj, scene)
    yield (
        "poses",
        poses and [len(poses.shares), *poses.shares.tolist()[:3]] if hasattr(poses, "shares") else repr(poses),
    )
    found = faults.of_object(obj)
    yield "faults", found and [len(found.edges), len(found.triangles), float(found.triangles.sum())]
    yield "wall", [walls.max_thickness(obj), walls.is_too_thick(obj)]
    referred = reference.referred(obj, scene)
    yield "referred", referred.inertia.ravel().tolist() if hasattr(referred, "inertia") else repr(referred)
    for name, stored in (("frame", results.of_object(obj, scene)), ("world", results.in_world(obj, scene))):
        yield name, stored and [stored.body.mass, stored.volume, stored.area, *stored.body.center.tolist()]
        yield name + " inertia", stored and stored.body.inertia.ravel().tolist()
    part = drawn.shown_body(obj, scene)
    yield "drawn", part and [part.mass, *part.center.tolist(), *part.gyration.tolist(), str(part.verdict)]
    yield "changes alone", drawn.changes_alone(obj)
    total = results.total(bpy.context)
    yield (
        "total",
        [total.count, total.missing, total.stale, total.doubtful, total.volume, [one.code for one in total.findings]],
    )
    yield "failure", repr(results.failure(obj))
    for key in obj.keys():  # noqa: SIM118
        if key.startswith("body_") and not key.startswith("body_moments") and "fingerprint" not in key:
            yield key, obj[key]


def state(obj):
    bpy.context.view_layer.update()
    return {place: shown(value) for place, value in said(obj)}


def points_of(obj):
    data = obj.data
    if obj.type == "MESH":
        data.vertices[0].co.x -= 0.5
        data.update()
    elif obj.type in ("CURVE", "SURFACE"):
        data.splines[0].points[0].co.x -= 0.5
        data.update_tag()


def undone(obj):
    name = obj.name
    bpy.ops.ed.undo_push(message="before")
    points_of(obj)
    bpy.context.view_layer.update()
    bpy.ops.ed.undo_push(message="edited")
    bpy.ops.ed.undo()
    return bpy.data.objects[name]


def reopened(edit):
    def change(obj):
        name, path = obj.name, bpy.app.tempdir + "what_is_remembered.blend"
        if edit:
            points_of(obj)
            bpy.context.view_layer.update()
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
        return bpy.data.objects[name]

    return change


def setting(name, value):
    return lambda obj: setattr(obj.body_moments, name, value)


def of_another(change):
    """A change of the first other object that has data."""
    return lambda obj: (
        next((change(one) for one in bpy.data.objects if one != obj and one.type == "MESH"), None) and None
    )


def other_parent(obj):
    parent = add(None, "Parent", (0, 0, 5), select=False)
    obj.parent = parent


def moved(obj):
    obj.location.x += 1.0


def scaled(obj):
    obj.scale.y *= 2.0


def turned(obj):
    obj.rotation_euler.x += 0.5


def modified(obj):
    if obj.type == "MESH":
        obj.modifiers.new("Cast", "CAST").factor = 0.9


def duplicated_name(obj):
    obj.name = "Renamed"


def unit(obj):
    bpy.context.scene.unit_settings.scale_length = 0.5


def frame(obj):
    bpy.context.scene.body_moments.frame = "OBJECT"


def pose(obj):
    if obj.type == "ARMATURE":
        bone = obj.pose.bones["arm.L"]
        bone.rotation_mode, bone.rotation_euler = "XYZ", (0.5, 0.2, 0.1)


def remeasured(obj):
    points_of(obj)
    bpy.context.view_layer.update()
    if obj.mode == "OBJECT" and obj.type != "ARMATURE":
        only(obj)
        bpy.ops.object.body_moments_measure()


def gravity(obj):
    bpy.context.scene.gravity = (9.81, 0.0, 0.0)


def material(obj):
    for made in bpy.data.materials:
        made.body_moments.density = 1234.0


def damaged(obj):
    obj["body_inertia"] = "gone"


def with_live(obj):
    if obj.mode == "OBJECT" and obj.type != "ARMATURE":
        only(obj)
        bpy.ops.object.body_moments_live()


CHANGES = {
    "nothing": lambda obj: None,
    "moved": moved,
    "scaled": scaled,
    "turned": turned,
    "edited": points_of,
    "edited, and that undone": undone,
    "saved and opened": reopened(False),
    "edited, saved and opened": reopened(True),
    "edited, and measured again": remeasured,
    "another modifier": modified,
    "another name": duplicated_name,
    "below a parent": other_parent,
    "kind": setting("kind", "SHELL"),
    "density": setting("density", 250.0),
    "linear density": setting("linear_density", 3.0),
    "mass given": setting("mass_from", "MASS"),
    "thickness": setting("thickness", 0.02),
    "wall": setting("wall", "OUTWARD"),
    "threshold": setting("threshold", 0.75),
    "overlap": setting("overlap", "UNION"),
    "density from a polynomial": setting("density_from", "POLYNOMIAL"),
    "a material's density": material,
    "another scale of the scene": unit,
    "the object's frame": frame,
    "gravity": gravity,
    "a bone": pose,
    "another object moved": of_another(moved),
    "another object edited": of_another(points_of),
    "another object's density": of_another(setting("density", 250.0)),
    "numbers damaged": damaged,
    "live on or off": with_live,
    "nothing selected": lambda obj: obj.select_set(False),
}


@pytest.mark.parametrize("build", THINGS, ids=lambda build: build.__name__)
def test_what_a_change_makes_of(build, kept, monkeypatch):
    from body_moments.operators.session import live

    monkeypatch.setattr(live, "BUDGET", 1000.0)  # s: on any machine
    lines = []
    for title, change in CHANGES.items():
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        obj = build()
        before = state(obj)
        if not lines:
            lines = ["{:s}: {:s}".format(*line) for line in before.items()]
        obj = change(obj) or obj
        lines += ["=== " + title, *difference(before, state(obj))]
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
    kept("{:s}.txt".format(build.__name__), "\n".join(lines))
