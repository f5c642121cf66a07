# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""When objects with Live on are followed and measured: by a clock and a window that stand still unless told."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.operators.session import handlers, live
from body_moments.operators.settings.preferences import BodyMomentsPreferences

from tests.blender.objects import add, mesh_body, only
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


class Clock:
    """Stands for the module `time`."""

    now = 100.0

    def thread_time(self):
        return self.now

    monotonic = thread_time


@pytest.fixture
def clock(monkeypatch):
    made = Clock()
    monkeypatch.setattr(live, "time", made)
    monkeypatch.setattr(live, "_budget", lambda: 1.0)
    return made


@pytest.fixture
def bodies(clock):
    """Three objects with Live on."""
    made = [add(mesh_body(), name) for name in "ABC"]
    only(*made)
    assert bpy.ops.object.body_moments_live() == {"FINISHED"}
    return made


def passes(clock, obj, seconds):
    """Let a pass over an object take so long; gives the list of passes."""
    done, followed = [], live._followed[obj]

    def follow(followed_object, _depsgraph):
        clock.now += seconds
        done.append(followed_object)
        return 2.0, np.zeros(3)

    followed.surface = SimpleNamespace(follow=follow)
    return done


def events(**others):
    """What Blender has evaluated anew."""
    graph = SimpleNamespace(view_layer=bpy.context.view_layer)
    plain = {"reshaped": [], "moved": [], "others": [], "collections": []}
    return SimpleNamespace(**{"depsgraph": graph, "frame_changed": False, **plain, **others})


def redraw(*objects):
    """Follow at once what was evaluated anew; gives the names of those with current numbers."""
    for obj in objects:
        live._followed[obj].first_order = 1.0, np.ones(3)
    live._follow_at_once(events(), {obj.session_uid for obj in objects})
    now = [(obj.name, live._followed[obj].first_order) for obj in objects]
    assert all(numbers is None or numbers[0] == 2.0 for _, numbers in now)  # those of before are never left
    return [name for name, numbers in now if numbers is not None]


def test_the_quickest_are_followed_as_far_as_the_budget_lasts_and_the_others_soon(bodies, clock):
    for obj, seconds in zip(bodies, (0.375, 0.625, 0.5)):
        passes(clock, obj, seconds)
        live._followed[obj].pass_seconds = seconds
    assert redraw(*bodies) == ["A", "C"]  # 0.375 + 0.5, and 0.625 is more than what is left
    kept = [live._followed[obj].pass_seconds for obj in bodies]
    assert kept[::2] == [0.375, 0.5] and 0.3 < kept[1] < 0.625
    assert redraw(*bodies) == ["A", "B"]  # which is tried before C now, and takes as long as it did
    assert live._followed[bodies[1]].pass_seconds == 0.625
    assert live._followed[bodies[0]].first_order[0] == 2.0
    assert redraw(bodies[1], bodies[2]) == ["C"]  # which is tried first now
    live._followed[bodies[2]].first_order = None
    assert redraw(bodies[0]) == ["A"] and live._followed[bodies[2]].first_order is None


@pytest.mark.parametrize("budget", [1.0, 0.25])
def test_the_only_pass_of_a_redraw_may_take_some_budgets_and_a_busy_moment_is_not_for_ever(
    budget, bodies, clock, monkeypatch
):
    monkeypatch.setattr(live, "_budget", lambda: budget)
    obj, other = bodies[:2]
    done, followed = passes(clock, obj, 5.0 * budget), live._followed[obj]
    followed.pass_seconds = 5.0 * budget
    assert redraw(obj) == ["A"] and done == [obj]
    followed.pass_seconds = 5.125 * budget
    assert redraw(obj) == [] and done == [obj]
    assert redraw(obj) == ["A"] and done == [obj, obj]
    followed.pass_seconds = 40.0 * budget
    tries = next(count for count in range(1, 20) if redraw(obj))
    assert 4 <= tries <= 10
    live._followed[other].surface, live._followed[other].pass_seconds = None, 0.0
    assert redraw(obj, other) == ["A"]  # what cannot be followed is no pass


