# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the files of robots that we write begin with. Standard library only."""

from __future__ import annotations

import re

MARKER = "Body Moments: {}"  # the first line of what we write, by which an older result is known
_HEAD = re.compile(
    rb"(<\?xml [^>]*>\s*<!-- |#usda 1.0\s*\(\s*\"\"\"|\{\s*\"asset\": \{\s*\"generator\": \")Body Moments: \w+[\s\"]"
)


def is_ours(head: bytes) -> bool:
    """Whether this is the beginning of a file that we have written."""
    return bool(_HEAD.match(head))
