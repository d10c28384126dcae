"""Text of an expression to nodes of the witness, through Python's own grammar and a list of what is allowed."""

from __future__ import annotations

import ast
from collections.abc import Callable
from fractions import Fraction

from symgen.laboratory.zoo.witness.numbers.tape import Node, NodeTape

FUNCTIONS = ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sqrt", "exp", "log", "sinh", "cosh", "tanh")
Lookup = Callable[[str], Node]


class NotReadError(ValueError):
    """The witness does not know this part of the language."""


def read_expression(tape: NodeTape, text: str, lookup: Lookup) -> Node:
    """The expression as a node; `lookup` gives the node of a name such as `l` or `tip.vx`."""
    source = " ".join(text.split())
    try:
        tree = ast.parse(source, mode="eval").body
    except SyntaxError as reason:
        raise NotReadError(f"{source!r}: {reason}") from reason
    return _SyntaxReader(tape, source, lookup).node(tree)


class _SyntaxReader:
    def __init__(self, tape: NodeTape, source: str, lookup: Lookup) -> None:
        self._tape, self._source, self._lookup = tape, source, lookup

    def node(self, tree: ast.expr) -> Node:
        tape = self._tape
        match tree:
            case ast.Constant():
                return tape.written(Fraction(ast.get_source_segment(self._source, tree) or ""))
            case ast.Name(id="pi"):
                return tape.pi()
            case ast.Name(id=name):
                return self._lookup(name)
            case ast.Attribute(value=ast.Name(id=owner), attr=what):
                return self._lookup(f"{owner}.{what}")
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -self.node(operand)
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                return self.node(operand)
            case ast.BinOp(left=left, op=ast.Pow(), right=right):
                return tape.power(self.node(left), self._rational(right))
            case ast.BinOp(left=left, op=operation, right=right):
                return self._binary(self.node(left), operation, self.node(right))
            case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in FUNCTIONS:
                return tape.call(name, *(self.node(arg) for arg in args))
        raise NotReadError(f"{self._source!r}: {ast.dump(tree)}")

    def _binary(self, left: Node, operation: ast.operator, right: Node) -> Node:
        match operation:
            case ast.Add():
                return left + right
            case ast.Sub():
                return left - right
            case ast.Mult():
                return left * right
            case ast.Div():
                return left / right
        raise NotReadError(f"{self._source!r}: {operation}")

    def _rational(self, tree: ast.expr) -> Fraction:
        match tree:
            case ast.Constant():
                return Fraction(ast.get_source_segment(self._source, tree) or "")
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -self._rational(operand)
            case ast.BinOp(left=left, op=ast.Div(), right=right):
                return self._rational(left) / self._rational(right)
            case ast.BinOp(left=left, op=ast.Pow(), right=right):
                return self._rational(left) ** self._rational(right).numerator
        raise NotReadError(f"{self._source!r}: an exponent that is not a rational number")
