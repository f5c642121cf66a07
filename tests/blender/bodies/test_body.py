# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What bodies do with moments that are known better, and with those of shapes that several bodies
share.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.measure_body import measure_body
from body_moments.blender.settings.options import MeasureOptions

from tests.blender.objects import add
from tests.core.bodies import moebius
from tests.corpus import shapes as s

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
