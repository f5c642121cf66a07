# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts are registered in their order and removed in reverse, all of them or none; who listens to what is kept."""

import importlib
import sys
from types import SimpleNamespace

import bpy
import pytest
from body_moments import operators, panels
from body_moments.operators import batch
from body_moments.operators.session import assembly, handlers, live, rig, staleness, updates
from body_moments.operators.settings import hooks

pytestmark = pytest.mark.usefixtures("registered")
LISTS = {name: getattr(handlers, name) for name in ("on_update", "before_undo", "on_undo", "on_load", "on_save")}
LISTS |= {name: getattr(hooks, name) for name in vars(hooks) if name.startswith("on_")}


def part(name, told, error=None):
    """A part that says what happens to it."""

    def register():
        told.append("+" + name)
        if error is not None:
            raise error

    return SimpleNamespace(register=register, unregister=lambda: told.append("-" + name))


@pytest.mark.parametrize(("package", "listed"), [(operators, "_parts"), (panels, "_modules")])
def test_where_a_part_fails_those_before_it_are_removed_in_reverse(package, listed, monkeypatch):
    told = []
    parts = [part(name, told) for name in "abc"]
    monkeypatch.setattr(package, listed, lambda: parts)
    package.register()
    assert told == ["+a", "+b", "+c"]
    told.clear()
    package.unregister()
    assert told == ["-c", "-b", "-a"]
    told.clear()
    parts[2] = part("c", told, ZeroDivisionError())
    with pytest.raises(ZeroDivisionError):
        package.register()
    assert told == ["+a", "+b", "+c", "-b", "-a"]


def test_the_classes_of_a_part_are_registered_all_or_none(monkeypatch):
    told = []

    def register_class(cls):
        told.append("+" + cls)
        if cls == "C":
            raise ZeroDivisionError

    monkeypatch.setattr(bpy.utils, "register_class", register_class)
    monkeypatch.setattr(bpy.utils, "unregister_class", lambda cls: told.append("-" + cls))
    operators.register_module(SimpleNamespace(CLASSES=("A", "B")))
    operators.unregister_module(SimpleNamespace(CLASSES=("A", "B")))
    assert told == ["+A", "+B", "-B", "-A"]
    told.clear()
    with pytest.raises(ZeroDivisionError):
        operators.register_module(SimpleNamespace(CLASSES=("A", "B", "C", "D")))
    assert told == ["+A", "+B", "+C", "-B", "-A"]


def test_the_command_is_known_while_it_is_registered(monkeypatch):
    told = []
    monkeypatch.setattr(bpy.utils, "register_cli_command", lambda *given: told.append(given) or "handle")
    monkeypatch.setattr(bpy.utils, "unregister_cli_command", told.append)
    monkeypatch.setattr(batch, "_command", None)
    batch.register()
    batch.unregister()
    assert told == [("body_moments", batch.main), "handle"] and batch._command is None


def test_objects_carry_settings_where_the_add_on_is_not_registered(monkeypatch, unregistered, tmp_path):
    pointers = [
        *((bpy.types.Object, "body_moments"), (bpy.types.Scene, "body_moments"), (bpy.types.PoseBone, "body_moments")),
        *((bpy.types.Collection, "body_moments"), (bpy.types.Scene, "body_moments_reference")),
    ]
    assert not any(hasattr(*pointer) for pointer in pointers)
    for _ in range(2):  # once more does nothing
        batch._load_settings()
        assert all(hasattr(*pointer) for pointer in pointers)
    for name in ("bone", "reference", "assembly", "properties"):
        importlib.import_module("body_moments.operators.settings." + name).unregister()

    def load_settings():
        raise ZeroDivisionError

    monkeypatch.setattr(batch, "_load_settings", load_settings)
    (tmp_path / "a.obj").write_text("v 0 0 0\n")
    with pytest.raises(ZeroDivisionError):
        batch._measure(["measure", str(tmp_path / "a.obj"), "--no-supervisor"], -1, True)


def test_files_are_measured_by_children_beside_the_file_that_is_open(monkeypatch):
    from body_moments.operators.command import supervised

    asked = []
    monkeypatch.setattr(supervised, "measure", lambda *given: asked.append(given) or 7)
    for blender, opened in ((SimpleNamespace(data=SimpleNamespace(filepath="a.blend")), "a.blend"), (None, None)):
        monkeypatch.setitem(sys.modules, "bpy", blender)
        assert batch._measure(["measure", "b.obj"], 3, False) == 7
        assert asked[-1][0].files and asked.pop()[1:] == (3, opened)


def listeners():
    """Who listens to what, by name."""
    named = {name: ["{:s}.{:s}".format(one.__module__, one.__name__) for one in told] for name, told in LISTS.items()}
    for name, function in handlers.HANDLERS:
        named[name] = [one.__name__ for one in getattr(bpy.app.handlers, name) if one is function]
    return {name: [one.replace("body_moments.operators.", "") for one in told] for name, told in named.items() if told}


def test_who_listens_to_what_while_the_add_on_is_registered(unregistered, kept):
    assert listeners() == {} and staleness.reasons_by_type == {} and not updates.count() and not rig._watched
    assert not handlers._uids and not handlers._evaluated_collections
    unregistered.register()
    found = listeners()
    assert staleness.reasons_by_type.keys() == {"EMPTY", "ARMATURE"}
    assert staleness.reasons_by_type["EMPTY"] is assembly.stale_reason
    kept("listeners.txt", "\n".join("{:s}: {:s}".format(name, ", ".join(told)) for name, told in found.items()))
    handlers.subscribe(handlers.on_update, live._note_updates)
    handlers.subscribe(handlers.on_update, rig._note_updates)
    handlers._uids["gone"] = 1
    unregistered.unregister()
    assert listeners() == {} and not handlers._uids
