# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Descriptions of robots from files of all formats, recognized by their content."""

from __future__ import annotations

import codecs
import re
import stat
from pathlib import Path

from ...scans.findings import FILE_MISSING, FILE_NOT_REGULAR
from ...streams.findings import FILE_TOO_LARGE, FILE_UNREADABLE, FILE_WITHOUT_OBJECTS
from ...verdict.finding import FileError, system_reason
from ..findings import DESCRIPTION_INVALID, DESCRIPTION_UNKNOWN, INCLUDE_TWICE, INCLUDE_UNREADABLE, USD_NOT_TEXT
from ..formats import AUDITED
from ..stated import Description
from .paths import Roots
from .xml import NOWHERE, Node, parse

_WIDE = {codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16", b"<\0": "utf-16-le", b"\0<": "utf-16-be"}
_ENCODING = re.compile(r"""^(<\?xml\b[^>]*?)\s+encoding\s*=\s*["'][\w.-]*["']""")
_USD = "#usda"
MAX_DESCRIPTION = 64 << 20  # bytes
MAX_LINKS = 100_000


def read_description(path: Path, roots: Roots | None = None) -> Description:
    """Return a file's robot description. roots: folders of files that an MJCF model includes. FileError if refused."""
    data = _bytes(path)
    if data.startswith(_USD.encode()):
        description = AUDITED[_USD].reader_module.read(data)
    else:
        description = _xml(data, roots or Roots.for_file(path))
    if len(description.links) > MAX_LINKS:
        raise FileError(FILE_TOO_LARGE, limit=MAX_LINKS, content="links")
    if not description.links:
        raise FileError(FILE_WITHOUT_OBJECTS, content="links")
    return description


def _bytes(path: Path) -> bytes:
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            raise FileError(FILE_NOT_REGULAR)
        with open(path, "rb") as file:
            data = file.read(MAX_DESCRIPTION + 1)
    except FileNotFoundError as error:
        raise FileError(FILE_MISSING) from error
    except OSError as error:
        raise FileError(FILE_UNREADABLE, error=system_reason(error)) from error
    _check_bytes(len(data))
    return data


def _check_bytes(count: int) -> None:
    if count > MAX_DESCRIPTION:
        raise FileError(FILE_TOO_LARGE, limit=MAX_DESCRIPTION, content="bytes")


def _xml(data: bytes, roots: Roots) -> Description:
    if data.startswith((b"PXR-USDC", b"PK")):
        raise FileError(USD_NOT_TEXT)
    data = _narrow(data)
    root = parse(data)
    if root.tag not in AUDITED:
        raise FileError(DESCRIPTION_UNKNOWN, tag=root.tag)
    if root.tag == "mujoco":
        _include(root, roots)
    return AUDITED[root.tag].reader_module.read(root, data)


def _narrow(data: bytes) -> bytes:
    """Return UTF-16 XML as UTF-8, so that repairs can be inserted in its bytes; other data unchanged."""
    wide = next((name for start, name in _WIDE.items() if data.startswith(start)), None)
    if wide is None:
        return data
    try:
        return _ENCODING.sub(r"\1", data.decode(wide)).encode()
    except UnicodeError as error:
        raise FileError(DESCRIPTION_INVALID, format="XML", line=1, error=str(error)) from error


def _include(root: Node, roots: Roots) -> None:
    """Replace each `include` of an MJCF model by the file's elements, which have no place in the model's own file."""
    included, total = set(), 0
    waiting = [root]
    while waiting:
        node = waiting.pop()
        children = []
        for child in node.children:
            if child.tag != "include":
                children.append(child)
                waiting.append(child)
                continue
            name = child.get("file")
            try:
                path = roots.find(name)
                data = _bytes(path)
            except FileError as error:
                raise FileError(INCLUDE_UNREADABLE, name=name) from error
            total += len(data)
            _check_bytes(total)
            if path in included:  # MuJoCo refuses that too; so includes cannot go round in a circle.
                raise FileError(INCLUDE_TWICE, name=name)
            included.add(path)
            found = parse(data)
            for below in found.walk():
                below.start = below.end = NOWHERE
            children += found.children
            waiting += found.children
        node.children = children
        if any(child.tag == "include" for child in children):  # The included file includes more.
            waiting.append(node)
