# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""No number, method, count or finding of the corpus has changed, but for rounding.

The truth is reference-5.2.json.gz; reference-4.5.json.gz has what Blender 4.5 builds otherwise (texts, metaballs,
booleans). Where a change of numbers is meant, both are made again as compare.py says, and what it prints is read first.
"""

import subprocess
import sys
from copy import deepcopy
from itertools import islice
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy")

from tests.corpus.compare import differences, load, within
from tests.corpus.scenes import EVALUATED, SCENES

FOLDER = Path(__file__).resolve().parent
SHOWN = 25


@pytest.fixture(scope="module")
def reference():
    table = load(FOLDER / "reference-5.2.json.gz")
    return table | load(FOLDER / "reference-4.5.json.gz") if bpy.app.version < (5, 0) else table


def test_no_number_has_changed(reference, tmp_path):
    out = tmp_path / "now.json"
    done = subprocess.run(
        [sys.executable, "-P", str(FOLDER / "compare.py"), "--write", str(out)],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        encoding="utf-8",
        errors="replace",
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-4000:]
    first = {}
    for place, before, after in within(reference, load(out), EVALUATED):
        first.setdefault(place.split(" › ")[0], "{}: {!r} -> {!r}".format(place, before, after))
    told = "{} of {} entries have changed; the first change of each:".format(len(first), len(reference))
    assert not first, "\n".join([told, *islice(first.values(), SHOWN)])


def test_the_corpus_is_large_and_of_every_kind(reference):
    records = [one for one in reference.values() if isinstance(one, dict) and "method" in one and "type" in one]
    bodies = {key.split("/", 1)[1] for key in reference if key.count("/") == 2 and not key.startswith("properties/")}
    assert len(bodies) >= 450
    assert {one["type"] for one in records} >= {"MESH", "CURVE", "SURFACE", "FONT", "META", "VOLUME", "EMPTY", "ARRAY"}
    assert {one["method"] for one in records} >= {
        "exact",
        "capped",
        "reoriented",
        "open",
        "shell",
        "union",
        "wire",
        "NURBS exact",
        "NURBS capped",
        "NURBS shell",
        "grid exact",
    }
    assert len(reference["named/refused.blend errors"]) >= 30
    assert {key.split("/")[1] for key in reference if key.startswith("properties/")} >= SCENES.keys() - {"refused"}


@pytest.mark.parametrize("name", ["volume", "surface"])
def test_a_moment_that_is_off_by_1e_12_is_found(reference, name):
    """In every record whose points the corpus itself makes."""
    changed = deepcopy(reference)
    touched = set()
    for key, one in changed.items():
        entries = one.get("moments", {}).get(name) if isinstance(one, dict) and "moments" in one else None
        if entries and entries["0,0,0"]:
            entries["0,0,0"] *= 1.0 + 1e-12
            touched.add(key)
    found = {place.split(" › ")[0] for place, _, _ in within(reference, changed)}
    assert len(touched) > 150 and found == touched
    strict = {place.split(" › ")[0] for place, _, _ in within(reference, changed, EVALUATED)}
    assert len(strict) > 0.6 * len(touched)


@pytest.mark.parametrize(
    "change",
    [
        lambda record: record.update(method="capped"),
        lambda record: record.update(symmetry="oblate"),
        lambda record: record.update(findings=""),
        lambda record: record.update(findings=record["findings"] + "; note cavities_subtracted of 0 count=1"),
        lambda record: record["health"].update(components=2),
        lambda record: record["health"].update(closed=False),
        lambda record: record.pop("mass"),
        lambda record: record.update(mass=None),
        lambda record: record.update(mass=record["mass"] * (1 + 1e-12)),
        lambda record: record["error_bound"].update(volume=1.01 * record["error_bound"]["volume"]),
        lambda record: record["principal_axes"][0].reverse(),
        lambda record: record["pose"]["matrix"][0].reverse(),
        lambda record: record["inertia"][0].pop(),
        lambda record: record["inertia"][0].__setitem__(1, "text"),
    ],
)
def test_a_change_of_one_record_is_found(reference, change):
    key = "world/closed.blend/Slanted beam far in its mesh"
    before, after = {key: reference[key]}, {key: deepcopy(reference[key])}
    change(after[key])
    assert list(within(before, after, EVALUATED)) and list(differences(before, after))


def test_changed_property_or_refusal_is_found(reference):
    stored, refused = "properties/closed/Slanted beam far in its mesh", "named/refused.blend errors"
    for key, new in (
        (stored, {**reference[stored], "body_method": "open"}),
        (stored, {**reference[stored], "body_mass": reference[stored]["body_mass"] * (1 + 1e-12)}),
        (refused, reference[refused][1:]),
        (refused, [*reference[refused], "Zero"]),
    ):
        before, after = {key: reference[key]}, {key: new}
        assert list(within(before, after, EVALUATED)) and list(differences(before, after))
    assert list(within(before, {})) and list(differences(before, {}))


def test_new_entries_and_the_last_bit_are_no_change(reference):
    key = "world/closed.blend/Slanted beam far in its mesh"
    more = {**reference[key], "status": "ok", "mass": reference[key]["mass"] * (1 + 2.3e-16)}
    before, after = {key: reference[key]}, {key: more, "world/closed.blend/Another": {}}
    assert not list(within(before, after))
    (found,) = differences(before, after)
    assert found[0] == key + " › mass"
