# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Several bodies as one, and the bounds of its errors where the parts are few enough to tell them
by hand.
"""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.measure_object import measure_many
from body_moments.blender.session import displayed
from body_moments.blender.session.displayed import drawn
from body_moments.blender.session.stored import results
from body_moments.blender.session.tracking import armatures, handlers
from body_moments.core.inertia.mass_properties import combine

from tests.blender.boxes import armature_with, box, collection
from tests.blender.objects import add, arrays, dent, measure, measured, mesh_body, only, strip_mesh
from tests.close import close

pytestmark = pytest.mark.usefixtures("registered")


def part(mass, center, volume, area):
    return SimpleNamespace(
        volume=volume, area=area, body=SimpleNamespace(mass=mass, center=np.array(center))
    )


def total_of(*objects):
    only(*objects)
    handlers.count_change()
    return displayed.total(bpy.context)


def test_total_names_missing_stale_and_doubtful_objects(scene):
    bare = add(mesh_body(), "bare")
    exact, edited, other = (
        add(mesh_body(), name, (9 * i, 0, 0)) for i, name in enumerate(("exact", "edited", "other"))
    )
    doubtful = add(strip_mesh(), "doubtful")
    other.body_moments.density = 3000.0
    measure(exact, edited, other, doubtful)
    dent(edited, -1.0)
    objects = bare, exact, edited, other, doubtful
    found = total_of(*objects)
    assert found.count == 4 and found.missing == ("bare",)
    assert found.stale == ("edited",)
    assert "doubtful" in repr([one.values for one in found.findings])
    for name in ("volume", "area"):
        assert close(getattr(found, name), sum(obj["body_" + name] for obj in objects[1:]), 1e-12)
    assert close(found.numbers.mass, sum(obj["body_mass"] for obj in objects[1:]), 1e-12)
    whole = arrays(total_of(exact, other).numbers)
    truth = combine([measured(obj).mass_moments for obj in (exact, other)])
    assert close([whole.mass, *whole.center], [truth.mass, *truth.center], 1e-6)
    assert np.abs(whole.inertia - truth.inertia).max() <= 1e-6 * truth.inertia.max()
    assert close(whole.moments, truth.principal.moments, 1e-6)
    exact["body_mass"] = 0.0
    nothing = total_of(exact)
    assert nothing.numbers is None and nothing.count == 1
    assert drawn(exact, scene) is None


def test_measurements_stored_in_reverse_reach_their_objects(scene):
    objects = [add(mesh_body(), scale=(size,) * 3) for size in (1, 2, 3)]
    batches = measure_many(objects, bpy.context.evaluated_depsgraph_get())
    measurements = [pair for batch in batches for pair in batch]
    results.store_measured(bpy.context, measurements[::-1])
    volumes = np.array([obj["body_volume"] for obj in objects])
    assert close(volumes / volumes[0], [1, 8, 27], 1e-6)


def test_armature_in_two_view_layers_deforms_the_meshes_of_each(scene):
    here, there = add(mesh_body(), "here"), add(mesh_body(), "there")
    armature = armature_with(here, there)
    layer = scene.view_layers.new("Layer")
    hidden = collection()
    hidden.objects.link(there)
    scene.collection.objects.unlink(there)
    layer.layer_collection.children[hidden.name].exclude = True
    layer.update()
    handlers.count_change()
    assert set(armatures.deformed_meshes(armature)) == {here, there}
    with bpy.context.temp_override(view_layer=layer):
        assert armatures.deformed_meshes(armature) == (here,)


def test_assembly_counts_without_its_selected_parts(scene):
    root = add(None, "a root")
    parts = [
        box(collection("Parts " + name), (1, 2, 3), (5 * i, 0, 0), name=name)
        for i, name in enumerate("bc")
    ]
    for part in parts:
        part.parent = root
    bpy.context.view_layer.update()
    only(root)
    assert bpy.ops.object.body_moments_measure_assembly(target="OBJECT") == {"FINISHED"}
    other = add(mesh_body(), "d other")
    measure(other)
    each, rest = parts[0]["body_mass"], other["body_mass"]
    for chosen, count, mass in (
        ([root], 1, 2.0 * each),
        ([root, other], 2, 2.0 * each + rest),
        ([root, parts[1]], 1, each),
        ([root, parts[1], other], 2, each + rest),
        ([*parts, other], 3, 2.0 * each + rest),
    ):
        found = total_of(*chosen)
        assert found.count == count and close(found.numbers.mass, mass, 1e-6)


@pytest.mark.parametrize("unit", [1.0, 0.5])
def test_posed_armature_has_sum_of_measured_meshes(unit, scene):
    scene.unit_settings.scale_length = unit
    meshes = [add(mesh_body(), name, (4 * i, 0, 0)) for i, name in enumerate("abc")]
    meshes[1].body_moments.density = 3000.0
    measure(*meshes[:2])
    armature = armature_with(*meshes)
    armature.location, armature.rotation_euler = (1, 2, 3), (0.3, 0.2, 0.1)
    only(armature)
    bpy.ops.object.mode_set(mode="POSE")
    bpy.context.view_layer.update()
    for density in (1000.0, 500.0):
        meshes[0].body_moments.density = density
        shown = displayed.displayed(armature, scene).world
        parts = [displayed.displayed(mesh, scene).world for mesh in meshes[:2]]
        for name in ("volume", "area", "mass"):
            assert close(getattr(shown, name), sum(getattr(part, name) for part in parts), 1e-12)
    scene.body_moments.frame = "OBJECT"
    own, whole = (
        arrays(displayed.displayed(armature, scene).in_frame(scene.body_moments.frame)),
        arrays(shown),
    )
    place = np.array(armature.matrix_world, np.float64)
    assert close(place[:3, :3] @ own.center + unit * place[:3, 3], whole.center, 1e-6)
    truth = place[:3, :3].T @ whole.inertia @ place[:3, :3]
    assert np.abs(own.inertia - truth).max() <= 1e-6 * truth.max()
    for mesh in meshes[:2]:
        mesh["body_volume"] = 0.0  # as of a shell without thickness
    assert displayed.displayed(armature, scene).world.density == 0.0
    for mass in (0.25, 0.0):
        for mesh in meshes[:2]:
            mesh["body_mass"] = mass
        shown = displayed.displayed(armature, scene)
        assert shown.is_posed if mass else shown is None
    bpy.ops.object.mode_set(mode="OBJECT")
