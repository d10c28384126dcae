"""One real scalar of a graph (`symbolic/graph.py`): an operation on others, with the arithmetic of numbers."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from symgen.symbolic.graph import Graph

Number: TypeAlias = "Scalar | int | Fraction"

# pi to 70 digits: literals are rounded once, from this value, to the scalar type of a program.
PI = Fraction(31415926535897932384626433832795028841971693993751058209749445923078164, 10**70)


# Operations of a scalar up to which its text is written out.
LONGEST_TEXT = 500


class Scalar:
    """One node; compared by identity because equal nodes are the same object within a graph."""

    __slots__ = (
        *("args", "constant", "family", "graph", "is_one", "is_zero", "op", "payload", "serial", "size", "stands"),
        "value",
    )

    def __init__(self, graph: Graph, serial: int, op: str, args: tuple[Scalar, ...], payload: object) -> None:
        self.graph = graph
        self.serial = serial
        self.op = op
        self.args = args
        self.payload = payload
        # the value of a constant node, else None
        self.constant: Fraction | None = None
        self.is_zero = self.is_one = False
        if op == "const":
            assert isinstance(payload, Fraction)
            self.constant = payload
            self.is_zero, self.is_one = payload == 0, payload == 1
        # operations of the expression written out, its stand-ins as bits, and its value in the field of fingerprints
        self.size: int
        self.stands: int
        if len(args) == 2:
            first, second = args
            self.size, self.stands = first.size + second.size + 1, first.stands | second.stands
        elif args:
            self.size = sum(argument.size for argument in args) + (op != "neg")
            self.stands = 0
            for argument in args:
                self.stands |= argument.stands
        else:
            self.size = self.stands = 0
        self.value = 0
        # equal for products of which one may be the other but for numbers, sines and cosines
        self.family = 1

    def __add__(self, other: Number) -> Scalar:
        return self.graph.add(self, other if other.__class__ is Scalar else self.graph.lift(other))

    def __radd__(self, other: Number) -> Scalar:
        return self.graph.add(self.graph.lift(other), self)

    def __sub__(self, other: Number) -> Scalar:
        return self.graph.sub(self, self.graph.lift(other))

    def __rsub__(self, other: Number) -> Scalar:
        return self.graph.sub(self.graph.lift(other), self)

    def __mul__(self, other: Number) -> Scalar:
        return self.graph.mul(self, other if other.__class__ is Scalar else self.graph.lift(other))

    def __rmul__(self, other: Number) -> Scalar:
        return self.graph.mul(self.graph.lift(other), self)

    def __truediv__(self, other: Number) -> Scalar:
        return self.graph.div(self, self.graph.lift(other))

    def __rtruediv__(self, other: Number) -> Scalar:
        return self.graph.div(self.graph.lift(other), self)

    def __neg__(self) -> Scalar:
        return self.graph.neg(self)

    def __repr__(self) -> str:
        if self.op in ("const", "symbol"):
            return str(self.payload)
        if self.size > LONGEST_TEXT:  # written out, what is shared would be written again and again
            return f"<{self.op} of {self.size} operations>"
        return f"{self.op}({', '.join(map(repr, self.args))})"
