# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scan files of every format, type, byte order and placement, and the refusals of damaged ones."""

import gzip
import itertools
import os
import random
import struct

import numpy as np
import pytest
from body_moments.core.scans import SUFFIXES, Scan, read_raw, read_scan, sample_matrix, scan_suffix
from body_moments.core.verdict import FileError, finding
from body_moments.tests.core.scan_files import (
    NIFTI_CODES,
    NRRD_NAMES,
    nifti,
    npy,
    npz,
    nrrd,
    written,
)

from tests.close import close

MILLIMETERS = 'space units: "mm" "mm" "mm"'


def values(dtype="f4", shape=(3, 4, 5)):
    return np.arange(np.prod(shape)).reshape(shape).astype(dtype)


def refusal(action, *arguments):
    """Return the code of the refusal, after checking its sentence for a remedy or a reason."""
    with pytest.raises(FileError) as caught:
        action(*arguments)
    assert caught.value.reason.endswith(".")
    return caught.value.finding.code


@pytest.mark.parametrize("order", "<>")
@pytest.mark.parametrize("kind", NRRD_NAMES)
@pytest.mark.parametrize("encoding", ["raw", "gzip"])
def test_nrrd_of_every_type(tmp_path, kind, order, encoding):
    expected = values(order + kind)
    scan = read_scan(written(tmp_path / "a.nrrd", nrrd(expected, encoding=encoding)))
    assert np.array_equal(scan.samples, expected)
    assert np.array_equal(scan.matrix, np.eye(4))
    assert not scan.is_placed and scan.unit is None
    assert isinstance(scan.samples, np.memmap) == (encoding == "raw")


@pytest.mark.parametrize(
    "dtype, names",
    {
        "i1": "signed char,int8,int8_t",
        "u1": "uchar,unsigned char,uint8,uint8_t",
        "i2": "short,short int,signed short,signed short int,int16,int16_t",
        "u2": "ushort,unsigned short,unsigned short int,uint16,uint16_t",
        "i4": "int,signed int,int32,int32_t",
        "u4": "uint,unsigned int,uint32,uint32_t",
        "i8": "longlong,long long,long long int,signed long long,signed long long "
        "int,int64,int64_t",
        "u8": "ulonglong,unsigned long long,unsigned long long int,uint64,uint64_t",
        "f4": "float",
        "f8": "double",
    }.items(),
)
def test_nrrd_type_names_are_known_and_need_a_byte_order(tmp_path, dtype, names):
    """All that the format's definition lists."""
    data = nrrd(values()).partition(b"\n\n")[0]
    for name in (names + "," + names.upper()).split(","):
        head = data.replace(b"type: float", b"type: " + name.encode())
        path = written(tmp_path / "a.nrrd", head + b"\n\n" + values(dtype).tobytes("F"))
        assert read_scan(path).samples.dtype == dtype
    path = written(path, head.replace(b"endian: little", b"") + b"\n\n")
    assert refusal(read_scan, path) == ("file_damaged" if dtype[1] == "1" else "header_field")


def test_the_keys_of_a_nrrd_file_and_its_comments_are_no_fields(tmp_path):
    """A field may contain the separator of a key."""
    for line in (
        b"sizes:=9 9 9",
        b"type:= double",
        b"# sizes: 9 9 9",
        b"#sizes: 9 9 9",
        b"sizes 9 9 9",
        b"no:=a: b",
    ):
        data = nrrd(values()).replace(b"encoding: raw", line + b"\nencoding: raw\n" + line)
        assert np.array_equal(read_scan(written(tmp_path / "a.nrrd", data)).samples, values())
    with_both = nrrd(values(), "content: a:=b").replace(b"type: float", b"type: float:=")
    assert refusal(read_scan, written(tmp_path / "a.nrrd", with_both)) == "scan_sample_type"


