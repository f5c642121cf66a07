# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The headers of NumPy's arrays, of each version of the format: how long they may be, and that no
more is read.
"""

import io

import numpy as np
import pytest
from body_moments.core.scans.formats import read_scan
from body_moments.core.verdict import FileError

from tests.core.scan_files import npz, written

VALUES = np.arange(60, dtype="u2").reshape(3, 4, 5)
LENGTH_BYTES = {1: 2, 2: 4, 3: 4}


def array(version: int, length: int | None = None) -> bytes:
    """Return an array file with a header of this many bytes, or of the needed length."""
    stream = io.BytesIO()
    np.lib.format.write_array(stream, VALUES, (version, 0))
    data = stream.getvalue()
    if length is None:
        return data
    size = LENGTH_BYTES[version]
    header, values = data[8 + size : -VALUES.nbytes], data[-VALUES.nbytes :]
    return (
        data[:8]
        + length.to_bytes(size, "little")
        + header.rstrip().ljust(length - 1)
        + b"\n"
        + values
    )


@pytest.mark.filterwarnings("ignore:Stored array in format")
@pytest.mark.parametrize("form", ["npy", "npz"])
@pytest.mark.parametrize("version", LENGTH_BYTES)
def test_arrays_of_each_version_are_read(tmp_path, version, form):
    for length in (None, 256, 9_984):
        data = array(version, length)
        path = written(tmp_path / ("a." + form), data if form == "npy" else npz({"density": data}))
        assert np.array_equal(read_scan(path).samples, VALUES)


@pytest.mark.filterwarnings("ignore:Stored array in format")
@pytest.mark.parametrize("form", ["npy", "npz"])
@pytest.mark.parametrize(
    "version, length, is_asked",
    [
        (1, 10_000, True),
        (1, 10_001, False),
        (1, 65_280, False),
        (2, 10_000, True),
        (2, 10_001, False),
        (2, 1 << 16, False),
        (2, 1 << 24, False),
        (3, 10_001, False),
    ],
)
def test_header_beyond_ten_thousand_bytes_is_refused_unread(
    tmp_path, monkeypatch, form, version, length, is_asked
):
    """NumPy reads all of it first."""
    asked = []
    for name in ("open_memmap", "read_array_header_1_0", "read_array_header_2_0"):
        plain = getattr(np.lib.format, name)
        monkeypatch.setattr(
            np.lib.format,
            name,
            lambda *words, of=plain, **more: asked.append(0) or of(*words, **more),
        )
    data = array(version, length)
    path = written(tmp_path / ("a." + form), data if form == "npy" else npz({"density": data}))
    if is_asked:
        assert np.array_equal(read_scan(path).samples, VALUES)
    else:
        with pytest.raises(FileError) as refusal:
            read_scan(path)
        assert refusal.value.finding.code == "file_damaged"
    assert bool(asked) == is_asked
