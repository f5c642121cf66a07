# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies broken in known ways: no wrong volume without a label, and the label that each breakage deserves.

A sample of what tests/soak/verdict_trials.py does by the thousand."""

import pytest

from tests.core.solid.breakages import BREAKAGES, trial
from tests.soak.verdict_trials import collect, markdown

EXACT, REPAIRED, ALARM = {"exact", "exact, with a note"}, {"reoriented"}, {"exact, with a warning"}
DESERVED = {
    "sound": {"exact"},
    "inside_out": REPAIRED,
    "flipped_faces": REPAIRED,
    "missing_faces": {"capped"},
    "missing_side": {"capped"},
    "many_missing_faces": {"capped", "open"},
    "copied_faces": ALARM | REPAIRED,
    "faces_without_area": EXACT,
    "loose_corners": {"exact"},
    "cracks": EXACT,
    "finer_side": EXACT,
    "fin": ALARM,
    "parts_apart": {"exact"} | REPAIRED,
    "cavity": EXACT | REPAIRED,
    "cavity_through_its_wall": ALARM,
    "nested": ALARM,
    "overlapping": ALARM,
    "twice": ALARM,
    "touching_and_welded": {"exact"} | REPAIRED,
    "bent_past_itself": ALARM,
    "bow_tie": ALARM | {"open"},
    "inner_wall": {"open"},
    "one_sided": {"open"},
    "flat_sheet": {"open"},
}
NEVER_WRONG = {
    *("sound", "inside_out", "flipped_faces", "missing_side", "copied_faces", "faces_without_area", "loose_corners"),
    *("cracks", "finer_side", "fin", "parts_apart", "cavity", "touching_and_welded", "inner_wall"),
}


@pytest.mark.parametrize("which", range(len(BREAKAGES)), ids=[breakage.__name__ for breakage in BREAKAGES])
def test_a_breakage_gets_the_label_that_it_deserves(which):
    for k in range(16):
        name, label, error = trial(len(BREAKAGES) * (1000 + k) + which)
        assert label in DESERVED[name], (name, label, k)
        if name in NEVER_WRONG and label != "open":
            assert error == 0.0, (name, label, k)


def test_trials_count_what_they_saw():
    table = collect(5000, 48)
    assert sum(table.values()) == 48 and {name for name, *_ in table} == set(DESERVED)
    assert "| sound | 2 | 0 |" in markdown(table)