def test_units_are_in_meters(tmp_path):
    sizes = {
        "m": 1.0,
        "meter": 1.0,
        "meters": 1.0,
        "cm": 1e-2,
        "nm": 1e-9,
        "in": 0.0254,
        "inch": 0.0254,
        "": None,
    }
    sizes["voxel"] = None
    sizes |= dict.fromkeys(("mm", "millimeter", "millimeters", " MM "), 1e-3)
    sizes |= dict.fromkeys(("um", "µm", "micron", "microns"), 1e-6)
    for field in ("space units", "units"):
        for name, unit in sizes.items():
            for code in ("latin-1", "utf-8"):
                line = '{}: "{}" "{}" "{}"'.format(field, *[name] * 3).encode(code)
                data = nrrd(values()).replace(b"# made for a test", line)
                assert read_scan(written(tmp_path / "a.nrrd", data)).unit == unit
    mixed = (
        nrrd(values(), 'space units: "mm" "mm" "" "mm"'),
        nrrd(values(), 'space units: "mm" "mm" "mm" "s"'),
    )
    assert [read_scan(written(tmp_path / "a.nrrd", data)).unit for data in mixed] == [None, 1e-3]
    for code, unit in (
        (0, None),
        (1, 1.0),
        (2, 1e-3),
        (3, 1e-6),
        (8 + 2, 1e-3),
        (24 + 3, 1e-6),
        (4, None),
    ):
        assert read_scan(written(tmp_path / "a.nii", nifti(values(), unit=code))).unit == unit


@pytest.mark.parametrize("order", "<>")
@pytest.mark.parametrize("kind", NIFTI_CODES)
@pytest.mark.parametrize("end", [".nii", ".nii.gz"])
def test_nifti_of_every_type(tmp_path, kind, order, end):
    expected = values(order + kind)
    data = nifti(expected, spacing=(0.5, 0.25, 2))
    scan = read_scan(
        written(tmp_path / ("a" + end), gzip.compress(data) if end == ".nii.gz" else data)
    )
    assert np.array_equal(scan.samples, expected)
    assert np.array_equal(np.diag(scan.matrix), [0.5, 0.25, 2, 1])
    assert scan.is_placed and scan.unit == 1e-3
    assert (scan.slope, scan.intercept) == (1.0, 0.0)


def test_nifti_placement_is_read(tmp_path):
    sform = [[-0.5, -0.25, 0, 9], [0, 2, -0.125, -8], [0, 0, 3, 7]]
    scan = read_scan(
        written(tmp_path / "s.nii", nifti(values(), sform=sform, quaternion=(0, 0, 0, 1, 2, 3)))
    )
    assert np.array_equal(scan.matrix[:3], sform)
    # half a turn about x (a = 0, b = 1), third axis mirrored
    turned = nifti(values(), spacing=(2, 3, 4), quaternion=(1, 0, 0, 5, 6, 7), qfac=-1.0)
    scan = read_scan(written(tmp_path / "q.nii", turned))
    assert np.array_equal(scan.matrix[:3], [[2, 0, 0, 5], [0, -3, 0, 6], [0, 0, 4, 7]])
    # zero stands for 1
    turned = nifti(values(), spacing=(2, 3, 4), quaternion=(1, 0, 0, 5, 6, 7), qfac=0.0)
    assert np.array_equal(read_scan(written(tmp_path / "q.nii", turned)).matrix[2], [0, 0, -4, 7])
    third = (1 / 3) ** 0.5 * np.sin(np.pi / 3)  # a third of a turn about (1, 1, 1): x to y to z
    scan = read_scan(
        written(tmp_path / "t.nii", nifti(values(), quaternion=(third, third, third, 0, 0, 0)))
    )
    assert np.allclose(scan.matrix[:3, :3], [[0, 0, 1], [1, 0, 0], [0, 1, 0]], atol=1e-7)


def test_a_nifti_file_without_any_spacing_is_not_placed(tmp_path):
    scan = read_scan(written(tmp_path / "n.nii", nifti(values(), spacing=(0, 0, 0))))
    assert np.array_equal(scan.matrix, np.eye(4)) and not scan.is_placed
    series = bytearray(nifti(values(), spacing=(0, 0, 0)))
    struct.pack_into("<f", series, 92, 2.5)  # seconds between volumes
    assert not read_scan(written(tmp_path / "n.nii", series)).is_placed
    assert read_scan(written(tmp_path / "s.nii", nifti(values(), spacing=(2, 3, 4)))).is_placed


def test_nifti_scales_and_has_a_fourth_dimension_of_one(tmp_path):
    for dims in (4, 7):
        scan = read_scan(
            written(
                tmp_path / "a.nii", nifti(values("i2"), slope=2.0, intercept=-1024.0, dims=dims)
            )
        )
        assert (scan.slope, scan.intercept) == (2.0, -1024.0)
        assert scan.samples.shape == (3, 4, 5)
    scan = read_scan(written(tmp_path / "a.nii", nifti(values(), slope=0.0, intercept=5.0)))
    assert (scan.slope, scan.intercept) == (1.0, 0.0)
    assert np.array_equal(
        read_scan(written(tmp_path / "a.nii", nifti_with(72, "h", 0))).samples, values()
    )


