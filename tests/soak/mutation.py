# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mutants of the product: how many of a sample from each package the tests find.

First each test file runs once, and the lines that its tests run are noted (kept in .envs/soak/lines; tests that are new
or changed run again; where a module changes, the lines follow its text, and new ones have the tests of those around
them). Then mutants are drawn, round after round one of each package. Each is written into a copy of the project, and
the tests that run its line pass there, the quickest first, until one fails or they have had their time.

A mutant counts as found when a test fails, does not end, or dies. Those that no test could find are in
tests/soak/equivalent_mutants.py, with reasons, and are not drawn. `mutation:20,core/mesh,core/solid` draws 20 from each
of these packages. The same seed draws the same mutants again: what is found stays so while its module does not change
(.envs/soak/found.jsonl), the others are tried again, and then come new ones.
"""

from __future__ import annotations

import ast
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from difflib import SequenceMatcher
from functools import cache
from pathlib import Path
from unittest import mock

from tests.corpus import runs, scenes, shapes
from tests.soak import equivalent_mutants, mutants

ROOT = Path(__file__).resolve().parent.parent.parent
PROCESS = Path(__file__).resolve().parent / "mutation_process"
KEPT = ROOT / ".envs" / "soak" / "lines"
FOUND = ROOT / ".envs" / "soak" / "found.jsonl"
CORPUS = "soak/mutation_process/corpus/test_runs.py"
MANY = "blender/bodies/test_many.py"
TESTS = {  # of a package, or of all in a part
    "core": ("core", CORPUS, MANY),
    "core/shape": ("core", CORPUS, MANY, "blender/actions/shape"),
    "core/robots": (
        "core/robots",
        "blender/bodies/test_audit.py",
        "blender/read/test_robots.py",
        "blender/actions/export",
    ),
    "operators": ("blender", CORPUS),
    "panels": ("blender",),
}
READERS = {  # tests that read the source, by what they look for in it
    re.compile(r"(finding|\w+Error|self\._damaged)\("): "tests/core/verdict/test_finding.py::"
    "test_every_value_that_a_message_needs_is_given",
    re.compile(r"(True|False|\d[\d.]*(e-?\d+)?)$"): "tests/core/test_public_names.py::"
    "test_what_is_left_out_in_a_call_means_what_it_meant",
}
LEFT_OUT = ("test_random_sessions.py",)  # what takes as long as it is given
MISSED = ("passed", "no test")
LEAST = 0.95  # of each package's mutants
LEAST_DRAWN = 20  # below this, a share says nothing
FIRST_SECONDS = 10.0  # of the tests of one mutant, and again of the corpus
FURTHER_SECONDS = 60.0  # of other tests that run its line, where those have not found it


def run(budget_seconds: float, seed: int, *choice: str) -> str:
    """Draw mutants until the budget is spent.

    Parameters
    ----------
    budget_seconds : float
        For the mutants; noting lines comes before, and takes as long as all tests.
    seed : int
    choice : str
        Packages such as "core/mesh" or "panels", all if none is given; and how many to draw from each, as many as
        there is time for if that is not given.

    Returns
    -------
    str
        A table of the packages, and the mutants that no test found.

    Raises
    ------
    AssertionError
        With the same, where less than `LEAST` of a package were found.
    """
    os.environ["BODY_MOMENTS_CORPUS"] = str(corpus_plan())
    count = next((int(word) for word in choice if word.isdigit()), sys.maxsize)
    packages = {word for word in choice if not word.isdigit()}
    with Project() as project:
        decks = {name: deck for name, deck in all_mutants(ROOT).items() if name in (packages or {name})}
        tests = {test for name in decks for test in TESTS.get(name, TESTS[name.partition("/")[0]])}
        tests = sorted("tests/" + test for test in tests if test.partition("/")[0] not in tests - {test})
        project.note_lines(tests)
        project.load_tests(tests)
        end, draws = time.monotonic() + budget_seconds, drawn(decks, seed, count)
        while time.monotonic() < end and (mutant := next(draws, None)):
            answer = project.try_mutant(mutant)
            print("{:9} {:5.1f} s  {}".format(answer["outcome"], answer["seconds"], mutant), flush=True)
        text = report(project.results)
        assert not too_few(project.results), text
    return text


def corpus_plan() -> Path:
    """The corpus' command lines as JSON, [(run, words, file), ...]; its files are made once while their makers stay."""
    sources = [Path(module.__file__).read_bytes() for module in (runs, scenes, shapes)]
    folder = KEPT.parent / "corpus-{}".format(hashlib.sha256(b"".join(sources)).hexdigest()[:16])
    plan = folder / "plan.json"
    if not plan.is_file():
        folder.mkdir(parents=True, exist_ok=True)
        asked = []

        def note(_folder: Path, run: str, options: tuple, files: list[Path]) -> dict:
            asked.extend((run, [str(word) for word in options], str(path)) for path in files)
            return {}

        with mock.patch.object(runs, "_measured", note), mock.patch.object(runs, "_transforms", lambda _folder: {}):
            runs.collect(folder)
        plan.write_text(json.dumps(asked), encoding="utf-8")
    return plan


