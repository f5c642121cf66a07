# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Names that scripts, drivers and pipelines rely on, and the help of the command line, kept as
text.
"""

import ast
import os
import re
from pathlib import Path

import bpy
import pytest
from body_moments.operators import batch

from tests.core.findings import declarations

ROOT = Path(__file__).resolve().parent.parent.parent
COMMANDS = (
    "measure",
    "similar",
    "audit",
    "simplex",
    "manifest",
    "merge",
    "to-csv",
    "summary",
    "compare",
    "report",
)


def operators():
    for category in dir(bpy.ops):
        for name in dir(getattr(bpy.ops, category)):
            if name.startswith("body_moments_"):
                yield "operator {}.{}".format(category, name)


def stored_keys():
    for path in ROOT.rglob("*.py"):
        if not {"tests", ".envs"} & {*path.relative_to(ROOT).parts}:
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                text = node.value if isinstance(node, ast.Constant) else None
                if isinstance(text, str) and re.fullmatch(r"body_(?!moments)[a-z_]+", text):
                    yield "key {}".format(text)


@pytest.fixture
def help_of(tmp_path, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")

    def read(command):
        path = tmp_path / command
        with open(path, "wb") as file:
            assert batch.main([command, "--help"], channel=os.dup(file.fileno())) == 0
        return path.read_text(encoding="utf-8")

    return read


@pytest.mark.usefixtures("registered")
def test_public_names_are_as_reviewed(kept, help_of):
    options = [
        "option {} {}".format(command, option)
        for command in COMMANDS
        for option in re.findall(r"--[a-z][a-z0-9-]*", help_of(command))
    ]
    codes = ["finding {}".format(code) for code in declarations()]
    kept("contracts.txt", "\n".join(sorted({*operators(), *stored_keys(), *options, *codes})))


@pytest.mark.parametrize("command", ["measure", "audit", "similar"])
def test_help_of_command_is_as_reviewed(command, kept, help_of):
    kept("help_{}.txt".format(command), help_of(command))
