# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""3MF files: meshes, components, the build's transforms and its unit.

Read according to the 3MF Core Specification 1.3 and its Production Extension (https://3mf.io/spec).
The demands of a file are limited: the archive's entries and their size, the number of placed
meshes. XML document types, and with them entities, are refused, as the specification forbids them.
"""

from __future__ import annotations

import posixpath
import zipfile
import zlib
from array import array
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from xml.parsers import expat

import numpy as np

from ..files import (
    BLOCK,
    DAMAGE_INCOMPLETE,
    DEFAULT_LIMITS,
    FILE_TOO_LARGE,
    FILE_UNREADABLE,
    LINE_MISREAD,
    MAX_FLOAT32,
    MAX_TEXT,
    SPACES,
    Limits,
    damaged,
    parse_number,
    parse_numbers,
    parse_whole,
    parse_xml,
    xml_parser,
)
from ..numerics import Array, NDArray
from ..verdict import FileError, system_reason
from .findings import THREEMF_EXTENSION
from .slicer_parts import NEGATIVE, SlicerPart, SlicerProject

MODEL = "model"  # the type of objects that are parts; supports and helpers have other types
MAX_INSTANCES = 100_000  # meshes that the build places
MAX_DEPTH = 100  # components within components
UNITS = {
    "micron": 1e-6,
    "millimeter": 1e-3,
    "centimeter": 1e-2,
    "inch": 0.0254,
    "foot": 0.3048,
    "meter": 1.0,
}
# Extensions that are read here, or have no effect on the shape, apart from coarser meshes.
_KNOWN = (
    "core/2015/02",
    "material/2015/02",
    "production/2015/06",
    "production/alternatives/2021/04",
    "slice/2015/07",
    "trianglesets/2021/07",
)
_RESOLUTIONS = "slice/2015/07 meshresolution", "alternatives/2021/04 modelresolution"
# Elements of extensions that change the shape, which some writers do not name as required.
_SHAPING = "beamlattice", "booleanshape", "displacementmesh", "levelset"
_PACKAGE = "http://schemas.openxmlformats.org/package/2006/relationships"
_DAMAGE = (
    *(zipfile.BadZipFile, zlib.error, EOFError, expat.ExpatError),
    *(RuntimeError, LookupError, ValueError, OverflowError),
)


@dataclass
class _Object:
    """An object of a model: a mesh, or components (part, id, transform)."""

    name: str
    type: str = MODEL
    points: array = field(default_factory=lambda: array("d"))
    triangles: array = field(default_factory=lambda: array("q"))
    components: list[tuple[str, str, Array]] = field(default_factory=list)


@dataclass(frozen=True)
class Placed:
    """A mesh at one of its places.

    key: the same at all places of a mesh. matrix: (4, 4), for column vectors. hidden: the reason
    why it is no part of what is printed, or empty. item: the number of the build's item that it
    belongs to. is_negative: true if it is cut away from the item's other meshes. print_settings: as
    `SlicerProject.print_settings` returns them; None if they cannot be read.
    """

    name: str
    key: tuple
    points: Array
    triangles: NDArray[np.int64]
    matrix: Array
    hidden: str = ""
    item: int = 0
    is_negative: bool = False
    print_settings: Mapping[str, float] | None = field(default_factory=dict)


def read_3mf(path: str, limits: Limits = DEFAULT_LIMITS) -> tuple[list[Placed], float]:
    """Return the meshes of a file's build, one for each place, in the file's unit; and that unit in
    meters.

    FileError if the file is damaged, beyond limits (`entries`, `unpacked_bytes`), or needs an
    unknown extension.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            return _Package(Path(path), archive, limits).build()
    except _DAMAGE as error:
        reason = "{}: {}".format(type(error).__name__, error).rstrip(": .")
        raise damaged(Path(path), DAMAGE_INCOMPLETE, kind="3MF file", error=reason) from error
    except OSError as error:
        raise FileError(FILE_UNREADABLE, error=system_reason(error)) from error


class _Package:
    """An open archive, and its parts that were read. Names of parts begin with "/" and do not
    depend on case.
    """

    def __init__(self, path: Path, archive: zipfile.ZipFile, limits: Limits) -> None:
        self._path = path
        self._archive = archive
        self._limits = limits
        self._unpacked = 0
        entries = archive.infolist()
        limits.check(path, "entries", len(entries))
        self._names = {"/" + entry.filename.lstrip("/").lower(): entry for entry in entries}
        self._models: dict[str, _Model] = {}
        self._arrays: dict[tuple[str, str], tuple[NDArray, NDArray]] = {}

    def pieces(self, part: str) -> Iterator[bytes]:
        """Yield the bytes of a part, in pieces."""
        with self._archive.open(self._names[part.lower()]) as file:
            while piece := file.read(BLOCK):
                self._unpacked += len(piece)
                self._limits.check(self._path, "unpacked_bytes", self._unpacked)
                yield piece

    def model(self, part: str) -> _Model:
        """Return the model in a part of the archive, which is read once."""
        if part not in self._models:
            self._models[part] = _Model(part, self.pieces(part))
        return self._models[part]

    def build(self) -> tuple[list[Placed], float]:
        """Return the meshes of the build, and its unit in meters."""
        model = self.model(self._root())
        self._project = SlicerProject.read(self._entry)
        placed: list[Placed] = []
        for number, item in enumerate(model.items):
            for mesh in self._placed(*item):
                placed.append(replace(mesh, item=number))
                if len(placed) > MAX_INSTANCES:
                    raise FileError(FILE_TOO_LARGE, limit=MAX_INSTANCES, content="placed meshes")
        return placed, UNITS[model.unit]

    def _entry(self, name: str) -> bytes | None:
        """Return the bytes of an entry, or None if there is none."""
        return b"".join(self.pieces(name)) if name in self._names else None

    def _root(self) -> str:
        """Return the part with the model: the target of the first relationship to one, else the
        usual place.
        """
        targets: list[str] = []

        def start(name: str, values: dict[str, str]) -> None:
            if name == _PACKAGE + " Relationship" and values["Type"].endswith("/3dmodel"):
                targets.append(values["Target"])

        if "/_rels/.rels" in self._names:
            parser = xml_parser(" ")
            parser.StartElementHandler = start
            parse_xml(parser, self.pieces("/_rels/.rels"))
        return posixpath.join("/", *targets[:1]) if targets else "/3D/3dmodel.model"

    def _placed(
        self,
        part: str,
        identifier: str,
        matrix: Array,
        hidden: str,
        above: tuple[tuple[str, str], ...] = (),
        name: str = "",
    ) -> Iterator[Placed]:
        """Yield the meshes of an object and of its components.

        part, identifier: the object's model, and its id there. matrix: (4, 4) the object's place.
        hidden: as in `Placed`. above: the keys of the objects whose component it is, the item's
        object first. name: of the object above, which replaces the object's own.
        """
        key = (part, identifier)
        if key in above:
            raise ValueError("an object is a component of itself")
        if len(above) > MAX_DEPTH:
            raise FileError(FILE_TOO_LARGE, limit=MAX_DEPTH, content="nested components")
        model_object = self.model(part).objects[identifier]
        name = name or model_object.name
        _, top = (*above, key)[0]  # the id of the item's object
        if model_object.type != MODEL and (top, identifier) not in self._project.components:
            hidden = hidden or "its type is {}".format(model_object.type)
        if len(model_object.triangles):
            points, triangles = self._mesh(key, model_object)
            whole = Placed(name or "Object " + identifier, key, points, triangles, matrix, hidden)
            yield from self._parts(key, top, whole)
        for component_part, component_id, local in model_object.components:
            yield from self._placed(
                component_part,
                component_id,
                matrix @ local,
                hidden,
                (*above, key),
                model_object.name or name,
            )

    def _parts(self, key: tuple[str, str], top: str, whole: Placed) -> Iterator[Placed]:
        """Yield the parts of a mesh in the slicer's project.

        key: of the mesh's object. top: the id of the item's object. whole: the mesh without parts.
        """
        project = self._project
        component = project.components.get((top, key[1]))
        parts = project.parts.get(key[1]) or [component or SlicerPart()]
        for part in parts:
            mesh = replace(whole, key=(key, top))  # Its settings depend on the item's object.
            if part.triangles is not None and len(parts) > 1:
                first, last = part.triangles
                if not 0 <= first <= last < len(whole.triangles):
                    raise ValueError("a part has triangles that its object has not")
                used, corners = np.unique(whole.triangles[first : last + 1], return_inverse=True)
                mesh = replace(
                    mesh,
                    key=(key, first),
                    points=whole.points[used],
                    triangles=corners.reshape(-1, 3),
                )
            if part.name and (component or len(parts) > 1):
                mesh = replace(mesh, name=part.name)
            is_negative = part.kind == NEGATIVE
            settings = {**project.objects.get(top, {}), **part.settings}
            try:
                print_settings = project.print_settings(settings)
            except (ValueError, TypeError, OverflowError):
                print_settings = None
            yield replace(
                mesh,
                hidden=mesh.hidden or ("" if is_negative else part.kind),
                is_negative=is_negative,
                print_settings=print_settings,
            )

    def _mesh(self, key: tuple[str, str], model_object: _Object) -> tuple[NDArray, NDArray]:
        """Return (n, 3) points and (m, 3) triangles of an object, the same arrays at each call."""
        if key not in self._arrays:
            points = np.frombuffer(model_object.points, np.float64).reshape(-1, 3)
            triangles = np.frombuffer(model_object.triangles, np.int64).reshape(-1, 3)
            if triangles.size and not (triangles.min() >= 0 and triangles.max() < len(points)):
                raise damaged(
                    self._path,
                    DAMAGE_INCOMPLETE,
                    kind="mesh",
                    error="a vertex beyond {}".format(len(points)),
                )
            self._arrays[key] = points, triangles
        return self._arrays[key]


class _Model:
    """A model part: its objects by id, the items of its build, its unit.

    items: for each the part and the id of its object, its (4, 4) place, and the reason why it is
    hidden, or "".
    """

    def __init__(self, part: str, pieces: Iterator[bytes]) -> None:
        self._part = part
        self._tag = ""  # the last element of the core specification that began
        self.unit = "millimeter"
        self.objects: dict[str, _Object] = {}
        self.items: list[tuple[str, str, Array, str]] = []
        self._object = _Object("")  # the last one that began
        self._spaces: dict[str, str] = {}  # URIs of namespaces by prefix
        parser = xml_parser(" ")
        parser.StartNamespaceDeclHandler = lambda prefix, uri: self._spaces.__setitem__(
            prefix or "", uri or ""
        )
        parser.StartElementHandler = self._start
        try:
            parse_xml(parser, pieces)
        except ValueError as error:  # with the text of a field
            raise FileError(
                LINE_MISREAD,
                line=parser.CurrentLineNumber,
                expected="a value of a 3MF <{}>".format(self._tag),
                text=str(error)[:MAX_TEXT],
            ) from error

    def _start(self, name: str, values: dict[str, str]) -> None:
        """Take an element. name: its namespace and tag."""
        space, _, tag = name.rpartition(" ")
        if not space.endswith("core/2015/02"):
            if tag in _SHAPING:
                raise FileError(THREEMF_EXTENSION, name=space)
            return
        self._tag = tag
        if tag == "vertex":
            self._object.points.extend([_coordinate(values.get(axis, "")) for axis in "xyz"])
        elif tag == "triangle":
            self._object.triangles.extend(
                parse_whole(values.get(corner, "").strip(SPACES)) for corner in ("v1", "v2", "v3")
            )
        elif tag == "object":
            for attribute, value in values.items():
                if attribute.endswith(_RESOLUTIONS) and value != "fullres":
                    raise FileError(THREEMF_EXTENSION, name=attribute.partition(" ")[0])
            self._object = self.objects[values["id"]] = _Object(
                values.get("name", ""), values.get("type", MODEL)
            )
        elif tag == "component":
            self._object.components.append(self._reference(values))
        elif tag == "item":
            is_printed = values.get("printable", "1") not in ("0", "false")
            self.items.append((*self._reference(values), "" if is_printed else "it is not printed"))
        elif tag == "model":
            self.unit = values.get("unit", self.unit)
            if self.unit not in UNITS:
                raise ValueError(self.unit)
            for prefix in values.get("requiredextensions", "").split():
                if not self._spaces.get(prefix, prefix).endswith(_KNOWN):
                    raise FileError(THREEMF_EXTENSION, name=self._spaces.get(prefix, prefix))

    def _reference(self, values: dict[str, str]) -> tuple[str, str, Array]:
        """Return the part and the id of an item's or component's object, and its (4, 4) matrix."""
        path = next(
            (value for name, value in values.items() if name.endswith("production/2015/06 path")),
            self._part,
        )
        matrix = np.eye(4)
        if "transform" in values:
            text = values["transform"]
            numbers = np.array(parse_numbers(text))
            if len(numbers) != 12 or not np.isfinite(numbers).all():
                raise ValueError(text)
            matrix[:3] = numbers.reshape(4, 3).T  # The file's matrices are for row vectors.
        return path, values["objectid"], matrix


def _coordinate(text: str) -> float:
    """Return the number of a text.

    ValueError, with the text, if it is no number or too large for float32.
    """
    value = parse_number(text.strip(SPACES))
    if not abs(value) < MAX_FLOAT32:
        raise ValueError(text)
    return value
