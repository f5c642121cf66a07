# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of USD, written as text."""

from tests.blender import batch_files as files
from tests.blender.batch_files import document

# sheared, mirrored and moved
MATRIX = (
    (1, 0, 0, 0),
    (0.5, 2, 0, 0),
    (0, 0, -3, 0),
    (10, 20, 30, 1),
)


def prim(kind, name, *lines, arcs=""):
    return 'def {} "{}" {}{{\n{}\n}}\n'.format(kind, name, arcs, "\n".join(lines))


def moved(matrix=MATRIX):
    order = 'uniform token[] xformOpOrder = ["xformOp:transform"]'
    return "matrix4d xformOp:transform = {}\n{}".format(str(matrix), order)


def measure(tmp_path, *prims, up="Z", unit=1, options=(), is_whole=True):
    head = '#usda 1.0\n(\n upAxis = "{}"\n metersPerUnit = {}\n)\n'.format(up, unit)
    found = document(
        files.write_text(tmp_path / "t.usda", head + "".join(prims)), "--density", "1", *options
    )
    assert not is_whole or found["errors"] == []
    return found


def by_name(found):
    return {entry["name"]: entry for entry in found["objects"]}
