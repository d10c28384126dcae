"""From the user's expressions to scalars of a graph."""

from __future__ import annotations

from collections.abc import Mapping

from symgen.diagnostics import SymgenBug
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import PI, Scalar


def translate(graph: Graph, expression: Expression, names: Mapping[str, Scalar]) -> Scalar:
    """The scalar of `expression`, every name looked up in `names`."""
    match expression:
        case Number(value=value):
            return graph.const(value)
        case Pi():
            return graph.const(PI)
        case Name(name=name):
            if name not in names:
                raise SymgenBug(f"translate: unresolved name {name}")
            return names[name]
        case Negation(operand=operand):
            return -translate(graph, operand, names)
        case Power(base=base, exponent=exponent):
            return graph.power(translate(graph, base, names), exponent)
        case Call(function=function, arguments=arguments):
            return graph.function(function, tuple(translate(graph, argument, names) for argument in arguments))
        case Binary(operator=operator, left=left, right=right):
            a, b = translate(graph, left, names), translate(graph, right, names)
            match operator:
                case "+":
                    return a + b
                case "-":
                    return a - b
                case "*":
                    return a * b
                case "/":
                    return a / b