def test_what_was_evaluated_is_pending_followed_and_scheduled(bodies, monkeypatch, clock):
    first, second, _third = bodies
    followed, scheduled, rendering = [], [], []
    app = SimpleNamespace(is_job_running=lambda job: job in rendering)
    monkeypatch.setattr(live, "bpy", SimpleNamespace(app=app))
    monkeypatch.setattr(live, "_schedule", scheduled.append)
    monkeypatch.setattr(live, "_follow_at_once", lambda _events, uids: followed.append(uids))

    def told(**updates):
        """What is followed, whether something is scheduled, and what is pending."""
        clock.now += 1.0
        for obj in bodies:
            live._followed[obj].is_pending = False
        followed.clear(), scheduled.clear()
        live._note_updates(events(**updates))
        assert live._last_event == clock.now and scheduled in ([], [0.0])
        return followed[:], bool(scheduled), [obj.name for obj in bodies if live.is_pending(obj)]

    uid, other = first.session_uid, 123456789
    assert told() == told(reshaped=[other], moved=[other], collections=[other]) == ([], False, [])
    assert told(reshaped=[uid, other]) == ([{uid}], True, ["A"])
    assert told(moved=[other, uid]) == ([], True, [])
    assert told(others=[uid]) == ([], False, [])
    rendering.append("RENDER")
    assert told(reshaped=[uid]) == ([], True, ["A"])
    rendering.clear()
    live._followed[second].shows_others = True
    for name in ("reshaped", "moved", "collections"):
        assert told(**{name: [other]}) == ([], True, [])
    assert told(others=[other]) == ([], False, [])
    live._followed[second].shows_others = False
    for mode, active, updated, is_drawn in (
        ("SCULPT", first, [uid], True),
        ("SCULPT", first, [second.session_uid], False),
        ("OBJECT", first, [uid], False),
        ("SCULPT", None, [uid], False),
    ):
        stand_in = active and SimpleNamespace(mode=mode, session_uid=active.session_uid)
        graph = SimpleNamespace(view_layer=SimpleNamespace(objects=SimpleNamespace(active=stand_in)))
        assert told(depsgraph=graph, others=updated)[2] == ["A"] * is_drawn
    stranger = SimpleNamespace(mode="SCULPT", session_uid=other)
    graph = SimpleNamespace(view_layer=SimpleNamespace(objects=SimpleNamespace(active=stranger)))
    assert told(depsgraph=graph, others=[other]) == ([], False, [])
    for obj in bodies:
        live.stop(obj)
    assert live._note_updates in handlers.on_update
    live._note_updates(events(reshaped=[uid]))
    assert live._note_updates not in handlers.on_update


@pytest.fixture
def timer(bodies, clock, monkeypatch):
    """The timer's surroundings, and what it does."""
    told, areas = [], []
    for kind in ("VIEW_3D", "PROPERTIES", "OUTLINER"):
        areas.append(SimpleNamespace(type=kind, tag_redraw=lambda kind=kind: told.append(kind)))
    window = SimpleNamespace(screen=SimpleNamespace(areas=areas, is_animation_playing=False), modal_operators=[])
    layer = SimpleNamespace(objects=bpy.context.view_layer.objects, update=lambda: told.append("evaluated"))
    context = SimpleNamespace(
        view_layer=layer,
        evaluated_depsgraph_get=bpy.context.evaluated_depsgraph_get,
        window_manager=SimpleNamespace(windows=[window]),
    )
    app = SimpleNamespace(is_job_running=lambda _: False)
    monkeypatch.setattr(live, "bpy", SimpleNamespace(app=app, context=context))

    def update(obj, _depsgraph):
        told.append(obj.name)
        live._followed[obj].is_pending = False

    monkeypatch.setattr(live, "update", update)

    def tick(since=0.0, **seconds):
        """Let it come so long after the last update, with pending objects that have taken so long."""
        told.clear()
        monkeypatch.setattr(live, "_last_event", clock.now - since)
        for obj in bodies:
            now = live.current_numbers(obj)
            taken = seconds.get(obj.name, 0.0)
            live._followed[obj].is_pending = obj.name in seconds
            live._followed[obj].result = live.LiveResult(now.measurement, None, taken, now.settings)
        return live._tick(), told[:]

    return tick, window


REDRAWN = ["VIEW_3D", "PROPERTIES"]


