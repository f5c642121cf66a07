# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""When the members of an assembly are the same bodies after their objects got other origins and axes."""

import bpy
import numpy as np
import pytest
from body_moments.core.verdict.finding import finding
from body_moments.operators.bodies.assembly import measure_assembly
from body_moments.operators.session import assembly, reference, results
from body_moments.operators.write import properties
from mathutils import Matrix, Vector

from tests.blender.actions.assembly.test_assembly import activate
from tests.blender.bodies.test_assembly import box, collection, instance
from tests.blender.objects import add, only
from tests.close import close

pytestmark = pytest.mark.usefixtures("registered", "scene")


def test_members_are_the_same_to_rounding_and_no_further():
    rtol = 1e-5
    for mass, center, size in ((3.0, (1.0, -2.0, 0.5), 0.25), (1e-9, (0.0, 0.0, 0.0), 4.0)):
        before = mass, np.array(center), size
        reach = max(size, np.abs(center).max())
        for factor, is_same in ((0.9, True), (1.2, False), (-0.9, True), (-1.2, False)):
            step = factor * rtol
            assert assembly._is_same(before, (mass * (1.0 + step), before[1], size)) == is_same
            assert assembly._is_same(before, (mass, before[1], size * (1.0 + step))) == is_same
            for axis in np.eye(3):
                assert assembly._is_same(before, (mass, before[1] + step * reach * axis, size)) == is_same


def three_assemblies():
    """Collections with a box each, and an empty between them that is none."""
    roots = [collection(name) for name in "ABC"]
    for number, root in enumerate(roots):
        box(root, (1, 2, 3 + number), (5 * number, 0, 0), name="box " + root.name)
        activate(root)
        assert bpy.ops.object.body_moments_measure_assembly() == {"FINISHED"}
    assert [assembly.stale_reason(root) for root in roots] == [None] * 3
    return roots


def other_frame(obj):
    """The same body in other coordinates, measured again."""
    obj.data.transform(Matrix.Translation((-1.0, 0.5, 2.0)))
    obj.location = obj.matrix_world @ Vector((1.0, -0.5, -2.0))
    bpy.context.view_layer.update()
    only(obj)
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}


def joined(root):
    box(root, (1, 1, 1), name="new")


def moved(root):
    root.objects[0].location.z += 1.0


def gone(root):
    del root["body_fingerprint"]


def heavier(root):
    root.objects[0].body_moments.density *= 2.0


def edited(root):
    root.objects[0].data.vertices[0].co.z -= 0.5
    root.objects[0].data.update()


def without_numbers(root):
    only(root.objects[0])
    bpy.ops.object.body_moments_clear()


@pytest.mark.parametrize("change", [joined, moved, gone, heavier, edited, without_numbers])
def test_what_became_another_assembly_keeps_no_other_from_staying_up_to_date(change):
    first, second, third = three_assemblies()
    with assembly.kept_up_to_date(bpy.context):
        change(first)
        change(second)
        other_frame(third.objects[0])
        bpy.context.view_layer.update()
        assert assembly.stale_reason(third) == "stale_member"  # until the end
    assert assembly.stale_reason(third) is None
    assert None not in [assembly.stale_reason(root) for root in (first, second)]
    other_frame(third.objects[0])
    assert assembly.stale_reason(third) == "stale_member"


@pytest.mark.parametrize("density", [500.0, 0.01])
def test_rows_say_what_instances_weigh_and_why_members_do_not(density):
    parts, root = collection("Parts"), collection("Robot")
    box(parts, (1, 2, 3), (4, 0, 0), density, "inner")
    instance(root, parts, location=(5, 0, 0), scale=(2, 2, 2)).name = "twice"
    flat = add(bpy.data.meshes.new("Nothing"), "nothing")
    bpy.context.scene.collection.objects.unlink(flat)
    root.objects.link(flat)
    activate(root)
    assert bpy.ops.object.body_moments_measure_assembly() == {"FINISHED"}
    rows = [(row.name, row.depth, row.mass, row.share, row.is_counted) for row in root.body_moments.rows]
    assert [(name, depth) for name, depth, *_ in rows] == [
        *(("Robot", 0), ("nothing", 1), ("twice", 1), ("Parts", 2), ("inner", 3))
    ]
    total = 8.0 * 6.0 * density
    for (name, _, mass, share, is_counted), own in zip(rows, (total, 0.0, total, total, total), strict=True):
        assert close(mass, own, 1e-6) and close(share, own / total, 1e-6) and is_counted == (own > 0), name
    reason = results.failure(flat)
    assert reason is not None
    assert [found.code for found in properties.findings_in(root.body_moments.rows[1].findings)] == [reason.code]


