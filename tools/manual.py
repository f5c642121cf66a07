# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the manual of the extension's zip: `docs/` and the docstrings of `core/`, by Sphinx
(docs/conf.py).

    python manual.py COPY      adds it to a copy of the add-on, whose README then leads into it

The Python needs tests/requirements-build.txt and numpy; Blender is not started.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
FOLDER = "manual"  # in the zip; `panels/menus.py` opens its pages
UNUSED = (".buildinfo", "objects.inv", "_static/**/*.map", "_static/**/*.LICENSE.txt")


def run_sphinx(source: Path, folder: Path) -> None:
    """Build pages; any warning, as of a broken link, is an error."""
    with tempfile.TemporaryDirectory() as cache:
        options = ["-q", "-W", "--keep-going", "-c", DOCS, "-d", cache]
        command = [sys.executable, "-P", "-m", "sphinx", *options, source, folder]
        done = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace")
    if done.returncode:
        raise RuntimeError(done.stderr)


def build(folder: Path) -> None:
    """Write the manual into a folder that is new or empty."""
    # another build may be at work there: only of packages that are gone
    for page in (DOCS / "api").glob("*.rst"):
        module = ROOT.joinpath(*page.stem.split(".")[1:])
        if not (module.is_dir() or module.with_suffix(".py").is_file()):
            page.unlink(missing_ok=True)
    run_sphinx(DOCS, folder)
    for pattern in UNUSED:
        for path in folder.glob(pattern):
            path.unlink()


def target(link: str) -> str:
    """Return the target of a link of README from the folder beside the manual."""
    path, hash_sign, place = link.partition("#")
    if not path:
        return link
    if path == "CHANGELOG.md":
        path = "docs/changes.md"
    path = re.sub(r"^docs/(.+)\.md$", r"\1.html", path)
    path = re.sub(r"^tests/window/pictures/", "_images/", path)
    return FOLDER + "/" + path + hash_sign + place


def readme() -> str:
    """Return README as it stands in the zip: its links lead into the manual."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return re.sub(r"\]\(([^)]+)\)", lambda match: "]({})".format(target(match[1])), text)


if __name__ == "__main__":
    copy = Path(sys.argv[1])
    shutil.rmtree(copy / FOLDER, ignore_errors=True)
    build(copy / FOLDER)
    (copy / "README.md").write_text(readme(), encoding="utf-8")
