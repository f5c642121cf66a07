# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Markers at the beginning of the robot files and audit reports that we write.

Standard library only.
"""

import re

AUDIT_SCHEMA = "body-moments-audit/1"
AUDIT_COLUMNS = ("file", "link", "severity", "code", "message", "mass", "density", "repaired")
AUDIT_PAGE = "<!doctype html><!-- Body Moments audit -->"  # the first line of a report as a page
AUDIT_TEXT = "Body Moments: audit"  # written for one as text or a table
AUDIT_COMMANDS = "::debug::Body Moments: audit"  # begins a report as commands for GitHub
SARIF_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/os/schemas/sarif-schema-2.1.0.json"
_SARIF = re.compile(
    rb'\s*\{\s*"\$schema": "[^"]*sarif[^"]*",[^{]*\{\s*"tool": \{\s*"driver": \{\s*'
    rb'"name": "Body Moments"'
)
MARKER = "Body Moments: {}"  # In the first lines of our robot files, which may be overwritten.
_HEAD = re.compile(
    rb"(<\?xml [^>]*>\s*<!-- |#usda "
    rb"1.0\s*\(\s*\"\"\"|\{\s*\"asset\": \{\s*\"generator\": \")Body Moments: \w+[\s\"]"
)


def is_audit(head: bytes) -> bool:
    """Return whether a file that begins with `head` is an audit report in a form other than
    JSON.
    """
    first = head.split(b"\n", 1)[0].rstrip(b"\r").decode("utf-8", "replace")
    return first in (",".join(AUDIT_COLUMNS), AUDIT_PAGE, AUDIT_TEXT, AUDIT_COMMANDS) or bool(
        _SARIF.match(head)
    )


def is_ours(head: bytes) -> bool:
    """Return whether a file that begins with `head` is a robot file that we have written."""
    return bool(_HEAD.match(head))
