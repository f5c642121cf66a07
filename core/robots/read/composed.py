# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Descriptions that other programs' modules compose: USD that is binary or has several files, and xacro.

The modules are optional. Files that a description names are checked before a module opens them.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module
from pathlib import Path
from typing import Any

from ...streams.findings import FILE_TOO_LARGE, FILE_UNREADABLE
from ...verdict.finding import FileError
from ..findings import INCLUDE_UNREADABLE, USD_NOT_TEXT, XACRO_NOT_EXPANDED
from .paths import Roots
from .xml import MAX_ELEMENTS

_QUEUE = ThreadPoolExecutor(1)  # One file at a time: xacro keeps what it reads in global variables.


def compose_usd(path: Path, roots: Roots) -> bytes:
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


def expand_xacro(path: Path, roots: Roots) -> bytes:
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
