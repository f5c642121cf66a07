# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line, called in this process."""

import json
import math

from body_moments.operators import batch

from tests.blender import batch_files as files
from tests.records import valid


def box_moment(powers, center=files.CENTER, size=(1, 2, 3)):
    bounds = [(c - s / 2, c + s / 2) for c, s in zip(center, size, strict=True)]
    return math.prod(
        (b ** (n + 1) - a ** (n + 1)) / (n + 1) for (a, b), n in zip(bounds, powers, strict=True)
    )


def ask(tmp_path, *words):
    path = tmp_path / "answer.txt"
    with open(path, "wb") as file:
        code = batch.main(["similar", *map(str, words)], channel=file.fileno())
    return code, path.read_text(encoding="utf-8")


def run(tmp_path, *words):
    """The exit code and the document of a file that is measured in this process."""
    out = tmp_path / "out.json"
    words = files.in_process("measure", "--force", "--output", out, *words)
    code = batch.main(words, channel=2, file_needed=True)
    document = json.loads(out.read_text(encoding="utf-8"))
    assert valid(document)
    return code, document
