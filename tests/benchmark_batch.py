# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What it costs to measure 400 small .blend files: one Blender a file, one process for all, one child, two children.

    python tests/benchmark_batch.py [BLENDER]

Any Python does; the Blender is the one named, or the one on the PATH. Rounds are interleaved, so that what else the
machine does weighs on all alike; of each the best counts. “without start” is the time between a file's first byte and
the last file's record, as the command itself says it.
"""

import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SCRIPT = Path(__file__).resolve().parent.parent / "operators" / "batch.py"
COUNT, SINGLES, ROUNDS = 400, 5, 3
MAKE = """
import bpy, sys
bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
bpy.ops.mesh.primitive_cube_add()
for number in range({count}):
    bpy.context.active_object.scale.x = 1.0 + number / 100.0
    bpy.ops.wm.save_as_mainfile(filepath={folder!r} + "/{{:03d}}.blend".format(number), copy=True)
"""


def timed(words: list) -> tuple[float, float]:
    """The seconds of a command, and those between its first and its last file where it says them."""
    begun = time.perf_counter()
    ended = subprocess.run(list(map(str, words)), capture_output=True)
    seconds = time.perf_counter() - begun
    assert ended.returncode == 0, ended.stderr[-2000:]
    told = re.search(rb"files in ([\d.]+) s", ended.stderr)
    return seconds, float(told[1]) if told else seconds


def main() -> None:
    blender = sys.argv[1] if sys.argv[1:] else shutil.which("blender")
    start = [blender, "-b", "--factory-startup", "--python", SCRIPT, "--", "measure"]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "files"
        folder.mkdir()
        make = MAKE.format(count=COUNT, folder=str(folder))
        subprocess.run([blender, "-b", "--factory-startup", "--python-expr", make], check=True, capture_output=True)
        files = sorted(folder.iterdir())
        ways = {
            "one process": ["--no-supervisor"],
            "one child": ["--jobs", "1"],
            "two children": ["--jobs", "2"],
        }
        best = {way: (float("inf"), float("inf")) for way in ("one file", *ways)}
        for number in range(ROUNDS):
            for file in files[number * SINGLES : (number + 1) * SINGLES]:
                seconds = timed([*start, file, "--no-supervisor", "--output", Path(name) / "one.json"])
                best["one file"] = min(best["one file"], seconds)
            for way, words in ways.items():
                out = Path(name) / "{} {}.jsonl".format(way, number)
                seconds = timed([*start, folder, "--format", "jsonl", "--output", out, *words])
                best[way] = tuple(map(min, best[way], seconds))
    single = COUNT * best["one file"][0]
    print("one Blender a file: {:.2f} s, {:.0f} s for {}".format(best["one file"][0], single, COUNT))
    for way in ways:
        whole, loop = best[way]
        print("{:<13} {:6.2f} s ({:.0f} times faster); without start {:.2f} s".format(way, whole, single / whole, loop))
    gain = best["one child"][1] / best["two children"][1]
    print("the second child: {:.2f} times faster, start apart".format(gain))
    starting = best["one file"][0] - best["one child"][1] / COUNT
    loop = best["one process"][0] - starting
    print(
        "one child beside the loop in one process, start apart: {:+.0f} %".format(
            100 * best["one child"][1] / loop - 100
        )
    )


if __name__ == "__main__":
    main()