def test_nrrd_placement_is_read(tmp_path):
    lines = "space: left-posterior-superior", "space directions: (0.5,0,0) (0.25,-2,0) (0,0.125,3)"
    scan = read_scan(
        written(tmp_path / "a.nrrd", nrrd(values(), *lines, "space origin: (-9,8,7)", MILLIMETERS))
    )
    assert np.array_equal(scan.matrix[:3], [[-0.5, -0.25, 0, 9], [0, 2, -0.125, -8], [0, 0, 3, 7]])
    assert scan.is_placed and scan.unit == 1e-3
    for spacings in ("0.5 -2 3", "0.5 -2 3 nan"):
        head = nrrd(values(), "spacings: " + spacings, "axismins: 1 2 3")
        scan = read_scan(written(tmp_path / "b.nrrd", head))
        assert np.array_equal(scan.matrix[:3], [[0.5, 0, 0, 1], [0, -2, 0, 2], [0, 0, 3, 3]])
    head = nrrd(values(), "space directions: (1,0,0) (0,2,0) (0,0,3)", "space origin: none")
    scan = read_scan(written(tmp_path / "c.nrrd", head))
    assert np.array_equal(scan.matrix, np.diag([1, 2, 3, 1])) and scan.is_placed
    head = nrrd(values(), "spacedirections: (1,0,0) (0,2,0) (0,0,3)", "spaceorigin: (4,5,6)")
    scan = read_scan(written(tmp_path / "d.nrrd", head))
    assert np.array_equal(scan.matrix[:3], [[1, 0, 0, 4], [0, 2, 0, 5], [0, 0, 3, 6]])
    assert scan.is_placed


@pytest.mark.parametrize(
    "lines, spacing, origin, unit",
    [
        (
            ("axis mins: 0 0 0", "axis maxs: 3 8 20", "centers: cell cell cell"),
            [1, 2, 4],
            [0.5, 1, 2],
            None,
        ),
        (
            ("axismins: 1 0 0", "axismaxs: 3 6 16", "centerings: node node node"),
            [1, 2, 4],
            [1, 0, 0],
            None,
        ),
        (("axis mins: 0 0 0", "axis maxs: 3 8 20"), [1, 2, 4], [0.5, 1, 2], None),
        (
            ("spacings: 1 nan 4", "axis mins: 0 8 0", "axis maxs: 2 0 20"),
            [1, -2, 4],
            [0, 7, 2],
            None,
        ),
        (
            ("spacings: 1 2 4", "axis mins: 0 0 0", "centers: cell node ???"),
            [1, 2, 4],
            [0.5, 0, 0],
            None,
        ),
        (
            (
                "spacings: 1 2 nan",
                "thicknesses: 9 9 4",
                "centers: cell cell cell",
                "axis mins: 0 0 0",
            ),
        )
        + ([1, 2, 4], [0.5, 1, 2], None),
        (("thicknesses: 1 2 4", 'units: "mm" "mm" "mm"'), [1, 2, 4], [0, 0, 0], 1e-3),
        (
            ("spacings: 1 20 .4", 'units: "mm" "um" "cm"', "axis mins: 5 0 1"),
            [1e-3, 2e-5, 4e-3],
            [5e-3, 0, 0.01],
            1,
        ),
        (("spacings: 1 2 4", "units: mm in mm"), [1e-3, 0.0508, 4e-3], [0, 0, 0], 1),
    ],
)
def test_nrrd_axes_state_spacing_origin_and_unit(tmp_path, lines, spacing, origin, unit):
    scan = read_scan(
        written(tmp_path / "a.nrrd", nrrd(values(), *lines, "kinds: domain Space ???"))
    )
    assert scan.is_placed and scan.unit == unit
    assert np.allclose(scan.matrix[:3], np.c_[np.diag(spacing), origin], rtol=1e-15, atol=0.0)
    findings = sample_matrix(scan, None, None, None)[1]
    assert findings == (
        () if unit else (finding("scan_unstated", part="unit", option="unit-scale"),)
    )


