# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Summaries, comparisons and the report page; and the options that the panel has too."""

import functools
import html
import json
import math
import random
import re
import shutil
import subprocess
from pathlib import Path

import bpy
import numpy as np
import pytest
from body_moments.command.parser import COMMANDS
from body_moments.command.supervisor import listing
from body_moments.core.measurement import documents, to_html

from tests.blender import batch_files as files
from tests.blender.batch_files import document, measured
from tests.blender.flat_objects import sheet
from tests.blender.grids import vdb_grid, volume_object
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")
HOSTILE = "<script>document.title='run'</script>\"'&\u202e"


def result(path, *found):
    path.write_text("".join(documents.to_json_lines(found)), encoding="utf-8")
    return path


def failed(name, status="crashed"):
    return documents.failed_document(
        name, "It <b>failed</b>.", status, blender="5.2.2", frame="world"
    )


def test_a_list_in_another_folder_has_absolute_names(main, tmp_path, monkeypatch):
    for folder in ("in", "lists"):
        (tmp_path / folder).mkdir()
    (tmp_path / "in" / "a.stl").write_bytes(b"solid")
    monkeypatch.chdir(tmp_path)
    name = str(Path("in", "a.stl"))
    for words, wanted in (
        ([], name),
        (["--output", "list"], name),
        (["--output", "lists/list"], str(tmp_path / name)),
    ):
        code, out, _ = main("manifest", "in", *words)
        text = Path(words[1]).read_text(encoding="utf-8") if words else out
        assert code == 0 and [json.loads(line)["path"] for line in text.splitlines()[1:]] == [
            wanted
        ]


