# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Public names of packages, imported when they are first used (PEP 562)."""

import sys
from collections.abc import Callable
from importlib import import_module
from types import ModuleType
from typing import Any


def lazy_names(
    package: str, **modules: str
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return `__getattr__`, `__dir__` and `__all__` of a package. modules: the module of each
    public name.
    """
    names = sorted(modules)

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
