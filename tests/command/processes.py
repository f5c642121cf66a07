# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line in a process of its own."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent

SCRIPT = str(ROOT / "operators" / "batch.py")

BLENDER = os.environ.get("BLENDER") or shutil.which("blender")

in_blender = pytest.mark.skipif(
    not BLENDER,
    reason="needs a real Blender: put one on the PATH or name it with the variable BLENDER",
)


def process(*words, env=None, **options):
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "timeout": 1200, **options}
    return subprocess.run(list(map(str, words)), env={**os.environ, **(env or {})}, **options)


def script(*words, **options):
    """The script in this Python."""
    return process(sys.executable, SCRIPT, *words, **options)
