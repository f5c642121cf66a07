# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Translations in gettext's format: the reader, and the files in `locale/`, held against msgfmt and
the source.
"""

import ast
import gettext
import re
import shutil
import string
import subprocess
from pathlib import Path

import pytest
from body_moments.blender.write.translations import read_po

from tests.package.modules import MODULES

ROOT = Path(__file__).resolve().parents[3]
FILES = [pytest.param(path, id=path.stem) for path in sorted((ROOT / "locale").glob("*.po"))]
SAMPLE = r"""
msgid ""
msgstr "Language: de\n"

# a note of a translator
#: source.py:1
#, python-brace-format
msgid "{count} edge"
msgid_plural "{count} edges"
msgstr[0] "{count} Kante"
msgstr[1] "{count} Kanten"

msgctxt "Body Moments"
msgid ""
"A \"long\" "
"text\n"
msgstr "Ein „langer“ "
"Text\n"

#| msgid "Mas"
#, fuzzy, python-brace-format
msgid "Mass"
msgstr "Gewicht"

msgid "Density"
msgstr ""

#~ msgid "Gone"
#~ msgstr "Fort"
"""


def find_placeholders(text):
    """Return the sorted names and formats of a text's placeholders."""
    return sorted(field[1:4] for field in string.Formatter().parse(text) if field[1] is not None)


def test_reader_yields_translated_forms_only(tmp_path):
    path = tmp_path / "de.po"
    path.write_text(SAMPLE, encoding="utf-8")
    assert list(read_po(path)) == [
        (None, "{count} edge", "{count} Kante"),
        (None, "{count} edges", "{count} Kanten"),
        ("Body Moments", 'A "long" text\n', "Ein „langer“ Text\n"),
    ]


def test_reader_gives_plurals_the_last_form(tmp_path):
    path = tmp_path / "xx.po"
    forms = ("one", "few", "many")
    for used in (forms[:1], forms):
        lines = [f'msgstr[{index}] "{form}"' for index, form in enumerate(used)]
        path.write_text(
            "\n".join(['msgid "edge"', 'msgid_plural "edges"', *lines]), encoding="utf-8"
        )
        assert list(read_po(path)) == [(None, "edge", used[0]), (None, "edges", used[-1])]


@pytest.mark.parametrize("path", FILES)
def test_file_passes_msgfmt_and_reads_alike(path, tmp_path):
    msgfmt = shutil.which("msgfmt")
    if msgfmt is None:
        pytest.skip("needs msgfmt")
    output = tmp_path / "messages.mo"
    done = subprocess.run(
        [msgfmt, "--check", f"--output-file={output}", str(path)],
        capture_output=True,
        encoding="utf-8",
    )
    assert done.returncode == 0, done.stderr
    with output.open("rb") as opened:
        catalog = gettext.GNUTranslations(opened)
    read = [
        (english, translation, catalog.gettext(english))
        for _, english, translation in read_po(path)
    ]
    # A plural is not a key of the catalog, which returns it as it is.
    assert not [entry for entry in read if entry[2] not in entry[:2]]
    assert sum(entry[1] == entry[2] for entry in read) > len(read) / 2


@pytest.mark.parametrize("path", FILES)
def test_file_has_every_plural_form_of_its_language(path):
    header, *blocks = path.read_text(encoding="utf-8").split("\n\n")
    forms = int(re.search(r"nplurals=(\d)", header)[1])
    plurals = [
        block for block in blocks if "\nmsgid_plural " in block and not block.startswith("#~")
    ]
    assert plurals
    assert not [
        block
        for block in plurals
        if len(re.findall(r"^msgstr\[\d\] ", block, re.MULTILINE)) != forms
    ]


@pytest.mark.parametrize("path", FILES)
def test_translation_keeps_placeholders_and_full_stop(path):
    wrong = [
        (english, translation)
        for _, english, translation in read_po(path)
        if find_placeholders(english) != find_placeholders(translation)
        or english.endswith(".") != translation.endswith(".")
    ]
    assert not wrong


@pytest.fixture(scope="module")
def source_texts():
    """The strings of the product's source."""
    trees = [ast.parse(path.read_text(encoding="utf-8")) for path in MODULES.values()]
    constants = (
        node for tree in trees for node in ast.walk(tree) if isinstance(node, ast.Constant)
    )
    texts = {constant.value for constant in constants if isinstance(constant.value, str)}
    return texts | {" ".join(text.split()) for text in texts}  # as descriptions of operators


@pytest.mark.parametrize("path", FILES)
def test_source_still_has_every_translated_text(path, source_texts):
    # Blender is given some texts whose {:s} is filled: "Density in {:s}", in each unit.
    templates = [
        re.escape(text).replace(r"\{:s\}", ".+") for text in source_texts if "{:s}" in text
    ]
    filled = re.compile(
        "|".join(template for template in templates if re.search("[a-z]{3}", template))
    )
    stale = [
        english
        for _, english, _ in read_po(path)
        if english not in source_texts
        and english.removeprefix("{count} ") not in source_texts  # the counts of the health record
        and not filled.fullmatch(english)
    ]
    assert not stale, "Translations of texts that are gone:\n" + "\n".join(stale)
