# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What every test starts from.

The repository's root is the add-on, whatever its folder is called, so it is loaded here under the
one name that tests use: `from body_moments.core.moments import Moments`. Loading it imports no
Blender; `tests/core` passes without one. Helper modules beside the tests are imported as
`from tests.core.exact import ...`.

Blender reads and writes its user files in a temporary folder that is set before `bpy` can be
imported, so that no test sees or changes the configuration of the person who runs it.
"""

import atexit
import importlib.util
import json
import os
import shutil
import sys
import tempfile
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = "body_moments"


def _load_root() -> ModuleType:
    spec = importlib.util.spec_from_file_location(PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)])
    module = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = module
    spec.loader.exec_module(module)
    return module


def _name_tests() -> None:
    """Make `tests` this folder, not a package of that name that some distribution installed."""
    module = ModuleType("tests")
    module.__path__ = [str(ROOT / "tests")]
    sys.modules["tests"] = module


def _isolate_blender() -> None:
    if "bpy" in sys.modules:
        raise RuntimeError("bpy was imported before tests/conftest.py could give it a user folder")
    folder = tempfile.mkdtemp(prefix="body_moments_user_")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    for name in list(os.environ):
        if name.startswith("BLENDER_USER_") or name.startswith("BLENDER_SYSTEM_"):
            del os.environ[name]
    os.environ["BLENDER_USER_RESOURCES"] = folder


if PACKAGE not in sys.modules:
    _isolate_blender()
    _name_tests()
    _load_root()


def pytest_addoption(parser):
    parser.addoption("--result-file", help="write the outcome of the run there as JSON")


class _Counter:
    """Counts outcomes and writes them when the session is over.

    bpy 4.5 can crash while the interpreter shuts down, after pytest has finished, and the exit
    code is lost with it. The runner (tests/project.py) then reads this file, which is complete or
    absent.
    """

    def __init__(self, path: Path):
        self.path = path
        self.counts = dict.fromkeys(("passed", "failed", "skipped"), 0)

    def pytest_runtest_logreport(self, report):
        if report.when == "call" or report.outcome != "passed":
            self.counts[report.outcome] += 1

    def pytest_collectreport(self, report):
        if report.outcome != "passed":
            self.counts[report.outcome] += 1

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self, exitstatus):
        text = json.dumps({"exit": int(exitstatus), **self.counts})
        partial = self.path.with_suffix(".partial")
        partial.write_text(text, encoding="utf-8")
        partial.replace(self.path)


def pytest_configure(config):
    path = config.getoption("--result-file")
    if path:
        config.pluginmanager.register(_Counter(Path(path)))


@pytest.fixture(scope="session")
def root() -> Path:
    """The folder of the add-on."""
    return ROOT


@pytest.fixture(scope="session")
def registered():
    """The add-on, registered in this process's Blender until the tests are over."""
    pytest.importorskip("bpy")
    body_moments = sys.modules[PACKAGE]
    body_moments.register()
    yield body_moments
    body_moments.unregister()


@pytest.fixture
def scene(registered):
    """An empty scene of factory settings, with the add-on registered."""
    import bpy

    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    return bpy.context.scene


@pytest.fixture
def bare_scene():
    """An empty scene of factory settings; the add-on need not be registered."""
    bpy = pytest.importorskip("bpy")
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    return bpy.context.scene
