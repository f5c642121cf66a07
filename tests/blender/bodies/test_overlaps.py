# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects whose common space counts twice: copies left in place, and bodies that overlap."""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies import measure_object, overlaps, stack
from body_moments.blender.bodies.assembly.measure import measure_assembly
from body_moments.blender.session.robots import collection_links, object_links

from tests.blender.batch_files import codes, document
from tests.blender.boxes import box, collection, empty

pytestmark = pytest.mark.usefixtures("registered", "scene")


def here():
    return bpy.context.scene.collection


def notes(*objects):
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found = overlaps.overlap_caveats(objects, depsgraph)
    outcomes = dict(
        pair for batch in measure_object.measure_many(objects, depsgraph) for pair in batch
    )
    measured = {obj: one for obj, one in outcomes.items() if isinstance(one, stack.Measured)}
    assert overlaps.overlap_caveats(objects, depsgraph, measured) == found
    return found


def copy_of(obj, name):
    copy = obj.copy()
    copy.name = name
    obj.users_collection[0].objects.link(copy)
    return copy


@pytest.mark.parametrize("turn", [(0, 0, 0), (0.3, 0.4, 0.5)])
@pytest.mark.parametrize("place", [(0, 0, 0), (1000, 2000, -50)])
@pytest.mark.parametrize(
    ("size", "offset", "shares"),
    [
        ((0.1, 0.1, 2), (0, 0, 0), True),  # crosses it, no vertex within the other
        ((0.1, 0.1, 2), (0.5, 0, 1.04), True),  # an end stands in it
        ((0.1, 0.05, 0.05), (0, 0, 0), True),  # within it
        ((0.1, 0.1, 2), (0, 0, 1.05), False),  # stands on it
        ((0.1, 0.1, 2), (0, 0.1, 0), False),  # leans on it
        ((0.1, 0.1, 2), (3, 0, 0), False),
    ],
)
def test_overlap_of_a_beam_and_a_post(turn, place, size, offset, shares):
    root = empty(here(), "Root", place)
    root.rotation_euler = turn
    beam, post = box(here(), (2, 0.1, 0.1), name="Beam"), box(here(), size, offset, name="Post")
    beam.parent = post.parent = root
    found = notes(post, beam)
    assert [(one.values["first"], one.values["second"]) for one in found] == (
        [("Beam", "Post")] if shares else []
    )


def test_overlaps_of_cavities_sheets_and_given_masses_do_not_count():
    shell = box(here(), (4, 4, 4), name="Shell")
    core = box(here(), (1, 1, 1), name="Core")
    assert len(notes(shell, core)) == 1
    inner = np.array([corner.co[:] for corner in shell.data.vertices]) / 2.0
    faces = [[8 + i for i in reversed(face.vertices)] for face in shell.data.polygons]
    points = [[*corner.co] for corner in shell.data.vertices] + inner.tolist()
    faces = [[*face.vertices] for face in shell.data.polygons] + faces
    hollow = bpy.data.meshes.new("Hollow")
    hollow.from_pydata(points, [], faces)
    full, shell.data = shell.data, hollow
    assert notes(shell, core) == []
    shell.data = full
    shell.body_moments.kind = "SHELL"
    assert notes(shell, core) == []
    shell.body_moments.kind = "SOLID"
    core.body_moments.mass_from = "MASS"
    assert notes(shell, core) == []


def test_nurbs_torus_and_box_overlap():
    bpy.ops.surface.primitive_nurbs_surface_torus_add()
    torus = bpy.context.object
    (found,) = notes(torus, box(here(), (1, 1, 1), (1, 0, 0), name="Box"))
    assert found.values["pairs"] == [["Box", torus.name]]


def test_many_overlaps_are_counted_and_one_is_named():
    boxes = [box(here(), (1.1, 1, 1), (i, 0, 0), name="Box {:02d}".format(i)) for i in range(30)]
    (found,) = notes(*boxes)
    assert found.values["count"] == 29 and len(found.values["pairs"]) == 29
    assert (found.values["first"], found.values["second"]) == ("Box 00", "Box 01")


def test_copies_and_overlaps_are_told_of_totals_and_assemblies():
    root = collection("Frame")
    beam = box(root, (2, 0.1, 0.1), name="Beam")
    box(root, (0.1, 0.1, 2), name="Post")
    expected = ["total_copies_in_place", "bodies_overlap"]
    copy_of(beam, "Again")
    depsgraph = bpy.context.evaluated_depsgraph_get()
    assert [one.code for one in overlaps.shared_space_caveats(root.objects, depsgraph)] == expected
    found = measure_assembly(root, depsgraph).measurement.findings
    assert [one.code for one in found if one.code in expected] == expected
    assert {*expected} <= {*codes(document("--density", "1000")["total"])}


def test_robots_tell_of_copies_and_overlaps():
    root = collection("Frame")
    beam = box(root, (2, 0.1, 0.1), name="Beam")
    post = box(root, (0.1, 0.1, 2), name="Post")
    again = copy_of(beam, "Again")
    bpy.context.view_layer.update()
    expected = ["total_copies_in_place", "bodies_overlap"]
    for made in (
        object_links(bpy.context, "r", [beam, post, again]),
        collection_links(bpy.context, "r", root, [beam, post, again]),
    ):
        assert [one.code for one in made.findings if one.code in expected] == expected


def test_copied_instance_of_a_collection_is_a_copy():
    part = collection("Part")
    box(part, (1, 1, 1), name="Body")
    here().children.unlink(part)
    root = collection("Frame")
    for name in ("First", "Second"):
        instancer = empty(root, name)
        instancer.instance_type = "COLLECTION"
        instancer.instance_collection = part
    bpy.context.view_layer.update()
    found = measure_assembly(root, bpy.context.evaluated_depsgraph_get()).measurement.findings
    (copies,) = [one for one in found if one.code == "total_copies_in_place"]
    assert copies.values["objects"] == ["Second"]
