# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Balance in Edit Mode and Object Mode: what moves, what does not, and what is refused."""

from contextlib import contextmanager

import bpy
import numpy as np
import pytest
from body_moments.blender.session.stored import stability
from body_moments.blender.session.tracking import staleness
from body_moments.blender.session.tracking.stamps import Stale
from body_moments.blender.write import properties
from mathutils import Matrix

from tests.blender.objects import add, editing, measure, measured, mesh_of, only
from tests.close import close
from tests.operators.balancing import balance, bmesh, edit, figure, points

pytestmark = pytest.mark.usefixtures("scene")


def world(obj, local):
    matrix = np.array(obj.matrix_world, np.float64)
    return local @ matrix[:3, :3].T + matrix[:3, 3]


def group(obj, weight=lambda co: float(co.z > 0.1), name="Top"):
    made = obj.vertex_groups.new(name=name)
    for vertex in obj.data.vertices:
        value = weight(vertex.co)
        if value > 0.0:
            made.add([vertex.index], value, "REPLACE")
    return made


def center(obj):
    return measured(obj).mass_properties.center


@contextmanager
def told_of(mesh):
    """The changes of a mesh's geometry that Blender is told of."""
    changes = []

    def note(_scene, depsgraph):
        changes.extend(
            one for one in depsgraph.updates if one.id.original == mesh and one.is_updated_geometry
        )

    bpy.app.handlers.depsgraph_update_post.append(note)
    try:
        yield changes
    finally:
        bpy.app.handlers.depsgraph_update_post.remove(note)


@pytest.fixture(autouse=True)
def object_mode():
    yield
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def test_what_cannot_lean_is_refused(reported):
    flat = add(mesh_of([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)]), "Flat")
    flat.body_moments.kind = "SHELL"
    only(flat)
    unchanged(flat, points(flat), "balance_no_effect", reported)
    only(figure())
    bpy.context.scene.cursor.location = (0.0, 0.0, -2.0)  # below the ground
    unchanged(
        bpy.context.object, points(bpy.context.object), "balance_no_effect", reported, axes="ALL"
    )
    only(add(bpy.data.meshes.new("Empty"), "Empty"))
    assert balance() == {"CANCELLED"}


@pytest.mark.parametrize("kind", ["SOLID", "SHELL"])
def test_object_without_groups_leans(kind):
    obj = figure(rotation=(0.3, 0.2, 0.1), scale=(1.0, 2.0, 0.5))
    only(obj)
    obj.body_moments.kind = kind
    before = world(obj, points(obj))
    height = before[:, 2] - before[:, 2].min()
    bpy.context.scene.cursor.location = (0.7, -0.4, 0.0)
    assert balance() == {"FINISHED"}
    moves = world(obj, points(obj)) - before
    assert close(center(obj)[:2], (0.7, -0.4), 2e-6)
    assert (
        np.abs(moves - np.multiply.outer(height / height.max(), moves[height.argmax()])).max()
        < 1e-6
    )
    bpy.context.scene.cursor.location = (0.0, 0.0, 0.0)
    there = points(obj)
    assert balance(limit=0.1) == {"CANCELLED"} and (points(obj) == there).all()


def test_balance_moves_selection_and_puts_center_over_cursor():
    obj = figure()
    selected = edit(obj)
    before, height = points(obj), center(obj)[2]
    bpy.context.scene.cursor.location = (0.02, 0.01, -1.0)
    assert balance() == {"FINISHED"}
    assert obj.mode == "EDIT"
    moved = np.abs(points(obj) - before).max(axis=1) > 0
    assert np.array_equal(points(obj)[~selected], before[~selected]) and moved[selected].sum() > 20
    assert np.abs(center(obj)[:2] - (0.02, 0.01)).max() < 1e-6
    assert 0.0 < abs(center(obj)[2] - height) < 0.3
    for face in bmesh.from_edit_mesh(obj.data).faces:
        shown = face.normal.copy()
        face.normal_update()
        assert (shown - face.normal).length < 1e-6
    bpy.ops.object.mode_set(mode="OBJECT")
    assert np.abs(center(obj)[:2] - (0.02, 0.01)).max() < 1e-6
    assert np.array_equal([vertex.select for vertex in obj.data.vertices], selected)


