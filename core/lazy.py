# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of packages, imported when they are first used (PEP 562).

A package's stub (`__init__.pyi`) lists the names that other packages take from it, with their
modules, for type checkers and for this module; its `__all__` lists the public ones.
"""

import re
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

_IMPORT = re.compile(r"^from \.([\w.]*) import (\([^)]*\)|.*)$", re.MULTILINE)
_NAME = re.compile(r"(\w+) as \w+")
_PUBLIC = re.compile(r"^__all__ = \[([^]]*)\]", re.MULTILINE)


def lazy_names(
    package: str, **modules: str
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return `__getattr__`, `__dir__` and `__all__` of a package.

    modules: the module of each public name; by default those of the stub.
    """
    stub = Path(str(sys.modules[package].__file__)).with_suffix(".pyi")
    names = sorted(modules)
    if not modules and stub.is_file():
        text = stub.read_text(encoding="utf-8")
        for module, imported in _IMPORT.findall(text):
            modules |= {name: module or name for name in _NAME.findall(imported)}
        names = re.findall(r"\w+", "".join(_PUBLIC.findall(text)))

    def load(name: str) -> Any:
        path = "{}.{}".format(package, modules.get(name, name))
        try:
            module = None if name.startswith("_") else import_module(path)
        except ModuleNotFoundError as error:
            if error.name != path:
                raise
            module = None
        if module is None:
            raise AttributeError("module {!r} has no attribute {!r}".format(package, name))
        value = getattr(module, name, module) if name in modules else module
        setattr(sys.modules[package], name, value)
        return value

    return load, lambda: names, names


def loaded_module(package: ModuleType, name: str) -> Any:
    """Return a package's module if it has been imported, else None: then it holds no state of this
    session.
    """
    return sys.modules.get("{}.{}".format(package.__name__, name))
