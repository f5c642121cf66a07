# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What may be no part of a body counts in a total only with a word: operands, what is not rendered, what is open."""

import bpy
import pytest
from body_moments.core.verdict.method import Method, Verdict
from body_moments.operators.read.total_caveats import left_out_reasons, open_body_caveats, total_caveats

from tests.blender.findings import said
from tests.blender.read_bodies import collection, cube, layer_of

pytestmark = pytest.mark.usefixtures("bare_scene")


def caveats(*objects):
    bpy.context.view_layer.update()
    return said(total_caveats(objects, bpy.context.view_layer))


def test_an_open_body_is_a_caveat_where_there_is_another():
    closed, open_one = Method(Verdict.EXACT), Method(Verdict.OPEN)
    assert open_body_caveats([("Strip", open_one)]) == []
    assert said(open_body_caveats([("Strip", open_one), ("Box", closed)])) == {
        "total_of_open_objects": {"objects": ["Strip"]}
    }
    assert said(open_body_caveats([("b", open_one), ("a", open_one), ("c", None)])) == {
        "total_of_open_objects": {"objects": ["a", "b"]}
    }
    assert open_body_caveats([("c", None), ("Box", closed)]) == []


def test_operands_and_what_the_render_does_not_show_are_caveats_of_a_total():
    body, cutter, other = cube("Body"), cube("Cutter"), cube("Other")
    assert caveats(body, cutter) == {} and caveats(body) == {}
    modifier = body.modifiers.new("Cut", "BOOLEAN")
    modifier.object = cutter
    cutter.display_type = "WIRE"
    for viewport, render in ((True, False), (False, True), (False, False)):
        modifier.show_viewport, modifier.show_render = viewport, render
        operands = {"total_boolean_operands": {"operands": [["Cutter", "Body"]]}}
        seen = {"total_hidden_objects": {"objects": ["Cutter"]}}
        assert caveats(cutter, body) == (operands if viewport or render else seen)
    assert caveats(cutter) == {}
    cutter.display_type = "TEXTURED"
    assert caveats(body, cutter) == {}
    for hide, show in (
        (lambda: setattr(other, "hide_render", True), lambda: setattr(other, "hide_render", False)),
        (lambda: other.hide_set(True), lambda: other.hide_set(False)),
        (lambda: setattr(other, "display_type", "BOUNDS"), lambda: setattr(other, "display_type", "SOLID")),
    ):
        hide()
        assert caveats(body, other) == {"total_hidden_objects": {"objects": ["Other"]}}
        show()
        assert caveats(body, other) == {}
    modifier.show_render, modifier.operand_type = True, "COLLECTION"
    assert caveats(body, cutter) == {}
    modifier.collection = collection("Cutters")
    modifier.collection.objects.link(cutter)
    assert caveats(body, cutter) == {"total_boolean_operands": {"operands": [["Cutter", "Body"]]}}


def test_what_no_view_layer_renders_is_no_part_of_the_scene():
    scene = bpy.context.scene
    home, inner = collection("Home"), collection("Inner", False)
    home.children.link(inner)
    body, below = cube("Body", home), cube("Below", inner)
    bpy.context.view_layer.update()

    def reasons():
        found = left_out_reasons(scene, bpy.context.view_layer)
        return {obj.name: reason.code for obj, reason in found.items()}

    assert reasons() == {}
    layer_of(home).exclude = True
    layer_of(home).children["Inner"].exclude = False  # what is excluded may hold what is not
    assert reasons() == {"Body": "not_rendered"}
    second = scene.view_layers.new("Second")
    assert reasons() == {}  # it renders all
    second.use = False
    assert reasons() == {"Body": "not_rendered"}
    bpy.context.view_layer.use = False
    assert reasons() == {"Body": "not_rendered"}  # where all are off the open one is all there is
    home.hide_render = True
    assert reasons() == {"Body": "not_rendered", "Below": "not_rendered"}
    home.hide_render, layer_of(home).exclude = False, False
    below.hide_render = True
    assert reasons() == {"Below": "not_rendered"}
    cutter = cube("Cutter")
    body.modifiers.new("Cut", "BOOLEAN").object = cutter
    assert "Cutter" not in reasons()
    cutter.display_type = "BOUNDS"
    assert reasons()["Cutter"] == "boolean_operand"
