# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `blender/write`."""

from ...core.verdict import error, warning

STALE_RESULTS = warning(
    "stale_results", "Out of date: the object changed after it was measured. Measure it again."
)
NO_STORED_RESULTS = error("no_stored_results", "No stored results. Measure the object.")
FAILURE = warning("failure", "{object}: {cause}")
FILE_NOT_WRITTEN = error("file_not_written", "“{file}” cannot be written: {error}.")
