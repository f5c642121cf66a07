# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of a run: named files, files in folders, and files of a list (a manifest).

A manifest is a text of JSON lines: {"schema": "body-moments-manifest/1", "files": N}, then {"path":
"…"} for each file. The first line has "parts", too, if the files are to be measured in several
parts, which are then as even as possible. A name may hold any character, a line break too.
"""

import json
import os
import re
from collections.abc import Iterable, Iterator
from errno import ENOENT
from pathlib import Path

from ...core.scans import scan_files as scans
from ...core.verdict import system_reason
from ..parser import UsageError

SCHEMA = "body-moments-manifest/1"
BLEND = ".blend"
UNITLESS = (".stl", ".obj", ".ply")  # formats that need no import either
CAD = (".igs", ".iges", ".step", ".stp")  # nor do these, which state their unit
USD = (".usd", ".usda", ".usdc", ".usdz")
IMPORTED = (".stl", ".ply", ".obj", ".fbx", ".3mf", *CAD, ".glb", ".gltf", *USD)
SUFFIXES = (BLEND, *IMPORTED, *(suffix for suffix in scans.SUFFIXES if suffix != ".raw"))
COPY_SUFFIX = ".body_moments.blend"  # suffix of our own copies of .blend files
# Other .raw files belong to headers.
_RAW = re.compile(r"_\d+x\d+x\d+_[a-z0-9]+\.raw$", re.IGNORECASE)


def expand(names: Iterable[str]) -> Iterator[str]:
    """Yield the names, with each folder replaced by its measurable files, sorted.

    Raises OSError if it has none.
    """
    for name in names:
        if not os.path.isdir(name):
            yield name
            continue
        paths = sorted(_walk(name))
        if not paths:
            raise FileNotFoundError(ENOENT, "no file that can be measured is in it", name)
        yield from paths


def _walk(top: str) -> Iterator[str]:
    """Yield the measurable files in a folder and its subfolders.

    Each folder counts once, so that links in a circle end. Hidden entries and unreadable folders
    are left out.
    """
    visited: set[tuple[int, int]] = set()
    for folder, folders, files in os.walk(top, followlinks=True):
        status = os.stat(folder)
        if (status.st_dev, status.st_ino) in visited:
            folders.clear()
            continue
        visited.add((status.st_dev, status.st_ino))
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        yield from (
            os.path.join(folder, name) for name in files if name[0] != "." and _is_measurable(name)
        )


def _is_measurable(path: str) -> bool:
    name = path.lower()
    return bool(name.endswith(SUFFIXES) and not name.endswith(COPY_SUFFIX) or _RAW.search(path))


def write_lines(paths: Iterable[str], parts: int = 1) -> Iterator[str]:
    """Yield the text of a manifest of these files, in pieces. parts: how many of its parts are
    measured apart.
    """
    paths = list(paths)
    divided = {"parts": parts} if parts > 1 else {}
    yield json.dumps({"schema": SCHEMA, "files": len(paths)} | divided) + "\n"
    for path in paths:
        yield json.dumps({"path": path}) + "\n"


def read(path: Path, part: int | None = None) -> list[str]:
    """Return the files that a manifest lists; relative names start from its folder.

    Raises UsageError.

    part: the number of one of its parts, from 1; None for all files.
    """
    try:
        with open(path, "rb") as file:
            lines = [json.loads(line) for line in file if line.strip()]
        names = [line["path"] for line in lines[1:]]
        parts = lines[0].pop("parts", 1)
        is_list = (
            lines[0] == {"schema": SCHEMA, "files": len(names)} and type(parts) is int and parts > 0
        )
        if not is_list or not all(isinstance(name, str) for name in names):
            raise ValueError(path)
    except OSError as error:
        raise UsageError(
            "The list {} cannot be read: {}".format(path, system_reason(error))
        ) from error
    except (ValueError, KeyError, TypeError, IndexError, AttributeError, RecursionError) as error:
        raise UsageError(
            "{} is not a list of files. Make one with “manifest FOLDER”".format(path)
        ) from error
    if part is not None:
        if part > parts:
            raise UsageError(
                "The list {} has {:d} parts, and no part {:d}".format(path, parts, part)
            )
        names = names[len(names) * (part - 1) // parts : len(names) * part // parts]
    folder = "" if path.parent == Path() else path.parent
    return [os.path.join(folder, name) for name in names]
