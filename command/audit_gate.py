# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The findings of `audit` that count: without ignored codes, light links and those that a baseline
knows.
"""

import json
import os
from argparse import Namespace
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from ..core.files.whole_file import whole_file
from ..core.robots import AUDIT_TOTAL, audit_report
from ..core.verdict import Severity

SCHEMA = "body-moments-baseline/1"
FAILING = {"error": (Severity.ERROR,), "warning": (Severity.ERROR, Severity.WARNING), "never": ()}
Key = tuple[str, str, str]  # file, link and code


def apply(document: dict[str, Any], options: Namespace) -> dict[str, Any]:
    """Return the document of a file after `--ignore`, `--light-links` and `--baseline`."""
    whole = {"name": "", "mass": None, "findings": document["findings"]}
    known = {key for key in options.known or () if key[2] != AUDIT_TOTAL}
    links = []
    for link in [whole, *document["links"]]:
        is_light = (
            options.light_links and link["mass"] is not None and link["mass"] <= options.light_links
        )
        findings = [
            found
            | ({"severity": str(Severity.NOTE)} if is_light else {})
            | ({"known": True} if known and _key(found, link, options.baseline) in known else {})
            for found in link["findings"]
            if found["code"] not in options.ignore
        ]
        links.append(link | {"findings": findings})
    whole, *links = links
    return audit_report.with_status(document | {"findings": whole["findings"], "links": links})


def fails(documents: Iterable[dict[str, Any]], level: str) -> bool:
    """Return whether a file could not be read, or has a finding of this level or above that is not
    known.
    """
    counted = [str(severity) + "s" for severity in FAILING[level]]
    return any(
        one["errors"] or any(audit_report.count_findings(one)[name] for name in counted)
        for one in documents
    )


def read_baseline(path: Path) -> set[Key]:
    """Return the known findings of a file. Raises OSError, or ValueError if it is no baseline."""
    data = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(data, dict) or data.get("schema") != SCHEMA:
        raise ValueError("it is no baseline of this command. Write one with --write-baseline")
    try:
        return {(one["file"], one["link"], one["code"]) for one in data["findings"]}
    except (KeyError, TypeError) as error:
        raise ValueError("its findings are damaged. Write it anew with --write-baseline") from error


def write_baseline(path: Path, documents: Sequence[dict[str, Any]]) -> None:
    """Write all findings but notes and expectations, with files relative to the baseline's folder.

    Raises OSError.
    """
    links = [
        link
        for one in documents
        for link in [{"name": "", "findings": one["findings"]}, *one["links"]]
    ]
    told = [
        (found, link)
        for link in links
        for found in link["findings"]
        if found["severity"] != Severity.NOTE and found["code"] != AUDIT_TOTAL
    ]
    findings = [
        dict(zip(("file", "link", "code"), key))
        for key in sorted({_key(*one, path) for one in told})
    ]
    text = json.dumps({"schema": SCHEMA, "findings": findings}, ensure_ascii=False, indent=1)
    with whole_file(path) as file:
        file.write((text + "\n").encode("utf-8", "backslashreplace"))


def _key(found: dict[str, Any], link: dict[str, Any], baseline: Path) -> Key:
    folder = os.path.dirname(os.path.abspath(baseline))
    try:
        file = os.path.relpath(found["file"], folder)
    except ValueError:  # another drive
        file = found["file"]
    return file.replace(os.sep, "/"), link["name"], found["code"]
