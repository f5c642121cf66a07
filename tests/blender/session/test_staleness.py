# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that no longer hold are reported as out of date, whatever made them so, and others are
not.
"""

import bmesh
import body_moments
import bpy
import pytest
from body_moments.blender.session.tracking import staleness
from body_moments.blender.session.tracking.stamps import Kind, Stale
from body_moments.blender.write import text_report
from body_moments.core.verdict import finding

from tests.blender.objects import add, after, dent, mesh_body, only

pytestmark = pytest.mark.usefixtures("scene")


def update():
    bpy.context.view_layer.update()


def reason(obj):
    return staleness.stale_reason(obj, bpy.context.scene)


def measure(*objects):
    update()
    only(*objects)
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}
    update()
    assert [reason(obj) for obj in objects] == [None] * len(objects)


def link(obj, *collections):
    for collection in collections or (bpy.context.scene.collection,):
        collection.objects.link(obj)
    return obj


def instancer(name, member):
    """An empty that shows a collection with the member in it."""
    collection = bpy.data.collections.new(name)
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(member)
    empty = link(bpy.data.objects.new(name, None))
    empty.instance_type, empty.instance_collection, empty.location = (
        "COLLECTION",
        collection,
        (0, 20, 0),
    )
    return empty


@pytest.mark.parametrize("stacked", [True, False])
def test_undone_results_are_stale_after_later_edit(stacked):
    obj = add(mesh_body())
    if not stacked:
        obj.modifiers.new("Cast", "CAST").factor = 0.125
    bpy.ops.ed.undo_push(message="Start")
    measure(obj)
    bpy.ops.ed.undo_push(message="Measured")
    dent(obj, -1.0)
    bpy.ops.ed.undo_push(message="Edited")
    first = obj["body_volume"]
    measure(obj)
    bpy.ops.ed.undo_push(message="Measured Again")
    assert obj["body_volume"] != first
    obj = after(bpy.ops.ed.undo)
    assert obj["body_volume"] == first and reason(obj) == Stale.GEOMETRY
    obj = after(bpy.ops.ed.redo)
    assert obj["body_volume"] != first and reason(obj) is None
    measure(obj)


def evaluated_anew(obj):
    only(obj)
    bpy.ops.object.duplicate()
    yield obj, bpy.context.object
    only(obj)
    bpy.ops.object.duplicate(linked=True)
    yield obj, bpy.context.object
    obj.hide_set(True)
    update()
    obj.hide_set(False)
    yield (obj,)
    obj.data.materials.append(bpy.data.materials.new("Paint"))
    yield (obj,)
    only(obj)
    bpy.ops.object.shade_smooth()
    yield (obj,)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.object.mode_set(mode="OBJECT")
    yield (obj,)
    obj.vertex_groups.new(name="Group").add([0], 1.0, "REPLACE")
    yield (obj,)


def test_reevaluation_without_change_keeps_results_current():
    obj = add(mesh_body())
    obj.modifiers.new("Subdivision", "SUBSURF").levels = 1
    bpy.ops.object.body_moments_find_symmetry()
    measure(obj)
    for objects in evaluated_anew(obj):
        update()
        assert [reason(one) for one in objects] == [None] * len(objects)
        assert [
            staleness.stale_reason(one, bpy.context.scene, Kind.SYMMETRY) for one in objects
        ] == [None] * len(objects)
        if len(objects) == 2:
            dent(objects[1], -1.0) if objects[1].data != obj.data else bpy.data.objects.remove(
                objects[1]
            )
    assert reason(bpy.data.objects["Body.001"]) == Stale.GEOMETRY


def test_setting_of_mesh_user_keeps_other_user_current():
    one = add(mesh_body())
    other = add(one.data, "Other")
    measure(one, other)
    one.body_moments.overlap = "UNION"
    update()
    assert (reason(one), reason(other)) == (Stale.SETTINGS, None)


def test_an_edit_that_is_taken_back_is_none():
    obj = add(mesh_body())
    modifier = obj.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = 1
    measure(obj)
    bpy.ops.ed.undo_push(message="Measured")
    dent(obj, -1.0)
    bpy.ops.ed.undo_push(message="Edited")
    assert reason(obj) == Stale.GEOMETRY
    obj = after(bpy.ops.ed.undo)
    assert reason(obj) is None
    obj = after(bpy.ops.ed.redo)
    assert reason(obj) == Stale.GEOMETRY
    dent(obj, 1.0)
    assert reason(obj) is None
    for level, code in ((2, Stale.GEOMETRY), (1, None)):
        obj.modifiers[0].levels = level
        update()
        assert reason(obj) == code


def edited_vertices(obj):
    mesh = bmesh.from_edit_mesh(obj.data)
    mesh.verts.ensure_lookup_table()
    mesh.verts[0].co.x -= 1.0
    bmesh.update_edit_mesh(obj.data)


def test_undo_in_edit_mode_brings_no_numbers_back_and_is_an_edit():
    obj = add(mesh_body())
    only(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.ed.undo_push(message="Edit Mode")
    edited_vertices(obj)
    bpy.ops.ed.undo_push(message="Edited")
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}
    update()
    assert reason(obj) is None
    obj = after(bpy.ops.ed.undo)
    assert bpy.context.mode == "EDIT_MESH" and reason(obj) == Stale.GEOMETRY
    bpy.ops.object.mode_set(mode="OBJECT")


def test_symmetry_is_stale_after_other_axes():
    obj = add(mesh_body())
    only(obj)
    assert bpy.ops.object.body_moments_find_symmetry() == {"FINISHED"}
    assert bpy.ops.object.body_moments_origin_to_center() == {"FINISHED"}
    assert staleness.stale_reason(obj, bpy.context.scene, Kind.SYMMETRY) is None
    assert bpy.ops.object.body_moments_axes_to_principal() == {"FINISHED"}
    assert staleness.stale_reason(obj, bpy.context.scene, Kind.SYMMETRY) is not None
    assert bpy.ops.object.body_moments_find_symmetry() == {"FINISHED"}
    assert staleness.stale_reason(obj, bpy.context.scene, Kind.SYMMETRY) is None


@pytest.mark.parametrize("source", ["MATERIALS", "ATTRIBUTE"])
def test_a_density_that_lies_on_the_mesh_counts_as_its_geometry(source):
    obj = add(mesh_body())
    obj.body_moments.kind, obj.body_moments.thickness = "SHELL", 0.01
    obj.body_moments.density_from, obj.body_moments.density_attribute = source, "rho"
    obj.data.attributes.new("rho", "FLOAT", "POINT").data.foreach_set(
        "value", [1.0] * len(obj.data.vertices)
    )
    for density in (1000.0, 2000.0):
        material = bpy.data.materials.new("Of {:g}".format(density))
        material.body_moments.density = density
        obj.data.materials.append(material)
    measure(obj)
    obj.data.polygons[0].material_index = 1
    obj.data.attributes["rho"].data[0].value = 2.0
    obj.data.update()
    update()
    assert reason(obj) == Stale.GEOMETRY


def test_reenabled_add_on_keeps_edited_results_stale():
    obj, other, third = (add(mesh_body(), name) for name in ("Body", "Other", "Third"))
    measure(obj, other, third)
    dent(obj, -1.0)
    only(other)
    bpy.ops.object.body_moments_find_symmetry()
    dent(other, -1.0)
    body_moments.unregister()
    body_moments.register()
    assert (reason(obj), reason(other)) == (Stale.GEOMETRY,) * 2
    assert staleness.stale_reason(other, bpy.context.scene, Kind.SYMMETRY) == Stale.GEOMETRY
    assert reason(third) is None
    dent(third, -1.0)  # updates are counted anew since then
    assert reason(third) == Stale.GEOMETRY


def test_measuring_edited_shape_keeps_symmetry_stale():
    obj = add(mesh_body())
    measure(obj)
    bpy.ops.object.body_moments_find_symmetry()
    assert staleness.stale_reason(obj, bpy.context.scene, Kind.SYMMETRY) is None
    dent(obj, -1.0)
    measure(obj)
    assert staleness.stale_reason(obj, bpy.context.scene, Kind.SYMMETRY) == Stale.GEOMETRY
    bpy.ops.object.body_moments_find_symmetry()
    assert (
        staleness.stale_reason(obj, bpy.context.scene, Kind.SYMMETRY) is None
        and reason(obj) is None
    )


@pytest.mark.parametrize("nested", [False, True])
def test_instancer_is_stale_after_change_of_its_members(nested):
    member, other = add(mesh_body(), "Member"), add(mesh_body(), "Other")
    shown = instancer("Instancer", member)
    outer = instancer("Outer", shown) if nested else shown
    measure(outer, other)
    other.scale.x *= 2.0
    update()
    assert reason(outer) is None and reason(other) == Stale.TRANSFORM
    for change in (
        lambda: dent(member, -1.0),
        lambda: setattr(member, "location", (5, 0, 0)),
        lambda: shown.instance_collection.objects.link(other),
        lambda: shown.instance_collection.objects.unlink(other),
    ):
        measure(outer)
        change()
        update()
        assert reason(outer) == Stale.GEOMETRY


def test_measuring_member_keeps_instancer_current():
    member, cut = add(mesh_body(), "Member"), add(mesh_body(), "Cut", location=(0.5, 0.5, 0.1))
    cut.modifiers.new("Boolean", "BOOLEAN").object = member
    shown = instancer("Instancer", member)
    measure(shown, cut)
    measure(member)
    assert reason(shown) is None and reason(cut) is None
    bpy.ops.object.body_moments_clear()
    update()
    assert reason(shown) is None and reason(cut) is None


@pytest.mark.parametrize("kind", ["VERTS", "FACES"])
def test_parent_showing_children_is_stale_after_their_edit(kind):
    parent, child = add(mesh_body(), "Parent"), add(mesh_body(), "Child", scale=(0.1, 0.1, 0.1))
    child.parent, parent.instance_type = parent, kind
    for change in (lambda: dent(child, -1.0), lambda: setattr(child, "scale", (0.2, 0.1, 0.1))):
        measure(parent)
        change()
        update()
        assert reason(parent) == Stale.GEOMETRY


def test_emitter_is_stale_after_edit_of_particle_object():
    emitter, seed = add(mesh_body(), "Emitter"), add(mesh_body(), "Seed")
    emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = emitter.particle_systems[0].settings
    settings.type, settings.render_type, settings.count, settings.instance_object = (
        "HAIR",
        "OBJECT",
        3,
        seed,
    )
    measure(emitter)
    dent(seed, -1.0)
    assert reason(emitter) == Stale.GEOMETRY


def test_balanced_mesh_makes_its_other_users_stale():
    obj = add(mesh_body())
    group = obj.vertex_groups.new(name="Top")
    group.add(list(range(6, 12)), 1.0, "ADD")
    twin, shown = link(bpy.data.objects.new("Twin", obj.data)), instancer("Instancer", obj)
    twin.location.x = 9.0
    measure(obj, twin, shown)
    bpy.context.scene.cursor.location = (1.2, 0.9, 0.0)
    only(obj)
    assert bpy.ops.object.body_moments_sculpt_balance() == {"FINISHED"}
    update()
    assert [reason(one) for one in (obj, twin, shown)] == [None, Stale.GEOMETRY, Stale.GEOMETRY]
    measure(obj, twin, shown)
    bpy.context.scene.cursor.location = (100.0, 0.0, 0.0)
    only(obj)
    assert bpy.ops.object.body_moments_sculpt_balance(limit=1e-6) == {"CANCELLED"}
    update()
    assert [reason(one) for one in (obj, twin, shown)] == [None] * 3


def test_storing_evaluates_no_modifier_again():
    obj = add(mesh_body())
    obj.modifiers.new("Subdivision", "SUBSURF")
    update()
    seen = []

    def note(_scene, depsgraph):
        seen.extend(one.id.name for one in depsgraph.updates if one.is_updated_geometry)

    bpy.app.handlers.depsgraph_update_post.append(note)
    try:
        measure(obj)
        bpy.ops.object.body_moments_clear()
        update()
    finally:
        bpy.app.handlers.depsgraph_update_post.remove(note)
    assert seen == []


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("body_mass", float("nan")),
        ("body_volume", float("inf")),
        ("body_inertia", [float("nan")] * 6),
        ("body_method", " "),
        ("body_method", ""),
        ("body_error_bound", [float("inf")] * 8),
    ],
)
def test_numbers_that_a_person_has_overwritten_break_nothing(key, value):
    from tests.panels.drawing import shown

    good, obj = add(mesh_body(), "Good"), add(mesh_body())
    measure(obj, good)
    obj[key] = value
    update()
    shown()
    text = text_report.text(text_report.stored_document(bpy.context, [obj, good]))
    assert (str(finding("no_stored_results")) in text) == (
        key in ("body_mass", "body_volume", "body_inertia")
    )


def test_symmetry_and_moments_of_instancer_become_stale():

    member = add(mesh_body(), "Member")
    shown = instancer("Instancer", member)
    update()
    only(shown)
    bpy.ops.object.body_moments_find_symmetry()
    assert bpy.ops.object.body_moments_compute_moments() == {"FINISHED"}
    assert (
        staleness.stale_reason(shown, bpy.context.scene, Kind.SYMMETRY),
        staleness.stale_reason(shown, bpy.context.scene, Kind.MOMENTS),
    ) == (
        None,
        None,
    )
    dent(member, -1.0)
    assert staleness.stale_reason(shown, bpy.context.scene, Kind.SYMMETRY) == Stale.GEOMETRY
    assert staleness.stale_reason(shown, bpy.context.scene, Kind.MOMENTS) == Stale.GEOMETRY


def test_becoming_a_rigid_body_is_no_change_of_the_shape():
    obj, other = add(mesh_body()), add(mesh_body(), "Other")
    measure(obj, other)
    for density in (1000.0, 500.0):
        other.body_moments.density = density
        measure(other)
        only(obj, other)
        assert bpy.ops.object.body_moments_set_rigid_body_mass(add=True) == {"FINISHED"}
        update()
        assert (reason(obj), reason(other)) == (None, None)
    dent(obj, -1.0)
    assert bpy.ops.object.body_moments_set_rigid_body_mass() == {"FINISHED"}
    update()
    assert (reason(obj), reason(other)) == (Stale.GEOMETRY, None)
