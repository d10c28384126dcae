"""Proofs that a scalar vanishes only where a rank drops, by rules that need no numbers.

A scalar cannot vanish if interval bounds say so.  A product needs all its factors proved, a sum of terms that are never
negative one of them.  A rank measure times parameters of a declared sign vanishes with the measure.  And a sum of
squares forces each of its terms to 0: if a measure becomes 0 with them, it vanishes there too.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations

from symgen.dynamics.admission.residues import Residues
from symgen.dynamics.forms.definite import Definite
from symgen.graph.fingerprint import PRIME
from symgen.graph.scalar import Scalar
from symgen.graph.traverse import topological

# a determinant may stand beside its square
POWERS = ((1, 1), (2, 1), (1, 2))


class Proof:
    """Rules about one system; `measures` are scalars known to vanish only where the rank of B or of M~ drops."""

    def __init__(self, definite: Definite, parameters: Sequence[str], measures: Sequence[Scalar]) -> None:
        self._definite = definite
        self._residues = Residues(parameters)
        self._measures = list(measures)
        self._known: dict[Scalar, bool] = {}
        self._inside: dict[Scalar, frozenset[int]] = {}

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
        zeros = self._forced(node)
        return any(self._vanishes_with(measure, zeros) for measure in self._measures)

    def _vanishes_with(self, measure: Scalar, zeros: Sequence[Scalar]) -> bool:
        if measure not in self._inside:
            self._inside[measure] = frozenset(node.value for node in topological([measure]))
        inside = self._inside[measure]
        met = any(zero.value in inside or -zero.value % PRIME in inside for zero in zeros)
        # the sine of a sum may stand in the measure without those of its parts
        sines = sum(zero.op == "sin" for zero in zeros)
        return (met or sines > 1) and _becomes_zero(measure, zeros)

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


def _becomes_zero(node: Scalar, zeros: Sequence[Scalar]) -> bool:
    """Whether the scalar is 0 where the given ones are."""
    values = {value for zero in zeros for value in (zero.value, -zero.value % PRIME)}
    angles = [_angle(zero) for zero in zeros if zero.op == "sin"]
    sums = [*angles, *(_sum(a, b, sign) for a, b in combinations(angles, 2) for sign in (1, -1))]
    gone: dict[Scalar, bool] = {}
    for inner in topological([node]):
        below = [gone[argument] for argument in inner.args]
        match inner.op:
            case "mul":
                gone[inner] = any(below)
            case "add" | "sub":
                gone[inner] = all(below)
            case "neg" | "abs" | "sqrt" | "div":
                gone[inner] = below[0]
            case "sin":
                # sin x = sin y = 0 makes sin(x + y) = 0
                angle = _angle(inner)
                gone[inner] = any(angle == known or _negative(angle) == known for known in sums)
            case _:
                gone[inner] = inner.is_zero
        gone[inner] = gone[inner] or inner.value in values
        if inner.op == "mul" and not gone[inner]:
            powers = inner.graph.products.monomial(inner)[1]
            gone[inner] = any(power > 0 and factor.value in values for factor, power in powers.items())
    return gone[node]


def _angle(sine: Scalar) -> dict[int, int]:
    """The angle of a sine, as whole multiples of leaves given by their fingerprints."""
    return {leaf.value: count for leaf, count in sine.graph.angle_form(sine.args[0]).items()}


def _sum(a: dict[int, int], b: dict[int, int], sign: int) -> dict[int, int]:
    total = {leaf: a.get(leaf, 0) + sign * b.get(leaf, 0) for leaf in (*a, *b)}
    return {leaf: count for leaf, count in total.items() if count}


def _negative(a: dict[int, int]) -> dict[int, int]:
    return {leaf: -count for leaf, count in a.items()}
