# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Registration of the modules of a subpackage, such as `operators`.

A module has tables: CLASSES in the order of registration; POINTERS, groups of settings by Blender's
type and the name of their property; MENUS, Blender's menus with functions that draw in them. The
rest is done by functions `register`, which follows the tables, and `unregister`, which precedes
them.
"""

from collections.abc import Iterable
from contextlib import ExitStack
from importlib import import_module
from types import ModuleType

import bpy
from bpy.props import PointerProperty


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


def _register(module: ModuleType) -> None:
    with ExitStack() as undo:
        for cls in getattr(module, "CLASSES", ()):
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
    for cls in reversed(getattr(module, "CLASSES", ())):
        bpy.utils.unregister_class(cls)