def test_nrrd_space_units_scale_the_coordinates(tmp_path):
    lines = (
        "space directions: (1,0,0) (1,2,0) (0,0,3) none",
        "space origin: (1,2,3)",
        'space units: "m" "mm" "cm"',
    )
    data = nrrd(values(), *lines).replace(
        b"dimension: 3\nsizes: 3 4 5", b"dimension: 4\nsizes: 3 4 5 1"
    )
    scan = read_scan(written(tmp_path / "a.nrrd", data))
    assert close(scan.matrix[:3], [[1, 1, 0, 1], [0, 2e-3, 0, 2e-3], [0, 0, 0.03, 0.03]], 1e-15)
    assert scan.unit == 1.0
    data = data.replace(b"(0,0,3) none", b"none (0,0,3)")
    assert refusal(read_scan, written(tmp_path / "a.nrrd", data)) == "header_field"


@pytest.mark.parametrize(
    "lines, name",
    [
        *(
            (("kinds: {} domain domain".format(kind),), "kinds")
            for kind in ("vector", "3-color", "time", "list", "x")
        ),
        (("kinds: domain domain RGB-color",), "kinds"),
        (("kinds: domain domain",), "kinds"),
        (('units: "mm" "mm" "s"', "spacings: 1 1 1"), "units"),
        (('units: "mm" "furlong" "mm"', "spacings: 1 1 1"), "units"),
        (('space units: "parsec" "parsec" "parsec"',), "space units"),
        (("encoding: hex",), "encoding"),
        (("centers: cell cell corner",), "centers"),
        (("spacings: 1 1 1", "axis mins: 0 0 0", "axis maxs: 3 4 7"), "axis maxs"),
        (("spacings: 1 2 nan", "axis mins: 0 0 0"), "spacings"),
        (("axis mins: 0 0 0", "axis maxs: 3 4 nan"), "spacings"),
        (("space directions: none (1,0,0) (0,1,0)",), "space directions"),
    ],
)
def test_nrrd_axes_that_are_no_places_are_refused(tmp_path, lines, name):
    with pytest.raises(FileError) as caught:
        read_scan(written(tmp_path / "a.nrrd", nrrd(values(), *lines)))
    assert (caught.value.finding.code, caught.value.finding.values["field"]) == (
        "header_field",
        name,
    )


@pytest.mark.parametrize(
    "mins, origin",
    [
        ("1 2 3 nan", [1, 2, 3]),
        ("nan 2 3", [0] * 3),
        ("1 2 inf", [0] * 3),
        ("1 -inf 3", [0] * 3),
        ("1 2", [0] * 3),
    ],
)
def test_nrrd_with_an_incomplete_axis_begins_at_the_origin(tmp_path, mins, origin):
    scan = read_scan(
        written(tmp_path / "a.nrrd", nrrd(values(), "spacings: 0.5 2 3", "axis mins: " + mins))
    )
    assert np.array_equal(
        scan.matrix,
        [[0.5, 0, 0, origin[0]], [0, 2, 0, origin[1]], [0, 0, 3, origin[2]], [0, 0, 0, 1]],
    )


def test_detached_headers_and_skips(tmp_path):
    expected = values("u2")
    data = expected.tobytes(order="F")
    written(tmp_path / "a.raw", b"one\ntwo\n1234" + data)
    head = nrrd(expected, "data file: a.raw", "line skip: 2", "byte skip: 4", head=False)
    assert np.array_equal(read_scan(written(tmp_path / "a.nhdr", head)).samples, expected)
    head = nrrd(expected, "datafile: a.raw", "byteskip: -1", head=False)
    assert np.array_equal(read_scan(written(tmp_path / "b.nhdr", head)).samples, expected)
    packed = written(tmp_path / "a.gz", gzip.compress(b"1234" + data))
    head = nrrd(expected, "data file: " + packed.name, "byte skip: 4", encoding="gzip", head=False)
    assert np.array_equal(read_scan(written(tmp_path / "c.nhdr", head)).samples, expected)


def test_raw_files_by_their_names_and_by_hand(tmp_path):
    expected = values("u2")
    path = written(tmp_path / "head_3x4x5_uint16.raw", expected.tobytes(order="F"))
    assert np.array_equal(read_scan(path).samples, expected)
    path = written(tmp_path / "any.raw", expected.astype(">u2").tobytes(order="F"))
    assert np.array_equal(read_raw(path, (3, 4, 5), "uint16", big_endian=True).samples, expected)
    assert refusal(read_scan, path) == "raw_without_layout"
    assert refusal(read_raw, path, (3, 4, 6), "uint16") == "file_damaged"
    assert refusal(read_raw, path, (3, 4, 5), "complex64") == "scan_sample_type"


