# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Registration of the modules of a subpackage, such as `operators`.

The classes that a module defines are registered in their order, then those that it makes, its
CLASSES. The idname of an operator follows from the name of its class, its tooltip is the docstring,
and it can be undone unless its `bl_options` say otherwise. Further tables are POINTERS, groups of
settings by Blender's type and the name of their property, and MENUS, Blender's menus with functions
that draw in them. The rest is done by functions `register`, which follows the tables, and
`unregister`, which precedes them.
"""

from collections.abc import Iterable
from contextlib import ExitStack
from importlib import import_module
from types import ModuleType

import bpy
from bpy.props import PointerProperty
from bpy.types import Operator, bpy_struct


def register_modules(package: str, names: Iterable[str]) -> None:
    """Register the modules in order; if one fails, unregister the modules before it and raise its
    error.
    """
    with ExitStack() as undo:
        for name in names:
            module = import_module("." + name, package)
            _register(module)
            undo.callback(_unregister, module)
        undo.pop_all()


def unregister_modules(package: str, names: Iterable[str]) -> None:
    """Unregister the modules, in reverse order."""
    for name in reversed([*names]):
        _unregister(import_module("." + name, package))


def classes_of(module: ModuleType) -> list[type]:
    """Return the classes that a module registers, in their order."""
    defined = [
        value
        for value in vars(module).values()
        if isinstance(value, type)
        and issubclass(value, bpy_struct)
        and value.__module__ == module.__name__
    ]
    return list(dict.fromkeys((*defined, *getattr(module, "CLASSES", ()))))


def _register(module: ModuleType) -> None:
    with ExitStack() as undo:
        for cls in classes_of(module):
            if issubclass(cls, Operator) and "bl_idname" not in vars(cls):
                category, name = cls.__name__.split("_OT_")
                cls.bl_idname = "{:s}.{:s}".format(category.lower(), name)
                cls.bl_description = " ".join((cls.__doc__ or "").split())
                if not hasattr(cls, "bl_options"):
                    cls.bl_options = {"REGISTER", "UNDO"}
            bpy.utils.register_class(cls)
            undo.callback(bpy.utils.unregister_class, cls)
        for (owner, name), group in getattr(module, "POINTERS", {}).items():
            setattr(owner, name, PointerProperty(name=name.replace("_", " ").title(), type=group))
            undo.callback(delattr, owner, name)
        for menu, draw in getattr(module, "MENUS", ()):
            menu.append(draw)
            undo.callback(menu.remove, draw)
        if hasattr(module, "register"):
            module.register()
        undo.pop_all()


def _unregister(module: ModuleType) -> None:
    if hasattr(module, "unregister"):
        module.unregister()
    for menu, draw in getattr(module, "MENUS", ()):
        menu.remove(draw)
    for owner, name in getattr(module, "POINTERS", {}):
        delattr(owner, name)
    for cls in reversed(classes_of(module)):
        bpy.utils.unregister_class(cls)
