# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of measurements in JSON, JSON lines and CSV. The bodies are boxes with closed forms."""

import csv
import io
import json
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.measurement import Measurement, documents, record
from body_moments.core.moments.raw import Moments, monomials
from body_moments.core.verdict import Method, Procedure, finding

from tests.close import close

HEALTH = {
    "closed": True,
    "welded": False,
    "boundary_edges": 0,
    "volume_spread": 0.0,
    "flipped_faces": [],
}
CAUSE = {"cause": {"code": "hidden_in_viewport", "values": {"name": "Box", "switch": "eye icon"}}}
UNTURNED = np.eye(3)
QUARTER_TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # about z: x to y


def box_moment(low, high, powers):
    """∫ x^p y^q z^r over a box with its sides along the axes."""
    return math.prod(
        (h ** (n + 1) - l ** (n + 1)) / (n + 1) for l, h, n in zip(low, high, powers, strict=True)
    )


def box(
    name="Box",
    low=(0, 0, 0),
    high=(1, 2, 3),
    density=1000.0,
    rotation=UNTURNED,
    location=(0, 0, 0),
):
    """A box's measurement, from closed forms about the world's origin."""
    raw = np.array([box_moment(low, high, powers) for powers in monomials(3)], float)
    moments = Moments(raw, np.zeros(3))
    a, b, c = np.subtract(high, low)
    return Measurement(
        name=name,
        type="MESH",
        kind="solid",
        method=Method(Procedure.EXACT),
        density=density,
        thickness=0.0,
        volume=moments.total,
        area=2.0 * (a * b + b * c + c * a),
        mass_properties=MassProperties.from_moments(moments, density),
        volume_moments=moments,
        area_moments=Moments(np.array([2.0 * (a * b + b * c + c * a)]), np.zeros(3), "area"),
        mass_moments=(moments, density),
        health=SimpleNamespace(as_record=lambda: dict(HEALTH)),
        findings=(
            finding("flipped_faces", np.array([4, 7]), count=2),
            finding("hidden_object_measured", **CAUSE),
        ),
        rotation=np.asarray(rotation, float),
        location=np.asarray(location, float),
        error_bound={"volume": 1e-15, "input": {"volume": 1e-7}},
        fingerprint="",
    )


def one_document(*measurements, errors=(), frame="world", **options):
    return documents.document(
        [record.record(one, frame, **options) for one in measurements],
        record.total(measurements),
        errors,
        file="part.stl",
        blender="5.2.2",
        frame=frame,
    )


def test_a_box_of_one_by_two_by_three_has_its_closed_form():
    entry = record.record(box())
    assert entry["mass"] == 6000.0 and entry["volume"] == 6.0 and entry["area"] == 22.0
    assert close(entry["center_of_mass"], [0.5, 1.0, 1.5], rel=1e-14)
    ixx, iyy, izz = 6000 / 12 * (4 + 9), 6000 / 12 * (1 + 9), 6000 / 12 * (1 + 4)
    np.testing.assert_allclose(entry["inertia"], np.diag([ixx, iyy, izz]), rtol=1e-14, atol=1e-11)
    np.testing.assert_allclose(entry["principal_moments"], [izz, iyy, ixx], rtol=1e-14)
    np.testing.assert_allclose(
        np.abs(entry["principal_axes"]), [[0, 0, 1], [0, 1, 0], [1, 0, 0]], atol=1e-15
    )
    assert entry["symmetry"] == "asymmetric"
    assert entry["health"] == HEALTH
    assert entry["error_bound"] == {"volume": 1e-15, "input": {"volume": 1e-7}}


def test_findings_are_data_with_their_messages():
    slightly = finding(
        "patch_holes_capped", slight=True, flat=np.int64(1), curved=0, share=math.nan
    )
    one = replace(box(), findings=(*box().findings, slightly))
    entry = record.record(one)
    first, _, last = entry["findings"]
    assert first == {
        "code": "flipped_faces",
        "severity": "warning",
        "message": entry["warnings"][0],
        "values": {"count": 2},
        "elements": [4, 7],
    }
    assert first["message"].startswith("2 flipped faces measured as reversed: 4, 7.")
    assert last["severity"] == "note" and last["values"] == {
        "flat": 1,
        "curved": 0,
        "share": None,
        "slight": True,
    }
    notes = [told["message"] for told in entry["findings"] if told["severity"] == "note"]
    assert entry["notes"] == notes and last["message"] in notes and len(entry["findings"]) == 3
    assert len(entry["warnings"]) + len(notes) == 3
    assert json.loads("".join(documents.to_json([one_document(one)])))["objects"][0] == entry


