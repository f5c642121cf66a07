# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which lines of the product are run, in this process and in those that it starts; needs Python 3.12."""

import os
import sys

TOOL = 4
PARTS = ("core", "operators", "panels")
_seen = set()


def start(root: str, path: str) -> None:
    """Note lines from now on; what other processes ran is gathered in the file `path`."""
    os.environ["BODY_MOMENTS_LINES"] = path
    os.environ["BODY_MOMENTS_LINES_ROOT"] = root
    _watch(root, lambda name, line: _seen.add((name, line)))


def start_child() -> None:
    path = os.environ["BODY_MOMENTS_LINES"]
    file = os.open(path, os.O_CREAT | os.O_APPEND | os.O_WRONLY)

    def note(name, line):
        os.write(file, "{}\t{}\n".format(name, line).encode())

    _watch(os.environ["BODY_MOMENTS_LINES_ROOT"], note)


def stop() -> None:
    """Note nothing any more, nor in processes that are started."""
    del os.environ["BODY_MOMENTS_LINES"]
    sys.monitoring.set_events(TOOL, 0)


def _watch(root: str, note) -> None:
    monitoring = sys.monitoring
    prefixes = tuple(os.path.join(root, part) + os.sep for part in PARTS)

    def ran(code, line):
        if code.co_filename.startswith(prefixes):
            note(code.co_filename[len(root) + 1 :], line)
        return monitoring.DISABLE

    monitoring.use_tool_id(TOOL, "lines")
    monitoring.register_callback(TOOL, monitoring.events.LINE, ran)
    monitoring.set_events(TOOL, monitoring.events.LINE)


def reset() -> None:
    taken()
    sys.monitoring.restart_events()


def taken() -> dict[str, list[int]]:
    """The lines since the last call, by module."""
    found = {}
    try:
        with open(os.environ["BODY_MOMENTS_LINES"], encoding="utf-8") as file:
            for text in file.read().splitlines():
                name, _, line = text.partition("\t")
                if line.isdigit():
                    _seen.add((name, int(line)))
        os.truncate(os.environ["BODY_MOMENTS_LINES"], 0)
    except OSError:
        pass
    for name, line in _seen:
        found.setdefault(name, []).append(line)
    _seen.clear()
    return found
