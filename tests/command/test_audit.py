# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`audit` on the command line: reports, repaired copies, exit codes."""

import csv
import gzip
import io
import itertools
import json
import zipfile
from pathlib import Path

import fastjsonschema
import numpy as np
import pytest
from body_moments.command import audit
from body_moments.core.robots.write import audit_report
from body_moments.operators import batch

SARIF_SCHEMA = Path(__file__).with_name("sarif-2.1.0.json.gz")
BOX = (
    '<link name="{}"><inertial><mass value="{}"/><inertia ixx="{}" iyy="{}" izz="{}" ixy="0" '
    'ixz="0" iyz="0"/>'
    '</inertial><collision><geometry><box size="2 2 2"/></geometry></collision></link>'
)
RIGHT = BOX.format("right", 8000, *["5333.3333"] * 3)
WRONG = BOX.format("=cmd|x&lt;b&gt;", 8000, *["5333333.3"] * 3)


def description(path, *links):
    path.write_text('<robot name="r">{}</robot>'.format("".join(links)), encoding="utf-8")
    return path


def answer(*words):
    (text,), code = audit.answer(audit.parse(["audit", *map(str, words)]))
    return text, code


def test_a_report_lists_links_with_findings_and_the_repair(tmp_path):
    path = description(tmp_path / "r.urdf", RIGHT, WRONG)
    text, code = answer(path)
    found = json.loads(text)
    assert (found["schema"], found["status"], code) == (audit_report.SCHEMA, "findings", 1)
    right, wrong = found["links"]
    assert right["findings"] == [] and right["repaired"] is None
    codes = [entry["code"] for entry in wrong["findings"]]
    assert codes == ["audit_unit"] and [one["code"] for one in wrong["findings"][0]["reasons"]] == [
        "inertial_spread_outside"
    ]
    assert abs(wrong["repaired"]["inertia"][0][0] / 5333.3333 - 1.0) < 1e-6
    assert answer(description(tmp_path / "s.urdf", RIGHT))[1] == 0


def test_several_files_are_a_list_with_unreadable_ones(tmp_path):
    good, bad = description(tmp_path / "a.urdf", RIGHT), tmp_path / "b.urdf"
    bad.write_text("<robot", encoding="utf-8")
    text, code = answer(good, bad)
    first, second = json.loads(text)
    assert (first["status"], second["status"], code) == ("ok", "error", 1)
    assert second["errors"][0]["code"] == "description_invalid" and second["links"] == []


def test_tables_and_pages_carry_nothing_out_of_the_file_as_code(tmp_path):
    path = description(tmp_path / "r.urdf", RIGHT, WRONG)
    rows = list(csv.DictReader(io.StringIO(answer("--format", "csv", path)[0])))
    assert [row["code"] for row in rows] == ["ok", "audit_unit"]
    assert rows[1]["link"] == "'=cmd|x<b>"
    page = answer("--format", "html", path)[0]
    assert (
        "&lt;b&gt;" in page and "<b>" not in page and "<script" not in page and "audit_unit" in page
    )


def test_a_repaired_copy_is_written_elsewhere_and_is_right(tmp_path):
    (tmp_path / "out").mkdir()
    path = description(tmp_path / "r.urdf", RIGHT, WRONG)
    text = answer("--repair", tmp_path / "out", path)[0]
    assert json.loads(text)["repaired"] == str(tmp_path / "out" / "r.urdf")
    again = json.loads(answer(tmp_path / "out" / "r.urdf")[0])
    assert again["status"] == "ok" and RIGHT in (tmp_path / "out" / "r.urdf").read_text(
        encoding="utf-8"
    )


