# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of many kinds, measured together."""

import bpy
import numpy as np
from body_moments.blender.write import properties

from tests.corpus import shapes as s

KINDS = {
    "shard": lambda rng, i: s.random_hull(i),
    "tetrahedra": lambda rng, i: s.random_tetrahedra(i, count=1),
    "box": lambda rng, i: s.box(-rng.uniform(0.5, 2, 3), rng.uniform(0.5, 2, 3)),
    "cylinder": lambda rng, i: s.prism(s.regular(5 + i % 28), height=rng.uniform(0.5, 3)),
    "L": lambda rng, i: s.prism(s.L_PLAN, slant=(0.1 * i, 0.2)),
    "open": lambda rng, i: s.without(s.box((0, 0, 0), rng.uniform(0.5, 2, 3)), 0),
    "tube": lambda rng, i: s.without(s.prism(s.regular(5 + i), height=rng.uniform(0.5, 3)), 0, 1),
    "holed": lambda rng, i: s.without(s.random_hull(i), 2, 7, 11),
    "halves": lambda rng, i: s.joined(
        s.box((5, 0, 0), (6, 1, 1)),
        s.without(s.box((8, 0, 0), rng.uniform(9, 10, 3)), i),
        s.without(s.random_hull(i), i),
    ),
    "warped": lambda rng, i: s.without(
        (s.box()[0] + rng.uniform(-0.1, 0.1, (8, 3)), s.box()[1]), 2
    ),
    "cracked": lambda rng, i: cracked(10.0 ** (i - 9.5)),
    "two": lambda rng, i: s.joined(s.box(), s.box((3, 0, 0), rng.uniform(4, 5, 3))),
    "touching": lambda rng, i: s.joined(s.box(), s.box((1, 0, 0), rng.uniform(2, 3, 3))),
    "nested": lambda rng, i: s.joined(
        s.box((0, 0, 0), (9, 9, 9)), s.box((3, 3, 3), rng.uniform(4, 5, 3))
    ),
    "cavity": lambda rng, i: s.joined(
        s.box((0, 0, 0), (9, 9, 9)), s.inverted(s.box((3, 3, 3), rng.uniform(4, 5, 3)))
    ),
    "inside out": lambda rng, i: s.joined(
        s.box(), s.inverted(s.box((3, 0, 0), rng.uniform(4, 5, 3)))
    ),
    "scattered": lambda rng, i: s.joined(
        *[s.box((3 * k, 0, 0), rng.uniform(1, 2, 3) + [3 * k, 0, 0]) for k in range(5)]
    ),
    "with a leaf": lambda rng, i: s.joined(
        s.box(), (s.box((3, 0, 0), (4, 1, 1))[0] * [1, 1, 1e-13], s.box()[1])
    ),
    "box and hull": lambda rng, i: s.joined(s.box((5, 5, 5), (6, 6, 6)), s.random_hull(i)),
    "flipped": lambda rng, i: s.with_flipped(s.random_hull(i), 1),
    "inverted": lambda rng, i: s.inverted(s.random_hull(i)),
    "bent": lambda rng, i: (s.box()[0] + rng.uniform(-0.1, 0.1, (8, 3)), s.box()[1]),
    "flat": lambda rng, i: s.sheet(3),
    "two-sided": lambda rng, i: (
        np.column_stack([s.regular(4), np.zeros(4)]) @ np.linalg.qr(rng.normal(size=(3, 3)))[0],
        [[0, 1, 2], [0, 2, 3], [1, 0, 3], [1, 3, 2]],
    ),
    "twice": lambda rng, i: (s.random_hull(i)[0], [*s.random_hull(i)[1], *s.random_hull(i)[1][:2]]),
    "far": lambda rng, i: s.box((1e3, 1e3, 1e3), (1e3 + 0.1**i, 1e3 + 1.0, 1e3 + 1.0)),
    "rod": lambda rng, i: s.box((3, 0, 0), (4, 1e-4, 1e-4)),
    "unwelded": lambda rng, i: s.unwelded(s.random_hull(i)),
}


def cracked(width):
    """A box with one corner of one face in another place."""
    points, faces = s.box()
    face = next(i for i, corners in enumerate(faces) if 0 in corners)
    moved = [8 if corner == 0 else corner for corner in faces[face]]
    return np.concatenate([points, points[:1] - width]), [*faces[:face], moved, *faces[face + 1 :]]


def shards(count=4, seed=3):
    """Bodies of all kinds, far away, tiny, mirrored, stretched and sheared; each once more as a
    linked copy.
    """
    rng, made = np.random.default_rng(seed), []
    for kind, make in KINDS.items():
        for i in range(count):
            points, faces = make(rng, i)
            mesh = bpy.data.meshes.new(kind)
            mesh.from_pydata(
                np.asarray(points).tolist(), [], [list(map(int, face)) for face in faces]
            )
            for twin in range(2):
                obj = bpy.data.objects.new("{} {} {}".format(kind, i, twin), mesh)
                bpy.context.scene.collection.objects.link(obj)
                obj.rotation_euler = rng.uniform(-3, 3, 3)
                obj.location = rng.normal(size=3) * 10.0 ** rng.uniform(-2, 4)
                obj.scale = np.full(3, 10.0 ** rng.uniform(-3, 2)) * (1, 1, -1 if i % 3 == 1 else 1)
                if i % 4 == 3:
                    obj.scale.x *= 3.0
                if twin and i == 2:
                    obj.body_moments.mass_from, obj.body_moments.mass = "MASS", 7.5
                if i == 3 and twin:  # sheared
                    outer = bpy.data.objects.new("Outer", None)
                    bpy.context.scene.collection.objects.link(outer)
                    outer.scale, obj.parent = (1.0, 2.0, 0.5), outer
                made.append(obj)
    bpy.context.view_layer.update()
    return made


def stored_on(obj):
    return {
        key: obj[key].to_list() if hasattr(obj[key], "to_list") else obj[key]
        for key in properties.DESCRIPTIONS
        if key in obj
    }
