# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat bodies: regions of a plane, their Fourier transforms and shapes."""
