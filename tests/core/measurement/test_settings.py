# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The digest of settings: each setting that the numbers depend on changes it, and nothing else
does.
"""

from body_moments.core.measurement.settings import Settings

USED = {
    "kind": "solid",
    "density": 1000.0,
    "mass": None,
    "thickness": 0.0123456,
    "overlap": "signed",
    "unit": 1.0,
}


def digest(**changes):
    return Settings(**{**USED, **changes}).digest


def test_unused_settings_of_a_kind_do_not_count():
    for kind, same, other in (
        ("solid", ({"thickness": 5.0}, {"wall": "inward"}), ({"overlap": "union"},)),
        (
            "shell",
            ({"overlap": "union"}, {"wall": "thin"}),
            ({"thickness": 5.0}, {"wall": "inward"}),
        ),
        ("wire", ({"thickness": 5.0}, {"overlap": "union"}, {"wall": "inward"}), ()),
    ):
        known = digest(kind=kind)
        assert all(digest(kind=kind, **change) == known for change in same)
        other = [
            *other,
            {"density": 1001.0},
            {"mass": 1.0},
            {"density": None},
            {"unit": 2.0},
            {"varying": "a"},
        ]
        found = [digest(kind=kind, **change) for change in other]
        assert len({known, *found}) == len(found) + 1
        varying = digest(kind=kind, varying="a")
        assert (
            varying == digest(kind=kind, varying="a", density=5.0) != digest(kind=kind, varying="b")
        )
    assert len({digest(kind=kind) for kind in ("solid", "shell", "wire")}) == 3


def test_digest_of_saved_files_is_unchanged():
    assert digest() == "ed2979b47ccf"
    assert digest(kind="shell", wall="inward", varying="a") == "479050371f99"
