# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Other languages, by Blender's own mechanism: what is shown is looked up as it stands in the source, and then filled.

Blender itself looks up labels, tooltips and texts without placeholders. Everything with placeholders goes through
`localized` or `localized_sentence`, and is drawn with `translate=False`. Stored texts and records stay English.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import bpy

from ...core.verdict.finding import Finding
from .german import GERMAN
from .messages import sentence
from .units import Units

ADDON_ID = __package__.removesuffix(".operators.write")
LANGUAGES = {"de_DE": GERMAN}


def dictionary() -> dict[str, dict[tuple[str, str], str]]:
    """All translations, as Blender takes them: locale → (context, English text) → text. Names of operators have a
    context of their own, so that every text stands under both."""
    contexts = (bpy.app.translations.contexts.default, bpy.app.translations.contexts.operator_default)
    return {
        locale: {(context, english): text for english, text in texts.items() for context in contexts}
        for locale, texts in LANGUAGES.items()
    }


def localized(text: str) -> str:
    """A text of the interface in the user's language, before it is filled."""
    return bpy.app.translations.pgettext_iface(text)


def localized_sentence(finding: Finding, unit_settings: Any) -> str:
    """The sentence of a finding in the user's language, lengths in a scene's units."""
    return sentence(finding, localized, partial(Units.of(unit_settings).text, "length"))


def register() -> None:
    bpy.app.translations.register(ADDON_ID, dictionary())


def unregister() -> None:
    bpy.app.translations.unregister(ADDON_ID)