@pytest.mark.parametrize("layout", "CF")
def test_numpy_arrays_are_read(tmp_path, layout):
    expected = np.asarray(values("f8"), order=layout)
    np.save(tmp_path / "a.npy", expected)
    assert np.array_equal(read_scan(tmp_path / "a.npy").samples, expected)
    assert not read_scan(tmp_path / "a.npy").samples.flags.writeable
    np.savez_compressed(tmp_path / "a.npz", table=np.eye(3), other=expected + 1, density=expected)
    scan = read_scan(tmp_path / "a.npz")
    assert np.array_equal(scan.samples, expected)
    assert scan.findings == (
        finding("others_left_out", kind="array", name="density", others=["other"]),
    )


@pytest.mark.parametrize(
    "array, code",
    [
        (np.ones((3, 3)), "scan_size"),
        (np.ones((2, 3, 3, 3)), "scan_size"),
        (np.ones((3, 3, 3), complex), "scan_sample_type"),
        (np.ones((0, 3, 3)), "scan_size"),
        (np.zeros((2, 2, 2), "U3"), "scan_sample_type"),
        (np.zeros((2, 2, 2), object), "file_damaged"),
    ],
)
def test_arrays_unfit_as_densities_are_refused(tmp_path, array, code):
    np.save(tmp_path / "a.npy", array)
    assert refusal(read_scan, tmp_path / "a.npy") == code


def test_archive_of_python_objects_is_refused_and_runs_nothing(tmp_path):
    class Maker:
        def __reduce__(self):
            return os.mkdir, (str(tmp_path / "made"),)

    objects = np.empty((2, 2, 2), object)
    objects[...] = Maker()
    np.savez(tmp_path / "a.npz", density=objects)
    assert refusal(read_scan, tmp_path / "a.npz") == "file_damaged"
    assert not (tmp_path / "made").exists()


@pytest.mark.parametrize("given", list(itertools.product((False, True), repeat=5)))
def test_placement_decision_is_reported(given):
    """Every combination of the file's and the user's values."""
    has_unit, is_placed, *asked = given
    own = np.array(
        [[2.0, 0.5, 0.0, 7.0], [0.0, 3.0, 0.0, 8.0], [0.0, 0.0, 4.0, 9.0], [0.0, 0.0, 0.0, 1.0]]
    )
    scan = Scan(values(), own, 1e-3 if has_unit else None, is_placed)
    spacing, origin, unit = (
        value if one else None for one, value in zip(asked, ((1, 2, 3), (4, 5, 6), 0.1))
    )
    matrix, findings = sample_matrix(scan, spacing, origin, unit)
    scale = 1e-3 if has_unit else unit or 1.0
    linear = own[:3, :3] * scale if spacing is None else np.diag(spacing) * (unit or 1.0)
    offset = own[:3, 3] * scale if origin is None else np.array(origin) * (unit or 1.0)
    assert np.array_equal(matrix[:3], np.column_stack([linear, offset])) and matrix[3].tolist() == [
        0,
        0,
        0,
        1,
    ]
    assert own[0, 0] == 2.0
    fields = [
        name for name, value in (("spacing", spacing), ("origin", origin)) if value is not None
    ]
    said = [finding("scan_own_unit")] if has_unit and unit else []
    said += [finding("scan_placement_overridden", fields=fields)] if is_placed and fields else []
    if spacing is None and not is_placed:
        said.append(finding("scan_unstated", part="spacing", option="spacing"))
    elif spacing is None and not has_unit and not unit:
        said.append(finding("scan_unstated", part="unit", option="unit-scale"))
    assert findings == tuple(said)


def damage(code, **values):
    return "file_damaged", {"file": "", "cause": {"code": code, "values": values}}


def field(name, wanted, text, form="NRRD"):
    return "header_field", {"format": form, "field": name, "wanted": wanted, "text": text}


def nifti_field(name, wanted, text):
    return field(name, wanted, text, "NIfTI")


def offset(text):
    return nifti_field("vox_offset", "a whole number behind the header", text)


def spacings(text, name="spacings", form="NRRD"):
    return field(name, "three spacings that are not zero", text, form)


def scaling(text):
    return field("slope and intercept", "finite numbers", text, ".nii")


def placement(text, form=".nii"):
    return field("spacing or directions", "finite, and not in one plane", text, form)


def rotation(text):
    return nifti_field("quatern", "a rotation", text)


