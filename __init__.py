# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Body Moments: exact mass properties of objects, and snapping to them.

This file puts the parts together and does nothing else: it hands the core the sentences of its findings, and registers
the add-on. Blender is imported inside `register`, so that `body_moments.core` can be imported, tested and used where
there is no Blender.
"""

from contextlib import ExitStack

from .core.verdict.finding import Finding, use_sentences


def _sentence(finding: Finding) -> str:
    from .core.verdict.messages import sentence

    return sentence(finding)


use_sentences(_sentence)


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
