# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Selected objects in order, parents first, and joints in another context."""

import bpy
import pytest
from body_moments.operators import selection

from tests.blender.objects import add, mesh_body, only

pytestmark = pytest.mark.usefixtures("scene")


def test_selection_is_ordered_parents_first():
    objects = [add(mesh_body(), name) for name in "abcd"]
    for child, parent in zip(objects, objects[1:], strict=False):
        child.parent = parent
    only(*objects)
    add(None, "Point", select=False).select_set(True)
    assert [obj.name for obj in selection.selected_measurable(bpy.context)] == ["d", "c", "b", "a"]
