# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Other languages, by Blender's own mechanism: what is shown is looked up as it stands in the source, and then filled.

Blender itself looks up labels, tooltips and texts without placeholders. Everything with placeholders goes through
`localized` or `localized_sentence`, and is drawn with `translate=False`. Stored texts and records stay English.

A language is a module with TEXTS, by the English text, and MESSAGES, by the code of a message.
"""

from __future__ import annotations

from functools import partial
from types import ModuleType
from typing import Any

import bpy

from ...core.verdict.catalog import declared
from ...core.verdict.finding import Finding
from ...core.verdict.sentences import sentence
from . import german
from .units import Units

ADDON_ID = __name__.removesuffix(".blender.write.translations")
LANGUAGES = {"de_DE": german}
# Words that mean something else in Blender's own translations, such as Frame and Order, are looked up under this.
CONTEXT = "Body Moments"


def dictionary() -> dict[str, dict[tuple[str, str], str]]:
    """All translations, as Blender takes them: locale → (context, English text) → text. Names of operators have a
    context of their own, so that every text stands under each."""
    contexts = bpy.app.translations.contexts
    return {
        locale: {
            (context, english): text
            for english, text in _translated(language).items()
            for context in (contexts.default, contexts.operator_default, CONTEXT)
        }
        for locale, language in LANGUAGES.items()
    }


def _translated(language: ModuleType) -> dict[str, str]:
    """English text → text in a language."""
    texts = dict(language.TEXTS)
    for code, translated in language.MESSAGES.items():
        entry = declared(code)
        texts |= zip(filter(None, (entry.text, entry.plural)), translated, strict=True)
    return texts


def localized(text: str) -> str:
    """A text of the interface in the user's language, before it is filled."""
    return bpy.app.translations.pgettext_iface(text, CONTEXT)


def localized_sentence(finding: Finding, unit_settings: Any) -> str:
    """The sentence of a finding in the user's language, lengths in a scene's units."""
    return sentence(finding, localized, partial(Units.of(unit_settings).text, "length"))


def register() -> None:
    bpy.app.translations.register(ADDON_ID, dictionary())


def unregister() -> None:
    bpy.app.translations.unregister(ADDON_ID)
