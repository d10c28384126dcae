"""Operations on many numbers at once, with the bits of one at a time."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np

from symgen.ir.interpret import OPERATIONS, round_float32, round_literal
from symgen.ir.kernel import Function, Literal, OperationName, Scalar
from symgen.ir.pairs.wide_functions import is_wide_operation, wide_function

# A number of the scalar type for each state, or rows of them.
Lanes: TypeAlias = Any
# Of rows: an array of their places, or a slice where they follow each other.
Places: TypeAlias = Any
TYPES: dict[Scalar, Any] = {"float64": np.float64, "float32": np.float32}


def number(literal: Literal, scalar: Scalar) -> Any:
    """In the scalar type."""
    return TYPES[scalar](round_literal(literal.value, scalar))


def together(places: Sequence[int]) -> Places:
    """Places that follow each other as one piece: such rows are read where they are, and not copied."""
    first, count = places[0], len(places)
    # most are told apart by their ends
    if places[-1] - first == count - 1 and [*places] == [*range(first, first + count)]:
        return slice(first, first + count)
    return np.array(places)


class LaneArithmetic:
    """Operations on arrays of a scalar type."""

    def __init__(self, scalar: Scalar, sincos: Function | None) -> None:
        self.scalar, self._sincos = scalar, sincos
        self._functions: dict[str, _Steps] = {}

    def apply(self, operation: OperationName, operands: Sequence[Lanes]) -> Sequence[Lanes]:
        """The results of an operation; operands are arrays of one shape, or numbers."""
        if (vectorised := VECTORISED.get(operation)) is not None:
            return (vectorised(*operands),)
        if operation == "sincos":
            return self._pair(operands)
        if is_wide_operation(operation):
            return self._steps(operation, lambda: wide_function(operation, self.scalar))(operands)
        return (self._one_by_one(OPERATIONS[operation], operands),)

    def _pair(self, angles: Sequence[Lanes]) -> Sequence[Lanes]:
        if (sincos := self._sincos) is not None:
            return self._steps("sincos", lambda: sincos)(angles)
        return tuple(self._one_by_one(function, angles) for function in (_sine, _cosine))

    def _steps(self, name: str, function: Callable[[], Function]) -> _Steps:
        if name not in self._functions:
            self._functions[name] = _Steps(function(), self)
        return self._functions[name]

    def _one_by_one(self, function: Callable[..., float], operands: Sequence[Lanes]) -> Lanes:
        """A function of the library, which NumPy has with other bits."""
        given = np.broadcast_arrays(*operands)
        rounding = round_float32 if self.scalar == "float32" else float
        values = [rounding(function(*one)) for one in zip(*(lane.ravel().tolist() for lane in given), strict=True)]
        return np.array(values, TYPES[self.scalar]).reshape(given[0].shape)


class _Steps:
    """A function with its operands found by place, and with its operations found once for all calls."""

    def __init__(self, function: Function, arithmetic: LaneArithmetic) -> None:
        self._arithmetic = arithmetic
        places = {name: place for place, name in enumerate(function.parameters)}
        literals = {o: None for s in function.statements for o in s.operands if isinstance(o, Literal)}
        self._numbers = [number(literal, arithmetic.scalar) for literal in literals]
        known = {literal: len(places) + place for place, literal in enumerate(literals)}
        count = len(places) + len(literals)
        self._steps: list[tuple[Callable[..., Lanes] | None, OperationName, tuple[int, ...]]] = []
        for statement in function.statements:
            operands = (known[o] if isinstance(o, Literal) else places[o.name] for o in statement.operands)
            self._steps.append((VECTORISED.get(statement.operation), statement.operation, tuple(operands)))
            for target in statement.targets:
                places[target], count = count, count + 1
        self._results = [places[name] for name in function.results]

    def __call__(self, operands: Sequence[Lanes]) -> Sequence[Lanes]:
        values = [*operands, *self._numbers]
        for vectorised, operation, given in self._steps:
            if vectorised is not None:
                values.append(vectorised(*[values[place] for place in given]))
            else:
                values += self._arithmetic.apply(operation, [values[place] for place in given])
        return [values[place] for place in self._results]


def _sine(x: float) -> float:
    return math.sin(x) if math.isfinite(x) else math.nan


def _cosine(x: float) -> float:
    return math.cos(x) if math.isfinite(x) else math.nan


def _ratio_or_zero(a: Lanes, b: Lanes) -> Lanes:
    return np.where(b == 0, b.dtype.type(0), np.divide(a, b))


# Operations whose bits are those of every IEEE machine: those that write their results where these are wanted, and all.
UFUNCS: dict[OperationName, Callable[..., Lanes]] = {
    "add": np.add,
    "sub": np.subtract,
    "mul": np.multiply,
    "div": np.divide,
    "neg": np.negative,
    "abs": np.abs,
    "sqrt": np.sqrt,
    "copysign": np.copysign,
}
VECTORISED: dict[OperationName, Callable[..., Lanes]] = UFUNCS | {
    "ratio_or_zero": _ratio_or_zero,
    "min": lambda a, b: np.where(a < b, a, b),
    "max": lambda a, b: np.where(a > b, a, b),
}
