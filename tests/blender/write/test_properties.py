# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is stored on an object besides its numbers, and what is read back of damaged properties."""

import json

import bpy
import pytest
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.write import properties
from body_moments.core.verdict import EditRefusedError, finding

from tests.blender import batch_files as files

pytestmark = pytest.mark.usefixtures("scene")


def measured(obj):
    return measure_object(obj, bpy.context.evaluated_depsgraph_get())


def test_the_tensor_is_stored_in_one_and_in_two_rows():
    box = files.add_box()
    properties.store(box, measured(box))
    assert [*box["body_inertia_diagonal"], *box["body_inertia_products"]] == [*box["body_inertia"]]
    assert properties.clear(box) and not [key for key in properties.DESCRIPTIONS if key in box]


@pytest.mark.parametrize(
    "text",
    [
        *("", "nonsense", "null", "3", "{}", "[1]", '{"code": "no_faces"}', "[" * 100_000),
        *(
            '[{"code": "no_faces"}]',
            '[{"code": "no_faces", "values": 1}]',
            '[{"code": 1, "values": {}}]',
        ),
        *(
            '[{"code": "of_another_version", "values": {}}]',
            '[{"code": "holes_capped", "values": {}}]',
        ),
        '[{"code": "no_faces", "values": {"sources": 3}}]',
        '[{"code": "no_faces", "values": {}, "elements": 3}]',
        '[{"code": "hidden_object_measured", "values": '
        '{"cause": {"code": "hidden_object_measured", "values": {}}}}]',
    ],
    ids=lambda text: text[:40],
)
def test_a_damaged_text_gives_no_findings(text):
    box = files.add_box()
    box["body_findings"] = text
    assert properties.findings(box) == ()


def test_a_finding_of_another_version_does_not_hide_the_others():
    box = files.add_box()
    records = [{"code": "of_another_version", "values": {}}, finding("flat_surface").as_record()]
    box["body_findings"] = json.dumps(records)
    assert properties.findings(box) == (finding("flat_surface"),)


def test_a_library_override_is_refused_and_left_as_it_is(tmp_path):
    library = files.box_file(tmp_path / "library.blend")
    files.empty_scene()
    with bpy.data.libraries.load(library, link=True) as (_, wanted):
        wanted.objects = [files.BOX_NAME]
    linked = wanted.objects[0]
    bpy.context.scene.collection.objects.link(linked)
    bpy.context.view_layer.update()
    numbers = measured(linked)
    for obj in (linked, linked.override_create()):
        with pytest.raises(EditRefusedError) as refused:
            properties.store(obj, numbers)
        assert refused.value.finding.code == "linked_object" and "body_mass" not in obj