def test_members_that_cannot_hold_their_results_are_named_and_the_others_have_theirs(monkeypatch):
    root = collection("Robot")
    for name in ("a", "b"):
        box(collection("Arm " + name, root), (1, 2, 3), name="box " + name)

    def planted(part, *args):
        if part.member.name == "Arm a":
            raise TypeError("planted")
        return assembly_measurement(part, *args)

    assembly_measurement = assembly.assembly_measurement
    monkeypatch.setattr(assembly, "assembly_measurement", planted)
    bpy.context.view_layer.update()
    measured = measure_assembly(root, bpy.context.evaluated_depsgraph_get())
    failures = assembly.store(bpy.context, measured)
    assert [(name, found.code) for name, found in failures] == [("Arm a", "internal_error")]
    assert "body_mass" not in bpy.data.collections["Arm a"] and "body_mass" in bpy.data.collections["Arm b"]
    monkeypatch.setattr(
        results, "store_many", lambda measured, scene: [(obj, TypeError("planted")) for obj, _ in measured]
    )
    failures = assembly.store(bpy.context, measured)
    assert [(name, found.code) for name, found in failures] == [
        *(("Arm a", "internal_error"), ("box a", "internal_error"), ("box b", "internal_error"))
    ]


def test_what_is_stored_and_remembered_of_each_kind_of_member():
    """Of an object its own results, or why there are none; of what was left out what was known; of no instance any."""
    parts, root = collection("Parts"), collection("Robot")
    inner = box(parts, (1, 2, 3), (4, 0, 0), name="inner")
    shown, sheared = instance(root, parts, location=(5, 0, 0)), instance(root, parts, location=(9, 0, 0))
    sheared.scale = (0, 1, 1)
    nothing, good = add(bpy.data.meshes.new("Nothing"), "nothing"), box(root, (1, 1, 1), name="good")
    left_out, unused = box(root, (1, 1, 1), (3, 3, 3), name="left out"), collection("Unused", root)
    bare = collection("Bare", root)
    for obj, holder in ((nothing, root), (add(bpy.data.meshes.new("Bare"), "bare"), bare)):
        bpy.context.scene.collection.objects.unlink(obj)
        holder.objects.link(obj)
    left_out.hide_render = True
    bpy.context.view_layer.update()
    before = finding("no_volume")
    for obj in (good, left_out, shown):
        results.remember_failure(obj, before)
    activate(root)
    measured = measure_assembly(root, bpy.context.evaluated_depsgraph_get())
    assert assembly.store(bpy.context, measured) == []
    assert ["body_mass" in one for one in (root, good, inner)] == [True] * 3
    assert not any("body_mass" in one for one in (shown, sheared, nothing, left_out, unused, bare))
    assert results.failure(good) is None and results.failure(left_out) == results.failure(shown) == before
    assert results.failure(nothing) is not None and results.failure(sheared) is None
    settings = bpy.context.scene.body_moments_reference
    settings.about = "WORLD"
    reference.store(root, bpy.context.scene)
    was = list(root["body_reference_inertia"])
    good.location.z += 5.0
    bpy.context.view_layer.update()
    assembly.store(bpy.context, measure_assembly(root, bpy.context.evaluated_depsgraph_get()))
    assert list(root["body_reference_inertia"]) != was


@pytest.mark.parametrize("unit", [1.0, 0.01])
def test_members_count_whose_results_are_part_of_the_whole(unit):
    """Neither what was left out nor what has none; assemblies in it by their members."""
    bpy.context.scene.unit_settings.scale_length = unit
    root = collection("Robot")
    arm = collection("Arm", root)
    nothing, first = add(bpy.data.meshes.new("Nothing"), "a nothing"), box(root, (1, 2, 3), (4, 5, 6), name="b first")
    second, left_out = box(arm, (2, 1, 1), (-3, 0, 0), name="second"), box(root, (1, 1, 1), name="c left out")
    bpy.context.scene.collection.objects.unlink(nothing)
    root.objects.link(nothing)
    first.rotation_euler = (0.3, 0.2, 0.1)
    only(left_out)
    bpy.ops.object.body_moments_measure()
    left_out.hide_render = True
    bpy.context.view_layer.update()
    activate(root)
    assert bpy.ops.object.body_moments_measure_assembly() == {"FINISHED"}
    count = len(root.body_moments.rows)
    assert bpy.ops.object.body_moments_measure_assembly() == {"FINISHED"} and len(root.body_moments.rows) == count
    assert "body_mass" in arm and "body_mass" in left_out and "body_mass" not in nothing
    found = assembly._member_bodies(assembly.members_of(root, bpy.context.evaluated_depsgraph_get()))
    assert found.keys() == {first, second}
    for obj, size, center in ((first, (1, 2, 3), (4, 5, 6)), (second, (2, 1, 1), (-3, 0, 0))):
        mass, place, radius = found[obj]
        assert close(mass, 1000.0 * np.prod(size) * unit**3, 1e-6)
        assert close(place, unit * np.array(center), 1e-6)
        assert close(radius, unit * np.sqrt(np.dot(size, size) / 12.0), 1e-6)
    with assembly.kept_up_to_date(bpy.context):
        other_frame(first)
        left_out.body_moments.density = 1.0
        bpy.context.view_layer.update()
    assert assembly.stale_reason(root) is None
