# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A repaired copy of a description: its inertials replaced in place, every other byte as it was."""

from __future__ import annotations

from collections.abc import Sequence

from .formats import FORMATS
from .stated import Description, StatedInertial, StatedLink


def repaired_copy(description: Description, repairs: Sequence[tuple[StatedLink, StatedInertial]]) -> bytes:
    """Return the bytes of a description's file with replaced inertials. repairs: links and their new inertials."""
    data, writer = description.source, FORMATS[description.format].writer_module
    places = [(link.span, link, inertial) for link, inertial in repairs if link.span is not None]
    for (start, end), link, inertial in sorted(places, key=lambda place: place[0], reverse=True):
        old = data[start:end].decode("utf-8", "surrogateescape")
        new = writer.inertial_text(inertial, old, link, description)
        before = data[:start].rpartition(b"\n")[2]
        if description.format != "usd" and not before.strip():
            new = new.replace("\n", "\n" + before.decode())
        data = data[:start] + new.encode("utf-8", "surrogateescape") + data[end:]
    return data
