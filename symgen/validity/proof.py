"""Proofs that a scalar vanishes only where a rank drops, by rules that need no numbers.

A scalar cannot vanish if interval bounds say so.  A product needs all its factors proved, a sum of terms that are never
negative one of them.  A rank measure times parameters of a declared sign vanishes with the measure.  And a sum of
squares forces each of its terms to 0: if a measure becomes 0 with them, it vanishes there too.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from symgen.mechanics.never_zero import Definite
from symgen.symbolic.scalar import Scalar
from symgen.validity.residues import Residues
from symgen.validity.vanishing import Vanishing

# a determinant may stand beside its square
POWERS = ((1, 1), (2, 1), (1, 2))


class Proof:
    """Rules about one system; `measures` are scalars known to vanish only where the rank of B or of M~ drops."""

    def __init__(self, definite: Definite, parameters: Sequence[str], measures: Sequence[Scalar]) -> None:
        self._definite = definite
        self._residues = Residues(parameters)
        self._measures = list(measures)
        self._known: dict[Scalar, bool] = {}
        self._vanishing = Vanishing()

    def unproved(self, divisors: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """Those of the scalars for which no rule was found.

        What is proved to vanish with a measure serves as a measure itself, hence the rounds.
        """
        left = list(divisors)
        while True:
            rest = [divisor for divisor in left if not self.shown(divisor)]
            if len(rest) in (0, len(left)):
                return tuple(rest)
            self._known.clear()
            left = rest

    def add(self, measures: Iterable[Scalar]) -> None:
        """More scalars whose zeros are known."""
        self._measures += measures
        self._known.clear()

    def shown(self, node: Scalar) -> bool:
        """Whether the scalar is proved to vanish only where a measure does."""
        if node not in self._known:
            self._known[node] = self._shown(node)
        return self._known[node]

    def _shown(self, node: Scalar) -> bool:
        if node.constant is not None:
            return not node.is_zero
        if self._definite.holds(node):
            return True
        if self._with_measure(node):
            return True
        match node.op:
            case "neg" | "abs" | "sqrt" | "copysign" | "div":
                return self.shown(node.args[0])
            case "mul":
                return all(map(self.shown, node.args))
            case "add" if self._nonnegative(node):
                return any(map(self.shown, node.args))
            case "add" | "sub":
                length = _added_to(node)
                return length is not None and self.shown(length)
            case _:
                return False

    def _with_measure(self, node: Scalar) -> bool:
        for measure in self._measures:
            if any(self._residues.proportional(node, measure, powers, self._never_zero) for powers in POWERS):
                self._measures.append(node)
                return True
        for measure in self._measures:
            self._vanishing.add(measure)
        return self._vanishing.any_where(self._forced(node), self._measures)

    def _never_zero(self, parameter: str) -> bool:
        return self._definite.holds(self._definite.parameter(parameter))

    def _nonnegative(self, node: Scalar) -> bool:
        match node.op:
            case "const":
                return node.constant is not None and node.constant >= 0
            case "abs" | "sqrt":
                return True
            case "mul" if node.args[0] is node.args[1]:
                return True
            case "add" | "mul":
                return all(map(self._nonnegative, node.args))
            case _:
                bounds = self._definite.bounds(node)
                return bounds is not None and bounds.low >= 0

    def _forced(self, node: Scalar) -> list[Scalar]:
        """What is 0 where the node is."""
        match node.op:
            case "neg" | "abs" | "sqrt" | "copysign" | "div":
                return [node, *self._forced(node.args[0])]
            case "mul" if node.args[0] is node.args[1]:
                return [node, *self._forced(node.args[0])]
            case "mul":
                # a factor that cannot vanish leaves the other one
                one, other = node.args
                left = self._forced(other) if self._definite.holds(one) else []
                right = self._forced(one) if self._definite.holds(other) else []
                return [node, *left, *right]
            case "add" if self._nonnegative(node):
                return [node, *self._forced(node.args[0]), *self._forced(node.args[1])]
            case _:
                return [node]


def _added_to(node: Scalar) -> Scalar | None:
    """The length that a sum adds to a scalar with the scalar's own sign: |x + copysign(l, x)| = |x| + l."""
    one, other = node.args
    for signed, rest in ((one, other), (other, one)):
        if signed.op == "copysign" and signed.args[1] is (rest if node.op == "add" else -rest):
            return signed.args[0]
    return None
