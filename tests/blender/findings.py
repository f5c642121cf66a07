# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is found, and what is refused, by code; and that each of it can be said."""

from contextlib import contextmanager

import pytest
from body_moments.core.verdict import MeasureError


def said(result):
    """{code: values} of what has findings, or of findings."""
    findings = getattr(result, "findings", result)
    assert all(str(found) for found in findings)
    return {found.code: found.values for found in findings}


@contextmanager
def refused(code, subject=None, **values):
    """What is done here is refused with this code, about this object, with these values among
    others.
    """
    with pytest.raises(MeasureError) as caught:
        yield
    found = caught.value.finding
    assert str(caught.value).endswith(str(found)) and found.code == code, caught.value
    assert subject in (None, caught.value.subject)
    assert values.items() <= found.values.items()
