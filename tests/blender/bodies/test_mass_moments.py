# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of the mass to any order, for every source of density: closed forms over boxes, within
the bounds.
"""

import math

import bpy
import numpy as np
import pytest
from body_moments.core.moments.raw import monomials

from tests.blender.batch_files import measured
from tests.blender.grids import vdb_grid, volume_object
from tests.blender.objects import add
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")

LOW, HIGH = np.array([10.0, -3.0, 0.5]), np.array([11.0, -1.0, 3.5])
ORDER = 12


def box_mesh(low, high):
    mesh = bpy.data.meshes.new("Box")
    corners = [
        [(low, high)[bit][axis] for axis, bit in enumerate(bits)] for bits in np.ndindex(2, 2, 2)
    ]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata(corners, [], faces)
    return mesh


def box_moments(low, high, powers):
    n = np.asarray(powers) + 1.0
    return np.prod((np.asarray(high) ** n - np.asarray(low) ** n) / n)


def box(low=LOW, high=HIGH, name="Box"):
    """Its corners are numbers that float32 holds, and so are the maps."""
    return add(box_mesh(low, high), name)


def mass_moments(*words, order=ORDER):
    """(K,) the moments, and their bounds together, of the one object, about the center of the
    box.
    """
    middle = (LOW + HIGH) / 2.0
    moments = measured("--order", order, "--about", ",".join(map(str, middle)), *words)["moments"]
    keys = [",".join(map(str, powers)) for powers in monomials(order).tolist()]
    return tuple(
        np.array([table["mass"][key] for key in keys])
        for table in (moments, moments["error"], moments["input"])
    )


def assert_moments(truth, words=(), order=ORDER, rel=1e-12, reach=(HIGH - LOW) / 2.0):
    """truth: of powers about the box's center. reach: of the body from there."""
    found, error, moved = mass_moments(*words, order=order)
    expected = np.array([truth(powers) for powers in monomials(order).tolist()])
    scale = found[0] * np.prod(reach ** monomials(order), axis=1)
    assert (np.abs(found - expected) <= rel * scale).all()
    assert (np.abs(found - expected) <= error + moved + 1e-15 * scale).all()


def centered(powers, low=LOW, high=HIGH):
    middle = (LOW + HIGH) / 2.0
    return box_moments(low - middle, high - middle, powers)


def test_one_value_and_a_given_mass():
    box()
    assert_moments(lambda powers: 2500.0 * centered(powers), ["--density", "2500"])
    assert_moments(lambda powers: 9.0 / 6.0 * centered(powers), ["--mass", "9"])


def test_a_polynomial():
    obj = box()
    obj.body_moments.density_from, obj.body_moments.density_polynomial = "POLYNOMIAL", "100 + 20*z"
    obj.body_moments.density_frame = "WORLD"
    assert_moments(
        lambda powers: 140.0 * centered(powers) + 20.0 * centered(np.add(powers, (0, 0, 1)))
    )


def test_materials_by_part():
    """Two boxes in one mesh."""
    other = np.array([20.0, 0.0, 0.0])
    obj = box()
    second = box_mesh(LOW + other, HIGH + other)
    for mesh, density, name in ((obj.data, 1000.0, "Light"), (second, 3000.0, "Heavy")):
        material = bpy.data.materials.new(name)
        material.body_moments.density = density
        mesh.materials.append(material)
    joined = bpy.data.objects.new("Other", second)
    bpy.context.collection.objects.link(joined)
    with bpy.context.temp_override(
        active_object=obj,
        selected_editable_objects=[obj, joined],
        object=obj,
        selected_objects=[obj, joined],
    ):
        bpy.ops.object.join()
    obj.body_moments.density_from = "MATERIALS"
    assert_moments(
        lambda powers: (
            1000.0 * centered(powers) + 3000.0 * centered(powers, LOW + other, HIGH + other)
        ),
        order=5,
        reach=(20.5, 1.0, 1.5),
    )


