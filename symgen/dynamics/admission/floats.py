"""Scalars and their gradients in double precision, for the way of a search that 40 digits decide at its end.

Gradients come from one sweep back for each output, over what that output reaches (Griewank and Walther, Evaluating
Derivatives, ch. 3), and are sparse.  Sines and cosines are the same on every machine.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TypeAlias

from symgen.effort import SLOPE, spend
from symgen.graph.evaluate import Evaluator
from symgen.graph.scalar import Scalar
from symgen.graph.sines import cosine, sine
from symgen.graph.traverse import topological
from symgen.model.sparse import Row

_Way: TypeAlias = tuple[int, list[tuple[int, str, tuple[int, ...]]], list[tuple[int, int]]]
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
            steps = [(k, nodes[k].op, tuple(place[argument] for argument in nodes[k].args)) for k in reached]
            own = [(k, columns[k]) for k in reached if k in columns]
            self._ways.append((place[output], [step for step in steps if step[2]], own))

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
    adjoint = {output: 1.0}
    for place, op, arguments in steps:
        weight = adjoint.get(place, 0.0)
        if weight:
            partials = _partials(op, [known[k] for k in arguments], known[place])
            for argument, partial in zip(arguments, partials, strict=True):
                adjoint[argument] = adjoint.get(argument, 0.0) + weight * partial
    return {column: adjoint[place] for place, column in columns if place in adjoint}


def _partials(op: str, args: list[float], value: float) -> tuple[float, ...]:
    match op:
        case "add":
            return 1.0, 1.0
        case "sub":
            return 1.0, -1.0
        case "mul":
            return args[1], args[0]
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
