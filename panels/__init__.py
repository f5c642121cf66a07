# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the 3D Viewport's sidebar, the same in the object's properties, and the menus
that they open.

They show what is stored or cached and compute nothing.
"""

from contextlib import ExitStack
from importlib import import_module
from types import ModuleType

from ..operators import register_module, unregister_module

# Each with `register` or with CLASSES. A sub-panel comes after the panel that it is a part of.
MODULES = (
    *("manual", "menus"),
    *("material_menus", "body"),
    *(
        "inertia",
        "reference",  # of the inertia
        "density",
        "given",
        "apply",
        "stability",
        "selection",
        "assembly",
        "bones",
        "advanced",
    ),  # sub-panels; their order is `places.ORDER`
    *("moments", "section", "shape"),  # sub-panels of the advanced one
    *("overlay.popover", "overlay.draw"),
)


def _modules() -> list[ModuleType]:
    return [import_module("." + name, __name__) for name in MODULES]


def register() -> None:
    """Register every module; where one fails, remove the others and let the error rise."""
    with ExitStack() as undo:
        for module in _modules():
            register_module(module)
            undo.callback(unregister_module, module)
        undo.pop_all()


def unregister() -> None:
    """Remove everything that `register` added, in reverse."""
    for module in reversed(_modules()):
        unregister_module(module)
