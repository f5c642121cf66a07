# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What every class that is registered declares: operators, settings, preferences, panels, menus. Kept as text.

"""

import sys
from collections import defaultdict
from importlib import import_module

import bpy
import pytest
from body_moments.operators import PARTS
from body_moments.panels import MODULES

from tests.blender import declared

pytestmark = pytest.mark.usefixtures("registered")
ADDON = "body_moments."
PLACES = [*("operators." + part for part in PARTS), *("panels." + name for name in MODULES)]
PLACES += ["operators.settings.preferences", "operators.settings.overlay"]


def by_module():
    """The classes that have something of each module: those in it, and those that take a property or a base with
    properties from it."""
    found = defaultdict(dict)
    modules = [import_module(ADDON + place) for place in PLACES]
    properties = {
        id(value): name
        for name, module in sorted(sys.modules.items())
        if name.startswith(ADDON)
        for value in vars(module).values()
        if hasattr(value, "keywords")
    }
    for module in modules:
        for cls in vars(module).values():
            if isinstance(cls, type) and issubclass(cls, bpy.types.bpy_struct) and cls.__module__ == module.__name__:
                places = {base.__module__ for base in cls.__mro__ if base is cls or any(declared.properties(base))}
                places |= {properties.get(id(prop), "") for _, prop in declared.properties(cls)}
                for place in places:
                    if place.startswith(ADDON):
                        found[place.replace(".", "/") + ".py"][cls.__name__] = cls
    return found


CLASSES = by_module()


@pytest.mark.parametrize("path", sorted(CLASSES))
def test_the_classes_of_a_module_declare_what_is_kept(path, kept):
    classes = CLASSES[path]
    lines = [line for name in sorted(classes) for line in declared.declaration(classes[name])]
    kept("declared/{:s}.txt".format(path.partition("/")[2][:-3].replace("/", ".")), "\n".join(lines))


def test_no_registered_class_is_left_out():
    known = {cls for classes in CLASSES.values() for cls in classes.values()}
    missing, kinds = set(), [bpy.types.bpy_struct]
    for kind in kinds:
        kinds += kind.__subclasses__()
        if kind.__module__.startswith(ADDON) and sys.modules[kind.__module__].__dict__.get(kind.__name__) is kind:
            missing |= {kind} - known if getattr(kind, "is_registered", False) else set()
    assert not missing


def test_types_of_blender_have_the_properties_that_are_kept(kept):
    kept("declared/pointers.txt", "\n".join(declared.pointers()))
