# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a body's density is of and what carries its mass; what settings fill in that a caller leaves open."""

from contextlib import ExitStack
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.core.moments.moments import Measure, Moments
from body_moments.core.verdict.finding import finding
from body_moments.core.verdict.health import MeshHealth
from body_moments.core.verdict.method import Method, Verdict
from body_moments.operators.bodies.body import Body
from body_moments.operators.bodies.measurement import _weighed, extent
from body_moments.operators.bodies.request import Request, with_object_settings
from body_moments.operators.settings.options import AS_SET, MeasureOptions

from tests.blender.bodies.test_assembly import box_mesh
from tests.blender.findings import refused
from tests.blender.objects import add
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def moments(total, measure=Measure.VOLUME):
    return Moments(np.concatenate([[total], np.full(19, -7.0)]), np.zeros(3), measure)


def body(volume=0.0, area=0.0, **more):
    extents = moments(volume), moments(area, Measure.AREA)
    given = {name: moments(value) if name in ("mass", "wall", "length") else value for name, value in more.items()}
    return Body(*extents, MeshHealth(closed=True), Method(Verdict.EXACT), (), **given)


def options(kind="solid", thickness=0.0, mass=None, density=None):
    return SimpleNamespace(kind=kind, thickness=thickness, mass=mass, density=density)


@pytest.mark.parametrize(
    ("of", "asked", "total"),
    [
        (body(0.5, 9.0), options(thickness=2.0), 0.5),
        (body(0.5, 0.25), options("shell", 0.5), 0.125),
        (body(0.5, 0.25, wall=0.75), options("shell", 0.5), 0.75),
        (body(0.5, 0.25, length=4.0), options("wire"), 4.0),
    ],
)
def test_the_density_is_of_the_volume_of_a_sheet_of_a_wall_or_of_a_length(of, asked, total):
    assert extent(of, asked).total == total


@pytest.mark.parametrize(
    ("of", "asked", "code"),
    [
        (body(0.0, 0.5, face_count=2), options(), "no_volume"),
        (body(0.0, 0.0, face_count=2), options(), "no_face_area"),
        (body(0.0, 0.0), options(), "no_volume"),
        (body(0.5, 0.5, face_count=2), options("shell"), "no_thickness"),
        (body(0.5, 0.5, wall=0.0, face_count=2), options("shell", 1.0), "no_thickness"),
        (body(0.5, 0.0, face_count=2), options("shell", 1.0), "no_face_area"),
        (body(0.5, 0.0), options("shell", 1.0), "no_volume"),
    ],
)
def test_what_has_no_extent_is_refused_with_what_it_lacks(of, asked, code):
    with refused(code):
        extent(of, asked)


def test_a_mass_is_carried_by_what_it_is_spread_over():
    plain, weighed, wire = body(0.5, 0.25), body(0.5, 0.25, mass=3.0), body(0.5, 0.25, length=4.0)
    volume, half = plain.volume, moments(0.5)
    for of, thin, asked, carrier, factor, density in (
        (plain, False, options(density=6.0), volume, 6.0, 6.0),
        (plain, False, options(mass=6.0), volume, 12.0, 12.0),
        (plain, True, options("shell", 2.0, density=6.0), plain.area, 12.0, 6.0),
        (wire, False, options("wire", density=6.0), wire.length, 6.0, 6.0),
        (weighed, False, options(density=1.0), weighed.mass, 1.0, 6.0),
        (weighed, False, options(mass=12.0), weighed.mass, 4.0, 24.0),
    ):
        found = _weighed(of, half, of.volume, thin, asked)
        assert found[0] is carrier and close(found[1:], [factor, density], 1e-15)
    for of, asked, code in (
        (plain, options(), "zero_density"),
        (plain, options(density=0.0), "zero_density"),
        (plain, options(mass=0.0), "zero_mass"),
        (body(0.5, mass=-1.0), options(), "zero_density"),
    ):
        with refused(code):
            _weighed(of, half, of.volume, False, asked)


