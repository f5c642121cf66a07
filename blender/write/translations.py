# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Other languages, by Blender's own mechanism: the text in the source is looked up, and then
filled.

Blender looks up labels, tooltips and texts without placeholders; all others go through `localized`
or `localized_sentence`, and are drawn with `translate=False`. Stored texts and records stay
English. The translations are `locale/*.po`, by the English text; only the file of the interface's
language is read.
"""

import json
import re
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import bpy
from bpy.app.handlers import persistent

from ...core.verdict import Finding, sentence
from .units import Units

ADDON_ID = __name__.removesuffix(".blender.write.translations")
FOLDER = Path(sys.modules[ADDON_ID].__path__[0]) / "locale"
# Words that mean something else in Blender's own translations, such as Frame and Order, are looked
# up under this.
CONTEXT = "Body Moments"

# A line of a .po file: a field with the first part of its text, or a further part of the text
# alone.
_PART = r'(msgctxt|msgid|msgid_plural|msgstr(?:\[\d+\])?)?\s*(".*")\s*'
_FUZZY = r"(?m)^#,.*\bfuzzy\b"  # a tool's guess that no translator has confirmed


def read_po(path: Path) -> Iterator[tuple[str | None, str, str]]:
    """Yield (context or None, English text, translation) of each translated singular and (last
    form) plural.
    """
    for block in re.split(r"\n\s*\n", path.read_text(encoding="utf-8")):
        if re.search(_FUZZY, block):
            continue
        entry: dict[str, str] = {}
        field = ""
        for part in filter(None, [re.fullmatch(_PART, line) for line in block.splitlines()]):
            field = part[1] or field
            entry[field] = entry.get(field, "") + json.loads(part[2], strict=False)
        forms = [entry[name] for name in entry if name.startswith("msgstr")]
        for english in filter(None, (entry.get("msgid"), entry.get("msgid_plural"))):
            translation = forms[0] if english == entry["msgid"] else forms[-1]
            if translation:
                yield entry.get("msgctxt"), english, translation


def read_translations(locale: str) -> dict[tuple[str, str], str]:
    """Return translations by (context, English text), {} without a file; each context has those
    without context.
    """
    contexts = bpy.app.translations.contexts
    everywhere = (contexts.default, contexts.operator_default, CONTEXT)
    paths = [FOLDER / f"{name}.po" for name in (locale, locale.partition("_")[0])]
    return {
        (context, english): translation
        for path in [path for path in paths if path.is_file()][:1]
        for own_context, english, translation in read_po(path)
        for context in ([own_context] if own_context else everywhere)
    }


@persistent
def register_language(*_: Any) -> None:
    """Give Blender the translations into the interface's language, if there are any."""
    locale = bpy.app.translations.locale
    if translations := read_translations(locale):
        bpy.app.translations.unregister(ADDON_ID)
        bpy.app.translations.register(ADDON_ID, {locale: translations})


def localized(text: str) -> str:
    """Return an interface text in the user's language, not yet filled with values."""
    return bpy.app.translations.pgettext_iface(text, CONTEXT)


def localized_sentence(finding: Finding, unit_settings: Any) -> str:
    """Return the sentence of a finding in the user's language, lengths in a scene's units."""
    return sentence(finding, localized, partial(Units.from_settings(unit_settings).text, "length"))


def register() -> None:
    register_language()
    bpy.app.handlers.translation_update_post.append(register_language)


def unregister() -> None:
    handlers = bpy.app.handlers.translation_update_post
    if register_language in handlers:  # scripts and other add-ons may empty these lists
        handlers.remove(register_language)
    bpy.app.translations.unregister(ADDON_ID)