def directions(text, shown=None):
    """A header with these directions, and its refusal for their count, or for the one that is
    shown.
    """
    wanted = "vectors of three numbers" if shown else "three vectors"
    return nrrd(values(), "space directions: " + text), field(
        "space directions", wanted, shown or text
    )


def nifti_with(offset: int, form: str, *numbers) -> bytes:
    data = bytearray(nifti(values()))
    struct.pack_into("<" + form, data, offset, *numbers)
    return bytes(data)


def nrrd_with(old: str, new: str) -> bytes:
    data = nrrd(values())
    assert old.encode() in data
    return data.replace(old.encode(), new.encode())


FAR_SFORM = np.eye(3, 4) + [0, 0, 0, np.inf]
FLAT_DIRECTIONS = nrrd(values(), "space directions: (1,0,0) (2,0,0) (0,0,1)")
NEGATIVE_SKIP = nrrd(values(), "byte skip: -1", encoding="gzip")
NOT_GZIP = damage(
    "damage_incomplete", kind="gzip stream", error=r"Not a gzipped file (b'\x00\x00')"
)
DAMAGED_NIFTI = [
    (b"", damage("damage_cut_short", part="header")),
    (b"x" * 400, ("file_unrecognized", {"format": "NIfTI"})),
    (nifti(values())[:-1], damage("damage_size", bytes=239, total=240)),
    (nifti_with(344, "4s", b"n+2\0"), ("file_unrecognized", {"format": "NIfTI"})),
    (nifti_with(0, "i", 349), ("file_unrecognized", {"format": "NIfTI"})),
    (nifti_with(344, "4s", b"ni1\0"), ("scan_in_several_files", {"suffix": ".nii"})),
    (nifti_with(40, "h", 8), nifti_field("dim", "1 to 7 dimensions", "8")),
    (nifti_with(40, "h", 1), ("scan_size", {"samples": [3]})),
    (nifti_with(40, "8h", 4, 3, 4, 5, 2, 1, 1, 1), ("scan_size", {"samples": [3, 4, 5, 2]})),
    (nifti_with(42, "h", -3), ("scan_size", {"samples": [-3, 4, 5]})),
    (
        nifti_with(42, "3h", 32767, 32767, 32767),
        damage("damage_size", bytes=240, total=140724603846652),
    ),
    (nifti_with(70, "h", 32), ("scan_sample_type", {"type": "NIfTI 32"})),
    (nifti_with(72, "h", 7), nifti_field("bitpix", "the size of its data type", "7")),
    (nifti_with(108, "f", float("nan")), offset("nan")),
    (nifti_with(108, "f", 347.0), offset("347")),
    (nifti_with(108, "f", 352.5), offset("352.5")),
    (nifti_with(108, "f", 356.0), damage("damage_size", bytes=236, total=240)),
    (nifti_with(40, "h", 0), nifti_field("dim", "1 to 7 dimensions", "0")),
    (nifti_with(84, "f", np.inf), spacings("1 inf 1", "pixdim", "NIfTI")),
    (nifti(values(), quaternion=(0.6, 0.8, 0.01, 0, 0, 0)), rotation("0.6 0.8 0.01 0 0 0")),
    (nifti(values(), quaternion=(0, 0, 0, 0, np.inf, 0)), rotation("0 0 0 0 inf 0")),
    (nifti_with(112, "f", float("inf")), scaling("inf 0")),
    (nifti_with(112, "2f", 1.0, float("inf")), scaling("1 inf")),
    (
        nifti(values(), spacing=(0, 0, 0), quaternion=(0, 0, 0, 1, 2, 3)),
        spacings("0 0 0", "pixdim", "NIfTI"),
    ),
    (nifti_with(80, "f", 0.0), spacings("0 1 1", "pixdim", "NIfTI")),
    (nifti(values(), sform=np.zeros((3, 4))), placement(" ".join("0" * 12))),
    (nifti(values(), sform=np.full((3, 4), np.nan)), placement(" ".join(["nan"] * 12))),
    (nifti(values(), sform=FAR_SFORM), placement("1 0 0 inf 0 1 0 inf 0 0 1 inf")),
    (nifti(values(), quaternion=(1, 1, 1, 0, 0, 0)), rotation("1 1 1 0 0 0")),
]
DAMAGED_NRRD = [
    (b"", ("file_unrecognized", {"format": "NRRD"})),
    (nrrd(values())[:-1], damage("damage_size", bytes=239, total=240)),
    (nrrd(values())[:60], field("dimension", "the count of “sizes”", "3")),
    (nrrd_with("type: float\n", ""), ("scan_sample_type", {"type": "“”"})),
    (nrrd_with("sizes: 3 4 5\n", ""), field("sizes", "three numbers", "")),
    (nrrd_with("dimension: 3\n", ""), field("dimension", "the count of “sizes”", "")),
    (nrrd_with("encoding: raw\n", ""), field("encoding", "raw, gzip, bzip2 or text", "")),
    (nrrd_with("type: float", "type: block"), ("scan_sample_type", {"type": "block"})),
    (nrrd_with("sizes: 3 4 5", "sizes: 3 4"), field("dimension", "the count of “sizes”", "3")),
    (nrrd_with("sizes: 3 4 5", "sizes: 3 4 x"), field("sizes", "a list of numbers", "3 4 x")),
    (nrrd_with("sizes: 3 4 5", "sizes: 3 4 0_5"), field("sizes", "a list of numbers", "3 4 0_5")),
    (nrrd(values(), "spacings: 1 2_0 1"), field("spacings", "a list of numbers", "1 2_0 1")),
    (nrrd_with("sizes: 3 4 5", "sizes: 3 4 -5"), ("scan_size", {"samples": [3, 4, -5]})),
    (
        nrrd_with("sizes: 3 4 5", "sizes: 3 4 5000000000000"),
        ("scan_size", {"samples": [3, 4, 5000000000000]}),
    ),
    (nrrd_with("dimension: 3", "dimension: 4"), field("dimension", "the count of “sizes”", "4")),
    (
        nrrd_with("encoding: raw", "encoding: hex"),
        field("encoding", "raw, gzip, bzip2 or text", "hex"),
    ),
    (nrrd_with("encoding: raw", "encoding: gzip"), NOT_GZIP),
    (NEGATIVE_SKIP, field("byte skip", "one number, not negative", "-1")),
    (nrrd_with("endian: little\n", ""), field("endian", "little or big", "")),
    *(
        (nrrd(values(), "spacings: " + text), spacings(text))
        for text in ("1 0 1", "1 2", "nan nan nan")
    ),
    (FLAT_DIRECTIONS, placement("1 2 0 0 0 0 0 0 0 0 1 0", ".nrrd")),
    directions("(1,0,0) (0,1,0)"),
    directions("(1,0,0) (0,1,0) (0,0)", "(0,0)"),
    directions("(1,0,0) (0,1_0,0) (0,0,1)", "(0,1_0,0)"),
    *(
        (
            nrrd(values(), "data file: " + name),
            ("named_file_missing", {"file": name, "content": "samples"}),
        )
        for name in ("nowhere.raw", "a b c")
    ),
    *(
        (nrrd(values(), "data file: " + name), ("scan_in_several_files", {"suffix": ".nrrd"}))
        for name in ("slice%03d.raw 1 9 1", "slice%03d.raw", "LIST", "list 2", "a b c d")
    ),
    (nrrd(values(), "byte skip: a"), field("byte skip", "a list of numbers", "a")),
    (nrrd(values(), "byte skip: -7"), field("byte skip", "one number, not negative", "-7")),
    (nrrd(values(), "byte skip: 1 2"), field("byte skip", "one number, not negative", "1 2")),
    (nrrd(values(), "line skip:"), field("line skip", "one number, not negative", "")),
    (nrrd(values(), "line skip: 9999"), damage("damage_cut_short", part="skipped lines")),
]


