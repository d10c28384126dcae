"""What a scene does not need: decisions with their reasons, for the command line, the report and derivation.json."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from symgen.dynamics.genericity import Genericity, configurations, rank
from symgen.dynamics.mechanics import Mechanics
from symgen.graph.evaluate import Evaluator
from symgen.graph.matrix import Matrix, flatten
from symgen.graph.scalar import Scalar
from symgen.graph.traverse import topological
from symgen.model.model import ConstraintRow


@dataclass(frozen=True, slots=True)
class Decision:
    """Something that is left out or simplified, and why."""

    what: str
    why: str


@dataclass(frozen=True, slots=True)
class Structure:
    """Facts of a system that no formula has to find out again."""

    actuation: str
    free_coordinates: tuple[str, ...]
    blocks: tuple[tuple[tuple[str, ...], tuple[str, ...]], ...]
    dependent_rows: tuple[str, ...]
    decisions: tuple[Decision, ...]


def analyse(mechanics: Mechanics, generic: Genericity) -> Structure:
    """The structure of a system: blocks of B, vanishing and constant parts, the kind of actuation."""
    model = mechanics.model
    coordinates = [c.name for c in model.coordinates]
    b = mechanics.constraint_jacobian
    free = tuple(name for j, name in enumerate(coordinates) if all(row[j].is_zero for row in b)) if b else ()
    blocks = _blocks(mechanics, b)
    dependent = _dependent_rows(mechanics, generic)
    decisions = (
        *_constraint_decisions(mechanics, generic, free, blocks, dependent),
        *_force_decisions(mechanics),
        *_input_decisions(mechanics, generic),
    )
    return Structure(_actuation(generic), free, blocks, dependent, decisions)


def _actuation(generic: Genericity) -> str:
    """The actuation scheme of section 4.1, by the generic degree of actuation (26)."""
    if generic.m == 0:
        return "no inputs"
    degree = "full-actuated" if generic.full_actuation else "under-actuated"
    return f"{'redundantly' if generic.m > generic.alpha else 'non-redundantly'} {degree}"


def _blocks(mechanics: Mechanics, b: Matrix) -> tuple[tuple[tuple[str, ...], tuple[str, ...]], ...]:
    """The connected components of B's bipartite graph: (rows, coordinates) that do not meet the others."""
    names = [c.name for c in mechanics.model.coordinates]
    rows = [row.name for row in _rows_in_order(mechanics)]
    remaining = set(range(len(b)))
    found = []
    while remaining:
        members = {min(remaining)}
        touched: set[int] = set()
        grown = True
        while grown:
            touched = {j for i in members for j, entry in enumerate(b[i]) if not entry.is_zero}
            more = {i for i in remaining if any(not b[i][j].is_zero for j in touched)} | members
            grown, members = more != members, more
        remaining -= members
        found.append((tuple(rows[i] for i in sorted(members)), tuple(names[j] for j in sorted(touched))))
    return tuple(found)


def _rows_in_order(mechanics: Mechanics) -> list[ConstraintRow]:
    rows = mechanics.model.constraints
    return [*(row for row in rows if row.kind == "geometric"), *(row for row in rows if row.kind == "nonholonomic")]


def _dependent_rows(mechanics: Mechanics, generic: Genericity) -> tuple[str, ...]:
    """Rows that can be left out without lowering the generic rank: the members of the dependencies (Remark 7)."""
    if generic.rank == generic.r:
        return ()
    n, r = mechanics.n, mechanics.r
    evaluate = Evaluator(flatten(mechanics.constraint_jacobian))
    for point in configurations(mechanics):
        values = evaluate(point)
        b = [values[i * n : (i + 1) * n] for i in range(r)]
        if rank(b) == generic.rank:
            rows = _rows_in_order(mechanics)
            return tuple(rows[i].name for i in range(r) if rank([*b[:i], *b[i + 1 :]]) == generic.rank)
    return ()


def _constraint_decisions(
    mechanics: Mechanics,
    generic: Genericity,
    free: tuple[str, ...],
    blocks: tuple[tuple[tuple[str, ...], tuple[str, ...]], ...],
    dependent: tuple[str, ...],
) -> list[Decision]:
    decisions = []
    if generic.r == 0:
        decisions.append(Decision("null space and multipliers", "there are no constraints, N_B is the identity"))
    if free:
        decisions.append(Decision(f"constraint terms of {', '.join(free)}", "no constraint touches these coordinates"))
    if len(blocks) > 1:
        sizes = "; ".join(f"{', '.join(rows)} on {', '.join(columns) or 'no coordinate'}" for rows, columns in blocks)
        why = f"the rows fall into {len(blocks)} blocks: {sizes}"
        decisions.append(Decision("coupling between constraint blocks", why))
    if generic.r and not mechanics.constraint_residual:
        decisions.append(Decision("projection of configurations", "there are no geometric constraints"))
    if generic.r and all(entry.constant is not None for row in mechanics.constraint_jacobian for entry in row):
        decisions.append(Decision("rates of B and N_B", "the constraint Jacobian is constant"))
    if dependent:
        rows = ", ".join(dependent)
        why = f"the rows {rows} depend on each other: rank {generic.rank} of {generic.r}; none is dropped"
        decisions.append(Decision("a unique set of multipliers", why))
    return decisions


def _force_decisions(mechanics: Mechanics) -> list[Decision]:
    decisions = []
    g = flatten(mechanics.mass_matrix)
    if not _moving(mechanics, g):
        decisions.append(Decision("Coriolis forces", "the mass matrix is constant, so C = 0"))
    elif all(entry.is_zero for entry in mechanics.coriolis_force):
        decisions.append(Decision("Coriolis forces", "the quadratic velocity terms cancel, so C q_dot = 0"))
    zeros = sum(mechanics.mass_matrix[i][j].is_zero for i in range(mechanics.n) for j in range(i))
    if zeros:
        decisions.append(Decision(f"{zeros} of {mechanics.n * (mechanics.n - 1) // 2} couplings in G", "they are zero"))
    if all(entry.is_zero for entry in mechanics.potential_force):
        decisions.append(Decision("potential forces", "the potential energy is constant, so Q = 0"))
    if not mechanics.model.applied_forces:
        decisions.append(Decision("applied forces", "the model declares none"))
    return decisions


def _moving(mechanics: Mechanics, entries: Sequence[Scalar]) -> list[Scalar]:
    """The entries that depend on a coordinate."""
    coordinates = set(mechanics.q)
    return [entry for entry in entries if any(node in coordinates for node in topological([entry]))]


def _input_decisions(mechanics: Mechanics, generic: Genericity) -> list[Decision]:
    decisions = []
    if not mechanics.m:
        return [Decision("inverse dynamics", "the model declares no inputs")]
    entries = [[x for x in column if not x.is_zero] for column in mechanics.inputs]
    if all(len(column) == 1 and column[0].is_one for column in entries):
        decisions.append(Decision("products with M", "every input drives one coordinate, M selects rows"))
    if generic.full_actuation:
        decisions.append(Decision("inverse dynamics residual", "the inputs span every admissible direction"))
    if generic.m == generic.alpha:
        decisions.append(Decision("minimum-norm step", f"as many independent inputs as needed: m = {generic.m}"))
    return decisions
