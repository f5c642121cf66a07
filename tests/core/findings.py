# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of findings and refusals by their codes and values, never by their sentences."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module

import pytest
from body_moments.core.verdict import Code, Finding, MeasureError, catalog


def declarations() -> dict[str, Code]:
    """Return every declared code by its name."""
    modules = [
        import_module(".".join((catalog.ROOT, package, "findings"))) for package in catalog.PACKAGES
    ]
    return {
        code: code for module in modules for code in vars(module).values() if isinstance(code, Code)
    }


def codes(found) -> list[str]:
    """The codes of a result's findings, in their order."""
    return [finding.code for finding in found.findings]


def only(found) -> Finding:
    """The one finding of a result."""
    (finding,) = found.findings
    return finding


@contextmanager
def refused(*allowed: str, **values) -> Iterator[None]:
    """A refusal with one of these codes and, among others, these values."""
    with pytest.raises(MeasureError) as caught:
        yield
    finding = caught.value.finding
    assert finding.code in allowed, finding
    assert {name: finding.values[name] for name in values} == values, finding