def test_no_file_of_a_user_is_replaced_without_being_asked_to(tmp_path, capfd):
    """Reports and repaired copies alike; an older report is."""
    (tmp_path / "out").mkdir()
    path, notes, copy = (
        description(tmp_path / "r.urdf", WRONG),
        tmp_path / "notes.txt",
        tmp_path / "out" / "r.urdf",
    )
    notes.write_text("mine", encoding="utf-8")
    for target in (notes, path, tmp_path, tmp_path / "none" / "a.json"):
        assert batch.main(["audit", str(path), "--output", str(target)], channel=1) == 2
        error = capfd.readouterr().err
        assert "--output" in error and error.startswith("usage: body_moments audit")
    assert batch.main(["audit", str(path), "--output", str(path), "--force"], channel=1) == 2
    assert notes.read_text(encoding="utf-8") == "mine" and WRONG in path.read_text(encoding="utf-8")
    report = tmp_path / "report"
    for form in (*audit_report.FORMATS, "json"):
        assert (
            batch.main(["audit", str(path), "--output", str(report), "--format", form], channel=1)
            == 1
        )
    assert json.loads(report.read_text(encoding="utf-8"))["schema"] == audit_report.SCHEMA
    assert batch.main(["audit", str(path), "--output", str(notes), "--force"], channel=1) == 1
    assert "mine" not in notes.read_text(encoding="utf-8")
    copy.write_text("mine", encoding="utf-8")
    found = json.loads(answer("--repair", tmp_path / "out", path)[0])
    assert (
        found["errors"][0]["code"] == "file_not_written"
        and copy.read_text(encoding="utf-8") == "mine"
    )
    for words in (["--force"], []):  # and the same once more is no loss
        assert not json.loads(answer("--repair", tmp_path / "out", *words, path)[0])["errors"]
    assert "mine" not in copy.read_text(encoding="utf-8")


def test_sarif_obeys_its_schema_and_names_the_places(tmp_path):
    """The published schema, as the package of jest matchers for SARIF (MIT) carries it."""
    validate = fastjsonschema.compile(
        json.loads(gzip.decompress(SARIF_SCHEMA.read_bytes())), use_default=False
    )
    good, bad = (
        description(tmp_path / "a b.urdf", "\n  " + RIGHT, "\n   " + WRONG),
        tmp_path / "b.urdf",
    )
    bad.write_text("<robot>\n<link", encoding="utf-8")
    log = json.loads(answer("--format", "sarif", good, bad)[0])
    validate(log)
    wrong, broken = log["runs"][0]["results"]
    place = wrong["locations"][0]["physicalLocation"]
    assert place["region"] == {
        "startLine": 3,
        "startColumn": 4 + len('<link name="=cmd|x&lt;b&gt;">'),
    }
    assert place["artifactLocation"]["uri"].endswith("/a%20b.urdf")
    assert (wrong["ruleId"], wrong["level"], wrong["properties"]["certainty"]) == (
        "audit_unit",
        "error",
        "certain",
    )
    assert broken["locations"][0]["physicalLocation"]["region"]["startLine"] == 2


def test_report_says_that_no_file_was_read(tmp_path):
    """One is missing, one an archive of MuJoCo, whose signature is that of packed USD, too."""
    archive = tmp_path / "x.mjz"
    with zipfile.ZipFile(archive, "w") as packed:
        packed.writestr("model.xml", "<mujoco/>")
    words = tmp_path / "none.urdf", archive
    found = json.loads(answer(*words)[0])
    assert [one["errors"][0]["code"] for one in found] == ["file_missing", "file_unreadable"]
    assert "MJZ" in found[1]["errors"][0]["message"] and answer(*words)[1] == 1
    for form in ("text", "table", "html"):
        text, code = answer("--format", form, *words)
        assert audit_report.NONE_READ in text and "0 links" not in text and code == 1
    log = json.loads(answer("--format", "sarif", *words)[0])
    assert log["runs"][0]["invocations"] == [{"executionSuccessful": False}]
    good = description(tmp_path / "r.urdf", RIGHT)
    assert audit_report.NONE_READ not in answer("--format", "text", good, archive)[0]
    assert json.loads(answer("--format", "sarif", good)[0])["runs"][0]["invocations"] == [
        {"executionSuccessful": True}
    ]


def test_folder_of_other_files_is_wrong_usage(tmp_path, capfd):
    (tmp_path / "a.xml").write_text("<other/>", encoding="utf-8")
    assert batch.main(["audit", str(tmp_path)], channel=1) == 2
    assert "no robot description" in capfd.readouterr().err


