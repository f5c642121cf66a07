# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The checkout under the names that tools import, whatever its folder is called."""

import importlib.util
import sys
import types
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def load_checkout(root: Path = ROOT) -> None:
    """Make `body_moments` the root of a checkout, and `tests` and `tools` its folders."""
    for name in ("tests", "tools"):
        sys.modules[name] = types.ModuleType(name)
        sys.modules[name].__path__ = [str(root / name)]
    spec = importlib.util.spec_from_file_location(
        "body_moments", root / "__init__.py", submodule_search_locations=[str(root)]
    )
    sys.modules["body_moments"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules["body_moments"])
