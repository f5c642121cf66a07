# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The project's commands take the options that their texts name."""

import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parent.parent
PARSED = """\
import sys
sys.path.insert(0, sys.argv[1])
import project
options = project.parse(sys.argv[2:])
values = (getattr(options, name, None) for name in ("subject", "k"))
print(options.function.__name__, options.arguments, *values)
"""


def parsed(*words: str) -> str:
    """Return the parsed command line, from a process of its own: no other module has the name
    there.
    """
    command = [sys.executable, "-c", PARSED, str(TESTS), *words]
    return subprocess.run(command, capture_output=True, encoding="utf-8", check=True).stdout.strip()


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["benchmark"], "benchmark [] None None"),
        (["benchmark", "--quick"], "benchmark ['--quick'] None None"),
        (["soak", "--minutes", "2", "kills"], "soak ['--minutes', '2', 'kills'] None None"),
        (["soak", "kills", "--seed", "3"], "soak ['kills', '--seed', '3'] None None"),
        (["test", "solid", "-k", "cube"], "test [] solid cube"),
        (["test", "solid", "--", "-x", "--lf"], "test ['-x', '--lf'] solid None"),
        (["test", "core/solid"], "test [] core/solid None"),
    ],
    ids=" ".join,
)
def test_options_reach_the_called_program(words, expected):
    assert parsed(*words) == expected
