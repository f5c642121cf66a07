# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A few random sessions; `python3 tests/project.py soak sessions` runs more of them."""

import pytest
from body_moments.blender.read import mesh

from tools.soak import sessions

pytestmark = pytest.mark.usefixtures("scene")


@pytest.mark.parametrize("max_faces", [mesh.MAX_DIGESTED_FACES, 0])
def test_random_sessions_lose_nothing_and_show_nothing_wrong(max_faces, monkeypatch):
    monkeypatch.setattr(mesh, "MAX_DIGESTED_FACES", max_faces)
    monkeypatch.setattr(sessions, "STEPS", 30)
    sessions.run(12.0, 1)
