# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Setup of a scene: presets, rigid bodies, a node group, the remedies beside warnings."""