def package_of(path: str) -> str:
    parts = path.split("/")
    return "panels" if parts[0] == "panels" else "/".join(parts[: 1 if len(parts) == 2 else 2])


def all_mutants(root: Path) -> dict[str, list[mutants.Mutant]]:
    """By package, without those that are known to change nothing."""
    found = defaultdict(list)
    for part in ("core", "operators", "panels"):
        for path in sorted((root / part).rglob("*.py")):
            name = path.relative_to(root).as_posix()
            found[package_of(name)] += [
                mutant for mutant in mutants.mutants(root, name) if not equivalent_mutants.reason(mutant)
            ]
    return dict(found)


def drawn(decks: dict[str, list[mutants.Mutant]], seed: int, count: int) -> Iterator[mutants.Mutant]:
    """Mutants in rounds, one of each package in a round, no two of one line; the same ones while others come or go."""
    order = {
        name: iter(sorted(deck, key=lambda mutant: hashlib.sha256(repr((seed, mutant.key)).encode()).digest()))
        for name, deck in decks.items()
    }
    lines = set()
    for _ in range(min(count, max(map(len, decks.values())))):
        for name, deck in list(order.items()):
            mutant = next((one for one in deck if (one.path, one.line) not in lines), None)
            if mutant is None:
                del order[name]
            else:
                lines.add((mutant.path, mutant.line))
                yield mutant


def texts_of_tests(text: str) -> dict[str, str]:
    """Of each test function of a file a digest of its own text and of what does not belong to another test."""
    tree = ast.parse(text)
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef)]
    functions = {
        "::".join([*holder, node.name]): node
        for holder, nodes in [((), tree.body), *(((one.name,), one.body) for one in classes)]
        for node in nodes
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test")
    }
    lines = text.splitlines()
    own = {}
    for name, node in functions.items():
        start = min(one.lineno for one in (node, *node.decorator_list)) - 1
        own[name] = "\n".join(lines[start : node.end_lineno])
        lines[start : node.end_lineno] = [""] * (node.end_lineno - start)
    rest = "\n".join(line for line in lines if line.strip())
    return {name: hashlib.sha256((rest + part).encode()).hexdigest() for name, part in own.items()}


def function_of(test: str) -> str:
    """The test function of a node id, without its file and its parameters."""
    return test.partition("[")[0].partition("::")[2]


def report(results: list[tuple[mutants.Mutant, dict]]) -> str:
    counts = defaultdict(Counter)
    for mutant, answer in results:
        counts[package_of(mutant.path)][answer["outcome"]] += 1
    rows = ["{:24} {:>6} {:>6} {:>6}".format("package", "drawn", "found", "share")]
    for package in sorted(counts):
        count = counts[package]
        found = count.total() - sum(count[outcome] for outcome in MISSED)
        rows.append("{:24} {:6d} {:6d} {:5.0f}%".format(package, count.total(), found, 100.0 * found / count.total()))
    total = Counter(answer["outcome"] for _, answer in results)
    rows.append("{} mutants: {}".format(total.total(), ", ".join("{} {}".format(*one) for one in total.most_common())))
    rows += ["{}  {}".format(answer["outcome"], mutant) for mutant, answer in results if answer["outcome"] in MISSED]
    return "\n".join(rows)


def too_few(results: list[tuple[mutants.Mutant, dict]]) -> list[str]:
    """Packages of which enough mutants were drawn and not enough were found."""
    drawn_of, missed = Counter(), Counter()
    for mutant, answer in results:
        drawn_of[package_of(mutant.path)] += 1
        missed[package_of(mutant.path)] += answer["outcome"] in MISSED
    return [
        package
        for package, count in drawn_of.items()
        if count >= LEAST_DRAWN and missed[package] > (1.0 - LEAST) * count
    ]


