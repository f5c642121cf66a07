# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Beginnings of the files about robots that we write.

Standard library only.
"""

from __future__ import annotations

import re

AUDIT_SCHEMA = "body-moments-audit/1"
AUDIT_COLUMNS = ("file", "link", "severity", "code", "message", "mass", "density", "repaired")
AUDIT_PAGE = "<!doctype html><!-- Body Moments audit -->"  # the first line of a report as a page
MARKER = "Body Moments: {}"  # the first line of what we write, by which an older result is known
_HEAD = re.compile(
    rb"(<\?xml [^>]*>\s*<!-- |#usda 1.0\s*\(\s*\"\"\"|\{\s*\"asset\": \{\s*\"generator\": \")Body Moments: \w+[\s\"]"
)


def is_audit(head: bytes) -> bool:
    """Return whether this is the beginning of an audit's report as a table or a page."""
    first = head.split(b"\n", 1)[0].rstrip(b"\r")
    return first in (",".join(AUDIT_COLUMNS).encode(), AUDIT_PAGE.encode())


def is_ours(head: bytes) -> bool:
    """Return whether this is the beginning of a file that we have written."""
    return bool(_HEAD.match(head))
