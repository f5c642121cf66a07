# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixtures of the tests that need Blender."""

import pytest
from body_moments.operators import batch

from tests.in_blender import reported  # noqa: F401


@pytest.fixture
def main(tmp_path, capfd):
    """The command line in this process: words to exit code, output and errors."""

    def run(*words):
        with open(tmp_path / "standard output", "wb+") as out:
            code = batch.main(list(map(str, words)), channel=out.fileno())
            out.seek(0)
            return code, out.read().decode(), capfd.readouterr().err

    return run
