# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""All the small mistakes that one could make in a module: its text with one expression or statement changed."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

NEGATED = {
    **{ast.Lt: ast.GtE, ast.GtE: ast.Lt, ast.Gt: ast.LtE, ast.LtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq},
    **{ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In},
}
SHIFTED = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt}
OTHER = {
    **{ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult},
    **{ast.FloorDiv: ast.Mult, ast.Mod: ast.Mult, ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd},
}
WHOLE = {"len", "sum", "count_nonzero"}  # what gives whole numbers
WHOLE_ATTRIBUTES = {"size", "ndim", "shape"}


@dataclass(frozen=True)
class Mutant:
    """One changed place of a module.

    path: of the module, from the root. line: of the place. function: qualified name of the function that holds it, or
    of the class or the module's name that it is a value of. is_imported: whether it runs while the module is imported.
    before, after: the place's text. start, end: its characters in the module's text.
    """

    path: str
    line: int
    function: str
    is_imported: bool
    before: str
    after: str
    start: int
    end: int

    def text(self, text: str) -> str:
        return text[: self.start] + self.after + text[self.end :]

    @property
    def key(self) -> tuple[str, str, str, str]:
        """What names it while lines move."""
        return self.path, self.function, " ".join(self.before.split()), " ".join(self.after.split())

    def __str__(self) -> str:
        return "{}:{} {}: {} -> {}".format(self.path, self.line, self.function or "-", *self.key[2:])


def mutants(root: Path, path: str) -> list[Mutant]:
    """Those of a module, in the order of its text; each parses and differs from what is there."""
    text = (root / path).read_text(encoding="utf-8")
    return list(_Places(path, text).found(ast.parse(text), "", True))


class _Places:
    def __init__(self, path: str, text: str):
        self.path, self.text = path, text
        self.starts = [0]
        for line in text.splitlines(keepends=True):
            self.starts.append(self.starts[-1] + len(line))
        self.lines = text.splitlines()

    def position(self, line: int, column: int) -> int:
        ahead = self.lines[line - 1].encode()[:column].decode() if line <= len(self.lines) else ""
        return self.starts[line - 1] + len(ahead)

    def found(self, node: ast.AST, function: str, is_imported: bool) -> Iterator[Mutant]:
        for changed in _changes(node):
            start = self.position(node.lineno, node.col_offset)
            end = self.position(node.end_lineno, node.end_col_offset)
            after = ast.unparse(ast.fix_missing_locations(changed))
            if isinstance(node, ast.expr) and not isinstance(changed, ast.Constant):
                after = "({})".format(after)
            before = self.text[start:end]
            yield Mutant(self.path, node.lineno, function, is_imported, before, after, start, end)
        for field, child in _children(node):
            name = _name(child, is_imported)
            inner = ".".join(part for part in (function, name) if part)
            is_default = field == "args" and isinstance(child, ast.arguments)
            if not _is_left_out(node, field, child):
                is_run = is_default or is_imported and not isinstance(child, ast.FunctionDef)
                yield from self.found(child, inner, is_run)


def _name(node: ast.AST, is_imported: bool) -> str:
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return node.name
    target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", None)
    is_value = is_imported and isinstance(node, ast.Assign | ast.AnnAssign) and isinstance(target, ast.Name)
    return target.id if is_value else ""


def _children(node: ast.AST) -> Iterator[tuple[str, ast.AST]]:
    for field, value in ast.iter_fields(node):
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST):
                yield field, child


def _is_left_out(node: ast.AST, field: str, child: ast.AST) -> bool:
    """Annotations but for Blender's properties, decorators, texts in pieces, what is for type checkers alone."""
    if field == "annotation":
        return not isinstance(child, ast.Call)
    if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
        return True
    return field in ("returns", "decorator_list", "bases", "keywords" if isinstance(node, ast.ClassDef) else "") or (
        isinstance(child, ast.JoinedStr)
    )


def _changes(node: ast.AST) -> Iterator[ast.AST]:
    change = getattr(_Changes, type(node).__name__, None)
    if change is not None:
        yield from change(node)


class _Changes:
    """What each kind of node becomes."""

    @staticmethod
    def Compare(node):
        if len(node.ops) == 1:
            kind = type(node.ops[0])
            yield ast.Compare(node.left, [NEGATED[kind]()], node.comparators)
            if kind in SHIFTED and any(map(_is_whole, (node.left, *node.comparators))):
                yield ast.Compare(node.left, [SHIFTED[kind]()], node.comparators)

    @staticmethod
    def BinOp(node):
        if type(node.op) in OTHER and not _is_text(node.left) and not _is_text(node.right):
            yield ast.BinOp(node.left, OTHER[type(node.op)](), node.right)
        if isinstance(node.op, ast.MatMult):
            yield ast.BinOp(node.right, ast.MatMult(), node.left)

    @staticmethod
    def AugAssign(node):
        if type(node.op) in OTHER:
            yield ast.AugAssign(node.target, OTHER[type(node.op)](), node.value)

    @staticmethod
    def BoolOp(node):
        yield ast.BoolOp(ast.Or() if isinstance(node.op, ast.And) else ast.And(), node.values)
        for index in range(len(node.values)):
            rest = node.values[:index] + node.values[index + 1 :]
            yield rest[0] if len(rest) == 1 else ast.BoolOp(node.op, rest)

    @staticmethod
    def UnaryOp(node):
        if not isinstance(node.operand, ast.Constant):
            yield node.operand

    @staticmethod
    def IfExp(node):
        yield node.body
        yield node.orelse

    @staticmethod
    def Constant(node):
        value = node.value
        if isinstance(value, bool):
            yield ast.Constant(not value)
        elif isinstance(value, int):
            yield ast.Constant(value + 1)
        elif isinstance(value, float) and value == value:
            yield ast.Constant(1.0 if value == 0.0 else 1000.0 * value if abs(value) < 1e-3 else 2.0 * value)

    @staticmethod
    def Call(node):
        for index, keyword in enumerate(node.keywords):
            if keyword.arg:
                yield ast.Call(node.func, node.args, node.keywords[:index] + node.keywords[index + 1 :])

    @staticmethod
    def Expr(node):
        if not isinstance(node.value, ast.Constant | ast.Yield | ast.YieldFrom | ast.Await):
            yield ast.Pass()

    @staticmethod
    def Return(node):
        if node.value is not None and not (isinstance(node.value, ast.Constant) and node.value.value is None):
            yield ast.Return(ast.Constant(None))

    @staticmethod
    def Raise(node):
        yield ast.Pass()

    @staticmethod
    def Continue(node):
        yield ast.Break()

    @staticmethod
    def Break(node):
        yield ast.Continue()


def _is_whole(node: ast.AST) -> bool:
    if isinstance(node, ast.Constant):
        return type(node.value) is int
    if isinstance(node, ast.Call):
        return getattr(node.func, "id", getattr(node.func, "attr", "")) in WHOLE
    if isinstance(node, ast.Subscript):
        return _is_whole(node.value)
    return isinstance(node, ast.Attribute) and node.attr in WHOLE_ATTRIBUTES


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))
