# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The manifest and the built zip, judged by Blender's own validator and by what they must hold."""

import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path, PurePosixPath

import pytest

from tests.package.modules import WINGS
from tools import extension

ROOT = Path(__file__).resolve().parent.parent.parent


@pytest.fixture(scope="module")
def manifest() -> dict:
    return tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def littered(tmp_path_factory) -> Path:
    """A copy of the project with everything beside it that work on it leaves behind."""
    folder = tmp_path_factory.mktemp("littered") / "a folder of another name"
    names = shutil.ignore_patterns(".git", ".envs", "__pycache__", "demo", "dist", "artefacts")
    shutil.copytree(ROOT, folder, ignore=names)
    for litter in (
        ".git/config",
        ".github/workflows/test.yml",
        ".envs/blender-5.2/complete",
        ".venv/lib/module.py",
        ".DS_Store",
        ".hypothesis/x",
        "__pycache__/__init__.cpython-313.pyc",
        "core/__pycache__/moments.cpython-313.pyc",
        "core/moments.pyc",
        "demo/measure.json",
        "dist/body_moments-0.0.9.zip",
        "docs/panel.png",
        "scene.blend1",
        "old.zip",
    ):
        path = folder / litter
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("litter", encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def archive(littered, tmp_path_factory) -> Path:
    return extension.build(littered, tmp_path_factory.mktemp("dist"))


def test_the_manifest_passes_blenders_validator():
    done = extension.validate(ROOT)
    assert done.returncode == 0, done.stdout


def test_the_zip_passes_blenders_validator(archive):
    done = extension.validate(archive)
    assert done.returncode == 0, done.stdout


def test_manifest_meets_the_platform_requirements(manifest):
    assert manifest["id"] == "body_moments"
    assert manifest["type"] == "add-on"
    assert "blender" not in manifest["name"].lower()
    assert set(manifest["tags"]) == {"Physics", "Object", "Mesh"}
    assert manifest["blender_version_min"] == "4.5.0"
    assert manifest["license"] == ["SPDX:GPL-3.0-or-later"]
    assert set(manifest["permissions"]) == {"files", "clipboard"}
    for sentence in (manifest["tagline"], *manifest["permissions"].values()):
        assert 0 < len(sentence) <= 64
        assert sentence[-1].isalnum() or sentence[-1] in ")]}"
    assert [part.isdigit() for part in manifest["version"].split(".")] == [True] * 3


def test_the_zip_holds_the_add_on_and_nothing_else(archive):
    with zipfile.ZipFile(archive) as opened:
        assert opened.testzip() is None and archive.stat().st_size < 8e6
        names = {name for name in opened.namelist() if not name.endswith("/")}
    top = {"__init__.py", "blender_manifest.toml", "LICENSE", "README.md"}
    expected = {
        path.relative_to(ROOT).as_posix()
        for part in (*WINGS, "locale")
        for path in (ROOT / part).rglob("*")
        if path.is_file() and path.suffix != ".pyc"
    }
    manual = {name for name in names if name.startswith("manual/")}
    assert names - manual == top | expected
    pictures = {".png", ".webp", ".gif", ".svg"}  # .png is Sphinx's own
    assert {PurePosixPath(name).suffix for name in manual} - pictures == {
        ".html",
        ".json",
        ".cff",
        ".js",
        ".css",
    }
    assert {PurePosixPath(name).suffix for name in expected} == {".py", ".pyi", ".po"}


def test_the_licence_is_the_whole_gpl_3():
    text = (ROOT / "LICENSE").read_text(encoding="utf-8")
    assert "GNU GENERAL PUBLIC LICENSE" in text
    assert "Version 3, 29 June 2007" in text
    assert "END OF TERMS AND CONDITIONS" in text


def test_the_zip_installs_works_and_leaves_cleanly(archive, tmp_path):
    """A person's way, in a Blender of its own with an empty user folder; see installed.py."""
    script = Path(__file__).with_name("installed.py")
    done = subprocess.run(
        [sys.executable, "-P", str(script), str(archive), str(tmp_path / "user")],
        capture_output=True,
        encoding="utf-8",
        errors="replace",
        timeout=1200,
    )
    assert done.returncode == 0, f"{done.stdout}\n{done.stderr}"
    # the command keeps the standard output for results
    assert "all steps passed" in done.stdout + done.stderr
