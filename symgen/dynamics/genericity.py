"""What is generically true of a system: the rank of B on V and the degree of actuation.

Decided at seeded random configurations on V, in double precision with a gap of many orders of magnitude between
"zero" and "not zero"; a point that falls into the gap is thrown away.
"""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

from symgen.diagnostics import SymgenBug
from symgen.dynamics.mechanics import Mechanics
from symgen.graph.evaluate import Evaluator
from symgen.graph.matrix import flatten
from symgen.graph.translate import translate
from symgen.records import dataclass

SEED = 20120731
POINTS = 6
ATTEMPTS = 60
NEWTON_STEPS = 80
RESIDUAL = 1e-12
NEGLIGIBLE = 1e-9
PLAIN = 1e-5


@dataclass(frozen=True, slots=True)
class Genericity:
    """Generic ranks on V: rho = rank B, delta = n - rho, alpha = rank of the projected control matrix (26)."""

    n: int
    r: int
    m: int
    rank: int
    alpha: int
    geometric_rank: int

    @property
    def delta(self) -> int:
        """Differential degree of freedom (5)."""
        return self.n - self.rank

    @property
    def delta_loc(self) -> int:
        """Local degree of freedom (4)."""
        return self.n - self.geometric_rank

    @property
    def minors(self) -> int:
        """How many minors of the generic rank B has."""
        return math.comb(self.n, self.rank) * math.comb(self.r, self.rank)

    @property
    def full_actuation(self) -> bool:
        """Whether the inputs span every admissible direction."""
        return self.alpha == self.delta


def parameter_values(mechanics: Mechanics) -> dict[str, float]:
    """The default parameters in double precision."""
    graph = mechanics.graph
    values: dict[str, float] = {}
    for parameter in mechanics.model.parameters:
        names = {name: graph.symbol(name) for name in values}
        values[parameter.name] = Evaluator([translate(graph, parameter.value, names)])(values)[0]
    return values


def configurations(mechanics: Mechanics, count: int = POINTS) -> list[dict[str, float]]:
    """Seeded random configurations on V, parameters included; the declared start is tried first."""
    source = random.Random(SEED)
    parameters = parameter_values(mechanics)
    residuals = mechanics.constraint_residual
    rows = len(residuals)
    evaluate = Evaluator([*residuals, *flatten(mechanics.geometric_jacobian)])
    start = {name: float(value) for name, value in mechanics.model.configuration}
    found: list[dict[str, float]] = []
    for attempt in range(ATTEMPTS):
        point = dict(parameters)
        for c in mechanics.model.coordinates:
            lower, upper = map(float, c.range)
            # later attempts leave the neighbourhood of the declared start
            centre = start.get(c.name) if attempt < ATTEMPTS // 2 else None
            width = upper - lower
            if centre is None:
                point[c.name] = source.uniform(lower, upper)
            else:
                point[c.name] = centre + source.uniform(-0.1, 0.1) * width
        solved = _newton(point, [c.name for c in mechanics.model.coordinates], rows, evaluate)
        if solved is not None:
            found.append(solved)
        if len(found) == count:
            break
    return found


def _newton(point: dict[str, float], names: list[str], rows: int, evaluate: Evaluator) -> dict[str, float] | None:
    """Levenberg-Marquardt on g(q) = 0; None where it does not converge."""
    damping = 1e-3
    values = evaluate(point)
    for _ in range(NEWTON_STEPS):
        g = values[:rows]
        size = math.sqrt(sum(x * x for x in g))
        if not size < math.inf:
            return None
        if size < RESIDUAL:
            return point
        jacobian = [values[rows + i * len(names) : rows + (i + 1) * len(names)] for i in range(rows)]
        scale = sum(x * x for row in jacobian for x in row) / rows
        normal = [
            [
                sum(a * b for a, b in zip(p, q, strict=True)) + (damping * scale if i == j else 0.0)
                for j, q in enumerate(jacobian)
            ]
            for i, p in enumerate(jacobian)
        ]
        weights = solve(normal, g)
        if weights is None:
            return None
        trial = dict(point)
        for j, name in enumerate(names):
            trial[name] -= sum(jacobian[i][j] * weights[i] for i in range(rows))
        fresh = evaluate(trial)
        if math.sqrt(sum(x * x for x in fresh[:rows])) < size:
            point, values, damping = trial, fresh, damping * 0.1
        else:
            damping = max(damping, 1e-12) * 10
            if damping > 1e8:
                return None
    return None


