# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Body Moments: exact mass properties of objects, and snapping to them.

This file registers the add-on, and offers the public names of `core`
(`body_moments.mass_properties`), which are imported when they are first used. Blender is imported
inside `register`, so that the core works without Blender.
"""

from contextlib import ExitStack
from importlib import import_module
from typing import Any


def __getattr__(name: str) -> Any:
    """Return `describe`, which needs Blender, or a public name of the core."""
    if name == "describe":
        return import_module(__name__ + ".blender.session.describe").describe
    is_alone = (
        "__path__" not in globals()
    )  # pytest loads this file alone if the folder's name is no identifier
    core = None if name.startswith("_") or is_alone else import_module(__name__ + ".core")
    if core is None or name not in core.__all__:
        raise AttributeError("module {!r} has no attribute {!r}".format(__name__, name))
    return getattr(core, name)


def __dir__() -> list[str]:
    """Return the public names of the package."""
    return [
        *import_module(__name__ + ".core").__all__,
        "core",
        "describe",
        "register",
        "unregister",
    ]


def register() -> None:
    """Register every class, property and command; if one part fails, undo the others and raise."""
    from . import blender, operators, panels
    from .blender.registration import register_modules, unregister_modules

    with ExitStack() as undo:
        for wing in (blender, operators, panels):
            register_modules(wing.__name__, wing.MODULES)
            undo.callback(unregister_modules, wing.__name__, wing.MODULES)
        undo.pop_all()


def unregister() -> None:
    """Remove everything that `register` added, in reverse."""
    from . import blender, operators, panels
    from .blender.registration import unregister_modules

    for wing in (panels, operators, blender):
        unregister_modules(wing.__name__, wing.MODULES)
