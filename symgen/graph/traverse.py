"""Walking a graph: operands before operators, substitution, operation counts."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from symgen.graph.scalar import Graph, Scalar


def topological(outputs: Iterable[Scalar], known: Container[Scalar] = ()) -> list[Scalar]:
    """Every node the outputs reach, depth first, operands before the node that uses them; `known` ones are left out."""
    order: list[Scalar] = []
    seen: set[Scalar] = set()
    # a node stands on the stack as itself until it is opened, and behind None until its operands are done
    stack: list[Scalar | None] = []
    for output in outputs:
        stack.append(output)
        while stack:
            node = stack.pop()
            if node is None:
                done = stack.pop()
                assert done is not None
                order.append(done)
            elif node not in seen and node not in known:
                seen.add(node)
                if node.args:
                    stack += (node, None, *reversed(node.args))
                else:
                    order.append(node)
    return order


def rebuild(graph: Graph, node: Scalar, args: tuple[Scalar, ...]) -> Scalar:
    """The node's operation on other operands, through the constructor rules."""
    match node.op:
        case "const" | "symbol":
            return node
        case "add":
            return graph.add(*args)
        case "sub":
            return graph.sub(*args)
        case "mul":
            return graph.mul(*args)
        case "div":
            return graph.div(*args)
        case "neg":
            return graph.neg(*args)
        case "pow":
            assert isinstance(node.payload, Fraction)
            return graph.power(args[0], node.payload)
        case _:
            return graph.function(node.op, args)


def substitute(graph: Graph, outputs: Iterable[Scalar], replacements: Mapping[Scalar, Scalar]) -> list[Scalar]:
    """The outputs with nodes replaced, rebuilt through the constructor rules."""
    outputs = list(outputs)
    image: dict[Scalar, Scalar] = {}
    for node in topological(outputs):
        if node in replacements:
            image[node] = replacements[node]
        elif all(image[argument] is argument for argument in node.args):
            image[node] = node
        else:
            image[node] = rebuild(graph, node, tuple(image[argument] for argument in node.args))
    return [image[output] for output in outputs]


@dataclass(frozen=True, slots=True)
class Cost:
    """Operations by kind; `weight` is the figure choices are made by."""

    additive: int
    multiplications: int
    divisions: int
    roots: int
    angles: int
    functions: int

    @property
    def weight(self) -> int:
        """Counted cost: a division or root weighs 6 products, a sine/cosine pair 30, another function 60."""
        return (
            self.additive
            + self.multiplications
            + 6 * (self.divisions + self.roots)
            + 30 * self.angles
            + 60 * self.functions
        )


def cost(outputs: Iterable[Scalar]) -> Cost:
    """Operations needed for the outputs, shared ones counted once."""
    additive = multiplications = divisions = roots = functions = 0
    angles: set[int] = set()
    for node in topological(outputs):
        match node.op:
            case "add" | "sub" | "min" | "max":
                additive += 1
            case "mul":
                multiplications += 1
            case "div" | "ratio_or_zero":
                divisions += 1
            case "sqrt":
                roots += 1
            case "sin" | "cos":
                angles.add(node.args[0].serial)
            case "const" | "symbol" | "neg" | "abs" | "copysign":
                pass
            case _:
                functions += 1
    return Cost(additive, multiplications, divisions, roots, len(angles), functions)
