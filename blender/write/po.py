# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reader of translations in gettext's format (.po), which the tools of translators write."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path

# A field with the first part of its text, or a further part of it on a line of its own.
_PART = re.compile(r'(msgctxt|msgid|msgid_plural|msgstr(?:\[\d+\])?)?\s*(".*")\s*')
_FUZZY = re.compile(r"^#,.*\bfuzzy\b", re.MULTILINE)  # a tool's guess that no translator has confirmed


def read_po(path: Path) -> Iterator[tuple[str | None, str, str]]:
    """Yield (context or None, English text, translation) of each singular and plural that is translated.

    Blender looks up singular and plural as two texts, so that the plural takes the language's last form.
    """
    for block in re.split(r"\n\s*\n", path.read_text(encoding="utf-8")):
        if _FUZZY.search(block):
            continue
        entry: dict[str, str] = {}
        field = ""
        for part in filter(None, map(_PART.fullmatch, block.splitlines())):
            field = part[1] or field
            entry[field] = entry.get(field, "") + json.loads(part[2], strict=False)
        forms = [entry[name] for name in entry if name.startswith("msgstr")]
        for english in filter(None, (entry.get("msgid"), entry.get("msgid_plural"))):
            translation = forms[0] if english == entry["msgid"] else forms[-1]
            if translation:
                yield entry.get("msgctxt"), english, translation
