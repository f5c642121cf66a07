# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects through the frames of an animation: which are sampled by their shape keys, and which are measured."""

import bpy
import numpy as np
import pytest
from body_moments.blender.session.live import motion
from body_moments.core.statics.mixes import sample_count

from tests.blender.findings import refused
from tests.blender.objects import add, measured, mesh_body, strip_mesh

pytestmark = pytest.mark.usefixtures("scene")


def keyed(mesh=None):
    """A prism over a quad whose base turns concave, so that it is cut otherwise, from a third of the second key on."""
    mesh = mesh or mesh_body(points=[(0, 0, 0), (4, 0, 0), (4, 1, 0), (0, 4, 0)])
    obj = add(mesh, location=(3, -1, 2), rotation=(0.3, 0.2, 1.0), scale=(1.0, 2.0, 0.5))
    for number, name in enumerate(("Basis", "First", "Second")):
        key = obj.shape_key_add(name=name)
        key.data[number].co.x -= 1.5 * number
        key.value = 0.25 * number
    bpy.context.view_layer.update()
    return obj


def with_modifier(obj):
    obj.modifiers.new("Cast", "CAST")


def with_group(obj):
    obj.vertex_groups.new(name="Group")
    obj.data.shape_keys.key_blocks["First"].vertex_group = "Group"


@pytest.mark.parametrize(
    "change",
    [
        with_modifier,
        with_group,
        lambda obj: setattr(obj, "show_only_shape_key", True),
        lambda obj: setattr(obj.data.shape_keys, "use_relative", False),
        lambda obj: setattr(obj, "instance_type", "FACES"),
        lambda obj: obj.modifiers.new("Particles", "PARTICLE_SYSTEM"),
        lambda obj: setattr(obj.body_moments, "kind", "SHELL"),
        lambda obj: setattr(obj.body_moments, "density_from", "MATERIALS"),
        lambda obj: setattr(obj.body_moments, "overlap", "UNION"),
        lambda obj: obj.shape_key_clear(),
        lambda obj: bpy.ops.object.mode_set(mode="EDIT"),
    ],
)
def test_a_mesh_that_anything_but_its_keys_may_change_has_no_mix(change):
    obj = keyed()
    assert motion._mixed_keys(obj) == ("First", "Second")
    change(obj)
    if obj.modifiers and obj.modifiers[0].type == "PARTICLE_SYSTEM":
        obj.modifiers[0].show_viewport = False  # the system alone
    assert motion._mixed_keys(obj) == ()
    if obj.mode == "EDIT":
        bpy.ops.object.mode_set(mode="OBJECT")


def found(followed, obj):
    bpy.context.view_layer.update()
    return followed.mass_and_center(obj, bpy.context.evaluated_depsgraph_get())


@pytest.mark.parametrize("frames", [sample_count(2) - 1, sample_count(2)])
@pytest.mark.parametrize("given", [False, True])
def test_a_mix_is_sampled_where_that_is_less_work_and_always_what_measuring_gives(frames, given):
    obj = keyed()
    bpy.context.scene.unit_settings.scale_length = 0.1
    if given:
        obj.body_moments.mass_from, obj.body_moments.mass = "MASS", 7.5
    keys = obj.data.shape_keys.key_blocks
    keys["Second"].relative_key = keys["First"]
    followed = motion.Motion(frames)
    for value in (0.0, 0.25, 0.5, 1.0, 0.3):
        obj.data.shape_keys.key_blocks["Second"].value = value
        mass, center = found(followed, obj)
        truth = measured(obj).mass_properties
        assert mass == pytest.approx(truth.mass, rel=1e-6)
        assert center == pytest.approx(np.array(truth.center) / np.float32(0.1), rel=1e-6)
        assert (followed._followed[obj].mixes is not None) == (frames == sample_count(2))


def test_a_polygon_that_blender_cuts_otherwise_is_measured():
    mesh = bpy.data.meshes.new("Prism")
    angles = np.arange(5) * 2.0 * np.pi / 5.0
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points = np.concatenate([np.insert(ring, 2, height, axis=1) for height in (0.0, 1.0)])
    sides = [(i, (i + 1) % 5, 5 + (i + 1) % 5, 5 + i) for i in range(5)]
    mesh.from_pydata(points.tolist(), [], [(4, 3, 2, 1, 0), (5, 6, 7, 8, 9), *sides])
    obj = keyed(mesh)
    obj.data.shape_keys.key_blocks["Second"].data[5].co = (-0.9, 0.0, 1.5)
    followed = motion.Motion(sample_count(2))
    for value in (0.0, 1.0, 0.5):
        obj.data.shape_keys.key_blocks["Second"].value = value
        assert found(followed, obj)[0] == pytest.approx(measured(obj).mass_properties.mass, rel=1e-6)
    assert followed._followed[obj].mixes is not None


def test_what_is_open_or_welded_is_no_mix():
    obj = keyed(strip_mesh())
    followed = motion.Motion(200)
    with refused("open_object", obj.name):
        found(followed, obj)
    assert followed._followed[obj].mixes is None
    mesh = mesh_body()
    count = len(mesh.vertices)
    split = bpy.data.meshes.new("Split")
    points = np.array([vertex.co for vertex in mesh.vertices])
    faces = [[count * side + index for index in face.vertices] for side, face in enumerate(mesh.polygons)]
    split.from_pydata(np.tile(points, (len(faces), 1)).tolist(), [], faces)
    split.update()
    obj = add(split, "Split")
    for name in ("Basis", "Key"):
        obj.shape_key_add(name=name)
    mass, _ = found(followed, obj)
    assert followed._followed[obj].mixes is None and mass == pytest.approx(measured(add(mesh)).mass_properties.mass)
