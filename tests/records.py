# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Documents as `docs/record.schema.json` has them: whatever tests read of the command line is held
against it.
"""

import functools
import json
from pathlib import Path

import fastjsonschema

SCHEMA = Path(__file__).resolve().parent.parent / "docs" / "record.schema.json"


@functools.cache
def _check():
    return fastjsonschema.compile(json.loads(SCHEMA.read_text(encoding="utf-8")))


def valid(document):
    """The document or documents, which the schema must allow; raises with the place where it does
    not.
    """
    try:
        _check()(document)
    except fastjsonschema.JsonSchemaException as error:
        raise AssertionError(
            "{} is not as docs/record.schema.json says: {}".format(error.name, error.message)
        ) from None
    return document
