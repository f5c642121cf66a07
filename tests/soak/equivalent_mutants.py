# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mutants that no test can find, as they change nothing that a user, a caller or a file could see; with the reasons."""

from __future__ import annotations

import re

from tests.soak.mutants import Mutant

# names of constants: the reason
NAMES = {
    r"_PER_(BLOCK|BATCH|CHUNK|SLAB|TASK|THREAD|STACK)$|^_?BLOCK|_BLOCK$": "how much is computed at a time",
    r"^MAX_CACHED_|_SCRATCH_": "how much is remembered",
}
# (module, function, before, after): the reason
EQUIVALENT: dict[tuple[str, str, str, str], str] = {
    (
        "core/density/smooth_threshold.py",
        "_combine",
        "body.mass is None or other.mass is None",
        "(other.mass is None)",
    ): "both have a mass, or neither",
}


def reason(mutant: Mutant) -> str:
    """Why it changes nothing; "" for all others."""
    if mutant.is_imported:
        name = mutant.function.rpartition(".")[2]
        for pattern, why in NAMES.items():
            if re.search(pattern, name):
                return why
    return EQUIVALENT.get(mutant.key, "")
