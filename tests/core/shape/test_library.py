# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Libraries of signatures: limits of the length of a line."""

import os

import pytest
from body_moments.core.shape.library import read_library
from body_moments.core.verdict import FileError


def test_line_beyond_256_mebibytes_is_refused(tmp_path):
    path = tmp_path / "a.jsonl"
    path.touch()
    os.truncate(path, 2**28 + 1)
    with pytest.raises(FileError) as caught:
        read_library(path)
    assert caught.value.finding.code == "library_line"
    assert caught.value.finding.values == {"file": "a.jsonl", "line": 1}
