# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists and sentences of a report: cut, counted, put in a row."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

LISTED = 3  # failures that a report names before it only counts


def one_line(sentences: Iterable[str]) -> str:
    """Sentences of a report, whether or not they end with a period, one after the other."""
    *before, last = sentences
    return "".join(sentence.removesuffix(".") + ". " for sentence in before) + last


def in_a_row(clauses: Sequence[str]) -> str:
    """Clauses of a report with semicolons between them, whether or not they bring their period."""
    return "; ".join([clause.removesuffix(".") for clause in clauses[:-1]] + list(clauses[-1:]))


def listed(texts: Iterable[str], most: int = LISTED) -> list[str]:
    """The first ones, and how many more there are."""
    texts = list(texts)
    more = ["and {:d} more".format(len(texts) - most)] if len(texts) > most else []
    return texts[:most] + more


def counted(count: int) -> str:
    """ "1 object", "2 objects"."""
    return "1 object" if count == 1 else "{:d} objects".format(count)
