# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that writers make: meshes of robots, glTF, JSON, thumbnails, pages, and stored sections
that are damaged.
"""

import json
from math import inf, nan

import bpy
import pytest
from body_moments.blender.write import properties
from body_moments.core.files import replace_gltf_document, to_glb
from body_moments.core.measurement import documents, to_html
from body_moments.core.robots.write import audit_report
from body_moments.core.verdict import finding

from tests.blender import batch_files
from tests.blender.boxes import box_mesh
from tests.blender.flat_objects import I_BEAM, flat_mesh
from tests.blender.objects import add, only


@pytest.mark.parametrize("value", [nan, inf])
def test_numbers_beyond_json_are_refused(value):
    entry = {"mass": value}
    for write in (documents.to_json, documents.to_json_lines, audit_report.to_json):
        with pytest.raises(ValueError):
            list(write([entry]))
    with pytest.raises(ValueError):
        replace_gltf_document(to_glb("{}"), entry)
    (stored,) = json.loads(properties.findings_text([finding("t_junctions", count=value)]))
    assert stored["values"] == {"count": None}


def test_page_row_has_picture_or_inertia_box(scene):
    """No other text can stand there."""
    add(box_mesh(1, 2, 4), "Box")
    document = batch_files.document("--thumbnails")
    entry = document["objects"][0]

    def shown(**changed):
        page = "".join(to_html([{**document, "objects": [{**entry, **changed}]}]))
        return page.count("<img"), page.count("<svg")

    assert shown() == (1, 0)
    for wrong in (None, 5, "", "javascript:x", entry["thumbnail"] + '"', "x" + entry["thumbnail"]):
        assert shown(thumbnail=wrong) == (0, 1)
    for name in ("mass", "principal_moments", "principal_axes"):
        assert shown(thumbnail=None, **{name: None}) == (0, 0)
    assert (
        shown(thumbnail=None, mass=0.0)
        == shown(thumbnail=None, principal_moments=[1.0, None, 2.0])
        == (0, 0)
    )
    assert shown(thumbnail=None, principal_moments=[0.0, 0.0, 0.0]) == (0, 1)


def test_a_section_that_somebody_else_has_stored_is_none(scene):
    from body_moments.blender.write import section

    beam = add(flat_mesh(I_BEAM), "Beam")
    only(beam)
    bpy.ops.object.body_moments_measure_section()
    kept = beam[section.KEY].to_dict()
    assert section.stored(beam) is not None
    for name, length in section.LENGTHS.items():
        for wrong in (
            [0.0] * (length + 1),
            [0.0] * (length - 1) if length > 1 else ["x"],
            "x" * length,
            5.0,
        ):
            beam[section.KEY] = {**kept, name: wrong}
            assert section.stored(beam) is None, (name, wrong)
        beam[section.KEY] = {one: value for one, value in kept.items() if one != name}
        assert section.stored(beam) is None
    for name in section.TEXTS:
        beam[section.KEY] = {one: value for one, value in kept.items() if one != name}
        assert (section.stored(beam) is not None) == (name == "findings")
    beam[section.KEY] = kept
    assert section.stored(beam).fingerprint == kept["fingerprint"]
    for wrong in (5, "text", [1.0, 2.0]):
        beam[section.KEY] = wrong
        assert section.stored(beam) is None
    assert section.clear(beam) and not section.clear(beam) and section.stored(beam) is None
