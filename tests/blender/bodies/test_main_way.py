# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How long the way of one press of Measure is, and that every kind of body has its own module of one form."""

import inspect
import sys
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy")
from body_moments.core.verdict.method import Method
from body_moments.operators.bodies.body import Body
from body_moments.operators.bodies.kinds import KINDS

ROOT = str(Path(__file__).resolve().parent.parent.parent.parent)
pytestmark = pytest.mark.usefixtures("scene")
MAX_MODULES, MAX_CALLS = 32, 200


def pressed() -> list[tuple[str, str]]:
    """The functions of ours that a second press of Measure calls, as (file, name), in order."""
    calls = []

    def note(frame, event, _argument):
        file = frame.f_code.co_filename
        if event == "call" and file.startswith(ROOT) and not file.startswith((ROOT + "/tests/", ROOT + "/.envs/")):
            calls.append((file, frame.f_code.co_name))

    bpy.ops.object.body_moments_measure()
    before = sys.getprofile()
    sys.setprofile(note)
    try:
        bpy.ops.object.body_moments_measure()
    finally:
        sys.setprofile(before)
    return calls


@pytest.mark.skipif(sys.version_info < (3, 12), reason="needs Python 3.12: comprehensions make no calls")
def test_one_press_of_measure_is_a_short_way():
    mesh = bpy.data.meshes.new("Tetrahedron")
    points = [(0, 0, 0), (1, 0, 0), (0.2, 1.7, 0), (0.1, 0.3, 2.3)]
    mesh.from_pydata(points, [], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    obj = bpy.data.objects.new("Tetrahedron", mesh)
    bpy.context.collection.objects.link(obj)
    obj.select_set(True)
    obj.body_moments.density = 1000.0  # else there is a note more
    bpy.context.view_layer.update()
    calls = pressed()
    modules = sorted({file for file, _ in calls})
    assert obj["body_volume"] == pytest.approx(1.7 * 2.3 / 6.0, rel=1e-6)
    assert len(modules) <= MAX_MODULES, "\n".join(modules)
    assert len(calls) <= MAX_CALLS
    assert any(file.endswith("bodies/stack.py") for file in modules)  # the way that is meant


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__.rpartition(".")[2])
def test_every_kind_of_body_has_one_form(kind):
    assert {"solid", "shell", "wire"} >= kind.MEASURED_AS > frozenset()
    assert list(inspect.signature(kind.read).parameters) == ["request"]
    assert list(inspect.signature(kind.body).parameters) == ["reading", "request"]


def test_bodies_are_data_and_methods_are_no_text():
    classes = [Body]
    for each in classes:
        classes += each.__subclasses__()
        assert not [name for name, hint in each.__annotations__.items() if "Callable" in str(hint)], each
    assert Body.__annotations__["method"] == "Method" and Method.parse("NURBS exact") is not None
    assert len(classes) >= 8
