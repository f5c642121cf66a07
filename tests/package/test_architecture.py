# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Allowed imports between parts of the add-on, as docs/architecture.md draws them, read off the
syntax trees.
"""

import ast
import importlib.util

from tests.package.modules import MODULES, ORDER, ROOT, WINGS

MAY_KNOW_EACH_OTHER = ("mesh", "inertia", "papers")
WITHOUT_WRITE = ("settings", "read", "bodies", "scene")  # These make findings and numbers only.
# Blender is imported when it is needed: the package can be imported without it, and a script has to
# be ready first.
LATE = {"__init__.py", "core/verdict/finding_types.py", "operators/batch.py"}


def imports(module: tuple[str, ...]) -> list[tuple[tuple[str, ...], int, bool, bool]]:
    """Return a module's imports from the add-on: (module or package, line, at the top of the file,
    when it runs).
    """
    result = []
    package = module[:-1]
    tree = ast.parse(MODULES[module].read_text(encoding="utf-8"))
    checked = [
        node.body
        for node in tree.body
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
    ]
    runs = {id(node) for node in tree.body}
    top = runs.union(id(node) for body in checked for node in body)
    for node in ast.walk(tree):
        if not (isinstance(node, ast.ImportFrom) and node.level):
            continue
        assert node.level - 1 <= len(package), f"{'/'.join(module)} imports from outside the add-on"
        base = package[: len(package) - (node.level - 1)] + tuple((node.module or "").split("."))
        base = tuple(part for part in base if part)
        for alias in node.names:
            target = (*base, alias.name)
            known = target in MODULES or (*target, "__init__") in MODULES
            result.append(
                (target if known else base, node.lineno, id(node) in top, id(node) in runs)
            )
    return result


def rank(order: tuple[tuple[str, ...], ...], package: str) -> int:
    rows = [number for number, row in enumerate(order) if package in row]
    assert rows, (
        f"{package} has no place in the architecture: give it one here and in docs/architecture.md"
    )
    return rows[0]


def complaints() -> list[str]:
    result = []
    for module in MODULES:
        for target, line, at_top, _ in imports(module):
            place = f"{'/'.join(module)}:{line} imports {'/'.join(target)}"
            if not at_top and MODULES[module].relative_to(ROOT).as_posix() not in LATE:
                result.append(place + " inside a function")
            if not target or module == ("__init__",):
                continue
            part = module[0]
            if WINGS.index(part) < WINGS.index(target[0]):
                result.append(place + ": up")
                continue
            if part != target[0] or part not in ORDER or len(target) < 2 or module[1] == "__init__":
                continue
            order = ORDER[part]
            source, destination = rank(order, module[1]), rank(order, target[1])
            if destination > source:
                result.append(place + ": up")
            elif (
                destination == source
                and module[1] != target[1]
                and module[1] not in MAY_KNOW_EACH_OTHER
            ):
                result.append(place + ": sideways")
            if part == "blender" and module[1] in WITHOUT_WRITE and target[1] == "write":
                result.append(place + ": only what shows or stores may write")
    return result


def cycles() -> list[list[str]]:
    """Modules that import each other, however far around; a package stands for its own __init__."""
    graph = {}
    for module in MODULES:
        targets = {
            target if target in MODULES else (*target, "__init__")
            for target, *_, runs in imports(module)
            if runs
        }
        graph["/".join(module)] = sorted(
            "/".join(target) for target in targets if target in MODULES
        )
    done, path, result = set(), [], []

    def visit(module: str) -> None:
        if module in path:
            result.append([*path[path.index(module) :], module])
            return
        if module in done:
            return
        path.append(module)
        for target in graph[module]:
            visit(target)
        path.pop()
        done.add(module)

    for module in graph:
        visit(module)
    return result


def test_imports_run_one_way():
    found = complaints()
    assert not found, "\n".join(found)


def test_no_module_imports_itself_by_a_detour():
    found = cycles()
    assert not found, "\n".join(" -> ".join(cycle) for cycle in found)


def test_every_folder_describes_its_contents():
    for module, path in MODULES.items():
        if module[-1] == "__init__":
            assert ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))), path


def test_packages_load_their_modules_on_use():
    """Else an attribute is there only if somebody has imported its module before."""
    for module, path in MODULES.items():
        if module[-1] == "__init__" and module[0] in ("core", "blender") and len(module) > 2:
            assert "= lazy_names(" in path.read_text(encoding="utf-8"), path


def test_root_alone_has_no_public_names():
    """As pytest loads it in a folder whose name is no identifier, such as body-moments."""
    spec = importlib.util.spec_from_file_location("__init__", ROOT / "__init__.py")
    alone = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(alone)
    assert not hasattr(alone, "setUpModule") and not hasattr(alone, "mass_properties")


def test_no_test_module_imports_another():
    """What several need is in a module of its own, which pytest does not collect."""
    for path in (ROOT / "tests").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom):
                words = [*(node.module or "").split("."), *(alias.name for alias in node.names)]
                assert not any(word.startswith("test_") for word in words), path
