# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Label maps on the command line: a record for each label, with names, colors and densities."""

import struct
from pathlib import Path

import numpy as np
import pytest

from tests.blender.batch_files import codes
from tests.close import close
from tests.command.running import run
from tests.core.scan_files import nifti, nrrd, written

pytestmark = pytest.mark.usefixtures("scene")
BOX = np.array([20 * 20 * 6, 15 * 20 * 6]) * 0.4 * 0.4 * 3e-9


def labels(dtype="i2"):
    values = np.zeros((60, 60, 20), dtype)
    values[10:30, 10:30, 4:10] = 1
    values[35:50, 20:40, 10:16] = 2
    return values


def save(tmp_path, values):
    np.save(tmp_path / "map.npy", values)
    return [tmp_path / "map.npy", "--spacing", "0.4,0.4,3", "--unit-scale", "0.001"]


@pytest.mark.parametrize("dtype", ["u1", "f4"])
def test_each_label_has_exact_volume_and_center(tmp_path, dtype):
    code, document = run(tmp_path, *save(tmp_path, labels(dtype)), "--label", "all")
    assert code == 0
    found = document["objects"]
    assert [entry["name"] for entry in found] == ["map 1", "map 2"]
    assert [entry["label"] for entry in found] == [
        {"value": 1, "voxels": 2400},
        {"value": 2, "voxels": 1800},
    ]
    assert close([entry["volume"] for entry in found], BOX, 1e-14)
    assert close(found[0]["center_of_mass"], [0.0078, 0.0078, 0.0195], 1e-14)
    assert "density_defaulted" in codes(document["total"])
    sides = np.array([20 * 0.4, 20 * 0.4, 18.0]) * 1e-3
    second = found[0]["mass"] * sides**2 / 12.0
    assert close(np.diag(found[0]["inertia"]), second.sum() - second, 1e-13)


def test_table_gives_names_and_densities(tmp_path):
    table = tmp_path / "tissue.csv"
    table.write_text("label;name;density;r;g;b\n1;Liver;1060;255;0;51\n2;Fat;;0;0;0\n")
    options = ["--label", "all", "--label-table", table, "--density", "900"]
    code, document = run(tmp_path, *save(tmp_path, labels()), *options)
    assert code == 0
    fat, liver = document["objects"]
    assert (liver["name"], fat["name"]) == ("Liver", "Fat")
    assert close([liver["mass"], fat["mass"]], BOX * [1060.0, 900.0], 1e-14)
    assert close(liver["label"]["color"], [1.0, 0.0, 0.2], 1e-15)
    assert close(document["total"]["mass"], liver["mass"] + fat["mass"], 1e-15)


@pytest.mark.parametrize(
    "text",
    [
        '# ITK-SNAP\n0 0 0 0 0 0 0 "Clear Label"\n1 255 0 0 1 1 1 "My Liver"\n',
        "#No. Label Name: R G B A\n0 Unknown 0 0 0 0\n1   My Liver   255 0 0 0\n",
    ],
)
def test_text_tables_name_labels(tmp_path, text):
    (tmp_path / "lut.txt").write_text(text)
    options = ["--label", "1", "--label-table", tmp_path / "lut.txt", "--density", "1"]
    code, document = run(tmp_path, *save(tmp_path, labels()), *options)
    assert code == 0
    (entry,) = document["objects"]
    assert entry["name"] == "My Liver" and entry["label"]["color"] == [1.0, 0.0, 0.0]


@pytest.mark.parametrize("color", [[0.5, 0.25, 1.0], None])
def test_header_of_nrrd_names_and_colors_segments(tmp_path, color):
    text = "Segment0_Color:={} 0.25 1".format("nan" if color is None else 0.5)
    lines = "Segment0_LabelValue:=2", "Segment0_Name:=Spleen", text
    path = written(tmp_path / "map.nrrd", nrrd(labels(), "spacings: 1 1 1", *lines))
    _, document = run(tmp_path, path, "--label", "2")
    (entry,) = document["objects"]
    assert entry["name"] == "Spleen" and entry["label"].get("color") == color


def test_extension_of_nifti_names_labels(tmp_path):
    xml = (
        b'<CaretExtension><VolumeInformation Index="0"><LabelTable><Label Key="2" Red="0.5" '
        b'Green="0" Blue="1" Alpha="1">\n<![CDATA[Spleen]]>\n</Label></LabelTable>'
        b"</VolumeInformation></CaretExtension>"
    )
    xml += b"\0" * (-(len(xml) + 8) % 16)
    plain = bytearray(nifti(labels()))
    start = int(struct.unpack_from("<f", plain, 108)[0])
    struct.pack_into("<f", plain, 108, start + 8 + len(xml))
    plain[348:352] = b"\1\0\0\0"
    plain[352:start] = b""
    plain[352:352] = struct.pack("<ii", 8 + len(xml), 0) + xml
    _, document = run(tmp_path, written(tmp_path / "map.nii", bytes(plain)), "--label", "2")
    (entry,) = document["objects"]
    assert entry["name"] == "Spleen" and entry["label"]["color"] == [0.5, 0.0, 1.0]


@pytest.mark.parametrize(
    ("options", "table", "part"),
    [
        (["--label", "7"], None, "no label 7; it has 0, 1, 2"),
        (["--label", "all"], "label,name\n1,Liver\n", "no label 2; it has 1"),
        (["--label", "all"], "Liver,Fat\n", "Line 1"),
        (["--label", "all"], "label,name\n1,Liver\n1,Fat\n", "a label that no line before it has"),
        (["--label", "all", "--label-table", "none.csv"], None, "No such file"),
        (["--label", "all"], "label,density\n1,heavy\n2,5\n", "Line 2"),
        (["--label", "all"], "label,name\n1,{}\n".format("x" * 200_000), "Line 2"),
        (["--label", "all"], "label,name,{}\n1,a,b\n".format("x" * 200_000), "Line 1"),
        (["--label", "all"], "label,name,r,g,b\n1,a,nan,1,1\n", "Line 2"),
    ],
)
def test_labels_and_tables_that_do_not_fit_are_refused(tmp_path, options, table, part):
    if table is not None:
        (tmp_path / "table.csv").write_text(table)
        options = [*options, "--label-table", tmp_path / "table.csv"]
    code, document = run(tmp_path, *save(tmp_path, labels()), *options)
    assert code == 1 and document["objects"] == []
    (error,) = document["errors"]
    assert part in error["reason"]
    if "no label" not in part:  # such a sentence has the name
        assert error["name"] == Path(options[-1]).name


def test_threshold_on_labels_names_label_option(tmp_path):
    _, document = run(tmp_path, *save(tmp_path, labels()), "--threshold", "2")
    (entry,) = document["objects"]
    assert any("--label" in text for text in entry["warnings"])
