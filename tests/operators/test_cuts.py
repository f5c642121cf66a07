# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The buttons Level, Show Level, and Cut and Fill."""

import re

import bpy
import numpy as np
import pytest
from body_moments.blender.session import memory, stored
from body_moments.core.cuts import TABLE_ROWS, cut_outline
from body_moments.core.verdict import sentence
from mathutils import Vector

from tests.blender.batch_files import document
from tests.blender.objects import add, editing, mesh_of

pytestmark = pytest.mark.usefixtures("scene")
LEVEL = bpy.ops.object.body_moments_level
CUT_FILL = bpy.ops.object.body_moments_cut_fill


def add_trough(scale=1.0):
    """An open box of 2 x 1 x 1, of one surface."""
    corners = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (2, 0), (2, 1), (0, 1))]
    sides = [(i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i) for i in range(4)]
    return add(
        mesh_of(np.array(corners) * scale, [(3, 2, 1, 0), *sides], "Trough"),
        "Trough",
        location=(0, 0, 3),
    )


def level_of(obj):
    return stored.cuts.level_of(obj, bpy.context.scene)


def refusal():
    """The sentence of the last action's refusal."""
    (group,) = memory.state.outcome.groups
    return "{}: {}".format(", ".join(group.objects), sentence(group.finding))


@pytest.mark.parametrize("scale", [1.0, 0.01])
def test_level_of_a_volume_a_mass_and_a_height(scale):
    bpy.context.scene.unit_settings.scale_length = scale
    trough = add_trough()
    for arguments in (
        {"by": "VOLUME", "volume": 0.5},
        {"by": "MASS", "mass": 400.0 * scale**3, "density": 800.0},
        {"by": "LEVEL", "level": 3.25},
    ):
        assert LEVEL(**arguments) == {"FINISHED"}
        level = level_of(trough)
        assert level.height == pytest.approx(3.25 * scale)
        assert level.volume == pytest.approx(0.5 * scale**3)
        assert level.hollow.capacity == pytest.approx(2 * scale**3)
        assert level.surface_moments == pytest.approx(
            (2 * scale**2, 2 / 12 * scale**4, 8 / 12 * scale**4), rel=1e-6
        )
        # It leans along the diagonal of its corner first: the closed form of the flat side bounds.
        assert 0 < level.tilt < np.arctan2(1.5, 1.0)
    area = np.cross(*np.diff(level.triangles, axis=1).swapaxes(0, 1)).sum(axis=0) / 2
    assert np.abs(area) == pytest.approx(np.array([0, 0, 2.0]) * scale**2)
    hollow = level.hollow
    outline = cut_outline(hollow.points, hollow.triangles, hollow.up, level.height)
    assert np.linalg.norm(np.diff(outline, axis=1), axis=2).sum() == pytest.approx(6 * scale)
    assert np.allclose(outline[..., 2], 3.25 * scale)


def test_trough_full_to_its_rim_has_a_surface():
    add_trough()
    assert LEVEL(by="LEVEL", level=4.0) == {"FINISHED"}
    assert bpy.ops.object.body_moments_show_level() == {"FINISHED"}
    surface = bpy.data.objects["Trough Level"]
    bpy.context.view_layer.update()
    assert sum(face.area for face in surface.data.polygons) == pytest.approx(2.0, rel=1e-5)
    corners = np.array([surface.matrix_world @ vertex.co for vertex in surface.data.vertices])
    assert np.allclose(corners[:, 2], 4.0, atol=1e-6)


@pytest.mark.parametrize("extra", [[(0, 1, 8)], [(0, 8, 4)], [(0, 1, 5), (0, 5, 1)]])
def test_faces_without_area_or_thrice_leave_the_level(extra):
    mesh = add_trough().data
    corners = [[*vertex.co] for vertex in mesh.vertices] + [[0.0, 0.0, 0.0]]
    faces = [[*face.vertices] for face in mesh.polygons if len(face.vertices) == 4][:1]
    faces += [(i, (i + 1) % 4, 4 + (i + 1) % 4) for i in range(4)]
    faces += [(i, 4 + (i + 1) % 4, 4 + i) for i in range(4)]
    mesh.clear_geometry()
    mesh.from_pydata(corners, [], [*faces, *extra])
    assert len(mesh.polygons) == 9 + len(extra)
    assert LEVEL(by="LEVEL", level=3.25) == {"FINISHED"}
    level = level_of(bpy.context.object)
    assert level.surface_moments == pytest.approx((2, 2 / 12, 8 / 12), rel=1e-6)
    area = np.cross(*np.diff(level.triangles, axis=1).swapaxes(0, 1)).sum(axis=0) / 2
    assert np.abs(area) == pytest.approx(np.array([0, 0, 2.0]))
    assert bpy.ops.object.body_moments_show_level() == {"FINISHED"}


