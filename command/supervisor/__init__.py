# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A pool of Blender processes, each of which measures one file at a time, and a journal of their
answers.

Standard library only, no Blender, no numpy: the process that reports never opens a user's file, and
nothing that such a file does to a child can end it. This is the one part of the add-on that starts
processes, and it starts nothing but Blender itself (or the Python that has it as a module) with the
add-on's own `operators/batch.py`.
"""

from ...core.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    Journal="journal",
    WholeRun="processes",
    expand="listing",
)