@pytest.mark.parametrize("is_on", [True, False])
def test_balance_is_along_gravity_if_it_is_on(is_on):
    obj = figure()
    edit(obj)
    bpy.context.scene.gravity, bpy.context.scene.use_gravity = (0.0, 9.81, 0.0), is_on
    bpy.context.scene.cursor.location = (0.05, 5.0, 0.0) if is_on else (0.05, 0.0, 5.0)
    assert balance() == {"FINISHED"}
    assert np.abs(center(obj)[[0, 2 if is_on else 1]] - (0.05, 0.0)).max() < 1e-6


@pytest.mark.parametrize("scale", [(2.0, 0.5, 1.5), (-1.0, 1.0, 1.0), (0.01, 0.01, 0.01)])
def test_scaled_parented_object_is_balanced_in_world(scale):
    obj = figure(rotation=(0.5, 0.2, 0.1), scale=scale)
    obj.parent = add(None, "Parent", (10.0, -5.0, 3.0), scale=(1.0, 1.5, 2.0), select=False)
    bpy.context.view_layer.update()
    size = np.ptp(world(obj, points(obj)), axis=0).max()
    target = center(obj) + np.array([-0.01, 0.01, 0.0]) * size
    edit(obj)
    assert balance(target="POINT", point=target) == {"FINISHED"}
    assert np.abs(center(obj) - target)[:2].max() < 2e-6 * (size + 10.0)


def test_no_vertex_moves_further_than_the_limit():
    obj = figure()
    edit(obj)
    before = points(obj)
    bpy.context.scene.cursor.location = (0.06, 0.0, 0.0)
    assert balance() == {"FINISHED"}
    free = np.linalg.norm(points(obj) - before, axis=1).max()
    bpy.ops.object.mode_set(mode="OBJECT")
    obj.data.vertices.foreach_set("co", before.astype(np.float32).ravel())
    edit(obj)
    assert balance(limit=0.7 * free) == {"FINISHED"}
    assert np.linalg.norm(points(obj) - before, axis=1).max() <= 0.7 * free * (1 + 1e-6)
    assert np.abs(center(obj)[:2] - (0.06, 0.0)).max() < 1e-6


def unchanged(obj, before, code, reported, **more):
    assert balance(**more) == {"CANCELLED"}
    assert np.array_equal(points(obj), before)
    assert code in reported.codes


@pytest.fixture
def over_cursor(scene):
    bpy.context.scene.cursor.location = (0.05, 0.0, 0.0)


@pytest.mark.usefixtures("over_cursor")
class TestRefused:
    """Refusals leave everything as it was, with the reason."""

    def test_no_selection(self, reported):
        obj = figure()
        edit(obj, lambda co: False)
        unchanged(obj, points(obj), "balance_impossible", reported)

    def test_too_far(self, reported):
        obj = figure()
        measure(obj)
        numbers = properties.stored(obj)
        edit(obj, lambda co: co.z > 0.8)
        bpy.context.scene.cursor.location = (50.0, 0.0, 0.0)
        before = points(obj)
        unchanged(obj, before, "balance_short", reported)
        size = np.linalg.norm(np.ptp(before, axis=0))  # the limit where none is given
        assert close(reported.values("balance_short")["limit"], size, rel=1e-6)
        bpy.ops.object.mode_set(mode="OBJECT")
        assert properties.stored(obj) == numbers

    @pytest.mark.parametrize("unit", [1.0, 0.01])
    @pytest.mark.parametrize("way", [edit, group])
    def test_too_small_limit_moves_nothing(self, way, unit, reported):
        bpy.context.scene.unit_settings.scale_length = unit
        obj = figure()
        way(obj)
        bpy.context.view_layer.update()
        before = points(obj)
        with told_of(obj.data) as changes:
            assert balance(limit=1e-4) == {"CANCELLED"}
            bpy.context.view_layer.update()
        assert not changes and np.array_equal(points(obj), before)
        assert close(reported.values("balance_short")["limit"], 1e-4 * unit, rel=1e-6)

    def test_a_mesh_that_is_open(self, reported):
        obj = figure()
        edit(obj)
        mesh = bmesh.from_edit_mesh(obj.data)
        mesh.faces.ensure_lookup_table()
        bmesh.ops.delete(mesh, geom=mesh.faces[:1], context="FACES")
        bmesh.update_edit_mesh(obj.data)
        unchanged(obj, points(obj), "balance_impossible", reported)

    def test_shape_keys(self, reported):
        obj = figure()
        obj.shape_key_add(name="Basis")
        edit(obj)
        unchanged(obj, points(obj), "shape_not_of_mesh", reported)

    def test_modifiers_that_change_the_mesh(self, reported):
        obj = figure()
        obj.modifiers.new("Smooth", "SUBSURF").levels = 1
        obj.modifiers.new("Hidden", "SUBSURF").show_viewport = False
        edit(obj)
        unchanged(obj, points(obj), "shape_not_of_mesh", reported)
        assert reported.values("shape_not_of_mesh") == {"makers": ["Smooth"]}

    def test_mesh_bent_by_its_parent(self, reported):
        cage = add(bpy.data.lattices.new("Cage"), "Cage", scale=(3, 3, 3), select=False)
        cage.data.points[1].co_deform.x += 0.3
        obj = figure()
        obj.parent, obj.parent_type = cage, "LATTICE"
        group(obj)
        bpy.context.view_layer.update()
        unchanged(obj, points(obj), "shape_not_of_mesh", reported)

    def test_no_active_group(self, reported):
        obj = figure()
        group(obj)
        obj.vertex_groups.active_index = -1
        unchanged(obj, points(obj), "balance_impossible", reported)

    def test_a_wall(self, reported):
        obj = figure()
        obj.body_moments.kind, obj.body_moments.wall = "SHELL", "INWARD"
        edit(obj)
        unchanged(obj, points(obj), "balance_impossible", reported)

    def test_a_zero_scale(self, reported):
        obj = figure(scale=(1, 1, 0))
        obj.body_moments.kind = "SHELL"
        edit(obj)
        unchanged(obj, points(obj), "scale_zero_axis", reported)


