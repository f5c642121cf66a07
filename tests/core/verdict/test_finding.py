# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings are data, and their one table of sentences covers every code that the source makes."""

import ast
import functools
import json
import string
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from body_moments.core.shape.library import Similarity
from body_moments.core.verdict.finding import (
    Finding,
    MeasureError,
    ReadError,
    Severity,
    finding,
    system_reason,
    truncate_findings,
    unique,
)
from body_moments.core.verdict.health import DefectiveElements, MeshHealth
from body_moments.core.verdict.method import Method, Source, Verdict, least_trusted
from body_moments.core.verdict.sentences import MESSAGES, of_severity, sentence, severity, truncate_list

ROOT = Path(__file__).resolve().parent.parent.parent.parent


def test_refusal_names_its_subject_and_the_remedy():
    error = ReadError("non_finite_vertices", count=2, total=8).about("Cube").about("Other")
    assert isinstance(error, MeasureError) and not isinstance(error, ValueError)
    assert str(error).startswith("Cube: 2 of 8 vertices have") and error.reason == str(error)[6:]
    assert repr(ReadError(error.finding)) == repr(error) == "ReadError('non_finite_vertices')"


def test_values_come_back_from_json_and_equal_findings_are_one():
    first = finding("holes_capped", count=2, flat=1, curved=1, share=0.125)
    again = Finding.from_record(json.loads(json.dumps(first.as_record())))
    assert again == first and str(again) == str(first)
    other = finding("holes_capped", count=3, flat=1, curved=1, share=0.125)
    assert unique([first, other, again]) == (first, other)
    assert first != finding("holes_closed", **first.values) and first != first.as_record()
    assert Finding("no_faces") == finding("no_faces")


def test_why_the_system_refused_is_a_part_of_a_sentence():
    assert system_reason(OSError(13, "Permission denied.")) == "Permission denied"
    assert system_reason(OSError("No such device.")) == "No such device"


def test_mesh_without_findings_is_sound():
    counts = "boundary_edges non_manifold_edges inconsistent_edges inverted_components nested_components cavities"
    counts += " overlapping_components duplicate_faces degenerate_faces non_planar_faces"
    record = MeshHealth(True).as_record()
    assert record == {
        **{"closed": True, "welded": False, "components": 1, **dict.fromkeys(counts.split(), 0)},
        **{"volume_spread": 0.0, "cap_area_share": 0.0, "self_intersection": "not_checked", "flipped_faces": []},
    }
    turned = MeshHealth(False, defective_elements=DefectiveElements(flipped_faces=np.array([2, 5])))
    assert turned.as_record() == {**record, "closed": False, "flipped_faces": [2, 5]}
    for entry in fields(DefectiveElements):
        assert getattr(DefectiveElements(), entry.name).shape == ((0, 2) if "edges" in entry.name else (0,))


def test_combined_verdict_is_the_worst_of_the_solids():
    order = ["open", "capped", "reoriented", "exact", "union", "shell", "wire", "given", "assembly"]
    assert [str(verdict) for verdict in Verdict] == order and least_trusted([]) == Verdict.OPEN
    for worse, better in zip(order, order[1:]):
        assert least_trusted([Verdict(better), Verdict(worse), Verdict(better)]) == worse
    assert [verdict for verdict in Verdict if verdict.is_closed] == ["capped", "reoriented", "exact", "union"]
    for verdict in Verdict:
        for source in Source:
            method = Method(verdict, source)
            assert Method.parse(str(method)) == method and str(method).split() == [*filter(None, [source]), verdict]
    assert Method.parse("STL exact") is Method.parse("NURBS") is Method.parse("") is None


def test_numbers_lists_causes_and_sources_are_filled_in():
    text = sentence(finding("flipped_faces", np.arange(3, 15), count=12))
    assert "3, 4, 5, 6, 7, 8, 9, 10, and 4 more" in text
    assert sentence(finding("no_faces").of_sources(["A", "B"])).startswith("“A”, “B”: No faces.")
    cause = finding("no_faces").as_record()
    assert "No faces." in sentence(finding("hidden_object_measured", cause=cause))
    assert "12.5%" in sentence(finding("holes_capped_slightly", count=1, share=0.125))


