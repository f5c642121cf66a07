# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies that are broken at random in known ways, with the volume that whoever broke them means."""

import numpy as np
from body_moments.core.mesh.surface import Surface
from body_moments.core.solid.measure import measure_solid
from body_moments.core.verdict import severity

from tests.core.bodies import (
    TOP,
    box,
    grid,
    inverted,
    joined,
    moebius,
    moved,
    rotation,
    soup,
    sphere,
    torus,
    volume,
    welded,
    with_flipped,
    without,
)
from tests.core.shapes import L_PRISM, prism

CONVEX = [
    lambda rng: box(),
    lambda rng: sphere(int(rng.integers(1, 4))),
    lambda rng: prism(int(rng.integers(3, 12))),
]
WHOLE = [
    *CONVEX,
    lambda rng: torus(int(rng.integers(8, 30)), int(rng.integers(5, 20))),
    lambda rng: welded(L_PRISM),
]
LABELS = ("exact", "exact, with a note", "exact, with a warning", "reoriented", "capped", "open")


def _whole(rng):
    part = WHOLE[rng.integers(len(WHOLE))](rng)
    return part, volume(part)


def _convex(rng):
    part = CONVEX[rng.integers(len(CONVEX))](rng)
    return part, volume(part)


def _some(rng, part, share):
    count = len(part[1])
    return rng.choice(count, size=max(1, int(share * count)), replace=False)


def sound(rng):
    return _whole(rng)


def inside_out(rng):
    part, true = _whole(rng)
    return inverted(part), true


def flipped_faces(rng):
    part, true = _whole(rng)
    return with_flipped(part, *_some(rng, part, rng.uniform(0.0, 0.4))), true


def missing_faces(rng):
    part, true = _whole(rng)
    return without(part, *_some(rng, part, rng.uniform(0.0, 0.1))), true


def missing_side(rng):
    return without(box(), *TOP), 1.0


def many_missing_faces(rng):
    part, true = _whole(rng)
    return without(part, *_some(rng, part, rng.uniform(0.3, 0.6))), true


def copied_faces(rng):
    part, true = _whole(rng)
    again = part[1][_some(rng, part, rng.uniform(0.0, 0.2))]
    return (part[0], np.concatenate([part[1], again[:, :: rng.choice([1, -1])]])), true


def faces_without_area(rng):
    part, true = _whole(rng)
    ends = rng.integers(0, len(part[0]), size=(4, 2))
    return (part[0], np.concatenate([part[1], ends[:, [0, 1, 0]]])), true


def loose_corners(rng):
    part, true = _whole(rng)
    return soup(part), true


def cracks(rng):
    part, true = _whole(rng)
    points, triangles = soup(part)
    return (points + rng.normal(size=points.shape) * 1e-9, triangles), true


def finer_side(rng):
    return joined(without(box(), *TOP), moved(grid(int(rng.integers(2, 6))), None, (0, 0, 1))), 1.0


def fin(rng):
    points, triangles = _convex(rng)[0]
    true = volume((points, triangles))
    tip = 2.0 * points[triangles[:1, 0]] - points.mean(axis=0)
    return (
        np.concatenate([points, tip]),
        np.concatenate([triangles, [[*triangles[0, :2], len(points)]]]),
    ), true


def parts_apart(rng):
    (first, one), (second, two) = _whole(rng), _whole(rng)
    second = inverted(second) if rng.random() < 0.5 else second
    return joined(first, moved(second, offset=(9, 0, 0))), one + two


def cavity(rng):
    part, true = _convex(rng)
    hole = moved((part[0] - part[0].mean(axis=0), part[1]), 0.5 * np.eye(3), part[0].mean(axis=0))
    whole = joined(part, inverted(hole))
    return (inverted(whole) if rng.random() < 0.3 else whole), true - volume(hole)


def cavity_through_its_wall(rng):
    """The removed part is the part of the cavity inside."""
    depth = 10.0 ** rng.uniform(-5, -1)
    return joined(box(), inverted(box((0.1, 0.2, -depth), (0.9, 0.8, 0.7)))), 1.0 - 0.8 * 0.6 * 0.7


def nested(rng):
    part, true = _convex(rng)
    middle = part[0].mean(axis=0)
    return joined(part, moved((part[0] - middle, part[1]), 0.4 * np.eye(3), middle)), true


def overlapping(rng):
    shift = rng.uniform(0.05, 0.95)
    other = box((shift, 0.1, 0.2), (1.0 + shift, 0.8, 0.9))
    return joined(box(), other), 1.0 + 0.49 * shift


def twice(rng):
    part, true = _convex(rng)
    return joined(part, part), true


def touching_and_welded(rng):
    """Boxes in a row, welded, each with faces of its own where they touch, some inside out."""
    count = int(rng.integers(2, 5))
    parts = [box((k, 0, 0), (k + 1, 1, 1)) for k in range(count)]
    return welded(
        joined(*(inverted(part) if rng.random() < 0.4 else part for part in parts))
    ), float(count)