def test_summary_counts_files_by_status(main, tmp_path):
    files.add_box("Box")
    path = result(tmp_path / "a.jsonl", document(), failed("b.stl"), failed("c.stl", "timeout"))
    code, out, _ = main("summary", path)
    assert code == 0
    assert "3 files: 1 ok, 1 crashed, 1 timeout" in out and "1 object: 1 exact" in out
    assert "density_defaulted" in out and "crashed  b.stl: It <b>failed</b>." in out
    code, out, _ = main("to-csv", path)
    assert code == 0 and len(out.splitlines()) == 4
    (tmp_path / "b").write_text("{}")
    assert main("summary", tmp_path / "b")[0] == 2 and main("merge", tmp_path / "none")[0] == 2
    assert main("merge", path, "--output", tmp_path / "b")[0] == 1
    assert main("merge", path, "--output", tmp_path / "b", "--force")[0] == 0


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A document with every kind of entry, as text."""
    files.empty_scene()
    box = files.add_box("Box")
    box.rotation_euler = (0.3, 0.2, 0.1)
    sheet([(0, 0), (3, 0), (2, 2), (0, 1)], "Sheet")
    found = document(
        "--flat", "--order", "3", "--pose", "--signature", "--surface-moments", "--about", "1,2,3"
    )
    found["assemblies"] = [{**found["objects"][0], "name": "All"}]
    found["bones"] = [{**found["objects"][0], "name": "Arm", "armature": "Rig"}]
    return json.dumps(found)


def places_of(value, path=()):
    """The paths of all values in a document."""
    if path:
        yield path
    for key, part in (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    ):
        yield from places_of(part, (*path, key))


def nested(depth):
    value = []
    for _ in range(depth):
        value = [value]
    return value


WRONG_VALUES = (
    None,
    True,
    -1,
    1e308,
    10**400,
    "x",
    "\ud800",
    [],
    {},
    [[]],
    [None] * 3,
    {"a": {}},
    math.nan,
    nested(99),
)


def test_no_damaged_document_ends_in_a_traceback(main, tmp_path, whole):
    """Values of other types, removed and added entries, cut text: one command each, which names
    file and line.
    """
    chance, good, path = random.Random(7), tmp_path / "good", tmp_path / "bad"
    good.write_text(whole)
    commands = [("merge", path), ("to-csv", path), ("summary", path), ("report", path)]
    commands += [
        ("compare", path, good),
        ("compare", good, path, "--align"),
        ("similar", path, "--to", "Box"),
    ]
    codes = set()
    for number in range(250):
        damaged = json.loads(whole)
        place = chance.choice([*places_of(damaged)])
        parent = functools.reduce(lambda value, key: value[key], place[:-1], damaged)
        if chance.random() < 0.3:
            del parent[place[-1]]
        else:
            parent[place[-1]] = chance.choice(WRONG_VALUES)
        text = json.dumps(damaged)
        text = text[: chance.randrange(len(text))] if chance.random() < 0.1 else text
        path.write_bytes(
            (whole + "\n" + text).encode(chance.choice(["utf-8"] * 9 + ["utf-16"]), "surrogatepass")
        )
        words = commands[number % len(commands)]
        code, _, said = main(*words)
        assert code in (0, 1, 2) and "Traceback" not in said, (place, said)
        assert code != 2 or words[0] == "similar" or str(path) in said and "line " in said, said
        codes.add((words[0], code))
    assert {
        (word, code) for word in ("merge", "to-csv", "summary", "report") for code in (0, 2)
    } <= codes


def part(path, options, *names):
    """A result of a run with these options."""
    run = {"addon": "1", "options": options}
    return result(
        path, *(documents.document([], {}, [], file=name, blender="5", run=run) for name in names)
    )


def test_help_without_a_command_lists_the_commands(main):
    code, out, _ = main("--help")
    names = [line.split()[0] for line in out.splitlines() if line.startswith("  ")]
    assert code == 0 and names == [*COMMANDS] and {"audit", "simplex", "similar"} <= {*names}
    assert all(main(name, "--help")[0] == 0 for name in names) and main("--help", "audit")[1] == out


def test_merge_refuses_parts_of_other_runs(main, tmp_path):
    steel, first = {"--density": 7850.0}, part(tmp_path / "1", {"--density": 7850.0}, "a", "b")
    code, out, _ = main("merge", first, part(tmp_path / "2", steel, "b", "c"))
    assert code == 0 and [json.loads(line)["file"] for line in out.splitlines()] == ["a", "b", "c"]
    code, out, said = main(
        "merge", first, part(tmp_path / "2", {"--density": 1.0, "--pose": True}, "c")
    )
    assert (
        (code, out) == (2, "")
        and "/2 was made with other options than " in said
        and "--density, --pose" in said
    )


def test_merge_holds_parts_against_their_list(main, tmp_path):
    names = [str(tmp_path / name) for name in "abcde"]
    listed = tmp_path / "list"
    listed.write_text("".join(listing.write_lines(names, 2)))
    assert [listing.read(listed, number) for number in (1, 2)] == [names[:2], names[2:]]
    parts = [
        part(tmp_path / str(number), {}, *some)
        for number, some in enumerate((names[:2], names[2:]), 1)
    ]
    code, out, _ = main("merge", *parts, "--manifest", listed)
    assert code == 0 and len(out.splitlines()) == 5
    (tmp_path / "f").touch()
    for others, words in (
        ([parts[0]], "no document of {}, {}, {}".format(*names[2:])),
        ([*parts, part(tmp_path / "3", {}, names[4])], "several documents of " + names[4]),
        (
            [*parts, part(tmp_path / "4", {}, str(tmp_path / "f"))],
            "not in the list: {}/f".format(tmp_path),
        ),
    ):
        code, out, said = main("merge", "--manifest", listed, *others)
        assert (code, out) == (2, "") and words in said
    assert main("measure", "--manifest", listed, "--part", "3")[0] == 2
    assert main("measure", "--part", "1", *names)[0] == 2


def test_wrong_value_is_named_with_its_place(main, tmp_path, whole):
    for change, place in (
        ({"mass": "heavy"}, "line 1: objects[0].mass is a text ('heavy'), not a number or null"),
        ({"inertia": [[1, 2, 3]]}, "line 1: objects[0].inertia has 1 entries, not 3"),
        (
            {"moments": {"volume": {"a": 1}}},
            "line 1: objects[0].moments.volume has the unknown entry “a”",
        ),
    ):
        damaged = json.loads(whole)
        damaged["objects"][0] |= change
        code, out, said = main("merge", result(tmp_path / "bad", damaged))
        assert (code, out) == (2, "") and place in said
    (tmp_path / "bad").write_bytes(b"\xef\xbb\xbf" + whole.encode())  # as some editors save it
    assert main("summary", tmp_path / "bad")[0] == 0
    (tmp_path / "bad").write_text(
        whole + "\n" + whole.replace('"schema": "body-moments/1"', '"schema": "x/1"')
    )
    assert "line 2: schema is x/1, not body-moments/1" in main("to-csv", tmp_path / "bad")[2]


def test_results_within_their_bounds_are_the_same(main, tmp_path):
    box = files.add_box("Box")
    first = result(tmp_path / "a", document("--pose"))
    assert main("compare", first, first)[0] == 0
    changed = json.loads(first.read_text())
    entry = changed["objects"][0]
    bound = entry["error_bound"]["volume"] + entry["error_bound"]["input"]["volume"]
    for factor, code in ((1.9, 0), (2.1, 1)):
        entry["volume"] = 6.0 + factor * bound
        ended, out, _ = main("compare", first, result(tmp_path / "b", changed))
        assert ended == code and ("FAIL" in out) == bool(code)
    assert main("compare", first, tmp_path / "b", "--tolerance", "1e-3")[0] == 0
    box.location = (1, -2, 5)
    box.rotation_euler = (0.4, 1.0, -2.0)
    bpy.context.view_layer.update()
    moved = result(tmp_path / "c", document("--pose"))
    assert main("compare", first, moved, "--tolerance", "1e-4")[0] == 1
    assert main("compare", first, moved, "--tolerance", "1e-4", "--align")[0] == 0
    assert main("compare", first, result(tmp_path / "d"))[0] == 1
    assert main("compare", first)[0] == 2
    assert main("compare", "--quiet", first, tmp_path / "b", "--tolerance", "1e-3") == (0, "", "")
    shown = main("compare", "--quiet", first, moved)[1].splitlines()
    assert [line[:4] for line in shown[:-1]] == ["FAIL"] * (len(shown) - 1) and len(shown) > 1


def test_assemblies_bones_and_missing_moments_are_compared(main, tmp_path):
    files.add_box("Box", (1.0, 2.0, 3.0))
    whole = document("--order", "2", "--surface-moments", "--about", "0.5,0,0", "--pose")
    whole["assemblies"] = [{**whole["objects"][0], "name": "All"}]
    whole["bones"] = [{**whole["objects"][0], "name": "Arm", "armature": "Rig"}]
    first = result(tmp_path / "a", whole)
    assert main("compare", first, first)[0] == 0
    for body, path in (
        ("objects", ("inertia_about", "inertia", 0, 1)),
        ("assemblies", ("mass",)),
        ("bones", ("mass",)),
    ):
        changed = json.loads(first.read_text())
        place = changed[body][0]
        for key in path[:-1]:
            place = place[key]
        place[path[-1]] *= 1.01
        code, out, _ = main("compare", first, result(tmp_path / "b", changed))
        assert code == 1 and out.count("FAIL") == 1 and changed[body][0]["name"] in out
    gone = json.loads(first.read_text())
    del gone["objects"][0]["moments"]["mass"]
    assert main("compare", first, result(tmp_path / "b", gone))[0] == 1
    assert main("compare", result(tmp_path / "b", gone), first)[0] == 1


def test_a_point_that_moved_by_as_much_as_a_center_is_uncertain(main, tmp_path):
    """The bound of a tensor about a point holds what the center's bound makes of it: from both
    sides.
    """
    files.add_box("Box", (1000.0, 0.0, 0.0))
    first = document("--about", "world", "--density", "1")
    entry = json.loads(json.dumps(first["objects"][0]))
    about, bounds = entry["inertia_about"]["inertia"], entry["error_bound"]
    bound = bounds["center_of_mass"] + bounds["input"]["center_of_mass"]
    share = (bounds["volume"] + bounds["input"]["volume"]) / entry["volume"]
    allowed = 2.0 * (
        2.0 * 6.0 * 1000.0 * bound
        + 6.0 * share * 1e6
        + bounds["inertia"]
        + bounds["input"]["inertia"]
    )
    for factor, code in ((0.9, 0), (1.1, 1)):
        about[1][1] = first["objects"][0]["inertia_about"]["inertia"][1][1] + factor * allowed
        words = (
            result(tmp_path / "a", first),
            result(tmp_path / "b", {**first, "objects": [entry]}),
        )
        assert main("compare", *words)[0] == code


def page(tmp_path):
    files.add_box(HOSTILE)
    found = [document("--thumbnails"), failed(HOSTILE + ".stl"), failed("b.stl", "timeout")]
    bpy.ops.mesh.primitive_uv_sphere_add()
    found.append({**document("--object", "Sphere"), "file": "z.blend"})
    path = tmp_path / "report.html"
    path.write_text("".join(to_html(found)), encoding="utf-8")
    return path


def test_report_is_one_page_with_escaped_names(tmp_path):
    text = page(tmp_path).read_text(encoding="utf-8")
    assert text.count("<script>") == 1 and "data:image/png;base64," in text and "<svg" in text
    assert "&lt;script&gt;" in text and r"\u202e" in text and "It &lt;b&gt;failed" in text
    assert (
        re.search(r"\d{4}-\d\d-\d\d \d\d:\d\d UTC", text)
        and "×" in text
        and "; --thumbnails" in text
    )
    assert not re.search(r"(src|href)=[\"']?(http|//|file)", text)


CHROMIUM = (
    shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
)
DRIVE = """
<script>
{
const rows=()=>[...document.querySelectorAll("tbody tr")].filter(row=>!row.hidden);
const names=()=>rows().map(row=>row.cells[2].textContent);
const told=[document.title,rows().length];
document.querySelectorAll("th button")[5].click();told.push(names());
document.querySelectorAll("th button")[5].click();told.push(names());
const text=document.getElementById("text");
text.value="sphere";text.dispatchEvent(new Event("input"));
told.push(names());text.value="";text.dispatchEvent(new Event("input"));
const status=document.getElementById("status");
status.value="timeout";status.dispatchEvent(new Event("change"));
told.push(rows().length);told.push([...document.images].every(image=>image.naturalWidth>0));
document.body.innerHTML="<pre></pre>";
document.querySelector("pre").textContent=JSON.stringify(told);
}
</script>
"""


@pytest.mark.skipif(not CHROMIUM, reason="needs chromium")
def test_the_report_sorts_and_filters_in_a_browser(tmp_path):
    """The page's own policy lets no other script run, so the one that drives it is let in by taking
    the policy away.
    """
    path = page(tmp_path)
    words = [
        CHROMIUM,
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--user-data-dir=" + str(tmp_path / "user"),
    ]
    words += ["--virtual-time-budget=5000", "--dump-dom"]
    shown = subprocess.run(
        [*words, path.as_uri()], capture_output=True, timeout=240, check=True
    ).stdout.decode()
    # its script ran, that of a name did not
    assert "<title>Body Moments</title>" in shown and "4 of 4" in shown
    text = re.sub(r"<meta http-equiv[^>]*>", "", path.read_text(encoding="utf-8")).replace(
        "</body>", DRIVE + "</body>"
    )
    driven = tmp_path / "driven.html"
    driven.write_text(text, encoding="utf-8")
    shown = subprocess.run(
        [*words, driven.as_uri()], capture_output=True, timeout=240, check=True
    ).stdout.decode()
    title, count, up, down, found, late, pictures = json.loads(
        html.unescape(re.search(r"<pre>(.*)</pre>", shown, re.S)[1])
    )
    assert (title, count, late, pictures) == ("Body Moments", 4, 1, True)
    assert up[0] == "Sphere" and down[0] != "Sphere" and found == ["Sphere"]


# Options that the panel has


def test_a_polynomial_is_every_objects_density():
    files.add_box("Box", (0, 0, 0))
    entry = measured("--polynomial", "1000 + 600*x")
    assert close(entry["mass"], 6000.0, 1e-12)
    # ∫ x (1000 + 600 x) over 1 by 2 by 3, by the mass.
    assert close(entry["center_of_mass"][0], 600.0 / 12.0 / 1000.0, 1e-12)


def test_materials_and_volumes_are_sources_of_density():
    box = files.add_box("Box")
    material = bpy.data.materials.new("Heavy")
    material.body_moments.density = 5000.0
    box.data.materials.append(material)
    assert close(measured("--density-from", "materials")["mass"], 30000.0, 1e-12)
    assert close(measured("--density-from", "value", "--order", "0")["mass"], 6000.0, 1e-12)
    assert "no Volume object" in document("--density-from", "volume:none")["errors"][0]["reason"]


def test_attribute_and_volume_agree_with_the_panel(tmp_path):
    box = files.add_box("Box", (0, 0, 0))
    values = np.array([1.0 + corner.co.x for corner in box.data.vertices], np.float32)
    box.data.attributes.new("weight", "FLOAT", "POINT").data.foreach_set("value", values)
    sheet = "--kind", "shell", "--thickness", "0.01"
    found = measured(*sheet, "--density-from", "attribute:weight")
    box.body_moments.kind, box.body_moments.density_from, box.body_moments.density_attribute = (
        "SHELL",
        "ATTRIBUTE",
        "weight",
    )
    box.body_moments.thickness = 0.01
    as_set = measured()
    assert found["mass"] == as_set["mass"] and found["inertia"] == as_set["inertia"]
    assert found["center_of_mass"] == as_set["center_of_mass"] != [0.0, 0.0, 0.0]

    box.body_moments.kind, box.body_moments.density_from = "SOLID", "VALUE"
    samples = np.random.default_rng(1).uniform(1.0, 2.0, (12, 12, 12)).astype(np.float32)
    cloud = volume_object(tmp_path / "a.vdb", vdb_grid(samples, offset=(-6, -6, -6)))
    found = measured("--object", "Box", "--density-from", "volume:Cloud")
    box.body_moments.density_from, box.body_moments.density_volume = "VOLUME", cloud
    as_set = measured("--object", "Box")
    assert found["mass"] == as_set["mass"] and found["inertia"] == as_set["inertia"]
    assert 6.0 < found["mass"] < 12.0  # The box has 6 m³.


@pytest.mark.parametrize("frame", ["world", "object"])
def test_inertia_and_moments_about_a_point(frame):
    box = files.add_box("Box", (3.0, 4.0, 5.0))
    box.rotation_euler = (0.3, 0.2, 0.1)
    bpy.context.view_layer.update()
    for about in ("center", "origin", "world", "0.5,-1,2"):
        entry = measured("--about", about, "--order", "2", "--density", "2", "--frame", frame)
        point, moments = np.array(entry["inertia_about"]["point"]), entry["moments"]
        assert moments["about"] == entry["inertia_about"]["point"]
        second = {key: 2.0 * value for key, value in moments["volume"].items()}  # with the density
        xx, yy, zz = second["2,0,0"], second["0,2,0"], second["0,0,2"]
        xy, xz, yz = second["1,1,0"], second["1,0,1"], second["0,1,1"]
        expected = np.array([[yy + zz, -xy, -xz], [-xy, xx + zz, -yz], [-xz, -yz, xx + yy]])
        assert (
            np.abs(entry["inertia_about"]["inertia"] - expected).max()
            < 1e-12 * np.abs(expected).max()
        )
        first = np.array([second[key] for key in ("1,0,0", "0,1,0", "0,0,1")]) / entry["mass"]
        assert np.abs(first - (np.array(entry["center_of_mass"]) - point)).max() < 1e-12
        expected = {"center": entry["center_of_mass"], "0.5,-1,2": [0.5, -1.0, 2.0]}
        expected["origin"] = [3.0, 4.0, 5.0] if frame == "world" else [0.0, 0.0, 0.0]
        expected["world"] = (
            [0.0, 0.0, 0.0]
            if frame == "world"
            else -(np.array(box.matrix_world.to_3x3()).T @ np.array(box.matrix_world.translation))
        )
        assert np.abs(point - expected[about]).max() < 1e-6
        assert math.isclose(entry["mass"], 12.0, rel_tol=1e-6)
    assert "inertia_about" not in measured()
