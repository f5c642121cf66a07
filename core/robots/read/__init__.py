# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robot descriptions as arrays: URDF, SDF, MJCF and USD, and the meshes that they name.

These files come from anywhere. No entities, no network, no path outside of given folders, and limits on everything.
"""

from ...lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