def solve(a: list[list[float]], b: list[float]) -> list[float] | None:
    """Gaussian elimination with partial pivoting; None for a singular matrix."""
    rows = [[*row, value] for row, value in zip(a, b, strict=True)]
    size = len(rows)
    for k in range(size):
        pivot = max(range(k, size), key=lambda i: abs(rows[i][k]))
        if not abs(rows[pivot][k]) > 0:
            return None
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, size):
            factor = rows[i][k] / rows[k][k]
            if factor:
                rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    x = [0.0] * size
    for k in reversed(range(size)):
        x[k] = (rows[k][size] - sum(rows[k][j] * x[j] for j in range(k + 1, size))) / rows[k][k]
    return x


def rank(rows: Sequence[Sequence[float]], plain: float = PLAIN) -> int | None:
    """Rank by elimination with complete pivoting of the row-normalised matrix; None where it is not clear-cut."""
    work = []
    for row in rows:
        length = math.sqrt(sum(x * x for x in row))
        if not length < math.inf:
            return None
        work.append([x / length for x in row] if length > 0 else list(row))
    found = 0
    while found < len(work) and work[0]:
        largest = [max(map(abs, row)) for row in work[found:]]
        size = max(largest)
        i = found + largest.index(size)
        j = list(map(abs, work[i])).index(size)
        if size < NEGLIGIBLE:
            return found
        if size < plain:
            return None
        work[found], work[i] = work[i], work[found]
        lead = work[found]
        for k in range(found + 1, len(work)):
            factor = work[k][j] / lead[j]
            if factor:
                work[k] = [x - factor * y for x, y in zip(work[k], lead, strict=True)]
        found += 1
    return found


def genericity(mechanics: Mechanics) -> Genericity:
    """The generic ranks: those most sampled configurations have, the largest where two are as frequent.

    Not the largest of all: beside a singular configuration a residual at rounding level still leaves a distance from V
    of its square root, and off V rows that depend on each other are independent.
    """
    n, r, m = mechanics.n, mechanics.r, mechanics.m
    rows = len(mechanics.geometric_jacobian)
    evaluate = Evaluator([*flatten(mechanics.constraint_jacobian), *(x for c in mechanics.inputs for x in c)])
    points = configurations(mechanics)
    if not points:
        raise SymgenBug(f"genericity: no configuration of {mechanics.model.name} satisfies its constraints")
    found: list[tuple[int, int, int]] = []
    # where lengths of very different sizes meet no point is clear-cut: then what is not negligible counts
    for plain in (PLAIN, NEGLIGIBLE):
        for point in points:
            values = evaluate(point)
            b = [values[i * n : (i + 1) * n] for i in range(r)]
            inputs = [values[(r + k) * n : (r + k + 1) * n] for k in range(m)]
            geometric, constraint, together = rank(b[:rows], plain), rank(b, plain), rank([*b, *inputs], plain)
            if geometric is not None and constraint is not None and together is not None:
                found.append((constraint, together - constraint, geometric))
        if found:
            break
    else:
        raise SymgenBug(f"genericity: the constraints of {mechanics.model.name} have no value where they hold")
    constraint, alpha, geometric = max(found, key=lambda ranks: (found.count(ranks), ranks))
    return Genericity(n, r, m, constraint, alpha, geometric)
