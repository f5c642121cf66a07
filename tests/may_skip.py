# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The reasons for which a test may be skipped where CI is set; any other skip fails there."""

import os
import re

REASONS = {
    "no Chromium": "the report is read as text all the same",
    "no GNU parallel": "an engine of others",
    "no libsdformat": "SDF is held against a restated schema all the same",
    "no Slurm": "its tasks are run as it would run them",
    "no Node": "runs the job type of Flamenco with stubs",
    "could not import 'bornagain'": "compared with where Blender 5.2 is; its wheels are for few systems",
    "comprehensions are calls of their own": "Python 3.11 counts more calls than the ones that are limited",
    "not on this system": "Windows has no such devices, signals, owners or links",
    "Dynamic topology cannot be turned on without a window": "the window tests see it there",
}
if os.environ.get("WITHOUT_BLENDER"):  # set by .ci/run where no real Blender can be had
    REASONS["no real Blender"] = "the modules of Blender are tested all the same"


def allowed(reason: str) -> bool:
    return any(re.search(re.escape(start), reason) for start in REASONS)
