# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the project's command line makes of its words."""

import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parent.parent

PARSED = """\
import sys
sys.path.insert(0, sys.argv[1])
import project
options = project.parse(sys.argv[2:])
values = (getattr(options, name, None) for name in ("subject", "k"))
name = getattr(options, "tool", options.function.__name__)
print(name, options.arguments, *values)
"""


def parsed(*words: str) -> str:
    """Return the parsed command line, from a process of its own: no other module has the name
    there.
    """
    command = [sys.executable, "-c", PARSED, str(TESTS), *words]
    return subprocess.run(command, capture_output=True, encoding="utf-8", check=True).stdout.strip()
