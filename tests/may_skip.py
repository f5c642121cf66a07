# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The beginnings of reasons for which a test may be skipped if CI is set; any other skip fails
there.
"""

MAY_SKIP = {
    "needs BornAgain": "compared with it on Blender 5.2; its wheels are for few systems",
    "needs BODY_MOMENTS_FILM": "it makes a film of the manual; the jump is tested all the same",
    "needs Python 3.12": "Python 3.11 counts more calls than those that are limited",
    "needs Slurm: its controller": "its tasks are run as it would run them",
    "needs a real Blender": "the modules of Blender are tested all the same; hosted runners have "
    "no other",
    "needs a simulator": "hosted runners have MuJoCo in the tests of robots; PyBullet and Newton "
    "compile for minutes",
    "needs a window": "the window tests see it there",
    "needs msgfmt": "gettext's own check of translations; forms, placeholders and texts are tested "
    "all the same",
    "needs libsdformat": "few systems have its release; SDF is held against a restated schema all "
    "the same",
}
