# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixtures of the tests that need Blender; the `conftest.py` of their folders import them."""

from contextlib import suppress

import pytest

with suppress(ImportError):
    import bpy  # noqa: F401 with it comes bmesh, which tests may import ahead of it


class Reported(list):
    """Findings that operators have reported, each followed by those among its values: the causes of
    refusals.

    texts: the other parts of their reports.
    """

    def __init__(self):
        super().__init__()
        self.texts = []

    def add(self, finding):
        from body_moments.core.verdict import Finding

        self.append(finding)
        for value in finding.values.values():
            for record in value if isinstance(value, list) else [value]:
                if isinstance(record, dict):
                    self.add(Finding.from_record(record))

    @property
    def codes(self):
        return [finding.code for finding in self]

    def values(self, code):
        """Those of the one finding with this code."""
        (finding,) = [finding for finding in self if finding.code == code]
        return finding.values


@pytest.fixture
def reported(monkeypatch):
    """What operators report from now on, as findings."""
    from body_moments.blender.write import reports

    found, report = Reported(), reports.report

    def kept(operator, *parts, **level):
        for part in parts:
            if isinstance(part, str):
                found.texts.append(part)
            else:
                found.add(part)
        return report(operator, *parts, **level)

    monkeypatch.setattr(reports, "report", kept)
    return found