def test_a_vertex_attribute_of_a_shell():
    """ρ = 100 + 10 x over a square in the plane x + 0: its moments are those of a polynomial."""
    points = [(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (2.0, 1.0, 0.0), (0.0, 1.0, 0.0)]
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(points, [], [(0, 1, 2, 3)])
    attribute = mesh.attributes.new("weight", "FLOAT", "POINT")
    for i, (x, *_) in enumerate(points):
        attribute.data[i].value = 100.0 + 10.0 * x
    obj = add(mesh, "Sheet")
    settings = obj.body_moments
    settings.kind, settings.thickness, settings.density_from, settings.density_attribute = (
        "SHELL", 0.125, "ATTRIBUTE", "weight",
    )  # fmt: skip
    moments = measured("--order", 9)["moments"]
    for p, q in ((0, 0), (4, 2), (9, 0), (3, 6)):
        truth = (
            0.125 * (100.0 * 2.0 ** (p + 1) / (p + 1) + 10.0 * 2.0 ** (p + 2) / (p + 2)) / (q + 1)
        )
        key = "{},{},0".format(p, q)
        assert close(moments["mass"][key], truth, rel=1e-13)
        assert (
            abs(moments["mass"][key] - truth)
            <= moments["error"]["mass"][key] + moments["input"]["mass"][key]
        )
    assert moments["mass"]["0,0,1"] == 0.0


def test_a_volume_object_within_a_solid(tmp_path):
    """Voxels of 1 m whose density is 10 above z = 2 and 30 below: a box of two layers."""
    values = np.full((4, 4, 6), 10.0, np.float32)
    values[:, :, :2] = 30.0
    matrix = np.eye(4)
    matrix[:3, 3] = (9.5, -3.5, 0.5)  # voxel (0, 0, 0) is the cube from (9, -4, 0)
    grid = volume_object(tmp_path / "grid.vdb", vdb_grid(values, matrix=matrix))
    obj = box()
    obj.body_moments.density_from, obj.body_moments.density_volume = "VOLUME", grid
    grid.hide_render = True
    cut = np.array([HIGH[0], HIGH[1], 2.0])
    assert_moments(
        lambda powers: (
            30.0 * centered(powers, LOW, cut)
            + 10.0 * centered(powers, np.array([*LOW[:2], 2.0]), HIGH)
        ),
        ["--object", "Box"],
        order=6,
    )


@pytest.mark.parametrize("spline_order", [1, 2, 4])
def test_a_grid_with_any_spline_order(tmp_path, spline_order):
    """One voxel: its spline is a product of three, whose moments are those of a sum of uniform
    numbers.
    """
    obj = volume_object(tmp_path / "grid.vdb", vdb_grid(np.full((1, 1, 1), 7.0, np.float32)))
    obj.body_moments.spline_order = spline_order
    moments = measured("--order", 8)["moments"]["mass"]

    def central(power):
        """E (u_1 + … + u_k)^power, u uniform on [-1/2, 1/2]."""
        table = [1.0] + power * [0.0]
        for _ in range(spline_order):
            uniform = [(0.5 ** (n + 1) - (-0.5) ** (n + 1)) / (n + 1) for n in range(power + 1)]
            table = [
                sum(math.comb(n, k) * table[n - k] * uniform[k] for k in range(n + 1))
                for n in range(power + 1)
            ]
        return table[power]

    for powers in ((0, 0, 0), (2, 0, 0), (4, 2, 2), (8, 0, 0), (0, 0, 6)):
        truth = 7.0 * np.prod([central(power) for power in powers])
        assert close(moments["{},{},{}".format(*powers)], truth, rel=1e-12)


def test_the_panel_computes_moments_of_the_mass():
    obj = box()
    obj.body_moments.density_from, obj.body_moments.density_polynomial = "POLYNOMIAL", "100 + 20*z"
    obj.body_moments.density_frame = "WORLD"
    bpy.context.view_layer.objects.active = obj
    settings = bpy.context.scene.body_moments
    settings.moments_order, settings.moments_of = 5, "MASS"
    assert bpy.ops.object.body_moments_compute_moments() == {"FINISHED"}
    from body_moments.blender.session import memory
    from body_moments.blender.session.stored import computed_moments
    from body_moments.blender.session.stored import moments as table

    computed = memory.moments[obj]
    degrees, missing = table.current_numbers(obj, bpy.context.scene)
    assert missing is None and [degree.unit for degree in degrees][:3] == ["kg", "kg·m", "kg·m²"]
    assert close(computed.mass.total, 6.0 * 140.0, rel=1e-12) and computed.mass.order == 5
    text = computed_moments.as_csv(computed, "MASS", "ORIGIN", "WORLD")
    assert text.startswith("# Box: mass moments") and len(text.splitlines()) == 2 + 56
    settings.moments_about = "NORMALIZED"
    assert table.current_numbers(obj, bpy.context.scene)[1] is None
