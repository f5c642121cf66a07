# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Statements of .obj files that importers would misread, and the lines that they stand on."""

import pytest
from body_moments.core.cad.obj_text import check_obj_text
from body_moments.core.files.text_fields import COUNT, NUMBER, VERTEX
from body_moments.core.files.text_fields import WHOLE as WHOLE_NUMBER

from tests.core.misread_files import NO_NUMBERS, NO_WHOLES, NUMBERS, misread

START = """# v 1.0x0
mtllib a\\b.mtl
o f 1 2 3
v 0 0 0
v 1 0 0 1 0.5 0
v 0 1 0 1
v 0 0 1
vt 0.5
vt 0.5 0.5 0
vn nan 0 1
vp 0.5 0.5
g v 1
usemtl 1.0x0
"""
FACES = (
    "f 1 2 3\nf 1/1 2/2 -1/-2\nf 1//1 2//-1 4//1\nf 1/1/1 -3/2/-1 4/1/1 3/2/1\nf 1/ 2/ 3/\nf 1// "
    "2// 3//\n"
)
FACES += "l 1 2/1\np 1 -4\n"
FREE = (
    "cstype rat bspline\ndeg 1 1\nsurf 0 1 0 1 1/1/1 2 3 -1\nparm u 0 0 1 1\nparm v 0 0 1 "
    "1\nend\ncurv 0 1 1 2\n"
)
FREE += "curv2 1 -1\n"
WHOLE = START + FACES + FREE


def changed(line, place, word):
    lines = WHOLE.split("\n")
    words = lines[line - 1].split()
    words[place : place + 1] = [word] if word is not None else []
    return "\n".join([*lines[: line - 1], " ".join(words), *lines[line:]])


# Line and field.
NUMBER_FIELDS = [
    (4, 1),
    (4, 2),
    (4, 3),
    (5, 3),
    (5, 4),
    (5, 6),
    (6, 4),
    (8, 1),
    (9, 1),
    (9, 3),
    (10, 1),
    (10, 3),
]
NUMBER_FIELDS += [(11, 1), (11, 2), (24, 1), (24, 4), (25, 2), (25, 5), (28, 1), (28, 2)]
PLACING = {4: {1, 2, 3}, 5: {3}, 24: {1, 4}, 25: {2, 5}, 28: {1, 2}}
INDEX_FIELDS = [
    (14, 1),
    (14, 3),
    (15, 2),
    (16, 3),
    (17, 4),
    (20, 1),
    (20, 2),
    (21, 1),
    (24, 5),
    (24, 8),
    (28, 3),
]


def test_statements_are_read_as_before():
    marked = "\ufeff" + WHOLE
    joined = WHOLE.replace("v 1 0 0", "v \\\n1 \\\r\n0\\\n0", 1).replace(
        "f 1 2 3\n", "f 1 \\\n2 3\n"
    )
    spaces = WHOLE.replace(" ", "\t ").replace("\nv", "\n \t v").replace("\nf", "\n\tf")
    comments = WHOLE.replace("v 0 0 0", "v 0 0 0#1x").replace("f 1 2 3\n", "f 1 2 3 # f 9\n")
    returns = WHOLE.replace("\n", "\r\n")
    for text in (WHOLE, returns, marked, joined, spaces, comments, WHOLE.rstrip(), "", "\n\n"):
        check_obj_text(text.encode())


@pytest.mark.parametrize("line, place", NUMBER_FIELDS)
def test_word_for_a_number_is_refused(line, place):
    placing = place in PLACING.get(line, ())
    for word in (*NO_NUMBERS, *["nan", "-INF", "1e39", "9" * 45] * placing):
        text = word.partition("#")[0].replace("\0", "")
        if not text or text == "1":
            continue  # a comment, and white space to importers
        with misread(line, NUMBER, text=text):
            check_obj_text(changed(line, place, word).encode())
    for word in (*NUMBERS, *["nan", "-nan(ind)", "inf", "1e39", "-1.#IND"] * (not placing)):
        check_obj_text(changed(line, place, word).encode())


@pytest.mark.parametrize("line, place", INDEX_FIELDS)
def test_word_for_an_index_is_refused(line, place):
    for word in (*filter(None, NO_WHOLES), "1/2/3/4", "/1", "1/x", "1//x", "1.0/1", "1 /1"):
        if word != "1/1":
            with misread(line, WHOLE_NUMBER, text=word.split()[-1]):
                check_obj_text(changed(line, place, word).encode())
    for word in (
        "0",
        "5",
        "-5",
        "00",
        "9" * 30,
        "1/3",
        "1/-3",
        "1/0",
        "1//2",
        "1//0",
        "1/1/-2",
        "5/1/1",
    ):
        with misread(line, VERTEX, text=word):
            check_obj_text(changed(line, place, word).encode())
    for word in ("4", "-4", "+1", "01", "1/2", "1/-2", "1//1", "1/2/-1", "1/2/"):
        check_obj_text(changed(line, place, word).encode())


@pytest.mark.parametrize("line, place", [(23, 1), (23, 2), (29, 1), (29, 2)])
def test_word_for_a_whole_number_is_refused(line, place):
    for word in filter(None, NO_WHOLES):
        with misread(line, WHOLE_NUMBER, text=word):
            check_obj_text(changed(line, place, word).encode())


@pytest.mark.parametrize("line", [4, 5, 6, 8, 10, 11, 14, 15, 16, 20, 21, 23, 24, 25, 28, 29])
def test_statement_with_too_few_fields_is_refused(line):
    least = {8: 0, 11: 0, 20: 1, 21: 0, 23: 0, 24: 4, 25: 1, 28: 2, 29: 1}.get(line, 2)
    lines = WHOLE.split("\n")
    lines[line - 1] = " ".join(lines[line - 1].split()[: least + 1])
    with misread(line, COUNT, text=lines[line - 1]):
        check_obj_text("\n".join(lines).encode())


def test_index_ahead_of_its_vertex_is_refused():
    for text, line, word in (
        ("v 0 0 0\nf 1 1 2\nv 1 1 1\n", 2, "2"),
        ("vt 0\nv 0 0 0\nf 1/2 1 1\nvt 1", 3, "1/2"),
    ):
        with misread(line, VERTEX, text=word):
            check_obj_text(text.encode())
    check_obj_text(b"v 0 0 0\nf 1/2/9 1//7 1/0\nvt 1\nvn 0 0 1\n")  # no vertices exist yet
    check_obj_text(b"v 0 0 0\nv 0 1 0\nv 0 0 1\nf -3 -2 -1\n" * 500)
    with misread(2001, VERTEX, text="-1501"):
        check_obj_text(b"v 0 0 0\nv 0 1 0\nv 0 0 1\nf -3 -2 -1\n" * 500 + b"f -1500 -1501 1\n")


def test_continued_statement_is_named_by_its_first_line():
    text = "v 0 0 \\\n0\n# a \\\nv x\nv 0 \\\r\n \\\n0 x\n"
    with misread(5, NUMBER, text="x"):
        check_obj_text(text.encode())
    for text in ("v 0 0 0\nf 1 1 1 \\", "v 0 0 0\nf 1 1 1 \\ 1"):
        with misread(2, WHOLE_NUMBER, text="\\"):
            check_obj_text(text.encode())


def test_byte_order_mark_before_a_statement_is_refused():
    with misread(1, "“v”", text="U+FEFF"):
        check_obj_text("\ufeffv 0 0 0\n".encode())
    check_obj_text("\ufeff\nv 0 0 0\n".encode())
