# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Change tracking: handlers, caches, and the comparison of stored results with the present
scene.
"""
