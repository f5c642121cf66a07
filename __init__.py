# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Body Moments: exact mass properties of objects, and snapping to them.

This file registers the add-on and does nothing else. Blender is imported inside `register`, so that
`body_moments.core` can be imported, tested and used without Blender.
"""

from contextlib import ExitStack


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
