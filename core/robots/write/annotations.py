# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Audit reports for programs that show findings at their lines: SARIF 2.1.0 and the annotations of
GitHub.
"""

import hashlib
import json
import os
import string
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from ...verdict import declared
from .marker import AUDIT_COMMANDS, SARIF_SCHEMA

_COMMANDS = {"error": "error", "warning": "warning", "note": "notice"}
_ESCAPES = (("%", "%25"), ("\r", "%0D"), ("\n", "%0A"))
_PLAIN = frozenset(string.ascii_letters + string.digits + "/-._~")  # characters of a URI
_IN_PROPERTIES = ((":", "%3A"), (",", "%2C"))


def _located(documents: Sequence[dict[str, Any]]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the name of the link, "" if it is about the file, and the record of all entries of
    report documents.
    """
    for document in documents:
        yield from (("", found) for found in [*document["errors"], *document["findings"]])
        for link in document["links"]:
            yield from ((link["name"], found) for found in link["findings"])


def _text(link: str, found: dict[str, Any]) -> str:
    return "{}: {}".format(link, found["message"]) if link else found["message"]


def _relative(file: str) -> str:
    """Return a file's path with slashes, relative to the working folder if it is in it."""
    path = (
        os.path.relpath(file)
        if os.path.isabs(file) and Path(file).is_relative_to(os.getcwd())
        else file
    )
    return path.replace(os.sep, "/")


def _uri(file: str) -> str:
    name = _relative(file)
    if os.path.isabs(name):
        return Path(file).as_uri()
    data = name.encode("utf-8", "surrogateescape")
    return "".join(chr(one) if chr(one) in _PLAIN else "%{:02X}".format(one) for one in data)


def to_sarif(documents: Sequence[dict[str, Any]]) -> str:
    """Return a SARIF log with one run: each entry is a result of the rule with its code."""
    entries = list(_located(documents))
    codes = sorted({found["code"] for _, found in entries})
    rules = [{"id": code, "shortDescription": {"text": declared(code).text}} for code in codes]
    results = []
    for link, found in entries:
        place = {
            "artifactLocation": {"uri": _uri(found["file"])},
            "region": {"startLine": found["line"], "startColumn": found["column"]},
        }
        logical = [{"name": link, "kind": "object"}] if link else []
        identity = "\0".join((_relative(found["file"]), link, found["code"])).encode(
            "utf-8", "surrogatepass"
        )
        results.append(
            {
                "ruleId": found["code"],
                "ruleIndex": codes.index(found["code"]),
                "level": found["severity"],
                "message": {"text": _text(link, found)},
                "locations": [{"physicalLocation": place, "logicalLocations": logical}],
                "partialFingerprints": {"fileLinkCode/v1": hashlib.sha256(identity).hexdigest()},
                "baselineState": "unchanged" if found.get("known") else "new",
                "properties": {
                    key: found.get(key) for key in ("stated", "geometry", "change", "certainty")
                },
            }
        )
    driver = {"name": "Body Moments", "rules": rules}
    is_read = not any(one["errors"] for one in documents)
    run = {
        "tool": {"driver": driver},
        "invocations": [{"executionSuccessful": is_read}],
        "columnKind": "unicodeCodePoints",
        "results": results,
        "properties": {
            "totals": [
                {
                    "file": _uri(str(one["file"])),
                    "total": one["total"],
                    "subtrees": {link["name"]: link["subtree"] for link in one["links"]},
                }
                for one in documents
            ]
        },
    }
    log = {"$schema": SARIF_SCHEMA, "version": "2.1.0", "runs": [run]}
    return json.dumps(log, ensure_ascii=False, indent=2, allow_nan=False) + "\n"


def to_github(documents: Sequence[dict[str, Any]]) -> str:
    """Return one workflow command a line for each entry that is not known, which GitHub shows at
    its line.
    """
    lines = [AUDIT_COMMANDS + "\n"]
    for link, found in _located(documents):
        if found.get("known"):
            continue
        title = "{} ({})".format(found["code"], link) if link else found["code"]
        values = {
            "file": _relative(found["file"]),
            "line": found["line"],
            "col": found["column"],
            "title": title,
        }
        properties = ",".join(
            "{}={}".format(key, _escape(str(value), True)) for key, value in values.items()
        )
        lines.append(
            "::{} {}::{}\n".format(
                _COMMANDS[found["severity"]], properties, _escape(_text(link, found))
            )
        )
    return "".join(lines)


def _escape(text: str, is_property: bool = False) -> str:
    for character, code in _ESCAPES + (_IN_PROPERTIES if is_property else ()):
        text = text.replace(character, code)
    return text
