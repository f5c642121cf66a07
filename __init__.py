# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Body Moments: exact mass properties of objects, and snapping to them.

This file registers the add-on and does nothing else. Blender is imported inside `register`,
so that `body_moments.core` can be imported, tested and used where there is no Blender.
"""

from contextlib import ExitStack


def register() -> None:
    """Register every class, property and command; if one part fails, undo the others and raise."""
    from . import operators, panels

    with ExitStack() as undo:
        for part in (operators, panels):
            part.register()
            undo.callback(part.unregister)
        undo.pop_all()


def unregister() -> None:
    """Remove everything that `register` added, in reverse."""
    from . import operators, panels

    for part in (panels, operators):
        part.unregister()
