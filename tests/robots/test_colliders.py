# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Exported colliders in MuJoCo: its own mass, center and inertia of them are those that we state."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from body_moments.core.colliders.effects import correct_masses, effect, uniform_masses
from body_moments.core.colliders.fits import Wanted, make_colliders
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.mesh.surface import Surface
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.robots.model import Inertial, Link, Robot, Shape
from body_moments.core.robots.write import mjcf
from body_moments.core.robots.write.shapes import with_colliders, with_meshes
from body_moments.core.robots.write.stl import to_stl

from tests.core.bodies import box
from tests.robots.links import ball, rotation

DENSITY = 700.0


def joined(*boxes):
    """Several boxes, each from one corner to the other, as one body."""
    points, triangles, count = [], [], 0
    for low, high in boxes:
        corners, faces = box(low, high)
        points.append(corners)
        triangles.append(faces + count)
        count += len(corners)
    return np.concatenate(points), np.concatenate(triangles)


def prism(outline, height=0.5):
    """A star-shaped outline around the origin as a prism."""
    n = len(outline)
    points = [(x, y, z) for z in (0.0, height) for x, y in outline]
    points += [(0.0, 0.0, 0.0), (0.0, 0.0, height)]
    faces = []
    for i in range(n):
        k = (i + 1) % n
        faces += [(i, k, n + k), (i, n + k, n + i), (2 * n, k, i), (2 * n + 1, n + i, n + k)]
    return np.array(points), np.array(faces)


def gear(teeth):
    angles = np.linspace(0.0, 2.0 * np.pi, 4 * teeth, endpoint=False)
    radius = np.where(np.arange(4 * teeth) % 4 < 2, 1.0, 0.7)
    return prism(list(zip(radius * np.cos(angles), radius * np.sin(angles))))


def bodies():
    """Forty-four bodies: convex ones, L, U, chairs, gears and stars, also stretched, turned and moved; columns."""
    rng = np.random.default_rng(7)
    legs = [((x, y, 0.0), (x + 0.2, y + 0.2, 1.0)) for x in (0.0, 0.8) for y in (0.0, 0.8)]
    kinds = {
        "box": box((-1, -1, -1), (1, 1, 1)),
        "ball": ball(),
        "L": joined(((0, 0, 0), (2, 1, 1)), ((0, 1, 0), (1, 3, 1))),
        "U": joined(((0, 0, 0), (3, 1, 1)), ((0, 1, 0), (1, 3, 1)), ((2, 1, 0), (3, 3, 1))),
        "chair": joined(*legs, ((0, 0, 1), (1, 1, 1.1)), ((0, 0, 1.1), (0.1, 1, 2))),
        "gear 5": gear(5),
        "gear 9": gear(9),
        "star": prism([(np.cos(a) * r, np.sin(a) * r) for a, r in zip(np.arange(10) * np.pi / 5, [1.0, 0.4] * 5)]),
    }
    for number in range(12):  # columns of random heights, more than there are pieces
        columns = [
            ((x, y, -z), (x + 1, y + 1, h))
            for (x, y), z, h in zip(np.ndindex(5, 3), rng.uniform(0.1, 3, 15), rng.uniform(0.1, 3, 15))
        ]
        kinds["columns {}".format(number)] = joined(*columns)
    for name, (points, triangles) in kinds.items():
        yield name, np.asarray(points, np.float64), triangles
        for number in range(0 if name.startswith("columns") else 3):
            sides, size = rng.uniform(0.3, 1.0, 3), 10.0 ** rng.uniform(-2, 1)
            placed = size * (np.asarray(points) * sides @ rotation(rng).T + rng.uniform(-2, 2, 3))
            yield "{} {}".format(name, number), placed.astype(np.float32).astype(np.float64), triangles


BODIES = {name: (points, triangles) for name, points, triangles in bodies()}


def run(generator):
    """The value that a generator returns."""
    while True:
        try:
            next(generator)
        except StopIteration as end:
            return end.value


