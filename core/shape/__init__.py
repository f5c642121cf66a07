# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a shape is apart from where it stands: symmetry, signature, registration, libraries of shapes."""
