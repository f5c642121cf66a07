# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robot descriptions as arrays: URDF, SDF, MJCF and USD, and the meshes that they name.

These files are untrusted: entities, networks and paths outside of given folders are refused, and
all sizes limited.
"""

from ...lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
