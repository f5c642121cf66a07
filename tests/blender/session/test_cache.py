# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The session remembers loaded objects only, by uid, and registers each handler once."""

import body_moments
import bpy
import pytest
from body_moments.blender.session import displayed, memory
from body_moments.blender.session.stored import moments as moments_table
from body_moments.blender.session.tracking import handlers, staleness

from tests.blender.objects import add, dent, measure, mesh_body

pytestmark = pytest.mark.usefixtures("scene")


def objects(count):
    return [bpy.data.objects.new("Object {:d}".format(i), None) for i in range(count)]


def caches():
    return {
        name: value
        for name, value in vars(memory).items()
        if isinstance(value, memory.SessionCache)
    }


def test_cache_follows_renaming_and_ends_with_object():
    cache, (obj,) = memory.SessionCache(), objects(1)
    cache[obj] = 1
    obj.name = "Renamed"
    assert cache.get(obj) == 1
    bpy.data.objects.remove(obj)
    assert bpy.data.objects.new("Renamed", None) not in cache


def test_results_until_change_end_with_the_next_change():
    calls = []

    @memory.until_change
    def name(obj, suffix):
        calls.append(suffix)
        return obj.name + suffix

    memory._containers.pop()
    (obj,) = objects(1)
    assert [name(obj, suffix) for suffix in "abab"] == [obj.name + end for end in "abab"]
    assert calls == ["a", "b"]
    handlers.count_change(obj)
    obj.name = "Renamed"
    assert name(obj, "a") == "Renameda"


def remember():
    """Something in every cache."""
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    bpy.ops.object.body_moments_live()
    obj = add(mesh_body())
    obj.body_moments.kind, obj.body_moments.wall, obj.body_moments.thickness = (
        "SHELL",
        "INWARD",
        0.01,
    )
    measure(obj)
    bpy.context.scene.body_moments.moments_order = 2
    bpy.ops.object.body_moments_compute_moments()
    moments_table.current_numbers(obj, bpy.context.scene)
    displayed.total(bpy.context)
    obj.body_moments.density = 500.0
    dent(obj, -1.0)
    assert staleness.is_edited(obj) and displayed.drawn(obj, bpy.context.scene) is not None
    filled = {name for name, cache in caches().items() if len(cache)}
    assert filled >= {"edited", "carried", "followed", "moments", "walls"}


@pytest.mark.parametrize("end", ["load", "unregister"])
def test_caches_are_empty_after_load_and_unregister(end, tmp_path):
    remember()
    assert memory.shapes and memory.drawn
    if end == "load":
        path = str(tmp_path / "session.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
    else:
        body_moments.unregister()
    try:
        assert {key for key, cache in caches().items() if len(cache)} == set()
        assert not memory.shapes and not memory.drawn
    finally:
        if end == "unregister":
            body_moments.register()
