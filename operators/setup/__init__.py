# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Setup of a scene: presets, rigid bodies, colliders, the remedies beside warnings."""