@pytest.mark.parametrize(
    "suffix, data, expected",
    [*((".nii", *case) for case in DAMAGED_NIFTI), *((".nrrd", *case) for case in DAMAGED_NRRD)],
)
def test_damaged_file_is_refused_with_its_damage(tmp_path, suffix, data, expected):
    code, said = expected
    with pytest.raises(FileError) as caught:
        read_scan(written(tmp_path / ("a" + suffix), data))
    found = caught.value.finding
    assert found.code == code and repr({**found.values, "file": 0}) == repr({**said, "file": 0})
    assert found.values.get("file", "a" + suffix) in ("a" + suffix, "nowhere.raw", "a b c")
    assert caught.value.reason.endswith(".")


def test_first_volume_of_an_archive_is_taken(tmp_path):
    np.savez(tmp_path / "a.npz", table=np.eye(3), first=values(), second=values() + 1)
    scan = read_scan(tmp_path / "a.npz")
    assert np.array_equal(scan.samples, values())
    assert scan.findings == (
        finding("others_left_out", kind="array", name="first", others=["second"]),
    )
    np.savez(tmp_path / "a.npz", first=values(), density=np.eye(3))
    scan = read_scan(tmp_path / "a.npz")
    assert np.array_equal(scan.samples, values()) and scan.findings == ()
    np.savez(tmp_path / "a.npz", table=np.eye(3))
    assert refusal(read_scan, tmp_path / "a.npz") == "scan_size"


