# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: mass properties of the objects in files, without a window.

    blender -b FILE.blend --python operators/batch.py -- measure [options]
    blender -b -c body_moments measure [options] [FILE ...]
    python operators/batch.py measure [options] FILE ...
    body-moments measure [options] FILE ...

and `similar LIBRARY --to NAME` in the place of `measure` compares measurements. The first and the
third (with the bpy module) need no installation: run as a script, this file loads the add-on's
folder as a package and registers nothing but the settings that objects carry. The fourth is the
command of the package that pip installs. All of them reach `main`.
"""

from __future__ import annotations

import importlib
import importlib.util
import os
import sys
import traceback
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, cast

if TYPE_CHECKING:
    from importlib.abc import Loader
    from importlib.machinery import ModuleSpec

PACKAGE = "body_moments"  # the add-on's name when this file is run as a script
ALL_MEASURED = 0
SOME_FAILED = 1
WRONG_USAGE = 2
INTERRUPTED = 3
INTERNAL_ERROR = 70

_command = None


def main(argv: list[str], *, channel: int | None = None, file_needed: bool = False) -> int:
    """Run the command line and return its exit code.

    argv: the words from `measure` on. channel: a descriptor for the result, by default the standard
    output, which nothing else in this process reaches from then on. file_needed: whether files must
    be named, as none can be open.
    """
    from ..command import interruption
    from ..command.files import output
    from ..core.measurement import print_message

    channel = output.claim_stdout() if channel is None else channel
    try:
        with interruption.interruptible():
            return _answer(argv, channel, file_needed)
    except KeyboardInterrupt:
        print_message("interrupted; the result was not written")
        return INTERRUPTED
    except Exception:
        traceback.print_exc()
        return INTERNAL_ERROR


def _answer(argv: list[str], channel: int, file_needed: bool) -> int:
    """Run the requested command, and return the exit code."""
    from ..command.files import output
    from ..command.parser import HelpRequested, UsageError, list_commands
    from ..core.measurement import print_message
    from ..core.verdict import MeasureError

    word = "".join(argv[:1])
    try:
        if word == "child":
            return _serve(channel)
        if word in ("-h", "--help"):
            raise HelpRequested(list_commands())
        return (
            _print(word, argv, channel)
            if word in _PRINTING
            else _measure(argv, channel, file_needed)
        )
    except HelpRequested as asked:
        return ALL_MEASURED if output.write_result(asked.args, None, channel) else SOME_FAILED
    except (UsageError, MeasureError) as error:
        print_message(error)
        return WRONG_USAGE
    except SystemExit as ended:
        return WRONG_USAGE if ended.code else ALL_MEASURED


def _measure(argv: list[str], channel: int, file_needed: bool) -> int:
    """Measure files in child processes, or in this process, and return the exit code.

    Modules are imported as late as possible: a wrong option is refused at once, and the process
    that supervises others never loads the code that measures.
    """
    from ..command.options import arguments

    options = arguments.parse(argv, file_needed)

    from ..command.measure import run_files

    if (options.files or options.manifest) and not options.no_supervisor:
        bpy = sys.modules.get("bpy")
        return run_files.measure(options, channel, bpy.data.filepath if bpy else None)
    options.files = run_files.files_of(options)

    from ..command.files import output
    from ..command.measure.run import Run
    from ..command.options import checks
    from ..command.supervisor import processes

    arguments.check_blender(options, options.files)
    _load_settings()  # imports bpy, if there is one
    bpy = sys.modules.get("bpy")
    checks.prepare(options)
    opened = bpy.data.filepath if bpy else None
    output.check_targets(options, arguments.files_of_options(options, options.files, opened))
    run = Run(options, memory=processes.memory_share())
    run.measure()
    is_written = output.write_documents(run.documents, options, channel)
    if run.internal_errors:
        return INTERNAL_ERROR
    failed = run.errors and not options.errors_exit_0
    return SOME_FAILED if failed or not is_written else ALL_MEASURED


def _serve(channel: int) -> int:
    """Serve the supervisor as its child, then end the process."""
    from ..command.supervisor.lifeline import Lifeline

    line = Lifeline(channel)  # first: importing bpy may take seconds
    try:
        _load_settings()

        from ..command.measure import child

        child.serve(line)
    except BaseException:
        traceback.print_exc()
        os._exit(INTERNAL_ERROR)
    os._exit(ALL_MEASURED)


def _print(word: str, argv: list[str], channel: int) -> int:
    """Run a command that neither opens files in Blender nor starts processes; return the exit
    code.
    """
    from .. import command
    from ..command.files import output

    module = getattr(command, _PRINTING[word])
    options = module.parse(argv)
    text, code = module.answer(options)
    # Not every command has the options --force and --output.
    check = output.guard(getattr(options, "force", False))
    is_written = output.write_result(text, getattr(options, "output", None), channel, check)
    return code if is_written or code == INTERNAL_ERROR else SOME_FAILED


# The modules of `command`, each with `parse` and `answer`, which returns the text in pieces and the
# exit code.
_PRINTING = {word: word for word in ("similar", "audit", "simplex")}
_PRINTING |= dict.fromkeys(
    ("manifest", "merge", "to-csv", "summary", "compare", "report"), "gather"
)


def _load_settings() -> None:
    """Register the settings of objects, collections and bones, where there is Blender and no
    registered add-on.
    """
    if importlib.util.find_spec("bpy") is None:
        return
    import bpy

    from .. import blender
    from ..blender.registration import register_modules

    if not hasattr(bpy.types.Object, PACKAGE):
        register_modules(blender.__name__, blender.SETTINGS)


def register() -> None:
    """Register the command `blender -c body_moments`."""
    import bpy

    global _command
    _command = bpy.utils.register_cli_command("body_moments", main)


def unregister() -> None:
    """Remove the command."""
    import bpy

    global _command
    bpy.utils.unregister_cli_command(_command)
    _command = None


def run_process() -> None:
    """Run the command line of this process, in Blender or in Python, and end the process.

    The command `body-moments` of the installed package calls this function; as a script, this file
    does.
    """
    try:
        code = _run()
    except ModuleNotFoundError as error:
        # Without the table of messages, which cannot be imported either if numpy is missing.
        sys.stderr.write("body_moments: {}. Install it, or use Blender.\n".format(error))
        code = WRONG_USAGE
    except KeyboardInterrupt:
        sys.stderr.write("body_moments: interrupted\n")
        code = INTERRUPTED
    except Exception:
        traceback.print_exc()
        code = INTERNAL_ERROR
    bpy = sys.modules.get("bpy")
    if bpy is None or not bpy.app.module:  # without bpy, or in Blender itself
        sys.exit(code)
    # The module may hang while the interpreter ends, after it has opened a file of a newer Blender.
    session = Path(bpy.app.tempdir)
    if session.name.startswith("blender_"):
        with suppress(OSError):
            session.rmdir()
    os._exit(code)


def _run() -> int:
    """Run the command line of this process, and return the exit code."""
    if __name__ == "__main__":
        _load_package()
    output = importlib.import_module(PACKAGE + ".command.files.output")
    channel = output.claim_stdout()  # first of all: importing bpy may print
    words = sys.argv  # the first one is the program, or Blender's "--"
    bpy = sys.modules.get("bpy")
    in_blender = bpy is not None and not bpy.app.module
    if in_blender:  # Blender leaves the words after "--" to the script
        words = words[words.index("--") :] if "--" in words else []
    batch = importlib.import_module(PACKAGE + ".operators.batch")
    return batch.main(words[1:], channel=channel, file_needed=not in_blender)


def _load_package() -> None:
    """Import the add-on's folder, whatever its name, as the package PACKAGE."""
    place = Path(__file__).resolve().parent.parent / "__init__.py"
    spec = cast("ModuleSpec", importlib.util.spec_from_file_location(PACKAGE, place))
    package = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = package
    cast("Loader", spec.loader).exec_module(package)


if __name__ == "__main__":
    run_process()
