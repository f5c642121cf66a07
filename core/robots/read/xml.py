# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reader of untrusted XML: elements with their byte positions in the file.

Document types, and with them entities, are refused.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar, cast
from xml.parsers import expat

import numpy as np

from ...files import FILE_TOO_LARGE, parse_numbers, parse_xml, xml_parser
from ...numerics import Array, NDArray
from ...verdict import FileError, Finding, finding
from ..findings import DESCRIPTION_INVALID, DESCRIPTION_NUMBER
from ..model import Shape
from ..stated import ENTRIES, Place, StatedLink, StatedShape

MAX_ELEMENTS = 1_000_000
MAX_DEPTH = 200
FLAT_KINDS = ("empty", "plane", "heightmap", "hfield", "image")  # shapes of no volume, and terrain
LEAST_LENGTH = 1e-14  # shorter directions are rounding errors, also for MuJoCo
NOWHERE = -1  # The position of elements from another file.
Value = TypeVar("Value")
_TAG = re.compile(rb"""(?:[^>"']|"[^"]*"|'[^']*')*>""")  # Quoted attributes may contain ">".


@dataclass(eq=False)
class Node:
    """One element. start, end: range of its bytes in the file, or NOWHERE. place: its beginning in
    its file.
    """

    tag: str
    attributes: dict[str, str]
    start: int
    place: Place = Place()
    end: int = NOWHERE
    text: str = ""
    children: list[Node] = field(default_factory=list)

    def find(self, *path: str) -> Node | None:
        """Return the first element along a path of tags, None if there is none."""
        node: Node | None = self
        for tag in path:
            node = (
                next((child for child in node.children if child.tag == tag), None) if node else None
            )
        return node

    def all(self, tag: str) -> list[Node]:
        """Return the direct children with a tag."""
        return [child for child in self.children if child.tag == tag]

    def walk(self) -> Iterator[Node]:
        """Yield the element and all elements below it, in the order of the file."""
        waiting: list[Node] = [self]
        while waiting:
            node = waiting.pop()
            yield node
            waiting.extend(reversed(node.children))

    def get(self, name: str, default: str = "") -> str:
        """Return the text of an attribute, else the default."""
        return self.attributes.get(name, default)

    def unreadable(self, text: str) -> Finding:
        """Return the finding about a wrong number.

        It names the only element with that text, else this one.
        """
        holders = [
            node
            for node in self.walk()
            if any(
                text in (words, *words.split()) for words in (node.text, *node.attributes.values())
            )
        ]
        holder = holders[0] if len(holders) == 1 else self
        line, column, file = holder.place
        source: dict[str, Any] = {"source": file} if file else {}
        return finding(
            DESCRIPTION_NUMBER, text=text, element=holder.tag, line=line, column=column, **source
        )


def check_size(depth: int, count: int) -> None:
    """Raise FileError if a file nests too many elements, or has too many."""
    if depth > MAX_DEPTH:
        raise FileError(FILE_TOO_LARGE, limit=MAX_DEPTH, content="nested elements")
    if count > MAX_ELEMENTS:
        raise FileError(FILE_TOO_LARGE, limit=MAX_ELEMENTS, content="elements")


def check_names(form: str, named: Iterable[tuple[str, Place]]) -> None:
    """Raise FileError if two elements of a kind have one name. "" is none."""
    names: set[str] = set()
    for name, place in named:
        if name in names:
            error = "“{}” is the name of two elements. Give each its own".format(name)
            raise FileError(DESCRIPTION_INVALID, format=form.upper(), error=error, **place.values)
        if name:
            names.add(name)


def _end_of_tag(data: bytes, start: int) -> int:
    """Return the index behind the tag that begins at `start`; expat has made sure that it ends."""
    return cast("re.Match[bytes]", _TAG.match(data, start)).end()


def parse(data: bytes, file: str = "") -> Node:
    """Return the root element of an XML document.

    FileError if it is invalid, too large, or has a doctype.

    file: the name of an included file, whose elements have no bytes in the description's own.
    """
    document = Node("", {}, 0)
    parser = xml_parser()
    waiting = [document]
    counts = itertools.count(1)

    def start(tag: str, attributes: dict[str, str]) -> None:
        check_size(len(waiting), next(counts))
        place = Place(parser.CurrentLineNumber, parser.CurrentColumnNumber + 1, file)
        node = Node(tag, attributes, parser.CurrentByteIndex, place)
        waiting[-1].children.append(node)
        waiting.append(node)

    def end(_tag: str) -> None:
        node = waiting.pop()
        place = parser.CurrentByteIndex
        # The index is behind <a/>, but at </a> of other elements.
        is_empty = data[place - 2 : place] == b"/>" and place == _end_of_tag(data, node.start)
        node.end = place if is_empty else _end_of_tag(data, place)

    def add_text(text: str) -> None:
        waiting[-1].text += text

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = add_text
    try:
        parse_xml(parser, [data])
    except (expat.ExpatError, ValueError, LookupError) as error:
        reason = " ".join(str(error).partition(": line")[0].split())
        line, column = parser.ErrorLineNumber, parser.ErrorColumnNumber + 1
        raise FileError(
            DESCRIPTION_INVALID, format="XML", line=line, column=column, error=reason
        ) from error
    if file:
        for node in document.walk():
            node.start = node.end = NOWHERE
    return document.children[0]  # expat has seen that there is one


