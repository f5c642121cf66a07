# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One selection that mixes everything is each of its objects measured by itself: what is stored,
totals, the order of what is reported.
"""

import contextlib
import random

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.findings import BODIES_OVERLAP
from body_moments.blender.session import displayed
from body_moments.blender.session.stored import outcome
from body_moments.blender.write import properties
from body_moments.core.verdict import Severity, sentences

from tests.blender.many_objects import KINDS, stored_on
from tests.blender.objects import only
from tests.corpus import shapes as s

pytestmark = pytest.mark.usefixtures("scene")
COUNT = 16  # meshes, each of one to three objects


def link(obj):
    bpy.context.scene.collection.objects.link(obj)
    return obj


def mesh_of(name, points, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.asarray(points).tolist(), [], [list(map(int, face)) for face in faces])
    return mesh


def place(obj, rng, draw):
    obj.rotation_euler = rng.uniform(-3, 3, 3)
    obj.location = rng.normal(size=3) * 10.0 ** rng.uniform(-2, 6 if draw.random() < 0.2 else 2)
    obj.scale = np.full(3, 10.0 ** rng.uniform(-3, 2)) * (1, 1, draw.choice([1, 1, -1]))
    if draw.random() < 0.25:
        obj.scale.x *= draw.choice([0.5, 3, 1e-3, 0.0])


def set_up(obj, before, draw):
    """Parents, modifiers, kinds, given masses, each of some."""
    settings = obj.body_moments
    if before and draw.random() < 0.1:
        obj.parent = draw.choice(before)
    for chance, kind in ((0.1, "SUBSURF"), (0.1, "MIRROR")):
        if draw.random() < chance:
            obj.modifiers.new(kind, kind)
    if draw.random() < 0.15:
        settings.kind = draw.choice(["SHELL", "WIRE", "SOLID"])
    if draw.random() < 0.2:
        settings.mass_from, settings.mass = "MASS", draw.choice([1.0, 2.5, 1e-9])
    if draw.random() < 0.3:
        settings.density = draw.choice([2700.0, 7850.0])
    obj.hide_render = draw.random() < 0.1


def linked(folder, rng):
    """Objects of a library: closed, open, and one that cannot be measured."""
    boxes = s.box(), s.without(s.box(), 0), s.sheet(3)
    objects = [
        bpy.data.objects.new("Library {}".format(i), mesh_of("Library", *boxes[i]))
        for i in range(len(boxes))
    ]
    path = str(folder / "library.blend")
    bpy.data.libraries.write(path, set(objects))
    names = [obj.name for obj in objects]
    bpy.data.batch_remove(objects)
    with bpy.data.libraries.load(path, link=True) as (_source, target):
        target.objects = names
    return target.objects


def mixed(seed, folder):
    """Objects in random order, selected: meshes of all kinds, some linked to each other, a curve,
    an empty, a camera, and some of a library.
    """
    rng, draw = np.random.default_rng(seed), random.Random(seed)
    made = []
    for number in range(COUNT):
        kind = draw.choice([*KINDS, "cube", "cube"])
        mesh = mesh_of(kind, *(s.box() if kind == "cube" else KINDS[kind](rng, draw.randrange(6))))
        for twin in range(draw.choice([1, 1, 2, 3])):
            obj = bpy.data.objects.new("{} {} {}".format(kind, number, twin), mesh)
            place(obj, rng, draw)
            set_up(obj, made, draw)
            made.append(obj)
    made += [
        bpy.data.objects.new("Empty", None),
        bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera")),
    ]
    made += [
        bpy.data.objects.new("Curve", bpy.data.curves.new("Curve", "CURVE")),
        *linked(folder, rng),
    ]
    draw.shuffle(made)
    for obj in made:
        link(obj)
    bpy.context.view_layer.update()
    only(*made)
    return list(bpy.context.selected_objects)


def measure():
    with contextlib.suppress(RuntimeError):  # a report of an error is one to Python
        bpy.ops.object.body_moments_measure()


def refused(findings):
    return [found.values for found in findings if found.code == "failure"]


def assert_equal(found, expected):
    assert found.keys() == expected.keys()
    for key, value in expected.items():
        if key == "body_principal_axes":  # choices of signs apart, a product of matrices of a stack
            assert np.abs(np.subtract(found[key], value)).max() < 1e-10
        else:
            assert found[key] == value, key


def assert_total_is(total, expected):
    for name in ("count", "volume", "area", "missing", "stale"):
        assert getattr(total, name) == getattr(expected, name), name
    # Overlaps are sought among objects that are measured together.
    found = tuple(one for one in total.findings if one.code != BODIES_OVERLAP)
    assert found == expected.findings
    for name in ("mass", "center", "inertia"):
        assert getattr(total.numbers, name) == getattr(expected.numbers, name), name


@pytest.mark.parametrize("seed", range(3))
def test_a_mixed_selection_is_each_measured_by_itself(seed, tmp_path, reported):
    objects = mixed(seed, tmp_path)
    measure()
    together, total = {obj: stored_on(obj) for obj in objects}, displayed.total(bpy.context)
    groups = outcome.last().groups
    warned = {
        obj.name_full
        for obj in objects
        if obj.library is None
        and sentences.of_severity(properties.findings(obj), Severity.WARNING, Severity.ERROR)
    }
    shown = [group for group in total.groups if sentences.severity(group.finding) != Severity.NOTE]
    assert {name for group in shown for name in group.objects} == warned
    assert 0 < total.count < len(objects) and total.missing
    for obj in objects:
        for key in list(obj.keys()) if obj.library is None else []:
            if key in properties.DESCRIPTIONS:
                del obj[key]
    bpy.context.view_layer.update()
    alone = []
    for obj in objects:
        only(obj)
        reported.clear()
        reported.texts.clear()
        measure()
        alone.append(list(reported))
        assert_equal(together[obj], stored_on(obj))
    only(*objects)
    bpy.context.view_layer.update()
    assert list(bpy.context.selected_objects) == objects
    assert_total_is(total, displayed.total(bpy.context))
    refusals = [values for findings in alone for values in refused(findings)]
    # passed over together
    refusals = [values for values in refusals if values["object"] not in ("Empty", "Camera")]
    kept = {name: group.finding.code for group in groups for name in group.objects}
    assert kept == {values["object"]: values["cause"]["code"] for values in refusals}
    assert "linked_object" in kept.values()
