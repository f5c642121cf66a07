# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Registering adds everything, unregistering removes it all, a failure leaves nothing."""

import sys
from collections import Counter

import bpy
import pytest

body_moments = sys.modules["body_moments"]


def footprint() -> dict[str, set | Counter]:
    """Everything that an add-on can leave in Blender and that Blender lets us list, and how
    often.
    """
    types = {
        name: kind for name in dir(bpy.types) if isinstance(kind := getattr(bpy.types, name), type)
    }
    properties, menus = set(), Counter()
    for type_name, kind in types.items():
        if rna := getattr(kind, "bl_rna", None):
            properties |= {(type_name, key) for key in rna.properties.keys()}  # noqa: SIM118
        for function in getattr(getattr(kind, "draw", None), "_draw_funcs", ()):
            menus[type_name, f"{function.__module__}.{function.__qualname__}"] += 1
    handlers = Counter(
        (name, function.__module__, function.__qualname__)
        for name in dir(bpy.app.handlers)
        if isinstance(functions := getattr(bpy.app.handlers, name), list)
        for function in functions
    )
    keymaps = Counter(
        (keymap.name, item.idname)
        for config in bpy.context.window_manager.keyconfigs
        for keymap in config.keymaps
        for item in keymap.keymap_items
    )
    return {
        "types": set(types),
        "classes": {f"{kind.__module__}.{name}" for name, kind in types.items()},
        "properties": properties,
        "menus": menus,
        "handlers": handlers,
        "keymaps": keymaps,
    }


def ours(before: dict[str, set | Counter]) -> set:
    return footprint()["types"] - before["types"]


@pytest.fixture
def before(unregistered):
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    return footprint()


def test_unregistering_removes_everything_and_can_be_repeated(before):
    body_moments.register()
    first = footprint()
    body_moments.unregister()
    assert footprint() == before
    body_moments.register()
    assert footprint() == first
    body_moments.unregister()
    assert footprint() == before


def test_a_failure_half_way_rises_and_leaves_nothing_registered(before, monkeypatch):
    from body_moments.panels import menus

    def fail():
        raise RuntimeError("no panels today")

    monkeypatch.setattr(menus, "register", fail)
    with pytest.raises(RuntimeError, match="no panels today"):
        body_moments.register()
    assert footprint() == before


def test_every_operator_has_a_description(before):
    body_moments.register()
    try:
        operators = [
            getattr(bpy.types, name)
            for name in ours(before)
            if issubclass(getattr(bpy.types, name), bpy.types.Operator)
        ]
        assert operators
        for operator in operators:
            assert "body_moments" in operator.bl_idname
            assert operator.bl_label
            tooltip = getattr(operator, "bl_description", "") or operator.__doc__
            assert tooltip, operator.bl_idname
            assert not tooltip.endswith("."), operator.bl_idname
            assert "\n" not in tooltip, operator.bl_idname  # Blender breaks the line there
    finally:
        body_moments.unregister()


def test_every_property_has_a_description(before):
    body_moments.register()
    try:
        for name in ours(before):
            kind = getattr(bpy.types, name)
            if issubclass(kind, bpy.types.Operator):
                module, _, function = kind.bl_idname.partition(".")
                rna = getattr(getattr(bpy.ops, module), function).get_rna_type()
            elif issubclass(kind, bpy.types.PropertyGroup):
                rna = kind.bl_rna
            else:
                continue
            for key in [each for each in kind.__annotations__ if not each.startswith("_")]:
                property = rna.properties[key]
                assert property.description or property.is_hidden, f"{name}.{key}"
    finally:
        body_moments.unregister()
