# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the 3D Viewport's sidebar, the same in the object's properties, and the menus
that they open.

They show what is stored or cached and compute nothing.
"""

from contextlib import ExitStack
from importlib import import_module

# Each with CLASSES. A sub-panel comes after the panel that it is a part of.
MODULES = (
    *("material_menus", "body"),
    *(
        "inertia",
        "density",
        "given",
        "apply",
        "selection",
        "assembly",
        "advanced",
    ),  # sub-panels; their order is `places.ORDER`
    *("moments", "section", "shape"),  # sub-panels of the advanced one
)


def _classes() -> list[type]:
    return [cls for name in MODULES for cls in import_module("." + name, __name__).CLASSES]


def register() -> None:
    """Register every class; where one fails, remove the others and let the error rise."""
    import bpy

    with ExitStack() as undo:
        for cls in _classes():
            bpy.utils.register_class(cls)
            undo.callback(bpy.utils.unregister_class, cls)
        undo.pop_all()


def unregister() -> None:
    """Remove everything that `register` added, in reverse."""
    import bpy

    for cls in reversed(_classes()):
        bpy.utils.unregister_class(cls)
