# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that a batch finds in folders."""

import os

import pytest
from body_moments.command.supervisor.listing import expand

FILES = (
    "a.stl",
    "b.NRRD",
    "c_2x3x4_uint8.raw",
    "d.nii.gz",
    "e.body_moments.blend.blend",
    "f/g.blend",
    "f/h/i.iges",
)
OTHERS = "a.txt", "b", "c.raw", "d.gz", "e.body_moments.blend", ".f.stl", ".g/h.stl", "f/stl"


def test_folders_list_their_measurable_files(tmp_path):
    for name in (*FILES, *OTHERS):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(b"")
    if os.name == "posix":
        (tmp_path / "f" / "around").symlink_to(tmp_path)
    found = [
        os.path.relpath(path, tmp_path).replace(os.sep, "/") for path in expand([str(tmp_path)])
    ]
    assert found == list(FILES)
    assert [*expand([str(tmp_path / "a.txt"), "nowhere"])] == [str(tmp_path / "a.txt"), "nowhere"]


@pytest.mark.parametrize("others", [(), OTHERS[:3]])
def test_a_folder_with_nothing_to_measure_is_refused(tmp_path, others):
    for name in others:
        (tmp_path / name).write_bytes(b"")
    with pytest.raises(OSError):
        [*expand([str(tmp_path)])]
