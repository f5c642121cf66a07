# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A file of a robot as a description, by what is in it."""

from __future__ import annotations

import stat
from pathlib import Path

from ....core.robots.stated import Description
from ....core.verdict.finding import FileError
from . import mjcf, sdf, urdf, usda
from .limits import MAX_DESCRIPTION, MAX_LINKS
from .xml import parse

ROOTS = {"robot": urdf.read, "sdf": sdf.read, "mujoco": mjcf.read}
SUFFIXES = (".urdf", ".sdf", ".xml", ".usda", ".usd", ".world")


def read_description(path: Path) -> Description:
    """Return what a file states of a robot.

    Parameters
    ----------
    path : Path

    Returns
    -------
    Description

    Raises
    ------
    FileError
        Where it is none, or is refused.
    """
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            raise FileError("file_not_regular")
        with open(path, "rb") as file:
            data = file.read(MAX_DESCRIPTION + 1)
    except FileNotFoundError as error:
        raise FileError("file_missing") from error
    except OSError as error:
        raise FileError("file_unreadable", error=error.strerror or str(error)) from error
    if len(data) > MAX_DESCRIPTION:
        raise FileError("description_too_large", limit=MAX_DESCRIPTION >> 20)
    description = usda.read(data) if data.startswith(b"#usda") else _xml(data)
    if len(description.links) > MAX_LINKS:
        raise FileError("description_too_large", limit=MAX_DESCRIPTION >> 20)
    if not description.links:
        raise FileError("description_without_links")
    return description


def _xml(data: bytes) -> Description:
    if data.startswith((b"PXR-USDC", b"PK")):
        raise FileError("usd_not_text")
    root = parse(data)
    if root.tag not in ROOTS:
        raise FileError("description_unknown", tag=root.tag)
    return ROOTS[root.tag](root, data)
