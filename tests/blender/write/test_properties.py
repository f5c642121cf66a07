# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is stored on an object besides its numbers, and what is read back of damaged properties."""

import json
from dataclasses import replace

import pytest

pytest.importorskip("bpy")
import bpy
import numpy as np
from body_moments.core.verdict.finding import EditRefusedError, finding
from body_moments.operators.bodies.measure_object import measure_object
from body_moments.operators.write import properties

from tests.blender import batch_files as files

pytestmark = pytest.mark.usefixtures("scene")

FINDINGS = (
    finding("flipped_faces", np.arange(20), count=np.int64(20)),
    finding("holes_capped_slightly", count=1, share=float("inf")),
    finding("hidden_object_measured", cause=finding("hidden_in_viewport").as_record()),
)


def measured(obj):
    return measure_object(obj, bpy.context.evaluated_depsgraph_get())


def test_the_tensor_is_stored_in_one_and_in_two_rows():
    box = files.add_box()
    properties.store(box, measured(box))
    assert [*box["body_inertia_diagonal"], *box["body_inertia_products"]] == [*box["body_inertia"]]
    assert properties.clear(box) and not [key for key in properties.DESCRIPTIONS if key in box]


def test_findings_are_stored_as_data_and_warnings_as_lines():
    box = files.add_box()
    properties.store(box, replace(measured(box), findings=FINDINGS))
    found = properties.findings(box)
    assert [one.code for one in found] == [one.code for one in FINDINGS]
    assert str(found[0]) == str(FINDINGS[0]) and found[1].values == {"count": 1, "share": None}
    assert found[2] == FINDINGS[2]
    assert box["body_warnings"].splitlines() == [str(FINDINGS[0]), str(FINDINGS[2])]
    assert properties.method_text(box) == "exact"


@pytest.mark.parametrize(
    "text",
    [
        *("", "nonsense", "null", "3", "{}", "[1]", '{"code": "no_faces"}', "[" * 100_000),
        *('[{"code": "no_faces"}]', '[{"code": "no_faces", "values": 1}]', '[{"code": 1, "values": {}}]'),
        *('[{"code": "of_another_version", "values": {}}]', '[{"code": "holes_capped", "values": {}}]'),
        '[{"code": "no_faces", "values": {"sources": 3}}]',
        '[{"code": "no_faces", "values": {}, "elements": 3}]',
        '[{"code": "hidden_object_measured", "values": {"cause": {"code": "hidden_object_measured", "values": {}}}}]',
    ],
    ids=lambda text: text[:40],
)
def test_a_damaged_text_gives_no_findings(text):
    box = files.add_box()
    box["body_findings"] = text
    assert properties.findings(box) == ()


def test_what_is_no_text_gives_no_findings_either():
    box = files.add_box()
    for value in (3, [1.0, 2.0], {"code": "no_faces"}):
        box["body_findings"] = value
        assert properties.findings(box) == ()
    del box["body_findings"]
    assert properties.findings(box) == () and properties.method_text(box) == ""


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
    for obj, code in ((linked, "linked_results"), (linked.override_create(), "override_results")):
        with pytest.raises(EditRefusedError) as refused:
            properties.store(obj, numbers)
        assert refused.value.finding.code == code and "body_mass" not in obj


@pytest.mark.parametrize("source", ["OBJECT", "POLYNOMIAL"])
def test_where_a_density_that_varies_comes_from_is_stored(source):
    box = files.add_box()
    if source == "POLYNOMIAL":
        box.body_moments.density_from, box.body_moments.density_polynomial = source, "1000 + z"
    found = measured(box)
    properties.store(box, found)
    assert box.get("body_density_from") == (None if source == "OBJECT" else str(found.density_from))
