"""Scalars and their gradients in double precision, for the way of a search that 40 digits decide at its end.

Gradients come from one sweep back for each output, over what that output reaches (Griewank and Walther, Evaluating
Derivatives, ch. 3), and are sparse.  Sines and cosines are the same on every machine.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TypeAlias

from symgen.model.configurations.sparse import Row
from symgen.runtime.effort import SLOPE, spend
from symgen.symbolic.angles.sines import cosine, sine
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import topological

_Step: TypeAlias = tuple[int, str, int, int]
"""The place of an operation, its name, and the places of its operands: -1 where there is no second one."""
_Way: TypeAlias = tuple[int, list[_Step], list[tuple[int, int]]]
"""The place of an output; the operations behind it, last first; the places and numbers of the symbols it reaches."""


class FloatGradients:
    """Values and gradients of a fixed list of scalars by some symbols, which rows number in their order."""

    def __init__(self, outputs: Sequence[Scalar], names: Sequence[str]) -> None:
        nodes = topological(outputs)
        self._evaluate = Evaluator(nodes)
        place = {node: k for k, node in enumerate(nodes)}
        column = {name: j for j, name in enumerate(names)}
        self._outputs = [place[output] for output in outputs]
        columns = {
            place[node]: column[str(node.payload)]
            for node in nodes
            if node.op == "symbol" and str(node.payload) in column
        }
        # only what depends on one of the symbols
        moving = set(columns)
        for k, node in enumerate(nodes):
            if any(place[argument] in moving for argument in node.args):
                moving.add(k)
        self._ways: list[_Way] = []
        for output in outputs:
            reached = [place[node] for node in reversed(topological([output])) if place[node] in moving]
            steps: list[_Step] = []
            for k in reached:
                if operands := [place[argument] for argument in nodes[k].args]:
                    first, second = (*operands, -1)[:2]
                    steps.append((k, nodes[k].op, first, second))
            own = [(k, columns[k]) for k in reached if k in columns]
            self._ways.append((place[output], steps, own))

    def __call__(self, point: Mapping[str, float]) -> tuple[list[float], list[Row]] | None:
        """The outputs and their slopes; None where one has no value."""
        known = self._evaluate(point)
        values = [known[place] for place in self._outputs]
        if not all(map(math.isfinite, values)):
            return None
        try:
            rows = [_slopes(way, known) for way in self._ways]
        except (ArithmeticError, ValueError):
            return None
        if not all(math.isfinite(value) for row in rows for value in row.values()):
            return None
        return values, rows


def _slopes(way: _Way, known: Sequence[float]) -> Row:
    output, steps, columns = way
    spend(SLOPE * len(steps))
    adjoint = [0.0] * len(known)
    adjoint[output] = 1.0
    # sums and products, which most steps are, as they stand
    for place, op, first, second in steps:
        weight = adjoint[place]
        if not weight:
            continue
        if op == "mul":
            adjoint[first] += weight * known[second]
            adjoint[second] += weight * known[first]
        elif op == "add":
            adjoint[first] += weight
            adjoint[second] += weight
        elif op == "sub":
            adjoint[first] += weight
            adjoint[second] -= weight
        else:
            args = [known[first]] if second < 0 else [known[first], known[second]]
            partials = _partials(op, args, known[place])
            adjoint[first] += weight * partials[0]
            if second >= 0:
                adjoint[second] += weight * partials[1]
    return {column: slope for place, column in columns if (slope := adjoint[place])}


def _partials(op: str, args: list[float], value: float) -> tuple[float, ...]:
    match op:
        case "div":
            return 1 / args[1], -value / args[1]
        case "ratio_or_zero":
            return (1 / args[1], -value / args[1]) if args[1] else (0.0, 0.0)
        case "neg":
            return (-1.0,)
        case "abs":
            return (math.copysign(1.0, args[0]),)
        case "sqrt":
            return (0.5 / value if value else 0.0,)
        case "copysign":
            return math.copysign(1.0, args[1]) * math.copysign(1.0, args[0]), 0.0
        case "sin":
            return (cosine(args[0]),)
        case "cos":
            return (-sine(args[0]),)
        case "exp":
            return (value,)
        case "log":
            return (1 / args[0],)
        case "tan":
            return (1 + value * value,)
        case _:
            return (0.0,) * len(args)
