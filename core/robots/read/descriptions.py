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
import stat
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from importlib import import_module
from io import BytesIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from ...files import (
    FILE_MISSING,
    FILE_TOO_LARGE,
    FILE_UNREADABLE,
    FILE_WITHOUT_OBJECTS,
    NOT_REGULAR,
)
from ...verdict import FileError, system_reason
from ..findings import (
    DESCRIPTION_INVALID,
    DESCRIPTION_UNKNOWN,
    INCLUDE_UNREADABLE,
    MESH_MISSING,
    MESH_OUTSIDE,
    USD_NOT_TEXT,
    XACRO_NOT_EXPANDED,
)
from ..formats import AUDITED
from ..stated import Description, Place
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
MAX_DESCRIPTION = 64 << 20  # bytes
MAX_LINKS = 100_000
MAX_INCLUDES = 1000
INCLUDED = "It is included already."
# Schemes of one letter are drives.
_SCHEME = re.compile(r"([A-Za-z][A-Za-z0-9+.-]+):(?://)?(.*)", re.DOTALL)
PATHS = "ROS_PACKAGE_PATH"
MAX_DEPTH = 3  # Levels of folders below a root that are searched for a package.


@dataclass(frozen=True)
class Roots:
    """Folders that files may be read from. base: that of the description. anywhere: True if all
    folders are allowed.
    """

    folders: tuple[Path, ...]
    anywhere: bool = False
    base: Path | None = None

    @classmethod
    def for_file(cls, file: Path, more: Sequence[Path] = (), anywhere: bool = False) -> Roots:
        """Return the roots of a description: its package's folder or else that above its own,
        `more`, and ROS's.
        """
        folder = Path(os.path.realpath(file)).parent
        packages = (
            above for above in (folder, *folder.parents) if os.path.isfile(above / "package.xml")
        )
        paths = [
            path for path in os.environ.get(PATHS, "").split(os.pathsep) if os.path.isabs(path)
        ]
        added = [Path(os.path.realpath(path)) for path in (*more, *paths)]
        return cls((next(packages, folder.parent), *added), anywhere, folder)

    def at(self, base: Path) -> Roots:
        """Return the same roots for names in a file of another folder."""
        return replace(self, base=base)

    def find(self, name: str) -> Path:
        """Return the file that a description names; raise FileError if it is missing, not allowed,
        or on a network.
        """
        name = name.replace("\\", "/")
        match = _SCHEME.fullmatch(name)
        scheme, rest = (match[1].lower(), match[2]) if match else ("", name)
        if scheme not in ("", "package", "model", "file"):
            raise FileError(MESH_OUTSIDE, name=name)
        is_outside = False
        for path in self._candidates(scheme, rest):
            try:
                real = Path(os.path.realpath(path))
            except (OSError, ValueError):  # no name that the system knows
                continue
            # False if the system refuses the name, as one that is too long
            if not os.path.isfile(real):
                continue
            if self.anywhere or any(real.is_relative_to(folder) for folder in self.folders):
                return real
            is_outside = True
        raise FileError(MESH_OUTSIDE if is_outside else MESH_MISSING, name=name)

    def _candidates(self, scheme: str, rest: str) -> Iterator[Path]:
        """Yield possible paths.

        A package's name may be that of a root, of a folder in it, or of neither.
        """
        if scheme in ("package", "model"):
            rest = rest.lstrip("/")  # Other readers join it so with their folders.
            package, _, inside = rest.partition("/")
            for folder in self.folders:
                if folder.name == package or _package_name(folder) == package:
                    yield folder / inside
                yield folder / rest
                yield folder / inside
            for folder in self.folders[1:]:
                yield from (found / inside for found in _folders_named(folder, package))
            if self.base is not None:
                yield from (above.parent / rest for above in (self.base, *self.base.parents))
        elif os.path.isabs(rest):
            yield Path(rest)
        else:
            for folder in (self.base, *self.folders):
                if folder is not None:
                    yield folder / rest
            # Of a description that was copied elsewhere: below its package.
            yield from (folder / rest.lstrip("./") for folder in self.folders)


