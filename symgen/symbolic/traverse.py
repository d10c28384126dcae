"""Walking a graph: operands before operators, substitution, operation counts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Container, Iterable, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import chain

from symgen.records import dataclass
from symgen.runtime.garbage import cleared_with_the_rest
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar

# What counts as arithmetic, as an angle, or not at all; every other operation is a function.
_NO_FUNCTIONS = frozenset({"add", "sub", "min", "max", "mul", "div", "ratio_or_zero", "sqrt", "sin", "cos"})
_NO_FUNCTIONS |= {"const", "symbol", "neg", "abs", "copysign", "rounded"}
# Counted cost of a division or root, of a sine and cosine, of another function; sums and products count 1.
QUOTIENT_WEIGHT, ANGLE_WEIGHT, FUNCTION_WEIGHT = 6, 30, 60
_WEIGHTS = dict.fromkeys(("add", "sub", "min", "max", "mul"), 1) | dict.fromkeys(("sin", "cos"), ANGLE_WEIGHT)
_WEIGHTS |= dict.fromkeys(("div", "ratio_or_zero", "sqrt"), QUOTIENT_WEIGHT)
# Operations that are looked at together where each of many outputs is counted by itself.
BITS = 8192


def topological(outputs: Iterable[Scalar], known: Container[Scalar] = ()) -> Sequence[Scalar]:
    """Every node the outputs reach, depth first, operands before the node that uses them; `known` ones are left out."""
    return _whole_order(tuple(outputs)) if known == () else _order(outputs, known)


# one step after another goes through the same outputs
@lru_cache(maxsize=16)
def _whole_order(outputs: tuple[Scalar, ...]) -> tuple[Scalar, ...]:
    return tuple(_order(outputs, ()))


cleared_with_the_rest(_whole_order.cache_clear)


def forget_orders() -> None:
    """Lets go of the orders that are remembered, and of the nodes in them."""
    _whole_order.cache_clear()


def _order(outputs: Iterable[Scalar], known: Container[Scalar]) -> list[Scalar]:
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
                args = node.args
                if not args:
                    order.append(node)
                elif len(args) == 2:
                    first, second = args
                    # what has been seen need not be looked at twice
                    stack += (node, None) if second in seen else (node, None, second)
                    if first not in seen:
                        stack.append(first)
                else:
                    stack += (node, None, *reversed(args))
    return order


def reached(outputs: Iterable[Scalar]) -> set[Scalar]:
    """Every node the outputs reach, in no order: faster than `topological` where the order does not matter."""
    stack = list(outputs)
    seen = set(stack)
    while stack:
        for argument in stack.pop().args:
            if argument not in seen:
                seen.add(argument)
                stack.append(argument)
    return seen


def uses_of(order: Sequence[Scalar], outputs: Iterable[Scalar]) -> Counter[Scalar]:
    """How often each node of an order is an operand or an output."""
    uses = Counter(chain.from_iterable([node.args for node in order]))
    uses.update(outputs)
    return uses


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
        else:
            args = tuple(map(image.__getitem__, node.args))
            image[node] = node if args == node.args else rebuild(graph, node, args)
    return [image[output] for output in outputs]


@dataclass(frozen=True, slots=True)
class Cost:
    """Operations by kind; `weight` is the figure choices are made by, signs are free."""

    signs: int
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
            + QUOTIENT_WEIGHT * (self.divisions + self.roots)
            + ANGLE_WEIGHT * self.angles
            + FUNCTION_WEIGHT * self.functions
        )


def cost(outputs: Iterable[Scalar]) -> Cost:
    """Operations needed for the outputs, shared ones counted once."""
    nodes = reached(outputs)
    count = Counter([node.op for node in nodes])
    angles = {node.args[0] for node in nodes if node.op == "sin" or node.op == "cos"}
    return Cost(
        signs=count["neg"],
        additive=count["add"] + count["sub"] + count["min"] + count["max"],
        multiplications=count["mul"],
        divisions=count["div"] + count["ratio_or_zero"],
        roots=count["sqrt"],
        angles=len(angles),
        functions=sum(number for op, number in count.items() if op not in _NO_FUNCTIONS),
    )


def weights_alone(outputs: Sequence[Scalar]) -> list[int]:
    """The counted cost of each output by itself, where they share most of what they need.

    What each node reaches is a number with a bit for each operation, so many bits at a time.
    """
    order = topological(outputs)
    places: dict[Scalar, int] = {}
    angles: dict[Scalar, int] = {}
    weights: list[int] = []
    for node in order:
        # a sine and a cosine of one angle are one operation
        of_angle = node.op in ("sin", "cos")
        known_angle = angles.get(node.args[0]) if of_angle else None
        if weight := _WEIGHTS.get(node.op, 0 if node.op in _NO_FUNCTIONS else FUNCTION_WEIGHT):
            places[node] = len(weights) if known_angle is None else known_angle
            if known_angle is None:
                weights.append(weight)
        if of_angle:
            angles[node.args[0]] = places[node]
    totals = [0] * len(outputs)
    for start in range(0, len(weights), BITS):
        reach: dict[Scalar, int] = {}
        for node in order:
            place = places.get(node, -1) - start
            bits = 1 << place if 0 <= place < BITS else 0
            for argument in node.args:
                bits |= reach[argument]
            reach[node] = bits
        masks: dict[int, int] = {}
        for place, weight in enumerate(weights[start : start + BITS]):
            masks[weight] = masks.get(weight, 0) | 1 << place
        for k, output in enumerate(outputs):
            totals[k] += sum(weight * (reach[output] & mask).bit_count() for weight, mask in masks.items())
    return totals
