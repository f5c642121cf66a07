# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random sessions: what a person does to a scene, in any order, with undo and redo and changes that
are not keyed.

After each step every number that is shown is that of its object, or is said to be out of date;
nothing that was changed and not keyed is lost to an operator of ours; no handler fails. A step that
a session's seed and number name is found again by running that seed.
"""

from __future__ import annotations

import random
import time
from collections import Counter

import bmesh
import bpy
import numpy as np
from body_moments.blender.read.mesh import MAX_DIGESTED_FACES
from body_moments.blender.session import displayed, memory
from body_moments.blender.session.live import measuring as live
from body_moments.blender.session.tracking import handlers, staleness
from body_moments.blender.write import properties
from body_moments.core.verdict import MeasureError

from tests.blender.objects import add, arrays, measured, mesh_body

STEPS = 40  # Steps of a session.
MAX_OBJECTS = 6
RTOL = 1e-5


class Session:
    """One scene, and what was changed in it without a key."""

    def __init__(self, seed: int):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.draw = random.Random(seed)
        self.calls: list[str] = []
        self.counted: Counter[str] = Counter()
        self.failures: list[str] = []
        for name in ("A", "B"):
            self.add(name)
        bpy.ops.ed.undo_push(message="Start")

    @property
    def objects(self):
        return [obj for obj in bpy.context.view_layer.objects if obj.type == "MESH"]

    def add(self, name):
        draw = self.draw
        place = [draw.uniform(-9, 9) for _ in range(3)]
        scale = [draw.choice((-1, 1)) * draw.uniform(0.3, 3) for _ in range(3)]
        obj = add(mesh_body(name), name, place, [draw.uniform(-3, 3) for _ in range(3)], scale)
        obj.shape_key_add(name="Basis")
        obj.shape_key_add(name="Key").data[0].co.x -= 0.5
        return obj

    def any(self):
        return self.draw.choice(self.objects)

    def run(self):
        for number in range(STEPS):
            step = self.draw.choice(PERSON + OURS + OURS)
            self.calls.append(step.__name__)
            self.counted[
                "of ours" if step in OURS else "undo and redo" if step in HISTORY else "of a person"
            ] += 1
            kept = self.unkeyed() if step in OURS else {}
            try:
                step(self)
            except RuntimeError as error:  # a refusal, or an operator that cannot run now
                if "Traceback" in str(error):
                    raise
            bpy.context.view_layer.update()
            self.check(kept, number)
            if step not in HISTORY:
                bpy.ops.ed.undo_push(message=step.__name__)

    def unkeyed(self):
        """Return the state of each object that no operator may change."""
        return {
            obj.name: (
                [key.value for key in obj.data.shape_keys.key_blocks]
                if obj.data.shape_keys
                else [],
                [
                    (modifier.name, getattr(modifier, "thickness", None))
                    for modifier in obj.modifiers
                ],
                obj.get("own"),
            )
            for obj in self.objects
        }

    def check(self, kept, number):
        place = "step {:d}: {}".format(number, ", ".join(self.calls))
        assert not self.failures, (place, self.failures)
        now = self.unkeyed()
        assert {name: now[name] for name in kept if name in now} == {
            name: kept[name] for name in kept if name in now
        }, place
        for obj in self.objects:
            if obj.visible_get():
                self.check_object(obj, place)

    def check_object(self, obj, place):
        scene = bpy.context.scene
        is_stored = properties.is_stored(obj) and staleness.stale_reason(obj, scene) is None
        current = displayed.displayed(obj, scene) if obj in memory.followed else None
        shown = (
            None
            if current is None or current.verdict == displayed.Verdict.OUT_OF_DATE
            else current.world
        )
        drawn, now = displayed.drawn(obj, scene), current or displayed.displayed(obj, scene)
        same = drawn is None or (drawn.world, drawn.verdict) == (now.world, now.verdict)
        assert same, (place, obj.name, "overlay and panel differ")
        if not is_stored and shown is None:
            return
        try:
            truth = measured(obj)
        except MeasureError as refusal:
            raise AssertionError(
                (place, obj.name, "shown, and cannot be measured", str(refusal))
            ) from None
        body = truth.mass_properties
        reach = np.linalg.norm(body.center) + np.linalg.norm(body.radii_of_gyration)
        if is_stored:
            stored = properties.stored(obj).in_world(obj.matrix_world, 1.0)
            found = arrays(stored)
            same = np.allclose(
                [stored.mass, stored.volume], [body.mass, truth.volume], rtol=RTOL, atol=0.0
            )
            assert same and np.linalg.norm(found.center - body.center) <= RTOL * reach, (
                place,
                obj.name,
                "stored",
            )
            spread = np.abs(found.inertia - body.inertia).max()
            assert spread <= 10.0 * RTOL * body.principal.moments.max(), (
                place,
                obj.name,
                "stored inertia",
            )
        if shown is not None:
            same = np.allclose(
                [shown.mass, shown.volume], [body.mass, truth.volume], rtol=RTOL, atol=0.0
            )
            assert same and np.linalg.norm(shown.center - body.center) <= RTOL * reach, (
                place,
                obj.name,
                "live",
            )


# ---------------------------------------------------------------- What a person does


def adds(session):
    if len(session.objects) < MAX_OBJECTS:
        session.add(session.draw.choice("CDEF"))


def duplicates(session):
    if len(session.objects) < MAX_OBJECTS:
        bpy.ops.object.duplicate(linked=session.draw.random() < 0.5)


def deletes(session):
    if len(session.objects) > 2:
        bpy.data.objects.remove(session.any())


def selects(session):
    bpy.ops.object.select_all(action="DESELECT")
    for obj in session.draw.sample(session.objects, session.draw.randint(1, len(session.objects))):
        obj.select_set(True)
        bpy.context.view_layer.objects.active = obj


def moves(session):
    session.any().location[session.draw.randrange(3)] += session.draw.uniform(-5, 5)


def turns(session):
    session.any().rotation_euler[session.draw.randrange(3)] += session.draw.uniform(-2, 2)


def scales(session):
    session.any().scale[session.draw.randrange(3)] *= session.draw.uniform(0.5, 2)


def edits(session):
    mesh = session.any().data
    mesh.vertices[0].co.z -= 0.1
    if mesh.shape_keys:
        mesh.shape_keys.key_blocks[0].data[0].co.z -= 0.1
    mesh.update()


def edits_in_edit_mode(session):
    obj = session.any()
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    mesh = bmesh.from_edit_mesh(obj.data)
    mesh.verts.ensure_lookup_table()
    mesh.verts[session.draw.randrange(3)].co.z -= 0.05
    bmesh.update_edit_mesh(obj.data)
    bpy.context.view_layer.update()
    if session.draw.random() < 0.5:
        bpy.ops.object.body_moments_measure()
        bpy.context.view_layer.update()
    bpy.ops.object.mode_set(mode="OBJECT")


def changes_shape_key(session):
    obj = session.any()
    if obj.data.shape_keys:
        obj.data.shape_keys.key_blocks[-1].value = session.draw.random()


def keys(session):
    obj = session.any()
    obj.keyframe_insert(
        session.draw.choice(("location", "scale")), frame=bpy.context.scene.frame_current
    )
    if obj.data.shape_keys:
        obj.data.shape_keys.key_blocks[-1].keyframe_insert(
            "value", frame=bpy.context.scene.frame_current
        )


def goes_to_frame(session):
    bpy.context.scene.frame_set(session.draw.randint(1, 20))


def adds_modifier(session):
    obj = session.any()
    if len(obj.modifiers) < 2:
        obj.modifiers.new(
            "Solidify" if session.draw.random() < 0.3 else "Subdivision", "SUBSURF"
        ).levels = 1


def changes_modifier(session):
    for modifier in session.any().modifiers:
        modifier.levels = session.draw.randint(0, 2)


def paints(session):
    session.any()["own"] = session.draw.random()


def hides(session):
    session.any().hide_set(session.draw.random() < 0.3)


def sets_density(session):
    session.any().body_moments.density = session.draw.uniform(100, 9000)


def sets_mass(session):
    settings = session.any().body_moments
    settings.mass_from = session.draw.choice(("MASS", "DENSITY"))
    settings.mass = session.draw.uniform(0.1, 100)


def sets_kind(session):
    settings = session.any().body_moments
    settings.kind, settings.thickness = session.draw.choice(("SOLID", "SHELL")), 0.01


def sets_unit(session):
    session.any().body_moments.overlap = session.draw.choice(("SIGNED", "UNION"))


def undoes(session):
    bpy.ops.ed.undo()


def redoes(session):
    bpy.ops.ed.redo()


# ---------------------------------------------------------------- What we do


def measures(session):
    bpy.ops.object.body_moments_measure()


def clears(session):
    bpy.ops.object.body_moments_clear()


def switches_live(session):
    bpy.ops.object.body_moments_live()


def waits(session):
    live._tick()


def sets_material(session):
    bpy.ops.object.body_moments_set_material(
        material=session.draw.choice(("PLA", "Steel, Carbon", "Oak, Red"))
    )


def copies_settings(session):
    bpy.ops.object.body_moments_copy_settings()


def finds_symmetry(session):
    bpy.ops.object.body_moments_find_symmetry()


def moves_origin(session):
    bpy.ops.object.body_moments_origin_to_center()


def turns_axes(session):
    bpy.ops.object.body_moments_axes_to_principal()


def adds_empty(session):
    bpy.ops.object.body_moments_add_empty()


def totals(session):
    displayed.total(bpy.context)


HISTORY = (undoes, redoes)
PERSON = (
    *(adds, duplicates, deletes, selects, selects, moves, turns, scales, edits, edits_in_edit_mode),
    *(
        changes_shape_key,
        keys,
        goes_to_frame,
        goes_to_frame,
        adds_modifier,
        changes_modifier,
        paints,
        hides,
    ),
    *(sets_density, sets_mass, sets_kind, sets_unit, *(3 * HISTORY)),
)
OURS = (
    *(
        measures,
        measures,
        measures,
        clears,
        switches_live,
        waits,
        sets_material,
        copies_settings,
        finds_symmetry,
    ),
    *(moves_origin, turns_axes, adds_empty, totals),
)


def run(budget_seconds: float, seed: int) -> str:
    """Run sessions until the budget is spent.

    Parameters
    ----------
    budget_seconds : float
    seed : int

    Returns
    -------
    str
        How many sessions and calls there were.

    Raises
    ------
    AssertionError
        With the seed of the session and its steps.
    """
    end, sessions, counted = time.monotonic() + budget_seconds, 0, Counter()
    called, idle = handlers._call, live.IDLE
    live.IDLE = 0.0
    try:
        while time.monotonic() < end or not sessions:
            session = Session(seed + sessions)

            def noted(subscribers, *args, session=session):
                try:
                    called(subscribers, *args)
                except Exception as error:
                    session.failures.append(repr(error))
                    raise

            handlers._call = noted
            try:
                session.run()
            except Exception as error:
                raise AssertionError("seed {:d}, {}".format(seed + sessions, error)) from error
            sessions += 1
            counted += session.counted
    finally:
        handlers._call, live.IDLE = called, idle
    calls = ", ".join("{:d} {}".format(count, whose) for whose, count in counted.most_common())
    return "{:d} sessions of {:d} calls ({}), meshes to {:d} faces compared".format(
        sessions, STEPS, calls, MAX_DIGESTED_FACES
    )
