# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a shape is apart from where it stands: symmetry, signature, registration, libraries of shapes."""

from .flat_signatures import flat_signature
from .library import classify, rank, read_library
from .registration import match
from .signatures import Signature, signature, similarity
from .symmetries import symmetry

__all__ = [
    "Signature",
    "classify",
    "flat_signature",
    "match",
    "rank",
    "read_library",
    "signature",
    "similarity",
    "symmetry",
]
