# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn over the 3D Viewport: centers of mass, principal axes and what else is switched on.

Nothing is measured here: everything drawn comes from `blender/session/`. In background mode nothing is registered.
"""
