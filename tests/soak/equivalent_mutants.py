# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mutants that no test can find, as they change nothing that a user, a caller or a file could see; with the reasons."""

from __future__ import annotations

import re

from tests.soak.mutants import Mutant

# names of constants: the reason
NAMES = {
    r"_PER_(BLOCK|BATCH|CHUNK|SLAB|TASK|THREAD|STACK)$|^_?BLOCK|_BLOCK$|_ROWS$|_IN_CACHE$|^SAMPLES$": "how much is "
    "computed or read at a time",
    r"^MAX_CACHED_|_SCRATCH_": "how much is remembered",
    r"^DIRECT_COST$|_TIME$": "how time is estimated",
    r"^NO_[A-Z]+$": "a mark, of which any negative number is one",
}
# places ("module function"), and the mutant's text before and after it: the reason
PATTERNS = [
    (r".*", r".*\*= -1\.0", r".*/= -1\.0", "times -1 is by -1"),
    (r".*", r".*sort\(.*kind=.stable.*", r"((?!kind=).)*", "the order of equal ones, of which any may be first"),
    (r".*triangle_kernel.py PhaseMeans._by_edges", r"np\.divide\(total.*", r".*", "where a value is stored"),
    (r".*offset/walls.py OffsetSolid.moments", r"inward\*\*degree / degree", r".*", "a looser bound"),
    (r".*", r".*copy=False.*", r"((?!copy=).)*", "a copy"),
    (r".*", r".* > MAX_\w+", r"\(.* >= MAX_\w+\)", "a limit of so many or one fewer"),
    (r"core/(polyhedron/any_order|moments/|plane/).*", r"1e-9", r"1\.0000000000000002e-06", "a looser bound"),
    (r".*statics/gradient.py .*", r"4", r"5", "of orders 0, 1 and 2 there are 1, 4 and 10 moments"),
    (r".*triangle_kernel.py _morton_code", r".*", r".*", "the order in which triangles are summed"),
    (r".*polyhedron/third_order.py integrate", r"room.*|count.*", r".*", "how much is computed at a time"),
    (r".*nurbs/patch_topology.py _overlapping_sides", r"0", r"1", "each of the two runs as the other does"),
    (r".*density/threshold.py threshold_body", r"2", r"3", "a reference point near the middle"),
    (r"panels/.*", r".*\balign=True.*", r"((?!align=).)*", "whether the corners between two rows are round"),
    (r"panels/bones.py BonesPanel.draw", r"True", r"False", "whether the corners between two rows are round"),
    (r"panels/rows.py DEFAULT_WIDTH", r"\d+", r"\d+", "a pixel of a panel whose width is not known"),
    (r".*cad/iges.py _Reader._pieces", r"[01]", r"[12]", "how soon a boundary of more pieces than any has is given up"),
]
# functions that make bounds of errors, where a constant factor twice as large gives a bound still
LOOSER = {
    "core/inertia/canonical_frame.py _extreme_directions",
    "core/inertia/canonical_frame.py _normalization",
    "core/inertia/canonical_stack.py _along_axes",
    "core/inertia/reference.py Reference.refer",
    "core/plane/section.py _bounds",
    "core/polyhedron/any_order_kernel.py absolute_sums",
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
    path, function, before, after = mutant.key
    place = "{} {}".format(path, function)
    if place in LOOSER and re.fullmatch(r"\d+\.\d*", before) and after == repr(2.0 * float(before)):
        return "a looser bound"
    for where, old, new, why in PATTERNS:
        if re.fullmatch(where, place) and re.fullmatch(old, before) and re.fullmatch(new, after):
            return why
    return EQUIVALENT.get(mutant.key, "")
