# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Exported colliders in MuJoCo: its own mass, center and inertia of them are those that we
state.
"""

from dataclasses import replace
from functools import cache
from importlib.resources import files
from pathlib import Path

import mujoco
import numpy as np
import pytest
from body_moments.core.colliders import (
    Wanted,
    correct_masses,
    correct_vertices,
    effect,
    make_colliders,
    uniform_masses,
)
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.mesh.surface import Surface
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.robots.model import Inertial, Link, Robot, Shape
from body_moments.core.robots.read.meshes import read_mesh
from body_moments.core.robots.write import mjcf
from body_moments.core.robots.write.shapes import with_colliders, with_meshes
from body_moments.core.robots.write.stl import to_stl

from tests.core.bodies import box, joined, sphere
from tests.robots.links import rotation
from tools import benchmark_colliders

DENSITY = 700.0
SLOW = {"helix", "knot", "spiral", "bowl", "goblet", "hook", "dumbbell", "cup", "crescent"}
# of the humanoid JVRC-1, closed meshes
LINKS = (
    *(
        "PELVIS",
        "WAIST_Y",
        "WAIST_R",
        "NECK_Y",
        "R_HIP_R",
        "R_HIP_Y",
        "R_KNEE",
        "R_ANKLE_P",
        "R_SHOULDER_P",
    ),
    *("R_SHOULDER_Y", "R_ELBOW_P", "R_ELBOW_Y", "R_WRIST_Y", "R_UTHUMB", "R_LINDEX"),
)
COLUMNS = ["columns {}".format(number) for number in range(6)]
SHAPES = {"box": box((-1, -1, -1), (1, 1, 1)), "ball": sphere(2), **benchmark_colliders.bodies()}
BODIES = (*sorted({*SHAPES} - SLOW), "Suzanne", *LINKS, *COLUMNS)


@cache
def surface_of(name):
    """The surface of a body; stretched, turned and moved if it is neither a robot's link nor
    columns.
    """
    if name in LINKS:
        return read_mesh(Path(str(files("jvrc_description"))) / "meshes" / (name + "_S.dae"))[0]
    rng = np.random.default_rng(BODIES.index(name))
    if name in COLUMNS:  # of random heights, more than there are pieces
        low, high = rng.uniform(0.1, 3.0, (2, 15))
        places = [*np.ndindex(5, 3)]
        return Surface.from_triangles(
            *joined(
                *(box((x, y, -z), (x + 1, y + 1, h)) for (x, y), z, h in zip(places, low, high))
            )
        )
    if name == "Suzanne" and not benchmark_colliders.shutil.which("blender"):
        pytest.skip("needs a real Blender, for Suzanne")
    points, triangles = SHAPES[name] if name in SHAPES else benchmark_colliders.suzanne()[name]
    placed = np.asarray(points) * rng.uniform(0.5, 1.0, 3) @ rotation(rng).T + rng.uniform(
        -2.0, 2.0, 3
    )
    placed *= 10.0 ** rng.uniform(-2.0, 1.0)
    return Surface.from_triangles(placed.astype(np.float32).astype(np.float64), triangles)


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
    surface = surface_of(name)
    volume = polyhedron_moments(surface)[0]
    body = MassProperties.from_moments(volume, DENSITY)
    return (
        surface,
        volume.total,
        body,
        [stored(one) for one in run(make_colliders(surface, body, wanted))],
    )


def in_mujoco(body, shapes):
    """Mass, center and inertia that MuJoCo computes of the exported colliders."""
    frame = body.principal
    inertial = Inertial.with_agreeing_axes(
        body.mass, body.center, body.inertia, frame.moments, frame.axes
    )
    robot = with_colliders(
        Robot("r", (Link("a", inertial, shapes=(Shape("mesh"),)),)), lambda _link: shapes
    )
    robot, _ = with_meshes(robot, lambda _name: None)
    link = robot.links[0]
    files = [
        replace(one, file=f"{i}.stl") if one.surface else one for i, one in enumerate(link.shapes)
    ]
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


@pytest.mark.parametrize("name", BODIES)
def test_mujoco_agrees_with_stated_effect_and_corrections(name):
    """Masses of pieces give the body itself if there are enough pieces, moved vertices always."""
    number = BODIES.index(name)
    for shape in (PRIMITIVES[number % len(PRIMITIVES)], "hull", "pieces"):
        surface, volume, body, shapes = made(name, Wanted(shape, 0.0, 0.0, 14, 64))
        masses = uniform_masses(DENSITY, shapes)
        agrees([replace(one, mass=mass) for one, mass in zip(shapes, masses)], body, volume, 1e-6)
        if shape in ("hull", "pieces"):
            limit = REACH * float(np.ptp(surface.points, axis=0).max())
            steps = correct_vertices(body, shapes, surface, limit, limit)
            moved = [stored(one) for one in run(steps)]
            masses = np.array(uniform_masses(DENSITY, moved))
            masses *= body.mass / masses.sum()
            moved = [replace(one, mass=float(mass)) for one, mass in zip(moved, masses)]
            mass, center, inertia = agrees(moved, body, volume, 1e-6)
            assert mass == pytest.approx(body.mass, rel=1e-6)
            assert np.linalg.norm(center - body.center) < 0.01 * np.sqrt(
                body.principal.moments.max() / mass
            )
            assert np.linalg.eigvalsh(inertia) == pytest.approx(body.principal.moments, rel=0.01)
            assert np.linalg.norm(inertia - body.inertia) < 0.01 * np.linalg.norm(body.inertia)
    corrected = correct_masses(body, shapes)
    assert min(corrected) >= 0.0
    shapes = [replace(one, mass=mass) for one, mass in zip(shapes, corrected)]
    mass, center, inertia = agrees(shapes, body, volume, 1e-6)
    change = effect(body, shapes, volume).inertia_change
    found = np.linalg.norm(inertia - body.inertia) / np.linalg.norm(body.inertia)
    # MuJoCo places the vertices of meshes in single precision.
    assert mass == pytest.approx(body.mass, rel=1e-12) and abs(found - change) < 2e-7
    MATCHED.append(len(shapes) >= 10 and change < 1e-9)


PRIMITIVES = ("box", "axes_box", "sphere", "capsule", "cylinder")
REACH = 0.2  # of the size: limit of moved vertices
MATCHED: list[bool] = []


def test_ten_bodies_of_ten_pieces_are_matched_by_masses():
    assert sum(MATCHED) >= 10
