# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the extension, with the manual in it, with the validator that Blender itself ships, as
plain Python.

    python extension.py OUTPUT      validates the repository's root and builds its zip into OUTPUT

The Python must be one that has the bpy module installed; Blender is not started.
"""

import importlib.util
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def _scripts() -> Path:
    """The folder of scripts of the installed bpy module."""
    found = importlib.util.find_spec("bpy")
    if found is None:
        raise SystemExit("This Python has no bpy module; use `python3 tests/project.py build`.")
    folder = Path(found.origin).parent
    return next(folder.glob("*.*/scripts"))


def run_validator(*arguments: str | Path) -> subprocess.CompletedProcess:
    """Call Blender's extension tool; output and errors are one text in `stdout`."""
    tool = _scripts() / "addons_core" / "bl_pkg" / "cli" / "blender_ext.py"
    return subprocess.run(
        [sys.executable, "-B", str(tool), *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        stdin=subprocess.DEVNULL,
        encoding="utf-8",
        errors="replace",
    )


def validate(path: Path) -> subprocess.CompletedProcess:
    """Validate a folder or a zip, with the tags that the platform knows."""
    tags = _scripts() / "modules" / "_bpy_internal" / "extensions" / "tags.py"
    return run_validator("validate", f"--valid-tags={tags}", path)


def build(source: Path, output: Path) -> Path:
    """Build the zip of a source folder, with the manual in it, into an output folder and return its
    path.
    """
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="body_moments_") as work:
        copy = Path(work) / "source"
        left_out = (".git", ".envs", "tests", "tools", "findings", "demo", "dist")
        shutil.copytree(source, copy, ignore=shutil.ignore_patterns(*left_out))
        manual = [sys.executable, "-P", str(Path(__file__).with_name("manual.py")), str(copy)]
        made = subprocess.run(manual, capture_output=True, encoding="utf-8", errors="replace")
        if made.returncode:
            raise RuntimeError(f"building the manual failed\n{made.stderr}")
        done = run_validator("build", "--source-dir", copy, "--output-dir", output)
    created = [line for line in done.stdout.splitlines() if line.startswith("created: ")]
    if done.returncode or not created:
        raise RuntimeError(f"building the extension failed\n{done.stdout}")
    return Path(created[0].split('"')[1])


def main() -> int:
    checked = validate(ROOT)
    if checked.returncode:
        print(checked.stdout, file=sys.stderr)
        return 1
    archive = build(ROOT, Path(sys.argv[1]))
    print(f"{archive.name}: {archive.stat().st_size} bytes, in {archive.parent}")
    return validate(archive).returncode


if __name__ == "__main__":
    sys.exit(main())
