# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings are data; their codes are declared beside the code that makes them, with severity and
sentence.
"""

import ast
import json
import string
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from body_moments.core.verdict import (
    Finding,
    MeasureError,
    Method,
    Procedure,
    ReadError,
    Source,
    catalog,
    finding,
    least_trusted,
    sentence,
    truncate_findings,
    truncate_list,
    unique,
)

from tests.core.findings import declarations
from tests.package.modules import WINGS

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


def test_combined_verdict_is_the_worst_of_the_solids():
    order = ["open", "capped", "reoriented", "exact", "union", "shell", "wire", "given", "assembly"]
    assert least_trusted([]) == Procedure.OPEN
    for worse, better in zip(order, order[1:]):
        assert least_trusted([Procedure(better), Procedure(worse), Procedure(better)]) == worse
    for verdict in Procedure:
        for source in Source:
            method = Method(verdict, source)
            assert Method.parse(str(method)) == method and str(method).split() == [
                *filter(None, [source]),
                verdict,
            ]
    assert Method.parse("STL exact") is Method.parse("NURBS") is Method.parse("") is None


def test_numbers_lists_causes_and_sources_are_filled_in():
    text = sentence(finding("flipped_faces", np.arange(3, 15), count=12))
    assert "3, 4, 5, 6, 7, 8, 9, 10, and 4 more" in text
    assert sentence(finding("no_faces").of_sources(["A", "B"])).startswith("“A”, “B”: No surface.")
    cause = finding("no_faces").as_record()
    assert "No surface." in sentence(finding("hidden_object_measured", cause=cause))
    assert "12.5%" in sentence(finding("patch_holes_capped", flat=1, curved=0, share=0.125))


def test_stored_finding_names_the_same_elements():
    first = finding("flipped_faces", np.arange(3, 15), count=12)
    stored = json.loads(json.dumps(first.as_record()))
    assert stored["elements"] == list(range(3, 11)) and sentence(
        Finding.from_record(stored)
    ) == sentence(first)
    assert "3, 4, 5, 6, 7, 8, 9, 10, and 4 more" in sentence(
        finding("failure", object="Cube", cause=stored)
    )
    of_source = finding("flipped_faces", [[np.int64(3), "Cube"]], count=1)
    assert (
        "3 of “Cube”" in sentence(of_source) and "elements" not in finding("no_faces").as_record()
    )


def test_nonfinite_finding_value_is_unknown():
    assert "unknown of the area" in sentence(
        finding("patch_holes_capped", flat=1, curved=0, share=None)
    )


def test_template_has_only_placeholders_known_to_the_formatter():
    known = ("", "percent", "length", "point", "size", "word")
    for code, entry in declarations().items():
        for text in filter(None, (entry.text, entry.plural)):
            for _, name, spec, conversion in string.Formatter().parse(text):
                assert conversion in (None, "r") and (name is None or name.isidentifier()), (
                    code,
                    text,
                )
                assert spec is None or spec in known or spec[-1] in "dgfes%", (code, text, spec)


FILLED_IN_LATER = {"axes_made_principal": {"count"}, "origins_moved": {"count"}}


def test_declarations_need_no_numpy_and_stand_in_the_catalog():
    found = {
        path.parent.relative_to(ROOT).as_posix().replace("/", ".")
        for path in ROOT.glob("*/**/findings.py")
    }
    assert {place for place in found if not place.startswith("tests")} == set(catalog.PACKAGES)
    code = (
        "import importlib, importlib.util, sys\n"
        "spec = importlib.util.spec_from_file_location('body_moments', sys.argv[1] + "
        "'/__init__.py', "
        "submodule_search_locations=[sys.argv[1]])\n"
        "sys.modules['body_moments'] = module = importlib.util.module_from_spec(spec)\n"
        "spec.loader.exec_module(module)\n"
        "for package in sys.argv[2:]:\n"
        "    importlib.import_module('body_moments.' + package + '.findings')\n"
        "assert not {'numpy', 'bpy'} & set(sys.modules)\n"
    )
    subprocess.run(
        [sys.executable, "-P", "-c", code, str(ROOT), *catalog.PACKAGES], check=True, timeout=480
    )


def test_every_placeholder_of_a_sentence_is_given():
    """A creation is `finding(CODE, ...)` or an error of that code; the values stand beside it."""
    makers = {
        "finding",
        "MeasureError",
        "ReadError",
        "EditRefusedError",
        "FileError",
        "QueryError",
        "NoShapeError",
    }
    missing, known_codes = [], declarations()
    for path in [path for wing in WINGS for path in (ROOT / wing).rglob("*.py")]:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not (
                isinstance(node, ast.Call) and getattr(node.func, "id", "") in makers and node.args
            ):
                continue
            given = {
                "elements",
                "share" if "PROGRESS_" in ast.unparse(node) else "",
                *(k.arg for k in node.keywords),
            }
            if None in given or any(isinstance(n, ast.Call) for n in ast.walk(node.args[0])):
                continue
            for name in [n.id.lower() for n in ast.walk(node.args[0]) if isinstance(n, ast.Name)]:
                code = known_codes.get(name)
                given |= FILLED_IN_LATER.get(name, set())
                texts = [code.text, code.plural or ""] if code else []
                needed = {
                    name
                    for text in texts
                    for _, name, _, _ in string.Formatter().parse(text)
                    if name
                }
                missing += [(path.name, node.lineno, code, name) for name in needed - given]
    assert not missing


@pytest.mark.parametrize(
    "count, more", [(7, ""), (8, ""), (9, ", und 1 weitere"), (20, ", und 12 weitere")]
)
def test_list_is_cut_uniformly_and_its_remainder_translated(count, more):
    german = {"and {count} more": "und {count} weitere"}
    names = ["a"] * count
    shown = ", ".join(["“a”"] * min(count, 8)) + more
    assert truncate_list(names, translate=lambda text: german.get(text, text)) == shown
    assert truncate_list(names[:8], count, german.get) == shown
    missing = sentence(
        finding("missing_references", names=names), lambda text: german.get(text, text)
    )
    assert missing.startswith("The file refers to what cannot be found: " + shown)
    several = [finding("no_faces")] * count
    cut = truncate_findings(several, 8)
    assert cut[:8] == several[:8] and cut[8:] == (
        [finding("and_more", count=count - 8)] if more else []
    )
