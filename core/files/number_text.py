# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers in text: the one definition of a decimal number, for files and options alike.

Standard library only.

Python's `float` and `int` also accept underscores and the digits of every script, and importers
written in C stop at the first letter that does not fit and take the digits before it.
"""

import re

_DECIMAL = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_is_number = re.compile(_DECIMAL + "|[+-]?(?:[nN][aA][nN]|[iI][nN][fF])").fullmatch
_is_whole = re.compile("[+-]?[0-9]+").fullmatch
SPACES = " \t\r\n"  # the white space of XML
_WORD = re.compile("[^{}]+".format(SPACES))


def parse_number(text: str) -> float:
    """Return the value of a decimal number, or of NaN and INF as in XML Schema.

    Raise ValueError with other text.
    """
    if not _is_number(text):
        raise ValueError(text)
    return float(text)


def parse_whole(text: str) -> int:
    """Return the value of a whole number. Raise ValueError with any other text."""
    if not _is_whole(text):
        raise ValueError(text)
    return int(text)


def parse_numbers(text: str) -> list[float]:
    """Return the numbers of a list in XML. Raise ValueError with the first word that is no
    number.
    """
    return [parse_number(word) for word in _WORD.findall(text)]


def parse_wholes(text: str) -> list[int]:
    """Return the whole numbers of a list in XML. Raise ValueError with the first word that is no
    whole number.
    """
    return [parse_whole(word) for word in _WORD.findall(text)]
