# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Of the letters and digits of two fonts, moved, turned, scaled, of another resolution and noisy,
each is found again.

`python3 tests/project.py soak letters` tries more of them, and noise of 0.1 %.
"""

import numpy as np
import pytest

from tools.soak import letters

pytestmark = pytest.mark.usefixtures("scene")


def test_noisy_letters_of_two_fonts_are_found_again():
    known, classes = letters.library()
    assert {pair for pair in classes.items() if pair[0] != pair[1]} == {("Bfont 1", "Bfont I")}
    lost = list(letters.missed(known, classes, 1e-4, np.random.default_rng(0)))
    assert len(lost) <= 0.01 * len(known), lost
