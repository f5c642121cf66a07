# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Descriptions of robots from files of all formats, recognized by their content.

Optional modules of other programs compose USD that is binary or has several files, and expand
xacro. Files that a description names are looked for before a module opens them, and are never
outside of the allowed folders.
"""

from __future__ import annotations

import codecs
import os
import re
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from importlib import import_module
from io import BytesIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

from ...files import FILE_TOO_LARGE, FILE_UNREADABLE, FILE_WITHOUT_OBJECTS
from ...verdict import FileError
from ..findings import (
    DESCRIPTION_INVALID,
    DESCRIPTION_UNKNOWN,
    INCLUDE_UNREADABLE,
    USD_NOT_TEXT,
    XACRO_NOT_EXPANDED,
)
from ..formats import AUDITED
from ..stated import Description, Place
from .roots import Roots, check_bytes, read_bytes
from .xml import MAX_ELEMENTS, Node, check_names, check_size, parse

_WIDE = {
    codecs.BOM_UTF16_LE: "utf-16",
    codecs.BOM_UTF16_BE: "utf-16",
    b"<\0": "utf-16-le",
    b"\0<": "utf-16-be",
}
_ENCODING = re.compile(r"""^(<\?xml\b[^>]*?)\s+encoding\s*=\s*["'][\w.-]*["']""")
_USD = "#usda"
_LAYERED = re.compile(rb"\b(?:references|payload|subLayers)\s*=\s*(?:\[[^\]@]*)?@")
_MARK = "body_moments_place"
_QUEUE = ThreadPoolExecutor(1)  # One file at a time: xacro keeps what it reads in global variables.
MAX_LINKS = 100_000
MAX_INCLUDES = 1000
INCLUDED = "It is included already."


def read_description(path: Path, roots: Roots | None = None) -> Description:
    """Return a file's robot description. roots: folders of files that an MJCF model includes.

    FileError if refused.
    """
    data = read_bytes(path)
    roots = roots or Roots.for_file(path)
    if data.startswith(b"PK") and path.suffix.lower() != ".usdz":
        error = "it is a zip archive, as the MJZ files of MuJoCo are. Unpack it, and audit its .xml"
        raise FileError(FILE_UNREADABLE, error=error)
    is_usd = data.startswith((_USD.encode(), b"PXR-USDC", b"PK"))
    description = _usd(data, roots, path) if is_usd else _xml(data, roots, path)
    if len(description.links) > MAX_LINKS:
        raise FileError(FILE_TOO_LARGE, limit=MAX_LINKS, content="links")
    if description.format in ("urdf", "mjcf"):
        links = [(link.name, link.place) for link in description.links]
        motions = [
            (motion.name, joint.place) for joint in description.joints for motion in joint.motions
        ]
        check_names(description.format, links)
        check_names(description.format, motions)
    # MuJoCo and Gazebo load models without bodies; a URDF needs a link.
    if not description.links and description.format not in ("mjcf", "sdf"):
        raise FileError(FILE_WITHOUT_OBJECTS, content="links")
    return description


def _usd(data: bytes, roots: Roots, path: Path) -> Description:
    reader = AUDITED[_USD].reader_module
    if data.startswith(_USD.encode()) and not _LAYERED.search(data):
        return reader.read(data)
    description = reader.read(_compose_usd(path, roots))
    # The file itself does not hold the inertials.
    nowhere = {"span": None, "place": Place(), "inertial_place": Place()}
    links = tuple(replace(link, **nowhere) for link in description.links)
    return replace(description, links=links)


def _xml(data: bytes, roots: Roots, path: Path) -> Description:
    data = _narrow(data)
    root = _expand_xacro(path, data, roots) if path.suffix.lower() == ".xacro" else parse(data)
    if root.tag not in AUDITED:
        raise FileError(DESCRIPTION_UNKNOWN, tag=root.tag)
    if root.tag in ("mujoco", "sdf"):
        _include(root, roots, Path(os.path.realpath(path)))
    return AUDITED[root.tag].reader_module.read(root, data)


def _narrow(data: bytes) -> bytes:
    """Return UTF-16 XML as UTF-8, so that repairs can be inserted in its bytes; other data
    unchanged.
    """
    wide = next((name for start, name in _WIDE.items() if data.startswith(start)), None)
    if wide is None:
        return data
    try:
        return _ENCODING.sub(r"\1", data.decode(wide)).encode()
    except UnicodeError as error:
        raise FileError(DESCRIPTION_INVALID, format="XML", line=1, error=str(error)) from error


class _Scope(NamedTuple):
    """The files around an element.

    roots: of the names in its file. files: those that it is in, the outermost first. model: those
    of its model of MuJoCo so far.
    """

    roots: Roots
    files: tuple[Path, ...]
    model: list[Path]


def _include(root: Node, roots: Roots, file: Path) -> None:
    """Replace each `include` of MJCF or SDF by the file's elements, which have no place in the
    model's own file.

    Models that MJCF attaches become children of their elements.
    """
    included = _IncludedFiles(root.tag == "mujoco")
    waiting = [(root, 1, _Scope(roots, (file,), [file]))]
    count = 0
    while waiting:
        node, depth, scope = waiting.pop()
        count += 1
        check_size(depth, count)
        children = []
        pending = [(child, scope) for child in reversed(node.children)]
        while pending:
            child, around = pending.pop()
            if child.tag == "include":
                elements, inside = included.include(child, around)
                pending += [(element, inside) for element in reversed(elements)]
                continue
            children.append(child)
            if included.is_mjcf and node.tag == "asset" and child.tag == "model":
                model, inside = included.attach(child, around)
                child.children = [model]
                waiting.append((model, depth + 1, inside))
            else:
                waiting.append((child, depth + 1, around))
        node.children = children


class _IncludedFiles:
    """The files that a description includes, up to a limit of their number and their bytes."""

    def __init__(self, is_mjcf: bool) -> None:
        self.is_mjcf = is_mjcf
        self._count = 0
        self._bytes = 0

    def attach(self, element: Node, scope: _Scope) -> tuple[Node, _Scope]:
        """Return the model of MuJoCo that an element of its assets names. It may be attached
        repeatedly, but not to itself.
        """
        path, model = self._read(element, element.get("file"), scope.roots, scope.files)
        inside = _Scope(scope.roots.at(path.parent), (*scope.files, path), [path])
        return model, inside

    def include(self, element: Node, scope: _Scope) -> tuple[list[Node], _Scope]:
        """Return the elements of the file that an element `include` names."""
        if self.is_mjcf:  # A model of MuJoCo includes a file once.
            path, content = self._read(element, element.get("file"), scope.roots, scope.model)
            scope.model.append(path)
            return content.children, scope._replace(files=(*scope.files, path))
        uri = element.find("uri")
        name = uri.text.strip() if uri else ""
        path, content = self._read(element, name, scope.roots, scope.files)
        # The including file of SDF may place and name a model anew.
        changes = {child.tag: child.text.strip() for child in element.children}
        for model in content.all("model"):
            model.attributes |= {
                key: changes[key] for key in ("name", "placement_frame") if key in changes
            }
            model.children = [*element.all("pose"), *model.children]
        inside = scope._replace(roots=scope.roots.at(path.parent), files=(*scope.files, path))
        return content.children, inside

    def _read(
        self, element: Node, name: str, roots: Roots, refused: Sequence[Path]
    ) -> tuple[Path, Node]:
        """Return the file of a name and its root element. FileError if it cannot be read, or is one
        of the refused files.
        """
        place = element.place.values
        try:
            path = roots.find(name) if self.is_mjcf else _model_file(name, roots)
            data = read_bytes(path)
            self._count += 1
            self._bytes += len(data)
            check_bytes(self._bytes)
            root = parse(_narrow(data), str(path))
            if element.tag == "model" and root.tag != "mujoco":
                raise FileError(DESCRIPTION_UNKNOWN, tag=root.tag)
        except FileError as error:
            cause = error.finding.as_record()
            raise FileError(INCLUDE_UNREADABLE, name=name, cause=cause, **place) from error
        if path in refused or self._count > MAX_INCLUDES:
            raise FileError(INCLUDE_UNREADABLE, name=name, cause=INCLUDED, **place)
        return path, root


def _model_file(name: str, roots: Roots) -> Path:
    """Return the file of a model of SDF: the name's own, or the last one that the model.config of
    its folder names.
    """
    try:
        return roots.find(name)
    except FileError as error:
        try:
            config = roots.find(name.rstrip("/") + "/model.config")
        except FileError:
            raise error from None
    files = [node.text.strip() for node in parse(read_bytes(config)).all("sdf")]
    return roots.at(config.parent).find(files[-1] if files else "model.sdf")


def _compose_usd(path: Path, roots: Roots) -> bytes:
    """Return one layer of text with the content of a stage and of all files that it refers to."""
    try:
        sdf = import_module("pxr.Sdf")
        usd = import_module("pxr.Usd")
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
        # Some messages begin with a place in pxr's source.
        # a place in pxr's source
        place, _, reason = str(error).strip().partition("\n")[0].rpartition(" : ")
        raise FileError(FILE_UNREADABLE, error=(reason or place).strip(" '")) from error


def _check_layers(sdf: Any, path: Path, roots: Roots) -> None:
    """Raise FileError if a stage refers to a file that is missing, or outside of the roots."""
    waiting = [sdf.Layer.FindOrOpen(str(path))]
    seen = {str(path)}
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
                place = {
                    "source": layer.realPath,
                    "line": before.count(b"\n") + 1 if is_text else 1,
                }
                raise FileError(
                    INCLUDE_UNREADABLE, name=name, cause=error.finding.as_record(), **place
                ) from error
            waiting.append(sdf.Layer.FindOrOpen(target))


def _expand_xacro(path: Path, data: bytes, roots: Roots) -> Node:
    """Return the element that xacro makes of a file.

    It evaluates the file's expressions as Python.
    """
    places: dict[str, Place] = {}
    marked = _mark_places(data, "", places)
    try:
        xacro: Any = import_module("xacro")
    except ImportError as error:
        raise FileError(XACRO_NOT_EXPANDED, name=path.name, error=str(error)) from error
    try:
        expanded = _QUEUE.submit(_run_xacro, xacro, path, marked, places, roots).result()
        root = parse(expanded, str(path))
    except FileError as error:
        cause = error.finding.as_record()
        raise FileError(INCLUDE_UNREADABLE, name=path.name, cause=cause) from error
    except (Exception, SystemExit) as error:  # whatever an expression of the file raises
        reason = " ".join(str(error).split())[:200]
        raise FileError(XACRO_NOT_EXPANDED, name=path.name, error=reason) from error
    waiting = [(root, Place())]
    while waiting:
        node, above = waiting.pop()
        node.place = places.get(node.attributes.pop(_MARK, ""), above)
        waiting += [(child, node.place) for child in node.children]
    return root


def _mark_places(data: bytes, file: str, places: dict[str, Place]) -> bytes:
    """Return XML whose elements have an attribute with a key of their place, which is added to
    `places`; macros of xacro pass it on.
    """
    parts = []
    start = 0
    for node in parse(data).walk():
        if ":" in node.tag:  # Elements of xacro itself take no other attributes.
            continue
        end_of_tag = node.start + 1 + len(node.tag.encode())
        parts += [data[start:end_of_tag], b' %s="%d"' % (_MARK.encode(), len(places))]
        places[str(len(places))] = node.place._replace(file=file)
        start = end_of_tag
    return b"".join([*parts, data[start:]])


def _run_xacro(
    xacro: Any, path: Path, marked: bytes, places: dict[str, Place], roots: Roots
) -> bytes:
    """Return the XML that xacro makes of a file with marked places, and of marked files that it
    includes.
    """
    # xacro appends the name of each file that it reads to a list. This one refuses files outside of
    # the roots.
    xacro.all_includes = SimpleNamespace(append=lambda name: roots.find(os.path.abspath(name)))
    parse_file = xacro.parse
    first = iter([marked])  # The first file that xacro parses is the description itself.

    def parse_marked(_: None, name: str) -> Any:
        source = next(first, None)
        if source is None:
            included = _narrow(read_bytes(Path(name)))
            source = _mark_places(included, os.path.abspath(name), places)
        return parse_file(BytesIO(source))

    xacro.parse = parse_marked
    try:
        return xacro.process_file(str(path), verbosity=0).toxml("utf-8")
    finally:
        xacro.parse = parse_file
