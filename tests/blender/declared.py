# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What registered classes declare, as lines of text: names, ranges, defaults, choices, and what a change calls."""

import sys
from contextlib import suppress

import bpy
from bl_ui.utils import PresetPanel

MAX_CHOICES = 16  # of a setting that are named


def declaration(cls):
    """Its own attributes that Blender reads, and its properties."""
    yield cls.__name__
    names = {name for base in cls.__mro__ if base.__module__ != "bpy_types" for name in vars(base)}
    if issubclass(cls, PresetPanel):
        names.discard("bl_label")  # Blender writes the preset's name there
    for name in sorted(name for name in names if name.startswith(("bl_", "preset_")) and not name.startswith("bl_rna")):
        yield "    {:s} = {:s}".format(name, shown(getattr(cls, name)))
    for name, prop in properties(cls):
        yield "    {:s}: {:s}".format(name, prop.function.__name__)
        for key, value in prop.keywords.items():
            if key == "description":
                yield "        described" if value else "        not described"
            elif key == "items" and not callable(value):
                yield from ("        {:s}: {:s}. {:s}".format(*item[:3]) for item in list(value)[:MAX_CHOICES])
            elif key != "attr":  # Blender's own
                yield "        {:s} = {:s}".format(key, shown(value))


def properties(cls):
    for base in reversed(cls.__mro__):
        for name, prop in vars(base).get("__annotations__", {}).items():
            if isinstance(prop, str):
                with suppress(NameError):  # a type of which only type checkers know
                    prop = eval(prop, vars(sys.modules[base.__module__]))
            if hasattr(prop, "keywords"):
                yield name, prop


def shown(value):
    if callable(value):
        return value.__name__
    if isinstance(value, set):
        return "{{{:s}}}".format(", ".join(sorted(value)))
    return repr(value)


def pointers():
    """Which of Blender's types have properties of the add-on's own types."""
    for owner in sorted(bpy.types.ID.__subclasses__() + [bpy.types.PoseBone], key=lambda cls: cls.__name__):
        for prop in owner.bl_rna.properties:
            if prop.identifier.startswith("body_moments"):
                told = ["described"] * bool(prop.description) + ["not saved"] * prop.is_skip_save
                place = "{:s}.{:s}".format(owner.__name__, prop.identifier)
                yield " ".join([place + ":", prop.type, prop.name, *told])
