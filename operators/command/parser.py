# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The parser of a command line, whose messages may hold names of files."""

from __future__ import annotations

import argparse
from typing import NoReturn

from ..write.terminal import visible


class Parser(argparse.ArgumentParser):
    """One that shows control characters."""

    def error(self, message: str) -> NoReturn:
        super().error(visible(message))