def test_full_round_cavity_has_no_free_surface():
    """A cube of edge 2 with an octahedron of corners at 0.5 cut out of it."""
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.object
    with editing(cube.data) as edited:
        ends = [[edited.verts.new(0.5 * sign * np.eye(3)[i]) for sign in (1, -1)] for i in range(3)]
        for i, j, k in np.ndindex(2, 2, 2):
            corners = [ends[0][i], ends[1][j], ends[2][k]]
            edited.faces.new(corners[:: 1 if (i + j + k) % 2 else -1])
    assert LEVEL(by="LEVEL", level=0.8) == {"FINISHED"}
    level = level_of(cube)
    assert level.volume == pytest.approx(4 / 3 * 0.5**3)
    assert level.surface_moments == (0.0, 0.0, 0.0) and level.triangles.shape == (0, 3, 3)
    with pytest.raises(RuntimeError, match="full to its top"):
        bpy.ops.object.body_moments_show_level()
    assert LEVEL(by="LEVEL", level=0.0) == {"FINISHED"}
    assert level_of(cube).surface_moments == pytest.approx((0.5, 1 / 48, 1 / 48))
    contents = document("--below", "0.8")["objects"][0]["below"]["contents"]
    assert contents["surface"] is None and contents["volume"] == pytest.approx(1 / 6)


def test_show_level_adds_meshes_and_nothing_else_moves():
    parent = add(None, "Parent", (4, 5, 0))
    trough = add_trough()
    trough.parent = parent
    bpy.context.view_layer.update()
    LEVEL(by="VOLUME", volume=0.5)
    before = trough.matrix_world.copy()
    assert bpy.ops.object.body_moments_show_level() == {"FINISHED"}
    surface = bpy.data.objects["Trough Level"]
    bpy.context.view_layer.update()
    corners = np.array([surface.matrix_world @ vertex.co for vertex in surface.data.vertices])
    assert np.allclose(np.unique(corners[:, 2]), 3.25)
    assert sum(face.area for face in surface.data.polygons) == pytest.approx(2.0)
    assert bpy.ops.object.body_moments_show_level(what="TABLE") == {"FINISHED"}
    table = bpy.data.objects["Trough Level Table"]
    assert table.location == trough.matrix_world.translation == Vector((4, 5, 3))
    assert len(table.data.edges) == TABLE_ROWS - 1
    assert trough.matrix_world == before


def test_changed_vessel_forgets_its_level():
    trough = add_trough()
    trough.body_moments.overlap = "UNION"
    LEVEL(by="VOLUME", volume=0.5)
    assert level_of(trough)
    trough.body_moments.overlap = "SIGNED"
    assert level_of(trough) is None
    LEVEL(by="VOLUME", volume=0.5)
    trough.location.z += 1
    bpy.context.view_layer.update()
    assert level_of(trough) is None
    with pytest.raises(RuntimeError, match="has changed"):
        bpy.ops.object.body_moments_show_level()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"by": "VOLUME", "volume": 5.0}, "Trough: It holds at most 2 m³, up to 4 m"),
        ({"by": "LEVEL", "level": 2.0}, "below the bottom"),
        ({"by": "LEVEL", "level": 4.5}, "at most"),
    ],
)
def test_liquid_that_does_not_fit_is_refused(arguments, message):
    trough = add_trough()
    assert LEVEL(**arguments) == {"CANCELLED"}
    assert re.search(message, refusal())
    assert trough not in memory.levels


@pytest.mark.parametrize("data", ["EMPTY", "PLANE"])
@pytest.mark.parametrize(
    ("rotation", "scale"),
    [((0, 0, 0), (0, 1, 1)), ((np.pi / 2, 0, 0), (1, 1, 1)), ((0.3, np.pi / 2, 0), (1, 1, 0))],
)
def test_plane_upright_or_of_no_scale_is_refused(data, rotation, scale):
    add(
        mesh_of([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)], "Plane")
        if data == "PLANE"
        else None,
        "Other",
        (0, 0, 1),
        rotation,
        scale,
    )
    slope = add_slope()
    assert CUT_FILL(against="OBJECT", other="Other") == {"CANCELLED"}
    assert "Slope: No cut and fill: " in refusal()
    assert slope not in memory.cut_fills
    assert data == "PLANE" or "its plane stands upright" in refusal()


