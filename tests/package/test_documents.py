# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Places that documents name: folders, files, and functions, classes and methods written as
`path.py:name`.
"""

import ast
import re
from pathlib import Path

import pytest

from tests.package.modules import ORDER

ROOT = Path(__file__).resolve().parent.parent.parent
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
PLACE = re.compile(
    r"`((?:core|blender|command|operators|panels|tests|tools|findings|docs)/[\w/.-]*?|__init__\.py)"
    r"(?::([A-Za-z_][\w.]*))?`"
)


def places(document: Path) -> list[tuple[str, str]]:
    return PLACE.findall(document.read_text(encoding="utf-8"))


def defines(path: Path, name: str) -> bool:
    """Return whether a module itself defines this function, class or method of a class."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    for part in name.split("."):
        inner = [
            node.body
            for node in body
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and node.name == part
        ]
        if not inner:
            return False
        body = inner[-1]
    return True


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_every_place_that_a_document_names_exists(document):
    missing = [path for path, _ in places(document) if not (ROOT / path).exists()]
    assert not missing
    unknown = [
        ":".join(place)
        for place in places(document)
        if place[1] and not defines(ROOT / place[0], place[1])
    ]
    assert not unknown


def test_the_architecture_draws_the_imports_that_are_tested():
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    rows = [", ".join(row) for wing in ORDER.values() for row in wing]
    drawn = re.search(r"    core  .*?(?=\n\n    command)", text, re.S).group()
    lines = [
        re.sub(r"^    (core|blender)?\s+", "", line) for line in drawn.splitlines() if line.strip()
    ]
    assert lines == rows
