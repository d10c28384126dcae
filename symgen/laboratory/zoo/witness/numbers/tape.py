"""Expressions of the witness: interned nodes, their derivatives, and their values in any arithmetic.

Shared with nothing else in symgen, so that a mistake in the product's own expressions cannot hide here.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

# how often an expression may be differentiated is bounded by what it is asked for: twice for a force
ZERO, ONE = Fraction(0), Fraction(1)


@dataclass(frozen=True)
class FileNumber:
    """A number that stands in a file, and which of its numbers it is: two that are equal are rounded each alone."""

    value: Fraction
    place: int


class Node:
    """One value: a number, a symbol, or an operation on earlier nodes."""

    __slots__ = ("args", "index", "op", "payload", "tape")

    def __init__(self, tape: NodeTape, index: int, op: str, args: tuple[Node, ...], payload: object) -> None:
        self.tape, self.index, self.op, self.args, self.payload = tape, index, op, args, payload

    def __add__(self, other: Node) -> Node:
        return self.tape.add(self, other)

    def __sub__(self, other: Node) -> Node:
        return self.tape.add(self, -other)

    def __mul__(self, other: Node) -> Node:
        return self.tape.mul(self, other)

    def __truediv__(self, other: Node) -> Node:
        return self.tape.div(self, other)

    def __neg__(self) -> Node:
        return self.tape.neg(self)

    @property
    def number(self) -> Fraction | None:
        """The value of a literal, None for everything else."""
        if self.op != "number":
            return None
        payload = self.payload.value if isinstance(self.payload, FileNumber) else self.payload
        assert isinstance(payload, Fraction)
        return payload


class NodeTape:
    """Nodes in the order they were made; equal ones are one."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self._known: dict[tuple[str, tuple[int, ...], object], Node] = {}
        self._rates: dict[tuple[int, str], Node] = {}
        self.zero = self.number(ZERO)
        self.one = self.number(ONE)

    def _node(self, op: str, args: tuple[Node, ...] = (), payload: object = None) -> Node:
        key = (op, tuple(arg.index for arg in args), payload)
        node = self._known.get(key)
        if node is None:
            node = self._known[key] = Node(self, len(self.nodes), op, args, payload)
            self.nodes.append(node)
        return node

    def number(self, value: Fraction | int) -> Node:
        """A number of mechanics, or a whole one, which no type rounds."""
        return self._node("number", (), Fraction(value))

    def written(self, value: Fraction) -> Node:
        """A number of the file; one that is not whole is a node of its own each time."""
        if value.denominator == 1:
            return self.number(value)
        return self._node("number", (), FileNumber(value, len(self.nodes)))

    def pi(self) -> Node:
        """The number pi."""
        return self._node("pi")

    def symbol(self, name: str) -> Node:
        """A coordinate, rate or parameter."""
        return self._node("symbol", (), name)

    def add(self, a: Node, b: Node) -> Node:
        """a + b."""
        if a.number == 0:
            return b
        if b.number == 0:
            return a
        if b.op == "neg" and b.args[0] is a:
            return self.zero
        if a.op == "neg" and a.args[0] is b:
            return self.zero
        return self._node("add", (a, b) if a.index <= b.index else (b, a))

    def neg(self, a: Node) -> Node:
        """-a."""
        if a.number == 0:
            return a
        return a.args[0] if a.op == "neg" else self._node("neg", (a,))

    def mul(self, a: Node, b: Node) -> Node:
        """a b."""
        if a.number == 0 or b.number == 0:
            return self.zero
        if a.number == 1:
            return b
        if b.number == 1:
            return a
        return self._node("mul", (a, b) if a.index <= b.index else (b, a))

    def div(self, a: Node, b: Node) -> Node:
        """a / b."""
        if a.number == 0 or b.number == 1:
            return a
        return self._node("div", (a, b))

    def power(self, a: Node, exponent: Fraction) -> Node:
        """a to a constant rational power."""
        if exponent == 0:
            return self.one
        return a if exponent == 1 else self._node("power", (a,), exponent)

    def call(self, name: str, *args: Node) -> Node:
        """A function of one argument, or atan2."""
        return self._node(name, args)

    def sum(self, terms: Iterable[Node]) -> Node:
        """The sum of any number of nodes."""
        total = self.zero
        for term in terms:
            total = total + term
        return total

    def partials(self, node: Node) -> tuple[Node, ...]:
        """Derivatives of a node with respect to each of its arguments."""
        a = node.args[0] if node.args else None
        one, number, call = self.one, self.number, self.call
        match node.op, node.args:
            case "add", _:
                return one, one
            case "neg", _:
                return (-one,)
            case "mul", (x, y):
                return y, x
            case "div", (x, y):
                return one / y, -(x / (y * y))
            case "atan2", (y, x):
                square = y * y + x * x
                return x / square, -(y / square)
        assert a is not None
        match node.op:
            case "power":
                exponent = node.payload
                assert isinstance(exponent, Fraction)
                return (number(exponent) * self.power(a, exponent - 1),)
            case "sin":
                return (call("cos", a),)
            case "cos":
                return (-call("sin", a),)
            case "tan":
                return (one + node * node,)
            case "sqrt":
                return (one / (number(2) * node),)
            case "exp":
                return (node,)
            case "log":
                return (one / a,)
            case "sinh":
                return (call("cosh", a),)
            case "cosh":
                return (call("sinh", a),)
            case "tanh":
                return (one - node * node,)
            case "asin":
                return (one / call("sqrt", one - a * a),)
            case "acos":
                return (-(one / call("sqrt", one - a * a)),)
            case "atan":
                return (one / (one + a * a),)
        raise ValueError(f"no derivative of {node.op}")

    def derivative(self, node: Node, seeds: Mapping[str, Node], key: str) -> Node:
        """The derivative along a direction given by the derivatives of the symbols; remembered under `key`."""
        rates = self._rates
        stack = [node]
        while stack:
            top = stack[-1]
            if (top.index, key) in rates:
                stack.pop()
                continue
            missing = [arg for arg in top.args if (arg.index, key) not in rates]
            if missing:
                stack.extend(missing)
                continue
            stack.pop()
            if top.op == "symbol":
                value = seeds.get(str(top.payload), self.zero)
            elif not top.args:
                value = self.zero
            else:
                inner = [rates[arg.index, key] for arg in top.args]
                value = self.zero
                if any(rate.number != 0 for rate in inner):
                    for partial, rate in zip(self.partials(top), inner, strict=True):
                        value = value + partial * rate
            rates[top.index, key] = value
        return rates[node.index, key]

    def gradient(self, node: Node, symbols: Sequence[str]) -> list[Node]:
        """Derivatives with respect to symbols, by one sweep backwards."""
        adjoint: dict[int, Node] = {node.index: self.one}
        for current in reversed(self.reached([node])):
            weight = adjoint.get(current.index)
            if weight is None or not current.args:
                continue
            for arg, partial in zip(current.args, self.partials(current), strict=True):
                adjoint[arg.index] = adjoint.get(arg.index, self.zero) + weight * partial
        return [adjoint.get(self.symbol(name).index, self.zero) for name in symbols]

    def reached(self, outputs: Sequence[Node]) -> list[Node]:
        """All nodes that the outputs need, arguments first."""
        needed: set[int] = set()
        stack = [node.index for node in outputs]
        while stack:
            index = stack.pop()
            if index not in needed:
                needed.add(index)
                stack.extend(arg.index for arg in self.nodes[index].args)
        return [self.nodes[index] for index in sorted(needed)]

    def evaluate(self, outputs: Sequence[Node], values: Mapping[str, Any], field: Any) -> list[Any]:
        """Values of nodes in the arithmetic of `field` (see `fields`)."""
        return NodeProgram(self, outputs).run(values, field)