def numbers(text: str, count: int, default: Sequence[float] = ()) -> Array:
    """Return the (count,) numbers of a text, the default if it is empty.

    ValueError, with the text, if it is wrong.
    """
    values = parse_numbers(text) or default
    if len(values) != count:
        raise ValueError(text)
    return np.array(values, np.float64)


def number(text: str, default: float | None = None) -> float:
    """Return the number of a text, the default if it is empty.

    ValueError, with the text, if it is wrong.
    """
    return float(numbers(text, 1, () if default is None else (default,))[0])


def direction(vector: NDArray, text: str) -> Array:
    """Return a vector of length 1. ValueError, with its text, if it has no direction."""
    length = np.linalg.norm(vector)
    if not LEAST_LENGTH < length < np.inf:
        raise ValueError(text)
    return vector / length


def axis_of(text: str, default: Sequence[float]) -> Array:
    """Return the (3,) unit vector of a text, the default if it is empty."""
    return direction(numbers(text, 3, default), text)


def attempt(
    findings: list[Finding], node: Any, read: Callable[..., Value], *more: object
) -> Value | None:
    """Return the result of `read` for an element or prim; None without one, or, with a finding, if
    a number is wrong.
    """
    if node is None:
        return None
    try:
        with np.errstate(all="ignore"):  # wrong numbers are refused afterwards
            return read(node, *more)
    except ValueError as error:
        findings.append(node.unreadable(str(error)))
        return None


def attempt_all(
    findings: list[Finding], nodes: Iterable[Any], read: Callable[..., Value | None], *more: object
) -> tuple[Value, ...]:
    """Return the results of `read` for elements or prims, without those that have none."""
    results = [attempt(findings, node, read, *more) for node in nodes]
    return tuple(result for result in results if result is not None)


def read_shapes(
    findings: list[Finding],
    link: Node,
    pose_of: Callable[[Node], tuple],
    kinds: Sequence[str],
    get: Callable[[Node, str], str],
    length: float | None = None,
    beside: str = "",
) -> tuple[StatedShape, ...]:
    """Return the visual and collision shapes of a link of URDF or SDF that bound a volume.

    pose_of: returns the pose of an element, and the angles if stated. kinds: known ones besides
    meshes. get: returns the text of an element's property. length: default of a radius or length,
    if there is one. beside: as of a shape.
    """

    def read(node: Node, role: str) -> StatedShape | None:
        pose, angles, *_ = pose_of(node)
        geometry = node.find("geometry")
        solids = [
            element
            for element in (geometry.children if geometry else ())
            if element.tag not in FLAT_KINDS
        ]
        if not solids:
            return None
        element = solids[0]
        kind = element.tag
        file = ""
        if kind == "mesh":
            size = numbers(get(element, "scale"), 3, (1.0, 1.0, 1.0)).tolist()
            file = get(element, "filename") or get(element, "uri")
        elif kind not in kinds:
            raise ValueError(kind)
        elif kind in ("box", "ellipsoid"):
            lengths = get(element, "size" if kind == "box" else "radii")
            size = numbers(lengths, 3, (1.0, 1.0, 1.0)).tolist()
        else:
            names = ("radius",) if kind == "sphere" else ("radius", "length")
            size = [number(get(element, name), length) for name in names]
        return StatedShape(Shape(kind, tuple(size), pose, file), role, angles, node.place, beside)

    return tuple(
        shape
        for role in ("visual", "collision")
        for shape in attempt_all(findings, link.all(role), read, role)
    )


def stated_link(
    node: Node, element: Node | None, findings: Sequence[Finding], **values: Any
) -> StatedLink:
    """Return a link with the places of its values in the file. element: the inertial's, which a
    repair replaces if it is in the file itself.
    """
    span = None
    if element is not None and values["inertial"] is not None and element.start != NOWHERE:
        span = (element.start, element.end)
    places = {"place": node.place, "inertial_place": (element or node).place}
    return StatedLink(span=span, findings=tuple(findings), **places, **values)


def symmetric_tensor(entries: Callable[[str], float]) -> Array:
    """Return the (3, 3) tensor of URDF's and SDF's six entries, such as "ixy"."""
    tensor = np.empty((3, 3))
    for name, i, j in ENTRIES:
        tensor[i, j] = tensor[j, i] = entries(name)
    return tensor
