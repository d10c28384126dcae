"""What goes wrong where: functions of q and the parameters that vanish at singularities.

Where closed forms exist, every minor of B and every determinant [M_J, B'] is factored exactly, and each factor that can
vanish is a trouble of its own.  Without closed forms the determinants themselves are taken.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from math import comb
from typing import TYPE_CHECKING, Any, TypeAlias

from flint import arb, arb_mat, fmpq

from symgen.model.expressions.expression import Name
from symgen.model.kinematics.energy_form import energy_form
from symgen.model.model import Model
from symgen.verify.reference.arithmetic.linear import determinant
from symgen.verify.reference.reference import Reference

if TYPE_CHECKING:
    from sympy.polys.rings import PolyElement

    from symgen.closedform.exact import Exact

Values: TypeAlias = Callable[[Sequence[Any], Sequence[Any]], list[Any]]
MOST_DETERMINANTS = 400


@dataclass(frozen=True, slots=True)
class Trouble:
    """Functions (q, parameters) -> balls that vanish together, and what fails there.

    `partitions` are the sets of independent coordinates (indices), `inputs` the choices of inputs that fail.
    """

    label: str
    values: Values
    partitions: tuple[tuple[int, ...], ...] = ()
    inputs: tuple[tuple[int, ...], ...] = ()


@dataclass
class _DeterminantFactor:
    value: PolyElement
    label: str
    partitions: list[tuple[int, ...]] = field(default_factory=list)
    inputs: list[tuple[int, ...]] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Choices:
    """The troubles of choices (of coordinates, of inputs), and every choice there is; factored where that is possible.

    A choice that no trouble names never fails.
    """

    troubles: tuple[Trouble, ...]
    partitions: tuple[tuple[int, ...], ...]
    inputs: tuple[tuple[int, ...], ...]
    factored: bool


def choices(reference: Reference) -> Choices:
    """The determinants of all choices, factored where closed forms exist."""
    return _factored(reference.model) or Choices(tuple(_numeric(reference)), (), (), False)


def common_troubles(known: Choices) -> Iterator[tuple[str, Trouble]]:
    """Sets of up to three factors without which no choice of coordinates (of inputs) is left: rank B (the degree of
    actuation) can drop only where such a set vanishes at once.
    """
    sides: tuple[tuple[str, tuple[tuple[int, ...], ...], Callable[[Trouble], tuple[tuple[int, ...], ...]]], ...] = (
        ("constraint", known.partitions, lambda t: t.partitions),
        ("input", known.inputs, lambda t: t.inputs),
    )
    for kind, everything, killed in sides:
        smaller: list[set[int]] = []
        for size in (1, 2, 3):
            for chosen in combinations(range(len(known.troubles)), size):
                members = [known.troubles[k] for k in chosen]
                covered = {subset for trouble in members for subset in killed(trouble)}
                if not everything or covered != set(everything) or any(s <= set(chosen) for s in smaller):
                    continue
                smaller.append(set(chosen))
                if size > 1:
                    yield kind, _all_of(members)


def _all_of(members: Sequence[Trouble]) -> Trouble:
    def values(q: Sequence[Any], parameters: Sequence[Any]) -> list[Any]:
        return [value for trouble in members for value in trouble.values(q, parameters)]

    label = " = ".join(trouble.label for trouble in members) + " = 0"
    partitions = tuple(dict.fromkeys(subset for trouble in members for subset in trouble.partitions))
    inputs = tuple(dict.fromkeys(subset for trouble in members for subset in trouble.inputs))
    return Trouble(label, values, partitions, inputs)


def _factored(model: Model) -> Choices | None:
    from symgen.closedform.algebra.limits import TooLargeError
    from symgen.closedform.exact import Exact
    from symgen.closedform.mechanics import ExactSystem, make_translator
    from symgen.closedform.points import generic_points
    from symgen.closedform.structure import derive_structure

    model = energy_form(model)
    try:
        mechanics = ExactSystem(model, make_translator(model, ()))
        points = generic_points(model, mechanics, 3) or generic_points(model, mechanics, 3, on_constraints=False)
        exact = Exact(model, mechanics, derive_structure(model, mechanics, points))
        if not exact.ring.is_complete or len(exact.minor_sets) > 1:
            return None
        with exact.ring.work.limited("the factors of the determinants"):
            return _factors(model, exact)
    except (TooLargeError, ArithmeticError):
        return None


def _factors(model: Model, exact: Exact) -> Choices:
    from symgen.closedform.singular import essential_factors
    from symgen.closedform.spelling import Speller
    from symgen.report.terminal import render_text_math

    ring = exact.ring
    speller = Speller(ring, ())
    by_value: dict[PolyElement, _DeterminantFactor] = {}

    def factors(p: PolyElement) -> list[_DeterminantFactor]:
        result = []
        for value in essential_factors(ring, p):
            if value not in by_value:
                spelled = speller.polynomial(ring.normal(value))
                unsigned = -spelled if spelled.could_extract_minus_sign() else spelled
                label = " ".join(render_text_math(unsigned, model, width=10_000).split())
                by_value[value] = _DeterminantFactor(value, label)
            result.append(by_value[value])
        return result

    partitions: list[tuple[int, ...]] = []
    inputs: list[tuple[int, ...]] = []
    for minors in exact.minor_sets if model.constraints else ():
        partitions = [subset for subset, minor in minors.values.items() if minor]
        for subset in partitions:
            for factor in factors(minors.values[subset]):
                factor.partitions.append(subset)
        for factor in factors(minors.content):
            factor.partitions = list(partitions)
    for actuation in exact.actuations if model.inputs and exact.full_actuation else ():
        inputs = [subset for subset, value in actuation.determinants.items() if value]
        for subset in inputs:
            for factor in factors(actuation.determinants[subset]):
                factor.inputs.append(subset)
    known = [
        Trouble(f.label, _ring_values(model, exact, f.value), tuple(f.partitions), tuple(f.inputs))
        for f in by_value.values()
    ]
    return Choices(tuple(known), tuple(partitions), tuple(inputs), True)


def _ring_values(model: Model, exact: Exact, p: PolyElement) -> Values:
    """Evaluate a ring element of coordinates and parameters in ball arithmetic."""
    ring = exact.ring
    names = [c.name for c in model.coordinates] + [x.name for x in model.parameters]
    terms = [(fmpq(int(c.numerator), int(c.denominator)), m) for m, c in p.items()]

    def values(q: Sequence[Any], parameters: Sequence[Any]) -> list[Any]:
        given = dict(zip(names, (*q, *parameters), strict=True))
        generators = [given.get(name, arb(0)) for name in ring.variables]
        for atom in ring.basis.atoms:
            angle = arb(0)
            for base, factor in atom:
                assert isinstance(base, Name)
                angle += arb(fmpq(factor.numerator, factor.denominator)) * given[base.name]
            generators += [angle.sin(), angle.cos()]
        total = arb(0)
        for coefficient, monomial in terms:
            term = arb(coefficient)
            for exponent, generator in zip(monomial, generators, strict=False):
                if exponent:
                    term *= generator**exponent
            total += term
        return [total]

    return values


def _numeric(reference: Reference) -> list[Trouble]:
    """The determinants of the coordinate partitions as they are: all row choices of one partition together."""
    system, rank = reference.system, reference.ranks.constraints
    if not rank or comb(system.n, rank) * comb(system.r, rank) > MOST_DETERMINANTS:
        return []
    troubles = []
    for independent in combinations(range(system.n), system.n - rank):
        dependent = [j for j in range(system.n) if j not in independent]
        names = ", ".join(system.model.coordinates[j].name for j in independent)
        values = _minors_of_rows(reference, dependent)
        troubles.append(Trouble(f"determinant of the partition ({names})", values, (independent,)))
    return troubles


def _minors_of_rows(reference: Reference, columns: Sequence[int]) -> Values:
    rank = reference.ranks.constraints

    def values(q: Sequence[Any], parameters: Sequence[Any]) -> list[Any]:
        constraints, _ = reference.system.matrices(q, parameters, reference.literals())
        return _minors(constraints.tolist(), rank, [columns])

    return values


def joint_troubles(reference: Reference) -> tuple[tuple[str, Trouble], ...]:
    """Without factors: where the rank of B drops, and where the degree of actuation does, all minors vanish at once."""
    system, ranks = reference.system, reference.ranks
    troubles: list[tuple[str, Trouble]] = []
    if ranks.constraints and comb(system.n, ranks.constraints) * comb(system.r, ranks.constraints) <= MOST_DETERMINANTS:
        troubles.append(("constraint", Trouble("all minors of B", _all_minors(reference, False))))
    size = ranks.constraints + ranks.actuation
    if ranks.actuation and comb(system.n, size) * comb(system.r + system.m, size) <= MOST_DETERMINANTS:
        troubles.append(("input", Trouble("all minors of [Bᵀ, M]", _all_minors(reference, True))))
    return tuple(troubles)


def _all_minors(reference: Reference, with_inputs: bool) -> Values:
    ranks = reference.ranks
    size = ranks.constraints + (ranks.actuation if with_inputs else 0)

    def values(q: Sequence[Any], parameters: Sequence[Any]) -> list[Any]:
        constraints, control = reference.system.matrices(q, parameters, reference.literals())
        rows = constraints.tolist() + (control.transpose().tolist() if with_inputs else [])
        return _minors(rows, size, list(combinations(range(reference.system.n), size)))

    return values


def _minors(rows: list[list[Any]], size: int, columns: Sequence[Sequence[int]]) -> list[Any]:
    """The determinants of all choices of rows with each of these choices of columns."""
    return [
        determinant(arb_mat(size, size, [row[j] for row in chosen for j in places]))
        for chosen in combinations(rows, size)
        for places in columns
    ]