class NodeProgram:
    """What must be computed for some outputs, in order."""

    def __init__(self, tape: NodeTape, outputs: Sequence[Node]) -> None:
        self._steps = [
            (node.index, node.op, tuple(arg.index for arg in node.args), node.payload) for node in tape.reached(outputs)
        ]
        self._outputs = [node.index for node in outputs]
        self.literals = tuple(payload for _, _, _, payload in self._steps if isinstance(payload, FileNumber))

    def run(self, values: Mapping[str, Any], field: Any, literals: Mapping[FileNumber, Any] | None = None) -> list[Any]:
        """Values of the outputs; `literals` replaces numbers of the file."""
        results: dict[int, Any] = {}
        functions = field.functions
        moved = literals or {}
        for index, op, args, payload in self._steps:
            if op == "add":
                value = results[args[0]] + results[args[1]]
            elif op == "mul":
                value = results[args[0]] * results[args[1]]
            elif op == "neg":
                value = -results[args[0]]
            elif op == "div":
                value = results[args[0]] / results[args[1]]
            elif op == "symbol":
                value = values[payload]  # type: ignore[index]
            elif op == "number":
                if isinstance(payload, FileNumber):
                    value = moved[payload] if payload in moved else field.number(payload.value)
                else:
                    value = field.number(payload)
            elif op == "pi":
                value = field.pi()
            elif op == "power":
                value = field.power(results[args[0]], payload)
            else:
                value = functions[op](*(results[arg] for arg in args))
            results[index] = value
        return [results[index] for index in self._outputs]
