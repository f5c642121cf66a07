# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The buttons beside warnings: each does its remedy in one step, and nothing else; accepted
findings are notes.
"""

import bpy
import pytest
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.session.tracking import staleness

from tests.blender.objects import add, editing, measure, mesh_of, only
from tests.close import close
from tests.operators.overlapping_boxes import boxes
from tests.panels.drawing import findings_of, labels, shown

pytestmark = pytest.mark.usefixtures("scene")


def buttons(record=None):
    return [entry[1] for entry in record or shown() if entry[0] == "operator"]


def offered():
    """The remedies of the lines that the panel shows."""
    return [
        entry[2].remedy
        for entry in shown()
        if entry[:2] == ("operator", "object.body_moments_remedy")
    ]


def orders(mesh):
    return [tuple(face.vertices) for face in mesh.polygons]


def test_recalculate_outside_turns_faces_and_keeps_cavity():
    """Flipped faces of an outer box, all of a second box beside it, and a cavity that is right as
    it is.
    """
    import bmesh

    mesh = boxes(2.0, 1.0, 4.0, reverse=[0, *range(6, 12)])
    for vertex in mesh.vertices[16:]:
        vertex.co.x += 10.0
    right = orders(mesh)
    mesh.flip_normals()
    right_of_third = orders(mesh)[12:]
    mesh.flip_normals()
    with editing(mesh) as inside_out:
        bmesh.ops.reverse_faces(inside_out, faces=inside_out.faces[12:])
    obj = add(mesh, location=(1.0, 2.0, 3.0), scale=(1.0, -2.0, 1.0))
    bpy.ops.object.body_moments_measure()
    volume = obj["body_volume"]
    assert close(volume, 2.0 * (8.0 - 1.0 + 64.0), rel=1e-12)
    assert findings_of(obj, "warning") == ["flipped_faces", "inverted_components"]
    assert {*offered()} == {"OUTSIDE"}
    assert bpy.ops.object.body_moments_remedy(remedy="OUTSIDE") == {"FINISHED"}
    assert findings_of(obj, "warning") == [] and close(obj["body_volume"], volume, rel=1e-12)
    assert {frozenset(face) for face in orders(mesh)[6:12]} == {
        frozenset(face) for face in right[6:12]
    }
    assert [set(face) for face in orders(mesh)[12:]] == [set(face) for face in right_of_third]
    assert obj["body_method"] == "exact"
    before = orders(mesh)
    assert bpy.ops.object.body_moments_remedy(remedy="OUTSIDE") == {"CANCELLED"}
    assert orders(mesh) == before


def test_union_and_shell_remedies_set_and_measure():
    obj = add(boxes(2.0, 1.0))
    bpy.ops.object.body_moments_measure()
    assert findings_of(obj, "warning") == ["components_nested"] and close(
        obj["body_volume"], 9.0, rel=1e-12
    )
    assert {*offered()} == {"UNION"}
    assert bpy.ops.object.body_moments_remedy(remedy="UNION") == {"FINISHED"}
    assert close(obj["body_volume"], 8.0, rel=1e-6) and obj.body_moments.overlap == "UNION"
    assert bpy.ops.object.body_moments_remedy(remedy="SHELL", thickness=0.25) == {"FINISHED"}
    assert obj["body_method"] == "shell" and close(obj["body_volume"], 0.25 * 30.0, rel=1e-6)


def test_accepted_warning_stays_a_note_after_measuring():
    from body_moments.core.measurement import record

    obj, other = add(boxes(2.0, 1.0)), add(boxes(2.0, 1.0), "Other")
    measure(obj, other)
    bpy.context.view_layer.objects.active = obj
    assert obj["body_warnings"]
    assert bpy.ops.object.body_moments_accept(code="components_nested") == {"FINISHED"}
    assert not obj["body_warnings"] and not other["body_warnings"]
    only(obj)
    assert findings_of(obj, "warning") == [] and "components_nested" in findings_of(obj, "note")
    assert staleness.stale_reason(obj, bpy.context.scene) is None
    assert "Accepted: 1 outward component lies" in " ".join(labels(shown()))
    bpy.ops.object.body_moments_measure()
    assert findings_of(obj, "warning") == []
    measurement = measure_object(obj, bpy.context.evaluated_depsgraph_get())
    entry = record.described(measurement.findings)
    assert entry["warnings"] == [] and [found["severity"] for found in entry["findings"]] == [
        "note"
    ]
    assert bpy.ops.object.body_moments_accept(code="components_nested", accepted=False) == {
        "FINISHED"
    }
    assert findings_of(obj, "warning") == ["components_nested"] and obj["body_warnings"]
    assert bpy.ops.object.body_moments_accept(code="components_nested", accepted=False) == {
        "CANCELLED"
    }
    assert bpy.ops.object.body_moments_accept() == {"FINISHED"} and not obj["body_warnings"]
    assert not other["body_warnings"]  # what is not selected keeps what was accepted


@pytest.mark.parametrize(
    ("fault", "code", "remedy"),
    [
        ("hole", "holes_capped", "FILL_HOLES"),
        ("copy", "duplicate_faces_ignored", "DUPLICATES"),
        ("split", "vertices_welded", "MERGE"),
        ("patch", "vertices_welded", "MERGE"),
    ],
)
def test_edits_repair_the_mesh_and_measure_again(fault, code, remedy):
    box = boxes(2.0)
    points, faces = [list(vertex.co) for vertex in box.vertices], orders(box)
    if fault == "hole":
        faces = faces[1:]
    elif fault == "copy":
        faces.append(faces[0])
    elif fault == "patch":  # copies of three faces, on vertices of their own
        points += points[:]
        faces += [[8 + corner for corner in face] for face in faces[:3]]
    else:  # one face has corners of its own, a little aside
        points += [[x + 1e-6, y, z] for x, y, z in (points[corner] for corner in faces[0])]
        faces[0] = (8, 9, 10, 11)
    mesh = mesh_of(points, faces, "Faulty")
    obj = add(mesh)
    bpy.ops.object.body_moments_measure()
    assert close(obj["body_volume"], 8.0, rel=1e-5)
    if code in findings_of(obj, "warning"):
        assert remedy in offered()
    assert code in findings_of(obj)
    assert bpy.ops.object.body_moments_remedy(remedy=remedy) == {"FINISHED"}
    assert code not in findings_of(obj) and obj["body_method"] == "exact"
    assert (
        close(obj["body_volume"], 8.0, rel=1e-6)
        and len(mesh.polygons) == 6
        and len(mesh.vertices) == 8
    )
    assert bpy.ops.object.body_moments_remedy(remedy=remedy) == {"CANCELLED"}


def test_the_unit_is_asked_for_once_a_scene_and_set_at_a_click():
    scene = bpy.context.scene
    obj = add(boxes(60.0), location=(20.0, 0.0, 0.0))
    obj.body_moments.density = 1240.0
    ask = "scene.body_moments_set_millimeters"
    assert ask not in buttons()
    bpy.ops.object.body_moments_measure()
    assert ask in buttons() and "60 m long and 268\u2009000 t" in " ".join(labels(shown()))
    assert bpy.ops.scene.body_moments_set_millimeters() == {"FINISHED"}
    assert scene.unit_settings.length_unit == "MILLIMETERS" and close(
        scene.unit_settings.scale_length, 1e-3, rel=1e-6
    )
    assert close(obj["body_mass"], 0.26784, rel=1e-6) and ask not in buttons()
    assert "20 mm" in labels(shown())
    scene.unit_settings.scale_length = 1.0
    bpy.ops.object.body_moments_measure()
    assert ask not in buttons()
