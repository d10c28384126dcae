"""Which scalars of parameters cannot vanish: intervals over the declared ranges (Moore, Interval Analysis).

Parameters without a range that are positive by nature (`symgen.model.checks.signs`) lie between 0 and infinity.
"""

from __future__ import annotations

from fractions import Fraction
from functools import reduce
from math import inf, isqrt
from typing import TypeAlias

from symgen.mechanics.system import System
from symgen.records import dataclass
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import topological

# floats are infinities only
Bound: TypeAlias = Fraction | float
# Bounds of roots are whole multiples of one part in this, 20 decimal places.
ROOT_UNITS = 10**20


@dataclass(frozen=True, slots=True)
class Interval:
    """Bounds of a scalar, and whether it is known not to be 0 although a bound may be."""

    low: Bound
    high: Bound
    nonzero: bool


class Definite:
    """Bounds of scalars that depend only on parameters with a declared range or positive by nature."""

    def __init__(self, mechanics: System) -> None:
        self._ranges: dict[str, Interval] = {}
        for parameter in mechanics.model.parameters:
            if parameter.range is not None:
                low, high = Fraction(parameter.range[0]), Fraction(parameter.range[1])
                self._ranges[parameter.name] = Interval(low, high, low > 0 or high < 0)
            elif parameter.name in mechanics.positive:
                self._ranges[parameter.name] = Interval(Fraction(0), inf, True)
            elif parameter.name in mechanics.nonnegative:
                self._ranges[parameter.name] = Interval(Fraction(0), inf, False)
            else:
                # of either sign, or 0: its square is not negative
                self._ranges[parameter.name] = Interval(-inf, inf, False)
        self._known: dict[Scalar, Interval | None] = {}
        self._graph = mechanics.graph

    def holds(self, node: Scalar) -> bool:
        """Whether the scalar is never 0, whatever the parameters are within their ranges."""
        bounds = self.bounds(node)
        return bounds is not None and bounds.nonzero

    def parameter(self, name: str) -> Scalar:
        """The parameter of that name."""
        return self._graph.symbol(name)

    def bounds(self, node: Scalar) -> Interval | None:
        """An enclosure, or None where the scalar depends on anything else or is not bounded on either side."""
        for inner in topological([node], self._known):
            args = [self._known[argument] for argument in inner.args]
            self._known[inner] = self._enclosure(inner, args)
        return self._known[node]

    def adds_up(self, node: Scalar) -> bool:
        """Whether all sums in it are of what is nowhere below 0, so that nothing cancels."""
        for inner in topological([node]):
            if inner.op == "add":
                bounds = [self.bounds(argument) for argument in inner.args]
                if any(one is None or one.low < 0 for one in bounds):
                    return False
            elif inner.op not in ("const", "symbol", "mul"):
                return False
        return True

    def _enclosure(self, node: Scalar, args: list[Interval | None]) -> Interval | None:
        if node.constant is not None:
            return Interval(node.constant, node.constant, not node.is_zero)
        if node.op == "symbol":
            return self._ranges.get(str(node.payload))
        given = [a for a in args if a is not None]
        if len(given) < len(args):
            return None
        match node.op:
            case "add":
                return _sum(given[0], given[1])
            case "sub":
                return _sum(given[0], _negative(given[1]))
            case "neg":
                return _negative(given[0])
            case "mul" if node.args[0] is node.args[1]:
                return _square(given[0])
            case "mul":
                return self._product(node, given[0], given[1])
            case "div" if given[1].nonzero and not given[1].low < 0 < given[1].high:
                return _product(given[0], _inverse(given[1]))
            case "sqrt" if given[0].low >= 0:
                return _root(given[0])
            case _:
                return None

    def _product(self, node: Scalar, a: Interval, b: Interval) -> Interval:
        """Of a product: one of even powers, as (m c) c with m > 0 is, is not negative whatever c is."""
        interval = _product(a, b)
        if interval.low >= 0:
            return interval
        coefficient, powers = self._graph.products.monomial(node)
        for factor, power in powers.items():
            bounds = self._known.get(factor)
            if bounds is None or power < 1 or (power % 2 and bounds.low < 0):
                return interval
        return Interval(Fraction(0), interval.high, interval.nonzero) if coefficient > 0 else interval

    def content(self, entries: list[Scalar]) -> Scalar:
        """The largest product of definite factors that divides every entry; 1 where there is none."""
        products = [self._graph.products.monomial(entry)[1] for entry in entries if not entry.is_zero]
        if not products:
            return self._graph.one
        shared = reduce(lambda a, b: {f: min(c, b[f]) for f, c in a.items() if c > 0 and b.get(f, 0) > 0}, products)
        factors = sorted((f for f in shared if shared[f] > 0 and self.holds(f)), key=lambda f: f.serial)
        return self._graph.product(f for f in factors for _ in range(shared[f]))

    def without(self, entry: Scalar, content: Scalar) -> Scalar:
        """entry / content for a content that divides it, without a division."""
        if content.is_one or entry.is_zero:
            return entry
        number, taken = self._graph.products.monomial(content)
        return self._graph.products.quotient(entry, taken, number)

    def ratio(self, entry: Scalar, divisor: Scalar) -> Scalar:
        """entry / divisor with the parameters' quotient in one piece, so that it is shared and can be computed once."""
        if entry.is_zero or divisor.is_one:
            return entry
        content = self.content([entry])
        return (content / divisor) * self.without(entry, content)


def _sum(a: Interval, b: Interval) -> Interval:
    low, high = a.low + b.low, a.high + b.high
    one_side = (a.low >= 0 and b.low >= 0) or (a.high <= 0 and b.high <= 0)
    return Interval(low, high, low > 0 or high < 0 or (one_side and (a.nonzero or b.nonzero)))


def _negative(a: Interval) -> Interval:
    return Interval(-a.high, -a.low, a.nonzero)


def _square(a: Interval) -> Interval:
    interval = _product(a, a)
    return interval if interval.low >= 0 else Interval(Fraction(0), interval.high, a.nonzero)


def _product(a: Interval, b: Interval) -> Interval:
    # 0 times infinity is 0 here: infinity only says that there is no bound
    ends: list[Bound] = [x * y if x and y else Fraction(0) for x in (a.low, a.high) for y in (b.low, b.high)]
    return Interval(min(ends), max(ends), a.nonzero and b.nonzero)


def _root(a: Interval) -> Interval:
    """Of what is not negative, to 20 digits: axes are divided by their lengths."""
    ends = [x if x == inf else Fraction(isqrt(int(x * ROOT_UNITS**2)), ROOT_UNITS) for x in (a.low, a.high)]
    return Interval(ends[0], ends[1] if ends[1] == inf else ends[1] + Fraction(1, ROOT_UNITS), a.nonzero)


def _inverse(a: Interval) -> Interval:
    """1 / a for an interval on one side of 0."""
    if a.high <= 0:
        return _negative(_inverse(_negative(a)))
    low = Fraction(0) if a.high == inf else 1 / a.high
    return Interval(low, 1 / a.low if a.low else inf, True)
