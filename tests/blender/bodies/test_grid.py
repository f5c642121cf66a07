# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume objects: voxels to the bit, and numbers through every
transform and type.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.read import vdb, volume
from body_moments.blender.session.tracking import staleness
from body_moments.blender.write import properties
from body_moments.core.bodies.grid import Samples, density_body
from body_moments.core.verdict import MeasureError, ReadError

from tests.blender.findings import refused, said
from tests.blender.grids import (
    SHEARED,
    depsgraph,
    linked,
    measure,
    mesh_to_volume,
    vdb_grid,
    volume_object,
)
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def dense(reading) -> np.ndarray:
    """The whole box, in the values' own type."""
    blocks = list(reading.blocks())
    array = np.full(reading.shape, reading.background, blocks[0][1].dtype)
    for start, block in blocks:
        array[tuple(slice(a, a + n) for a, n in zip(start, block.shape))] = block
    return array


def random_values(dtype, shape=(9, 20, 33), seed=0):
    values = np.random.default_rng(seed).uniform(0.0, 4.0, shape)
    return (values * (values > 1.0)).astype(dtype)


def expected_body(values, matrix):
    """Mass, center and inertia of voxels with these densities by a plain sum over boxes."""
    index = np.stack(np.meshgrid(*map(np.arange, values.shape), indexing="ij"), axis=-1).reshape(
        -1, 3
    )
    masses = values.reshape(-1).astype(float) * abs(np.linalg.det(matrix[:3, :3]))
    points = index @ matrix[:3, :3].T + matrix[:3, 3]
    mass = masses.sum()
    center = masses @ points / mass
    arms = points - center
    second = (
        np.einsum("n,ni,nj->ij", masses, arms, arms) + mass * matrix[:3, :3] @ matrix[:3, :3].T / 12
    )
    return mass, center, np.trace(second) * np.eye(3) - second


def check(measurement, values, matrix):
    mass, center, inertia = expected_body(values, matrix)
    body = measurement.mass_properties
    size = np.sqrt(np.trace(inertia) / mass)
    assert close(body.mass, mass, rel=1e-6)
    assert np.abs(body.center - center).max() <= 1e-6 * (size + np.abs(center).max())
    assert np.abs(body.inertia - inertia).max() <= 3e-6 * np.trace(inertia)


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.int32, np.int64, np.bool_])
def test_voxels_of_every_type_are_read_to_the_bit(tmp_path, dtype):
    values = random_values(dtype)
    obj = volume_object(tmp_path / "a.vdb", vdb_grid(values, "density", SHEARED, (-5, 130, 7)))
    with volume.volume_reading(obj, depsgraph()) as reading:
        found = dense(reading)
        assert found.dtype == values.dtype
        corner = np.array(np.nonzero(values)).min(axis=1)
        assert (reading.low == corner + (-5, 130, 7)).all()
        end = corner + reading.shape
        assert np.array_equal(found, values[tuple(map(slice, corner, end))])
        assert np.array_equal(reading.to_object, SHEARED)


def test_grid_without_openvdb_module_is_refused(tmp_path, monkeypatch):
    obj = volume_object(tmp_path / "a.vdb", vdb_grid(random_values(np.float32)))
    monkeypatch.setattr(vdb, "openvdb", lambda: None)
    with refused("grid_unsupported", grid="density"):
        measure(obj)


@pytest.mark.parametrize("kind", ["SHELL", "WIRE"])
def test_volume_object_is_solid_for_any_kind(kind):
    bpy.ops.mesh.primitive_cube_add(location=(3, 0, 0))
    fog = mesh_to_volume(bpy.context.object)
    solid = measure(fog)
    fog.body_moments.kind = kind
    found = measure(fog)
    assert found.kind == "solid" and found.mass_properties.mass == solid.mass_properties.mass > 0.0
    assert found.fingerprint == solid.fingerprint
    with pytest.raises(ReadError):
        measure(fog, kind=kind.lower())


