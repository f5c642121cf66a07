# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of moments, over the area of flat shapes: of faces, curves and text, in their own
plane.
"""

import csv
from fractions import Fraction
from math import factorial

import bpy
import numpy as np
import pytest
from body_moments.blender.session import memory
from body_moments.blender.session.stored import computed_moments
from body_moments.blender.session.stored import moments as moments_table
from body_moments.core.verdict import MeasureError, finding

from tests.blender.flat_objects import sheet, text
from tests.blender.moments import compute, settings
from tests.blender.objects import add, mesh_body, only
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")

L_SHAPE = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 2.5), (0, 2.5)]


def table():
    """(the comment, the rows as they are)"""
    group = bpy.context.scene.body_moments
    text = computed_moments.as_csv(
        memory.moments[bpy.context.object],
        group.moments_of,
        group.moments_about,
        group.frame,
    )
    assert "\r" not in text
    comment, *lines = text.splitlines()
    return comment, list(csv.DictReader(lines))


def values():
    return {
        (int(row["p"]), int(row["q"])): tuple(
            float(row[key]) for key in ("moment", "rounding", "float32")
        )
        for row in table()[1]
    }


def truth(p, q, shift=(0, 0)):
    """∫ x^p y^q over the L, as two rectangles."""

    def power(low, high, n):
        return (Fraction(high) ** (n + 1) - Fraction(low) ** (n + 1)) / (n + 1)

    x, y = map(Fraction, shift)
    upright = power(-x, 1 - x, p) * power(-y, Fraction(5, 2) - y, q)
    return upright + power(1 - x, 3 - x, p) * power(-y, 1 - y, q)


def test_flat_moments_are_exact_within_bounds():
    sheet(L_SHAPE)
    settings(moments_of="FLAT", moments_about="ORIGIN", frame="WORLD")
    compute(20)
    found = values()
    assert len(found) == 231
    for (p, q), (value, rounding, moved) in found.items():
        off = abs(Fraction(value) - truth(p, q))
        assert off <= Fraction(rounding) and moved > 0.0
        assert rounding <= 1e-8 * float(truth(p, q))
    settings(moments_about="CENTER")
    centroid = [truth(1, 0) / truth(0, 0), truth(0, 1) / truth(0, 0)]
    for (p, q), (value, rounding, _) in values().items():
        assert abs(Fraction(value) - truth(p, q, centroid)) <= Fraction(rounding)


def test_flat_moments_have_axes_and_origin_of_the_plane():
    obj = sheet(L_SHAPE, location=(1, 2, 3), rotation=(0.3, 0.4, 0.5), scale=(2, 2, 2))
    settings(moments_of="FLAT", moments_about="ORIGIN", frame="OBJECT")
    compute(6)
    for (p, q), (value, *_) in values().items():
        assert close(value, float(truth(p, q)) * 2.0 ** (p + q + 2), rel=1e-6)
    comment = table()[0]
    front = np.array(comment.split("front (")[1].split(")")[0].split(), float)
    assert np.abs(front - np.array(obj.matrix_world.col[2][:3]) / 2.0).max() < 1e-6
    settings(frame="WORLD")
    axes = np.array(obj.matrix_world)[:3, :2] / 2.0
    foot = -axes.T @ np.array(obj.location)
    found = values()
    centroid = [2.0 * float(truth(1, 0) / truth(0, 0)), 2.0 * float(truth(0, 1) / truth(0, 0))]
    assert (
        np.abs(
            np.array([found[1, 0][0], found[0, 1][0]]) / found[0, 0][0] - (centroid - foot)
        ).max()
        < 1e-5
    )


def test_circle_moments_are_exact_for_its_curve():
    bpy.ops.curve.primitive_nurbs_circle_add(radius=2.0)
    circle = bpy.context.object
    circle.data.dimensions, circle.data.fill_mode, circle.data.resolution_u = "2D", "BOTH", 3
    bpy.context.view_layer.update()
    settings(moments_of="FLAT", moments_about="CENTER")
    compute(6)
    for (p, q), (value, rounding, moved) in values().items():
        even = p % 2 == q % 2 == 0
        # ∫ x^p y^q over a disc: 2 Γ((p+1)/2) Γ((q+1)/2) / (Γ((p+q)/2 + 1) (p+q+2)) R^(p+q+2)
        exact = 0.0
        if even:
            i, j = p // 2, q // 2
            gammas = (
                factorial(p) * factorial(q) / (4.0 ** (i + j) * factorial(i) * factorial(j)) * np.pi
            )
            exact = 2.0 * gammas / (factorial(i + j) * (p + q + 2)) * 2.0 ** (p + q + 2)
        assert abs(value - exact) <= rounding + moved
        assert rounding + moved <= 1e-5 * 2.0 ** (p + q + 2)


@pytest.mark.parametrize("resolution", [1, 12])
def test_text_moments_are_independent_of_resolution(resolution):
    found = []
    for drawn_with in (resolution, 200):
        obj = text("O", resolution=drawn_with)
        only(obj)
        settings(moments_of="FLAT", moments_about="CENTER")
        compute(8)
        found.append(values())
    for key, (value, rounding, moved) in found[0].items():
        assert abs(value - found[1][key][0]) <= 2 * (rounding + moved)
    section = found[0][0, 0][0]
    bpy.ops.object.body_moments_measure_section()
    assert close(bpy.context.object["body_section"]["area"][0], section, rel=1e-4)


def test_selected_faces_have_flat_moments_beside_body():
    obj = add(mesh_body("Body"), "Body")
    import bmesh  # there once bpy is

    bpy.ops.object.mode_set(mode="EDIT")
    edited = bmesh.from_edit_mesh(obj.data)
    for face in edited.faces:
        face.select_set(False)
    edited.faces.ensure_lookup_table()
    edited.faces[1].select_set(True)
    bmesh.update_edit_mesh(obj.data)
    compute(3)
    settings(moments_of="FLAT", moments_about="CENTER")
    area = values()[0, 0][0]
    settings(moments_of="VOLUME")
    assert close(float(table()[1][0]["moment"]), area * 0.7, rel=1e-6)
    bpy.ops.object.mode_set(mode="OBJECT")


def test_flat_invariants_are_independent_of_place_and_size():
    found, forms = [], []
    for where in (
        {},
        {"location": (5, -3, 2), "rotation": (1.0, 2.0, 3.0), "scale": (0.01, 0.01, 0.01)},
        {"rotation": (0, 0, 2), "scale": (30, 30, 30)},
        {"scale": (-1, 1, 1)},
    ):
        sheet(L_SHAPE, **where)
        settings(moments_of="FLAT", moments_about="INVARIANT")
        compute(6)
        rows = table()[1]
        found.append(
            {row["invariant"]: complex(float(row["real"]), float(row["imaginary"])) for row in rows}
        )
        forms.append(
            {row["invariant"]: float(row["rounding"]) + float(row["float32"]) for row in rows}
        )
    assert (
        list(found[0])[:7] == ["φ1", "φ2", "φ3", "φ4", "φ5", "φ6", "φ7"] and "c42 c12²" in found[0]
    )
    for other, bounds in list(zip(found, forms))[1:3]:
        for name, value in found[0].items():
            assert abs(other[name] - value) <= bounds[name] + forms[0][name] + 1e-12
    mirrored = found[3]
    assert close(mirrored["φ7"].real, -found[0]["φ7"].real, rel=1e-5)
    assert all(
        close(mirrored[name].real, found[0][name].real, rel=1e-5) for name in ("φ1", "φ4", "φ6")
    )
    assert close(mirrored["c42 c12²"].imag, -found[0]["c42 c12²"].imag, rel=1e-4)
    settings(moments_about="NORMALIZED")
    assert close(values()[0, 0][0], 1.0, rel=1e-12)


def test_overflowing_invariants_are_refused():
    """c30,0 c12³⁰ grows with the sixtieth power of length by width."""
    only(sheet([(0, 0), (1024, 0), (0, 1 / 1024)]))
    settings(moments_of="FLAT", moments_about="INVARIANT")
    compute(30)
    with pytest.raises(MeasureError) as refusal:
        table()
    assert refusal.value.finding == finding("moments_overflow", order=30)


def test_flat_moments_are_about_foot_of_reference():
    obj = sheet(L_SHAPE)
    only(obj)
    settings(moments_of="FLAT", moments_about="REFERENCE")
    compute(2)
    bpy.context.scene.body_moments_reference.about = "CURSOR"
    bpy.context.scene.cursor.location = (2.0, -1.0, 5.0)
    degrees, _ = moments_table.current_numbers(obj, bpy.context.scene)
    shown = {name: float(exact) for degree in degrees for name, _, exact in degree.rows}
    for name, p, q in (
        ("1", 0, 0),
        ("x", 1, 0),
        ("y", 0, 1),
        ("x²", 2, 0),
        ("xy", 1, 1),
        ("y²", 0, 2),
    ):
        assert close(shown[name], float(truth(p, q, (2, -1))), 1e-12), name
