# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robots as text: one module a format, each from `core/robots/model.py:Robot` alone."""
