# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shares, margins and numbers of lines of the panels, as they were chosen by eye: kept as text."""

from importlib import import_module

import pytest

MODULES = (
    *("panels.assembly", "panels.bones", "panels.inertia", "panels.menus", "panels.remedies", "panels.rows"),
    *("panels.selection", "panels.settings", "panels.shape", "panels.stability"),
)


@pytest.mark.usefixtures("registered")
def test_sizes(kept):
    lines = []
    for name in MODULES:
        values = vars(import_module("body_moments." + name)).items()
        sizes = [item for item in values if item[0].isupper() and type(item[1]) in (int, float)]
        assert sizes, name
        lines += ["{:s}.{:s} = {!r}".format(name, *size) for size in sizes]
    kept("sizes.txt", "\n".join(lines))
