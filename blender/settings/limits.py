# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The limits of reading scans, which an environment variable changes for the panel and the command line alike."""

from __future__ import annotations

import os

from ...core.scans.limits import Limits

VARIABLE = "BODY_MOMENTS_LIMITS"


def scan_limits() -> Limits:
    """Return the limits of this process, or raise MeasureError if the variable cannot be parsed."""
    return Limits.parse(os.environ.get(VARIABLE, ""))
