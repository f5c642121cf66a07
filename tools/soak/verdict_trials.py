# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random verdict trials: bodies broken in known ways, and what the label beside their numbers is
worth.

python tools/soak/verdict_trials.py [--trials N] [--seed S]     prints the table of docs/limits.md
"""

import argparse
import importlib
import sys
import time
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
TRIALS = 3000
COLUMNS = ("right", "up to 1 % off", "more than 1 % off", "no true volume")


def collect(seed, trials, budget_seconds=float("inf")):
    """Counts of (breakage, label, column). AssertionError where a wrong number has no label."""
    breakages = importlib.import_module("tests.core.solid.breakages")
    table, begun = Counter(), time.monotonic()
    for k in range(trials):
        name, label, error = breakages.trial(seed + k)
        column = 3 if error is None else 0 if error == 0.0 else 1 if error <= 0.01 else 2
        labelled = label not in ("exact", "exact, with a note")
        assert labelled or column == 0 or (column == 1 and error < 1e-4), (
            seed + k,
            name,
            label,
            error,
        )
        assert column != 3 or label == "open", (seed + k, name, label)
        table[name, label, column] += 1
        if time.monotonic() - begun > budget_seconds:
            break
    return table


def markdown(table):
    """The table of label against truth, and of breakage against label."""
    labels = importlib.import_module("tests.core.solid.breakages").LABELS
    lines = ["| verdict | " + " | ".join(COLUMNS) + " |", "|---|" + "---:|" * len(COLUMNS)]
    for label in labels:
        counts = [
            sum(n for (_, of, k), n in table.items() if (of, k) == (label, column))
            for column in range(4)
        ]
        lines.append("| {} | {} |".format(label, " | ".join(map(str, counts))))
    lines += ["", "| damage | " + " | ".join(labels) + " |", "|---|" + "---:|" * len(labels)]
    for name in dict.fromkeys(name for name, *_ in table):
        counts = [
            sum(n for (of, at, _), n in table.items() if (of, at) == (name, label))
            for label in labels
        ]
        lines.append("| {} | {} |".format(name.replace("_", " "), " | ".join(map(str, counts))))
    return "\n".join(lines)


def run(budget_seconds, seed):
    """Run trials until the time is used up."""
    table = collect(seed % 2**31, 10**9, budget_seconds)
    return "{} trials, no wrong number without a label\n{}".format(
        sum(table.values()), markdown(table)
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=TRIALS)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    sys.path.insert(0, str(ROOT))
    importlib.import_module("tests.conftest")
    print(markdown(collect(options.seed, options.trials)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