def test_volume_made_by_modifier_is_read():
    bpy.ops.mesh.primitive_cube_add(location=(3, 0, 0))
    fog = mesh_to_volume(bpy.context.object)
    fog.modifiers[0].interior_band_width = 0.01
    found = measure(fog)
    assert str(found.method) == "grid exact"
    assert found.mass_properties.mass == pytest.approx(8.0, rel=0.25)
    assert found.mass_properties.center == pytest.approx([3, 0, 0], abs=0.11)


def snapshot():
    return {
        name: [(block.name, block.users, block.session_uid) for block in getattr(bpy.data, name)]
        for name in (
            "objects",
            "meshes",
            "node_groups",
            "scenes",
            "volumes",
            "collections",
            "worlds",
        )
    }


def test_reading_leaves_nothing_behind(tmp_path):
    obj = volume_object(tmp_path / "a.vdb", vdb_grid(random_values(np.float32)))
    properties.store(obj, measure(obj))
    staleness.mark_up_to_date(bpy.context, [obj])
    before, scene = snapshot(), bpy.context.scene
    measure(obj)
    with (
        pytest.raises(RuntimeError, match="stop"),
        volume.volume_reading(obj, depsgraph()) as reading,
    ):
        next(iter(reading.blocks()))
        raise RuntimeError("stop")
    assert snapshot() == before
    assert bpy.context.scene == scene
    assert staleness.stale_reason(obj, scene) is None


TRANSFORMS = {
    "plain": {},
    "moved": {"location": (100, -200, 300)},
    "turned": {"rotation_euler": (0.3, 0.5, -1.0)},
    "uneven": {"scale": (2, 0.5, 3), "rotation_euler": (0.1, 0.2, 0.3)},
    "mirrored": {"scale": (-1, 1, 1), "location": (1, 2, 3)},
    "tiny": {"scale": (1e-6, 1e-6, 1e-6)},
}


@pytest.mark.parametrize("name", TRANSFORMS)
@pytest.mark.parametrize("matrix", [np.eye(4), SHEARED], ids=["plain", "sheared"])
def test_grid_and_object_transforms(tmp_path, name, matrix):
    values = random_values(np.float32, (6, 7, 8))
    obj = volume_object(tmp_path / "a.vdb", vdb_grid(values, matrix=matrix, offset=(-2, 4, 9)))
    for key, value in TRANSFORMS[name].items():
        setattr(obj, key, value)
    found = measure(obj)
    offset = np.eye(4)
    offset[:3, 3] = (-2, 4, 9)
    check(found, values, np.array(obj.matrix_world, float) @ matrix @ offset)
    filled = np.count_nonzero(values) * abs(
        np.linalg.det((np.array(obj.matrix_world, float) @ matrix)[:3, :3])
    )
    assert close(found.volume, filled, rel=1e-6)
    assert found.density == pytest.approx(found.mass_properties.mass / found.volume, rel=1e-12)


def test_a_sheared_parent_and_the_unit_scale(tmp_path):
    values = random_values(np.float32, (5, 5, 5))
    obj = volume_object(tmp_path / "a.vdb", vdb_grid(values))
    parent = linked(bpy.data.objects.new("Parent", None))
    parent.scale, parent.rotation_euler = (3, 1, 1), (0, 0, 0.5)
    obj.parent, obj.rotation_euler = parent, (0.2, 0, 0.7)
    bpy.context.scene.unit_settings.scale_length = 0.001
    found = measure(obj)
    matrix = np.array(obj.matrix_world, float)
    matrix[:3] *= 0.001
    check(found, values, matrix)


def test_given_mass_and_density_options(tmp_path):
    obj = volume_object(tmp_path / "a.vdb", vdb_grid(random_values(np.float32)))
    plain = measure(obj)
    assert close(measure(obj, mass=5.0).mass_properties.mass, 5.0, rel=1e-14)
    twice = measure(obj, density=2.0)
    assert twice.mass_properties.mass == pytest.approx(2.0 * plain.mass_properties.mass, rel=1e-14)
    with refused("grid_as_shell", obj.name):
        measure(obj, kind="shell")


