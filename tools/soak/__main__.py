# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs what takes long: every module of this folder that has `run(budget_seconds, seed)`, which
returns a report.

    python tools/soak [--minutes N] [--seed S] [NAME[:PART,…] …]

PART is a further argument of that `run`. A module fails by an exception. Each report is a file in
the folder that --reports names.
"""

import argparse
import importlib
import signal
import sys
import time
import traceback
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
NAMES = sorted(
    path.stem
    for path in Path(__file__).parent.glob("*.py")
    if "\ndef run(budget_seconds" in path.read_text("utf-8")
)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="of " + ", ".join(NAMES))
    parser.add_argument("--minutes", type=float, default=10.0, help="for all of them together (10)")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--reports", type=Path, default=ROOT / ".envs" / "soak")
    options = parser.parse_args()
    # a shell's job in the background has it ignored
    signal.signal(signal.SIGINT, signal.default_int_handler)
    unknown = {word.partition(":")[0] for word in options.names} - set(NAMES)
    if unknown:
        parser.error("unknown: " + ", ".join(sorted(unknown)))
    names = options.names or NAMES
    options.reports.mkdir(parents=True, exist_ok=True)
    failed = []
    for word in names:
        name, _, parts = word.partition(":")
        begun = time.monotonic()
        print("{} with seed {} ...".format(word, options.seed), flush=True)
        try:
            report = importlib.import_module("tools.soak." + name).run(
                60.0 * options.minutes / len(names), options.seed, *filter(None, parts.split(","))
            )
        except Exception:
            report = traceback.format_exc()
            failed.append(name)
        text = "{} in {:.0f} s, seed {}: {}".format(
            name, time.monotonic() - begun, options.seed, report
        )
        (options.reports / (name + ".txt")).write_text(text + "\n", encoding="utf-8")
        print(text, flush=True)
    print("failed: " + ", ".join(failed) if failed else "all passed", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    # the add-on under its name, and user files of Blender out of the way
    importlib.import_module("tests.conftest")
    importlib.import_module("bpy")  # bmesh is there from then on
    sys.modules["body_moments"].register()
    sys.exit(main())
