# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers, methods, counts and findings of the corpus agree with the kept ones within their
tolerances.

reference.txt was made with Blender 5.2; reference-4.5.txt holds the bodies that Blender 4.5 builds
differently (texts, metaballs, Booleans). A change of numbers on purpose: make both again as
compare.py says, and read their diff first.
"""

import subprocess
import sys
from copy import deepcopy
from itertools import islice
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy")

from tests.corpus import summary
from tests.corpus.compare import differences, load
from tests.corpus.scenes import EVALUATED, SCENES

FOLDER = Path(__file__).resolve().parent
SHOWN = 25
KEY = "world/closed.blend/Box"
RECORD = {
    "type": "MESH",
    "kind": "solid",
    "method": "exact",
    "findings": "holes_capped 4 count=1",
    "density": 1000.0,
    "mass": 24000.0,
    "volume": 24.0,
    "area": 52.0,
    "center_of_mass": [1.0, 2.0, 3.0],
    "inertia": [[50000.0, 1.0, 0.0], [1.0, 40000.0, 0.0], [0.0, 0.0, 26000.0]],
    "principal_moments": [26000.0, 40000.0, 50000.0],
    "principal_axes": [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]],
    "principal_axes_unique": True,
    "symmetry": "asymmetric",
    "health": {
        "closed": True,
        "components": 1,
        "self_intersection": "not_found",
        "volume_spread": 0.0,
    },
    "error_bound": {
        "volume": 1e-13,
        "area": 1e-13,
        "center_of_mass": 1e-14,
        "inertia": 1e-10,
        "input": {"volume": 1e-4},
    },
    "moments": {
        "order": 1,
        "volume": {"0,0,0": 24.0, "1,0,0": 24.0, "0,1,0": 48.0, "0,0,1": 72.0},
        "error": {"volume": {"0,0,0": 1e-13, "1,0,0": 1e-13, "0,1,0": 1e-13, "0,0,1": 1e-13}},
    },
    "pose": {
        "matrix": [[1.0, 0.0, 0.0, -1.0], [0.0, 1.0, 0.0, -2.0], [0.0, 0.0, 1.0, -3.0]],
        "unique": True,
    },
    "signature": {"size": 1.0, "zernike": [0.5, 0.25], "fourier": [0.125, 0.5]},
}


@pytest.fixture(scope="module")
def reference():
    table = load(FOLDER / "reference.txt")
    return table | load(FOLDER / "reference-4.5.txt") if bpy.app.version < (5, 0) else table


def test_corpus_keeps_its_numbers(reference, tmp_path):
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
    for place, before, after in summary.changes(reference, summary.summarize(load(out), EVALUATED)):
        first.setdefault(place.split(" › ")[0], "{}: {!r} -> {!r}".format(place, before, after))
    told = "{} of {} entries have changed; the first change of each:".format(
        len(first), len(reference)
    )
    assert not first, "\n".join([told, *islice(first.values(), SHOWN)])


def test_corpus_holds_bodies_of_every_kind(reference):
    bodies = {
        key.split("/", 1)[1]
        for key in reference
        if key.count("/") == 2 and not key.startswith("properties/")
    }
    assert len(bodies) >= 450
    types = {entry["words"].split()[0] for entry in reference.values() if "words" in entry}
    assert types >= {"MESH", "CURVE", "SURFACE", "FONT", "META", "VOLUME", "EMPTY", "ARRAY"}
    assert {entry.get("method") for entry in reference.values()} >= {
        *("exact", "capped", "reoriented", "open", "shell", "union", "wire"),
        *("NURBS exact", "NURBS capped", "NURBS shell", "grid exact"),
    }
    assert {
        key.split("/")[1] for key in reference if key.startswith("properties/")
    } >= SCENES.keys() - {"refused"}


def find_changes(before, after):
    """Return the changes from one record to another, by way of the text that is kept."""
    kept = summary.read(summary.write(summary.summarize({KEY: before}, set())))
    return list(summary.changes(kept, summary.summarize({KEY: after}, set())))


def scale(place, factor):
    def change(record):
        *path, last = place
        for key in path:
            record = record[key]
        record[last] *= factor

    return change


@pytest.mark.parametrize(
    "change",
    [
        *(scale([name], 1.0 + 1e-6) for name in ("mass", "volume", "area", "density")),
        *(scale(["center_of_mass", i], 1.0 + 1e-6) for i in range(3)),
        scale(["inertia", 0, 0], 1.0 + 1e-6),
        scale(["principal_moments", 0], 1.0 + 1e-6),
        scale(["moments", "volume", "0,1,0"], 1.0 + 1e-6),
        scale(["moments", "error", "volume", "1,0,0"], 10.0),
        scale(["error_bound", "input", "volume"], 2.0),
        scale(["signature", "fourier", 1], 1.0 + 1e-6),
        lambda record: record.update(method="capped"),
        lambda record: record.update(symmetry="oblate"),
        lambda record: record.update(findings=""),
        lambda record: record.update(findings="holes_capped 4 count=2"),
        lambda record: record["health"].update(components=2),
        lambda record: record["health"].update(closed=False),
        lambda record: record.update(mass=None),
        lambda record: record.update(volume=float("nan")),
        lambda record: record["principal_axes"][0].reverse(),
        lambda record: record["pose"]["matrix"][0].reverse(),
        lambda record: record.pop("inertia"),
    ],
)
def test_changed_record_is_found(change):
    after = deepcopy(RECORD)
    change(after)
    assert find_changes(RECORD, after) and list(differences({KEY: RECORD}, {KEY: after}))


def test_last_bit_is_no_change_of_the_summary():
    after = RECORD | {"mass": RECORD["mass"] * (1 + 2.3e-16), "volume": 24.0 * (1 + 1e-13)}
    assert not find_changes(RECORD, RECORD) and not find_changes(RECORD, after)
    assert len(list(differences({KEY: RECORD}, {KEY: after}))) == 2


def test_missing_entry_is_found_and_a_new_one_is_not(reference):
    key, refused = next(iter(reference)), "named/refused.blend errors"
    less = {name: entry for name, entry in reference.items() if name != key}
    assert [place for place, _, _ in summary.changes(reference, less)] == [key]
    assert not list(summary.changes(less, less | {key: {}}))
    names = summary.summarize({refused: ["Zero", "Empty"]}, set())
    assert list(summary.changes(names, summary.summarize({refused: ["Zero"]}, set())))


def test_changed_property_is_found():
    stored = {"body_mass": 24000.0, "body_volume": 24.0, "body_method": "exact"}
    tables = [
        {"object/closed.blend/Box": RECORD, "properties/closed/Box": stored | change}
        for change in ({}, {"body_mass": 24000.1}, {"body_method": "open"})
    ]
    first, *others = (summary.summarize(table, set()) for table in tables)
    assert not {"mass", "volume", "method"} & first["properties/closed/Box"].keys()
    assert all([place for place, _, _ in summary.changes(first, other)] for other in others)