def test_ct_numbers_become_tissue(tmp_path):
    values = np.array([-1000.0, -98.0, 14.0, 1600.0], np.float32).reshape(1, 1, 4)
    obj = volume_object(tmp_path / "a.vdb", vdb_grid(values, background=-2000.0))
    with refused("values_negative", density=-1000.0):
        measure(obj)
    obj.body_moments.values_from = "TABLE"
    found = measure(obj)
    assert found.mass_properties.mass == pytest.approx(1.21 + 930 + 1030 + 1964.2, rel=1e-14)
    assert said(found)["background_empty"] == {"value": -2000.0}
    assert said(found)["grid_density"]["cause"]["code"] == "values_by_table"
    obj.body_moments.transfer_table = "1 2, 1 3"
    with refused("transfer_table_numbers"):
        measure(obj)


def test_the_grid_is_chosen(tmp_path):
    one, two = random_values(np.float32, (4, 4, 4)), random_values(np.float32, (4, 4, 4), 7)
    obj = volume_object(tmp_path / "a.vdb", vdb_grid(one, "alpha"), vdb_grid(two, "density"))
    found = measure(obj)
    assert found.mass_properties.mass == pytest.approx(two.sum(dtype=float), rel=1e-12)
    assert said(found)["others_left_out"] == {
        "kind": "grid",
        "name": "density",
        "others": ["alpha"],
    }
    obj.body_moments.grid = "alpha"
    assert measure(obj).mass_properties.mass == pytest.approx(one.sum(dtype=float), rel=1e-12)
    obj.body_moments.grid = "nothing"
    with refused("grid_missing", grid="nothing", grids=["alpha", "density"]):
        measure(obj)


def test_vectors_are_no_density(tmp_path):
    grid = vdb.openvdb().Vec3SGrid()
    grid.name = "velocity"
    grid.fill((0, 0, 0), (3, 3, 3), (1.0, 0.0, 0.0))
    obj = volume_object(tmp_path / "a.vdb", grid)
    with refused("no_scalar_grid", grids=["velocity"]):
        measure(obj)
    obj.body_moments.grid = "velocity"
    with refused("grid_unsupported", grid="velocity"):
        measure(obj)


def level_set(path, radius=2.0, size=0.1):
    grid = vdb.openvdb().createLevelSetSphere(radius=radius, center=(5.0, 0.0, 0.0), voxelSize=size)
    grid.name = "distance"
    return volume_object(path, grid)


def test_level_set_is_no_density_and_measures_as_solid(tmp_path):
    obj = level_set(tmp_path / "a.vdb")
    with refused("grid_unsupported", grid="distance"):
        measure(obj)
    obj.body_moments.grid_as = "SOLID"
    found = measure(obj)
    assert str(found.method) == "grid exact"
    exact = 4 / 3 * np.pi * 8
    assert 0.0 < exact - found.volume < 4e-3 * exact  # its polygons are chords
    finer = level_set(tmp_path / "b.vdb", size=0.05)
    finer.body_moments.grid_as = "SOLID"
    assert exact - measure(finer).volume == pytest.approx((exact - found.volume) / 4, rel=0.1)
    assert found.mass_properties.mass == pytest.approx(1000 * found.volume, rel=1e-12)
    assert found.mass_properties.center == pytest.approx([5, 0, 0], abs=1e-3)
    told = said(found)["level_set_measured"]
    # through each voxel
    assert told["grid"] == "distance" and 1.3 < told["polygons"] * 0.1**2 / found.area < 1.6


