"""Kernels at many states at once, the same operations with the same bits as `ir/interpret.py` has one by one."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np

from symgen.ir.interpret import OPERATIONS, round_float32, round_literal
from symgen.ir.kernel import (
    Block,
    Check,
    Function,
    Kernel,
    Literal,
    Local,
    Operand,
    OperationName,
    Scalar,
    Statement,
    Status,
)
from symgen.ir.wide_functions import is_wide, wide_function

# A number of the scalar type for each state.
_Lanes: TypeAlias = Any
_TYPES: dict[Scalar, Any] = {"float64": np.float64, "float32": np.float32}


def run_many(
    kernel: Kernel, sincos: Function | None, scalar: Scalar, arguments: Sequence[Mapping[str, Sequence[float]]]
) -> list[tuple[Status, list[float]]]:
    """The status of each state and, where it is OK, the outputs; `arguments` hold the parameters `p`, too."""
    with np.errstate(all="ignore"):
        return _KernelRun(kernel, sincos, scalar, arguments).outcomes()


class _KernelRun:
    def __init__(
        self, kernel: Kernel, sincos: Function | None, scalar: Scalar, given: Sequence[Mapping[str, Sequence[float]]]
    ) -> None:
        self._kernel, self._sincos, self._scalar = kernel, sincos, scalar
        self._type, self._count = _TYPES[scalar], len(given)
        columns = ((load, [one[load.argument][load.index] for one in given]) for load in kernel.loads)
        self._values: dict[str, _Lanes] = {load.local: np.array(column, self._type) for load, column in columns}
        self._numbers: dict[Literal, _Lanes] = {}
        self._functions: dict[OperationName, _Steps] = {}

    def outcomes(self) -> list[tuple[Status, list[float]]]:
        """Of all states."""
        status = np.zeros(self._count, dtype=int)
        for block in self._kernel.blocks:
            status = np.where(status == 0, self._block(block, self._values), status)
        outputs = np.empty((len(self._kernel.outputs), self._count), self._type)
        for place, output in enumerate(self._kernel.outputs):
            outputs[place] = self._operand(output, self._values)
        status = np.where((status == 0) & ~np.isfinite(outputs).all(axis=0), Status.NOT_FINITE, status)
        found = zip(status.tolist(), outputs.T.tolist(), strict=True)
        return [(Status(code), entries if code == 0 else []) for code, entries in found]

    def _block(self, block: Block, values: dict[str, _Lanes]) -> _Lanes:
        """The first status of each state."""
        self._statements(block.statements, values)
        status = np.zeros(self._count, dtype=int)
        for check in block.checks:
            status = np.where(status == 0, self._check(check, values), status)
        return status

    def _check(self, check: Check, values: dict[str, _Lanes]) -> _Lanes:
        value, limit = self._operand(check.value, values), self._operand(check.limit, values)
        failed = ~(value >= limit if check.inclusive else value > limit)
        first: _Lanes = 0
        if check.first is not None and np.any(failed):
            first = self._block(check.first, dict(values))
        return np.where(failed, np.where(first == 0, check.status, first), 0)

    def _statements(self, statements: Iterable[Statement], values: dict[str, _Lanes]) -> None:
        for statement in statements:
            operands = [
                values[o.name] if o.__class__ is Local else self._operand(o, values) for o in statement.operands
            ]
            if (vectorised := VECTORISED.get(statement.operation)) is not None:
                values[statement.targets[0]] = vectorised(*operands)
                continue
            results: Sequence[_Lanes]
            if statement.operation == "sincos":
                results = self._pair(operands[0])
            elif is_wide(statement):
                results = self._wide(statement.operation)(operands)
            else:
                results = (self._one_by_one(OPERATIONS[statement.operation], operands),)
            values.update(zip(statement.targets, results, strict=True))

    def _pair(self, angle: _Lanes) -> tuple[_Lanes, ...]:
        if self._sincos is not None:
            return self._called(self._sincos, [angle])
        return tuple(self._one_by_one(function, [angle]) for function in (_sine, _cosine))

    def _wide(self, operation: OperationName) -> _Steps:
        if operation not in self._functions:
            self._functions[operation] = _Steps(wide_function(operation, self._scalar), self._scalar)
        return self._functions[operation]

    def _called(self, function: Function, operands: Sequence[_Lanes]) -> tuple[_Lanes, ...]:
        values = dict(zip(function.parameters, operands, strict=True))
        self._statements(function.statements, values)
        return tuple(values[name] for name in function.results)

    def _one_by_one(self, function: Callable[..., float], operands: Sequence[_Lanes]) -> _Lanes:
        """A function of the library, which NumPy has with other bits."""
        given = np.broadcast_arrays(*operands, np.empty(self._count))[:-1]
        rounding = round_float32 if self._scalar == "float32" else float
        found = [rounding(function(*one)) for one in zip(*(lane.tolist() for lane in given), strict=True)]
        return np.array(found, self._type)

    def _operand(self, operand: Operand, values: Mapping[str, _Lanes]) -> _Lanes:
        if not isinstance(operand, Literal):
            return values[operand.name]
        if operand not in self._numbers:
            self._numbers[operand] = self._type(round_literal(operand.value, self._scalar))
        return self._numbers[operand]


class _Steps:
    """A function of vectorised operations with its operands found by place: kernels with twice the digits call a few
    of them tens of thousands of times."""

    def __init__(self, function: Function, scalar: Scalar) -> None:
        places = {name: place for place, name in enumerate(function.parameters)}
        self._numbers: list[_Lanes] = []
        literals = {o: None for s in function.statements for o in s.operands if isinstance(o, Literal)}
        known: dict[Operand, int] = {}
        for literal in literals:
            known[literal] = len(places) + len(self._numbers)
            self._numbers.append(_TYPES[scalar](round_literal(literal.value, scalar)))
        self._steps: list[tuple[Callable[..., _Lanes], tuple[int, ...]]] = []
        count = len(places) + len(self._numbers)
        for statement in function.statements:
            operands = (known[o] if isinstance(o, Literal) else places[o.name] for o in statement.operands)
            self._steps.append((VECTORISED[statement.operation], tuple(operands)))
            (target,) = statement.targets
            places[target], count = count, count + 1
        self._results = [places[name] for name in function.results]

    def __call__(self, operands: Sequence[_Lanes]) -> list[_Lanes]:
        values = [*operands, *self._numbers]
        for function, given in self._steps:
            if len(given) == 2:
                first, second = given
                values.append(function(values[first], values[second]))
            else:
                values.append(function(*(values[place] for place in given)))
        return [values[place] for place in self._results]


def _sine(x: float) -> float:
    return math.sin(x) if math.isfinite(x) else math.nan


def _cosine(x: float) -> float:
    return math.cos(x) if math.isfinite(x) else math.nan


def _ratio_or_zero(a: _Lanes, b: _Lanes) -> _Lanes:
    return np.where(b == 0, b.dtype.type(0), np.divide(a, b))


# Operations whose bits are those of every IEEE machine.
VECTORISED: dict[OperationName, Callable[..., _Lanes]] = {
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": np.divide,
    "neg": operator.neg,
    "abs": np.abs,
    "sqrt": np.sqrt,
    "copysign": np.copysign,
    "ratio_or_zero": _ratio_or_zero,
    "min": lambda a, b: np.where(a < b, a, b),
    "max": lambda a, b: np.where(a > b, a, b),
}
