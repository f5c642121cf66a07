# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The rules that the platform's reviewers and this project's layout set for the shipped source.

They are read off the syntax tree of every shipped file, so that a rule is broken in a test, not in
a review.
"""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
SHIPPED = [
    ROOT / "__init__.py",
    *sorted(path for part in ("core", "operators", "panels") for path in (ROOT / part).rglob("*.py")),
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
ALLOWED = (set(sys.stdlib_module_names) - REFUSED) | BLENDER | {"numpy"}


def name(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def shipped(function):
    return pytest.mark.parametrize("path", SHIPPED, ids=name)(function)


def absolute_imports(tree: ast.AST) -> set[str]:
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            found.add(node.module.partition(".")[0])
    return found


@shipped
def test_a_file_imports_only_what_blender_brings(path):
    allowed = ALLOWED - BLENDER if name(path).startswith("core/") else ALLOWED
    assert absolute_imports(TREES[path]) <= allowed


@shipped
def test_a_file_uses_nothing_that_reviewers_refuse(path):
    for node in ast.walk(TREES[path]):
        if isinstance(node, ast.Name):
            refused = {"eval", "exec", "compile", "__import__", "print", "bl_info"}
            assert node.id not in refused, f"{name(path)}:{node.lineno}: {node.id}"
            if node.id == "__file__":
                assert name(path) == "operators/batch.py", f"{name(path)} reads __file__"
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            dotted = f"{node.value.id}.{node.attr}"
            refused = {"sys.path", "os.system", "os.popen", "os.fork", "site.addsitedir"}
            assert dotted not in refused, f"{name(path)}:{node.lineno}: {dotted}"


def test_only_the_script_part_of_batch_knows_its_own_place():
    """`__file__`, and whatever calls what reads it, is reached from the main branch alone."""
    tree = TREES[ROOT / "operators" / "batch.py"]
    used = {top: {node.id for node in ast.walk(top) if isinstance(node, ast.Name)} for top in tree.body}
    tainted, known = {"__file__"}, 0
    while known != len(tainted):
        known = len(tainted)
        tainted |= {top.name for top in tree.body if isinstance(top, ast.FunctionDef) and used[top] & tainted}
    assert not tainted & {"main", "register", "unregister"}
    for top in tree.body:
        if used[top] & tainted and not isinstance(top, ast.FunctionDef):
            assert isinstance(top, ast.If)
            assert ast.unparse(top.test) == "__name__ == '__main__'"


def test_no_module_beside_batch_hides_one_that_python_or_blender_imports():
    """`python operators/batch.py` puts the folder operators/ before everything else."""
    names = {path.stem for path in (ROOT / "operators").iterdir()} - {"__init__", "__pycache__"}
    hidden = names & (set(sys.stdlib_module_names) | BLENDER | {"numpy"})
    assert not hidden


@shipped
def test_reports_can_be_translated(path):
    """An f-string is filled before any translation can find it."""
    for node in ast.walk(TREES[path]):
        if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)):
            continue
        if node.func.attr in ("report", "poll_message_set"):
            inner = [part for argument in node.args for part in ast.walk(argument)]
            formatted = any(isinstance(part, ast.JoinedStr) for part in inner)
            assert not formatted, f"{name(path)}:{node.lineno}"


@shipped
def test_a_file_says_what_it_is(path):
    assert ast.get_docstring(TREES[path]), f"{name(path)} has no docstring"


def words(text: str) -> int:
    """How many words of two letters or more a text has; of a list with commas but no spaces, its longest entry."""
    parts = [part.split() for part in re.split(r",(?=\S)", text)]
    return max(sum(re.search(r"[^\W\d_]{2}", word) is not None for word in part) for part in parts)


def test_the_core_says_nothing():
    """It makes findings; sentences stand in operators/write/messages.py. The names of materials are data."""
    for path in SHIPPED:
        if not name(path).startswith("core/") or name(path) == "core/density/materials.py":
            continue
        documented = {id(node.value) for node in ast.walk(TREES[path]) if isinstance(node, ast.Expr)}
        for node in ast.walk(TREES[path]):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documented:
                assert words(node.value) < 5, f"{name(path)}:{node.lineno}: {node.value!r}"


def test_importing_the_add_on_loads_nothing_heavy():
    """Blender imports every add-on that is installed when it starts."""
    code = (
        "import importlib.util, sys\n"
        "spec = importlib.util.spec_from_file_location('body_moments', sys.argv[1] + '/__init__.py', "
        "submodule_search_locations=[sys.argv[1]])\n"
        "sys.modules['body_moments'] = module = importlib.util.module_from_spec(spec)\n"
        "spec.loader.exec_module(module)\n"
        "assert 'body_moments.core.verdict.finding' in sys.modules\n"
        "assert not {'numpy', 'bpy', 'body_moments.operators'} & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-P", "-c", code, str(ROOT)], check=True, timeout=120)


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
    lines = (
        "# SPDX-FileCopyrightText: 2026 Body Moments contributors",
        "# SPDX-License-Identifier: GPL-3.0-or-later",
    )
    for path in project_files():
        if path.suffix == ".py":
            top = path.read_text(encoding="utf-8").splitlines()[:3]
            assert all(line in top for line in lines), name(path)


def test_no_file_names_a_machine_or_a_registry():
    """Paths of the machine it was written on, and hosts that a network elsewhere may not have."""
    hosts = ("pypi" + ".org", "pythonhosted" + ".org", "debian" + ".org", "npmjs" + ".org")
    pattern = re.compile(
        "|".join(
            [
                r"(?<![\w.~}])/(?:home|root|work|Users)/\w",
                r"[A-Z]:\\Users\\",
                *(re.escape(host) for host in hosts),
            ]
        )
    )
    for path in project_files():
        if path.suffix in (".png", ".blend", ".npz", ".npy", ".zip", ".gz", ".glb", ".fbx"):
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
            found = pattern.search(line)
            assert not found, f"{name(path)}:{number}: {found.group()}"
