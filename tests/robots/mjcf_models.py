# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Links of MJCF models beside those that MuJoCo compiles."""

import mujoco
import numpy as np
from body_moments.core.robots.read.descriptions import read_description


def matrix(quaternion):
    flat = np.zeros(9)
    mujoco.mju_quat2Mat(flat, quaternion)
    return flat.reshape(3, 3)


def check_links(path):
    """Compare names, inertials and shapes with those of MuJoCo, and return our links."""
    model = mujoco.MjModel.from_xml_path(str(path))
    links = read_description(path).links
    assert [link.name for link in links] == [
        model.body(index).name for index in range(1, model.nbody)
    ]
    for index, link in enumerate(links, start=1):
        assert not link.findings
        if link.inertial is not None:
            stated, turn = link.inertial, matrix(model.body_iquat[index])
            np.testing.assert_allclose(stated.mass, model.body_mass[index], rtol=1e-12)
            np.testing.assert_allclose(
                stated.center, model.body_ipos[index], atol=1e-12 * max(abs(stated.center))
            )
            inertia = turn @ np.diag(model.body_inertia[index]) @ turn.T
            np.testing.assert_allclose(
                stated.inertia, inertia, rtol=0, atol=1e-9 * stated.inertia.max()
            )
        geoms = range(
            model.body_geomadr[index], model.body_geomadr[index] + model.body_geomnum[index]
        )
        found = {tuple(np.round(model.geom_pos[geom], 9)): geom for geom in geoms}
        assert len(link.shapes) == len(geoms)
        for shape in (stated.shape for stated in link.shapes if stated.shape.kind != "mesh"):
            geom = found[tuple(np.round(shape.pose.position, 9))]
            halves = {"box": 0.5, "capsule": (1.0, 0.5), "cylinder": (1.0, 0.5)}.get(
                shape.kind, 1.0
            )
            np.testing.assert_allclose(
                np.multiply(shape.size, halves), model.geom_size[geom, : len(shape.size)]
            )
            np.testing.assert_allclose(
                shape.pose.rotation, matrix(model.geom_quat[geom]), atol=1e-9
            )
    return links
