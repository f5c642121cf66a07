# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the documents name exists: folders, files, and functions, classes and methods written as `path.py:name`."""

import ast
import re
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest

from tests.package.test_architecture import ORDER
from tests.window import png

ROOT = Path(__file__).resolve().parent.parent.parent
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
PLACE = re.compile(
    r"`((?:core|blender|command|operators|panels|tests|docs)/[\w/.]*?|__init__\.py)(?::([A-Za-z_][\w.]*))?`"
)


def places(document: Path) -> list[tuple[str, str]]:
    return PLACE.findall(document.read_text(encoding="utf-8"))


def defines(path: Path, name: str) -> bool:
    """Whether a module defines this function or class, or this method of a class, itself."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    for part in name.split("."):
        inner = [node.body for node in body if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and node.name == part]
        if not inner:
            return False
        body = inner[-1]
    return True


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_every_place_that_a_document_names_exists(document):
    missing = [path for path, _ in places(document) if not (ROOT / path).exists()]
    assert not missing
    unknown = [":".join(place) for place in places(document) if place[1] and not defines(ROOT / place[0], place[1])]
    assert not unknown


@pytest.mark.parametrize(("document", "least"), [("architecture.md", 15), ("how-a-number-is-made.md", 40)])
def test_tour_of_the_code_names_its_functions(document, least):
    named = [place for place in places(ROOT / "docs" / document) if place[1]]
    assert len(named) > least


def test_the_architecture_draws_the_imports_that_are_tested():
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    rows = [", ".join(row) for wing in ORDER.values() for row in wing]
    drawn = re.search(r"    core  .*?(?=\n\n    command)", text, re.S).group()
    lines = [re.sub(r"^    (core|blender)?\s+", "", line) for line in drawn.splitlines() if line.strip()]
    assert lines == rows


def test_the_animated_picture_moves_and_is_small():
    """An animated PNG (tests/window/record_live.py): viewers that know no animation show its first frame."""
    data = (ROOT / "tests" / "window" / "pictures" / "live.png").read_bytes()
    frames, plays = struct.unpack(">II", data[data.index(b"acTL") + 4 :][:8])
    assert frames >= 10 and plays == 0 and len(data) < 1.5e6
    assert data.count(b"fcTL") == frames and data.count(b"fdAT") == frames - 1


def test_frames_are_written_as_they_are(tmp_path):
    first = np.zeros((6, 9, 3), np.uint8)
    second = first.copy()
    second[2:4, 5:7] = (248, 16, 96)
    png.write_animation(tmp_path / "two.png", [first, second, second], [0.5, 0.1, 1.0])
    data = (tmp_path / "two.png").read_bytes()
    control = data[data.index(b"fcTL", data.index(b"fdAT") - 60) + 4 :]
    assert struct.unpack(">IIIIIHH", control[:24]) == (1, 2, 2, 5, 2, 100, 1000)  # what changed, and where
    start = data.index(b"fdAT") + 4
    (length,) = struct.unpack(">I", data[start - 8 : start - 4])
    rows = np.frombuffer(zlib.decompress(data[start + 4 : start + length]), np.uint8).reshape(2, 3)
    palette = np.frombuffer(data[data.index(b"PLTE") + 4 :][:6], np.uint8).reshape(-1, 3)
    assert not rows[:, 0].any() and (palette[rows[:, 1:]] == (248, 16, 96)).all()