@pytest.mark.parametrize("shape", [b"(3, 4, 6)", b"(9, 9999,9999)", b"(3, 4, 5"])
def test_an_archive_cannot_promise_more_than_it_holds(tmp_path, shape):
    data = npy(values()).replace(b"(3, 4, 5), }     ", (shape + b", }").ljust(17))
    assert data != npy(values()) and len(data) == len(npy(values()))
    path = written(tmp_path / "a.npz", npz({"density": data}))
    assert refusal(read_scan, path) == "file_damaged"


SEEDS = {
    ".npy": npy(values()),
    ".npz": npz({"density": npy(values())}),
    ".nrrd": nrrd(
        values(), "space directions: (1,0,0) (0,1,0) (0,0,1)", "byte skip: 0", MILLIMETERS
    ),
    ".nrrd gzip": nrrd(values(), "spacings: 1 1 1", encoding="gzip"),
    ".nii": nifti(values(), quaternion=(0, 0, 0.5, 1, 2, 3)),
    ".nii.gz": gzip.compress(nifti(values())),
}


@pytest.mark.parametrize("name", SEEDS)
@pytest.mark.filterwarnings("ignore")
def test_damage_anywhere_gives_a_refusal_or_an_array(tmp_path, name):
    data, rng = SEEDS[name], random.Random(name)
    path = tmp_path / ("a" + name.split()[0])
    refused = 0
    for _ in range(400):
        damaged = bytearray(data)
        for _ in range(rng.choice((1, 1, 2, 8))):
            place = rng.randrange(min(len(damaged), 400))
            action = rng.randrange(4)
            if action == 0:
                damaged[place] = rng.randrange(256)
            elif action == 1:
                damaged[place] ^= 1 << rng.randrange(8)
            elif action == 2:
                damaged[place:place] = rng.choice(
                    (b"9", b"-", b"\n", b"\0", b"99999999", b"nan", b"(", b"\xff")
                )
            elif len(damaged) > 1:
                del damaged[place : place + rng.choice((1, 4, 100))]
            if not damaged:
                damaged = bytearray(b"0")
        path.write_bytes(damaged)
        try:
            scan = read_scan(path)
        except FileError as error:
            refused += 1
            assert str(error)[0].isupper() and str(error).endswith("."), error
            continue
        assert scan.samples.ndim == 3 and np.isfinite(scan.matrix).all()
        np.asarray(scan.samples).sum(dtype=np.float64)  # every sample is there
    assert refused > 50


def test_foreign_file_is_no_scan(tmp_path):
    assert [scan_suffix("A.B" + end.upper()) for end in SUFFIXES] == list(SUFFIXES)
    assert scan_suffix("a.blend") == ""
    assert refusal(read_scan, tmp_path / "a.blend") == "file_type"
    assert refusal(read_scan, tmp_path / "a.npy") == "file_missing"
    (tmp_path / "b.npy").mkdir()
    assert refusal(read_scan, tmp_path / "b.npy") == "file_unreadable"


@pytest.mark.parametrize("end", SUFFIXES)
def test_unreadable_file_is_not_called_damaged(tmp_path, monkeypatch, end):
    path = tmp_path / f"scan_2x2x2_uint8{end}"
    path.write_bytes(b"x")

    def refused(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("builtins.open", refused)
    monkeypatch.setattr("io.open", refused)
    with pytest.raises(PermissionError):
        read_scan(path)


@pytest.mark.parametrize("name", ["a.npy", "a.npz"])
def test_lack_of_memory_is_not_called_damage(tmp_path, monkeypatch, name):
    path = written(tmp_path / name, SEEDS[name[1:]])

    def fails(*_, **__):
        raise MemoryError

    monkeypatch.setattr(np.lib.format, "open_memmap", fails)
    monkeypatch.setattr(np.lib.format, "read_array", fails)
    assert refusal(read_scan, path) == "file_unreadable"
