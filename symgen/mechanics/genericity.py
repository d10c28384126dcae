"""What is generically true of a system: the rank of B on V and the degree of actuation.

Both hold on one branch of configurations (`model/configurations/branches.py`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from symgen.diagnostics import SymgenBug
from symgen.linear_algebra.blocks import components
from symgen.linear_algebra.null_space.proportional_columns import families, folded
from symgen.mechanics.system import System
from symgen.model.configurations.assembly import Assembly
from symgen.model.configurations.branches import branches
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.configurations.sparse import NEGLIGIBLE, PLAIN, clear_rank
from symgen.model.model import Model
from symgen.records import dataclass
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.matrix import Matrix, flatten
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.translate import translate


@dataclass(frozen=True, slots=True)
class Genericity:
    """Generic ranks on V: rho = rank B, delta = n - rho, alpha = rank of the projected control matrix (26).

    The ranks of B and of [B; M^T] are identical where no configuration, on V or off it, exceeds them.  `locked` are the
    numbers of coordinates that rows without others lock, as many as the rank of these rows; where columns of B are
    multiples of each other, of the first coordinate of each family whose sum is locked.
    """

    n: int
    r: int
    m: int
    rank: int
    alpha: int
    geometric_rank: int
    rank_is_identical: bool = True
    actuation_is_identical: bool = True
    locked: tuple[int, ...] = ()

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


def parameter_values(mechanics: System) -> dict[str, float]:
    """The default parameters in double precision."""
    graph = mechanics.graph
    values: dict[str, float] = {}
    for parameter in mechanics.model.parameters:
        names = {name: graph.symbol(name) for name in values}
        values[parameter.name] = Evaluator([translate(graph, parameter.value, names)])(values)[0]
    return values


def assembly_of(model: Model) -> Assembly:
    """What loading found about the configurations; found here where the model was not read from a file."""
    if model.assembly is not None:
        return model.assembly
    start = {name: float(value) for name, value in model.configuration}
    assembly = branches(NumericSystem.of(model), model.inputs, start)
    if not isinstance(assembly, Assembly):
        raise SymgenBug(f"genericity: no configuration of {model.name} satisfies its constraints")
    return assembly


def configurations(mechanics: System) -> list[dict[str, float]]:
    """Configurations on V with the generic ranks, parameters included; where the declared start leads is the first."""
    parameters = parameter_values(mechanics)
    names = [c.name for c in mechanics.model.coordinates]
    return [parameters | dict(zip(names, place.q, strict=True)) for place in assembly_of(mechanics.model).places]


def at_configurations(mechanics: System, rows: Matrix) -> list[list[list[float]]]:
    """The rows of B, or what they are gathered to, at each of the `configurations`.

    A row is 0 where it vanishes and rounding alone is left of it: its length there would be no measure.
    """
    width, none = len(rows[0]) if rows else 0, (0,) * len(rows)
    own, done = assembly_of(mechanics.model).own_units, mechanics.model.row_units or none
    # of rows that are others than the file's no units are known
    least = [
        math.ldexp(NEGLIGIBLE, unit - usual)
        for usual, unit in zip(own if len(own) == len(rows) else none, done, strict=True)
    ]
    evaluate = Evaluator(flatten(rows))
    made = []
    for point in configurations(mechanics):
        values = evaluate(point)
        at = [list(values[i * width : (i + 1) * width]) for i in range(len(rows))]
        made.append([[0.0] * width if math.hypot(*row) <= size else row for row, size in zip(at, least, strict=True)])
    return made


def rank(rows: Sequence[Sequence[float]], plain: float = PLAIN) -> int | None:
    """Rank by elimination with complete pivoting of the row-normalised matrix; None where it is not clear-cut."""
    work = []
    for row in rows:
        length = math.hypot(*row)
        if not length < math.inf:
            return None
        work.append({j: x / length for j, x in enumerate(row) if x} if length else {})
    return clear_rank(work, plain)


def genericity(mechanics: System) -> Genericity:
    """The ranks kernels are made for: those of the branch that is meant."""
    assembly = assembly_of(mechanics.model)
    ranks, identical = assembly.ranks, (assembly.rank_is_identical, assembly.actuation_is_identical)
    sizes = mechanics.n, mechanics.r, mechanics.m
    locked = _locked(mechanics, assembly.held)
    return Genericity(*sizes, ranks.constraints, ranks.actuation, ranks.geometric, *identical, locked)


def _locked(mechanics: System, held: Sequence[int]) -> tuple[int, ...]:
    """Of coordinates that cannot move, or sums over families of them, what rows without others lock everywhere.

    Such rows have as many columns as their rank, which is tested at run time: where they have it, nothing moves there.
    Others are held along this branch alone, and may move along another.
    """
    column_families = families(mechanics.constraint_jacobian, mechanics.n)
    gathered = any(len(family.members) > 1 for family in column_families)
    if not held and not gathered:
        return ()
    rows = tuple(folded(row, column_families) for row in mechanics.constraint_jacobian)
    places = at_configurations(mechanics, rows)
    if gathered:
        still = [k for k in range(len(column_families)) if all(_holds(at, k) for at in places)]
    else:
        still = [k for k, family in enumerate(column_families) if family.members[0] in held]
    own = [i for i, row in enumerate(rows) if _lies_in(row, still)]
    locked: list[int] = []
    for part in components(tuple(tuple(rows[i][k] for k in still) for i in own)):
        ranks = {rank([[at[own[i]][still[k]] for k in part.columns] for i in part.rows]) for at in places}
        if ranks == {len(part.columns)}:
            locked += (column_families[still[k]].members[0] for k in part.columns)
    return tuple(sorted(locked))


def _holds(rows: Sequence[Sequence[float]], column: int) -> bool:
    """Whether rows leave no motion along a column."""
    axis = [float(k == column) for k in range(len(rows[0]))]
    known = rank(rows)
    return known is not None and rank([*rows, axis]) == known


def _lies_in(row: Sequence[Scalar], columns: Sequence[int]) -> bool:
    return all(entry.is_zero for j, entry in enumerate(row) if j not in columns)
