# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh read by arrays is the mesh that Blender tessellates, triangle by triangle."""

import bmesh
import bpy
import numpy as np
import pytest
from body_moments.blender.read.mesh import vertex_values
from body_moments.blender.read.objects import read_object

from tests.blender.findings import refused, said
from tests.blender.read_bodies import (
    CUBE,
    CUBE_FACES,
    activate,
    bmesh_triangles,
    cube,
    depsgraph,
    drag_a_corner,
    link,
    loop_triangles,
    mesh,
    surface_triangles,
)

pytestmark = pytest.mark.usefixtures("bare_scene")
RNG = np.random.default_rng(7)


def prism(sides, wobble=0.0):
    angle = np.arange(sides) * 2.0 * np.pi / sides
    ring = (
        np.stack([np.cos(angle), np.sin(angle)], 1) * (1.0 + 0.6 * (np.arange(sides) % 2))[:, None]
    )
    points = np.concatenate([np.c_[ring, np.zeros(sides)], np.c_[ring, np.ones(sides)]])
    points += RNG.uniform(-wobble, wobble, points.shape)
    i = np.arange(sides)
    sides_ = np.stack([i, (i + 1) % sides, (i + 1) % sides + sides, i + sides], 1).tolist()
    return points, [i[::-1].tolist(), (i + sides).tolist(), *sides_]


def mixed():
    points, faces = prism(7, 0.2)
    points = np.concatenate([points, RNG.uniform(-1, 1, (9, 3)) + [5, 0, 0]])
    loose = [[14, 15, 16], [16, 17, 18, 19], [19, 20, 21], [22, 21, 20, 14, 15]]
    return points, loose[:2] + faces + loose[2:]


def soup(count):
    """Quads of every kind: non-planar, concave, folded, degenerate, far from the origin, on a
    coarse lattice."""
    wild = RNG.uniform(-1, 1, (count, 4, 3))
    flat = np.concatenate([RNG.uniform(-1, 1, (count, 4, 2)), np.zeros((count, 4, 1))], axis=2)
    far = wild + [1.0e4, -3.0e3, 50.0]
    lattice = RNG.integers(-1, 2, (count, 4, 3)).astype(float)
    thin = wild * [1.0, 1.0e-6, 1.0e-3]
    points = np.concatenate([wild, flat, far, lattice, thin]).reshape(-1, 3)
    return points, np.arange(len(points)).reshape(-1, 4)


BODIES = {
    "triangles": (
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
        [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)],
    ),
    "quads": (CUBE, CUBE_FACES),
    "one big n-gon and quads": prism(40),
    "n-gons that are not planar": prism(9, 0.3),
    "few n-gons": prism(400),
    "triangles, quads and n-gons in any order": mixed(),
    "triangles and quads": (
        [*CUBE, (3, 0, 0)],
        [*CUBE_FACES[:3], (4, 6, 8), *CUBE_FACES[3:], (6, 7, 8)],
    ),
    "quads of all shapes": soup(2000),
    "one triangle and a pentagon, four corners on average": (
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (2, 0, 0), (3, 0, 0), (3, 1, 0), (2.5, 2, 0), (2, 1, 0)],
        [(0, 1, 2), (3, 4, 5, 6, 7)],
    ),
}


@pytest.mark.parametrize("points, faces", BODIES.values(), ids=BODIES.keys())
def test_a_surface_has_the_triangles_that_blender_draws(points, faces):
    obj = link("Body", mesh("Body", points, faces))
    surface = read_object(obj, depsgraph()).parts[0].surface
    drawn = loop_triangles(obj.data)
    assert len(drawn) > 0
    assert surface_triangles(surface) == drawn
    assert surface_triangles(surface) == bmesh_triangles(obj)


@pytest.mark.parametrize(("domain", "kind"), [("FACE", "FLOAT"), ("POINT", "INT")])
def test_face_or_integer_attribute_is_refused(domain, kind):
    data = mesh("Quads", CUBE, CUBE_FACES)
    data.attributes.new("per_vertex", "FLOAT", "POINT").data.foreach_set("value", range(8))
    data.attributes.new("other", kind, domain)
    assert vertex_values(data, "per_vertex").tolist() == [*range(8)]
    with refused("attribute_missing", attribute="other"):
        vertex_values(data, "other")


def test_a_modified_mesh_is_read_as_evaluated():
    obj = link("Body", mesh("Body", *mixed()))
    obj.modifiers.new("Subdivision", "SUBSURF").levels = 2
    obj.modifiers.new("Triangulate", "TRIANGULATE").min_vertices = 4
    plain = link("Subdivided", mesh("Body", *mixed()))
    plain.modifiers.new("Subdivision", "SUBSURF").levels = 2
    for each in (obj, plain):
        assert surface_triangles(
            read_object(each, depsgraph()).parts[0].surface
        ) == bmesh_triangles(each)


def test_edit_mode_reads_edits_that_nothing_has_told_blender_of():
    obj = cube()
    obj.use_shape_key_edit_mode = True  # of keys that it has not
    activate(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    depsgraph()
    blocks = set(bpy.data.meshes)
    bm = bmesh.from_edit_mesh(obj.data)
    bm.verts.ensure_lookup_table()
    bm.verts[0].co = (-7.0, -1.0, -1.0)
    bmesh.ops.triangulate(bm, faces=list(bm.faces)[:1])
    reading = read_object(obj, depsgraph())
    surface = reading.parts[0].surface
    assert surface.points[0].tolist() == [-7.0, -1.0, -1.0]
    assert (len(surface.triangles), len(surface.quads)) == (2, 5)
    assert said(reading) == {"read_in_mode": {"mode": "Edit Mode"}}
    assert set(bpy.data.meshes) == blocks
    assert obj.mode == "EDIT"
    assert bm.is_valid
    assert obj.data.vertices[0].co[:] == (-1.0, -1.0, -1.0)


def test_edit_mode_reads_the_modifiers_that_act_there():
    obj = cube()
    obj.modifiers.new("Array", "ARRAY").count = 3
    idle = obj.modifiers.new("Idle", "SUBSURF")
    idle.show_in_editmode = False
    for name, in_edit_mode in (("Off", True), ("Never", False)):
        hidden = obj.modifiers.new(name, "SUBSURF")
        hidden.show_viewport, hidden.show_in_editmode = False, in_edit_mode
    drag_a_corner(obj)
    reading = read_object(obj, depsgraph())
    (part,) = reading.parts
    assert len(part.surface.quads) == 18
    assert part.surface.points.min() == -7.0
    findings = said(reading)
    assert findings["read_in_mode"] == {"mode": "Edit Mode"}
    assert findings["modifiers_left_out"] == {"modifiers": ["Idle"]}


def test_other_user_of_edited_mesh_has_the_edits():
    obj = cube()
    other = link("Other", obj.data)
    drag_a_corner(obj)
    surface = read_object(other, depsgraph()).parts[0].surface
    assert surface.points[0].tolist() == [-7.0, -1.0, -1.0]