def _package_name(folder: Path) -> str:
    """Return the name that the package.xml of a folder states, "" if it has none."""
    try:
        with open(folder / "package.xml", encoding="utf-8", errors="replace") as file:
            match = re.search(r"<name>\s*([\w.-]+)\s*</name>", file.read(1 << 16))
    except (OSError, ValueError):
        return ""
    return match[1] if match else ""


def _folders_named(root: Path, name: str) -> Iterator[Path]:
    """Yield the folders with a name, a few levels below a root."""
    for folder, folders, _ in os.walk(root):
        if name in folders:
            yield Path(folder, name)
        if len(Path(folder).relative_to(root).parts) >= MAX_DEPTH:
            folders.clear()


def read_description(path: Path, roots: Roots | None = None) -> Description:
    """Return a file's robot description. roots: folders of files that an MJCF model includes.

    FileError if refused.
    """
    data = _bytes(path)
    roots = roots or Roots.for_file(path)
    is_text = data.startswith(_USD.encode())
    is_archive = data.startswith(b"PK")
    if is_archive and path.suffix.lower() != ".usdz":
        error = "it is a zip archive, as the MJZ files of MuJoCo are. Unpack it, and audit its .xml"
        raise FileError(FILE_UNREADABLE, error=error)
    is_binary = is_archive or data.startswith(b"PXR-USDC")
    is_composed = is_binary or is_text and _LAYERED.search(data) is not None
    if is_text or is_binary:
        description = AUDITED[_USD].reader_module.read(
            _compose_usd(path, roots) if is_composed else data
        )
    else:
        description = _xml(data, roots, path)
    if is_composed:  # The file itself does not hold the inertials.
        nowhere = {"span": None, "place": Place(), "inertial_place": Place()}
        description = replace(
            description, links=tuple(replace(link, **nowhere) for link in description.links)
        )
    if len(description.links) > MAX_LINKS:
        raise FileError(FILE_TOO_LARGE, limit=MAX_LINKS, content="links")
    if description.format in ("urdf", "mjcf"):
        links = [(link.name, link.place) for link in description.links]
        joints = [(one.name, joint.place) for joint in description.joints for one in joint.motions]
        check_names(description.format, links)
        check_names(description.format, joints)
    # MuJoCo and Gazebo load models without bodies; a URDF needs a link
    if not description.links and description.format not in ("mjcf", "sdf"):
        raise FileError(FILE_WITHOUT_OBJECTS, content="links")
    return description


def _bytes(path: Path) -> bytes:
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            raise FileError(FILE_UNREADABLE, error=NOT_REGULAR)
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


