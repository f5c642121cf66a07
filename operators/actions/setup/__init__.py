# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What sets up a scene: presets, imported scans, assemblies, rigid bodies, the remedies beside warnings."""
