"""What a system does not need: decisions with their reasons, for the command line, the report and derivation.json."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import comb

from symgen.linear_algebra.blocks import ConnectedComponent, ConstraintBlock, components, named
from symgen.mechanics.free_fall import falls_freely
from symgen.mechanics.genericity import Genericity, at_configurations, rank
from symgen.mechanics.system import System
from symgen.mechanics.workless_forces import workless_forces
from symgen.model.expressions.names import counted
from symgen.model.model import ConstraintRow, Model
from symgen.records import dataclass
from symgen.symbolic.angles.angle_forms import angle_form
from symgen.symbolic.angles.sharing import angles_of, share_angles
from symgen.symbolic.matrix import flatten
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import topological

# Names that a reason lists; of more it tells how many.
MOST_NAMES = 4
# A mass matrix with more entries is not formed to be looked through: u does without it.
MOST_ENTRIES = 100


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
    blocks: tuple[ConstraintBlock, ...]
    dependent_rows: tuple[str, ...]
    decisions: tuple[Decision, ...]


def analyse(mechanics: System, generic: Genericity) -> Structure:
    """The structure of a system: blocks of B, vanishing and constant parts, angles, the kind of actuation."""
    coordinates = [c.name for c in mechanics.model.coordinates]
    b = mechanics.constraint_jacobian
    free = tuple(name for j, name in enumerate(coordinates) if all(row[j].is_zero for row in b)) if b else ()
    blocks, dependent = _ranked(mechanics, generic)
    decisions = (
        *_constraint_decisions(mechanics, generic, free, blocks, dependent),
        *_force_decisions(mechanics),
        *_borne_forces(mechanics.model, generic),
        *_input_decisions(mechanics, generic),
        *_shared_work(mechanics),
    )
    return Structure(_actuation(generic), free, blocks, dependent, decisions)


def _actuation(generic: Genericity) -> str:
    """The actuation scheme of section 4.1, by the generic degree of actuation (26)."""
    if generic.m == 0:
        return "no inputs"
    degree = "full-actuated" if generic.full_actuation else "under-actuated"
    return f"{'redundantly' if generic.m > generic.alpha else 'non-redundantly'} {degree}"


def _rows_in_order(mechanics: System) -> list[ConstraintRow]:
    rows = mechanics.model.constraints
    return [*(row for row in rows if row.kind == "geometric"), *(row for row in rows if row.kind == "nonholonomic")]


def _ranked(mechanics: System, generic: Genericity) -> tuple[tuple[ConstraintBlock, ...], tuple[str, ...]]:
    """The blocks with their generic ranks, and the rows that can be left out without lowering the rank (Remark 7)."""
    r = mechanics.r
    rows = [row.name for row in _rows_in_order(mechanics)]
    coordinates = [c.name for c in mechanics.model.coordinates]
    parts = list(components(mechanics.constraint_jacobian))
    ranks = [generic.rank] * len(parts)
    dependent: tuple[str, ...] = ()
    if len(parts) > 1 or generic.rank < r:
        for b in at_configurations(mechanics, mechanics.constraint_jacobian):
            part_ranks = [_rank(b, part) for part in parts]
            if rank(b) == generic.rank == sum(part_ranks):
                spare = [i for i in range(r) if rank([*b[:i], *b[i + 1 :]]) == generic.rank]
                ranks, dependent = part_ranks, tuple(rows[i] for i in spare)
                break
    blocks = (named(part, rows, coordinates, its) for part, its in zip(parts, ranks, strict=True))
    return tuple(blocks), dependent


def _rank(b: Sequence[Sequence[float]], part: ConnectedComponent) -> int:
    part_rank = rank([b[i] for i in part.rows])
    return -1 if part_rank is None else part_rank


def _constraint_decisions(
    mechanics: System,
    generic: Genericity,
    free: tuple[str, ...],
    blocks: tuple[ConstraintBlock, ...],
    dependent: tuple[str, ...],
) -> Iterator[Decision]:
    if generic.r == 0:
        yield Decision("null space and multipliers", "there are no constraints, N_B is the identity")
        return
    if free:
        yield Decision(f"constraint terms of {', '.join(free)}", "no constraint touches these coordinates")
    if len(blocks) > 1:
        sizes = "; ".join(f"{', '.join(b.rows)} on {', '.join(b.coordinates) or 'no coordinate'}" for b in blocks)
        yield Decision("coupling between constraint blocks", f"the rows fall into {len(blocks)} blocks: {sizes}")
    for block in blocks:
        if block.coordinates:
            what = "(B Bᵀ)⁻¹" if len(blocks) == 1 else f"(B Bᵀ)⁻¹ of {_some(block.rows)}"
            size = f"δ = {block.delta} for {counted(len(block.coordinates), 'coordinate')}"
            yield Decision(what, f"{size}: {block.null_space}")
    if not mechanics.constraint_residual:
        yield Decision("projection of configurations", "there are no geometric constraints")
    entries = flatten(mechanics.constraint_jacobian)
    if not _moving(mechanics, entries):
        yield Decision("rates of B and N_B", "the constraint Jacobian is constant")
    else:
        yield from _entries(mechanics, "B", entries)
    if dependent:
        rows = ", ".join(dependent)
        why = f"the rows {rows} depend on each other: rank {generic.rank} of {generic.r}; none is dropped"
        yield Decision("a unique set of multipliers", why)


def _force_decisions(mechanics: System) -> Iterator[Decision]:
    if mechanics.n * (mechanics.n + 1) // 2 <= MOST_ENTRIES:
        yield from _inertia_decisions(mechanics)
    else:
        yield from _velocity_decisions(mechanics)
    if all(entry.is_zero for entry in mechanics.potential_force):
        yield Decision("potential forces", "the potential energy is constant, so Q = 0")
    else:
        yield from _zeros("potential forces", mechanics.potential_force)
    if not mechanics.model.has_applied_forces:
        yield Decision("applied forces", "the model declares none")


def _borne_forces(model: Model, generic: Genericity) -> Iterator[Decision]:
    """Weights and forces that the rows bear in every configuration."""
    workless = workless_forces(model, generic)
    if workless:
        others = bool(workless.terms) + len(workless.forces) + len(workless.loads)
        parts = [*(["weights"] if workless.weights else []), *([counted(others, "force")] if others else [])]
        yield Decision(f"{' and '.join(parts)} in u and q̈", "constraints bear them whatever the configuration")
    if falls_freely(model):
        yield Decision("weights in λ", "the system falls freely, all of it alike")


def _inertia_decisions(mechanics: System) -> Iterator[Decision]:
    n = mechanics.n
    g = [mechanics.mass_matrix[i][j] for i in range(n) for j in range(i, n)]
    moving = _moving(mechanics, g)
    if not moving:
        yield Decision("Coriolis forces", "the mass matrix is constant, so C = 0")
    else:
        yield from _velocity_decisions(mechanics)
    zeros = sum(mechanics.mass_matrix[i][j].is_zero for i in range(n) for j in range(i))
    if zeros:
        yield Decision(f"{zeros} of {n * (n - 1) // 2} couplings in G", _are(zeros, "zero"))
    fixed = len([x for x in g if not x.is_zero]) - len(moving)
    if fixed and moving:
        yield Decision(f"derivatives of {fixed} of {len(g)} entries of G", _are(fixed, "constant"))


def _velocity_decisions(mechanics: System) -> Iterator[Decision]:
    if all(entry.is_zero for entry in mechanics.coriolis_force):
        yield Decision("Coriolis forces", "the quadratic velocity terms cancel, so C q_dot = 0")
    else:
        yield from _zeros("Coriolis forces", mechanics.coriolis_force)


def _input_decisions(mechanics: System, generic: Genericity) -> Iterator[Decision]:
    if not mechanics.m:
        yield Decision("inverse dynamics", "the model declares no inputs")
        return
    entries = [[x for x in column if not x.is_zero] for column in mechanics.inputs]
    if all(len(column) == 1 and column[0].is_one for column in entries):
        yield Decision("products with M", "every input drives one coordinate, M selects rows")
    else:
        yield from _entries(mechanics, "M", flatten(mechanics.control_matrix))
    if generic.full_actuation:
        yield Decision("inverse dynamics residual", "the inputs span every admissible direction")
    if generic.m == generic.alpha:
        yield Decision("minimum-norm step", f"as many independent inputs as needed: m = {generic.m}")
    elif generic.full_actuation:
        why = f"m = {generic.m} inputs for δ = {generic.delta}: all {comb(generic.m, generic.alpha)} choices are summed"
        if mechanics.model.keeps_limits:
            why = f"m = {generic.m} inputs for δ = {generic.delta}: reflections take all of them together"
        yield Decision("switching between choices of inputs", why)


def _shared_work(mechanics: System) -> Iterator[Decision]:
    """Values that do not enter, sines and cosines that follow from others, and what parameters alone decide."""
    parts = [
        mechanics.kinetic_energy,
        mechanics.potential_energy,
        *flatten(mechanics.constraint_jacobian),
        *flatten(mechanics.control_matrix),
        *mechanics.applied_force,
    ]
    nodes = set(topological(parts))
    idle = [c.name for c, q in zip(mechanics.model.coordinates, mechanics.q, strict=True) if q not in nodes]
    if idle:
        yield Decision(f"the values of {_some(idle)}", "only their rates and accelerations matter")
    evaluated = set(angles_of(share_angles(mechanics.graph, parts)))
    derived = [angle for angle in angles_of(parts) if angle not in evaluated]
    if derived:
        names = _some([_sum_of(angle) for angle in derived])
        why = "by addition from those of their parts, where these are needed"
        yield Decision(f"sine and cosine of {names}", why)
    fixed = mechanics.factoring.fixed
    groups = {
        inner
        for node in nodes
        if not fixed(node)
        for inner in node.args
        if inner.op not in ("const", "symbol") and fixed(inner)
    }
    if groups:
        why = "sums and products of parameters alone are formed once"
        yield Decision(f"repeated work on {counted(len(groups), 'group')} of parameters", why)


def _entries(mechanics: System, name: str, entries: Sequence[Scalar]) -> Iterator[Decision]:
    """Zero and constant entries of a matrix."""
    zeros = sum(entry.is_zero for entry in entries)
    fixed = len(entries) - zeros - len(_moving(mechanics, entries))
    if zeros:
        yield Decision(f"{zeros} of {len(entries)} entries of {name}", _are(zeros, "zero"))
    if fixed:
        yield Decision(f"rates of {fixed} of {len(entries)} entries of {name}", _are(fixed, "constant"))


def _zeros(what: str, entries: Sequence[Scalar]) -> Iterator[Decision]:
    zeros = sum(entry.is_zero for entry in entries)
    if zeros:
        yield Decision(f"{zeros} of {len(entries)} {what}", _are(zeros, "zero"))


def _are(count: int, what: str) -> str:
    return f"it is {what}" if count == 1 else f"they are {what}"


def _moving(mechanics: System, entries: Sequence[Scalar]) -> list[Scalar]:
    """The entries that depend on a coordinate."""
    coordinates = set(mechanics.q)
    return [entry for entry in entries if any(node in coordinates for node in topological([entry]))]


def _sum_of(angle: Scalar) -> str:
    """An angle as the sum of its leaves: `theta + phi`."""
    text = ""
    for leaf, count in sorted(angle_form(angle).items(), key=lambda term: term[0].serial):
        name = str(leaf.payload) if leaf.op == "symbol" else "(...)"
        size = name if abs(count) == 1 else f"{abs(count)}*{name}"
        text += (f" {'-' if count < 0 else '+'} " if text else "-" if count < 0 else "") + size
    return text


def _some(names: Sequence[str]) -> str:
    """The names, or the first few and how many more."""
    shown = ", ".join(names[:MOST_NAMES])
    return shown if len(names) <= MOST_NAMES else f"{shown} and {len(names) - MOST_NAMES} more"
