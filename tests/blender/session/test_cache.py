# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the session remembers is of loaded objects only, and Blender's reports reach all who asked for them."""

from functools import partial
from types import SimpleNamespace

import pytest

pytest.importorskip("bpy")
import body_moments
import bpy
from body_moments.core.verdict.finding import finding
from body_moments.operators.read.tracking import tracking_paused
from body_moments.operators.session import handlers, live, results, staleness, walls
from body_moments.operators.session import moments as moments_table
from body_moments.operators.session import updates as ledger
from body_moments.operators.session.cache import SessionCache

from tests.blender.objects import add, mesh_body, only

pytestmark = pytest.mark.usefixtures("scene")


def objects(count):
    return [bpy.data.objects.new("Object {:d}".format(i), None) for i in range(count)]


def caches():
    modules = (live, moments_table, results, staleness, walls)
    return {
        (module.__name__, name): value
        for module in modules
        for name, value in vars(module).items()
        if isinstance(value, SessionCache)
    }


def test_a_full_cache_forgets_what_was_not_used_for_longest():
    first, second, third, fourth = objects(4)
    cache = SessionCache(3)
    for i, obj in enumerate((first, second, third)):
        cache[obj] = i
    assert cache.get(first) == 0  # used again
    cache[second] = 10  # and changed
    cache[fourth] = 3
    assert third not in cache and cache.get(third, "none") == "none"
    assert sorted(cache) == [0, 3, 10] and len(cache) == 3
    cache.forget(first)
    cache.forget(first)
    assert first not in cache and cache.get(first) is None
    with pytest.raises(KeyError):
        cache[first]
    assert cache[fourth] == 3


def test_a_cache_without_a_limit_keeps_all_and_may_change_while_it_is_read():
    many, cache = objects(200), SessionCache()
    for obj in many:
        cache[obj] = obj.name
    for name in cache:
        cache.forget(bpy.data.objects[name])
    assert not len(cache)


def test_what_is_remembered_follows_a_name_and_is_not_a_successor_s():
    cache, (obj,) = SessionCache(), objects(1)
    cache[obj] = 1
    obj.name = "Renamed"
    assert cache.get(obj) == 1
    bpy.data.objects.remove(obj)
    assert bpy.data.objects.new("Renamed", None) not in cache


def remember():
    """Something in every cache."""
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    bpy.ops.object.body_moments_live()
    obj = add(mesh_body())
    obj.body_moments.kind, obj.body_moments.wall, obj.body_moments.thickness = "SHELL", "INWARD", 0.01
    only(obj)
    bpy.ops.object.body_moments_measure()
    bpy.context.scene.body_moments.moments_order = 2
    bpy.ops.object.body_moments_compute_moments()
    moments_table.current_numbers(obj, bpy.context.scene)
    results.total(bpy.context)
    obj.body_moments.density = 500.0
    obj.data.vertices[0].co.x -= 1.0
    obj.data.update()
    bpy.context.view_layer.update()
    assert staleness.is_edited(obj)
    results.remember_failure(obj, finding("no_faces"))
    assert {key for key, cache in caches().items() if not len(cache)} == set()


