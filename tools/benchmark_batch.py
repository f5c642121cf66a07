# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cost of measuring 400 small .blend files: one Blender a file, one process for all, one child, two
children.

    python tools/benchmark_batch.py [BLENDER]

Any Python of Linux or macOS does; the Blender is the one named, or the one on the PATH. The ways
take turns, so that what else the machine does weighs on all alike. Two clocks: processor time of a
command with all that it starts, and wall time. A file's time without start-up is (all files - one
file) / (their number - 1), for every way alike; the figures are medians over the rounds, of ratios
within a round where two ways are compared.
"""

import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SCRIPT = Path(__file__).resolve().parent.parent / "operators" / "batch.py"
COUNT, ROUNDS = 400, 5
MAKE = """
import bpy, sys
bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
bpy.ops.mesh.primitive_cube_add()
for number in range({count}):
    bpy.context.active_object.scale.x = 1.0 + number / 100.0
    bpy.ops.wm.save_as_mainfile(filepath={folder!r} + "/{{:03d}}.blend".format(number), copy=True)
"""
WAYS = {
    "one process": ["--no-supervisor"],
    "one child": ["--jobs", "1"],
    "two children": ["--jobs", "2"],
}
CLOCKS = ("processor", "wall")


def timed(words: list) -> tuple[float, float]:
    """The seconds of a command, by the two clocks."""
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    ended = subprocess.run(list(map(str, words)), capture_output=True)
    seconds, after = time.perf_counter() - begun, resource.getrusage(resource.RUSAGE_CHILDREN)
    assert ended.returncode == 0, ended.stderr[-2000:]
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, seconds


def one_round(
    start: list, folder: Path, first: Path, out: Path
) -> dict[str, list[tuple[float, float]]]:
    """Return the times of each way for all files and for one; of one Blender a file, for one
    only.
    """
    found = {
        "one Blender a file": [
            timed([*start, first, "--no-supervisor", "--output", out / "one.json"])
        ]
    }
    for way, words in WAYS.items():
        result = ["--force", "--format", "jsonl", "--output", out / (way + ".jsonl")]
        found[way] = [timed([*start, files, *words, *result]) for files in (folder, first)]
    return found


def main() -> None:
    blender = sys.argv[1] if sys.argv[1:] else shutil.which("blender")
    start = [blender, "-b", "--factory-startup", "--python", SCRIPT, "--", "measure"]
    with tempfile.TemporaryDirectory() as name:
        folder, out = Path(name) / "files", Path(name) / "out"
        folder.mkdir()
        out.mkdir()
        make = MAKE.format(count=COUNT, folder=str(folder))
        subprocess.run(
            [blender, "-b", "--factory-startup", "--python-expr", make],
            check=True,
            capture_output=True,
        )
        first = min(folder.iterdir())
        one_round(start, folder, first, out)  # The files are in memory then.
        rounds = [one_round(start, folder, first, out) for _ in range(ROUNDS)]
    load = os.getloadavg()
    print("{} files, {} rounds, load {:.1f} at the end".format(COUNT, ROUNDS, load[0]))
    print(
        "{:<20} {:>22} {:>30} {:>26}".format(
            "", "all, s", "a file without start-up, ms", "times one Blender a file"
        )
    )
    print("{:<20} {}".format("", "{:>11} {:>10} {:>18} {:>11} {:>15} {:>10}".format(*3 * CLOCKS)))

    def middle(value) -> list[float]:
        """The median over the rounds of what `value` makes of one, for each clock."""
        return [statistics.median(value(one, clock) for one in rounds) for clock in (0, 1)]

    def loop(one, way, clock):
        return (one[way][0][clock] - one[way][1][clock]) / (COUNT - 1)

    single = "one Blender a file"
    print(
        "{:<20} {:>11.0f} {:>10.0f}".format(
            single, *middle(lambda one, c: COUNT * one[single][0][c])
        )
    )
    for way in WAYS:
        whole = middle(lambda one, c, way=way: one[way][0][c])
        apart = middle(lambda one, c, way=way: 1000.0 * loop(one, way, c))
        gain = middle(lambda one, c, way=way: COUNT * one[single][0][c] / one[way][0][c])
        line = "{:<20} {:>11.2f} {:>10.2f} {:>18.2f} {:>11.2f} {:>15.0f} {:>10.0f}"
        print(line.format(way, *whole, *apart, *gain))
    second = middle(lambda one, c: loop(one, "one child", c) / loop(one, "two children", c))
    cost = middle(
        lambda one, c: 100.0 * loop(one, "one child", c) / loop(one, "one process", c) - 100.0
    )
    print(
        "start-up apart: the second child {:.2f} times faster by the wall clock;".format(second[1])
    )
    print(
        "one child beside the plain loop {:+.0f} % of processor time, {:+.0f} % of wall "
        "time".format(*cost)
    )


if __name__ == "__main__":
    main()