def test_github_annotations_escape_what_ends_them(tmp_path):
    odd = description(tmp_path / "a,b:c%.urdf", BOX.format("x&#10;y", 8000, *["5333333.3"] * 3))
    head, line, rest = answer("--format", "github", odd)[0].split("\n")
    assert head.startswith("::debug::") and line.startswith("::error file=") and not rest
    assert "a%2Cb%3Ac%25.urdf,line=1,col=" in line and "title=audit_unit (x y)::" in line.replace(
        "%0A", " "
    )


def test_text_and_table_state_the_assumption_once(tmp_path):
    outside = WRONG.replace("<mass", '<origin xyz="9 0 0"/><mass')
    paths = [description(tmp_path / name, outside) for name in ("a.urdf", "b.urdf")]
    for form in ("text", "table", "html"):
        text = answer("--format", form, *paths)[0]
        assert text.count(audit_report.RESTS_ON) == 1 and "Repaired" not in text
    rows = answer("--format", "table", *paths)[0].splitlines()
    assert rows[2].split()[:5] == ["2", "0", "0", "1", "1"] and rows[4].split()[:5] == [
        "4",
        "0",
        "0",
        "2",
        "2",
    ]


def test_no_baseline_knows_an_unexpected_total(tmp_path):
    path, baseline = description(tmp_path / "r.urdf", RIGHT), tmp_path / "known.json"
    assert answer("--expect-mass", "99", "--write-baseline", baseline, path)[1] == 1
    known = json.loads(baseline.read_text(encoding="utf-8"))
    assert known["findings"] == []
    known["findings"] = [{"file": "r.urdf", "link": "", "code": "audit_total"}]
    baseline.write_text(json.dumps(known), encoding="utf-8")
    assert answer("--expect-mass", "12", "--baseline", baseline, path)[1] == 1


def test_gate_counts_new_findings_of_its_level_alone(tmp_path):
    path, baseline = description(tmp_path / "r.urdf", RIGHT, WRONG), tmp_path / "known.json"
    assert [answer("--fail-on", level, path)[1] for level in ("error", "warning", "never")] == [
        1,
        1,
        0,
    ]
    assert answer("--ignore", "audit_unit", path)[1] == 0
    assert [answer("--light-links", mass, path)[1] for mass in (7999, 8000)] == [1, 0]
    assert answer("--write-baseline", baseline, path)[1] == 1
    found = json.loads(answer("--baseline", baseline, path)[0])
    assert found["status"] == "ok" and found["links"][1]["findings"][0]["known"]
    description(path, RIGHT, WRONG, WRONG.replace("=cmd", "new"))
    text, code = answer("--baseline", baseline, path)
    assert code == 1 and [
        "known" in one["findings"][0] for one in json.loads(text)["links"][1:]
    ] == [True, False]


def test_folders_are_audited_several_files_at_a_time(tmp_path):
    (tmp_path / "below").mkdir()
    paths = [description(tmp_path / name, RIGHT) for name in ("a.urdf", "b.urdf", "below/c.urdf")]
    (tmp_path / "package.xml").write_text("<package/>", encoding="utf-8")
    text, code = answer("--jobs", "2", tmp_path)
    assert [one["file"] for one in json.loads(text)] == list(map(str, paths)) and code == 0


def test_folder_holds_meshes_and_settings_of_other_programs(tmp_path):
    """A named folder may be read; XML with a doctype is no robot unless it is named itself."""
    inner = tmp_path / "share" / "robots" / "one" / "urdf"
    inner.mkdir(parents=True)
    link = RIGHT.replace('<box size="2 2 2"/>', '<mesh filename="../../../meshes/a.obj"/>')
    path = description(inner / "r.urdf", link)
    (tmp_path / "share" / "meshes").mkdir()
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    rows = ["v {} {} {}\n".format(*one) for one in corners] + [
        "f {} {} {} {}\n".format(*one) for one in faces
    ]
    (tmp_path / "share" / "meshes" / "a.obj").write_text("".join(rows), encoding="utf-8")
    other = tmp_path / "share" / "other.xml"
    other.write_text('<!DOCTYPE robot PUBLIC "x" "y"><robot name="r"/>', encoding="utf-8")
    assert json.loads(answer(path)[0])["links"][0]["findings"][0]["code"] == "mesh_outside"
    text, code = answer(tmp_path / "share")
    assert (
        code == 0
        and json.loads(text)["file"] == str(path)
        and not json.loads(text)["links"][0]["findings"]
    )
    assert json.loads(answer(other)[0])["errors"][0]["code"] == "xml_entities"


