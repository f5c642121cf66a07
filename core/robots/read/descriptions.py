# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Descriptions of robots from files of all formats, recognized by their content.

Optional modules of other programs compose USD that is binary or has several files, and expand xacro. Files that a
description names are checked before a module opens them.
"""

from __future__ import annotations

import codecs
import os
import re
import stat
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from importlib import import_module
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
    USD_NOT_TEXT,
    XACRO_NOT_EXPANDED,
)
from ..formats import AUDITED
from ..stated import Description, Place
from .paths import Roots
from .xml import MAX_ELEMENTS, Node, check_size, parse

_WIDE = {codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16", b"<\0": "utf-16-le", b"\0<": "utf-16-be"}
_ENCODING = re.compile(r"""^(<\?xml\b[^>]*?)\s+encoding\s*=\s*["'][\w.-]*["']""")
_USD = "#usda"
_LAYERED = re.compile(rb"\b(?:references|payload|subLayers)\s*=\s*(?:\[[^\]@]*)?@")
_QUEUE = ThreadPoolExecutor(1)  # One file at a time: xacro keeps what it reads in global variables.
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
            data = _compose_usd(path, roots)
        description = AUDITED[_USD].reader_module.read(data)
    else:
        if path.suffix.lower() == ".xacro":
            parse(data)  # It refuses entities.
            data, is_composed = _expand_xacro(path, roots), True
        description = _xml(data, roots, path)
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


def _xml(data: bytes, roots: Roots, path: Path) -> Description:
    data = _narrow(data)
    root = parse(data)
    if root.tag not in AUDITED:
        raise FileError(DESCRIPTION_UNKNOWN, tag=root.tag)
    if root.tag in ("mujoco", "sdf"):
        _include(root, roots, Path(os.path.realpath(path)))
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


def _include(root: Node, roots: Roots, own: Path) -> None:
    """Replace each `include` of MJCF or SDF by the file's elements, which have no place in the model's own file."""
    is_mjcf = root.tag == "mujoco"
    waiting: list[tuple[Node, int, Roots, tuple[Path, ...]]] = [(root, 1, roots, (own,))]
    included = [own]
    total, count = 0, 0
    while waiting:
        node, depth, beside, within = waiting.pop()
        count += 1
        check_size(depth, count)
        children, pending = [], [(child, beside, within) for child in reversed(node.children)]
        while pending:
            child, here, above = pending.pop()
            if child.tag != "include":
                children.append(child)
                waiting.append((child, depth + 1, here, above))
                continue
            uri = child.find("uri")
            name = child.get("file") if is_mjcf else uri.text.strip() if uri is not None else ""
            place = {"line": child.place.line, "column": child.place.column, "source": child.place.file}
            try:
                path = here.find(name) if is_mjcf else _model_file(name, here)
                data = _bytes(path)
                total += len(data)
                _check_bytes(total)
                found = parse(_narrow(data), str(path))
            except FileError as error:
                raise FileError(INCLUDE_UNREADABLE, name=name, cause=error.finding.as_record(), **place) from error
            # MuJoCo refuses a second time; models of SDF may repeat, but not include themselves.
            if path in (included if is_mjcf else above) or len(included) > MAX_INCLUDES:
                raise FileError(INCLUDE_TWICE, name=name, **place)
            included.append(path)
            there = here if is_mjcf else here.at(path.parent)
            pending += [(below, there, (*above, path)) for below in reversed(found.children)]
        node.children = children


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


def _compose_usd(path: Path, roots: Roots) -> bytes:
    """Return one layer of text with the content of a stage and of all files that it refers to."""
    try:
        sdf, usd = import_module("pxr.Sdf"), import_module("pxr.Usd")
    except ImportError as error:
        raise FileError(USD_NOT_TEXT, name=path.name) from error
    try:
        _check_layers(sdf, path, roots)
        stage = usd.Stage.Open(str(path))
        stage.SetEditTarget(stage.GetSessionLayer())
        instances = [stage.GetPseudoRoot()]
        while instances:  # The content of an instance may hold more of them.
            prims = list(zip(stage.Traverse(), range(MAX_ELEMENTS + 1)))
            if len(prims) > MAX_ELEMENTS:
                raise FileError(FILE_TOO_LARGE, limit=MAX_ELEMENTS, content="elements")
            instances = [prim for prim, _ in prims if prim.IsInstance()]
            for prim in instances:
                prim.SetInstanceable(False)
        return stage.Flatten().ExportToString().encode()
    except RuntimeError as error:  # pxr.Tf.ErrorException is one.
        place, _, reason = str(error).strip().partition("\n")[0].rpartition(" : ")  # a place in pxr's source
        raise FileError(FILE_UNREADABLE, error=(reason or place).strip(" '")) from error


def _check_layers(sdf: Any, path: Path, roots: Roots) -> None:
    """Raise FileError if a stage refers to a file that is missing, or outside of the roots."""
    waiting, seen = [sdf.Layer.FindOrOpen(str(path))], {str(path)}
    while waiting:
        layer = waiting.pop()
        if layer is None:
            raise RuntimeError("no layer of USD")
        layer.Reload()  # The process may hold it as it was.
        for name in layer.GetCompositionAssetDependencies():
            target = layer.ComputeAbsolutePath(name)
            if not name or target in seen:  # A reference within the layer has no name.
                continue
            seen.add(target)
            try:
                roots.find(target.partition("[")[0])  # Packages have their files in brackets.
            except FileError as error:
                before, is_text, _ = Path(layer.realPath).read_bytes().partition(name.encode())
                place = {"source": layer.realPath, "line": before.count(b"\n") + 1 if is_text else 1}
                raise FileError(INCLUDE_UNREADABLE, name=name, cause=error.finding.as_record(), **place) from error
            waiting.append(sdf.Layer.FindOrOpen(target))


class _Included(list):
    """xacro's list of included files, each of which must be within the roots."""

    def __init__(self, roots: Roots) -> None:
        super().__init__()
        self._roots = roots

    def append(self, name: str) -> None:
        """Add a file that is about to be read. FileError if it is outside of the roots."""
        self._roots.find(os.path.abspath(name))
        super().append(name)


def _expand_xacro(path: Path, roots: Roots) -> bytes:
    """Return the XML that xacro makes of a file. It evaluates the file's expressions as Python."""
    try:
        xacro: Any = import_module("xacro")
    except ImportError as error:
        raise FileError(XACRO_NOT_EXPANDED, name=path.name, error=str(error)) from error

    def expand() -> bytes:
        xacro.all_includes = _Included(roots)
        return xacro.process_file(str(path), verbosity=0).toxml("utf-8")

    try:
        return _QUEUE.submit(expand).result()
    except FileError as error:
        raise FileError(INCLUDE_UNREADABLE, name=path.name, cause=error.finding.as_record()) from error
    except (Exception, SystemExit) as error:  # whatever an expression of the file raises
        reason = " ".join(str(error).split())[:200]
        raise FileError(XACRO_NOT_EXPANDED, name=path.name, error=reason) from error