def stored(shape):
    """A shape as files have it: hulls in single precision."""
    if shape.surface is None:
        return shape
    points = shape.surface.points @ shape.pose.rotation.T + shape.pose.position
    points = points.astype(np.float32).astype(np.float64)
    return Shape("mesh", surface=Surface.from_triangles(points, shape.surface.all_triangles()[0]))


def made(name, wanted):
    """The surface, its volume, its mass properties, and its colliders."""
    surface = Surface.from_triangles(*BODIES[name])
    volume = polyhedron_moments(surface)[0]
    body = MassProperties.from_moments(volume, DENSITY)
    return surface, volume.total, body, [stored(one) for one in run(make_colliders(surface, body, wanted))]


def in_mujoco(body, shapes):
    """Mass, center and inertia that MuJoCo computes of the exported colliders."""
    frame = body.principal
    inertial = Inertial.with_agreeing_axes(body.mass, body.center, body.inertia, frame.moments, frame.axes)
    robot = with_colliders(Robot("r", (Link("a", inertial, shapes=(Shape("mesh"),)),)), lambda _link: shapes)
    robot, _ = with_meshes(robot, lambda _name: None)
    link = robot.links[0]
    files = [replace(one, file=f"{i}.stl") if one.surface else one for i, one in enumerate(link.shapes)]
    robot = replace(robot, links=(replace(link, inertial=None, shapes=tuple(files)),))
    text = mjcf.write(robot).replace("<compiler", '<compiler inertiafromgeom="true"', 1)
    assets = {one.file: to_stl(one.surface) for one in files if one.surface}
    model = mujoco.MjModel.from_xml_string(text, assets)
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, model.body_iquat[1])
    turn = turn.reshape(3, 3)
    return model.body_mass[1], model.body_ipos[1], turn * model.body_inertia[1] @ turn.T


def agrees(shapes, body, volume, rtol):
    """Whether MuJoCo's numbers are the stated ones; lengths relative to the radius of gyration."""
    mass, center, inertia = in_mujoco(body, shapes)
    stated = effect(body, shapes, volume).as_record()
    reach = float(np.sqrt(body.principal.moments.max() / body.mass))
    assert mass == pytest.approx(stated["mass_ratio"] * body.mass, rel=rtol)
    assert np.abs(center - body.center - stated["center_shift"]).max() <= rtol * reach
    ratios = np.linalg.eigvalsh(inertia) / body.principal.moments
    assert ratios == pytest.approx(stated["moment_ratios"], rel=rtol)
    return mass, center, inertia


SHAPES = ("box", "axes_box", "sphere", "capsule", "cylinder")


@pytest.mark.parametrize("name", BODIES)
def test_mujoco_agrees_with_stated_effect_and_correction(name):
    """With masses of pieces the body itself is there, if there are enough pieces; else what we state."""
    number = [*BODIES].index(name)
    for shape in (SHAPES[number % len(SHAPES)], "hull", "pieces"):
        _, volume, body, shapes = made(name, Wanted(shape, 0.0, 0.0, 14, 64))
        masses = uniform_masses(DENSITY, shapes)
        agrees([replace(one, mass=mass) for one, mass in zip(shapes, masses)], body, volume, 1e-6)
    corrected = correct_masses(body, shapes)
    assert min(corrected) >= 0.0
    shapes = [replace(one, mass=mass) for one, mass in zip(shapes, corrected)]
    mass, center, inertia = agrees(shapes, body, volume, 1e-6)
    change = effect(body, shapes, volume).inertia_change
    found = np.linalg.norm(inertia - body.inertia) / np.linalg.norm(body.inertia)
    # MuJoCo places the vertices of meshes in single precision.
    assert mass == pytest.approx(body.mass, rel=1e-8) and abs(found - change) < 2e-7
    MATCHED.append(len(shapes) >= 10 and change < 1e-9)


MATCHED: list[bool] = []


def test_ten_bodies_of_ten_pieces_are_matched_by_masses():
    assert sum(MATCHED) >= 10