@pytest.mark.usefixtures("over_cursor")
def test_other_users_of_balanced_mesh_become_stale(reported):
    obj = figure()
    other = add(obj.data, "Other")
    measure(obj, other)
    only(obj)
    group(obj)
    assert balance() == {"FINISHED"}
    assert "Other objects use this mesh" in "".join(reported.texts)
    bpy.context.view_layer.update()
    reasons = [staleness.stale_reason(one, bpy.context.scene) for one in (obj, other)]
    assert reasons == [None, Stale.GEOMETRY]


def test_distant_fine_mesh_is_balanced_to_float32():
    mesh = bpy.data.meshes.new("Fine")
    with editing(mesh) as work:
        bmesh.ops.create_icosphere(
            work, subdivisions=5, radius=1.0, matrix=Matrix.Diagonal((1.0, 1.5, 0.7, 1.0))
        )
    obj = add(mesh, location=(1000.0, 0.0, 0.0))
    group(obj, lambda co: float(co.z > 0.0))
    assert balance(target="POINT", point=(1000.02, 0.01, 0.0)) == {"FINISHED"}
    assert np.abs(center(obj)[:2] - (1000.02, 0.01)).max() < 1e-4


def bracket():
    """A body of three overlapping boxes that counts as a union."""
    mesh = bpy.data.meshes.new("Bracket")
    with editing(mesh) as work:
        for center, size in (
            ((0, 0, 0.1), (2, 1, 0.2)),
            ((0.9, 0, 0.9), (0.2, 0.8, 1.8)),
            ((1.7, 0, 1.7), (1.8, 0.6, 0.2)),
        ):
            bmesh.ops.create_cube(
                work, matrix=Matrix.Translation(center) @ Matrix.Diagonal((*size, 1.0))
            )
    obj = add(mesh, "Bracket")
    obj.body_moments.overlap = "UNION"
    return obj


@pytest.mark.parametrize("vertices", ["lean", "group"])
def test_union_of_overlapping_boxes_is_balanced(vertices):
    obj = bracket()
    before = measured(obj).mass_properties.center
    if vertices == "group":
        top = [vertex.index for vertex in obj.data.vertices if vertex.co.z > 1.5]
        obj.vertex_groups.new(name="Top").add(top, 1.0, "ADD")
    target = before + (-0.04, 0.01, 0.0)
    assert balance(target="POINT", point=target) == {"FINISHED"}
    assert np.abs(measured(obj).mass_properties.center - target)[:2].max() < 1e-5


def test_stability_is_valid_after_undo_to_measured_shape():
    obj = bracket()
    bpy.ops.object.body_moments_stability()
    bpy.ops.ed.undo_push(message="checked")
    first = stability.support(obj, bpy.context.scene)
    balance(target="POINT", point=(0.9, 0.0, 0.0))
    bpy.ops.ed.undo_push(message="balanced")
    moved = stability.support(bpy.context.object, bpy.context.scene)
    assert abs(moved.margin - first.margin) > 0.01
    bpy.ops.ed.undo()
    bpy.context.view_layer.update()
    back = stability.support(bpy.context.object, bpy.context.scene)
    assert back is not None and abs(back.margin - first.margin) < 1e-6
