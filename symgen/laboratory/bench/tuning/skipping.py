"""What each thing that a system does not need is worth: operations of u with one of them kept at a time.

Measured on the minor method, which every model has; "kept" means that a number the structure analysis knows is treated
as if it came at run time.  The weight of operations is that of the choice of methods (`symgen.symbolic.traverse.Cost`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from symgen.linear_algebra.exterior import ActuationForms
from symgen.linear_algebra.null_space.null_spaces import MinorSpace
from symgen.mechanics.absolute_angles import absolute_angles
from symgen.mechanics.christoffel import by_christoffel_symbols
from symgen.mechanics.genericity import Genericity, genericity
from symgen.mechanics.system import System
from symgen.methods.derivation import Derivation
from symgen.methods.inverse_dynamics.elimination import Elimination
from symgen.methods.inverse_dynamics.forces_eliminated import elimination_candidate
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.symbolic.angles.sharing import share_angles
from symgen.symbolic.matrix import Matrix, Vector, matvec
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, topological

MOST_CHOICES = 2**12  # of columns; without zeros every choice has a minor of its own
BY_MINORS = (
    "coordinates no constraint touches",
    "zeros of B and M",
    "constants of B and M",
    "forces that vanish",
    "τ without G and C",
    "m = δ",
    "groups of parameters",
    "sines by addition",
    "zeros of G and C",
)


@dataclass(frozen=True, slots=True)
class Skipped:
    """Weighted operations of u: as generated, by the minor method, and with one thing kept."""

    model: str
    generated: int
    minor: int | None  # None where B has too many minors
    kept: tuple[KeptWeight, ...]


@dataclass(frozen=True, slots=True)
class KeptWeight:
    """The weight with one thing kept, and without; None where there is nothing of the kind, or too long a method."""

    what: str
    weight: int | None
    without: int
    too_long: bool = False

    def __str__(self) -> str:
        if self.weight is None:
            return "too long" if self.too_long else "–"
        return f"{self.weight} ({self.weight - self.without:+d})"


class _HidingSystem(System):
    """A system some of whose known numbers hide behind symbols."""

    def __init__(self, model: Model, hide: Callable[[Scalar], bool], columns: Sequence[bool], forces: bool) -> None:
        super().__init__(model)
        self._hide, self._columns, self._forces = hide, columns, forces
        self._hidden = 0

    def _behind(self) -> Scalar:
        self._hidden += 1
        return self.graph.symbol(f"hidden {self._hidden}")

    def _matrix(self, matrix: Matrix, columns: Sequence[bool]) -> Matrix:
        return tuple(
            tuple(
                self._behind() if kept and self._hide(x) else x for x, kept in zip(row, columns, strict=True)
            )
            for row in matrix
        )

    @cached_property
    def constraint_jacobian(self) -> Matrix:
        """B with what is kept as symbols."""
        return self._matrix(super().constraint_jacobian, self._columns)

    @cached_property
    def control_matrix(self) -> Matrix:
        """M with what is kept as symbols, where all coordinates are looked at."""
        plain = super().control_matrix
        return self._matrix(plain, [True] * self.m) if all(self._columns) else plain

    @cached_property
    def potential_force(self) -> Vector:
        """Q with vanishing entries as symbols, where forces are kept."""
        plain = super().potential_force
        return tuple(self._behind() if self._forces and x.is_zero else x for x in plain)


class _WrittenMatrices(System):
    """A system with C as it is written down, by Christoffel symbols."""

    def coriolis_matrix(self) -> Matrix:
        """C along q_dot."""
        return by_christoffel_symbols(self.graph, self.mass_matrix_gradient, self.qd)


class _FullMatrices(_WrittenMatrices):
    """The same with numbers at run time where G and C hold zeros."""

    def _full(self, matrix: Matrix, name: str) -> Matrix:
        return tuple(
            tuple(self.graph.symbol(f"{name} {i} {j}") if x.is_zero else x for j, x in enumerate(row))
            for i, row in enumerate(matrix)
        )

    @cached_property
    def mass_matrix(self) -> Matrix:
        """G without zeros; differentiated, what stands for them has no rate."""
        return self._full(super().mass_matrix, "G")

    def coriolis_matrix(self) -> Matrix:
        """C without zeros."""
        return self._full(super().coriolis_matrix(), "C")


class _WorldAxes(Elimination):
    """The steps of elimination without turning rows and multipliers into the axes of the bodies."""

    def _direction(self, a: Scalar, b: Scalar, lengths: bool = False) -> None:
        del a, b, lengths


class _SummedForms(ActuationForms):
    """The sum over choices of inputs even where there is one choice only."""

    @property
    def single(self) -> bool:
        """Never a plain quotient."""
        return False


def skipped(model: Model) -> Skipped:
    """The counts of one model with inputs."""
    plain = System(model)
    generic = genericity(plain)
    (chosen,) = derive_quantities(model, ("inverse_dynamics",)).quantities
    if generic.minors > MOST_CHOICES:
        none = (KeptWeight(what, None, 0, too_long=True) for what in BY_MINORS)
        return Skipped(model.name, counted_cost(chosen.outputs), None, (*none, _of_axes(model, generic)))
    outputs = _minor(plain, generic)
    kept = (*_of_minors(plain, generic, outputs), *_of_matrices(model, generic), _of_axes(model, generic))
    return Skipped(model.name, counted_cost(chosen.outputs), counted_cost(outputs), kept)


def _of_minors(plain: System, generic: Genericity, outputs: Vector) -> Iterator[KeptWeight]:
    """What the minor method skips."""
    model, b = plain.model, plain.constraint_jacobian
    free = [bool(b) and all(row[j].is_zero for row in b) for j in range(model.n)]
    everywhere, nowhere = [True] * model.n, [False] * model.n
    minor = counted_cost(outputs)

    def weight(mechanics: System) -> int:
        return counted_cost(_minor(mechanics, generic))

    touched = weight(_HidingSystem(model, lambda x: x.is_zero, free, False)) if any(free) else None
    yield KeptWeight("coordinates no constraint touches", touched, minor)
    too_long = 2**model.n > MOST_CHOICES
    full = None if too_long else weight(_HidingSystem(model, lambda x: x.is_zero, everywhere, False))
    yield KeptWeight("zeros of B and M", full, minor, too_long)
    constants = weight(_HidingSystem(model, lambda x: bool(x.constant), everywhere, False))
    yield KeptWeight("constants of B and M", constants, minor)
    vanishing = any(x.is_zero for x in plain.potential_force)
    forces = weight(_HidingSystem(model, lambda _: False, nowhere, True)) if vanishing else None
    yield KeptWeight("forces that vanish", forces, minor)
    yield KeptWeight("τ without G and C", counted_cost(_by_matrices(_WrittenMatrices(model), generic)), minor)
    square = generic.m == generic.delta == generic.alpha and generic.rank == generic.r
    yield KeptWeight("m = δ", counted_cost(_summed(model, generic)) if square else None, minor)
    yield KeptWeight("groups of parameters", _each_time(plain, outputs), minor)
    unshared = cost(outputs).weight
    yield KeptWeight("sines by addition", unshared if unshared != minor else None, minor)


def _of_matrices(model: Model, generic: Genericity) -> Iterator[KeptWeight]:
    """What the matrices G and C skip, where u is formed from them."""
    systems = _WrittenMatrices(model), _FullMatrices(model)
    plain, full = (counted_cost(_by_matrices(system, generic)) for system in systems)
    yield KeptWeight("zeros of G and C", full if full != plain else None, plain)


def _of_axes(model: Model, generic: Genericity) -> KeptWeight:
    """What body-fixed axes save in elimination."""

    def weight(steps: Callable[[System], Elimination]) -> int | None:
        mechanics = System(model)
        change = absolute_angles(mechanics.q, mechanics.constraint_jacobian)
        seen = mechanics if change.is_identity else System(model, mechanics, change)
        made = elimination_candidate(seen, generic, steps)
        return None if made is None else counted_cost(made.derived.outputs)

    plain, world = weight(Elimination), weight(_WorldAxes)
    return KeptWeight("body-fixed axes", None if plain is None or world == plain else world, plain or 0)


def _minor(mechanics: System, generic: Genericity) -> Vector:
    space = MinorSpace(mechanics.graph, mechanics.constraint_jacobian, mechanics.n, generic.rank)
    return Derivation(mechanics, generic, space).inverse_dynamics


def _by_matrices(mechanics: _WrittenMatrices, generic: Genericity) -> Vector:
    """u from G q_ddot + C q_dot + Q - Q_a with the matrices G and C."""
    graph, qd = mechanics.graph, mechanics.qd
    inertial = matvec(graph, mechanics.mass_matrix, mechanics.qdd)
    coriolis = matvec(graph, mechanics.coriolis_matrix(), qd)
    forces = zip(inertial, coriolis, mechanics.potential_force, mechanics.applied_force, strict=True)
    space = MinorSpace(graph, mechanics.constraint_jacobian, mechanics.n, generic.rank)
    forms, restriction = space.listed_actuation(mechanics.inputs, generic.alpha)
    return forms.solve(restriction(tuple(g + c + q - a for g, c, q, a in forces)))


def _summed(model: Model, generic: Genericity) -> Vector:
    mechanics = System(model)
    space = MinorSpace(mechanics.graph, mechanics.constraint_jacobian, mechanics.n, generic.rank)
    forms, restriction = space.listed_actuation(mechanics.inputs, generic.alpha)
    return _SummedForms(forms.rows, forms.inputs, forms.degree).solve(restriction(mechanics.balance))


def _each_time(mechanics: System, outputs: Vector) -> int | None:
    """The weight with every group of parameters formed again wherever it is used; None without groups."""
    fixed = mechanics.factoring.fixed
    nodes = topological(share_angles(mechanics.graph, outputs))
    uses = [a for node in nodes if not fixed(node) for a in node.args if fixed(a) and a.op not in ("const", "symbol")]
    shared = cost(uses).weight
    again = sum(cost([group]).weight for group in uses)
    return None if not uses else counted_cost(outputs) + again - shared


def counted_cost(outputs: Sequence[Scalar]) -> int:
    """That of scalars of one graph, sines of sums from those of their parts."""
    return cost(share_angles(outputs[0].graph, outputs)).weight


def page(rows: Sequence[Skipped]) -> str:
    """The page docs/skipping.md."""
    names = [kept.what for kept in rows[0].kept]
    head = ["model", "u as generated", "minor method", *names]
    lines = [table_line(head), table_line(["---"] * len(head))]
    for row in rows:
        minor = "too long" if row.minor is None else row.minor
        lines.append(table_line([row.model, row.generated, minor, *row.kept]))
    return _PAGE.replace("TABLE", "\n".join(lines))


def table_line(cells: Sequence[object]) -> str:
    """A row of a table in Markdown."""
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


_PAGE = """\
# What a system does not need, in operations

