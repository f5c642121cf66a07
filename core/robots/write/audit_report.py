# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Report of an audit as JSON, as a table and as a page.

A public contract, `body-moments-audit/1`.
"""

from __future__ import annotations

import html
import json
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ...measurement.documents import plain, table
from ...measurement.plain_text import counted
from ...verdict.finding import Finding, Severity
from ...verdict.sentences import sentence, severity
from ..audit import Audit
from ..stated import StatedInertial
from .marker import AUDIT_COLUMNS as COLUMNS
from .marker import AUDIT_PAGE
from .marker import AUDIT_SCHEMA as SCHEMA

_STYLE = (
    "body{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:75rem;color:#222;background:#fff}"
    "table{border-collapse:collapse;width:100%}th,td{text-align:left;vertical-align:top;padding:.35rem .6rem;"
    "border-bottom:1px solid #ddd}.error{color:#a40000;font-weight:600}.warning{color:#8a5a00;font-weight:600}"
    ".note{color:#555}td.number{text-align:right;font-variant-numeric:tabular-nums}"
)


def document(file: str, audit: Audit, repaired: str | None) -> dict[str, Any]:
    """Return the report document of one file. repaired: name of the repaired copy, None if there is none."""
    links = [
        {
            "name": one.link.name,
            **_inertial(one.link.inertial),
            "density": one.density,
            "findings": [_finding(found) for found in one.findings],
            "repaired": None if one.repaired is None else _inertial(one.repaired),
        }
        for one in audit.links
    ]
    levels = {one["severity"] for link in links for one in link["findings"]}
    status = "ok" if not levels & {Severity.ERROR, Severity.WARNING} else "findings"
    form, robot = audit.description.format, audit.description.name
    head = {"schema": SCHEMA, "file": file, "status": status, "format": form, "robot": robot}
    return plain({**head, "repaired": repaired, "links": links, "errors": []})


def count_findings(document: dict[str, Any]) -> dict[str, int]:
    """Return the counts of "links", and of findings by severity: "notes", "warnings" and "errors"."""
    levels = [found["severity"] for link in document["links"] for found in link["findings"]]
    return {"links": len(document["links"]), **{str(level) + "s": levels.count(level) for level in Severity}}


def failed_document(file: str, reason: Finding) -> dict[str, Any]:
    """Return the document of a file that could not be read."""
    head = {"schema": SCHEMA, "file": file, "status": "error", "format": None, "robot": None, "repaired": None}
    return plain({**head, "links": [], "errors": [_finding(reason)]})


def _finding(one: Finding) -> dict[str, Any]:
    return {"code": one.code, "severity": str(severity(one)), "message": sentence(one), "values": dict(one.values)}


def _inertial(inertial: StatedInertial | None) -> dict[str, Any]:
    if inertial is None:
        return {"mass": None, "center_of_mass": None, "inertia": None}
    tensor = inertial.inertia / 2.0 + inertial.inertia.T / 2.0
    return {"mass": inertial.mass, "center_of_mass": inertial.center, "inertia": np.asarray(tensor)}


def to_json(documents: Sequence[dict[str, Any]]) -> str:
    """Return the documents as JSON: a single one by itself, else a list."""
    shown = documents[0] if len(documents) == 1 else list(documents)
    return json.dumps(shown, ensure_ascii=False, indent=2, allow_nan=False) + "\n"


def _table_rows(documents: Iterable[dict[str, Any]]) -> Iterable[list[Any]]:
    for one in documents:
        for reason in one["errors"]:
            yield [one["file"], "", *(reason[key] for key in ("severity", "code", "message")), "", "", ""]
        for link in one["links"]:
            shared = [link["mass"], link["density"], "true" if link["repaired"] else "false"]
            for found in link["findings"] or [{"severity": "", "code": "ok", "message": ""}]:
                yield [
                    one["file"], link["name"], *(found[key] for key in ("severity", "code", "message")),
                    *("" if value is None else value for value in shared),
                ]  # fmt: skip


def to_csv(documents: Sequence[dict[str, Any]]) -> str:
    """Return CSV with one row for each finding, and one for each link without any."""
    return "".join(table(COLUMNS, (dict(zip(COLUMNS, row)) for row in _table_rows(documents))))


def to_html(documents: Sequence[dict[str, Any]]) -> str:
    """Return a self-contained HTML page, without scripts or links to other files."""
    lines = [AUDIT_PAGE, '<html lang="en">', '<meta charset="utf-8">', "<title>Audit</title>"]
    lines += ["<style>{}</style>".format(_STYLE), "<h1>Audit of robot descriptions</h1>"]
    for one in documents:
        lines.append("<h2>{}</h2>".format(html.escape(str(one["file"]))))
        counts = count_findings(one)
        summary = ", ".join(counted(counts[level + "s"], level) for level in map(str, Severity))
        lines.append("<p>{}: {}.</p>".format(counted(counts["links"], "link"), summary))
        lines += ["<table>", "<tr><th>Link<th>Severity<th>Finding<th>Mass, kg<th>Density, kg/m³<th>Repaired</tr>"]
        for _, link, level, code, message, mass, density, repaired in _table_rows([one]):
            fine = "nothing to compare" if "" in (mass, density) else "agrees with its geometry"
            numbers = ["{:.6g}".format(value) if isinstance(value, float) else "" for value in (mass, density)]
            cells = [
                "<td>{}".format(html.escape(str(link))),
                '<td class="{0}">{0}'.format(html.escape(level) or "ok"),
                '<td title="{}">{}'.format(html.escape(code), html.escape(message) or fine),
                *('<td class="number">{}'.format(text) for text in numbers),
                "<td>{}".format("yes" if repaired == "true" else ""),
            ]
            lines.append("<tr>{}</tr>".format("".join(cells)))
        lines.append("</table>")
    return "\n".join([*lines, "</html>", ""])


def to_text(document: dict[str, Any]) -> str:
    """Return one file's findings as plain text, link by link."""
    lines = ["{} ({})".format(document["file"], document["format"]), ""]
    for link in document["links"]:
        lines.append(link["name"])
        for found in link["findings"]:
            lines.append("    {}: {}".format(found["severity"], found["message"]))
        if not link["findings"]:
            lines.append("    -")
    if document["repaired"]:
        lines += ["", document["repaired"]]
    return "\n".join([*lines, ""])


FORMATS = {"json": to_json, "csv": to_csv, "html": to_html}
