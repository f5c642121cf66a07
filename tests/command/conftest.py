# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixtures of the tests that need Blender."""

import os

import pytest
from body_moments.operators import batch

from tests.in_blender import reported  # noqa: F401


@pytest.fixture
def main(tmp_path_factory, capfd):
    """The command line in this process: words to exit code, output and errors."""

    def run(*words):
        from tests.blender.batch_files import in_process  # needs Blender

        kept = os.dup(1)
        with open(tmp_path_factory.mktemp("main") / "standard output", "wb+") as out:
            try:
                code = batch.main(in_process(*words), channel=out.fileno())
            finally:
                os.dup2(kept, 1)
                os.close(kept)
            out.seek(0)
            said = capfd.readouterr().err
            assert "Traceback" not in said, said
            return code, out.read().decode(), said

    return run
