# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Found by every Python that a test starts while lines are noted."""

import os
import sys

if "BODY_MOMENTS_LINES" in os.environ and hasattr(sys, "monitoring"):
    import lines

    lines.start_child()
