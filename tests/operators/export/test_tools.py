# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inertials as text, shapes of equal inertia, and the audit from the menu."""

from xml.etree import ElementTree

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.core.mesh.surface import Surface
from body_moments.core.robots.write.stl import to_stl

from tests.blender.objects import add, mesh_body, only
from tests.close import close
from tests.core.bodies import box as cube

pytestmark = pytest.mark.usefixtures("scene")
BOX = (
    '<robot name="r"><link name="a"><inertial><mass value="8000"/><inertia ixx="{0}" iyy="{0}" '
    'izz="{0}" ixy="0" '
    'ixz="0" iyz="0"/></inertial><collision><geometry><box size="2 2 '
    '2"/></geometry></collision></link></robot>'
)


def measured(obj):
    return measure_object(obj, bpy.context.evaluated_depsgraph_get())


@pytest.mark.parametrize("name", ["urdf", "sdf", "mjcf", "usd", "gltf", "osim"])
def test_an_inertial_is_copied_along_the_objects_own_axes(name, capfd):
    body = add(mesh_body(), "Body", (1, 2, 3), (0.3, 0.4, 0.5))
    assert bpy.ops.object.body_moments_copy(what=name) == {"FINISHED"}
    text = capfd.readouterr().out
    assert repr(measured(body).mass_properties.mass) in text or name == "usd"
    if name == "urdf":
        found = ElementTree.fromstring(text[text.index("<?xml") :].encode()).find(
            "link/inertial/inertia"
        )
        truth = measured(body).in_object_frame().inertia
        assert float(found.get("ixy")) == truth[0, 1] and float(found.get("izz")) == truth[2, 2]


@pytest.mark.parametrize("unit", [1.0, 0.001])
@pytest.mark.parametrize("kind", ["BOX", "ELLIPSOID", "CAPSULE"])
def test_a_shape_has_mass_center_and_inertia_of_the_object(kind, unit):
    bpy.context.scene.unit_settings.scale_length = unit
    body = add(mesh_body(), "Body", (1, 2, 3), (0.3, 0.4, 0.5))
    before = measured(body)
    assert bpy.ops.object.body_moments_equal_inertia(kind=kind) == {"FINISHED"}
    (shape,) = [obj for obj in bpy.data.objects if obj is not body]
    found, true = measured(shape).mass_properties, before.mass_properties
    assert (
        close(found.mass, true.mass, 1e-6)
        and np.abs(found.center - true.center).max() < 1e-5 * unit
    )
    apart = np.abs(found.inertia - true.inertia).max() / np.abs(true.inertia).max()
    # facets; two parameters for three moments
    assert apart < {"BOX": 1e-5, "ELLIPSOID": 0.03, "CAPSULE": 0.2}[kind]
    if kind != "BOX":
        assert (
            len(shape.data.vertices) == 32 * 16 + 2
            and min(abs(vertex.co.z) for vertex in shape.data.vertices) > 0.0
        )
    assert (
        shape.display_type == "WIRE"
        and shape.hide_render
        and measured(body).fingerprint == before.fingerprint
    )


def test_rigid_box_carries_object_in_place():
    body = add(mesh_body(), "Body", (1, 2, 3), (0.3, 0.4, 0.5))
    before = body.matrix_world.copy()
    bpy.ops.object.body_moments_equal_inertia(rigid_body=True)
    bpy.context.view_layer.update()
    box = body.parent
    assert box.rigid_body.collision_shape == "BOX" and close(
        box.rigid_body.mass, measured(body).mass_properties.mass, 1e-6
    )
    assert np.abs(np.subtract(body.matrix_world, before)).max() < 1e-5
    only(body)
    assert bpy.ops.object.body_moments_equal_inertia(rigid_body=True) == {"CANCELLED"}


@pytest.mark.parametrize("where", ["relative", "absolute"])
def test_audit_reads_other_folders_only_if_allowed(where, tmp_path, monkeypatch):
    mesh, path = tmp_path / "meshes" / "part.stl", tmp_path / "package" / "robot" / "r.urdf"
    for file in (mesh, path):
        file.parent.mkdir(parents=True)
    mesh.write_bytes(to_stl(Surface.from_triangles(*cube((-1, -1, -1), (1, 1, 1)))))
    file = "part.stl" if where == "relative" else mesh.as_posix()
    shape = '<mesh filename="{}"/>'.format(file)
    path.write_text(
        BOX.format("5333.333333").replace('<box size="2 2 2"/>', shape), encoding="utf-8"
    )

    def is_read(**options):
        assert bpy.ops.import_scene.body_moments_audit(filepath=str(path), **options) == {
            "FINISHED"
        }
        text = bpy.data.texts[-1]
        said = text.as_string()
        bpy.data.texts.remove(text)
        return "part.stl" not in said

    monkeypatch.chdir(mesh.parent)  # where Blender was started is no folder of meshes
    assert not is_read()
    assert is_read(root=str(mesh.parent))
    assert is_read(allow_outside=True) == (where == "absolute")


def test_the_audit_becomes_a_text_and_a_repaired_copy(tmp_path, reported):
    path = tmp_path / "r.urdf"
    path.write_text(BOX.format("5333333"), encoding="utf-8")
    options = {"filepath": str(path), "write_copy": True, "write_page": True}
    assert bpy.ops.import_scene.body_moments_audit(**options) == {"FINISHED"}
    assert reported.texts[0].startswith("1 links: 1 errors, 0 warnings, 0 notes")
    assert bpy.data.texts["Audit of r.urdf"].current_line_index == 0
    text = bpy.data.texts["Audit of r.urdf"].as_string()
    assert "r_repaired.urdf" in text
    assert "Multiply the inertia by 0.001" in text and "Impossible" in text
    assert 'ixx="5333.333"' in (tmp_path / "r_repaired.urdf").read_text(encoding="utf-8")
    assert "audit_unit" in (tmp_path / "r.urdf.audit.html").read_text(encoding="utf-8")
    with pytest.raises(RuntimeError, match="r_repaired.urdf"):
        bpy.ops.import_scene.body_moments_audit(**options)
    assert reported.codes[-1] == "file_exists"
    path.write_text("<robot", encoding="utf-8")
    with pytest.raises(RuntimeError, match="“r.urdf”: .*not XML"):
        bpy.ops.import_scene.body_moments_audit(filepath=str(path))
