# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Documents as one HTML file that needs no network: a table of all bodies to sort and to filter,
with pictures.

Standard library only. Everything that comes from files is escaped, and the page's security policy
allows no script but its own.
"""

from __future__ import annotations

import base64
import hashlib
import html
import math
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from datetime import UTC, datetime
from itertools import combinations
from typing import Any

from .documents import bound_of, count_findings, radius_of_gyration
from .plain_text import counted, visible

_PICTURE = re.compile(r"data:image/png;base64,[A-Za-z0-9+/=]+")
_COLUMNS = (
    *(("picture", ""), ("file", "File"), ("name", "Name"), ("status", "Status")),
    *(("verdict", "Verdict"), ("method", "Method")),
    *(
        ("mass", "Mass, kg"),
        ("volume", "Volume, m³"),
        ("area", "Area, m²"),
        ("size", "Gyration, m"),
    ),
    *(("bound", "Bound, of volume"), ("remarks", "Remarks")),
)
_NUMERIC = {"mass", "volume", "area", "size", "bound"}
_STYLE = """
:root{color-scheme:light dark}
body{font:14px/1.4 system-ui,sans-serif;margin:1.5rem}
h1{font-size:1.3rem;margin:0 0 .3rem}
p{margin:.3rem 0}
input,select{font:inherit;padding:.2rem .4rem;margin-right:.5rem}
table{border-collapse:collapse;margin-top:1rem;width:100%}
th,td{text-align:left;vertical-align:top;padding:.3rem .6rem}
th,td{border-bottom:1px solid #8884;overflow-wrap:anywhere}
th{white-space:nowrap;position:sticky;top:0;background:Canvas}
th button{font:inherit;font-weight:600;border:0;background:none;color:inherit}
th button{padding:0;cursor:pointer}
th[aria-sort=ascending] button::after{content:" \\25b2"}
th[aria-sort=descending] button::after{content:" \\25bc"}
td.number{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
td{min-width:4rem}td:nth-child(2){min-width:9rem}
td img,td svg{width:96px;height:96px;display:block}
td svg.curve{width:240px;height:150px}
.crashed,.timeout,.memory,.error,.missing,.unsupported_version{color:#c33;font-weight:600}
.warning{color:#a60}
"""
_SCRIPT = """
"use strict";
const body=document.querySelector("tbody"),rows=[...body.rows];
const count=document.getElementById("count");
const text=document.getElementById("text"),status=document.getElementById("status");
function filter(){
  const words=text.value.toLowerCase().split(/\\s+/).filter(Boolean);let shown=0;
  for(const row of rows){
    const has=words.every(word=>row.dataset.text.includes(word));
    const hidden=!has||status.value&&row.dataset.status!==status.value;
    row.hidden=hidden;if(!hidden)shown++;
  }
  count.textContent=shown+" of "+rows.length;
}
function sort(head,index){
  const down=head.getAttribute("aria-sort")==="ascending";
  for(const other of head.parentNode.cells)other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort",down?"descending":"ascending");
  const number=head.dataset.kind==="number",sign=down?-1:1;
  const key=row=>row.cells[index].dataset.key;
  rows.sort((a,b)=>{
    const x=key(a),y=key(b);
    if(number){
      if(x===""||y==="")return (x==="")-(y==="");
      return sign*(Number(x)-Number(y));
    }
    return sign*x.localeCompare(y,undefined,{numeric:true});
  });
  body.append(...rows);
}
document.querySelectorAll("th").forEach((head,index)=>{
  const button=head.querySelector("button");
  if(button)button.addEventListener("click",()=>sort(head,index));
});
text.addEventListener("input",filter);status.addEventListener("change",filter);filter();
"""


def to_html(documents: Iterable[dict[str, Any]]) -> Iterator[str]:
    """Yield the HTML page in pieces; `documents` is iterated twice."""
    statuses: Counter[str] = Counter()
    origins: Counter[str] = Counter()
    codes: Counter[tuple[str, str]] = Counter()
    for document in documents:
        statuses[document["status"]] += 1
        origins[_origin(document)] += 1
        codes += count_findings(document)
    digest = base64.b64encode(hashlib.sha256(_SCRIPT.encode()).digest()).decode()
    policy = (
        "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'sha256-{}'"
    ).format(digest)
    yield "<!doctype html><!-- Body Moments: report -->\n"
    yield '<html lang="en"><head><meta charset="utf-8">\n'
    yield '<meta http-equiv="Content-Security-Policy" content="{}">\n'.format(policy)
    yield "<title>Body Moments</title><style>{}</style></head><body>\n".format(_STYLE)
    counts = ", ".join("{} {}".format(number, status) for status, number in statuses.most_common())
    yield "<h1>Body Moments</h1><p>{}: {}. All numbers are SI.</p>\n".format(
        counted(statuses.total(), "file"), counts or "-"
    )
    yield "<p>{:%Y-%m-%d %H:%M} UTC</p>\n".format(datetime.now(UTC))
    yield from (
        "<p>{}: {}</p>\n".format(counted(number, "file"), html.escape(visible(origin)))
        for origin, number in origins.items()
    )
    yield "<details><summary>{}</summary><ul>\n".format(counted(len(codes), "finding"))
    yield from (
        '<li class="{0}">{2} × {1} ({0})</li>\n'.format(
            html.escape(level), html.escape(visible(code)), number
        )
        for (level, code), number in codes.most_common()
    )
    yield "</ul></details>\n"
    yield '<p><input id="text" type="search" placeholder="Filter" aria-label="Filter">'
    yield '<select id="status" aria-label="Status"><option value="">All statuses</option>'
    yield from ("<option>{}</option>".format(html.escape(status)) for status in sorted(statuses))
    yield '</select><span id="count"></span></p>\n<table><thead><tr>'
    for name, title in _COLUMNS:
        kind = ' data-kind="number"' if name in _NUMERIC else ""
        yield "<th{}>{}</th>".format(kind, "<button>{}</button>".format(title) if title else "")
    yield "</tr></thead><tbody>\n"
    for document in documents:
        yield from _table_rows(document)
    yield "</tbody></table><script>{}</script></body></html>\n".format(_SCRIPT)


def _origin(document: dict[str, Any]) -> str:
    """Return the versions and the options with which a document was made."""
    run = document.get("run", {})
    words = [
        name if value is True else "{} {}".format(name, value)
        for name, value in run.get("options", {}).items()
    ]
    versions = "Blender {}, Body Moments {}".format(
        document["blender"] or "-", run.get("addon", "-")
    )
    return "; ".join([versions, " ".join(words) or "no options"])


def _table_rows(document: dict[str, Any]) -> Iterator[str]:
    """Yield the HTML of a document's rows: bodies, flat shapes, then errors."""
    file = document["file"] or ""
    status = document["status"]
    for entry in document["objects"]:
        bound = bound_of(entry, "volume")
        volume = entry["volume"]
        values = {
            "mass": entry["mass"],
            "volume": volume,
            "area": entry["area"],
            "size": radius_of_gyration(entry),
        }
        values["bound"] = bound / abs(volume) if bound is not None and volume else None
        methods = entry.get("verdict", ""), entry["method"]
        picture = _picture(entry) + _plots(entry)
        yield _row(picture, file, entry["name"], status, methods, values, _remarks(entry))
    for entry in document.get("flat", ()):
        yield _row(
            "", file, entry["name"], status, ("", "flat"), {"area": entry["area"]}, _remarks(entry)
        )
    for error in document["errors"]:
        yield _row(
            "", file, error["name"] or "", status, ("", ""), {}, [("error", error["reason"])]
        )


def _plots(entry: dict[str, Any]) -> str:
    """Return HTML of the righting arms over the angles of heel, and of the volumes over the levels
    of a liquid; empty without them.
    """
    curve = (entry.get("floating") or {}).get("gz") or {}
    angles = [math.degrees(angle) for angle in curve.get("angles", ())]
    table = ((entry.get("below") or {}).get("contents") or {}).get("table") or {}
    return _plot("GZ", "m", "°", angles, curve.get("arms", ())) + _plot(
        "Volume over level", "m³", " m", table.get("levels", ()), table.get("volumes", ())
    )


def _plot(
    name: str, unit: str, across: str, places: Sequence[float], heights: Sequence[float]
) -> str:
    """Return HTML of a curve; across: the unit of the places along X."""
    points = [
        (place, height)
        for place, height in zip(places, heights)
        if isinstance(place, float) and isinstance(height, float)
    ]
    if len(points) < 2:
        return ""
    first, last = points[0][0], points[-1][0]
    low = min(0.0, *(height for _, height in points))
    high = max(0.0, *(height for _, height in points))

    def corner(place: float, height: float) -> str:
        x = 200.0 * (place - first) / (last - first or 1.0)
        return "{:.2f},{:.2f}".format(x, 100.0 * (high - height) / (high - low or 1.0))

    label = '<text x="{}" y="{}" font-size="12" fill="currentColor"{}>{}</text>'
    labels = (
        label.format(0, -6, "", "{}, {:.3g} to {:.3g} {}".format(name, low, high, unit)),
        label.format(0, 116, "", "{:.4g}{}".format(first, across)),
        label.format(200, 116, ' text-anchor="end"', "{:.4g}{}".format(last, across)),
    )
    axis = '<path d="M{}L{}" stroke="#888"/>'.format(corner(first, 0.0), corner(last, 0.0))
    line = '<path d="M{}" fill="none" stroke="#4860d6" stroke-width="2"/>'.format(
        "L".join(corner(*point) for point in points)
    )
    head = '<svg class="curve" viewBox="-10 -20 220 145" role="img" aria-label="{}">'
    return "".join([head.format(name), axis, line, *labels, "</svg>"])


def _remarks(entry: dict[str, Any]) -> list[tuple[str, str]]:
    """Return the class and the text of each warning and note of a record."""
    return [("warning", text) for text in entry["warnings"]] + [
        ("", text) for text in entry["notes"]
    ]


def _row(
    picture: str,
    file: str,
    name: str,
    status: str,
    methods: tuple[str, str],
    values: dict[str, float | None],
    remarks: Sequence[tuple[str, str]],
) -> str:
    """Return a row of the table. methods: verdict and method. remarks: class and text of each."""
    words = " ".join([file, name, *methods, status, *(text for _, text in remarks)]).lower()
    cells = ["<td>{}</td>".format(picture)]
    for text, kind in ((file, ""), (name, ""), (status, status), *((text, "") for text in methods)):
        escaped = html.escape(visible(text))
        cells.append(
            '<td class="{}" data-key="{}">{}</td>'.format(html.escape(kind), escaped, escaped)
        )
    for column in ("mass", "volume", "area", "size", "bound"):
        value = values.get(column)
        key, number = ("", "") if value is None else (repr(value), "{:.6g}".format(value))
        cells.append('<td class="number" data-key="{}">{}</td>'.format(key, number))
    paragraphs = "".join(
        '<p class="{}">{}</p>'.format(kind, html.escape(visible(text))) for kind, text in remarks
    )
    cells.append('<td data-key="{}">{}</td>'.format(len(remarks), paragraphs))
    head = '<tr data-status="{}" data-text="{}">'.format(
        html.escape(status), html.escape(visible(words))
    )
    return head + "".join(cells) + "</tr>\n"


def _picture(entry: dict[str, Any]) -> str:
    """Return HTML of the record's thumbnail, else of the box of equal inertia with its axes; empty
    without mass.
    """
    thumbnail = entry.get("thumbnail")
    if isinstance(thumbnail, str) and _PICTURE.fullmatch(thumbnail):
        return '<img alt="" src="{}">'.format(thumbnail)
    mass = entry["mass"]
    moments = entry["principal_moments"]
    axes = entry["principal_axes"]
    if radius_of_gyration(entry) is None or not axes or None in sum(axes, []):
        return ""
    # The half sides of the box: half - moment is ∫ x² dm, which is mass side² / 12.
    half = sum(moments) / 2.0
    sides = [math.sqrt(max(6.0 * (half - moment) / mass, 0.0)) / 2.0 for moment in moments]
    scale = 40.0 / (max(sides) * 1.8 or 1.0)
    columns = [[row[number] for row in axes] for number in range(3)]

    def flat(point: Sequence[float]) -> str:
        """Return the place in the picture, seen from above and the side."""
        x, y, z = point
        return "{:.2f},{:.2f}".format(0.8 * x - 0.6 * y, -(0.36 * x + 0.48 * y + 0.8 * z))

    def along(*factors: float) -> list[float]:
        """Return a point of the box, in half sides from its middle."""
        return [
            sum(f * s * column[i] for f, s, column in zip(factors, sides, columns)) * scale
            for i in range(3)
        ]

    corners = {(a, b, c): flat(along(a, b, c)) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)}
    edges = [pair for pair in combinations(corners, 2) if sum(a != b for a, b in zip(*pair)) == 1]
    lines = ["M{}L{}".format(corners[one], corners[other]) for one, other in edges]
    paths = '<path d="{}" fill="none" stroke="#888"/>'.format("".join(lines))
    for column, color in zip(columns, ("#d64040", "#48a048", "#4860d6")):
        end = [42.0 * value for value in column]
        paths += '<path d="M{}L{}" stroke="{}" stroke-width="2"/>'.format(
            flat([-v for v in end]), flat(end), color
        )
    return '<svg viewBox="-50 -50 100 100">{}</svg>'.format(paths)
