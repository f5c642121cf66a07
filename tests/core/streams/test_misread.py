# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Words of .stl and .ply files in text that importers would misread, and the lines that they stand
on.
"""

import time

import pytest
from body_moments.core.files.number_text import parse_number, parse_numbers, parse_whole
from body_moments.core.files.text_fields import (
    COUNT,
    NUMBER,
    VERTEX,
    WHOLE,
)
from body_moments.core.streams.measure import open_mesh_file
from body_moments.core.streams.ply import check_ply_text
from body_moments.core.streams.ply_rows import parse_header
from body_moments.core.streams.stl import check_stl_text

from tests.core.findings import refused
from tests.core.misread_files import NO_NUMBERS, NO_WHOLES, NUMBERS, misread

NO_NUMBERS += [
    "1e1.5",
    "1.0f",
    "½",
    "٣",
    "１",
    "−1",
    "1;",
    "#1",
    "(1)",
    "1/2",
    "1%",
    "None",
    "infinite",
    "1\xa0",
]
NO_NUMBERS.append("\x001")

FACET = (
    "facet normal {} {} {}\n outer loop\n  vertex {} {} {}\n  vertex {} {} {}\n  vertex {} {} {}\n "
    "endloop\nendfacet\n"
)
FIELDS = [*"001", *"000", *"100", *"010"]
LINES = [2, 2, 2, 4, 4, 4, 5, 5, 5, 6, 6, 6]
HEADER = """ply
format ascii 1.0
comment 1.0x0
element camera 2
property int view
property list uchar float path
element vertex 4
property float x
property double y
property float z
property float nx
property uchar red
element face 2
property list uchar float texcoord
property list uchar int vertex_indices
property float quality
end_header
"""
ROWS = [
    "7 2 0.5 .5",
    "8 0",
    *["{} 0 0 0 255".format(x) for x in range(4)],
    "2 0.5 1 3 0 1 2 1",
    "0 4 0 1 2 3 nan",
]


def write(path, text):
    path.write_bytes(text.encode())
    return path


def test_decimal_numbers_follow_xml_schema():
    for text in NUMBERS:
        assert parse_number(text) == float(text)
    assert (
        parse_numbers(" 1\t.5\r\n-INF NaN ")[:3] == [1.0, 0.5, -float("inf")]
        and parse_whole("-07") == -7
    )
    for text in (*NO_NUMBERS, "", " 1", "1 ", "1\n"):
        with pytest.raises(ValueError, match=".*") as caught:
            parse_number(text)
        assert caught.value.args == (text,)
    with pytest.raises(ValueError, match="^1_0$"):
        parse_numbers("1 1_0 x")


def facet(fields):
    return "solid a b\n" + FACET.format(*fields) + "endsolid a b\n"


@pytest.mark.parametrize("place", range(12))
def test_stl_with_a_word_for_a_number_is_refused(tmp_path, place):
    for word in (*NO_NUMBERS, *["1e39", "nan"] * (place > 2)):
        text = facet([*FIELDS[:place], word, *FIELDS[place + 1 :]])
        with misread(LINES[place], NUMBER, text=word):
            open_mesh_file(write(tmp_path / "a.stl", text)).mesh()
    for word in (*NUMBERS, *["1e39", "-nan(ind)", "1.#QNAN", "inf"] * (place < 3)):
        text = facet([*FIELDS[:place], word, *FIELDS[place + 1 :]])
        open_mesh_file(write(tmp_path / "a.stl", text)).mesh()


@pytest.mark.parametrize("place", range(12))
def test_stl_without_a_number_is_refused(tmp_path, place):
    missing, double = (facet([*FIELDS[:place], word, *FIELDS[place + 1 :]]) for word in ("", "1 1"))
    for text in (missing, double):
        with refused("line_misread"):
            open_mesh_file(write(tmp_path / "a.stl", text)).mesh()


@pytest.mark.parametrize(
    "old, new, line, word, expected",
    [
        (" endloop", "  vertex 1 1 1\n endloop", 7, "vertex", "endloop"),
        ("  vertex 1 0 0\n", "", 6, "endloop", "vertex"),
        ("facet", "# vertex 1 2 3\nfacet", 2, "#", "facet"),
        ("  vertex 1", "  vertx 1", 5, "vertx", "vertex"),
        ("\nfacet", "\nfacets", 2, "facets", "facet"),
        ("normal", "normals", 2, "normals", "normal"),
        ("outer", "inner", 3, "inner", "outer"),
        ("loop\n", "loops\n", 3, "loops", "loop"),
        (" endloop", " endloops", 7, "endloops", "endloop"),
        ("endfacet", "endfacets", 8, "endfacets", "endfacet"),
        (
            "endsolid a b",
            "endsolid a\nsolid vertex 1 2 3\n" + FACET.format(*FIELDS),
            10,
            "vertex",
            "facet",
        ),
    ],
)
def test_stl_with_other_words_is_refused(tmp_path, old, new, line, word, expected):
    text = facet(FIELDS).replace(old, new, 1)
    with misread(line, "“{}”".format(expected), text=word):
        open_mesh_file(write(tmp_path / "a.stl", text)).mesh()


def test_stl_words_may_stand_on_any_lines():
    text = facet(FIELDS)
    body = FACET.format(*FIELDS)
    others = [
        text.upper(),
        text.title(),
        "\ufeff" + text,
        text.replace("\n", "\r\n"),
        text.replace("\n ", "\n\t"),
        text * 2,
    ]
    others += [
        "solid vertex 1 2 3 facet\n" + body + "endsolid",
        "solid\n" + body.replace(" ", "\n") + "endsolid",
    ]
    others += [
        "solid\n" + body.replace("\n", " ") + "\nendsolid",
        text.replace("0", "+.0e-00").replace("1", "\f1."),
    ]
    for other in others:
        check_stl_text(other.encode())


def ply(number, place, word):
    rows = [row.split() for row in ROWS]
    rows[number][place] = word
    return HEADER + "\n".join(map(" ".join, rows)) + "\n"


# Row, field and whether it is a number that places a point ("point"), another one, a whole one, or
# an index.
PLY_FIELDS = [
    (0, 0, "number"),
    (0, 1, "whole"),
    (0, 3, "number"),
    (2, 0, "point"),
    (3, 1, "point"),
    (4, 2, "point"),
]
PLY_FIELDS += [
    (5, 3, "number"),
    (5, 4, "number"),
    (6, 0, "whole"),
    (6, 2, "number"),
    (6, 3, "whole"),
    (6, 4, "index"),
]
PLY_FIELDS += [(7, 0, "whole"), (7, 1, "whole"), (7, 5, "index"), (7, 6, "number")]


@pytest.mark.parametrize("row, place, kind", PLY_FIELDS)
def test_ply_with_a_word_for_a_number_is_refused(tmp_path, row, place, kind):
    is_whole, line = kind in ("whole", "index"), 18 + row
    expected = WHOLE if is_whole else NUMBER
    wrong = (NO_WHOLES if is_whole else NO_NUMBERS) + ["nan", "1e39"] * (kind == "point")
    for word in filter(None, wrong):
        with misread(line, expected, text=word):
            open_mesh_file(write(tmp_path / "a.ply", ply(row, place, word)))
    if kind == "index":
        for word in ("4", "-1", "9" * 30):
            with misread(line, VERTEX, text=word):
                open_mesh_file(write(tmp_path / "a.ply", ply(row, place, word)))
    for word in NUMBERS if not is_whole else ["+2", "02"][: 2 * (kind == "index")]:
        open_mesh_file(write(tmp_path / "a.ply", ply(row, place, word)))


@pytest.mark.parametrize("row", range(len(ROWS)))
def test_ply_row_with_another_count_is_refused(tmp_path, row):
    for text in (ROWS[row].rpartition(" ")[0], ROWS[row] + " 1", "", "-1 " + ROWS[row]):
        rows = [*ROWS[:row], text, *ROWS[row + 1 :]]
        with refused("line_misread", line=18 + row):
            open_mesh_file(write(tmp_path / "a.ply", HEADER + "\n".join(rows) + "\n"))


def test_ply_rows_may_have_other_spaces(tmp_path):
    text = HEADER + "\n".join(ROWS)
    for other in (
        text,
        text + "\n\n \n",
        text.replace("\n", "\r\n"),
        HEADER + " \t\n ".join(ROWS).replace(" ", "\t "),
    ):
        open_mesh_file(write(tmp_path / "a.ply", other))
    with misread(26, COUNT, text="3 0 1 2"):
        open_mesh_file(write(tmp_path / "a.ply", text + "\n3 0 1 2\n"))


def test_ply_polygons_of_many_sides_are_read(tmp_path):
    count = 20
    rows = ["{0} {0} 1 0 0".format(number) for number in range(count)]
    faces = [
        "0 {} {} 1".format(sides, " ".join(map(str, range(sides)))) for sides in range(3, count + 1)
    ]
    head = HEADER.replace("element vertex 4", "element vertex 20").replace(
        "element face 2", "element face 18"
    )
    text = head + "\n".join([*ROWS[:2], *rows, *faces, ""])
    open_mesh_file(write(tmp_path / "a.ply", text))
    with misread(57, VERTEX, text="20"):
        open_mesh_file(write(tmp_path / "a.ply", text.replace(" 19 1\n", " 20 1\n")))


def test_ply_header_of_many_properties_is_read_soon():
    """Expressions for all of them would take minutes."""
    lists = "".join("property list uchar int p{}\n".format(number) for number in range(10_000))
    elements = "".join(
        "element e{} 1\nproperty float x\n".format(number) for number in range(10_000)
    )
    text = "ply\nformat ascii 1.0\nelement a 30\n" + lists + elements + "end_header\n"
    text += 30 * (10_000 * "0 " + "\n") + 9_999 * "1\n" + "x"
    start = time.process_time()
    with misread(text.count("\n") + 1, NUMBER, text="x"):
        check_ply_text(text.encode(), parse_header(text.encode()))
    assert time.process_time() - start < 10.0