def test_refusal_in_a_record_is_a_warning_told_once():
    refusal = finding("shape_of_open_surface")
    entry = record.record(replace(box(), findings=(refusal,)))
    record.add_findings(entry, [refusal, finding("flat_surface")])
    assert [told["code"] for told in entry["findings"]] == ["shape_of_open_surface", "flat_surface"]
    assert (
        entry["findings"][0]["severity"] == "error"
        and len(entry["warnings"]) == 2
        and entry["notes"] == []
    )


def test_element_lists_are_limited_to_a_thousand():
    pairs = [[np.int32(face), "Cube"] for face in range(1200)]
    (told,) = record.described([finding("duplicate_faces_ignored", pairs, count=1200)])["findings"]
    assert told["elements"] == [[face, "Cube"] for face in range(1000)]
    assert "0 of “Cube”, 1 of “Cube”" in told["message"] and "1192 more" in told["message"]


def test_the_axes_are_the_columns_of_the_principal_axes():
    turn = np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    body = box()
    body = replace(body, mass_properties=body.mass_properties.in_frame(turn.T, np.zeros(3)))
    entry = record.record(body)
    axes, inertia = np.array(entry["principal_axes"]), np.array(entry["inertia"])
    for number, moment in enumerate(entry["principal_moments"]):
        np.testing.assert_allclose(
            inertia @ axes[:, number], moment * axes[:, number], rtol=1e-12, atol=1e-9
        )
    assert np.linalg.det(axes) == pytest.approx(1.0)


def test_object_frame_changes_only_directed_values():
    body = box(rotation=QUARTER_TURN, location=(10, 0, 0))
    world, own = record.record(body), record.record(body, "object")
    assert close(own["center_of_mass"], [1.0, 9.5, 1.5], rel=1e-14)  # x' = y, y' = 10 - x
    np.testing.assert_allclose(
        np.diag(own["inertia"]), np.diag(world["inertia"])[[1, 0, 2]], rtol=1e-14
    )
    for name in ("mass", "volume", "area", "density", "principal_moments", "health"):
        assert own[name] == world[name]


@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_moments_are_about_the_worlds_origin(order):
    entry = record.record(box(low=(1, 2, 3), high=(2, 4, 6)), order=order)["moments"]
    assert entry["order"] == order and entry["about"] == [0, 0, 0]
    assert set(entry) == {"order", "about", "volume", "mass", "error", "input"}
    assert set(entry["error"]) == set(entry["input"]) == {"volume", "mass"}
    assert (
        entry["error"]["volume"].keys() == entry["input"]["mass"].keys() == entry["volume"].keys()
    )
    assert list(entry["volume"]) == [",".join(map(str, powers)) for powers in monomials(order)]
    for powers in monomials(order):
        key = ",".join(map(str, powers))
        assert close(entry["volume"][key], box_moment((1, 2, 3), (2, 4, 6), powers), rel=1e-14)


def test_object_frame_moments_are_about_the_objects_origin():
    body = box(low=(1, 2, 3), high=(2, 4, 6), rotation=QUARTER_TURN, location=(10, 0, 0))
    entry = record.record(body, "object", order=3)["moments"]["volume"]
    for powers in monomials(3):
        exact = box_moment((2, 8, 3), (4, 9, 6), powers)  # x' = y, y' = 10 - x
        assert close(entry[",".join(map(str, powers))], exact, rel=1e-13)


def test_shell_volume_moments_match_its_thin_volume():
    area = Moments(np.arange(1.0, 21.0), np.zeros(3), "area")
    shell = replace(box(), kind="shell", thickness=0.5, volume_moments=None, area_moments=area)
    assert record.record(shell, order=0)["moments"]["volume"] == {"0,0,0": 0.5}


def test_the_total_weighs_each_object_by_its_own_density():
    total = record.total([box("A", (0, 0, 0), (1, 1, 1), 1.0), box("B", (2, 0, 0), (3, 1, 1), 3.0)])
    assert total["mass"] == 4.0
    assert close(total["center_of_mass"], [2.0, 0.5, 0.5], rel=1e-14)
    # Two cubes, each m/6, and arms of 1.5 and 0.5 m.
    assert close(total["inertia"][2][2], 4.0 / 6.0 + 1.0 * 1.5**2 + 3.0 * 0.5**2, rel=1e-13)


def test_the_total_of_nothing_has_no_numbers():
    total = record.total([])
    assert {key for key, value in total.items() if value is None} == {*documents.TOTAL}


