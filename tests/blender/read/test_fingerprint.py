# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What numbers are known to be of: each thing that they depend on makes another text, and nothing else does."""

import numpy as np
import pytest
from body_moments.blender.read import fingerprint

pytestmark = pytest.mark.usefixtures("scene")


GEOMETRY, SETTINGS, OTHER_SETTINGS = "50d4ad0b3a2b", "ed2979b47ccf", "479050371f99"  # BLAKE2s, six bytes
USED = {
    "kind": "SOLID",
    "density": 1000.0,
    "mass": None,
    "thickness": 0.0123456,
    "overlap": "SIGNED",
    "unit_scale": 1.0,
}


def settings(**changes):
    return fingerprint.effective_hash(**{**USED, **changes})


def test_settings_that_a_kind_has_no_use_for_do_not_count():
    for kind, same, other in (
        ("SOLID", ({"thickness": 5.0}, {"wall": "INWARD"}), ({"overlap": "UNION"},)),
        ("SHELL", ({"overlap": "UNION"}, {"wall": "THIN"}), ({"thickness": 5.0}, {"wall": "INWARD"})),
        ("WIRE", ({"thickness": 5.0}, {"overlap": "UNION"}, {"wall": "INWARD"}), ()),
    ):
        known = settings(kind=kind)
        assert all(settings(kind=kind, **change) == known for change in same)
        other = [*other, {"density": 1001.0}, {"mass": 1.0}, {"density": None}, {"unit_scale": 2.0}, {"varying": "a"}]
        found = [settings(kind=kind, **change) for change in other]
        assert len({known, *found}) == len(found) + 1
        varying = settings(kind=kind, varying="a")
        assert varying == settings(kind=kind, varying="a", density=5.0) != settings(kind=kind, varying="b")
    assert len({settings(kind=kind) for kind in ("SOLID", "SHELL", "WIRE")}) == 3


def test_fingerprint_of_saved_files_is_unchanged():
    assert fingerprint.fingerprint(b"geometry", "matrix", "settings") == "v1:{}:matrix:settings".format(GEOMETRY)
    assert fingerprint.digest(np.frombuffer(b"geometry", np.uint8)) == GEOMETRY
    assert settings() == SETTINGS and settings(kind="SHELL", wall="INWARD", varying="a") == OTHER_SETTINGS