class Project:
    """A copy of the project, and a process in which tests run on it."""

    def __init__(self, kept: Path = KEPT, found: Path = FOUND):
        self.kept, self.found_file = kept, found
        texts = found.read_text(encoding="utf-8").splitlines() if found.is_file() else []
        self.found = dict(json.loads(text) for text in texts)
        self.results: list[tuple[mutants.Mutant, dict]] = []

    def __enter__(self) -> Project:
        self.folder = Path(tempfile.mkdtemp(prefix="body_moments_mutation_"))
        self.root = self.folder / "project"
        shutil.copytree(ROOT, self.root, ignore=shutil.ignore_patterns(".envs", ".git", "__pycache__", "dist", "demo"))
        self.server = self._start("server.py")
        self.warm = None
        return self

    def _start(self, name: str, *words: str) -> subprocess.Popen:
        return subprocess.Popen(
            [sys.executable, "-P", "-W", "ignore", PROCESS / name, self.root, *words],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, "PYTHONPYCACHEPREFIX": str(self.folder / "pycache")},
            text=True,
        )

    def __exit__(self, *_error) -> None:
        for process in (self.server, self.warm):
            if process is not None:
                process.stdin.close()
                process.wait()
                process.stdout.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def load_tests(self, files: Iterable[str]) -> None:
        """Start the process that knows the tests of some files or folders."""
        self.warm = self._start("warm.py", *files)
        assert json.loads(self.warm.stdout.readline())["count"], "no tests"

    def ask(self, tests: list, seconds: float, lines: Path | None = None) -> dict:
        return _answer(self.server, {"tests": tests, "seconds": seconds, "lines": lines and str(lines)})

    def note_lines(self, tests: Iterable[str]) -> None:
        """Run the tests that are new or have changed, and know for each line of the product which tests run it."""
        self.kept.mkdir(parents=True, exist_ok=True)
        self.tests_of, self.seconds, self.texts = defaultdict(set), {}, {}
        for test in tests:
            place = self.root / test
            for path in sorted(place.rglob("test_*.py")) if place.is_dir() else [place]:
                if path.name not in LEFT_OUT:
                    self._note_file(path.relative_to(self.root).as_posix())

    def _note_file(self, file: str) -> None:
        self.texts[file] = (self.root / file).read_text(encoding="utf-8")
        kept = self.kept / (file.replace("/", ".") + ".json")
        notes = json.loads(kept.read_text(encoding="utf-8")) if kept.is_file() else {"texts": {}, "tests": {}}
        texts = texts_of_tests(self.texts[file])
        changed = {name for name in texts if notes["texts"].get(name) != texts[name]}
        tests = {name: note for name, note in notes["tests"].items() if function_of(name) in set(texts) - changed}
        if changed:
            found = self.folder / "lines.json"
            found.unlink(missing_ok=True)
            self.ask([[file, sorted(changed)]], 3600.0, found)
            new = json.loads(found.read_text(encoding="utf-8")) if found.is_file() else {}
            for note in new.values():
                note["modules"] = {path: self._keep_text(path) for path in note["lines"]}
            tests |= new
            kept.write_text(json.dumps({"texts": texts, "tests": tests}), encoding="utf-8")
        for name, note in tests.items():
            if note["ok"]:
                self.seconds[name] = note["seconds"]
                for path, lines in note["lines"].items():
                    following = self._following_lines(path, note["modules"][path])
                    for line in {now for before in lines for now in following.get(before, ())}:
                        self.tests_of[path, line].add(name)

    @cache  # noqa: B019 one project a process
    def _keep_text(self, name: str) -> str:
        """Its digest, under which it is kept."""
        digest = self._digest(name).hex()
        kept = self.kept.parent / "texts" / digest
        if digest and not kept.is_file():
            kept.parent.mkdir(exist_ok=True)
            shutil.copyfile(self.root / name, kept)
        return digest

    @cache  # noqa: B019 one project a process
    def _following_lines(self, path: str, digest: str) -> dict[int, list[int]]:
        """For each line of a module as it was those that have its tests now: itself, and new ones in or beside it."""
        old_file, new_file = self.kept.parent / "texts" / digest, self.root / path
        if not digest or not new_file.is_file():
            return {}
        old, new = (file.read_text(encoding="utf-8").splitlines() for file in (old_file, new_file))
        following = defaultdict(list)
        for kind, old_start, old_end, new_start, new_end in SequenceMatcher(None, old, new, False).get_opcodes():
            if kind == "equal":
                for offset in range(old_end - old_start):
                    following[old_start + offset + 1].append(new_start + offset + 1)
            else:
                for line in range(old_start, old_end + 2):
                    following[line] += range(new_start + 1, new_end + 1)
        return dict(following)

    def _digest(self, name: str) -> bytes:
        path = self.root / name
        return hashlib.sha256(path.read_bytes()).digest() if path.is_file() else b""

    def try_mutant(self, mutant: mutants.Mutant) -> dict:
        """What comes of its tests, or came of them before if they found it."""
        name = "{} {} {}".format(self._digest(mutant.path).hex(), mutant.start, mutant)
        answer = self.found.get(name) or self._new_answer(mutant)
        self.results.append((mutant, answer))
        if answer["outcome"] not in MISSED and name not in self.found:
            self.found[name] = answer
            with self.found_file.open("a", encoding="utf-8") as file:
                file.write(json.dumps([name, answer]) + "\n")
        return answer

    def _new_answer(self, mutant: mutants.Mutant) -> dict:
        """What comes of the tests that run its line; where the line runs while it is imported, its module."""
        path = self.root / mutant.path
        text, status = path.read_text(encoding="utf-8"), path.stat()
        first, further = self.tests_for(mutant)
        if not first:
            return {"outcome": "no test", "test": "", "seconds": 0.0}
        job = {"path": mutant.path, "before": text, "text": mutant.text(text)}
        job["lines"] = list(range(mutant.line, mutant.line + mutant.before.count("\n") + 1))
        try:
            path.write_text(job["text"], encoding="utf-8")
            later = status.st_mtime_ns + (10 + len(self.results)) * 10**9  # no bytecode of another mutant fits
            os.utime(path, ns=(later, later))
            answer = self._outcome(mutant, job, first)
            if further and answer["outcome"] in MISSED:
                seconds = answer["seconds"]
                answer = self._outcome(mutant, job, further)
                answer["seconds"] += seconds
            declared = self._declaring(mutant)
            if declared and not mutant.is_imported and answer["outcome"] in MISSED:
                # what it is in may run while the module is imported, too
                answer = self.ask(_by_file(declared), 20.0 + sum(10.0 * self.seconds[name] for name in declared))
        finally:
            path.write_text(text, encoding="utf-8")
            os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))
        return answer

    def _outcome(self, mutant: mutants.Mutant, job: dict, tests: list[str]) -> dict:
        """What comes of some tests while the mutant is on the disk."""
        limits = [int(20.0 + 10.0 * self.seconds[name]) for name in tests]
        seconds = float(sum(limits))
        if not mutant.is_imported:
            answer = _answer(self.warm, {**job, "tests": tests, "limits": limits, "seconds": seconds})
            if answer["outcome"] != "cold":
                return answer
        return self.ask(_by_file(tests), seconds)

    def tests_for(self, mutant: mutants.Mutant) -> tuple[list[str], list[str]]:
        """The tests that may find it, those of its own folder first, the quickest first; and further ones."""
        near = "/{}/".format(package_of(mutant.path).rpartition("/")[2])
        names = {test for look, test in READERS.items() if look.match(mutant.before) and test in self.seconds}
        if mutant.is_imported:
            module = mutant.path[:-3].replace("/", ".")
            importers = {file for file, text in self.texts.items() if module in text}
            names |= {name for name in self.seconds if name.partition("::")[0] in importers}
            names.update(self._declaring(mutant))
            names = names.union(*(tests for (path, _), tests in self.tests_of.items() if path == mutant.path))
        else:
            names |= self.tests_of.get((mutant.path, mutant.line), set())
        files = {name.partition("::")[0] for name in names}
        # of what is cached, the lines run in the first of a file's tests alone
        others = {name for name in self.seconds if name.partition("::")[0] in files} - names
        order = {name: (name in others, near not in name, self.seconds[name], name) for name in names | others}
        sorted_names = sorted(order, key=order.__getitem__)
        first = [*self._quick((name for name in sorted_names if CORPUS not in name), FIRST_SECONDS)]
        first += self._quick((name for name in sorted_names if CORPUS in name and name in names), FIRST_SECONDS)
        done = set(first)
        further = self._quick((name for name in sorted_names if name in names and name not in done), FURTHER_SECONDS)
        return first, list(further)

    def _declaring(self, mutant: mutants.Mutant) -> list[str]:
        """The tests of what the classes of its module declare."""
        return [name for name in self.seconds if name.endswith("[body_moments/{:s}]".format(mutant.path))]

    def _quick(self, names: Iterable[str], seconds: float) -> Iterator[str]:
        """The first ones, for as many seconds; at least one."""
        total = 0.0
        for name in names:
            if total and total + self.seconds[name] > seconds:
                break
            total += self.seconds[name]
            yield name


def _answer(process: subprocess.Popen, job: dict) -> dict:
    process.stdin.write(json.dumps(job) + "\n")
    process.stdin.flush()
    return json.loads(process.stdout.readline())


def _by_file(names: list[str]) -> list:
    files = defaultdict(list)
    for name in names:
        file, _, test = name.partition("::")
        files[file].append(test)
    return [[file, tests] for file, tests in files.items()]
