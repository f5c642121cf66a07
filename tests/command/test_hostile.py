# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hostile files, names and places: the exit code is the contract's, nobody sees a traceback,
nothing is obeyed.
"""

import csv
import io
import json
import os
import random
import signal
import subprocess
import sys
import zipfile

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
from body_moments.core.measurement.plain_text import visible

from tests.blender import batch_files as files
from tests.command.processes import BLENDER, SCRIPT, in_blender, process
from tests.core.scan_files import written

pytestmark = pytest.mark.usefixtures("scene")


def array(values, **more) -> bytes:
    stream = io.BytesIO()
    np.save(stream, values, **more)
    return stream.getvalue()


def archive(data: bytes) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as target:
        target.writestr("q.npy", data)
    return stream.getvalue()


Q = array(np.eye(3))
WRONG_Q = {
    "empty": b"",
    "text": b"1 2 3\n",
    "cut": Q[:-1],
    "cut in its header": Q[:30],
    "longer": Q + b"x",
    "objects": array(np.array([[{}, 1, 2]], object), allow_pickle=True),
    "pickle": b"\x80\x04K\x01.",
    "terabytes": Q.replace(b"(3, 3)", b"(1<<40, 3)").replace(b"1<<40", b"99999999999"),
    "negative": Q.replace(b"(3, 3)", b"(-3, 3)"),
    "nested": Q.replace(b"(3, 3)", b"(" * 6),
    "not its words": Q.replace(b"'shape'", b"'shabe'"),
    "archive": archive(Q),
    "damaged archive": archive(Q)[:-30] + b"PK",
    "only the start of an archive": b"PK\x03\x04" + bytes(40),
    "text array": array(np.array([["a", "b", "c"]])),
    "complex": array(np.eye(3) * 1j),
    "flat": array(np.ones(3)),
    "infinite": array(np.full((1, 3), np.inf)),
    "a header of gigabytes": b"\x93NUMPY\2\0\xff\xff\xff\xff",
}


@pytest.mark.parametrize("name", WRONG_Q)
def test_damaged_wave_vectors_are_wrong_usage(name, tmp_path, main):
    files.add_box()
    path, target = written(tmp_path / "q.npy", WRONG_Q[name]), tmp_path / "out.npz"
    code, out, said = main("measure", "--fourier", target, "--q", path)
    assert (code, out) == (2, "") and "--q" in said and not target.exists()


@pytest.fixture
def library(main, tmp_path):
    for name in "ab":
        files.add_box(name)
    path = tmp_path / "library.jsonl"
    assert main("measure", "--signature", "--format", "jsonl", "--output", path)[0] == 0
    return path


def changed(document, name, value):
    found = json.loads(json.dumps(document))
    found["objects"][1]["signature"][name] = value
    return json.dumps(found).encode()


def test_malformed_library_is_wrong_usage(main, library):
    whole = library.read_bytes()
    document = json.loads(whole)
    for damaged in (
        b"[" * 200_000,
        b"{}",
        b"[]",
        b"5",
        b'"objects"',
        b'{"objects": 5}',
        b'{"objects": [5]}',
        b'{"objects": null}',
        b'{"objects": [[1, 2]]}',
        whole[:-9],
        b"\xff" + whole,
        b"1" * 5000,
    ):
        library.write_bytes(whole + damaged)
        code, out, said = main("similar", library, "--to", "a")
        assert (code, out) == (2, "") and "line 2" in said, damaged[:20]
    record = document["objects"][0]["signature"]
    for name, value in (
        ("invariants", record["invariants"][:-1]),
        ("invariants", []),
        ("zernike", [1e200] * 9),
        ("zernike", {"a": 1}),
        ("zernike", [[1], [1, 2]]),
        ("chirality", ["x"]),
        ("size", 1e-320),
        ("size", 1e300),
        ("size", [1]),
        ("size", 10**400),
        ("size", float("nan")),
    ):
        library.write_bytes(changed(document, name, value))
        code, out, said = main("similar", library, "--to", "a")
        assert code == 1 and "b: no signature" in said, (name, value)


@pytest.mark.filterwarnings("ignore")  # NumPy's, of headers that it can still make out
def test_no_random_damage_of_options_files_is_our_fault(main, library, tmp_path):
    chance = random.Random(4)
    whole, path = library.read_bytes(), tmp_path / "q.npy"

    def damage(data):
        data = bytearray(data)
        for _ in range(chance.randint(1, 4)):
            place = chance.randrange(len(data))
            data[place : place + chance.choice((0, 1, 1, 9))] = chance.choice(
                (
                    b"",
                    b"\0",
                    b"-",
                    b"9" * 30,
                    b"[",
                    b"{",
                    b'"',
                    b"e9",
                    b"(",
                    b"nan",
                    bytes([chance.randrange(256)]),
                )
            )
        return bytes(data)

    codes = set()
    for _ in range(150):
        library.write_bytes(damage(whole))
        codes.add(main("similar", library, "--to", "a")[0])
        path.write_bytes(damage(Q))
        codes.add(
            main("measure", "--object", "a", "--fourier", tmp_path / "out.npz", "--q", path)[0]
        )
    assert codes <= {0, 1, 2} and {0, 2} < codes | {1}


def test_empty_range_does_not_measure_the_open_scene(main, tmp_path):
    files.add_box()
    (tmp_path / "a.stl").write_text("")
    code, out, _ = main("measure", tmp_path / "a.stl", "--range", "1:2")
    assert (code, json.loads(out)) == (0, [])


def test_too_little_memory_is_no_fault_of_ours(main, monkeypatch):
    files.add_box()

    def fail(*_):
        raise MemoryError

    files.measure_with(monkeypatch, fail)
    code, out, _ = main("measure")
    assert code == 1 and "Too little memory" in json.loads(out)["errors"][0]["reason"]


NAMES = [
    "=1+1",
    "+1",
    "-1",
    "@x",
    "\t=1",
    "\r=1",
    "\tx",
    "\nx",
    " =1",
    "＝1",
    "'=1",
    "'x",
    "1e5",
    "x=1",
    "“=”",
    "a,b\n=c",
]


def test_no_cell_is_a_formula_and_every_text_can_be_read_back(main):
    for name in NAMES:
        files.add_box(name, center=(-1.0, -2.0, -3.0))
    names = [obj.name for obj in bpy.context.scene.objects]
    assert {*NAMES} <= {*names}
    code, out, _ = main("measure", "--format", "csv")
    rows = list(csv.DictReader(io.StringIO(out, newline="")))
    assert code == 0 and len(rows) == len(NAMES)
    for row in rows:
        for column, cell in row.items():
            if cell.lstrip()[:1] in {"=", "+", "-", "@", "\uff1d"}:
                float(cell)
            assert cell[:1] not in {"\t", "\r", "\n"}, column
    assert {row["name"].removeprefix("'") for row in rows} == {*names}
    plain = {"1e5", "x=1", "“=”", "a,b\n=c"}
    assert {row["name"] for row in rows if not row["name"].startswith("'")} == plain
    assert {row["center_of_mass_x"][:1] for row in rows} == {"-"}
    assert {entry["name"] for entry in json.loads(main("measure")[1])["objects"]} == {*names}


HOSTILE_NAME = "a\x1b[2J\nbody_moments: all fine\x07\u202egnp.\u2066\x9b1m\u2028"


def test_control_characters_are_shown_and_json_keeps_them(main, tmp_path):
    code, out, said = main("measure", "--object", HOSTILE_NAME)
    assert code == 1 and json.loads(out)["errors"][0]["name"] == HOSTILE_NAME
    (line,) = said.splitlines()
    assert (
        r"a\x1b[2J\nbody_moments: all fine\x07\u202egnp.\u2066\x9b1m\u2028" in line
        and line.isprintable()
    )
    said = main("measure", tmp_path / "a\x1b]0;b\n")[2]
    assert r"a\x1b]0;b\n" in said and said.count("\n") == 1
    for words in (
        ("--output", "\x1b[2J/x"),
        ("--density", "\x1b[2J"),
        ("--\x1b[2J",),
        ("--object",) * 2,
    ):
        said = main("measure", *words)[2]
        assert "\x1b" not in said and "error: " in said
    assert visible("Würfel 立方体 \\n ‘’ é\u200d") == "Würfel 立方体 \\n ‘’ é\u200d"


def starts(tmp_path):
    """Ways to start, with a scan that takes minutes."""
    path = tmp_path / "a_4096x4096x4096_uint8.raw"
    with open(path, "wb") as file:
        os.truncate(file.fileno(), 1 << 36)
    yield [sys.executable, SCRIPT, "measure", path]
    if BLENDER:
        yield [BLENDER, "-b", "--factory-startup", "--python", SCRIPT, "--", "measure", path]


@pytest.mark.skipif(os.name == "nt", reason="no signals between processes")
def test_ctrl_c_ends_a_long_read(tmp_path):
    for words in starts(tmp_path):
        env = {**os.environ, "BODY_MOMENTS_LIMITS": "samples=1e12"}
        reading = subprocess.Popen(
            list(map(str, words)), env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        try:
            assert any(b"samples read" in line for line in reading.stderr)
            reading.send_signal(signal.SIGINT)
            out, said = reading.communicate(timeout=20)
        finally:
            reading.kill()
        assert reading.returncode == 3 and b"interrupted" in said and b"Traceback" not in said, said
        assert b"{" not in out


def scripted_file(path, *, text=False, driver=None):
    files.empty_scene()
    box = files.add_box("Box")
    if text:
        bpy.data.texts.new("rig.py").use_module = True
        bpy.data.texts["rig.py"].write("1")
    if driver:
        box.driver_add("location", 0).driver.expression = driver
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True)
    return path


@in_blender
def test_scripts_that_blender_may_have_run_before_are_a_finding(tmp_path):
    paths = {
        "text": scripted_file(tmp_path / "text.blend", text=True),
        "driver": scripted_file(tmp_path / "driver.blend", driver="len('ab')"),
        "simple": scripted_file(tmp_path / "simple.blend", driver="1 + sin(2)"),
    }

    def findings(name, *switches, named=False):
        start = [BLENDER, "--factory-startup", "-b", *switches]
        words = [
            *(() if named else (paths[name],)),
            "--python",
            SCRIPT,
            "--",
            "measure",
            "--output",
        ]
        ended = process(*start, *words, tmp_path / "out.json", *((paths[name],) if named else ()))
        assert ended.returncode == 0, ended.stderr
        (found,) = (json.loads((tmp_path / "out.json").read_text()),)
        return [
            one["values"]["names"]
            for one in found["total"]["findings"]
            if one["code"] == "scripts_allowed"
        ]

    assert findings("text", "-y") == [["rig.py"]]
    assert findings("driver", "-Y", "-y") == [["Box"]]
    assert findings("simple", "-y") == []
    assert (
        findings("text", "-y", "-Y") == findings("text") == findings("text", "-y", named=True) == []
    )
