# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The rules that the platform's reviewers and this project's layout set for the shipped source.

They are read off the syntax tree of every shipped file, so that a rule is broken in a test, not in
a review. What ruff knows too (prints, docstrings, calls of the system, sys.path) is in
pyproject.toml.
"""

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from tests.package.modules import WINGS

ROOT = Path(__file__).resolve().parent.parent.parent
SHIPPED = [
    ROOT / "__init__.py",
    *sorted(path for part in WINGS for path in (ROOT / part).rglob("*.py")),
]
TREES = {path: ast.parse(path.read_text(encoding="utf-8"), str(path)) for path in SHIPPED}

BLENDER = {
    *("addon_utils", "bl_operators", "bl_ui", "blf", "bmesh", "bpy", "bpy_extras", "gpu"),
    *("gpu_extras", "mathutils"),
}
NETWORK = {
    *("asyncio", "ftplib", "http", "imaplib", "poplib", "smtplib", "socket", "socketserver"),
    *("ssl", "telnetlib", "urllib", "webbrowser", "wsgiref", "xmlrpc"),
}
REFUSED = NETWORK | {
    *("_thread", "builtins", "code", "codeop", "ctypes", "ensurepip", "marshal"),
    *("multiprocessing", "pickle", "pip", "runpy", "site", "subprocess", "threading", "venv"),
}
REFUSED_NAMES = {"eval", "exec", "compile", "__import__", "bl_info"}
# The supervisor alone starts processes, Blender with this add-on, so that no file can end the run
# over all of them.
STARTS_PROCESSES = {
    "command/supervisor/" + name for name in ("processes.py", "pool.py", "whole_run.py")
}
ASKS_SYSTEM = {"command/supervisor/lifeline.py", "command/supervisor/processes.py"}
ALLOWED = (set(sys.stdlib_module_names) - REFUSED) | BLENDER | {"numpy"}


def name(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def nodes() -> Iterator[tuple[str, ast.AST, str]]:
    """Each node of each shipped file: the file's name, the node, where it stands."""
    for path, tree in TREES.items():
        file = name(path)
        for node in ast.walk(tree):
            yield file, node, "{}:{}".format(file, getattr(node, "lineno", 1))


def assert_none(places: list[str]) -> None:
    assert not places, "\n" + "\n".join(places)


def imported(node: ast.AST) -> list[str]:
    """The packages that a statement imports by their full name."""
    if isinstance(node, ast.Import):
        return [alias.name.partition(".")[0] for alias in node.names]
    return (
        [node.module.partition(".")[0]]
        if isinstance(node, ast.ImportFrom) and node.level == 0
        else []
    )


def test_only_packages_of_blender_are_imported():
    assert_none(
        [
            "{} imports {}".format(place, package)
            for file, node, place in nodes()
            for package in imported(node)
            if (
                package not in ALLOWED
                and not (package == "subprocess" and file in STARTS_PROCESSES)
                and not (package == "ctypes" and file in ASKS_SYSTEM)
            )
            or (file.startswith("core/") and package in BLENDER)
        ]
    )


def test_the_supervisor_needs_neither_numpy_nor_blender():
    """It runs in any Python: what it and the modules that it uses import is the standard library's.

    The add-on itself loads nothing heavy: Blender imports every one that is installed when it
    starts.
    """
    code = (
        "import importlib.util, sys\n"
        "spec = importlib.util.spec_from_file_location('body_moments', sys.argv[1] + "
        "'/__init__.py', "
        "submodule_search_locations=[sys.argv[1]])\n"
        "sys.modules['body_moments'] = module = importlib.util.module_from_spec(spec)\n"
        "spec.loader.exec_module(module)\n"
        "assert not {'numpy', 'bpy', 'body_moments.core', 'body_moments.operators'} & "
        "set(sys.modules)\n"
        "import body_moments.command.measure.run_files\n"
        "assert not {'numpy', 'bpy', 'mathutils'} & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-P", "-S", "-c", code, str(ROOT)], check=True, timeout=480)


