"""Products compared by their factors: what cancels, what collects, and the addition theorem."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Set
from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

from symgen.symbolic.fingerprint import PRIME, residue

if TYPE_CHECKING:
    from symgen.symbolic.graph import Graph
    from symgen.symbolic.scalar import Scalar

# Whole coefficients are integers: their arithmetic is many times faster than that of fractions.
Monomial: TypeAlias = "tuple[int | Fraction, dict[Scalar, int]]"

# Factors of a product up to which it is taken apart.
MOST_FACTORS = 12


def _whole(value: Fraction) -> int | Fraction:
    return value.numerator if value.denominator == 1 else value


def _held(rule: str, same: bool, rewritten: Scalar, asked: Callable[[], Scalar]) -> Scalar:
    """What was found, held to be what was asked for: where fingerprints are not the same, or do not decide, exactly."""
    from symgen.symbolic import identity  # which needs graphs

    if not same or identity.evaluates_all():
        identity.same_values(rule, [asked()], [rewritten])
    return rewritten


def _is_composed(a: Scalar) -> bool:
    return a.op in ("neg", "mul", "div")


class Products:
    """The products of one graph, taken apart once each."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._known: dict[Scalar, Monomial] = {}
        self._turning: set[Scalar] = set()  # those with a sine or cosine among their factors
        self._sums: dict[int, Scalar] = {}  # by their fingerprints, those that stand for what is opposite too

    def monomial(self, a: Scalar) -> Monomial:
        """`a` as coefficient times powers of factors, whatever the order in which they were multiplied."""
        known = self._known.get(a)
        if known is not None:
            return known
        # a product may be as deep as a model is long
        waiting = [a]
        while waiting:
            node = waiting[-1]
            unknown = [x for x in node.args if x not in self._known] if _is_composed(node) else []
            if unknown:
                waiting += reversed(unknown)
            else:
                waiting.pop()
                self._known[node] = result = self._taken_apart(node)
                if any(factor.op in ("sin", "cos") for factor in result[1]):
                    self._turning.add(node)
        return self._known[a]

    def _taken_apart(self, a: Scalar) -> Monomial:
        """A monomial, those of what it is composed of being known."""
        if (value := a.constant) is not None:
            return _whole(value), {}
        if not _is_composed(a):
            sign, factor = self._upright(a)
            return sign, {factor: 1}
        if a.op == "neg":
            coefficient, powers = self._known[a.args[0]]
            return -coefficient, powers
        sign = 1 if a.op == "mul" else -1
        (k1, left), (k2, right) = self._known[a.args[0]], self._known[a.args[1]]
        if len(left) + len(right) > MOST_FACTORS or (sign < 0 and k2 == 0):
            return 1, {a: 1}
        powers = dict(left)
        for factor, count in right.items():
            powers[factor] = powers.get(factor, 0) + sign * count
        return k1 * k2 if sign > 0 else _whole(Fraction(k1) / k2), {f: c for f, c in powers.items() if c}

    def _upright(self, a: Scalar) -> tuple[int, Scalar]:
        """A factor as a sign times one that is known: -1 - x as -(1 + x) where that was met before."""
        if a.op not in ("add", "sub"):
            return 1, a
        opposite = self._sums.get(-a.value % PRIME)
        if opposite is None or opposite is a:
            self._sums.setdefault(a.value, a)
            return 1, a
        return -1, opposite

    def __len__(self) -> int:
        return len(self._known)

    def forget(self, first: int, gone: Set[Scalar]) -> None:
        """Lets go of scalars, see `Graph.forget`, that were made since so many products were known.

        Factors of a product that stays stay with it.
        """
        kept = []
        while len(self._known) > first:
            a, monomial = self._known.popitem()
            if a not in gone and gone.isdisjoint(monomial[1]):
                kept.append((a, monomial))
            else:
                self._turning.discard(a)
        self._known.update(reversed(kept))
        for a in gone:
            if self._sums.get(a.value) is a:
                del self._sums[a.value]

    def combined(self, a: Scalar, b: Scalar, sign: int) -> Scalar | None:
        """a + sign * b where the two are products that differ in constants or in two sines and cosines only."""
        # most are sums of products that have nothing in common, which it would take long to take apart
        if a.family != b.family:
            return None
        (k1, left), (k2, right) = self.monomial(a), self.monomial(b)
        if left == right and k1:
            return a * (Fraction(k1 + sign * k2) / k1)
        if abs(k1) != abs(k2) or (a not in self._turning and b not in self._turning):
            return None
        # factors of either side; what one of them alone is divided by stays
        more = {f: left.get(f, 0) - right.get(f, 0) for f in {**left, **right}}
        if any(count and min(left.get(f, 0), right.get(f, 0)) < 0 for f, count in more.items()):
            return None
        lost = [f for f, count in more.items() for _ in range(count)]
        gained = [f for f, count in more.items() for _ in range(-count)]
        if not all(f.op in ("sin", "cos") for f in (*lost, *gained)):
            return None
        sign_of_both = sign if k1 == k2 else -sign
        if len(lost) == len(gained) == 2:
            angle = self._addition_theorem(lost, gained, sign_of_both)
        else:
            angle = self._other_leg(lost, gained) if sign_of_both < 0 else None
        if angle is None:
            return None
        rest = {f: common for f in more if (common := min(left.get(f, 0), right.get(f, 0)))}
        product = k1 * (self._product(rest) * angle)
        op, same = "add" if sign > 0 else "sub", product.value == (a.value + sign * b.value) % PRIME
        return _held("the addition theorem", same, product, lambda: self._graph.beside(op, (a, b)))

    def quotient(self, a: Scalar, powers: Mapping[Scalar, int], number: int | Fraction = 1) -> Scalar:
        """`a` over a number times powers of factors; those of its own are left out instead of divided by."""
        coefficient, own = self.monomial(a)
        if not coefficient:
            return a
        rest = {f: own.get(f, 0) - powers.get(f, 0) for f in {**own, **powers}}
        ratio = Fraction(coefficient) / number * self._product({f: count for f, count in rest.items() if count})
        # ratio * number * below = a * above, as what is 0 has no inverse in the field
        left, right = ratio.value * residue(Fraction(number)), a.value
        for factor, count in powers.items():
            if count > 0:
                left = left * pow(factor.value, count, PRIME)
            else:
                right = right * pow(factor.value, -count, PRIME)
        same = (left - right) % PRIME == 0
        return _held("leaving out factors", same, ratio, lambda: self._over(a, powers, number))

    def _over(self, a: Scalar, powers: Mapping[Scalar, int], number: int | Fraction) -> Scalar:
        """The quotient as it is asked for, divided by one factor after the other."""
        beside = self._graph.beside
        asked = beside("div", (a, beside("const", (), Fraction(number))))
        for factor, count in powers.items():
            for _ in range(abs(count)):
                asked = beside("div" if count > 0 else "mul", (asked, factor))
        return asked

    def _product(self, powers: dict[Scalar, int]) -> Scalar:
        factors = sorted(powers.items(), key=lambda entry: entry[0].serial)
        product = self._graph.product(factor for factor, count in factors for _ in range(count))
        for factor, count in factors:
            for _ in range(-count):
                product = product / factor
        return product

    def _other_leg(self, lost: list[Scalar], gained: list[Scalar]) -> Scalar | None:
        """1 - s s as c c, and s s - 1 as -c c: where s is nearly 1, the difference holds no digit of c."""
        match lost, gained:
            case ([], [one, other]) | ([one, other], []) if one is other:
                leg = self._graph.trig("cos" if one.op == "sin" else "sin", one.args[0])
                return -(leg * leg) if lost else leg * leg
            case _:
                return None

    def _addition_theorem(self, lost: list[Scalar], gained: list[Scalar], sign: int) -> Scalar | None:
        """t1 t2 + sign * t3 t4 with t sines and cosines of the same two angles, as one sine or cosine."""
        graph = self._graph
        p, q = sorted(lost, key=lambda f: f.args[0].serial)
        v, w = sorted(gained, key=lambda f: f.args[0].serial)
        x, y = p.args[0], q.args[0]
        if (v.args[0], w.args[0]) != (x, y):
            return None
        if x is y:
            # c c + s s; differences are cosines of 2x, an angle of their own
            return graph.one if sign > 0 and p.op == q.op and v.op == w.op else None
        match (p.op, q.op, v.op, w.op):
            case ("cos", "cos", "sin", "sin"):
                return graph.trig("cos", x - y if sign > 0 else x + y)
            case ("sin", "sin", "cos", "cos"):
                return graph.trig("cos", x - y) if sign > 0 else -graph.trig("cos", x + y)
            case ("sin", "cos", "cos", "sin"):
                return graph.trig("sin", x + y if sign > 0 else x - y)
            case ("cos", "sin", "sin", "cos"):
                return graph.trig("sin", x + y if sign > 0 else y - x)
            case _:
                return None
