# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Text for terminals and pages, made safe.

Names come from files: a terminal would obey an escape sequence in a name, a line break would forge
a line of output, and characters that set the direction of writing would show another name.
"""

from __future__ import annotations

import sys
import unicodedata

PROGRAM = "body_moments"
# categories: control, surrogates, separators of lines and paragraphs
_ESCAPED = {
    "Cc",
    "Cs",
    "Zl",
    "Zp",
}
_DIRECTIONS = {*"\u061c\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069"}


def visible(text: str) -> str:
    r"""Return the text on one line, with control and direction characters escaped as \x1b, \n,
    \u202e.
    """
    return "".join(
        character.encode("unicode_escape").decode()
        if character in _DIRECTIONS or unicodedata.category(character) in _ESCAPED
        else character
        for character in text
    )


def counted(number: int, name: str) -> str:
    """Return a count with its noun, in the plural unless it is 1, such as "2 links"."""
    return "{:d} {}{}".format(number, name, "" if number == 1 else "s")


def print_message(*parts: object) -> None:
    """Write the program's name and the parts to standard error as one line, separated by colons."""
    sys.stderr.write("{}\n".format(visible(": ".join(map(str, (PROGRAM, *parts))))))
