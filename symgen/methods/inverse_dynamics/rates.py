"""B q_dot = 0 reduced by steps that cannot fail, whatever the angles: q_dot = motion mu with core mu = 0.

A step solves a row for a rate whose coefficient cannot vanish (a product of parameters with a declared sign), or
turns two rates or two rows into the direction in which a pair of coefficients (k cos x, k sin x) becomes (k, 0).
Turned rates are velocities along axes that move with a body.  So ker B is the image of ker core under `motion`, which
is injective everywhere.
"""

from __future__ import annotations

from itertools import combinations

from symgen.mechanics.never_zero import Definite
from symgen.records import dataclass
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, identity
from symgen.symbolic.scalar import Scalar


@dataclass(frozen=True, slots=True)
class Rates:
    """q_dot = motion mu (n x k) with core mu = 0 (rho x k)."""

    motion: Matrix
    core: Matrix

    @property
    def width(self) -> int:
        """Number of rates mu."""
        return len(self.motion[0])


@dataclass(frozen=True, slots=True)
class _TurnOfPair:
    """A pair (k cos x, k sin x) at `first` and `second` of a row (`by_columns`) or of a column of the core."""

    by_columns: bool
    line: int
    first: int
    second: int
    cosine: Scalar
    sine: Scalar
    size: Scalar


def reduced_rates(graph: Graph, definite: Definite, rows: Matrix, n: int) -> Rates:
    """The rates in which no step is left; the step that touches the fewest entries comes first (Markowitz)."""
    rates = Rates(identity(graph, n), rows)
    while True:
        rates = _eliminated(definite, rates)
        turns = _turns(graph, definite, rates)
        if not turns:
            return rates
        rates = _turned(rates, min(turns, key=lambda turn: _touched(rates, turn)))


def _eliminated(definite: Definite, rates: Rates) -> Rates:
    while True:
        steps = [
            (_size(row) * _size(_column(rates.core, j)), i, j)
            for i, row in enumerate(rates.core)
            for j, entry in enumerate(row)
            if not entry.is_zero and definite.holds(entry)
        ]
        if not steps:
            return rates
        _, i, j = min(steps)
        rates = _solved(definite, rates, i, j)


def _solved(definite: Definite, rates: Rates, i: int, j: int) -> Rates:
    """Row i solved for mu_j, which is put in everywhere."""
    row = rates.core[i]
    shares = tuple(definite.ratio(entry, row[j]) for entry in row)

    def without(other: Vector) -> Vector:
        factor = other[j]
        return tuple(
            x if factor.is_zero else x - factor * share
            for k, (x, share) in enumerate(zip(other, shares, strict=True))
            if k != j
        )

    others = (other for k, other in enumerate(rates.core) if k != i)
    return Rates(tuple(map(without, rates.motion)), tuple(map(without, others)))


def _turns(graph: Graph, definite: Definite, rates: Rates) -> list[_TurnOfPair]:
    turns = []
    for i, row in enumerate(rates.core):
        for j, k in combinations(range(rates.width), 2):
            pair = _unit_pair(graph, definite, row[j], row[k])
            if pair is not None:
                turns.append(_TurnOfPair(True, i, j, k, *pair))
    for j in range(rates.width):
        for i, k in combinations(range(len(rates.core)), 2):
            pair = _unit_pair(graph, definite, rates.core[i][j], rates.core[k][j])
            if pair is not None:
                turns.append(_TurnOfPair(False, j, i, k, *pair))
    return turns


def _unit_pair(graph: Graph, definite: Definite, a: Scalar, b: Scalar) -> tuple[Scalar, Scalar, Scalar] | None:
    """(f, g, k) with a = k f, b = k g, f and g sine and cosine of one angle up to sign, and a definite k."""
    if a.is_zero or b.is_zero:
        return None
    (p, left), (q, right) = graph.products.monomial(a), graph.products.monomial(b)
    only_left = [f for f in left if left[f] != right.get(f, 0)]
    only_right = [f for f in right if right[f] != left.get(f, 0)]
    if abs(p) != abs(q) or len(only_left) != 1 or len(only_right) != 1:
        return None
    (f,), (g,) = only_left, only_right
    if {f.op, g.op} != {"sin", "cos"} or f.args != g.args or (left[f], right[g]) != (1, 1) or f in right or g in left:
        return None
    size = definite.without(a, f)
    return (f, g if p == q else -g, size) if definite.holds(size) else None


def _touched(rates: Rates, turn: _TurnOfPair) -> tuple[int, int, int, int]:
    """How many entries a turn changes; its place decides between equals."""
    if turn.by_columns:
        lines = (_column(rates.core, turn.first), _column(rates.core, turn.second))
        cost = (_size(rates.core[turn.line]) - 1) * sum(map(_size, lines))
    else:
        lines = (rates.core[turn.first], rates.core[turn.second])
        cost = (_size(_column(rates.core, turn.line)) - 1) * sum(map(_size, lines))
    return cost, turn.line, turn.first, turn.second


def _turned(rates: Rates, turn: _TurnOfPair) -> Rates:
    """(x, y) -> (c x + s y, c y - s x) for two rows, or for the coefficients of two rates."""
    c, s = turn.cosine, turn.sine
    zero = c.graph.zero

    def pair(x: Scalar, y: Scalar, on_line: bool) -> tuple[Scalar, Scalar]:
        return (turn.size, zero) if on_line else (combined(c, x, s, y), combined(c, y, -s, x))

    def columns(row: Vector, on_line: bool) -> Vector:
        first, second = pair(row[turn.first], row[turn.second], on_line)
        replaced = {turn.first: first, turn.second: second}
        return tuple(replaced.get(j, entry) for j, entry in enumerate(row))

    if turn.by_columns:
        core = tuple(columns(row, i == turn.line) for i, row in enumerate(rates.core))
        return Rates(tuple(columns(row, False) for row in rates.motion), core)
    both = zip(rates.core[turn.first], rates.core[turn.second], strict=True)
    pairs = [pair(x, y, j == turn.line) for j, (x, y) in enumerate(both)]
    rows = [*rates.core]
    rows[turn.first], rows[turn.second] = tuple(x for x, _ in pairs), tuple(y for _, y in pairs)
    return Rates(rates.motion, tuple(rows))


def combined(a: Scalar, x: Scalar, b: Scalar, y: Scalar) -> Scalar:
    """a x + b y, term by term where the terms pair up by the addition theorem."""
    left, right = _terms(x), _terms(y)
    if len(left) == len(right) > 1:
        total = a.graph.zero
        for term in left:
            pairs = (other for other in right if (a * term + b * other).size <= term.size)
            partner = next(pairs, None)
            if partner is None:
                return a * x + b * y
            right.remove(partner)
            total = total + (a * term + b * partner)
        return total
    return a * x + b * y


def _terms(x: Scalar) -> list[Scalar]:
    """The summands of x."""
    match x.op:
        case "add":
            return _terms(x.args[0]) + _terms(x.args[1])
        case "sub":
            return _terms(x.args[0]) + [-term for term in _terms(x.args[1])]
        case "neg":
            return [-term for term in _terms(x.args[0])]
        case _:
            return [x]


def _column(a: Matrix, j: int) -> Vector:
    return tuple(row[j] for row in a)


def _size(entries: Vector) -> int:
    return sum(not entry.is_zero for entry in entries)
