# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender out: what a measurement becomes. Properties on objects, records for pipelines, reports
for people.
"""
