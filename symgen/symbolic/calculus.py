"""Derivatives on the graph: along a direction (forward) and of one output by many symbols (reverse).

Both are memoised over the graph, so a shared intermediate is differentiated once (Griewank and Walther, Evaluating
Derivatives, ch. 3).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from symgen.diagnostics import SymgenBug
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import topological


def partials(graph: Graph, node: Scalar) -> tuple[Scalar, ...]:
    """The derivative of a node by each of its operands."""
    args = node.args
    match node.op:
        case "add":
            return (graph.one, graph.one)
        case "sub":
            return (graph.one, graph.const(-1))
        case "neg":
            return (graph.const(-1),)
        case "rounded":
            return (graph.one,)
        case "mul":
            return (args[1], args[0])
        case "div":
            return (1 / args[1], -(node / args[1]))
        case "ratio_or_zero":
            # a constant 0 where b is 0, like the ratio itself
            inverse = graph.function("ratio_or_zero", (graph.one, args[1]))
            return (inverse, -(node * inverse))
        case "sqrt":
            return (Fraction(1, 2) / node,)
        case "abs":
            return (graph.function("copysign", (graph.one, args[0])),)
        case "copysign":
            # of a magnitude that is not negative
            return (graph.function("copysign", (graph.one, args[1])), graph.zero)
        case "max" | "min":
            # where both are equal either derivative will do
            larger = (1 + graph.function("copysign", (graph.one, args[0] - args[1]))) / 2
            return (larger, 1 - larger) if node.op == "max" else (1 - larger, larger)
        case "pow":
            exponent = node.payload
            assert isinstance(exponent, Fraction)
            return (graph.power(args[0], exponent - 1) * exponent,)
        case "sin":
            return (graph.trig("cos", args[0]),)
        case "cos":
            return (-graph.trig("sin", args[0]),)
        case "tan":
            return (1 + node * node,)
        case "asin":
            return (1 / graph.function("sqrt", (1 - args[0] * args[0],)),)
        case "acos":
            return (-1 / graph.function("sqrt", (1 - args[0] * args[0],)),)
        case "atan":
            return (1 / (1 + args[0] * args[0]),)
        case "atan2":
            square = args[0] * args[0] + args[1] * args[1]
            return (args[1] / square, -(args[0] / square))
        case "exp":
            return (node,)
        case "log":
            return (1 / args[0],)
        case "sinh":
            return (graph.function("cosh", args),)
        case "cosh":
            return (graph.function("sinh", args),)
        case "tanh":
            # 1 - tanh^2 loses every digit where tanh is near 1
            small = graph.function("exp", (-2 * graph.function("abs", args),))
            return (4 * small / ((1 + small) * (1 + small)),)
        case _:
            raise SymgenBug(f"calculus: no derivative for {node.op}")


def derivative_along(graph: Graph, outputs: Sequence[Scalar], direction: Mapping[Scalar, Scalar]) -> list[Scalar]:
    """d/ds of the outputs where each symbol moves with the given rate; symbols not named stand still."""
    rate: dict[Scalar, Scalar] = {}
    for node in topological(outputs):
        if node.op in ("const", "symbol"):
            rate[node] = direction.get(node, graph.zero)
        elif all(rate[argument].is_zero for argument in node.args):
            rate[node] = graph.zero
        elif node.op == "div":
            # (a' - (a/b) b') / b: one division more instead of three
            numerator, denominator = node.args
            rate[node] = (rate[numerator] - node * rate[denominator]) / denominator
        else:
            terms = zip(partials(graph, node), (rate[argument] for argument in node.args), strict=True)
            rate[node] = graph.sum(partial * term for partial, term in terms if not term.is_zero)
    return [rate[output] for output in outputs]


def gradient(graph: Graph, output: Scalar, symbols: Sequence[Scalar]) -> list[Scalar]:
    """The derivatives of one output by the symbols, in one reverse sweep."""
    order = topological([output])
    touched = set(symbols)
    for node in order:
        if not touched.isdisjoint(node.args):
            touched.add(node)
    adjoint: dict[Scalar, Scalar] = {output: graph.one}
    for node in reversed(order):
        if node not in adjoint or node.op in ("const", "symbol") or node not in touched:
            continue
        for partial, argument in zip(partials(graph, node), node.args, strict=True):
            if argument in touched:
                adjoint[argument] = adjoint.get(argument, graph.zero) + adjoint[node] * partial
    return [adjoint.get(symbol, graph.zero) for symbol in symbols]


def jacobian(graph: Graph, outputs: Sequence[Scalar], symbols: Sequence[Scalar]) -> tuple[tuple[Scalar, ...], ...]:
    """The derivatives of the outputs by the symbols: a row for each output, in one reverse sweep each."""
    return tuple(tuple(gradient(graph, output, symbols)) for output in outputs)
