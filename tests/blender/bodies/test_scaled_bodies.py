# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A body of each kind that is larger, or in other units, has the numbers and the bounds of a larger
body.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.measure_body import measure_body
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.settings.options import MeasureOptions
from body_moments.core.moments.raw import monomials

from tests.blender.objects import add, mesh_body
from tests.blender.spline_bodies import surface
from tests.close import close
from tests.core.bodies import moebius
from tests.corpus import shapes as s

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


CASES = {
    "box": (s.box((0, 0, 0), (1, 2, 3)), 12),
    "open": (s.without(s.box((0, 0, 0), (1, 2, 3)), 0), 14),
    "turned face": (s.with_flipped(s.box((0, 0, 0), (1, 2, 3)), 1), 12),
    "twice": ((s.box()[0], [*s.box()[1], s.box()[1][0]]), 12),
    "with a leaf": (
        s.joined(s.box(), (np.array([(5.0, 0, 0), (6, 0, 0), (5, 1, 0)]), [(0, 1, 2), (0, 2, 1)])),
        14,
    ),
    "strip": (tuple(map(np.ndarray.tolist, moebius())), None),
}


@pytest.mark.usefixtures("scene")
@pytest.mark.parametrize("scale", [(1, 1, 1), (0.5, 2, -1)])
@pytest.mark.parametrize("name", CASES)
def test_moments_of_any_order_extend_measured_ones(name, scale):
    """Of the volume of what was repaired, and of the area of the faces that are there."""
    (points, faces), count = CASES[name]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(
        np.asarray(points, float).tolist(), [], [list(map(int, face)) for face in faces]
    )
    obj = add(mesh, scale=scale, location=(3, 4, 5), rotation=(0.3, 0.4, 0.5))
    if name == "strip":
        obj.body_moments.kind = "SHELL"
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found = measure_body(obj, depsgraph).body
    if name == "twice":  # the copy is left out of a solid's area
        mesh.clear_geometry()
        mesh.from_pydata(points, [], faces := faces[:-1])
        depsgraph.update()
    sheet = measure_body(obj, depsgraph, MeasureOptions(kind="shell", thickness=1.0)).body.area
    for order in (2, 3, 4, 6):
        volume, area = found.moments(order, True)
        assert (volume.order, area.order) == (order, order)
        assert found.moments(order, False)[1] is None
        low = min(order, 3)
        for one, known in (
            (volume, found.volume),
            (found.moments(order, False)[0], found.volume),
            (area, sheet),
        ):
            known = known.about_point(one.about).truncate(low).raw
            assert np.abs(one.truncate(low).raw - known).max() <= 1e-12 * np.abs(known).max(), (
                order,
                one.measure,
            )
    sheets, solids = (list(found.surfaces(kind)) for kind in (True, False))
    assert [len(one.all_triangles()[0]) for one in sheets] == [sum(len(face) - 2 for face in faces)]
    assert count is None or [len(one.all_triangles()[0]) for one in solids] == [count]
    place = np.array(obj.matrix_world, float)
    truth = np.asarray(points, float) @ place[:3, :3].T + place[:3, 3]
    assert np.abs(sheets[0].points - truth).max() < 1e-5
