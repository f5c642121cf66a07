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
import random
import re
import shutil
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parent.parent
CI = os.environ.get("CI", "").lower() in ("1", "true", "yes")
PACKAGE = "body_moments"


def _load_root() -> ModuleType:
    spec = importlib.util.spec_from_file_location(
        PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = module
    spec.loader.exec_module(module)
    return module


def _name_tests() -> None:
    """Make `tests` and `tools` our folders, not packages that some distribution installed."""
    for name in ("tests", "tools"):
        sys.modules[name] = ModuleType(name)
        sys.modules[name].__path__ = [str(ROOT / name)]


def _isolate_blender() -> None:
    if "bpy" in sys.modules:
        raise RuntimeError("bpy was imported before tests/conftest.py could give it a user folder")
    folder = tempfile.mkdtemp(prefix="body_moments_user_")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    for name in list(os.environ):
        if name.startswith("BLENDER_USER_") or name.startswith("BLENDER_SYSTEM_"):
            del os.environ[name]
    os.environ["BLENDER_USER_RESOURCES"] = folder


def _drop_hidden_tolerances() -> None:
    """Let pytest.approx and np.allclose have an absolute tolerance only where it is written down.

    Theirs is 1e-12 and 1e-8 for whoever says nothing: beside it a volume of 1e-18 m³ equals any
    other.
    """
    import numpy as np

    approx, allclose, isclose = pytest.approx, np.allclose, np.isclose

    def approx_relative(expected, rel=None, abs=None, nan_ok=False):
        if abs is None:
            rel, abs = 1e-6 if rel is None else rel, 0.0
        return approx(expected, rel=rel, abs=abs, nan_ok=nan_ok)

    def allclose_relative(found, truth, rtol=1e-5, atol=0.0, equal_nan=False):
        return allclose(found, truth, rtol=rtol, atol=atol, equal_nan=equal_nan)

    def isclose_relative(found, truth, rtol=1e-5, atol=0.0, equal_nan=False):
        return isclose(found, truth, rtol=rtol, atol=atol, equal_nan=equal_nan)

    pytest.approx, np.allclose, np.isclose = approx_relative, allclose_relative, isclose_relative


if PACKAGE not in sys.modules:
    _isolate_blender()
    _name_tests()
    _load_root()
    _drop_hidden_tolerances()

from tests.may_skip import MAY_SKIP


def pytest_addoption(parser):
    parser.addoption("--result-file", help="write the outcome of the run there as JSON")
    parser.addoption(
        "--seed",
        type=int,
        help="run files, and tests within a file, in the random order of this seed",
    )
    parser.addoption(
        "--rewrite",
        action="store_true",
        help="keep what the fixture `kept` is given instead of comparing",
    )


def pytest_collection_modifyitems(config, items):
    seed = config.getoption("--seed")
    if seed is not None:
        draw = random.Random(seed)
        files = {}
        for item in items:
            files.setdefault(item.path, []).append(item)
        order = list(files.values())
        draw.shuffle(order)
        for tests in order:
            draw.shuffle(tests)
        items[:] = [item for tests in order for item in tests]


class _Progress:
    """Prints a line for each file that is over, and writes the outcome when the session is.

    bpy 4.5 can crash while the interpreter shuts down, after pytest has finished, and the exit
    code is lost with it. The runner (tests/project.py) then reads this file, which is complete or
    absent.
    """

    def __init__(self, config: pytest.Config, path: Path):
        self.config, self.path = config, path
        self.counts = dict.fromkeys(("passed", "failed", "skipped"), 0)
        self.left_out = Counter()
        self.failures = []
        self.left, self.total, self.done = Counter(), 0, 0

    def print(self, text: str) -> None:
        self.config.pluginmanager.getplugin("terminalreporter").write_line(text)

    def count(self, report: pytest.TestReport | pytest.CollectReport) -> None:
        self.counts[report.outcome] += 1
        if report.skipped:
            self.left_out[_skip_reason(report).partition(":")[0]] += 1

    def pytest_collection_finish(self, session):
        self.left = Counter(item.path for item in session.items)
        self.sizes, self.total, self.started = dict(self.left), len(session.items), time.monotonic()
        self.print("{} tests in {} files".format(self.total, len(self.left)))

    @pytest.hookimpl(tryfirst=True)
    def pytest_report_teststatus(self, report):
        """No letters: lines for files, and for failures as they happen."""
        if report.outcome == "failed" and report.when != "call":
            return "error", "", "ERROR"
        if report.outcome != "passed":
            return report.outcome, "", report.outcome.upper()
        return report.outcome if report.when == "call" else "", "", ""

    def pytest_runtest_logreport(self, report):
        if report.when == "call" or report.outcome != "passed":
            self.count(report)
        if report.outcome == "failed":
            self.failures.append(report.nodeid)
            self.print("FAILED {}".format(report.nodeid))

    def pytest_runtest_protocol(self, item):
        self.path_now = item.path

    def pytest_runtest_logfinish(self):
        self.done += 1
        self.left[self.path_now] -= 1
        if not self.left[self.path_now]:
            share = 100 * self.done // self.total
            now = time.monotonic()
            text = "{:3d} %  {}: {} tests in {:.0f} s"
            name = self.path_now.relative_to(ROOT / "tests").as_posix()
            self.print(text.format(share, name, self.sizes[self.path_now], now - self.started))
            self.started = now

    def pytest_collectreport(self, report):
        if report.outcome != "passed":
            self.count(report)

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self, exitstatus):
        names = {"left_out": self.left_out, "failures": self.failures}
        text = json.dumps({"exit": int(exitstatus), **names, **self.counts})
        partial = self.path.with_suffix(".partial")
        partial.write_text(text, encoding="utf-8")
        partial.replace(self.path)


def pytest_configure(config):
    path = config.getoption("--result-file")
    if path:
        config.pluginmanager.register(_Progress(config, Path(path)))


def _skip_reason(report) -> str:
    return report.longrepr[-1].removeprefix("Skipped: ")


def _fail_undeclared_skip(report):
    """Turn a skip that tests/may_skip.py does not declare into a failure, if CI is set."""
    if CI and report.skipped and not _skip_reason(report).startswith(tuple(MAY_SKIP)):
        report.outcome = "failed"
        report.longrepr = "skipped, which tests/may_skip.py does not declare: " + _skip_reason(
            report
        )
    return report


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport():
    return _fail_undeclared_skip((yield))


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report():
    return _fail_undeclared_skip((yield))


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
def unregistered(registered):
    """The add-on, which is not registered while the test runs; whatever ran before, and for
    whatever comes after.
    """
    import bpy

    registered.unregister()
    yield registered
    if not hasattr(bpy.types.Object, PACKAGE):
        registered.register()


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


@pytest.fixture
def kept(request):
    """Compare a text, its numbers rounded to six digits, with the page kept beside the tests;
    --rewrite keeps it.
    """

    def rounded(number):
        value = float(number[0])
        return (
            "{:.{}g}".format(value, 6 if abs(value) > 1e-6 else 1) if abs(value) > 1e-15 else "0.0"
        )

    def compare(name, text):
        path = request.path.parent / "kept" / name
        text = re.sub(r"-?\d+\.\d{6,}(e[-+]\d+)?", rounded, text).rstrip("\n") + "\n"
        if request.config.getoption("--rewrite"):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        assert text == path.read_text(encoding="utf-8")

    return compare
