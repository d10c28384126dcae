"""The syntax tree of the expressions a user writes: a handful of frozen nodes, no behaviour.

Every later stage (scalar graph, SymPy ring, CasADi, the multi-precision reference) translates this tree by its own
`match`; nothing here knows mechanics.  Spans do not take part in comparison.
"""

from __future__ import annotations

from dataclasses import field
from fractions import Fraction
from typing import Literal, TypeAlias

from symgen.diagnostics import Span
from symgen.records import dataclass

FunctionName: TypeAlias = Literal[
    "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sqrt", "exp", "log", "sinh", "cosh", "tanh"
]
FUNCTION_ARITY: dict[str, int] = {
    "sin": 1,
    "cos": 1,
    "tan": 1,
    "asin": 1,
    "acos": 1,
    "atan": 1,
    "atan2": 2,
    "sqrt": 1,
    "exp": 1,
    "log": 1,
    "sinh": 1,
    "cosh": 1,
    "tanh": 1,
}
BinaryOperator: TypeAlias = Literal["+", "-", "*", "/"]


@dataclass(frozen=True, slots=True)
class Number:
    """An exact decimal literal."""

    value: Fraction
    span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Pi:
    """The constant pi."""

    span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Name:
    """A declared name: coordinate, rate `x_dot`, acceleration `x_ddot`, parameter, definition, input, `t` in a path."""

    name: str
    span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Negation:
    """Unary minus."""

    operand: Expression
    span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Binary:
    """Sum, difference, product or quotient of two expressions."""

    operator: BinaryOperator
    left: Expression
    right: Expression
    span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Power:
    """A power with an exact rational exponent (the parser folds the exponent and bounds its size)."""

    base: Expression
    exponent: Fraction
    span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Call:
    """One of the functions of FUNCTION_ARITY, with as many arguments as it takes."""

    function: FunctionName
    arguments: tuple[Expression, ...]
    span: Span | None = field(default=None, compare=False, repr=False)


Expression: TypeAlias = Number | Pi | Name | Negation | Binary | Power | Call
