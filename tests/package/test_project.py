# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The project's commands take the options that their texts name."""

import re
from contextlib import suppress
from importlib import metadata

import pytest
from packaging.specifiers import SpecifierSet

from tests.package.parsed import TESTS, parsed


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["benchmark"], "benchmark [] None None"),
        (["benchmark", "--quick"], "benchmark ['--quick'] None None"),
        (["soak", "--minutes", "2", "kills"], "soak ['--minutes', '2', 'kills'] None None"),
        (["soak", "kills", "--seed", "3"], "soak ['kills', '--seed', '3'] None None"),
        (["test", "solid", "-k", "cube"], "test [] solid cube"),
        (["test", "solid", "--", "-x", "--lf"], "test ['-x', '--lf'] solid None"),
        (["test", "core/solid"], "test [] core/solid None"),
    ],
    ids=" ".join,
)
def test_options_reach_the_called_program(words, expected):
    assert parsed(*words) == expected


PINNED = re.compile(r"^([\w.-]+)==([\w.]+)$", re.MULTILINE)  # for every system and Python


@pytest.mark.parametrize("file", ["4.5", "build", "core", "tests"])
def test_pins_allow_the_oldest_python_that_the_readme_names(file):
    """The installed distributions state it; those that are not installed are left out."""
    text = (TESTS / f"requirements-{file}.txt").read_text(encoding="utf-8")
    checked = 0
    for name, version in PINNED.findall(text):
        with suppress(metadata.PackageNotFoundError):
            found = metadata.distribution(name)
            if found.version == version:
                allowed = found.metadata.get("Requires-Python") or ""
                assert SpecifierSet(allowed).contains("3.11.0"), (name, allowed)
                checked += 1
    assert checked >= 3