def test_stored_finding_names_the_same_elements():
    first = finding("flipped_faces", np.arange(3, 15), count=12)
    stored = json.loads(json.dumps(first.as_record()))
    assert stored["elements"] == list(range(3, 11)) and sentence(Finding.from_record(stored)) == sentence(first)
    assert "3, 4, 5, 6, 7, 8, 9, 10, and 4 more" in sentence(finding("failure", object="Cube", cause=stored))
    of_source = finding("flipped_faces", [[np.int64(3), "Cube"]], count=1)
    assert "3 of “Cube”" in sentence(of_source) and "elements" not in finding("no_faces").as_record()


def test_nonfinite_finding_value_is_unknown():
    assert "unknown of the area" in sentence(finding("holes_capped_slightly", count=1, share=None))


def test_severity_belongs_to_the_code():
    assert severity(finding("no_faces")) == Severity.ERROR
    both = [finding("holes_capped_slightly", count=1, share=1e-5), finding("flat_surface")]
    assert of_severity(both, Severity.WARNING) == [both[1]]


def test_template_has_only_placeholders_known_to_the_formatter():
    known = ("", "percent", "length", "point", "size", "word")
    for code, entry in MESSAGES.items():
        for text in filter(None, (entry.text, entry.plural)):
            for _, name, spec, conversion in string.Formatter().parse(text):
                assert conversion in (None, "r") and (name is None or name.isidentifier()), (code, text)
                assert spec is None or spec in known or spec[-1] in "dgfes%", (code, text, spec)


@functools.cache
def calls_that_make() -> list[tuple[str, ast.Call]]:
    """Yield the places of the source that create findings and refusals."""
    makers = {"finding", "Finding", "MeasureError", "ReadError", "EditRefusedError", "FileError", "QueryError"}
    makers |= {"SurfaceRefusedError", "NoShapeError", "_damaged"}
    return [
        ("{}:{}".format(path.relative_to(ROOT), node.lineno), node)
        for part in ("core", "operators", "panels")
        for path in (ROOT / part).rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and maker_of(node) in makers and node.args
    ]


def maker_of(call: ast.Call) -> str:
    return getattr(call.func, "id", getattr(call.func, "attr", ""))


def codes_of(call: ast.Call) -> list[str]:
    """The strings of its first argument."""
    constants = (node for node in ast.walk(call.args[0]) if isinstance(node, ast.Constant))
    return [constant.value for constant in constants if isinstance(constant.value, str)]


def test_every_created_code_has_a_message():
    assert not {code: place for place, call in calls_that_make() for code in codes_of(call) if code not in MESSAGES}


FILLED_IN_LATER = {"axes_made_principal": {"count"}, "origins_moved": {"count"}}


def test_every_placeholder_of_a_message_is_given():
    missing = []
    for place, call in calls_that_make():
        given = {"elements", *(keyword.arg for keyword in call.keywords)}
        if maker_of(call) == "SurfaceRefusedError":  # these are known where the surfaces of a file are listed
            given |= {"count", "kind", "names"}
        holds_another = any(isinstance(node, ast.Call) for node in ast.walk(call.args[0]))
        if holds_another or maker_of(call) == "Finding" or None in given:
            continue
        for code in codes_of(call):
            message, known = MESSAGES[code], given | FILLED_IN_LATER.get(code, set())
            if code.startswith("progress_"):
                known |= {"share"}
            texts = [message.text, message.plural or ""]
            needed = {name for text in texts for _, name, _, _ in string.Formatter().parse(text) if name}
            missing += [(place, code, name) for name in needed - known]
    assert not missing


def test_every_countable_shape_and_defect_has_a_message():
    kinds = {"shapes_" + similarity for similarity in Similarity} - {"shapes_different"}
    assert kinds | {"defect_" + field.name for field in fields(DefectiveElements)} <= MESSAGES.keys()


@pytest.mark.parametrize("count, more", [(7, ""), (8, ""), (9, ", und 1 weitere"), (20, ", und 12 weitere")])
def test_list_is_cut_uniformly_and_its_remainder_translated(count, more):
    german = {"and {count} more": "und {count} weitere"}
    names = ["a"] * count
    shown = ", ".join(["“a”"] * min(count, 8)) + more
    assert truncate_list(names, translate=lambda text: german.get(text, text)) == shown
    assert truncate_list(names[:8], count, german.get) == shown
    missing = sentence(finding("missing_links", names=names), lambda text: german.get(text, text))
    assert missing.startswith("Linked data is missing: " + shown)
    several = [finding("no_faces")] * count
    cut = truncate_findings(several, 8)
    assert cut[:8] == several[:8] and cut[8:] == ([finding("and_more", count=count - 8)] if more else [])
