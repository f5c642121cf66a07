# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Exceptions become findings: a refusal its own, a fault of this program one with its place."""

import traceback

import pytest
from body_moments.core.numerics.arrays import segment_starts
from body_moments.core.verdict import MeasureError, finding
from body_moments.core.verdict.internal_error import finding_of


def test_refusal_and_memory_error_are_findings(capsys):
    refusal = MeasureError("holes_capped", count=2)
    assert finding_of(refusal) is refusal.finding
    assert finding_of(MemoryError()) == finding("out_of_memory")
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    "text, said", [("of\n  two lines.", "of two lines"), ("", "-"), (".", "-")]
)
def test_foreign_fault_prints_its_kind_message_and_traceback(text, said, capsys):
    try:
        raise KeyboardError(text)
    except KeyboardError as error:
        found = finding_of(error)
    assert found == finding("internal_error", type="KeyboardError", error=said, where="-")
    assert "raise KeyboardError(text)" in capsys.readouterr().err


def test_a_fault_inside_says_its_innermost_line_of_ours():
    with pytest.raises(AttributeError) as caught:
        segment_starts(None)
    frames = traceback.extract_tb(caught.value.__traceback__)
    (line,) = {frame.lineno for frame in frames if frame.filename.endswith("arrays.py")}
    assert finding_of(caught.value).values["where"] == "core/numerics/arrays.py:{}".format(line)


class KeyboardError(Exception):
    pass
