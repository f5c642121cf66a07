# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A body of each kind that is larger, or in other units, has the numbers and the bounds of a larger
body.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.settings.options import MeasureOptions
from body_moments.core.moments.moments import monomials

from tests.blender.objects import add, mesh_body
from tests.blender.spline_bodies import surface
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")
THICKNESS = 2.0**-7


def patch():
    u, v = np.meshgrid(np.arange(4.0), np.arange(4.0))
    return surface(np.stack([u, v, 0.25 * u * v], axis=2))


def ball():
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    return bpy.context.object


def ring(dimensions):
    bpy.ops.curve.primitive_nurbs_circle_add()
    bpy.context.object.data.dimensions = dimensions
    return bpy.context.object


def instances():
    members = bpy.data.collections.new("Members")
    for place in (0.0, 8.0):
        member = add(mesh_body(), location=(place, 0.0, 0.0), scale=(1.0, 1.0 + place, 1.0))
        bpy.context.scene.collection.objects.unlink(member)
        members.objects.link(member)
    obj = add(None)
    obj.instance_type, obj.instance_collection = "COLLECTION", members
    return obj


def of_materials():
    mesh = mesh_body()
    for density in (500.0, 7000.0):
        mesh.materials.append(bpy.data.materials.new("Material"))
        mesh.materials[-1].body_moments.density = density
    mesh.polygons.foreach_set("material_index", [i % 2 for i in range(len(mesh.polygons))])
    obj = add(mesh)
    obj.body_moments.density_from = "MATERIALS"
    return obj


def of_an_attribute():
    mesh = mesh_body()
    values = mesh.attributes.new("density", "FLOAT", "POINT").data
    values.foreach_set("value", [100.0 + 10.0 * i for i in range(len(values))])
    obj = add(mesh)
    obj.body_moments.density_from = "ATTRIBUTE"
    return obj


def of_a_polynomial():
    obj = add(mesh_body())
    obj.body_moments.density_from, obj.body_moments.density_polynomial = "POLYNOMIAL", "700"
    return obj


KINDS = {
    "solid": (lambda: add(mesh_body()), {}),
    "sheet": (lambda: add(mesh_body()), {"kind": "shell"}),
    "wall": (lambda: add(mesh_body()), {"kind": "shell", "wall": "inward"}),
    "instances": (instances, {}),
    "instances, sheets": (instances, {"kind": "shell"}),
    "instances, walls": (instances, {"kind": "shell", "wall": "outward"}),
    "patches": (ball, {}),
    "sheet of patches": (patch, {"kind": "shell"}),
    "wall of patches": (patch, {"kind": "shell", "wall": "centered"}),
    "wire": (lambda: ring("3D"), {"kind": "wire"}),
    "region": (lambda: ring("2D"), {"kind": "shell"}),
    "materials": (of_materials, {"density": None}),
    "sheet of materials": (of_materials, {"kind": "shell", "density": None}),
    "attribute": (of_an_attribute, {"kind": "shell", "density": None}),
    "polynomial": (of_a_polynomial, {"density": None}),
    "sheet of a polynomial": (of_a_polynomial, {"kind": "shell", "density": None}),
}


ESTIMATED = {"patches", "sheet of patches", "wall of patches", "wire", "region"}
OPEN = {"sheet of patches", "wall of patches", "region"}
METHODS = {"patches": "NURBS exact", "wire": "wire"}
METHODS |= dict.fromkeys(("solid", "instances", "materials", "polynomial"), "exact")
METHODS |= dict.fromkeys(ESTIMATED - METHODS.keys(), "NURBS shell")


def in_several_sizes(kind, **more):
    """[(by how much it is larger, measurement)] of a body as it is, scaled, and in another unit."""
    make, options = KINDS[kind]
    obj, found = make(), []
    scene, scale, place = bpy.context.scene, np.array(obj.scale), np.array((1.0, 2.0, 3.0))
    for by, unit in ((1.0, 1.0), (4.0, 1.0), (1.0, 0.25)):
        scene.unit_settings.scale_length, obj.scale, obj.location = unit, by * scale, by * place
        bpy.context.view_layer.update()
        given = MeasureOptions(
            **{"density": 1000.0, **options, **more}, thickness=by * unit * THICKNESS
        )
        found.append((by * unit, measure_object(obj, bpy.context.evaluated_depsgraph_get(), given)))
    return found


@pytest.mark.parametrize("kind", KINDS)
def test_a_larger_body_has_larger_numbers_and_bounds(kind):
    (_, plain), *larger = in_several_sizes(kind)
    assert plain.error_bound.get("estimated", False) == (kind in ESTIMATED)
    assert str(plain.method) == METHODS.get(kind, "shell")
    assert (plain.health.closed, plain.health.components) == (
        kind not in OPEN,
        2 if "instances" in kind else 1,
    )
    power = 3 if kind == "wire" else 5
    rows = {"volume": 3, "area": 2, "center_of_mass": 1, "inertia": power}
    for factor, found in larger:
        assert [one.code for one in found.findings] == [one.code for one in plain.findings]
        assert close(found.volume, factor**3 * plain.volume, 1e-12)
        assert close(found.area, factor**2 * plain.area, 1e-12)
        assert close(found.location, factor * plain.location, 1e-12)
        body, own_body = found.mass_properties, plain.mass_properties
        assert close(body.mass, factor ** (power - 2) * own_body.mass, 1e-12)
        assert close(body.center, factor * own_body.center, 1e-9)
        for now, own in (
            (found.error_bound, plain.error_bound),
            (found.error_bound["input"], plain.error_bound["input"]),
        ):
            for name, degree in rows.items():
                assert close(now[name], factor**degree * own[name], 1e-6), name


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "wall of patches"])
def test_moments_of_larger_body_grow_by_their_degree(kind):
    (_, plain), *larger = in_several_sizes(kind, order=4, surface=True)
    for factor, found in larger:
        for name, dimension in (("volume_moments", 3), ("area_moments", 2)):
            now, own = getattr(found, name), getattr(plain, name)
            if own is None:
                assert now is None
                continue
            growth = factor ** (dimension + monomials(4).sum(axis=1))
            assert own.order == 4 and close(now.about, factor * own.about, 1e-9)
            assert (np.abs(now.raw - growth * own.raw) <= now.rounding_error).all()
            for bound in ("rounding_error", "input_error"):
                assert close(getattr(now, bound), growth * getattr(own, bound), 1e-6), (name, bound)
