# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A parser of untrusted XML."""

from collections.abc import Iterable
from xml.parsers import expat

from ..verdict import FileError
from .findings import XML_ENTITIES


class _DocumentTypeError(Exception):
    pass


def _refuse(*_: object) -> None:
    raise _DocumentTypeError


def xml_parser(namespace_separator: str | None = None) -> expat.XMLParserType:
    """Return a parser without handlers of elements and text, for `parse_xml`. It refuses document
    types. namespace_separator: stands between namespace and tag in names; None leaves prefixes.
    """
    parser = expat.ParserCreate(namespace_separator=namespace_separator)
    parser.buffer_text = True
    parser.StartDoctypeDeclHandler = _refuse
    return parser


def parse_xml(parser: expat.XMLParserType, pieces: Iterable[bytes]) -> None:
    """Parse a document in pieces. FileError at a document type, with which entities could be
    declared.
    """
    try:
        for piece in pieces:
            parser.Parse(piece, False)
        parser.Parse(b"", True)
    except _DocumentTypeError:
        line = parser.CurrentLineNumber
        column = parser.CurrentColumnNumber + 1
        raise FileError(XML_ENTITIES, line=line, column=column) from None