def test_nonfinite_number_is_null():
    body = replace(
        box(), density=math.nan, error_bound={"volume": math.inf, "input": {"volume": -math.inf}}
    )
    text = "".join(documents.to_json([one_document(body)]))
    entry = json.loads(text, parse_constant=lambda word: pytest.fail(word))["objects"][0]
    assert entry["density"] is None and entry["error_bound"] == {
        "volume": None,
        "input": {"volume": None},
    }


def test_one_document_is_itself_and_several_are_an_array():
    first, second = one_document(box("a")), one_document(box("b"))
    assert json.loads("".join(documents.to_json([first]))) == first
    assert json.loads("".join(documents.to_json([first, second]))) == [first, second]
    lines = "".join(documents.to_json_lines([first, second])).splitlines()
    assert [json.loads(line) for line in lines] == [first, second]


def test_number_rows_on_one_line_change_no_value_or_text():
    name = 'a [\n  1,\n 2 ] "x" \\n [ 1.5, 2 ] Ünï 立方体 \udcff'
    odd = finding("object_warnings", object="[\n      1\n    ]", causes=[])
    body = replace(box(name), findings=(odd,), density=1e-300, area=1 / 3)
    document = one_document(body, order=3)
    assert json.loads("".join(documents.to_json([document]))) == document
    assert '"center_of_mass": [0.5, 1.0, 1.5]' in "".join(documents.to_json([document]))


def rows(text):
    return list(csv.DictReader(io.StringIO(text)))


def test_csv_has_one_row_an_object_under_one_header():
    both = [one_document(box("a"), box('b, "quoted"\nline')), one_document(box("c"))]
    table = rows("".join(documents.to_csv(both)))
    assert [row["name"] for row in table] == ["a", 'b, "quoted"\nline', "c"]
    row, entry = table[0], both[0]["objects"][0]
    assert row["file"] == "part.stl" and row["kind"] == "solid" and row["method"] == "exact"
    assert (
        float(row["mass"]) == entry["mass"]
        and float(row["center_of_mass_z"]) == entry["center_of_mass"][2]
    )
    assert (
        float(row["inertia_xy"]) == entry["inertia"][0][1]
        and float(row["inertia_zz"]) == entry["inertia"][2][2]
    )
    assert float(row["principal_moment_3"]) == entry["principal_moments"][2]
    assert float(row["principal_axis_1_z"]) == entry["principal_axes"][2][0]
    assert row["health_closed"] == "true" and row["health_boundary_edges"] == "0"
    assert (
        float(row["error_bound_volume"]) == 1e-15 and float(row["error_bound_input_volume"]) == 1e-7
    )
    assert row["warnings"] == " | ".join(entry["warnings"]) and row["error"] == ""
    assert row["findings"] == " | ".join(told["code"] for told in entry["findings"])
    assert row["notes"] == " | ".join(entry["notes"])
    assert all(None not in row for row in table)


def test_csv_has_a_row_with_the_reason_of_each_failure():
    errors = [
        {"name": None, "reason": "the file is empty"},
        {"name": "Plane", "reason": "it is open"},
    ]
    table = rows("".join(documents.to_csv([one_document(errors=errors)])))
    assert [(row["file"], row["name"], row["mass"], row["error"]) for row in table] == [
        ("part.stl", "", "", "the file is empty"),
        ("part.stl", "Plane", "", "it is open"),
    ]


def test_csv_has_a_column_for_each_requested_moment():
    table = rows("".join(documents.to_csv([one_document(box(), order=2)])))
    assert close(float(table[0]["volume_moment_2_0_0"]), 2.0, rel=1e-14)
    assert "volume_moment_3_0_0" not in table[0]


def test_csv_holds_every_value_of_json():
    shell = replace(box(), kind="shell", thickness=0.25)
    wire = replace(box("w"), kind="wire", length=2.0)
    document = one_document(shell, wire, order=1)
    first, second = document["objects"]
    first["signature"] = {"size": 2.0, "invariants": [0.5, -3.0]}
    table = rows("".join(documents.to_csv([document])))
    assert float(table[0]["thickness"]) == 0.25 and table[0]["principal_axes_unique"] in (
        "true",
        "false",
    )
    assert (
        float(table[0]["signature_size"]) == 2.0
        and float(table[0]["signature_invariants_2"]) == -3.0
    )
    assert (
        float(table[1]["length"]) == 2.0
        and float(table[1]["linear_density"]) == second["linear_density"]
    )
    assert float(table[1]["length_moment_1_0_0"]) == second["moments"]["length"]["1,0,0"]
