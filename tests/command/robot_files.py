# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robots that the command line exports."""

from body_moments.command.files import output
from body_moments.command.measure.run import Run
from body_moments.command.options.option_types import FORMATS

from tests.blender.batch_files import parsed
from tests.blender.exported_robots import SUFFIXES, exported_links


def text(*words):
    line = Run(parsed(*words))
    line.measure()
    assert not line.errors
    found = "".join(FORMATS[line.options.format](line.documents))
    if line.options.output is not None:
        assert output.write_result(found, line.options.output, -1)
    return found


def exported(folder, name, *words):
    """The links of a robot written to a folder, read back."""
    path = folder / ("robot" + SUFFIXES[name])
    text("measure", "--format", name, "--output", path, *words)
    return exported_links(path)
