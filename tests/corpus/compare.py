# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of the corpus, before and after a change.

    python tests/corpus/compare.py --write OUT.json  measure the corpus and keep all numbers (.json)
    python tests/corpus/compare.py REFERENCE.json    measure it and compare with them, bit for bit

for a Python with the bpy module (.envs/blender-5.2/bin/python). The second prints every difference
and their count, and ends with 1 if there is one. A file that ends in .txt holds the summary instead
(summary.py), which is compared within its tolerances, on any machine. tests/corpus/test_corpus.py
does so with the references that are kept here: that of Blender 5.2, and the lines of 4.5 that
differ from it:

    --write reference.txt, and with the other: --write reference-4.5.txt --beside reference.txt
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import os
import shutil
import sys
import tempfile
import traceback
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

ROOT = Path(__file__).resolve().parent.parent.parent
# The folder of the checkout would hide other packages if it were on the path.
if __name__ == "__main__":
    tests = ModuleType("tests")
    tests.__path__ = [str(ROOT / "tests")]
    sys.modules["tests"] = tests

from tests.corpus import summary

MISSING = "(missing)"


def load(path: Path) -> dict[str, object]:
    text = path.read_text(encoding="utf-8")
    return summary.read(text) if path.suffix == ".txt" else json.loads(text)


def save(path: Path, table: dict[str, object]) -> None:
    """Write one entry a line, in the order of the keys; JSON has the shortest digits that give the
    same bits.
    """
    if path.suffix == ".txt":
        text = summary.write(table)
    else:
        lines = [
            "{}: {}".format(
                json.dumps(key, ensure_ascii=False), json.dumps(table[key], ensure_ascii=False)
            )
            for key in sorted(table)
        ]
        text = "{\n" + ",\n".join(lines) + "\n}\n"
    path.write_text(text, encoding="utf-8", newline="\n")


def leaves(value: object, path: str = "") -> Iterator[tuple[str, object]]:
    """Yield the place and value of each leaf; an empty table or list is a leaf."""
    items = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else None
    )
    if not items:
        yield path, value
        return
    for key, part in items:
        yield from leaves(part, "{} › {}".format(path, key))


def differences(before: dict, after: dict) -> Iterator[tuple[str, object, object]]:
    """Yield (place, before, after) of each leaf that differs by a bit, 0.0 and -0.0 too; new
    entries are none.
    """
    for key in sorted(before):
        if key not in after:
            yield key, "…", MISSING
            continue
        old, new = dict(leaves(before[key], key)), dict(leaves(after[key], key))
        for place, value in old.items():
            if place not in new or repr(value) != repr(new[place]):
                yield place, value, new.get(place, MISSING)
        if isinstance(before[key], list):  # the names of refused objects
            for place in new.keys() - old.keys():
                yield place, MISSING, new[place]


def _prepare() -> str:
    """Load the add-on from this checkout as a module, with a new user folder.

    Return that folder.
    """
    folder = tempfile.mkdtemp(prefix="body_moments_corpus_")
    for name in [
        name for name in os.environ if name.startswith(("BLENDER_USER_", "BLENDER_SYSTEM_"))
    ]:
        del os.environ[name]
    os.environ["BLENDER_USER_RESOURCES"] = folder
    spec = importlib.util.spec_from_file_location(
        "body_moments", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    sys.modules["body_moments"] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return folder


def _measure() -> dict[str, object]:
    folder = _prepare()
    try:
        import body_moments

        from tests.corpus.runs import collect

        body_moments.register()
        work = Path(folder) / "work"
        work.mkdir()
        return collect(work)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def main() -> int:
    parser = argparse.ArgumentParser(
        description="Measures the corpus, and keeps or compares the numbers."
    )
    parser.add_argument("reference", nargs="?", type=Path, metavar="REFERENCE")
    parser.add_argument("--write", type=Path, metavar="OUT")
    parser.add_argument(
        "--beside",
        type=Path,
        metavar="BASE.txt",
        help="with --write OUT.txt: only entries that differ from BASE by more than the tolerances",
    )
    options = parser.parse_args()
    if (options.reference is None) == (options.write is None):
        parser.error("give either a reference or --write")
    before = None if options.reference is None else load(options.reference)
    after = _measure()
    is_summary = (options.write or options.reference).suffix == ".txt"
    if is_summary:
        from tests.corpus.scenes import EVALUATED

        after = summary.summarize(after, EVALUATED)
    if options.beside is not None:
        base = load(options.beside)
        changed = {place.partition(" › ")[0] for place, _, _ in summary.changes(base, after)}
        after = {key: entry for key, entry in after.items() if key in changed or key not in base}
    if before is None:
        save(options.write, after)
        print("{} entries were written.".format(len(after)))
        return 0
    count = 0
    for place, old, new in (summary.changes if is_summary else differences)(before, after):
        count += 1
        print("{}: {!r} -> {!r}".format(place, old, new))
    print("{} differences in {} entries".format(count, len(before)))
    return 1 if count else 0


if __name__ == "__main__":
    try:
        code = main()
    except Exception:
        traceback.print_exc()
        code = 70
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)  # bpy 4.5 may crash while the interpreter ends