def bent_past_itself(rng):
    """A bar with a square section, around more than once: its union is a full ring."""
    turn, sections = 1.0 + rng.uniform(0.02, 0.8), 120
    angle = np.linspace(0.0, 2.0 * np.pi * turn, sections + 1)
    section = np.array([[1.3, -0.2], [1.3, 0.2], [0.9, 0.2], [0.9, -0.2]])
    x, y = (np.multiply.outer(side, section[:, 0]) for side in (np.cos(angle), np.sin(angle)))
    points = np.stack([x, y, np.broadcast_to(section[:, 1], x.shape)], axis=-1).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(sections), np.arange(4), indexing="ij"))
    after = (j + 1) % 4
    sides = np.stack(
        [4 * i + j, 4 * i + 4 + j, 4 * i + 4 + after, 4 * i + j, 4 * i + 4 + after, 4 * i + after],
        axis=1,
    )
    ends = [
        [0, 1, 2],
        [0, 2, 3],
        [4 * sections + 2, 4 * sections + 1, 4 * sections],
        [4 * sections + 3, 4 * sections + 2, 4 * sections],
    ]
    part = points, np.concatenate([sides.reshape(-1, 3), ends])
    return part, abs(volume(part)) / turn


def bow_tie(rng):
    """A prism over a polygon that crosses itself: one lobe counts as negative. Both are meant."""
    right = rng.uniform(0.2, 0.9)
    plan = np.array([[-1.0, -1.0], [right, right], [right, -right], [-1.0, 1.0]])
    points = np.concatenate([np.insert(plan, 2, z, axis=1) for z in (0.0, 1.0)])
    sides = [t for i in range(4) for j in [(i + 1) % 4] for t in ((i, j, 4 + j), (i, 4 + j, 4 + i))]
    middle = np.concatenate([points, [[0, 0, 0], [0, 0, 1]]])
    lower = [(8, (i + 1) % 4, i) for i in range(4)]
    upper = [(9, 4 + i, 4 + (i + 1) % 4) for i in range(4)]
    return (middle, np.array(sides + lower + upper)), 1.0 + right**2


def inner_wall(rng):
    points, triangles = welded(joined(box(), box((1, 0, 0), (2, 1, 1))))
    keys = [tuple(sorted(triangle)) for triangle in triangles.tolist()]
    once = [k for k, key in enumerate(keys) if keys.index(key) == k]
    return (points, triangles[once]), 2.0


def one_sided(rng):
    return moebius(int(rng.integers(10, 60))), None


def flat_sheet(rng):
    return grid(int(rng.integers(1, 8))), None


BREAKAGES = [
    *(
        sound,
        inside_out,
        flipped_faces,
        missing_faces,
        missing_side,
        many_missing_faces,
        copied_faces,
    ),
    *(
        faces_without_area,
        loose_corners,
        cracks,
        finer_side,
        fin,
        parts_apart,
        cavity,
        cavity_through_its_wall,
    ),
    *(
        nested,
        overlapping,
        twice,
        touching_and_welded,
        bent_past_itself,
        bow_tie,
        inner_wall,
        one_sided,
        flat_sheet,
    ),
]


def label(result):
    """Return the label that a user sees beside the numbers, one of LABELS."""
    if result.method != "exact":
        return str(result.method)
    if not result.findings:
        return "exact"
    warned = any(severity(found) != "note" for found in result.findings)
    return "exact, with a warning" if warned else "exact, with a note"


def trial(seed):
    """One body, broken and placed at random: the breakage, its label, and how far its volume is
    from the true one, as a share of that, 0 within what rounding and storing the coordinates
    explain; None where no volume is true.
    """
    rng = np.random.default_rng(seed)
    breakage = BREAKAGES[seed % len(BREAKAGES)]
    (points, triangles), true = breakage(rng)
    scale = 10.0 ** rng.uniform(-6, 6)
    stretch = np.diag(rng.uniform(0.5, 2.0, 3)) if rng.random() < 0.5 else np.eye(3)
    linear = scale * rotation(seed) @ stretch
    points = points @ linear.T + rng.normal(size=3) * scale * 10.0 ** rng.uniform(-2, 1.5)
    points = points.astype(np.float32 if rng.random() < 0.7 else np.float64)
    order = rng.permutation(len(triangles))
    result = measure_solid(Surface(points, triangles[order]))
    assert np.isfinite(result.volume.raw).all() and result.volume.total >= 0.0, seed
    if true is None:
        return breakage.__name__, label(result), None
    true *= abs(np.linalg.det(linear))
    allowed = 1e-5 * true + result.volume.input_error[0] + result.volume.rounding_error[0]
    error = abs(result.volume.total - true)
    return breakage.__name__, label(result), 0.0 if error <= allowed else error / true
