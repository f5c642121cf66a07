# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw an open crate that is thrown spinning: as MuJoCo moves its hull, its corrected hull, and as
it really moves.

    python3 tests/project.py film

Needs numpy, mujoco and pillow. Writes the animation of docs/colliders.md,
tests/window/pictures/tumbling.gif. The crate turns about its middle principal axis, which is no
steady axis; that of its hull is another one.
"""

from dataclasses import replace

import mujoco
import numpy as np
from benchmark_colliders import run
from loading import ROOT, load_checkout
from PIL import Image

SECONDS, RATE, STEPS = 10, 20, 150  # STEPS of time for each frame
WIDTH, HEIGHT, SCALE = 168, 168, 62.0
SPIN = 5.0  # rad/s
COLORS = np.array([[200, 85, 60], [70, 130, 190], [95, 155, 85]])
LIGHT = np.array([0.35, -0.75, 0.56])
# right, up, towards the eye
VIEW = np.array([[0.8, 0.6, 0.0], [-0.3, 0.4, 0.866], [0.52, -0.693, 0.5]])
OUTER, WALL = np.array([1.3, 0.9, 1.0]), 0.08


def crate():
    """Return points and triangles of a crate without a lid."""
    low, high = np.zeros(3), OUTER
    inner_low, inner_high = low + WALL, high - (WALL, WALL, 0.0)
    corners = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    points = [
        np.where(corner, far, near)
        for near, far in ((low, high), (inner_low, inner_high))
        for corner in corners
    ]
    quads = [(3, 2, 1, 0), (8, 9, 10, 11)]
    for i in range(4):
        k = (i + 1) % 4
        quads += [
            (i, k, k + 4, i + 4),
            (k + 8, i + 8, i + 12, k + 12),
            (i + 4, k + 4, k + 12, i + 12),
        ]
    return np.array(points), np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def exact_motion(body, start):
    """Return (frames, 3, 3) rotations of a free body, by Euler's equations and fourth-order
    steps.
    """
    turn, momentum = np.eye(3), body.inertia @ start
    moments, axes = body.principal.moments, body.principal.axes

    def rate(turn):
        own = turn @ axes
        spin = own @ ((own.T @ momentum) / moments)
        return np.cross(spin, turn, axisa=0, axisb=0, axisc=0)

    frames, step = [], 1.0 / RATE / STEPS
    for _ in range(SECONDS * RATE):
        frames.append(turn)
        for _ in range(STEPS):
            a = rate(turn)
            b = rate(turn + step / 2.0 * a)
            c = rate(turn + step / 2.0 * b)
            turn = turn + step / 6.0 * (a + 2.0 * b + 2.0 * c + rate(turn + step * c))
            left, _, right = np.linalg.svd(turn)
            turn = left @ right
    return np.array(frames)


def simulated_motion(shape, start):
    """Return (frames, 3, 3) rotations of a collider in MuJoCo, which computes its inertia, and its
    (3,) center.
    """
    points = " ".join(map("{:.9g}".format, shape.surface.points.ravel()))
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><option gravity='0 0 0' integrator='RK4' timestep='{:.17g}'/><asset><mesh "
        "name='m' vertex='{}'/>"
        "</asset><worldbody><body><freejoint/><geom type='mesh' mesh='m' "
        "mass='{:.17g}'/></body></worldbody>"
        "</mujoco>".format(1.0 / RATE / STEPS, points, shape.mass)
    )
    data, frames = mujoco.MjData(model), []
    data.qvel[3:6] = start
    for _ in range(SECONDS * RATE):
        mujoco.mj_kinematics(model, data)
        frames.append(data.xmat[1].reshape(3, 3).copy())
        for _ in range(STEPS):
            mujoco.mj_step(model, data)
    return np.array(frames), model.body_ipos[1].copy()


def draw(points, triangles, color):
    """Return a (HEIGHT, WIDTH, 3) picture of a body."""
    picture, depth = np.full((HEIGHT, WIDTH, 3), 246, np.uint8), np.full((HEIGHT, WIDTH), -np.inf)
    corners = points[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    seen = corners @ VIEW.T * (SCALE, -SCALE, 1.0) + (WIDTH / 2.0, HEIGHT / 2.0, 0.0)
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    for (a, b, c), normal in zip(seen, normals):
        if normal @ VIEW[2] <= 0.0:
            continue
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        v = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area
        w = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area
        near = a[2] + v * (b[2] - a[2]) + w * (c[2] - a[2])
        covers = (v >= 0.0) & (w >= 0.0) & (v + w <= 1.0) & (near > depth)
        shade = 0.55 + 0.7 * np.clip(np.rint((normal @ LIGHT + 0.6) * 2.5) / 4.0, 0.0, 1.0)
        picture[covers], depth[covers] = (
            np.minimum(shade * color, 255.0).astype(np.uint8),
            near[covers],
        )
    return picture


def main() -> None:
    load_checkout()
    from body_moments.core import MassProperties, Surface, polyhedron_moments
    from body_moments.core.colliders.effects import correct_vertices
    from body_moments.core.colliders.fits import Wanted, make_colliders

    points, triangles = crate()
    surface = Surface.from_triangles(points, triangles)
    body = MassProperties.from_moments(polyhedron_moments(surface)[0], 500.0)
    wanted = Wanted("hull", 0.0, 0.0, 1, 64)
    hulls = [replace(shape, mass=body.mass) for shape in run(make_colliders(surface, body, wanted))]
    corrected = [
        replace(shape, mass=body.mass)
        for shape in run(correct_vertices(body, hulls, surface, 0.3, 0.3))
    ]
    start = body.principal.axes @ (0.2, SPIN, 0.2)
    motions = [simulated_motion(shape, start) for (shape,) in (hulls, corrected)]
    motions.append((exact_motion(body, start), body.center))
    apart = np.trace(motions[1][0].transpose(0, 2, 1) @ motions[2][0], axis1=1, axis2=2)
    print(
        "corrected and exact, apart at most {:.3g}°".format(
            np.degrees(np.arccos((apart.min() - 1.0) / 2.0))
        )
    )
    pictures = []
    for frame in range(SECONDS * RATE):
        row = [
            draw((points - center) @ turns[frame].T, triangles, color)
            for color, (turns, center) in zip(COLORS, motions)
        ]
        pictures.append(np.concatenate(row, axis=1))
    path = ROOT / "tests" / "window" / "pictures" / "tumbling.gif"
    first, *others = map(Image.fromarray, pictures)
    first.save(path, save_all=True, append_images=others, duration=1000 // RATE, loop=0)
    print(path, path.stat().st_size)


if __name__ == "__main__":
    main()
