# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""IGES and .obj surfaces as surface objects: what Blender shows are points of the surfaces of the
file, and what is measured are their volumes.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.scene.imports import import_bodies
from body_moments.core.cad.surface_file import read_surfaces
from body_moments.core.numerics.bspline import SplineSpace, clamped_space
from body_moments.core.nurbs import Patch, display_parameters

from tests.blender.objects import measured
from tests.blender.surface_files import imported, written
from tests.close import close
from tests.core.exact_splines import sphere, torus
from tests.core.iges_files import IgesFile, obj_text, unrolled

pytestmark = pytest.mark.usefixtures("scene")
BALL = 4.0 / 3.0 * np.pi
DONUT = 2.0 * np.pi**2 * 0.75 * 0.25**2


def shown(obj):
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return np.array([vertex.co for vertex in mesh.vertices], np.float64).reshape(-1, 3)


def true_parameters(space, found):
    """Of Blender's parameters, a unit for each span, those of the file's knots."""
    edges = np.append(space.intervals[:, 0], space.intervals[-1, 1])
    return np.interp(found, np.arange(len(edges)), edges)


@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("order_s", range(2, 7))
def test_the_display_mesh_lies_on_the_surface_of_the_file(tmp_path, order_s, weighted):
    """At the parameters of the display mesh's vertices, for orders 2 to 6 and uneven knots that are
    not clamped.
    """
    rng = np.random.default_rng(order_s)
    for order_t in range(2, 7):
        spaces = []
        for order in (order_s, order_t):
            knots = np.cumsum(rng.uniform(0.2, 2.0, order + 8)).tolist()
            spaces.append(
                SplineSpace(tuple(knots), order, 8)
                if order % 2
                else clamped_space(order, (0.3, 0.35))
            )
        shape = (spaces[0].count, spaces[1].count)
        weights = rng.uniform(0.3, 3.0, shape) if weighted else None
        patch = Patch(tuple(spaces), rng.uniform(-1.0, 1.0, (*shape, 3)), weights)
        obj = imported(filepath=str(written(tmp_path, patch)))
        (spline,) = obj.data.splines
        (found,) = read_surfaces(tmp_path / "body.igs").bodies[0].patches
        s, t = (
            true_parameters(
                space, np.minimum(display_parameters(short, resolution), short.domain[1])
            )
            for space, short, resolution in zip(
                spaces, found.spaces, (spline.resolution_v, spline.resolution_u)
            )
        )
        truth = patch.evaluate_grid(s, t)
        points = shown(obj).reshape(len(t), len(s), 3).swapaxes(0, 1)
        # the last step of Blender's float32 parameter may end before the surface does
        assert np.abs(points[:-1, :-1] - truth[:-1, :-1]).max() <= 2e-5
        bpy.data.objects.remove(obj)


@pytest.mark.parametrize("patch, truth", [(sphere(), BALL), (torus(), DONUT)])
@pytest.mark.parametrize("unit, meters", [(2, 1e-3), (1, 0.0254), (6, 1.0)])
def test_iges_bodies_are_measured_from_their_control_points(
    tmp_path, reported, patch, truth, unit, meters
):
    bpy.context.scene.unit_settings.scale_length = 0.01
    obj = imported(filepath=str(written(tmp_path, unrolled(patch), unit=unit)))
    assert obj.name == "body" and obj.select_get() and obj.type == "SURFACE"
    (moved,) = [found.values["share"] for found in reported if found.code == "surfaces_rounded"]
    assert 0.0 < moved <= 1e-6
    one = measured(obj)
    assert str(one.method.source) == "NURBS"
    assert close(one.volume, truth * meters**3, 4e-7)
    assert "order 3" in reported.texts[0]


def test_a_body_far_from_the_origin_keeps_its_digits(tmp_path):
    far = np.eye(4)
    far[:3, 3] = 1e5, -2e5, 3e5
    file = IgesFile()
    file.surface(unrolled(sphere()), matrix=file.transformation(far))
    obj = imported(filepath=str(file.write(tmp_path / "far.iges")))
    one = measured(obj)
    assert close(one.volume, BALL, 4e-7)
    assert np.abs(np.array(one.volume_moments.center) - far[:3, 3]).max() <= 1e-6


def test_several_files_import_and_invalid_one_is_named(tmp_path, reported):
    written(tmp_path, unrolled(sphere()))
    (tmp_path / "two.obj").write_text(obj_text([unrolled(torus())], name="Donut"))
    (tmp_path / "bad.igs").write_text("nothing")
    names = [{"name": name} for name in ("body.igs", "two.obj", "bad.igs")]
    obj = imported(directory=str(tmp_path), files=names, unit=0.001)
    assert [one.name for one in bpy.context.selected_objects] == [
        "body",
        "Donut",
    ] and obj.name == "body"
    assert "file_unrecognized" in reported.codes
    assert close(measured(bpy.data.objects["Donut"]).volume, DONUT * 1e-9, 4e-7)
    assert bpy.ops.object.body_moments_import_surfaces.poll()


def test_nothing_to_import_changes_nothing(tmp_path, reported):
    (tmp_path / "bad.igs").write_text("nothing")
    before = len(bpy.data.objects), len(bpy.data.scenes), len(bpy.data.curves)
    for path in (tmp_path / "bad.igs", tmp_path, tmp_path / "none.igs"):
        with pytest.raises(RuntimeError):
            bpy.ops.object.body_moments_import_surfaces(filepath=str(path))
    assert before == (len(bpy.data.objects), len(bpy.data.scenes), len(bpy.data.curves))


def test_surface_faces_look_along_normals_of_the_file(tmp_path):
    (body,) = read_surfaces(written(tmp_path, unrolled(sphere()))).bodies
    ((obj, _),) = import_bodies([body], bpy.context.scene.collection, 1.0)
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    outward = [
        polygon.normal.dot(polygon.center) for polygon in mesh.polygons if polygon.area > 1e-6
    ]
    assert min(outward) > 0.5


def test_one_undo_takes_the_surfaces_away(tmp_path):
    path = written(tmp_path, unrolled(sphere()))
    bpy.ops.ed.undo_push(message="Before")
    bpy.ops.object.body_moments_import_surfaces("EXEC_DEFAULT", True, filepath=str(path))
    bpy.ops.ed.undo_push(message="After")
    bpy.ops.ed.undo()
    assert "body" in bpy.data.objects
    bpy.ops.ed.undo()
    assert "body" not in bpy.data.objects and len(bpy.data.scenes) == 1