The structure analysis finds what a system does not need, and says why (`symgen MODEL.yaml`, the report,
`derivation.json`). This table says what each finding is worth for the inverse dynamics: weighted operations with one of
them kept, that is, treated as if its number came at run time or its work were done each time. A sum or product weighs
1, a quotient or root 6, a sine and cosine 30. Rank tests are not counted. Made by `make skipping`.

TABLE

- *u as generated* against *minor method* is what the choice of the method is worth, for one thing that M selects rows.
- *coordinates no constraint touches*, *zeros of B and M*: their zero entries as numbers at run time. *constants*: the
  entries that are numbers other than 0. *forces that vanish*: the zero entries of Q.
- *τ without G and C*: G q̈ + C q̇ with the matrices G and C instead of the vector by itself, which is the cheaper of
  two derivations.
- *m = δ*: the sum over choices of inputs where there is one choice.
- *groups of parameters*: sums and products of parameters alone formed wherever they are used.
- *sines by addition*: a sine and cosine of its own for each angle.
- *zeros of G and C*: what stands where they are zero as numbers at run time, against τ by these matrices.
- *body-fixed axes*: elimination whose rows and multipliers stay in the axes of the model, against elimination.
- A small minus is a product that happens to be shared; the slider-crank does not take elimination. Where bodies are
  given, τ comes from their frames, and the matrices of a small mechanism can be shorter; so is *u as generated*, which
  eliminates on the way through the frames.
- *too long*: with the zeros kept, every choice of 16 or 32 columns has a minor of its own; 18 rows of 24 columns have
  134596 minors.
- No shipped model has several blocks of B. For two skates and a rod on one plane
  (`tests/linear_algebra/test_blocks.py`) B⁺ weighs 87 block by block and 158 taken together.
"""
