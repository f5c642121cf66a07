# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies in nested and scaled frames of MJCF, as our reader and as MuJoCo place and scale them."""

import mujoco
import numpy as np
import pytest
from body_moments.core.robots.read.descriptions import read_description

EVEN, UNEVEN = "scale=", 'scaling="geometry" scale='


class Writer:
    """A model of random nested frames and bodies. Uneven scales allow quarter turns only."""

    def __init__(self, seed):
        self.rng, self.is_even, self.count = np.random.default_rng(seed), seed % 2 == 0, 0

    def text(self, values):
        return " ".join(map(repr, np.ravel(values).tolist()))

    def place(self):
        position = self.text(self.rng.normal(size=3))
        turn = self.rng.uniform(-180, 180, 3) if self.is_even else 90 * self.rng.integers(0, 4, 3)
        return 'pos="{}" euler="{}"'.format(position, self.text(turn))

    def inertial(self):
        numbers = self.text(self.rng.uniform(2, 3, 3))
        return '<inertial mass="{}" diaginertia="{}" {}/>'.format(self.rng.uniform(1, 3), numbers, self.place())

    def geom(self):
        kind = self.rng.choice(["box", "ellipsoid", *["capsule", "cylinder", "sphere"] * self.is_even])
        return '<geom type="{}" size="{}" {}/>'.format(kind, self.text(self.rng.uniform(0.1, 0.5, 3)), self.place())

    def scale(self):
        own = self.rng.uniform(0.5, 2, 1 if self.is_even else 3)
        text = '{}"{}"'.format(EVEN if self.is_even else UNEVEN, self.text(own))
        return "" if self.rng.random() < 0.3 else text + ' massscale="1.5"' * (self.rng.random() < 0.3)

    def content(self, depth):
        parts = [self.geom()]
        for _ in range(self.rng.integers(1, 3) if depth else 0):
            if self.rng.random() < 0.6:
                parts.append("<frame {} {}>{}</frame>".format(self.place(), self.scale(), self.content(depth - 1)))
            else:
                parts.append(self.body(depth - 1))
        return "".join(parts)

    def body(self, depth):
        self.count += 1
        name, place = "b{}".format(self.count), self.place()
        return '<body name="{}" {}>{}{}</body>'.format(name, place, self.inertial(), self.content(depth))


def matrix(quaternion):
    flat = np.zeros(9)
    mujoco.mju_quat2Mat(flat, quaternion)
    return flat.reshape(3, 3)


@pytest.mark.parametrize("seed", range(20))
def test_frames_are_those_of_mujoco(tmp_path, seed):
    compiler = '<compiler inertiafromgeom="false"/>'
    path = tmp_path / "model.xml"
    path.write_text("<mujoco>{}<worldbody>{}</worldbody></mujoco>".format(compiler, Writer(seed).body(4)))
    model = mujoco.MjModel.from_xml_path(str(path))
    links = read_description(path).links
    assert len(links) == model.nbody - 1
    for link in links:
        assert not link.findings
        index, stated = model.body(link.name).id, link.inertial
        turn = matrix(model.body_iquat[index])
        np.testing.assert_allclose(stated.mass, model.body_mass[index], rtol=1e-12)
        np.testing.assert_allclose(stated.center, model.body_ipos[index], rtol=0, atol=1e-12 * max(abs(stated.center)))
        inertia = turn @ np.diag(model.body_inertia[index]) @ turn.T
        np.testing.assert_allclose(stated.inertia, inertia, rtol=0, atol=1e-9 * stated.inertia.max())
        geoms = range(model.body_geomadr[index], model.body_geomadr[index] + model.body_geomnum[index])
        found = {tuple(np.round(model.geom_pos[geom], 9)): geom for geom in geoms}
        assert len(link.shapes) == len(geoms)
        for shape in (stated.shape for stated in link.shapes):
            geom = found[tuple(np.round(shape.pose.position, 9))]
            halves = {"box": 0.5, "capsule": (1.0, 0.5), "cylinder": (1.0, 0.5)}.get(shape.kind, 1.0)
            np.testing.assert_allclose(np.multiply(shape.size, halves), model.geom_size[geom, : len(shape.size)])
            np.testing.assert_allclose(shape.pose.rotation, matrix(model.geom_quat[geom]), atol=1e-9)