def test_the_timer_measures_what_the_budget_allows_and_the_rest_when_nothing_happens_any_more(timer):
    tick, window = timer
    assert tick() == (None, [])
    assert tick(A=1.0) == (None, ["A", *REDRAWN])
    assert tick(A=1.125) == (live.POLL, REDRAWN)
    assert tick(A=0.5, B=0.375, C=0.25) == (live.POLL, ["C", "B", *REDRAWN])
    assert tick(A=0.5, B=0.5) == (None, ["A", "B", *REDRAWN])
    idle = 0.25
    assert tick(since=0.9 * idle, A=9.0) == (live.POLL, REDRAWN)
    assert tick(since=1.1 * idle, A=9.0, B=8.0) == (None, ["B", "A", *REDRAWN])
    window.screen.is_animation_playing = True
    assert tick(since=60.0, A=9.0, B=0.5) == (live.POLL, ["B", *REDRAWN])
    assert 0.0 < live.POLL < idle / 2.0  # it looks more than once in that time


def test_what_is_sculpted_is_measured_between_strokes(timer, bodies):
    tick, window = timer
    only(bodies[0])
    bpy.ops.object.mode_set(mode="SCULPT")
    try:
        assert tick(A=0.5, B=0.25) == (None, ["B", "evaluated", "A", *REDRAWN])
        window.modal_operators = [SimpleNamespace(bl_idname="SCULPT_OT_brush_stroke")]
        assert tick(since=60.0, A=0.5, B=0.5) == (live.POLL, ["B", *REDRAWN])
        window.modal_operators = [SimpleNamespace(bl_idname="VIEW3D_OT_rotate")]
        assert tick(A=0.5) == (None, ["evaluated", "A", *REDRAWN])
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")


def test_the_timer_knows_how_long_measuring_took(bodies, clock, monkeypatch):
    def measure(*given, measure=live.measure_body):
        clock.now += 0.5
        return measure(*given)

    monkeypatch.setattr(live, "measure_body", measure)
    assert live.update(bodies[0], bpy.context.evaluated_depsgraph_get()).seconds == 0.5


def test_the_budget_is_that_of_the_preferences_where_there_are_some(monkeypatch):
    monkeypatch.setattr(live, "preferences", lambda: SimpleNamespace(live_budget=25.0))
    assert close(live._budget(), 0.025, 1e-12)
    monkeypatch.setattr(live, "preferences", lambda: None)
    default = BodyMomentsPreferences.bl_rna.properties["live_budget"].default
    assert close(live._budget(), 1e-3 * default, 1e-12)


def test_control_points_are_as_exact_wherever_their_object_is(monkeypatch):
    """As their object's coordinates are: the bound on these grows with its scale and the unit, not with its place."""
    given, tracked_solid = [], live.TrackedSolid
    monkeypatch.setattr(live, "TrackedSolid", lambda *them: given.append(them[1]) or tracked_solid(*them))
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    obj, scene = bpy.context.object, bpy.context.scene
    for location, scale, unit in (((0, 0, 0), 1.0, 1.0), ((300, 0, -400), 1.0, 1.0), ((0, 0, 0), 2.0, 0.125)):
        obj.location, obj.scale, scene.unit_settings.scale_length = location, (scale,) * 3, unit
        bpy.context.view_layer.update()
        live.start(obj, bpy.context.evaluated_depsgraph_get())
        assert given[0] > 0.0 and close(given[-1], given[0] * scale * unit, 1e-6)
    assert len(given) == 3


@pytest.mark.parametrize("given_mass", [False, True])
def test_what_is_scaled_has_its_area_and_its_density(given_mass, clock):
    obj = add(mesh_body(), location=(1, 2, 3))
    if given_mass:
        obj.body_moments.mass_from, obj.body_moments.mass = "MASS", 3.5
    only(obj)
    bpy.ops.object.body_moments_live()
    before = live.current_properties(obj, bpy.context.scene)
    obj.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    after = live.current_properties(obj, bpy.context.scene)
    assert close(after.area, 4.0 * before.area, 1e-9) and close(after.volume, 8.0 * before.volume, 1e-9)
    assert close(after.density, before.density / (8.0 if given_mass else 1.0), 1e-9)
    assert close(after.body.mass, before.body.mass * (1.0 if given_mass else 8.0), 1e-9)