def test_all_faults_of_a_link_are_told_at_once(tmp_path):
    """A tensor that breaks the triangle inequality does not hide a center outside."""
    link = BOX.format("a", 8000, 1, 1, 9).replace("<mass", '<origin xyz="9 0 0"/><mass')
    (found,) = json.loads(answer(description(tmp_path / "r.urdf", link))[0])["links"]
    assert [one["code"] for one in found["findings"]] == [
        "inertial_triangle",
        "inertial_center_outside",
    ]
    assert all(
        one["certainty"] == "guess" and one["geometry"]["mass"] == 8000 for one in found["findings"]
    )


JOINT = (
    '<joint name="{}" type="revolute"><origin xyz="3 0 0"/><parent link="{}"/><child link="{}"/>'
    '<axis xyz="0 0 1"/></joint>'
)
PAIR = [BOX.format(name, 8000, *["5333.3333"] * 3) for name in "ab"]
FRAME = '<link name="tool"/>'
BARE = '<link name="c"><visual><geometry><sphere radius="1"/></geometry></visual></link>'


def test_totals_of_the_robot_are_in_every_form(tmp_path):
    path = description(
        tmp_path / "r.urdf",
        *(*PAIR, FRAME, BARE, JOINT.format("j", "a", "b")),
        *(JOINT.format("t", "b", "tool"), JOINT.format("k", "b", "c")),
    )
    record = json.loads(answer(path)[0])
    total = record["total"]
    assert (total["mass"], total["center_of_mass"]) == (16000.0, [1.5, 0.0, 0.0])
    assert abs(total["inertia"][1][1] / (2 * 5333.3333 + 16000.0 * 1.5**2) - 1.0) < 1e-12
    assert (total["missing"], total["frames"]) == (["c"], ["tool"])
    assert [link["subtree"]["mass"] for link in record["links"]] == [16000.0, 8000.0, 0.0, 0.0]
    for form in ("text", "table", "html", "sarif"):
        text = answer("--format", form, path)[0]
        assert "16000" in text and "8000" in text and "1.5" in text, form
    turned = json.loads(answer("--joint", "j=1.5707963267948966", path)[0])
    assert turned["total"]["center_of_mass"] == [1.5, 0.0, 0.0]
    again = json.loads(answer("--joint", "j=0.5", "--expect-mass", "16000", path)[0])
    assert again["findings"] == []


@pytest.mark.parametrize(
    "words, code",
    [
        (("--expect-mass", "16000"), 0),
        (("--expect-mass", "16.1t", "--expect-center", "1.5,0,0"), 0),
        (("--expect-mass", "16.1t", "--within", "0.5%"), 1),
        (("--expect-center", "1.4,0,0"), 1),
        (("--joint", "none=1"), 1),
    ],
)
def test_expectation_decides_the_exit_code(words, code, tmp_path):
    path = description(tmp_path / "r.urdf", *PAIR, JOINT.format("j", "a", "b"))
    text, found = answer(*words, path)
    record = json.loads(text)
    assert found == code and len(record["findings"]) == code
    assert answer("--ignore", "audit_total", "--ignore", "audit_joint", *words, path)[1] == 0


SDF_CHAIN = """<sdf version="1.11"><model name="m">{}{}</model></sdf>"""
SDF_LINK = """<link name="{}"><pose>{} 0 0 0 0 0</pose><inertial><pose>1 0 0 0 0 0</pose>
<mass>1</mass></inertial></link>"""
SDF_JOINT = """<joint name="{}" type="revolute"><parent>{}</parent><child>{}</child><axis>
<xyz>0 0 1</xyz>{}</axis></joint>"""