def _include(root: Node, roots: Roots, own: Path) -> None:
    """Replace each `include` of MJCF or SDF by the file's elements, which have no place in the
    model's own file.

    Models that MJCF attaches become children of their elements.
    """
    is_mjcf = root.tag == "mujoco"
    waiting: list[tuple[Node, int, Roots, tuple[Path, ...], list[Path]]] = [
        (root, 1, roots, (own,), [own])
    ]
    total = 0
    count = 0
    files = 0
    while waiting:
        node, depth, beside, within, model = waiting.pop()
        count += 1
        check_size(depth, count)
        children = []
        pending = [(child, beside, within) for child in reversed(node.children)]
        while pending:
            child, here, above = pending.pop()
            is_attached = is_mjcf and node.tag == "asset" and child.tag == "model"
            if child.tag != "include" and not is_attached:
                children.append(child)
                waiting.append((child, depth + 1, here, above, model))
                continue
            name = child.get("file") if is_mjcf else getattr(child.find("uri"), "text", "").strip()
            place = {
                "line": child.place.line,
                "column": child.place.column,
                "source": child.place.file,
            }
            try:
                path = here.find(name) if is_mjcf else _model_file(name, here)
                data = _bytes(path)
                total = total + len(data)
                files = files + 1
                _check_bytes(total)
                found = parse(_narrow(data), str(path))
                if is_attached and found.tag != root.tag:
                    raise FileError(DESCRIPTION_UNKNOWN, tag=found.tag)
            except FileError as error:
                raise FileError(
                    INCLUDE_UNREADABLE, name=name, cause=error.finding.as_record(), **place
                ) from error
            # A model of MuJoCo includes a file once; all models may repeat, but not include
            # themselves.
            if path in (model if is_mjcf and not is_attached else above) or files > MAX_INCLUDES:
                raise FileError(INCLUDE_UNREADABLE, name=name, cause=INCLUDED, **place)
            there = here if is_mjcf and not is_attached else here.at(path.parent)
            inside = (*above, path)
            if is_attached:
                child.children = [found]
                children.append(child)
                waiting.append((found, depth + 1, there, inside, [path]))
            else:
                model.append(path)
                # The including file of SDF may place and name it anew.
                for inner in found.all("model"):
                    stated = {one.tag: one.text.strip() for one in child.children}
                    inner.attributes |= {
                        name: stated[name] for name in ("name", "placement_frame") if name in stated
                    }
                    inner.children = [*child.all("pose"), *inner.children]
                pending += [(below, there, inside) for below in reversed(found.children)]
        node.children = children


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
    files = [node.text.strip() for node in parse(_bytes(config)).all("sdf")]
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


def _marked(data: bytes, file: str, places: dict[str, Place]) -> bytes:
    """Return XML whose elements have the key of their place as an attribute, which macros of xacro
    pass on.
    """
    parts = []
    end = 0
    for node in parse(data).walk():
        if ":" not in node.tag:  # Elements of xacro itself take no other attributes.
            start = end
            end = node.start + 1 + len(node.tag.encode())
            parts += [data[start:end], b' %s="%d"' % (_MARK.encode(), len(places))]
            places[str(len(places))] = node.place._replace(file=file)
    return b"".join([*parts, data[end:]])


def _expand_xacro(path: Path, data: bytes, roots: Roots) -> Node:
    """Return the element that xacro makes of a file.

    It evaluates the file's expressions as Python.
    """
    places: dict[str, Place] = {}
    marked = _marked(data, "", places)
    try:
        xacro: Any = import_module("xacro")
    except ImportError as error:
        raise FileError(XACRO_NOT_EXPANDED, name=path.name, error=str(error)) from error

    def expand() -> bytes:
        # xacro appends the name of each file that it reads to a list. This one refuses files
        # outside of the roots.
        xacro.all_includes = SimpleNamespace(append=lambda name: roots.find(os.path.abspath(name)))
        parse_file = xacro.parse
        files = iter([marked])

        def parse_marked(_: None, name: str) -> Any:
            source = next(files, None) or _marked(
                _narrow(_bytes(Path(name))), os.path.abspath(name), places
            )
            return parse_file(BytesIO(source))

        xacro.parse = parse_marked
        try:
            return xacro.process_file(str(path), verbosity=0).toxml("utf-8")
        finally:
            xacro.parse = parse_file

    try:
        root = parse(_QUEUE.submit(expand).result(), str(path))
    except FileError as error:
        raise FileError(
            INCLUDE_UNREADABLE, name=path.name, cause=error.finding.as_record()
        ) from error
    except (Exception, SystemExit) as error:  # whatever an expression of the file raises
        reason = " ".join(str(error).split())[:200]
        raise FileError(XACRO_NOT_EXPANDED, name=path.name, error=reason) from error
    waiting = [(root, Place())]
    while waiting:
        node, above = waiting.pop()
        node.place = places.get(node.attributes.pop(_MARK, ""), above)
        waiting += [(child, node.place) for child in node.children]
    return root
