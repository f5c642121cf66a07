# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What numbers are known to be of: each thing that they depend on makes another text, and nothing
else does.
"""

import numpy as np
import pytest
from body_moments.core.measurement import settings as fingerprints

pytestmark = pytest.mark.usefixtures("scene")


GEOMETRY = "50d4ad0b3a2b"  # BLAKE2s, six bytes


def test_fingerprint_of_saved_files_is_unchanged():
    assert fingerprints.fingerprint(
        b"geometry", "matrix", "settings"
    ) == "v1:{}:matrix:settings".format(GEOMETRY)
    assert fingerprints.digest(np.frombuffer(b"geometry", np.uint8)) == GEOMETRY