@pytest.mark.parametrize("form", ["urdf", "sdf"])
@pytest.mark.parametrize("words", [(), ("--joint", "j=0")])
def test_followers_stand_at_their_offset(words, form, tmp_path):
    path = tmp_path / ("r." + form)
    if form == "urdf":
        mimic = '<mimic joint="j" offset="1.5707963267948966"/></joint>'
        follower = JOINT.format("f", "b", "c").replace("</joint>", mimic)
        link = PAIR[1].replace('name="b"', 'name="c"')
        description(path, *PAIR, link, JOINT.format("j", "a", "b"), follower)
    else:
        mimic = """<mimic joint="j"><multiplier>-2</multiplier><offset>0.5707963267948966</offset>
        <reference>0.5</reference></mimic>"""
        links = "".join(map(SDF_LINK.format, "abc", range(3)))
        joints = SDF_JOINT.format("j", "a", "b", "") + SDF_JOINT.format("f", "b", "c", mimic)
        path.write_text(SDF_CHAIN.format(links, joints), encoding="utf-8")
    found = json.loads(answer(*words, path)[0])["total"]["center_of_mass"]
    plain = json.loads(answer("--joint", "f=1.5707963267948966", path)[0])
    assert found == plain["total"]["center_of_mass"]


@pytest.mark.parametrize(
    "words",
    [
        *[("--expect-mass", "3 m"), ("--within", "1"), ("--expect-center", "1,2")],
        *[("--joint", "j=x"), ("--joint", "j=1", "--joint", "j=2")],
        *[("--repair", "."), ("--repair", "none"), ("--format", "xml"), ("--ignore", "none")],
        *[("--baseline", "r.urdf"), ("--baseline", "none"), ("--jobs", "0")],
    ],
)
def test_option_without_a_usable_value_is_wrong_usage(words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    description(tmp_path / "r.urdf", *PAIR)
    with pytest.raises(SystemExit) as ended:
        answer(*words, "r.urdf")
    assert ended.value.code == 2


@pytest.mark.parametrize(
    "joints",
    [
        [("j", "a", "b"), ("k", "b", "a")],
        [("j", "a", "b"), ("k", "a", "b")],
        [("j", "", "b")],
        [("j", "a", "nowhere")],
    ],
)
def test_joint_outside_of_the_tree_is_one_finding(joints, tmp_path):
    path = description(tmp_path / "r.urdf", *PAIR, "\n", *(JOINT.format(*one) for one in joints))
    text, code = answer(path)
    record = json.loads(text)
    (found,) = record["findings"]
    assert (found["code"], found["line"], code) == ("audit_joint", 2, 1)
    assert record["total"]["mass"] == 16000.0


@pytest.mark.parametrize("leader", ["none", "k"])
def test_mimic_of_no_other_joint_is_named(leader, tmp_path):
    joint = JOINT.format("k", "a", "b").replace("</joint>", '<mimic joint="{}"/></joint>')
    path = description(tmp_path / "r.urdf", *PAIR, "\n", joint.format(leader))
    (found,) = json.loads(answer(path)[0])["findings"]
    assert (found["code"], found["line"]) == ("joint_value_unusable", 2)
    assert (found["values"]["joint"], found["values"]["value"]) == ("k", leader)


AUTO = """<sdf version="1.11"><model name="m"><link name="b"><inertial auto="true">{}</inertial>
<collision name="c">{}<geometry><box><size>1 2 3</size></box></geometry></collision>
<collision name="d"><pose>2 0 0 0 0 0</pose><geometry><box><size>1 2 3</size></box></geometry>
</collision></link></model></sdf>"""


@pytest.mark.parametrize(
    "inertial, collision, masses",
    [
        ("", "", (6000.0, 6000.0)),
        ("", "<density>500</density>", (3000.0, 6000.0)),
        ("<density>200</density>", "<density>500</density>", (3000.0, 1200.0)),
        ("<mass>9</mass>", "<density>500</density>", (3.0, 6.0)),
    ],
)
def test_automatic_inertial_comes_from_collisions(inertial, collision, masses, tmp_path):
    path = tmp_path / "auto.sdf"
    path.write_text(AUTO.format(inertial, collision), encoding="utf-8")
    (link,) = json.loads(answer(path)[0])["links"]
    first, second = masses
    mass, arm = first + second, 2.0 * second / (first + second)
    across = mass * 10.0 / 12.0 + first * arm**2 + second * (2.0 - arm) ** 2
    assert link["from_shapes"] and abs(link["mass"] / mass - 1.0) < 1e-12
    assert abs(link["center_of_mass"][0] - arm) < 1e-12
    assert abs(link["inertia"][1][1] / across - 1.0) < 1e-12


@pytest.mark.parametrize("density, code", [(5, "audit_density"), (50000, "inertial_too_dense")])
def test_odd_density_of_shapes_is_found(density, code, tmp_path):
    path = tmp_path / "auto.sdf"
    path.write_text(AUTO.format("<density>{}</density>".format(density), ""), encoding="utf-8")
    record = json.loads(answer(path)[0])["links"][0]
    assert [one["code"] for one in record["findings"]] == [code]
    assert abs(record["density"] / density - 1.0) < 1e-12


OFF = (
    '<link name="{}"><inertial><origin xyz="{}"/><mass value="{}"/><inertia ixx="{}" iyy="{}" '
    'izz="{}" ixy="0" ixz="0" iyz="0"/></inertial><visual><geometry><box size="2 1 0.5"/>'
    "</geometry></visual></link>"
)


def test_guess_keeps_a_possible_center(tmp_path):
    path = description(tmp_path / "r.urdf", OFF.format("a", "0.3 0.1 0", 500, 1, 1, 9))
    (link,) = json.loads(answer(path)[0])["links"]
    assert link["findings"][0]["certainty"] == "guess"
    assert link["repaired"]["center_of_mass"] == [0.3, 0.1, 0.0]
    assert abs(link["repaired"]["inertia"][0][0] / (500 * 1.25 / 12.0) - 1.0) < 1e-12
    at_border = description(tmp_path / "s.urdf", OFF.format("a", "0.999 0 0", 500, 1, 1, 9))
    (link,) = json.loads(answer(at_border)[0])["links"]
    assert link["repaired"]["center_of_mass"] == [0.999, 0.0, 0.0]


def test_repaired_copy_has_no_new_finding(tmp_path):
    (tmp_path / "out").mkdir()
    centers = ("0 0 0", "0.3 0.1 0", "0.999 0 0", "3 0 0")
    moments = ((1, 1, 9), (0.5, 2, 2.4), (1e3, 4e3, 5e3), (0, 0, 0), (-1, 2, 2), (1e-9, 1e-9, 1e-9))
    cases = itertools.product(centers, (1e-6, 5, 5e3, 5e6), moments)
    links = [
        OFF.format(
            "abcdefghijklmnopqrstuvwxyz"[index % 26] * (1 + index // 26), center, mass, *tensor
        )
        for index, (center, mass, tensor) in enumerate(cases)
    ]
    path = description(tmp_path / "r.urdf", *links)
    before = json.loads(answer("--repair", tmp_path / "out", path)[0])["links"]
    after = json.loads(answer(tmp_path / "out" / "r.urdf")[0])["links"]
    assert sum(link["repaired"] is not None for link in before) > 20
    for old, new in zip(before, after, strict=True):
        codes = [
            {found["code"] for one in link["findings"] for found in (one, *one["reasons"])}
            for link in (old, new)
        ]
        assert codes[1] <= codes[0], old["name"]


@pytest.mark.parametrize("mass, is_odd", [(29_000, False), (32_000, True)])
def test_uneven_filling_needs_a_usual_density(mass, is_odd, tmp_path):
    spread = np.array([0.9, 0.2, 0.05]) * mass  # wider than an even filling, and in the hull
    moments = spread.sum() - spread
    path = description(tmp_path / "r.urdf", OFF.format("a", "0 0 0", mass, *moments))
    codes = [one["code"] for one in json.loads(answer(path)[0])["links"][0]["findings"]]
    assert ("audit_density" in codes) == is_odd and "audit_not_uniform" in codes
