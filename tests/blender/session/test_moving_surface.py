# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Of which measured bodies the faces may be followed in a light pass, and which shapes such a pass can tell."""

from dataclasses import replace
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.core.verdict.method import Method, Source, Verdict
from body_moments.operators.bodies.measure_object import Measured, measure_body
from body_moments.operators.session import moving_surface
from body_moments.operators.session.moving_surface import MovingSurface
from body_moments.operators.settings.options import MeasureOptions

from tests.blender.objects import add, measured, mesh_body
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


@pytest.fixture
def body():
    obj = add(mesh_body(), location=(1, 2, 3), rotation=(0.3, 0.2, 0.1), scale=(0.5, 0.5, 1.0))
    return obj, measure_body(obj, bpy.context.evaluated_depsgraph_get(), MeasureOptions(compare=False))


def of_reading(**values):
    return lambda measured: replace(measured, reading=replace(measured.reading, **values))


def of_part(change):
    def changed(measured):
        (part,) = measured.reading.parts
        return replace(measured, reading=replace(measured.reading, parts=[replace(part, **change(part))]))

    return changed


def of_body(change):
    return lambda measured: replace(measured, body=replace(measured.body, **change(measured.body)))


def of_measurement(**values):
    return lambda measured: replace(measured, measurement=replace(measured.measurement, **values))


def plain(kind):
    """The same attributes in something else."""

    def changed(measured):
        return Measured(**vars(measured) | {kind: SimpleNamespace(**vars(getattr(measured, kind)))})

    return changed


def moved(part):
    matrices = part.matrices.copy()
    matrices[0, 0, 3] += 1.0
    return {"matrices": matrices}


def welded(body):
    ((solid, matrices),) = body.solids
    surface = replace(solid.repaired_surface, points=solid.repaired_surface.points + 1.0)
    return {"solids": ((SimpleNamespace(repaired_surface=surface), matrices),)}


FOLLOWED = {
    "as it is": lambda measured: measured,
    "by its name": of_part(lambda _: {"source_object_name": "Body"}),
    "capped": of_measurement(method=Method(Verdict.CAPPED)),
    "reoriented": of_measurement(method=Method(Verdict.REORIENTED)),
}
LEFT = {
    "no reading": plain("reading"),
    "no mesh": plain("body"),
    "a shell": of_measurement(kind="shell"),
    "a mass that varies": of_body(lambda _: {"mass": object()}),
    "of patches": of_measurement(method=Method(Verdict.EXACT, Source.NURBS)),
    "open": of_measurement(method=Method(Verdict.OPEN)),
    "no part": of_reading(parts=[]),
    "two parts": lambda measured: of_reading(parts=measured.reading.parts * 2)(measured),
    "no solid": of_body(lambda _: {"solids": ()}),
    "two solids": of_body(lambda body: {"solids": body.solids * 2}),
    "of another object": of_part(lambda _: {"source_object_name": "Other"}),
    "two places": of_part(lambda part: {"matrices": part.matrices.repeat(2, axis=0)}),
    "another place": of_part(moved),
    "without corners": of_part(lambda part: {"surface": replace(part.surface, corner_vertices=None)}),
    "welded": of_body(welded),
}


@pytest.mark.parametrize("name", [*FOLLOWED, *LEFT])
def test_one_mesh_in_its_own_place_as_it_was_read_is_followed(body, name):
    found = MovingSurface.of((FOLLOWED | LEFT)[name](body[1]))
    assert (found is not None) == (name in FOLLOWED)


def followed(surface, obj):
    bpy.context.view_layer.update()
    return surface.follow(obj, bpy.context.evaluated_depsgraph_get())


def test_a_pass_gives_volume_and_center_in_own_coordinates_where_the_faces_enclose_something(body, monkeypatch):
    obj, whole = body
    surface = MovingSurface.of(whole)
    for change in (
        lambda: None,
        lambda: setattr(obj.data.vertices[1].co, "z", -1.0),
        lambda: setattr(obj, "scale", (3, 2, 1)),
    ):
        change()
        obj.data.update()
        volume, center = followed(surface, obj)
        truth = measured(obj)
        assert close(volume * abs(np.linalg.det(np.array(obj.matrix_world)[:3, :3])), truth.volume, 1e-6)
        place = np.array(obj.matrix_world, np.float64)
        assert close(place[:3, :3] @ center + place[:3, 3], truth.mass_properties.center, 1e-6)
    other = bpy.data.objects.new("Other", obj.data)
    bpy.context.scene.collection.objects.link(other)
    bpy.context.view_layer.objects.active = other
    other.select_set(True)
    obj.select_set(False)
    bpy.ops.object.mode_set(mode="EDIT")
    assert obj.mode == "OBJECT" and followed(surface, obj) is None
    bpy.ops.object.mode_set(mode="OBJECT")
    assert followed(surface, obj) is not None
    obj.scale = (1, 1, 1)
    for vertex in obj.data.vertices:
        vertex.co *= 0.1
    obj.data.update()
    assert 0.0 < followed(surface, obj)[0] < 0.01
    for vertex in obj.data.vertices:
        vertex.co.z *= -1.0
    obj.data.update()
    assert followed(surface, obj) is None
    for answer, is_known in (((1.0, np.zeros(3)), True), ((1.0, np.array([0.0, np.nan, 0.0])), False)):
        monkeypatch.setattr(moving_surface, "volume_and_center", lambda _surface, answer=answer: answer)
        assert (followed(surface, obj) is not None) == is_known


def test_what_shows_other_points_no_mesh_or_a_curve_is_not_followed(body):
    obj, whole = body
    surface = MovingSurface.of(whole)
    obj.modifiers.new("Mirror", "MIRROR")
    assert followed(surface, obj) is None
    group = bpy.data.node_groups.new("Nothing", "GeometryNodeTree")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    obj.modifiers[0].show_viewport = False
    assert followed(surface, obj) is not None
    obj.modifiers.new("Nodes", "NODES").node_group = group
    assert followed(surface, obj) is None
    bpy.ops.curve.primitive_bezier_circle_add()
    curve = bpy.context.object
    curve.data.dimensions, curve.data.fill_mode = "3D", "FULL"
    curve.data.bevel_depth, curve.data.use_fill_caps = 0.2, True
    bpy.context.view_layer.update()
    tube = measure_body(curve, bpy.context.evaluated_depsgraph_get(), MeasureOptions(compare=False))
    surface = MovingSurface.of(tube)
    assert surface is None or followed(surface, curve) is None
