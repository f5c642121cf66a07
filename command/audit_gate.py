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
    """Return the document of a file after `--ignore`, `--light-links` and `--baseline`.

    Findings about the whole model are treated as those of a link without name and mass.
    """
    model_entry = {"name": "", "mass": None, "findings": document["findings"]}
    known_keys = {key for key in options.known or () if key[2] != AUDIT_TOTAL}
    links = []
    for link in [model_entry, *document["links"]]:
        is_light = (
            options.light_links and link["mass"] is not None and link["mass"] <= options.light_links
        )
        findings = [
            record
            | ({"severity": str(Severity.NOTE)} if is_light else {})
            | (
                {"known": True}
                if known_keys and _key(record, link, options.baseline) in known_keys
                else {}
            )
            for record in link["findings"]
            if record["code"] not in options.ignore
        ]
        links.append(link | {"findings": findings})
    model_entry, *links = links
    return audit_report.with_status(
        document | {"findings": model_entry["findings"], "links": links}
    )


def fails(documents: Iterable[dict[str, Any]], level: str) -> bool:
    """Return whether a file could not be read, or has a finding of this level or above that is not
    known.
    """
    counted = [str(severity) + "s" for severity in FAILING[level]]
    return any(
        document["errors"] or any(audit_report.count_findings(document)[name] for name in counted)
        for document in documents
    )


def read_baseline(path: Path) -> set[Key]:
    """Return the known findings of a file. Raises OSError, or ValueError if it is no baseline."""
    data = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(data, dict) or data.get("schema") != SCHEMA:
        raise ValueError("it is no baseline of this command. Write one with --write-baseline")
    try:
        return {(entry["file"], entry["link"], entry["code"]) for entry in data["findings"]}
    except (KeyError, TypeError) as error:
        raise ValueError("its findings are damaged. Write it anew with --write-baseline") from error


def write_baseline(path: Path, documents: Sequence[dict[str, Any]]) -> None:
    """Write all findings but notes and expectations, with files relative to the baseline's folder.

    Raises OSError.
    """
    links = [
        link
        for document in documents
        for link in [{"name": "", "findings": document["findings"]}, *document["links"]]
    ]
    counted_findings = [
        (record, link)
        for link in links
        for record in link["findings"]
        if record["severity"] != Severity.NOTE and record["code"] != AUDIT_TOTAL
    ]
    findings = [
        dict(zip(("file", "link", "code"), key))
        for key in sorted({_key(record, link, path) for record, link in counted_findings})
    ]
    text = json.dumps({"schema": SCHEMA, "findings": findings}, ensure_ascii=False, indent=1)
    with whole_file(path) as file:
        file.write((text + "\n").encode("utf-8", "backslashreplace"))


def _key(record: dict[str, Any], link: dict[str, Any], baseline: Path) -> Key:
    """Return the key of a link's finding. baseline: the file from whose folder names start."""
    folder = os.path.dirname(os.path.abspath(baseline))
    try:
        file = os.path.relpath(record["file"], folder)
    except ValueError:  # another drive
        file = record["file"]
    return file.replace(os.sep, "/"), link["name"], record["code"]
