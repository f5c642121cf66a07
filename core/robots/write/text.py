# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers, names, angles and elements as the formats of robots write them."""

import re
from collections.abc import Callable, Iterable
from math import atan2, cos, hypot, sin
from typing import TypeVar
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from ..model import Pose
from .marker import MARKER

_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_SPACES = re.compile(r"[\t\n\r]")
Key = TypeVar("Key")


def number(value: float) -> str:
    """Return the shortest text that is read as this float64, without a negative zero."""
    return repr(float(value) + 0.0)


def numbers(values: Iterable[float]) -> str:
    """Return numbers with spaces between."""
    return " ".join(map(number, values))


def xml_text(text: str) -> str:
    """Return the text with an underscore for each character that XML cannot hold or a reader would
    change.
    """
    return _SPACES.sub("_", _NOT_XML.sub("_", text))


def xml_name(text: str) -> str:
    """Return a name for XML: readers trim spaces at its ends, and refuse an empty one."""
    text = xml_text(text)
    inner = text.strip()
    # An underscore takes the place of each space at an end.
    before = len(text) - len(text.lstrip()) if inner else 0
    return "_" * before + inner + "_" * (len(text) - before - len(inner)) if text else "_"


def unique_names(
    names: Iterable[Key], rename: Callable[[Key], str], taken: Iterable[str] = ()
) -> dict[Key, str]:
    """Return a dict from each name to its `rename`d name, with a number if that name is used or
    `taken`.
    """
    used = set(taken)
    result = {}
    for name in names:
        base = candidate = rename(name)
        number_ = 1
        while candidate in used:
            number_ += 1
            candidate = "{}_{}".format(base, number_)
        used.add(candidate)
        result[name] = candidate
    return result


def free_name(name: str, taken: Iterable[str]) -> str:
    """Return a name, with a number if it is `taken`."""
    return unique_names([name], str, taken)[name]


def roll_pitch_yaw(rotation: NDArray) -> tuple[float, float, float]:
    """Return roll, pitch and yaw with rotation = Rz(yaw) Ry(pitch) Rx(roll), -π/2 ≤ pitch ≤ π/2,
    also at the poles.
    """
    yaw = atan2(rotation[1, 0], rotation[0, 0])
    pitch = atan2(-rotation[2, 0], hypot(rotation[0, 0], rotation[1, 0]))
    # The rotation turned back by the yaw shows the roll however small the pitch's cosine is.
    roll = atan2(
        sin(yaw) * rotation[0, 2] - cos(yaw) * rotation[1, 2],
        cos(yaw) * rotation[1, 1] - sin(yaw) * rotation[0, 1],
    )
    return roll, pitch, yaw


def is_identity(pose: Pose) -> bool:
    """Return whether a pose has no offset and no rotation."""
    return not pose.position.any() and bool((pose.rotation == np.eye(3)).all())


def element(tag: str, *parts: Element, text: str | None = None, **attributes: str) -> Element:
    """Return an element with attributes, text and the elements in it."""
    result = Element(tag, attributes)
    result.text = text
    result.extend(parts)
    return result


def element_text(root: Element) -> str:
    """Return the indented text of an element."""
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode")


def document(root: Element, kind: str, remarks: Iterable[str]) -> str:
    """Return the text of an XML file: our marker and the remarks as comments, then the root
    element, indented.
    """
    lines = [MARKER.format(kind), *(xml_text(remark) for remark in remarks)]
    # A comment of XML neither contains "--" nor ends in "-".
    comments = ["<!-- {} -->\n".format(re.sub("-(?=-|$)", "- ", line)) for line in lines]
    body = element_text(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n{}{}\n'.format("".join(comments), body)