def test_what_a_caller_leaves_open_is_as_the_object_has_it():
    obj = add(box_mesh(1, 2, 3))
    settings, scene = obj.body_moments, bpy.context.scene
    settings.kind, settings.thickness, settings.wall, settings.overlap = "SHELL", 0.25, "INWARD", "UNION"
    settings.density = 500.0

    def filled(unit=0.5, **given):
        found = with_object_settings(MeasureOptions(**given), obj, unit, scene)
        return found.kind, found.density, found.mass, found.thickness, found.wall, found.overlap

    assert filled() == ("shell", 500.0, None, 0.125, "inward", "union")
    asked = {"kind": "solid", "thickness": 0.75, "wall": "outward", "overlap": "signed"}
    assert filled(**asked) == ("solid", 500.0, None, 0.75, "outward", "signed")
    assert filled(density=3.0)[1:3] == (3.0, None) and filled(mass=4.0)[1:3] == (None, 4.0)
    settings.mass_from, settings.mass = "MASS", 7.0
    assert filled()[1:3] == (None, 7.0)
    assert filled(density=3.0)[1:3] == (3.0, None) and filled(mass=4.0)[1:3] == (None, 4.0)
    settings.mass_from, settings.linear_density = "DENSITY", 0.5
    assert filled(kind="wire")[:3] == ("wire", 0.5, None)
    cloud = bpy.data.objects.new("Cloud", bpy.data.volumes.new("Cloud"))
    cloud.body_moments.kind = "SHELL"
    assert with_object_settings(MeasureOptions(), cloud, 1.0, scene).kind == "solid"


def test_lengths_are_in_the_unit_that_is_given_else_in_that_of_the_scene():
    obj, opened = add(box_mesh(1, 2, 3)), ExitStack()
    bpy.context.scene.unit_settings.scale_length = 0.25
    obj.body_moments.kind, obj.body_moments.thickness = "SHELL", 0.5
    depsgraph = bpy.context.evaluated_depsgraph_get()
    own = MeasureOptions(unit_scale=0.125)
    for given, unit, expected in ((AS_SET, None, 0.25), (own, None, 0.125), (own, 2.0, 2.0), (AS_SET, 2.0, 2.0)):
        request = Request.of(obj, depsgraph, given, unit=unit, opened=opened)
        assert (request.unit, request.options.thickness) == (expected, 0.5 * expected)
        assert request.given is given and request.obj == obj and request.opened is opened
        assert request.depsgraph == depsgraph and request.scene == bpy.context.scene
    assert isinstance(Request.of(obj, depsgraph).opened, ExitStack)
    assert Request.of(obj, None, unit=1.0).scene == bpy.context.scene


def test_the_density_varies_where_the_object_says_so_and_nothing_else_is_given():
    obj = add(box_mesh(1, 2, 3))
    settings = obj.body_moments
    settings.density_from, settings.density_polynomial = "POLYNOMIAL", "1000 + 10*x"
    depsgraph = bpy.context.evaluated_depsgraph_get()

    def density(**given):
        return Request.of(obj, depsgraph, MeasureOptions(**given)).density

    assert density() is not None and density(kind="shell") is not None
    assert density(density=5.0) is None and density(mass=5.0) is None and density(kind="wire") is None
    settings.mass_from = "MASS"
    assert density() is None
    settings.mass_from, settings.density_from = "DENSITY", "VALUE"
    assert density() is None


def test_why_others_could_not_read_an_object_is_among_what_is_said_of_its_surfaces():
    obj = add(box_mesh(1, 2, 3))
    request = Request.of(obj, bpy.context.evaluated_depsgraph_get())
    request.findings.append(finding("density_defaulted"))
    assert "density_defaulted" in [found.code for found in request.surfaces.findings]
    assert request.surfaces is request.surfaces and request.accepted == frozenset()
