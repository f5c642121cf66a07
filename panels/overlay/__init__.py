# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The overlay of the 3D Viewport: centers of mass, principal axes and other optional marks.

Nothing is measured here: everything drawn comes from `blender/session/`. In background mode nothing
is registered.
"""

from ...core.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