def test_empty_of_any_scale_is_its_plane():
    add(None, "Empty", (7, 7, 1), scale=(1e-9, 1e6, 0))
    slope = add_slope()
    assert CUT_FILL(against="OBJECT", other="Empty") == {"FINISHED"}
    found = memory.cut_fills[slope].cut_fill
    assert (found.cut.total, found.fill.total) == pytest.approx((0.25, 0.25))


def add_slope():
    """A slope of z = 2 x over the unit square."""
    return add(
        mesh_of([(0, 0, 0), (1, 0, 2), (1, 1, 2), (0, 1, 0)], [(0, 1, 2, 3)], "Slope"), "Slope"
    )


def add_mug():
    """A cup of 1 x 1 x 1 with walls of 0.1, and a box for a handle through one of them."""
    outer = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    inner = [(0.1 + 0.8 * x, 0.1 + 0.8 * y, z or 0.1) for x, y, z in outer]
    sides = [(i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i) for i in range(4)]
    faces = [(3, 2, 1, 0), *sides, (8, 9, 10, 11)]
    faces += [tuple(8 + i for i in side[::-1]) for side in sides]
    faces += [(4 + i, 4 + (i + 1) % 4, 12 + (i + 1) % 4, 12 + i) for i in range(4)]
    handle = [(0.4 + 0.2 * x, 0.95 + 0.5 * y, 0.4 + 0.2 * z) for x, y, z in outer]
    faces += [tuple(16 + i for i in face) for face in [(3, 2, 1, 0), (4, 5, 6, 7), *sides]]
    return add(mesh_of([*outer, *inner, *handle], faces, "Mug"), "Mug")


def test_mug_with_a_handle_holds_liquid_as_a_union():
    mug = add_mug()
    assert LEVEL(by="LEVEL", level=0.5) == {"CANCELLED"}
    assert "Mug: No level: its components overlap. Set Overlaps to Count as Union" in refusal()
    mug.body_moments.overlap = "UNION"
    assert LEVEL(by="LEVEL", level=0.5) == {"FINISHED"}
    level = level_of(mug)
    assert level.volume == pytest.approx(0.64 * 0.4, rel=1e-6)
    assert level.hollow.capacity == pytest.approx(0.64 * 0.9, rel=1e-6)
    contents = document("--below", "0.5")["objects"][0]["below"]["contents"]
    assert contents["volume"] == pytest.approx(0.64 * 0.4, rel=1e-6)


@pytest.mark.parametrize("wall", ["INWARD", "OUTWARD"])
def test_vessel_with_real_walls_holds_liquid_within_them(wall):
    trough = add_trough()
    settings = trough.body_moments
    settings.kind, settings.wall, settings.thickness = "SHELL", wall, 0.1
    wide = 0.0 if wall == "OUTWARD" else 0.1
    area, bottom = (2 - 2 * wide) * (1 - 2 * wide), 3 + wide
    assert LEVEL(by="LEVEL", level=3.5) == {"FINISHED"}
    level = level_of(trough)
    assert level.volume == pytest.approx(area * (3.5 - bottom), rel=1e-6)
    assert level.hollow.spill == pytest.approx(4.0)
    below = document("--below", "3.5")["objects"][0]["below"]
    outer = (2.2 - 2 * wide) * (1.2 - 2 * wide)
    assert below["contents"]["volume"] == pytest.approx(level.volume, rel=1e-6)
    assert below["face"]["area"] == pytest.approx(outer - area, rel=1e-6)
    volume = outer * (3.6 - bottom) - area * (3.5 - bottom)
    assert below["volume"] == pytest.approx(volume, rel=1e-6)


def test_cut_and_fill_of_a_slope():
    slope = add_slope()
    assert CUT_FILL(against="HEIGHT", height=1.0) == {"FINISHED"}
    found = memory.cut_fills[slope].cut_fill
    assert (found.cut.total, found.fill.total) == pytest.approx((0.25, 0.25))
    assert CUT_FILL(against="RIM") == {"FINISHED"}
    assert memory.cut_fills[slope].cut_fill.net == pytest.approx(0.0, abs=1e-12)
    assert CUT_FILL(against="OBJECT", other="Nothing") == {"CANCELLED"}
    assert "“Nothing”" in refusal()
    bpy.ops.mesh.primitive_cube_add()
    assert CUT_FILL(against="HEIGHT") == {"CANCELLED"}
    assert "Cube: No cut and fill: the surface is closed" in refusal()
