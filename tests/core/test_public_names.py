# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The public names of core/: each documented in numpydoc's form, with an example that runs;
README's example runs.
"""

import doctest
import importlib
import inspect
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
PACKAGES = [
    "",
    *sorted(
        "." + path.parent.name
        for path in (ROOT / "core").glob("*/__init__.py")
        if path.parent.name not in ("files", "measurement")
    ),
]
FACES = {package: importlib.import_module("body_moments.core" + package) for package in PACKAGES}
PUBLIC = {
    (package, name): getattr(module, name)
    for package, module in FACES.items()
    for name in module.__all__
    if inspect.isclass(getattr(module, name))
    or inspect.isfunction(inspect.unwrap(getattr(module, name)))
}
# core.papers offers modules; their functions are the public names.
PUBLIC |= {
    (module.__name__, name): thing
    for module in (getattr(FACES[".papers"], name) for name in FACES[".papers"].__all__)
    for name, thing in vars(module).items()
    if inspect.isfunction(thing)
    and thing.__module__ == module.__name__
    and not name.startswith("_")
}
# A class or function is documented once, wherever it is offered.
DOCUMENTED = {
    "{0.__module__}.{0.__qualname__}".format(inspect.unwrap(thing)): thing
    for thing in PUBLIC.values()
}


def documented(function):
    return pytest.mark.parametrize(
        "name", sorted(DOCUMENTED), ids=lambda name: name.removeprefix("body_moments.")
    )(function)


def section(doc: str, title: str) -> str:
    found = re.search(r"^{}\n-+\n(.*?)(?=^\S[^\n]*\n-+\n|\Z)".format(title), doc, re.M | re.S)
    return found.group(1) if found else ""


def entries(text: str) -> set[str]:
    """The names that a section of parameters documents."""
    lines = [line for line in text.splitlines() if line and not line.startswith(" ")]
    return {name.strip("* ") for line in lines for name in line.split(" : ")[0].split(",")}


@pytest.mark.parametrize("package", PACKAGES)
def test_every_face_is_small_sorted_and_true(package):
    names = FACES[package].__all__
    assert list(names) == sorted(names) and len(names) <= (14 if not package else 9)
    assert all(getattr(FACES[package], name) is not None for name in names)
    assert set(names) <= set(dir(FACES[package]))


def test_public_name_loads_on_first_use():
    core = FACES[""]
    for name in core.__all__:
        vars(core).pop(name, None)
        assert getattr(core, name) is vars(core)[name] is not None


@documented
def test_a_public_name_is_documented(name):
    thing = inspect.unwrap(DOCUMENTED[name])
    doc = inspect.getdoc(thing)
    first, _, rest = doc.partition("\n")
    assert first.endswith((".", ":")) and not rest.startswith(" ")
    assert ">>>" in section(doc, "Examples")
    if inspect.isclass(thing):
        parameters = (
            [] if issubclass(thing, (str, Exception)) else inspect.signature(thing).parameters
        )
        attributes = entries(section(doc, "Parameters")) | entries(section(doc, "Attributes"))
        assert set(parameters) <= attributes, "undocumented: {}".format(
            set(parameters) - attributes
        )
        for method, function in vars(thing).items():
            if not method.startswith("_") and (
                callable(function) or isinstance(function, (property, classmethod))
            ):
                assert inspect.getdoc(getattr(thing, method)), method
    else:
        signature = inspect.signature(thing)
        missing = set(signature.parameters) - entries(section(doc, "Parameters"))
        assert not missing, "undocumented: {}".format(missing)
        assert section(doc, "Returns")


@documented
def test_the_example_of_a_public_name_runs(name):
    thing = inspect.unwrap(DOCUMENTED[name])
    test = doctest.DocTestParser().get_doctest(inspect.getdoc(thing), {"np": np}, name, None, 0)
    report = []
    failed, tried = doctest.DocTestRunner(verbose=False).run(test, out=report.append)
    assert tried and not failed, "".join(report)


def run_with_package(code, *arguments):
    """Run code in a new process where this folder is the package, without anything else of it
    imported.
    """
    load = (
        "import importlib, importlib.util, sys\n"
        "spec = importlib.util.spec_from_file_location('body_moments', sys.argv[1] + "
        "'/__init__.py', "
        "submodule_search_locations=[sys.argv[1]])\n"
        "sys.modules['body_moments'] = module = importlib.util.module_from_spec(spec)\n"
        "spec.loader.exec_module(module)\n"
    )
    subprocess.run(
        [sys.executable, "-P", "-c", load + code, str(ROOT), *arguments], check=True, timeout=120
    )


def test_library_names_load_nothing_before_use():
    run_with_package(
        "import body_moments.core, body_moments.core.verdict\n"
        "assert 'measure_solid' in dir(body_moments.core)\n"
        "assert 'numpy' not in sys.modules\n"
        "assert not hasattr(body_moments.core, 'measure_everything')\n"
        "from body_moments.core import *\n"
        "assert Surface.__name__ == 'Surface' and 'numpy' in sys.modules\n"
    )


@pytest.mark.parametrize("package", PACKAGES[1:])
def test_every_package_can_be_imported_first(package):
    run_with_package("importlib.import_module('body_moments.core' + sys.argv[2])\n", package)


def readme_example() -> str:
    """The first block of Python in README's section on Python."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return text.partition("## Python")[2].partition("```python\n")[2].partition("```")[0]


def test_the_readme_example_uses_the_library_s_names_alone():
    modules = re.findall(r"from (body_moments\S*) import", readme_example())
    assert modules == ["body_moments"]


def test_readme_example_runs_as_printed(capsys):
    """A cube without a lid: the moments belong to the measured body at every order."""
    names = {}
    exec(compile(readme_example(), "README.md", "exec"), names)
    assert str(names["body"].method) == "capped"
    assert names["properties"].mass == pytest.approx(7850.0, rel=1e-12, abs=0.0)
    assert names["volume"].total == pytest.approx(1.0, rel=1e-12, abs=0.0)
    assert names["volume"][4, 0, 2] == pytest.approx(1.0 / 15.0, rel=1e-12, abs=0.0)
    # the faces that were given: no cap
    assert names["area"].total == pytest.approx(5.0, rel=1e-12, abs=0.0)
    assert names["area"].about.tolist() == [0.5, 0.5, 0.5]  # the middle of the bounding box
    assert "capped" in capsys.readouterr().out


def test_python_page_has_the_readme_example():
    assert readme_example() in (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
