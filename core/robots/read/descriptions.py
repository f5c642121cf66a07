# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Descriptions of robots from files of all formats, recognized by their content."""

from __future__ import annotations

import codecs
import re
import stat
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...scans.findings import FILE_MISSING, FILE_NOT_REGULAR
from ...streams.findings import FILE_TOO_LARGE, FILE_UNREADABLE, FILE_WITHOUT_OBJECTS
from ...verdict.finding import FileError, system_reason
from ..findings import (
    DESCRIPTION_INVALID,
    DESCRIPTION_UNKNOWN,
    INCLUDE_TWICE,
    INCLUDE_UNREADABLE,
    MESH_ON_NETWORK,
)
from ..formats import AUDITED
from ..stated import Description, Place
from .composed import compose_usd, expand_xacro
from .paths import Roots
from .xml import Node, parse

_WIDE = {codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16", b"<\0": "utf-16-le", b"\0<": "utf-16-be"}
_ENCODING = re.compile(r"""^(<\?xml\b[^>]*?)\s+encoding\s*=\s*["'][\w.-]*["']""")
_USD = "#usda"
_LAYERED = re.compile(rb"\b(?:references|payload|subLayers)\s*=\s*(?:\[[^\]@]*)?@")
MAX_DESCRIPTION = 64 << 20  # bytes
MAX_LINKS = 100_000
MAX_INCLUDES = 1000


def read_description(path: Path, roots: Roots | None = None) -> Description:
    """Return a file's robot description. roots: folders of files that an MJCF model includes. FileError if refused."""
    data, roots = _bytes(path), roots or Roots.for_file(path)
    is_text = data.startswith(_USD.encode())
    is_binary = data.startswith((b"PXR-USDC", b"PK"))
    is_composed = is_binary or is_text and _LAYERED.search(data) is not None
    if is_text or is_binary:
        if is_composed:
            data = compose_usd(path, roots)
        description = AUDITED[_USD].reader_module.read(data)
    else:
        if path.suffix.lower() == ".xacro":
            parse(data)  # It refuses entities.
            data, is_composed = expand_xacro(path, roots), True
        description = _xml(data, roots)
    if is_composed:  # The file itself does not hold the inertials.
        nowhere = {"span": None, "place": Place(), "inertial_place": Place()}
        description = replace(description, links=tuple(replace(link, **nowhere) for link in description.links))
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
    data = _narrow(data)
    root = parse(data)
    if root.tag not in AUDITED:
        raise FileError(DESCRIPTION_UNKNOWN, tag=root.tag)
    if root.tag in ("mujoco", "sdf"):
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
    """Replace each `include` of MJCF or SDF by the file's elements, which have no place in the model's own file."""
    is_mjcf = root.tag == "mujoco"
    total = 0
    waiting: list[tuple[Node, Roots, tuple[Path, ...]]] = [(root, roots, ())]
    included: set[Path] = set()
    while waiting:
        node, here, above = waiting.pop()
        children = []
        for child in node.children:
            if child.tag != "include":
                children.append(child)
                waiting.append((child, here, above))
                continue
            uri = child.find("uri")
            name = child.get("file") if is_mjcf else uri.text.strip() if uri is not None else ""
            if not is_mjcf and name.startswith(("http:", "https:")):
                raise FileError(MESH_ON_NETWORK, name=name)
            try:
                path = here.find(name) if is_mjcf else _model_file(name, here)
                data = _bytes(path)
            except FileError as error:
                raise FileError(INCLUDE_UNREADABLE, name=name, cause=error.finding.as_record(), **_at(child)) from error
            total += len(data)
            _check_bytes(total)
            # MuJoCo refuses a second time; models of SDF may repeat, but not include themselves.
            if path in (included if is_mjcf else above) or len(included) > MAX_INCLUDES:
                raise FileError(INCLUDE_TWICE, name=name, **_at(child))
            included.add(path)
            try:
                found = parse(_narrow(data), str(path))
            except FileError as error:
                raise FileError(INCLUDE_UNREADABLE, name=name, cause=error.finding.as_record(), **_at(child)) from error
            there = here if is_mjcf else here.at(path.parent)
            children += found.children
            waiting += [(below, there, (*above, path)) for below in found.children]
        node.children = children
        if any(child.tag == "include" for child in children):  # The included file includes more.
            waiting.append((node, here, above))


def _at(node: Node) -> dict[str, Any]:
    return {"line": node.place.line, "column": node.place.column}


def _model_file(name: str, roots: Roots) -> Path:
    """Return the file of a model of SDF: the name's own, or the last one that the model.config of its folder names."""
    try:
        return roots.find(name)
    except FileError as error:
        try:
            config = roots.find(name.rstrip("/") + "/model.config")
        except FileError:
            raise error from None
    files = [node.text.strip() for node in parse(_bytes(config)).all("sdf")]
    return roots.at(config.parent).find(files[-1] if files else "model.sdf")