def test_volume_without_file_is_refused_after_saving(tmp_path):
    """Blender saves its empty path as one of a folder."""
    linked(bpy.data.objects.new("Empty", bpy.data.volumes.new("Empty")))
    bpy.ops.mesh.primitive_cube_add()
    mesh_to_volume(bpy.context.object)
    path = str(tmp_path / "empty.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    with refused("no_scalar_grid", "Empty"):
        measure(bpy.data.objects["Empty"])
    assert measure(bpy.data.objects["Fog"]).volume > 0.0


def test_unmeasurable_volumes_are_refused_with_reason(tmp_path):
    empty = linked(bpy.data.objects.new("Empty", bpy.data.volumes.new("Empty")))
    with (
        refused("no_scalar_grid", "Empty"),
        volume.volume_reading(empty, bpy.context.evaluated_depsgraph_get()),
    ):
        pass
    missing = linked(bpy.data.objects.new("Missing", bpy.data.volumes.new("Missing")))
    missing.data.filepath = str(tmp_path / "none.vdb")
    with pytest.raises(MeasureError) as caught:
        measure(missing)
    assert caught.value.finding.values["error"].endswith("none.vdb not found")
    nothing = volume_object(tmp_path / "a.vdb", vdb_grid(np.zeros((4, 4, 4), np.float32)))
    with refused("grid_empty", nothing.name):
        measure(nothing)
    source = vdb.VdbGrid(str(tmp_path / "a.vdb"), "density")
    assert source.low.tolist() == source.shape.tolist() == [0, 0, 0]
    flat = volume_object(tmp_path / "c.vdb", vdb_grid(random_values(np.float32)))
    flat.scale = (1, 0, 1)
    with refused("grid_transform_singular"):
        measure(flat)
    far = np.zeros((2, 2, 2), np.float32)
    far[0, 0, 0] = 1.0
    grid = vdb_grid(far, offset=(-(2**30), -(2**30), -(2**30)))
    grid.fill((2**30,) * 3, (2**30,) * 3, 1.0)
    with refused("grid_too_large", grid="density"):
        measure(volume_object(tmp_path / "d.vdb", grid))


def test_a_mesh_that_its_nodes_turn_into_a_volume():
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.object
    tree = bpy.data.node_groups.new("Fog", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    start, end, fog = (
        tree.nodes.new(name)
        for name in ("NodeGroupInput", "NodeGroupOutput", "GeometryNodeMeshToVolume")
    )
    tree.links.new(start.outputs[0], fog.inputs[0])
    tree.links.new(fog.outputs[0], end.inputs[0])
    cube.modifiers.new("Fog", "NODES").node_group = tree
    found = measure(cube)
    assert str(found.method) == "grid exact"
    assert found.mass_properties.center == pytest.approx([0, 0, 0], abs=0.05)
    properties.store(cube, found)
    staleness.mark_up_to_date(bpy.context, [cube])
    assert staleness.stale_reason(cube, bpy.context.scene) is None


def test_higher_orders_of_the_voxels_that_are_not_empty(tmp_path):
    obj = volume_object(tmp_path / "a.vdb", vdb_grid(np.full((4, 2, 6), 0.5, np.float32)))
    assert measure(obj, order=4).area_moments.order == 0
    found = measure(obj, order=4, surface=True)
    moments = found.volume_moments.about_point([1.5, 0.5, 2.5])
    assert moments[4, 0, 0] == pytest.approx(2 * 2**5 / 5 * 2 * 6, rel=1e-13)
    assert moments[0, 2, 2] == pytest.approx(4 * (2 / 3) * (2 * 27 / 3), rel=1e-13)
    assert not found.area_moments.raw.any()


def with_nodes(obj, *makers):
    """A modifier that joins with the object's own geometry what the makers give, from a tree an
    output socket each.
    """
    tree = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    join, end = tree.nodes.new("GeometryNodeJoinGeometry"), tree.nodes.new("NodeGroupOutput")
    tree.links.new(join.outputs[0], end.inputs[0])
    for socket in (tree.nodes.new("NodeGroupInput").outputs[0], *(make(tree) for make in makers)):
        tree.links.new(socket, join.inputs[0])
    obj.modifiers.new("Nodes", "NODES").node_group = tree
    return obj


def an_instance(tree):
    cube, instance = (
        tree.nodes.new("GeometryNodeMeshCube"),
        tree.nodes.new("GeometryNodeGeometryToInstance"),
    )
    tree.links.new(cube.outputs[0], instance.inputs[0])
    return instance.outputs[0]


ONES = np.ones((8, 8, 8), np.float32)


@pytest.mark.parametrize("value", [np.inf, -np.inf, np.nan])
@pytest.mark.parametrize("table", [False, True])
def test_no_voxel_that_is_not_finite_has_a_density(tmp_path, value, table):
    grid = vdb_grid(ONES)
    grid.getAccessor().setValueOn((1, 2, 3), value)
    obj = volume_object(tmp_path / "a.vdb", grid)
    obj.body_moments.values_from = "TABLE" if table else "FACTOR"
    with pytest.raises(MeasureError) as caught:
        measure(obj)
    negative = "values_negative" if value == -np.inf else "density_non_finite"
    assert caught.value.finding.code == ("density_non_finite" if table else negative)


def test_numbers_too_large_or_too_far_are_refused(tmp_path):
    with refused("mass_overflow"):
        measure(volume_object(tmp_path / "a.vdb", vdb_grid(np.full((4, 4, 4), 1e300))))
    with refused("grid_unsupported", grid="density"):
        measure(volume_object(tmp_path / "b.vdb", vdb_grid(ONES, offset=(5, 1 << 29, -5))))


def test_a_grid_on_a_frustum_is_refused(tmp_path):
    grid = vdb_grid(ONES)
    grid.transform = vdb.openvdb().createFrustumTransform((0, 0, 0), (7, 7, 7), 0.5, 2.0)
    with refused("grid_unsupported", "Cloud", grid="density"):
        measure(volume_object(tmp_path / "a.vdb", grid))


def test_damaged_volume_file_is_refused_with_grid_name(tmp_path):
    """Blender reads the list of grids, and voxels only when they are shown."""
    path = tmp_path / "a.vdb"
    obj = volume_object(path, vdb_grid(random_values(np.float32)))
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    with refused("grid_unreadable", "Cloud", grid="density"):
        measure(obj)


def test_instances_of_empty_volume_are_its_body():
    obj = with_nodes(
        linked(bpy.data.objects.new("Empty", bpy.data.volumes.new("Empty"))), an_instance
    )
    assert close(measure(obj).volume, 1.0, rel=1e-6)


def test_a_packed_volume_is_read_from_the_file_that_it_is_in(tmp_path):
    obj = volume_object(tmp_path / "a.vdb", vdb_grid(ONES))
    truth = measure(obj).mass_properties.mass
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.file.pack_all()
    assert obj.data.packed_file is not None
    vdb.openvdb().write(str(tmp_path / "a.vdb"), [vdb_grid(2 * ONES)])
    assert measure(obj).mass_properties.mass == truth > 0.0


def test_empty_background_and_positions_hold_for_any_order():
    samples = np.array([5.0, 1.0, 2.0, 5.0, 3.0]).reshape(5, 1, 1)
    places = np.array([0.0, 1.0, 3.0, 4.0, 8.0])
    place = {"background": 5.0, "positions": (places, None, None)}
    body = density_body(Samples(samples, samples.shape, np.eye(4), **place), order=5)
    ends = np.concatenate([[-0.5], (places[1:] + places[:-1]) / 2.0, [10.0]])
    thick = np.diff(ends)[[1, 2, 4]]
    assert close(body.mass.total, (thick * [1.0, 2.0, 3.0]).sum(), rel=1e-12)
    assert close(body.higher_mass.total, body.mass.total, rel=1e-12)
    for moments in (body.volume, body.moments(5, False)[0]):
        assert close(moments.total, thick.sum(), rel=1e-12)
    assert [one.code for one in body.findings] == ["background_empty", "grid_without_surface"]
    with refused("grid_empty"):
        density_body(Samples(np.zeros((0, 2, 2)), (0, 2, 2), np.eye(4)))
