# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Formulas as the papers print them, one module a paper: the tests hold the fast ways against these."""
