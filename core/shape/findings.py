# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings of `core/shape`."""

from ..verdict import error

LIBRARY_LINE = error(
    "library_line",
    "{file}: line {line} is not a body_moments document. Write the library with --format jsonl.",
)
NO_SHAPE = "The body has no shape; see the findings of its record"
RECORD_WITHOUT_SIGNATURE = error("record_without_signature", "{name}: no signature. {remedy:word}.")
SIGNATURE_INVALID = error("signature_invalid", "The signature {fault:word}.")