@pytest.mark.parametrize("end", ["load", "unregister"])
def test_nothing_is_remembered_when_the_file_or_the_add_on_is_gone(end, tmp_path):
    remember()
    assert staleness._shapes
    if end == "load":
        path = str(tmp_path / "session.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
    else:
        body_moments.unregister()
    try:
        assert {key for key, cache in caches().items() if len(cache)} == set()
        assert not staleness._shapes
    finally:
        if end == "unregister":
            body_moments.register()


def test_each_application_handler_is_added_once_and_survives_a_file(tmp_path):
    def ours():
        return sorted(
            (name, function.__name__)
            for name in dir(bpy.app.handlers)
            if isinstance(functions := getattr(bpy.app.handlers, name), list)
            for function in functions
            if function.__module__.startswith("body_moments.")
        )

    expected = sorted((name, function.__name__) for name, function in handlers.HANDLERS)
    assert ours() == expected
    path = str(tmp_path / "session.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert ours() == expected
    bpy.app.handlers.undo_post.remove(handlers._on_undo)  # another add-on may empty a list
    body_moments.unregister()
    subscribers = [*handlers.on_update, *handlers.on_undo, *handlers.on_load, *handlers.on_save]
    found = ours()
    body_moments.register()
    assert found == subscribers == [] and ours() == expected


def test_a_subscriber_that_fails_keeps_no_other_from_being_called(monkeypatch):
    called = []

    def fail(*_args):
        called.append("fail")
        raise TypeError("planted")

    monkeypatch.setattr(handlers, "on_load", [fail, partial(called.append, "last")])
    before = handlers.generation()
    with pytest.raises(TypeError, match="planted"):
        handlers._on_load()
    assert called == ["fail", "last"] and handlers.generation() > before


def test_every_change_is_counted_and_moves_are_told_from_all_others():
    obj, scene = add(mesh_body()), bpy.context.scene
    bpy.context.view_layer.update()

    def edit():
        obj.data.vertices[0].co.x -= 1.0
        obj.data.update()
        bpy.context.view_layer.update()

    def move():
        obj.location.x += 1.0
        bpy.context.view_layer.update()

    def make():
        scene.collection.objects.link(bpy.data.objects.new("New", None))
        bpy.context.view_layer.update()

    renderer = SimpleNamespace(mode="RENDER", updates=())
    for change, moved in (
        (move, {obj.session_uid}),
        (edit, None),
        (move, {obj.session_uid}),
        (make, None),
        (lambda: handlers._on_frame(scene, bpy.context.view_layer.depsgraph), None),
        (lambda: handlers._on_update(scene, renderer), None),
        (lambda: handlers._on_update(scene), None),
        (handlers._on_undo, None),
        (handlers._on_load, None),
        (handlers.count_change, None),
        (move, {obj.session_uid}),
    ):
        before = handlers.generation()
        change()
        assert handlers.generation() > before and handlers.moved_since(before) == moved
        assert handlers.moved_since(handlers.generation()) == (moved or set())


def test_what_was_updated_is_passed_on_once_and_as_original_data(monkeypatch):
    seen, quiet = [], []
    monkeypatch.setattr(handlers, "on_update", [seen.append])
    shaped, moved = add(mesh_body()), add(mesh_body(), "Moved")
    collection = bpy.data.collections.new("Collection")
    bpy.context.scene.collection.children.link(collection)
    bpy.context.view_layer.update()
    seen.clear()
    shaped.data.vertices[0].co.x -= 1.0
    shaped.data.update()
    shaped.location.x = moved.location.x = 5.0
    bpy.context.view_layer.update()
    (updates,) = seen
    assert (updates.reshaped, updates.moved) == ([shaped.session_uid], [moved.session_uid])
    assert updates.scene == bpy.context.scene and not updates.collections and not updates.frame_changed
    handlers._on_update(updates.scene, SimpleNamespace(mode="RENDER", updates=updates.depsgraph.updates))
    handlers._on_update(updates.scene)
    assert len(seen) == 1  # neither a renderer's evaluation nor none
    collection.objects.link(shaped)
    bpy.context.view_layer.update()
    assert collection.session_uid in seen[-1].collections
    monkeypatch.setattr(handlers, "on_update", [ledger._note_updates, quiet.append])
    changes = ledger.last_change_of_geometry(shaped)
    with tracking_paused():
        shaped.data.update()
        bpy.context.view_layer.update()
    assert ledger.last_change_of_geometry(shaped) == changes and quiet[-1].reshaped == [shaped.session_uid]


def test_what_a_panel_shows_is_kept_until_anything_that_it_is_made_of_changes():
    obj, scene = add(mesh_body()), bpy.context.scene
    bpy.ops.object.body_moments_compute_moments()
    shown = moments_table.current_numbers(obj, scene)
    assert moments_table.current_numbers(obj, scene) is shown
    scene.body_moments.moments_of = "SURFACE"
    area = moments_table.current_numbers(obj, scene)
    assert area[0][0].unit == "m²" and shown[0][0].unit == "m³"
    bpy.ops.object.body_moments_compute_moments()
    assert moments_table.current_numbers(obj, scene) is not area
    before = results.total(bpy.context)
    assert results.total(bpy.context) is before
    staleness.mark_object(obj)
    assert results.total(bpy.context) is not before
