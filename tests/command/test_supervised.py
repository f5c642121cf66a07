# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs over many files in child processes: each file has one record, whatever it or a signal does
to a child.
"""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
from body_moments.command.supervisor import listing, processes

from tests.blender import batch_files as files
from tests.command.processes import BLENDER, SCRIPT, in_blender, process, script
from tools.soak import commands, hostile, kills

on_linux = pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="not on this system: /proc"
)
signals = pytest.mark.skipif(os.name == "nt", reason="not on this system: signals")


def lines(path):
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def statuses(path):
    return {Path(document["file"]).name: document["status"] for document in lines(path)}


@pytest.fixture(scope="module")
def scans(tmp_path_factory):
    """Twelve scans, whose masses tell them apart."""
    folder = tmp_path_factory.mktemp("scans")
    for number in range(12):
        np.save(folder / "scan {:02d}.npy".format(number), np.full((3, 4, 5), number + 1, "u2"))
    return folder


@pytest.fixture(scope="module")
def killer(tmp_path_factory):
    """A file that kills Blender."""
    corpus = Path(__file__).resolve().parents[2] / "tools" / "soak" / "crash_corpus"
    return Path(
        shutil.copy(
            corpus / "damaged_block.blend", tmp_path_factory.mktemp("killer") / "killer.blend"
        )
    )


def test_file_that_kills_blender_is_a_record(scans, killer, tmp_path):
    first, second = sorted(scans.iterdir())[:2]
    out = tmp_path / "out.jsonl"
    words = (
        "measure",
        first,
        killer,
        tmp_path / "none.stl",
        second,
        first,
        "--jobs",
        "1",
        "--format",
        "jsonl",
    )
    ended = script(*words, "--output", out)
    assert ended.returncode == 1 and b"Traceback" not in ended.stderr
    found = lines(out)
    assert [Path(one["file"]) for one in found] == [
        first,
        killer,
        tmp_path / "none.stl",
        second,
        first,
    ]
    assert [one["status"] for one in found] == ["ok", "crashed", "missing", "ok", "ok"]
    assert found[0] == found[4] and "2 times" in found[1]["errors"][0]["reason"]
    assert b"4 files in" in ended.stderr and b"killer.blend: Blender crashed" in ended.stderr
    attempts = {
        Path(one["key"]["path"]).name: one["attempts"]
        for one in lines(tmp_path / "out.jsonl.journal")
    }
    assert attempts == {first.name: 1, killer.name: 2, "none.stl": 1, second.name: 1}
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.jsonl", "out.jsonl.journal"]


def test_hanging_or_huge_file_is_a_record(tmp_path):
    path = tmp_path / "a_2048x2048x2048_uint8.raw"
    with open(path, "wb") as file:
        os.truncate(file.fileno(), 1 << 33)
    out = tmp_path / "out.json"
    ended = script("measure", path, "--timeout", "1", "--output", out)
    assert ended.returncode == 1 and json.loads(out.read_text())["status"] == "timeout"
    assert b"longer than 1 s" in ended.stderr
    if sys.platform.startswith("linux"):
        assert script("measure", path, "--memory-mb", "60", "--output", out).returncode == 1
        assert json.loads(out.read_text())["status"] == "memory"
        assert json.loads((tmp_path / "out.json.old").read_text())["status"] == "timeout"


def test_folders_manifests_and_ranges_name_the_same_files(scans, tmp_path):
    (tmp_path / "in").mkdir()
    link = tmp_path / "in" / "round"
    if os.name != "nt":
        link.symlink_to(tmp_path)
    shutil.copytree(scans, tmp_path / "in" / "scans")
    (tmp_path / "in" / "notes.txt").write_text("")
    (tmp_path / "in" / ".hidden.npy").write_text("")
    names = ["scan {:02d}.npy".format(number) for number in range(12)]
    listed = tmp_path / "list"
    assert script("manifest", tmp_path / "in", "--output", listed).returncode == 0
    assert [Path(path).name for path in listing.read(listed)] == names
    parts = []
    for part in ("0:5", "5:12"):
        parts.append(tmp_path / "part {}.jsonl".format(part[0]))
        words = (
            "measure",
            "--manifest",
            listed,
            "--range",
            part,
            "--format",
            "jsonl",
            "--output",
            parts[-1],
        )
        assert script(*words).returncode == 0
    merged = tmp_path / "merged.jsonl"
    assert script("merge", *parts, parts[1], "--output", merged).returncode == 0
    whole = script("measure", tmp_path / "in", "--format", "jsonl")
    assert whole.returncode == 0 and whole.stdout == merged.read_bytes()
    assert [one["objects"][0]["mass"] for one in lines(merged)] == [
        60.0 * (number + 1) for number in range(12)
    ]
    assert script("measure", tmp_path / "in" / "nothing", "--manifest", scans).returncode == 2
    (tmp_path / "empty").mkdir()
    assert script("measure", tmp_path / "empty").returncode == 2


@pytest.mark.parametrize("name", ["out.json.old", "out.json.journal"])
def test_file_in_the_way_of_an_older_result_is_kept(scans, tmp_path, name):
    (tmp_path / "out.json").write_text(script("measure", next(scans.iterdir())).stdout.decode())
    (tmp_path / name).write_text("a novel")
    words = ("measure", next(scans.iterdir()), "--output", tmp_path / "out.json")
    ended = script(*words)
    assert ended.returncode == 2 and name.encode() in ended.stderr
    assert (tmp_path / name).read_text() == "a novel"


@signals
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM] if os.name != "nt" else [])
def test_a_signal_ends_a_run_at_once_and_it_can_be_resumed(tmp_path, number):
    folder = tmp_path / "scans"
    folder.mkdir()
    for one in range(4):
        np.save(folder / "{}.npy".format(one), np.full((3, 4, 5), one + 1, "u2"))
    slow = folder / "z_2048x2048x2048_uint8.raw"
    slow.touch()
    os.truncate(slow, 1 << 33)
    out, journal = tmp_path / "out.jsonl", tmp_path / "out.jsonl.journal"
    words = (folder, "--jobs", "1", "--format", "jsonl", "--output", out)
    running = commands.start(*words)
    assert commands.wait_until(
        lambda: journal.exists() and journal.read_bytes().count(b"\n") == 4, 120
    )
    born = commands.children(running.pid)
    sent = time.monotonic()
    running.send_signal(number)
    _, said = running.communicate(timeout=20)
    # within a second on a machine at rest, where the file would take minutes
    assert time.monotonic() - sent < 10.0
    assert running.returncode == 3 and b"interrupted after 4 of 5" in said and not out.exists()
    assert not any(map(commands.is_running, born))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.jsonl.journal", "scans"]
    slow.unlink()
    ended = script("measure", *words, "--resume")
    assert ended.returncode == 0 and b"0 files in" in ended.stderr and len(lines(out)) == 4


@signals
def test_children_that_do_not_listen_end_together():
    """One period of grace for all of them: with one each these would take 8 s."""
    stubborn = ["sh", "-c", "trap '' TERM; echo; while :; do sleep 1; done"]
    children = [
        subprocess.Popen(stubborn, stdout=subprocess.PIPE, start_new_session=True)
        for _ in range(20)
    ]
    for child in children:
        child.stdout.readline()
        child.stdout.close()
    begun = time.monotonic()
    processes.kill(children, gently=True)
    assert time.monotonic() - begun < 4.0
    assert [child.returncode for child in children] == [-signal.SIGKILL] * 20


def test_two_runs_do_not_write_the_same_result(scans, tmp_path):
    slow = tmp_path / "z_2048x2048x2048_uint8.raw"
    slow.touch()
    os.truncate(slow, 1 << 33)
    running = commands.start(slow, "--output", tmp_path / "out.json")
    try:
        assert commands.wait_until(lambda: (tmp_path / ".out.json.body_moments.work").exists(), 60)
        ended = script("measure", next(scans.iterdir()), "--output", tmp_path / "out.json")
        assert ended.returncode == 2 and b"another run" in ended.stderr
    finally:
        running.terminate()
        running.communicate(timeout=20)


@on_linux
def test_kills_lose_nothing_and_leave_nothing():
    assert "kills" in kills.run(0.0, 1, children=3, supervisors=2, files=24)


def test_hostile_files_have_one_record_each():
    """More of them, and on every format, in `project.py soak`."""
    assert "files" in hostile.run(0.0, 1, fuzzed=40)


@in_blender
def test_any_python_supervises_a_blender(scans, killer, tmp_path):
    out = tmp_path / "out.jsonl"
    words = (next(scans.iterdir()), killer, "--format", "jsonl", "--output", out)
    bare = (sys.executable, "-S", SCRIPT, "measure")
    ended = process(*bare, "--blender", BLENDER, *words)
    assert ended.returncode == 1, ended.stderr
    assert [*statuses(out).values()] == ["ok", "crashed"]
    before = [{**one, "blender": None} for one in lines(out)]
    ended = process(BLENDER, "-b", "--factory-startup", "--python", SCRIPT, "--", "measure", *words)
    assert ended.returncode == 1 and [{**one, "blender": None} for one in lines(out)] == before
    ended = process(*bare, "--blender", tmp_path / "no blender", *words)
    assert ended.returncode == 2 and b"no process that measures" in ended.stderr


def test_results_of_many_files_are_known_when_resuming(tmp_path):
    for name in "ab":
        files.empty_scene()
        files.add_box("Box")
        files.save(tmp_path / "{}.blend".format(name))
    out = tmp_path / "out.jsonl"
    words = (
        "measure",
        tmp_path / "a.blend",
        tmp_path / "b.blend",
        "--density",
        "2",
        "--format",
        "jsonl",
    )
    assert script(*words, "--write", "--output", out).returncode == 0
    stored = (tmp_path / "a.blend").read_bytes()
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    assert bpy.data.objects["Box"]["body_mass"] == pytest.approx(12.0)
    ended = script(*words, "--write", "--output", out, "--resume")
    assert b"0 files in" in ended.stderr and (tmp_path / "a.blend").read_bytes() == stored


def test_resuming_notices_changed_sample_positions(tmp_path):
    np.save(tmp_path / "scan.npy", np.full((2, 2, 2), 3, "u2"))
    along, out = tmp_path / "x.npy", tmp_path / "out.json"
    np.save(along, np.array([0.0, 1.0]))
    words = (
        "measure",
        tmp_path / "scan.npy",
        tmp_path / "scan.npy",
        "--positions",
        "x={}".format(along),
    )
    ended = script(*words, "--output", along, "--force")
    assert (
        ended.returncode == 2 and b"x.npy" in ended.stderr and np.load(along).tolist() == [0.0, 1.0]
    )
    assert script(*words, "--output", out).returncode == 0
    before = json.loads(out.read_text())[0]["objects"][0]["mass"]
    np.save(along, np.array([0.0, 2.0]))
    os.utime(along, ns=(1, 1))
    assert script(*words, "--output", out, "--resume").returncode == 0
    assert json.loads(out.read_text())[0]["objects"][0]["mass"] == pytest.approx(2.0 * before)


def test_the_scan_through_children_is_the_one_without(scans):
    names = sorted(scans.iterdir())[:3]
    one, other = (script("measure", *names, *words) for words in ((), ("--no-supervisor",)))
    assert one.returncode == other.returncode == 0 and one.stdout == other.stdout


def test_resuming_notices_changed_references(tmp_path):
    """A library linked by way of another, the buffer of a glTF, the samples of a detached NRRD."""
    files.empty_scene()
    files.add_box("Box")
    files.save(tmp_path / "inner.blend")
    files.empty_scene()
    with bpy.data.libraries.load(str(tmp_path / "inner.blend"), link=True) as (_, into):
        into.meshes = ["Box"]
    bpy.context.collection.objects.link(bpy.data.objects.new("Outer", bpy.data.meshes["Box"]))
    files.save(tmp_path / "outer.blend")
    files.empty_scene()
    with bpy.data.libraries.load(str(tmp_path / "outer.blend"), link=True) as (_, into):
        into.objects = ["Outer"]
    bpy.context.collection.objects.link(bpy.data.objects["Outer"])
    files.save(tmp_path / "main.blend")
    files.empty_scene()
    files.add_box("Box")
    files.save(tmp_path / "part.gltf")
    header = (
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: samples.bin\n"
    )
    (tmp_path / "scan.nhdr").write_text(header)
    (tmp_path / "samples.bin").write_bytes(bytes([1] * 8))
    (tmp_path / "broken.gltf").write_text(
        (tmp_path / "part.gltf").read_text().replace("part.bin", "absent.bin")
    )
    out = tmp_path / "out.jsonl"
    named = [tmp_path / name for name in ("main.blend", "part.gltf", "scan.nhdr", "broken.gltf")]
    words = ("measure", *named, "--jobs", "1", "--format", "jsonl", "--output", out)
    assert script(*words).returncode == 1
    assert [one["status"] for one in lines(out)] == ["ok", "ok", "ok", "error"]

    def measured_again():
        ended = script(*words, "--resume")
        return ended.stderr.decode().rpartition(" file")[0].split()[-1], [
            one["status"] for one in lines(out)
        ]

    assert measured_again()[0] == "0"
    files.empty_scene()
    files.add_box("Box", size=(2.0, 2.0, 2.0))
    files.save(tmp_path / "inner.blend")
    (tmp_path / "samples.bin").write_bytes(bytes([3] * 8))
    os.utime(tmp_path / "samples.bin", ns=(1, 1))
    shutil.copy(tmp_path / "part.bin", tmp_path / "absent.bin")
    assert measured_again() == ("3", ["ok"] * 4)
    assert (
        lines(out)[0]["objects"][0]["volume"] == pytest.approx(8.0)
        and lines(out)[2]["objects"][0]["mass"] == 24.0
    )
    (tmp_path / "part.bin").unlink()
    (tmp_path / "inner.blend").unlink()
    assert measured_again() == ("2", ["error", "error", "ok", "ok"])
    assert measured_again()[0] == "0"
