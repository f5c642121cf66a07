# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is reported about a body beside its numbers: findings, refusals, method, health, tolerances.

Nothing here that is offered imports numpy: a process without it can read findings.
"""

from .finding import FileError, Finding, MeasureError, QueryError, Severity
from .method import Method, Source, Verdict

__all__ = [
    "FileError",
    "Finding",
    "MeasureError",
    "Method",
    "QueryError",
    "Severity",
    "Source",
    "Verdict",
]
