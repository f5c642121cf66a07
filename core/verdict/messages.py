# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is told of a body whose surface had to be mended, with the remedies."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

LISTED = 8  # numbers of faces that a sentence names


def counted(numbers: NDArray[np.integer], one: str, many: str, names: Callable[[NDArray], str]) -> str:
    """A sentence about numbered things: `one` takes the name, `many` how many there are and the names."""
    return one.format(names(numbers)) if len(numbers) == 1 else many.format(len(numbers), names(numbers))


def listed(numbers: NDArray[np.integer]) -> str:
    """The first few numbers, as text."""
    text = ", ".join(str(int(number)) for number in numbers[:LISTED])
    return text + ", …" if len(numbers) > LISTED else text


def turned(flipped: NDArray, inverted: NDArray, number: int, names: Callable[[NDArray], str]) -> list[str]:
    """About faces, and parts of `number` ones, that were turned."""
    notes = []
    if len(flipped):
        notes.append(
            counted(
                flipped,
                "Face {:s} is flipped and was measured as if turned. Recalculate Outside mends it.",
                "{:d} faces are flipped and were measured as if turned: {:s}. Recalculate Outside mends them.",
                names,
            )
        )
    if len(inverted):
        notes.append(
            "{:s} inside out, and measured as if turned. Recalculate Outside mends that.".format(
                "It is"
                if number == 1
                else "One of its parts is"
                if len(inverted) == 1
                else "{:d} of its {:d} parts are".format(len(inverted), number)
            )
        )
    return notes


def capped(flat: int, curved: int, share: float) -> list[str]:
    """About caps: how many are flat and curved, and their share of the area."""
    if flat + curved == 0:
        return []
    if flat + curved == 1:
        return [
            "One {:s} hole was capped ({:.3g} % of the area). Fill it for a closed body.".format(
                "curved" if curved else "flat", 100.0 * share
            )
        ]
    return [
        "{:d} holes were capped ({:d} flat, {:d} curved; {:.3g} % of the area). Fill them for a closed body.".format(
            flat + curved, flat, curved, 100.0 * share
        )
    ]


def compared(nested: int, overlapping: int, flat: int, unchecked: int) -> list[str]:
    """About parts that count twice or not at all; unchecked: pairs of them that nobody compared."""
    notes = []
    if nested:
        notes.append(
            "{:s} inside another one, so that space counts twice. Flip what is a cavity, or measure the union.".format(
                "One outward shell lies" if nested == 1 else "{:d} outward shells lie".format(nested)
            )
        )
    if overlapping:
        notes.append(
            "{:d} parts overlap, so that what they share counts twice. Measure the union instead.".format(overlapping)
        )
    if flat:
        notes.append(
            "{:s} flat and adds no volume.".format("One part is" if flat == 1 else "Each of {:d} parts is".format(flat))
        )
    if unchecked:
        notes.append(
            "Whether {:d} pairs of its parts overlap was not checked, as it would have taken too long.".format(
                unchecked
            )
        )
    return notes
