# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests in Blender start from."""

import re
from contextlib import suppress

import pytest

with suppress(ImportError):
    import bpy  # noqa: F401 with it comes bmesh, which tests may import ahead of it


class Reported(list):
    """Findings that operators have reported, each followed by those among its values: the causes of refusals."""

    def add(self, finding):
        from body_moments.core.verdict.finding import Finding

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
    from body_moments.operators.write import reports

    found, report = Reported(), reports.report

    def kept(operator, *findings):
        for finding in findings:
            found.add(finding)
        report(operator, *findings)

    monkeypatch.setattr(reports, "report", kept)
    return found


def six_digits(text):
    """A text whose numbers have six digits, one where they are near rounding: the others are another processor's."""

    def rounded(number):
        value = float(number[0])
        return "{:.{}g}".format(value, 6 if abs(value) > 1e-6 else 1) if abs(value) > 1e-15 else "0.0"

    return re.sub(r"-?\d+\.\d{6,}(e[-+]\d+)?", rounded, text)


@pytest.fixture
def kept(request):
    """Compare a text with the one that is kept beside the tests; `pytest --rewrite` keeps the new one."""

    def compare(name, text):
        path, text = request.path.parent / "kept" / name, six_digits(text) + "\n"
        if request.config.getoption("--rewrite"):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        assert text == path.read_text(encoding="utf-8")

    return compare