def test_nothing_is_used_that_reviewers_refuse():
    """Not even a reference to it; ruff's own rules see calls alone."""
    assert_none(
        [
            "{} uses {}".format(place, node.id)
            for file, node, place in nodes()
            if isinstance(node, ast.Name)
            and (
                node.id in REFUSED_NAMES or (node.id == "__file__" and file != "operators/batch.py")
            )
        ]
    )


def test_no_module_beside_batch_hides_another():
    """`python operators/batch.py` puts the folder operators/ before everything else."""
    names = {path.stem for path in (ROOT / "operators").iterdir()} - {"__init__", "__pycache__"}
    hidden = names & (set(sys.stdlib_module_names) | BLENDER | {"numpy"})
    assert not hidden


def test_reports_can_be_translated():
    """An f-string is filled before any translation can find it."""
    assert_none(
        [
            place
            for _, node, place in nodes()
            if isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and node.func.attr in ("report", "poll_message_set")
            and any(
                isinstance(inner, ast.JoinedStr)
                for argument in node.args
                for inner in ast.walk(argument)
            )
        ]
    )


def project_files() -> list[Path]:
    """Every file of the project: what git keeps, found without git."""
    left_out = {".git", ".envs", ".hypothesis", ".ruff_cache", ".pytest_cache", "__pycache__"}
    produced = {ROOT / "demo", ROOT / "dist", ROOT / "tests" / "window" / "artefacts"}
    found, folders = [], [ROOT]
    while folders:
        for path in folders.pop().iterdir():
            if path.name in left_out or path in produced:
                continue
            if path.is_dir():
                folders.append(path)
            else:
                found.append(path)
    return sorted(found)


def test_every_source_file_names_its_holder_and_licence():
    lines = {
        "# SPDX-FileCopyrightText: 2026 Body Moments contributors",
        "# SPDX-License-Identifier: GPL-3.0-or-later",
    }
    files = [path for path in project_files() if path.suffix == ".py"]
    assert_none(
        [
            name(path)
            for path in files
            if not lines <= {*path.read_text(encoding="utf-8").splitlines()[:3]}
        ]
    )


def test_no_file_names_a_machine_or_a_registry():
    """Paths of the machine it was written on, and hosts that a network elsewhere may not have."""
    hosts = ("pypi" + ".org", "pythonhosted" + ".org", "debian" + ".org", "npmjs" + ".org")
    patterns = [
        r"(?<![\w.~}])/(?:home|root|work|Users)/\w",
        r"[A-Z]:\\Users\\",
        *map(re.escape, hosts),
    ]
    pattern = re.compile("|".join(patterns))
    binary = (
        ".png",
        ".webp",
        ".gif",
        ".ply",
        ".blend",
        ".npz",
        ".npy",
        ".zip",
        ".gz",
        ".xz",
        ".glb",
        ".fbx",
    )
    assert_none(
        [
            "{}:{}: {}".format(name(path), number, match.group())
            for path in project_files()
            if path.suffix not in binary
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1)
            if (match := pattern.search(line))
        ]
    )


RELATIVE = re.compile(
    r"(What|Which|Where|Whether|Of|How|Who|When|Those|That|The same|As|Some)\b", re.I
)


def test_docstrings_rarely_open_with_a_relative_word():
    """A docstring names its subject first; two in a hundred may do otherwise."""
    kinds = ast.FunctionDef | ast.ClassDef | ast.Module
    texts = [
        ast.get_docstring(node)
        for tree in TREES.values()
        for node in ast.walk(tree)
        if isinstance(node, kinds)
    ]
    found = [text.partition("\n")[0] for text in texts if text and RELATIVE.match(text)]
    assert len(found) <= 0.02 * sum(text is not None for text in texts), found
