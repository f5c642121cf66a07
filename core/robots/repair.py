# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A repaired copy of a description: its inertials replaced in place, every other byte as it was."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from ..numerics.rotations import quaternion
from .model import Inertial
from .stated import Description, StatedInertial, StatedLink
from .write.text import number, numbers
from .write.usd import mass_attributes

_USD_ATTRIBUTE = re.compile(
    r"[ \t]*(?:custom )?(?:uniform )?[\w:\[\]]+ (?:physics:(?:mass|centerOfMass|diagonalInertia|principalAxes)|"
    r"newton:inertia) = (?:\([^)]*\)|\[[^\]]*\]|[^\s(\[]+)[ \t]*;?\n?"
)


def repaired_copy(description: Description, repairs: Sequence[tuple[StatedLink, StatedInertial]]) -> bytes:
    """Return a description's file with other inertials.

    repairs: links with an inertial in the file, and its replacement.
    """
    data = description.source
    places = [(link.span, link, inertial) for link, inertial in repairs if link.span is not None]
    for (start, end), link, inertial in sorted(places, key=lambda place: place[0], reverse=True):
        old = data[start:end]
        new = _INERTIAL_WRITERS[description.format](link, inertial, description, old.decode("utf-8", "surrogateescape"))
        before = data[:start].rpartition(b"\n")[2]
        indent = before if not before.strip() else b""
        if description.format != "usd":
            new = ("\n" + indent.decode("utf-8", "surrogateescape")).join(new.split("\n"))
        data = data[:start] + new.encode("utf-8", "surrogateescape") + data[end:]
    return data


def _urdf(_link: StatedLink, inertial: StatedInertial, _description: Description, _old: str) -> str:
    tensor = inertial.inertia
    entries = ['i{}{}="{}"'.format("xyz"[i], "xyz"[j], number(tensor[i, j])) for i in range(3) for j in range(i, 3)]
    return '<inertial>\n  <origin xyz="{}" rpy="0 0 0"/>\n  <mass value="{}"/>\n  <inertia {}/>\n</inertial>'.format(
        numbers(inertial.center), number(inertial.mass), " ".join(entries)
    )


def _sdf(_link: StatedLink, inertial: StatedInertial, _description: Description, old: str) -> str:
    tensor = inertial.inertia
    entries = ["    <i{0}{1}>{2}</i{0}{1}>".format("xyz"[i], "xyz"[j], number(tensor[i, j]))
               for i in range(3) for j in range(i, 3)]  # fmt: skip
    kept = re.findall(r"<fluid_added_mass>.*?</fluid_added_mass>", old, re.DOTALL)
    return "\n".join(
        [
            "<inertial>",
            "  <pose>{} 0 0 0</pose>".format(numbers(inertial.center)),
            "  <mass>{}</mass>".format(number(inertial.mass)),
            *["  <inertia>", *entries, "  </inertia>"],
            *["  " + text for text in kept],
            "</inertial>",
        ]
    )


def _mjcf(_link: StatedLink, inertial: StatedInertial, _description: Description, _old: str) -> str:
    principal = with_principal_axes(inertial)
    return '<inertial pos="{}" quat="{}" mass="{}" diaginertia="{}"/>'.format(
        numbers(principal.center),
        numbers(quaternion(principal.axes)),
        number(principal.mass),
        numbers(principal.moments),
    )


def _usd(link: StatedLink, inertial: StatedInertial, description: Description, old: str) -> str:
    """Return the text with new attributes in the place of the old ones, before anything below."""
    unit, mass = description.scales["length"], description.scales["mass"]
    local = np.eye(4) if link.local is None else link.local
    principal = with_principal_axes(inertial)
    center = np.asarray(np.linalg.solve(local[:3, :3], inertial.center / unit - local[:3, 3]) * unit, np.float64)
    placed = Inertial(principal.mass / mass, center, principal.inertia / mass, principal.moments / mass, principal.axes)
    below = re.search(r"\n[ \t]*(?:def|over|class)\b", old)
    split = below.start() if below else len(old)
    own, rest = old[:split], old[split:]
    match = re.search(r"\n([ \t]+)\S", old)
    indent = match[1] if match else "    "
    lines = "".join("\n" + indent + line for line in mass_attributes(placed, unit))
    return lines + _USD_ATTRIBUTE.sub("", own) + rest


def with_principal_axes(inertial: StatedInertial) -> Inertial:
    """Return an inertial with its principal moments and axes, none of them above the sum of the others."""
    tensor = (inertial.inertia + inertial.inertia.T) / 2.0
    moments, axes = np.linalg.eigh(tensor)
    axes = axes * (1.0, 1.0, np.sign(np.linalg.det(axes)))
    moments[2] = min(moments[2], moments[0] + moments[1])
    return Inertial(inertial.mass, inertial.center, tensor, moments, axes)


_INERTIAL_WRITERS = {"urdf": _urdf, "sdf": _sdf, "mjcf": _mjcf, "usd": _usd}
