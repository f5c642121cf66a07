# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Report of an audit as JSON, as tables, as a page and as text.

A public contract, `body-moments-audit/1`.
"""

import html
import json
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ...measurement import counted, plain, table, visible
from ...verdict import Finding, Severity, sentence, severity
from ..audit import Audit
from ..entries import Entry, LinkAudit
from ..findings import INERTIAL_CENTER_OUTSIDE, INERTIAL_SPREAD_OUTSIDE
from ..stated import StatedInertial
from ..totals import Body
from .annotations import to_github, to_sarif
from .marker import AUDIT_COLUMNS as COLUMNS
from .marker import AUDIT_PAGE, AUDIT_TEXT
from .marker import AUDIT_SCHEMA as SCHEMA

RESTS_ON = (
    "What is said of the geometry rests on one assumption: the drawn shapes of a link hold all of "
    "its mass."
)
_UNCOUNTED = {
    "missing": "without inertial, not counted",
    "frames": "frames without mass",
    "impossible": "impossible inertial",
    "left_out": "no positive mass, not counted",
}
NONE_READ = "No file could be read, so nothing was audited."
_STYLE = (
    "body{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:75rem;"
    "color:#222;background:#fff}table{border-collapse:collapse;width:100%}"
    "th,td{text-align:left;vertical-align:top;padding:.35rem .6rem;border-bottom:1px solid #ddd}"
    ".error{color:#a40000;font-weight:600}.warning{color:#8a5a00;font-weight:600}"
    ".note{color:#555}td.number{text-align:right;font-variant-numeric:tabular-nums}"
)


def document(file: str, audit: Audit, repaired: str | None) -> dict[str, Any]:
    """Return the report document of one file. repaired: name of the repaired copy, None if there is
    none.
    """
    parents = {name: joint.parent or None for name, joint in audit.tree.above.items()}
    repairs = {id(link): _inertial(inertial) for link, inertial in audit.repairs()}
    links = [
        {
            "name": one.link.name,
            **_inertial(one.link.inertial),
            "from_shapes": one.link.from_shapes,
            "density": one.density,
            "colliders": None if one.colliders is None else one.colliders.as_record(),
            "line": one.link.place.line,
            "parent": parents.get(one.link.name),
            "subtree": _total(audit.totals.subtrees[one.link.name]),
            "findings": [_entry(entry, one, file) for entry in one.entries],
            "repaired": repairs.get(id(one.link)),
        }
        for one in audit.links
    ]
    form = audit.description.format
    robot = audit.description.name
    head = {"schema": SCHEMA, "file": file, "status": "ok", "format": form, "robot": robot}
    total = _total(audit.totals.whole) | {
        name: list(getattr(audit.totals, name)) for name in _UNCOUNTED
    }
    whole = {
        "total": total,
        "findings": [_entry(entry, None, file) for entry in audit.entries],
        "links": links,
        "errors": [],
    }
    return with_status(plain(head | {"repaired": repaired} | whole))


def _total(body: Body) -> dict[str, Any]:
    """Return the mass, the center and the inertia about it of several links as a record."""
    return {"mass": body.mass, "center_of_mass": body.center, "inertia": body.inertia}


def with_status(document: dict[str, Any]) -> dict[str, Any]:
    """Return the document of a readable file with the status of its findings: "ok" if all are notes
    or known.
    """
    counts = count_findings(document)
    return document | {"status": "findings" if counts["warnings"] + counts["errors"] else "ok"}


def count_findings(document: dict[str, Any]) -> dict[str, int]:
    """Return the counts of "links", and of findings that are not known, by severity: "notes" and so
    on.
    """
    found = [
        *document["errors"],
        *document["findings"],
        *(found for link in document["links"] for found in link["findings"]),
    ]
    levels = [one["severity"] for one in found if not one.get("known")]
    return {"links": len(document["links"])} | {
        str(level) + "s": levels.count(level) for level in Severity
    }


def failed_document(file: str, reason: Finding) -> dict[str, Any]:
    """Return the document of a file that could not be read."""
    head = {
        "schema": SCHEMA,
        "file": file,
        "status": "error",
        "format": None,
        "robot": None,
        "repaired": None,
        "total": None,
        "findings": [],
    }
    place = {
        "file": reason.values.get("source") or file,
        "line": reason.values.get("line", 1),
        "column": reason.values.get("column", 1),
    }
    return plain(head | {"links": [], "errors": [(_finding(reason) | place)]})


def _finding(one: Finding) -> dict[str, Any]:
    return {
        "code": one.code,
        "severity": str(severity(one)),
        "message": sentence(one),
        "values": dict(one.values),
    }


def _entry(one: Entry, link: LinkAudit | None, file: str) -> dict[str, Any]:
    """Return one fault as a record. file: of the description, which the place may differ from."""
    place = {"file": one.place.file or file, "line": one.place.line, "column": one.place.column}
    head = _finding(one.finding) | {"severity": str(one.severity), "message": one.message} | place
    compared = link if one.compares else None
    inertial = compared and compared.link.inertial
    reference = compared.reference if compared and compared.density else None
    geometry = reference.uniform(inertial.mass) if reference and inertial else None
    return head | {
        "reasons": [_finding(reason) for reason in one.reasons],
        "stated": compared and _inertial(inertial),
        "geometry": geometry and _inertial(geometry),
        "change": None if one.change is None else sentence(one.change),
        "certainty": one.certainty or None,
    }


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
        for reason in [*one["errors"], *one["findings"]]:
            yield [
                one["file"],
                "",
                *(reason[key] for key in ("severity", "code", "message")),
                "",
                "",
                "",
            ]
        for link in one["links"]:
            repaired = "false"
            if link["repaired"] is not None:
                repaired = "true" if one["repaired"] else "possible"
            shared = [link["mass"], link["density"], repaired]
            for found in link["findings"] or [{"severity": "", "code": "ok", "message": ""}]:
                yield [
                    one["file"],
                    link["name"],
                    *(found[key] for key in ("severity", "code", "message")),
                    *("" if value is None else value for value in shared),
                ]


def to_csv(documents: Sequence[dict[str, Any]]) -> str:
    """Return CSV with one row for each finding, and one for each link without any."""
    return "".join(table(COLUMNS, (dict(zip(COLUMNS, row)) for row in _table_rows(documents))))


def to_html(documents: Sequence[dict[str, Any]]) -> str:
    """Return a self-contained HTML page, without scripts or links to other files."""
    lines = [AUDIT_PAGE, '<html lang="en">', '<meta charset="utf-8">', "<title>Audit</title>"]
    lines += ["<style>{}</style>".format(_STYLE), "<h1>Audit of robot descriptions</h1>"]
    for one in documents:
        lines.append("<h2>{}</h2>".format(html.escape(str(one["file"]))))
        lines.append("<p>{}.</p>".format(_summary(one)))
        lines += [
            "<table>",
            "<tr><th>Link<th>Severity<th>Finding<th>Mass, kg<th>Density, kg/m³<th>Repair</tr>",
        ]
        for _, link, level, code, message, mass, density, repaired in _table_rows([one]):
            fine = "nothing to compare" if "" in (mass, density) else "agrees with its geometry"
            numbers = [
                "{:.6g}".format(value) if isinstance(value, float) else ""
                for value in (mass, density)
            ]
            cells = [
                "<td>{}".format(html.escape(str(link))),
                '<td class="{0}">{0}'.format(html.escape(level) or "ok"),
                '<td title="{}">{}'.format(html.escape(code), html.escape(message) or fine),
                *('<td class="number">{}'.format(text) for text in numbers),
                "<td>{}".format(
                    {"true": "repaired", "possible": "can be repaired"}.get(repaired, "")
                ),
            ]
            lines.append("<tr>{}</tr>".format("".join(cells)))
        lines.append("</table>")
        if one["total"]:
            lines += ["<table>", "<tr><th>Part<th>Mass, center, inertia about it</tr>"]
            lines += (
                "<tr>{}</tr>".format("".join(map("<td>{}".format, map(html.escape, row))))
                for row in _total_rows(one)
            )
            lines.append("</table>")
    lines += map("<p>{}</p>".format, _remarks(documents))
    return "\n".join([*lines, "</html>", ""])


def _summary(document: dict[str, Any]) -> str:
    if document["errors"]:
        return "not read"
    counts = count_findings(document)
    return ", ".join(counted(counts[one + "s"], one) for one in ("link", *map(str, Severity)))


def _total_rows(document: dict[str, Any]) -> list[tuple[str, str]]:
    """Return names and texts of the whole model, of its subtrees, and of links beside the total."""
    total = document["total"]
    parents = {link["parent"] for link in document["links"]}
    rows = [("total", _numbers(total))]
    for name, told in _UNCOUNTED.items():
        if total[name]:
            rows.append((told, ", ".join(total[name])))
    return rows + [
        ("subtree {}".format(link["name"]), _numbers(link["subtree"]))
        for link in document["links"]
        if link["name"] in parents
    ]


def _remarks(documents: Sequence[dict[str, Any]]) -> list[str]:
    """Return the sentences about the report as a whole."""
    if all(one["errors"] for one in documents):
        return [NONE_READ]
    of_geometry = {INERTIAL_CENTER_OUTSIDE, INERTIAL_SPREAD_OUTSIDE}
    entries = (found for one in documents for link in one["links"] for found in link["findings"])
    codes = {reason["code"] for found in entries for reason in (found, *found["reasons"])}
    return [RESTS_ON] if codes & of_geometry else []


def _numbers(inertial: dict[str, Any] | None) -> str:
    if inertial is None or inertial["mass"] is None:
        return "unknown"
    if inertial["inertia"] is None:
        return "mass {:.6g} kg, center and inertia unknown".format(inertial["mass"])
    center = " ".join(
        "-" if value is None else "{:.4g}".format(value) for value in inertial["center_of_mass"]
    )
    rows = inertial["inertia"]
    entries = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    tensor = " ".join(
        "-" if rows[i][j] is None else "{:.4g}".format(rows[i][j]) for i, j in entries
    )
    return "mass {:.6g} kg, center {} m, inertia {} kg·m²".format(inertial["mass"], center, tensor)


def to_text(documents: Sequence[dict[str, Any]]) -> str:
    """Return the findings as plain text, one after the other: place, severity, link, sentence, and
    the numbers.
    """
    lines = [AUDIT_TEXT]
    for one in documents:
        for reason in one["errors"]:
            lines.append("{file}:{line}:{column}: {severity}: {message}".format(**reason))
        for link in [{"name": "", "findings": one["findings"]}, *one["links"]]:
            for found in link["findings"]:
                head = "{file}:{line}:{column}: {severity}: ".format(**found)
                known = " (known)" if found.get("known") else ""
                lines.append(
                    "{}{}{} [{}]{}".format(
                        head,
                        link["name"] and link["name"] + ": ",
                        found["message"],
                        found["code"],
                        known,
                    )
                )
                if found["severity"] != Severity.NOTE and found["stated"] is not None:
                    lines.append("    stated: {}".format(_numbers(found["stated"])))
                    lines.append("    shapes: {}".format(_numbers(found["geometry"])))
                if found["change"] is not None:
                    lines.append("    change: {} ({})".format(found["change"], found["certainty"]))
        lines += map("{0[0]}: {0[1]}".format, _total_rows(one) if one["total"] else ())
        lines.append("{}: {}".format(one["file"], _summary(one)))
        if one["repaired"]:
            lines.append("repaired copy: {}".format(one["repaired"]))
        elif any(link["repaired"] for link in one["links"]):
            count = sum(link["repaired"] is not None for link in one["links"])
            lines.append("{} can be repaired (--repair)".format(counted(count, "link")))
    return "\n".join(map(visible, [*lines, *_remarks(documents), ""]))


def to_table(documents: Sequence[dict[str, Any]]) -> str:
    """Return one line for each file, in columns, and their totals."""
    rows: list[tuple[str, ...]] = [
        ("errors", "warnings", "notes", "links", "can be repaired", "mass, kg", "status", "file")
    ]
    totals = [0] * 5
    for one in documents:
        counts = count_findings(one)
        repairs = sum(link["repaired"] is not None for link in one["links"])
        numbers = [*(counts[key] for key in ("errors", "warnings", "notes", "links")), repairs]
        totals = [total + number for total, number in zip(totals, numbers)]
        texts = [*map(str, numbers[:3]), *("--" if one["errors"] else map(str, numbers[3:]))]
        mass = "{:.6g}".format(one["total"]["mass"]) if one["total"] else "-"
        rows.append((*texts, mass, one["status"], visible(str(one["file"]))))
    rows.append((*map(str, totals), "", "", counted(len(documents), "file")))
    widths = [max(map(len, column)) for column in zip(*rows)]
    lines = [
        "  ".join(map(str.rjust, row[:6], widths)) + "  {}  {}".format(row[6].ljust(8), row[7])
        for row in rows
    ]
    for one in documents:
        if one["total"]:
            told = _total_rows(one)
            wide = max(len(name) for name, _ in told)
            lines += ["", *(visible(name.ljust(wide) + "  " + text) for name, text in told)]
            lines[-len(told)] += "  " + visible(str(one["file"]))
    return "\n".join([AUDIT_TEXT, *lines, *_remarks(documents), ""])


FORMATS = {
    "json": to_json,
    "csv": to_csv,
    "html": to_html,
    "text": to_text,
    "table": to_table,
    "sarif": to_sarif,
    "github": to_github,
}
