"""u in closed form where redundant inputs are allocated: weighted minors, internal force, limits, in named parts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from sympy import Expr, ImmutableDenseMatrix, Integer, Max, Min, Mul, Pow, Symbol, sign, sqrt

from symgen.closedform.algebra.limits import TooLargeError
from symgen.closedform.algebra.matrices import determinant
from symgen.closedform.algebra.minors import left_inverse_terms, permutation_sign
from symgen.closedform.algebra.quotient import polynomial
from symgen.closedform.exact import Exact
from symgen.closedform.spelling import Speller
from symgen.closedform.structured import (
    LONGEST_LOAD,
    MOST_NAMED_MINORS,
    NamedMatrix,
    Naming,
    label,
    name_minors,
)
from symgen.model.model import Allocation

Named = list[tuple[Symbol, Expr]]


def structured_allocation(exact: Exact, speller: Speller, taken: frozenset[str], allocation: Allocation) -> NamedMatrix:
    """u (m x 1): weighted Cramer sums over the minors Delta_J, then the share of the internal force.

    For full actuation.  Raises TooLargeError where there is too much to list.
    """
    names = [item.name for item in exact.model.inputs]
    naming = Naming(speller, taken)
    name_minors(exact, naming)
    forces = _forces(exact, speller, naming, _by_input(names, allocation.preferred, Integer(0)))
    weights = _by_input(names, allocation.weights, Integer(1))
    least, total, squares = _least(exact, naming, weights, [symbol for symbol, _ in forces])
    preferred = _by_input(names, allocation.preferred, Integer(0))
    inputs = [p + u for p, u in zip(preferred, least, strict=True)]
    parts: Named = [(total, squares)]
    if allocation.directed:
        inputs = _directed(exact, naming, allocation, inputs, total, parts)
    used = set().union(*(e.free_symbols for e in inputs), *(meaning.free_symbols for _, meaning in parts))
    first = [(symbol, speller.polynomial(value)) for symbol, value in naming.elements.items() if symbol in used]
    if len(first) > MOST_NAMED_MINORS:
        raise TooLargeError(f"{len(first)} minors")
    loads = [(symbol, meaning) for symbol, meaning in forces if symbol in used]
    return NamedMatrix(ImmutableDenseMatrix(inputs), (*loads, *first, *parts))


def _by_input(names: Sequence[str], given: Sequence[tuple[str, str]], absent: Expr) -> list[Expr]:
    chosen = {name: Symbol(parameter) for name, parameter in given}
    return [chosen.get(name, absent) for name in names]


def _forces(exact: Exact, speller: Speller, naming: Naming, preferred: Sequence[Expr]) -> Named:
    """tau, or what the preferred inputs leave of it, entry by entry."""
    if sum(len(entry.numerator) for (entry,) in exact.load) > LONGEST_LOAD:
        raise TooLargeError("tau is too long")
    named: Named = []
    for i, ((entry,), row) in enumerate(zip(exact.load, exact.mechanics.control, strict=True)):
        supplied = sum((speller.quotient(m) * p for m, p in zip(row, preferred, strict=True)), Integer(0))
        named.append((naming.symbol(f"tau_{i + 1}"), speller.quotient(entry) - supplied))
    return named


def _least(
    exact: Exact, naming: Naming, weights: Sequence[Expr], forces: Sequence[Symbol]
) -> tuple[list[Expr], Symbol, Expr]:
    """The inputs of least weighted norm, the symbol of their denominator and what it stands for."""
    scale = naming.speller.polynomial(exact.control_scale)
    total = naming.symbol("Sigma_Delta")
    squares: Expr = Integer(0)
    numerators: list[Expr] = [Integer(0)] * exact.model.m
    choices = len(exact.actuations)
    for i, actuation in enumerate(exact.actuations):
        deltas = {j: naming.name(value, label("Delta", j, i, choices)) for j, value in actuation.determinants.items()}
        outside = {j: Mul(*(w for k, w in enumerate(weights) if k not in j)) for j in deltas}
        works = {
            rest: sum(
                (naming.name(e, label("v", (*rest, a), i, choices)) * forces[a] for a, e in enumerate(vector)),
                Integer(0),
            )
            for rest, vector in actuation.vectors.items()
        }
        squares += sum((outside[j] * delta**2 for j, delta in deltas.items()), Integer(0))
        for k in range(exact.model.m):
            for sign_, j, rest in left_inverse_terms(actuation, k):
                numerators[k] += sign_ * outside[j] * deltas[j] * works[rest]
    return [scale * numerator / total for numerator in numerators], total, squares


def _directed(
    exact: Exact, naming: Naming, allocation: Allocation, inputs: Sequence[Expr], total: Symbol, parts: Named
) -> list[Expr]:
    """The inputs with their share c of the internal force z; adds the names of u_0, z and c to `parts`."""
    names = [item.name for item in exact.model.inputs]
    (actuation,) = exact.actuations
    orientation = _orientation(exact, naming.speller)
    start, direction = [], []
    for k in range(exact.model.m):
        (others,) = (subset for subset in actuation.determinants if k not in subset)
        minor = naming.name(actuation.determinants[others], label("Delta", others, 0, 1))
        u, z = naming.symbol(f"u0_{k + 1}"), naming.symbol(f"z_{k + 1}")
        parts += [(u, inputs[k]), (z, (-1) ** k * orientation * minor / sqrt(total))]
        start.append(u)
        direction.append(z if minor != 0 else Integer(0))
    share: Expr = Integer(0) if allocation.preload is None else Symbol(allocation.preload)
    ends = []
    for limit in allocation.limits:
        k = names.index(limit.input)
        if direction[k] != 0:
            ends.append([(Symbol(bound) - start[k]) / direction[k] for bound in (limit.lower, limit.upper)])
    if ends:
        low, high, c = (naming.symbol(name) for name in ("c_low", "c_high", "c"))
        parts.append((low, Max(*(Min(*pair) for pair in ends))))
        parts.append((high, Min(*(Max(*pair) for pair in ends))))
        parts.append((c, Max(Min(low, high), Min(Max(low, high), share))))
        share = c
    return [u + share * z for u, z in zip(start, direction, strict=True)]


def _orientation(exact: Exact, speller: Speller) -> Expr:
    """The sign by which the minors without common factors and denominators differ from det[M_J, B^T]."""
    ring, jacobian = exact.ring, exact.mechanics.jacobian
    (minors,) = exact.minor_sets
    kept, value = next((s, v) for s, v in minors.values.items() if v)
    columns = [j for j in range(exact.model.n) if j not in kept]
    minor = determinant(ring, tuple(tuple(row[j] for j in columns) for row in jacobian))
    if permutation_sign((*kept, *columns)) < 0:
        minor = -minor
    ratio = speller.quotient(minor / polynomial(ring, value))
    ratio *= speller.polynomial(exact.control_scale) ** exact.delta
    positive = {p.name for p in exact.model.parameters if p.range is not None and p.range[0] > 0}
    return Mul(*_signs(Mul.make_args(ratio), positive))


def _signs(factors: Iterable[Expr], positive: set[str]) -> Iterable[Expr]:
    for factor in factors:
        base, exponent = factor.as_base_exp()
        if factor.is_number:
            yield sign(factor)
        elif not (isinstance(base, Symbol) and base.name in positive) and exponent % 2:
            yield sign(Pow(base, 1))
