"""Structured closed forms: N_B, the pseudoinverse of N_B M and u in terms of named minors, where they are long."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations

from sympy import Add, Expr, ImmutableDenseMatrix, Integer, Mul, Symbol, preorder_traversal
from sympy.polys.rings import PolyElement

from symgen.closedform.algebra.limits import TooLargeError
from symgen.closedform.algebra.matrices import dot
from symgen.closedform.algebra.minors import left_inverse_terms, permutation_sign
from symgen.closedform.exact import Exact
from symgen.closedform.spelling import Speller

LONGEST_LOAD = 600
"""A load tau with more terms than this is not listed."""

LONGEST_SQUARES = 600
"""Entries of B B^T with more terms than this together are not listed."""

MOST_PRODUCTS = 20 * LONGEST_SQUARES
"""More products of terms than this are not formed to see how many terms they leave."""

MOST_NAMED_MINORS = 30
"""More named minors than this are not listed."""

LONGEST_MINORS = 10_000
"""Minors of more symbols, numbers and operations are not listed: some ten pages, which take a gigabyte beyond that."""


@dataclass(slots=True)
class Naming:
    """Names for ring elements: equal or opposite elements share one symbol; what is used is spelled at the end."""

    speller: Speller
    taken: frozenset[str]
    elements: dict[Symbol, PolyElement] = field(default_factory=dict)
    known: dict[PolyElement, Expr] = field(default_factory=dict)

    def symbol(self, name: str) -> Symbol:
        """A symbol no coordinate, parameter or input of the model uses."""
        while name in self.taken:
            name += "_"
        return Symbol(name)

    def name(self, value: PolyElement, name: str) -> Expr:
        """The symbol for a ring element with a sign, or the element itself when it is a monomial."""
        if len(value) <= 1:
            return self.speller.polynomial(value)
        # one of the two signs is looked up: rational numbers are slow to hash
        upright = value if value.LC > 0 else -value
        known = self.known.get(upright)
        if known is None:
            symbol = self.symbol(name)
            self.elements[symbol] = value
            known = self.known[upright] = symbol if upright is value else -symbol
        return known if upright is value else -known


@dataclass(frozen=True, slots=True)
class NamedMatrix:
    """A matrix in named intermediates, listed in order of use."""

    matrix: ImmutableDenseMatrix
    intermediates: tuple[tuple[Symbol, Expr], ...]


def label(kind: str, indices: Sequence[int], choice: int, choices: int) -> str:
    """Phi_1_3 and the like; a prefix tells choices of rows apart."""
    name = "_".join([kind, *(str(i + 1) for i in indices)])
    return name if choices == 1 else f"{name}_rows{choice + 1}"


def name_minors(exact: Exact, naming: Naming) -> list[Mapping[tuple[int, ...], Expr]]:
    """A symbol (or a monomial) for every minor Phi_J."""
    sets = exact.minor_sets
    return [
        {subset: naming.name(value, label("Phi", subset, i, len(sets))) for subset, value in minors.values.items()}
        for i, minors in enumerate(sets)
    ]


def structured_projector(exact: Exact, speller: Speller, taken: frozenset[str]) -> NamedMatrix:
    """N_B = sum_K Phi_K Phi_K^T / Sigma_Phi with every Phi_J as a product of its factors.

    Raises TooLargeError when there are too many minors to list.
    """
    count = sum(len(minors.values) for minors in exact.minor_sets)
    if count > MOST_NAMED_MINORS:
        raise TooLargeError(f"{count} minors")
    naming = Naming(speller, taken)
    phis = name_minors(exact, naming)
    total = naming.symbol("Sigma_Phi")
    meaning = sum((e**2 for phi in phis for e in phi.values()), Integer(0))
    size = range(exact.model.n)
    rest = list(combinations(size, exact.delta - 1))

    def signed(phi: Mapping[tuple[int, ...], Expr], indices: tuple[int, ...]) -> Expr:
        if len(set(indices)) < len(indices):
            return Integer(0)
        return phi[tuple(sorted(indices))] * permutation_sign(indices)

    upper = {
        (i, j): sum((signed(phi, (i, *k)) * signed(phi, (j, *k)) for phi in phis for k in rest), Integer(0)) / total
        for i in size
        for j in size[i:]
    }
    entries = [[upper[min(i, j), max(i, j)] for j in size] for i in size]
    return _finish(entries, naming, [(total, meaning)])


def structured_control_pseudoinverse(exact: Exact, speller: Speller, taken: frozenset[str]) -> NamedMatrix:
    """M~^+ = sum_J Delta_J v_L / Sigma_Delta, L = J without the input of the row; Delta_J as products of factors.

    A single Delta_J is cancelled: v_L / Delta_J.
    """
    naming = Naming(speller, taken)
    name_minors(exact, naming)
    scale = speller.polynomial(exact.control_scale)
    total = naming.symbol("Sigma_Delta")
    squares: Expr = Integer(0)
    entries = [[Integer(0) for _ in range(exact.model.n)] for _ in range(exact.model.m)]
    choices = len(exact.actuations)
    for i, actuation in enumerate(exact.actuations):
        deltas = {j: naming.name(value, label("Delta", j, i, choices)) for j, value in actuation.determinants.items()}
        vectors = {
            rest: [naming.name(e, label("v", (*rest, a), i, choices)) for a, e in enumerate(vector)]
            for rest, vector in actuation.vectors.items()
        }
        squares += sum((e**2 for e in deltas.values()), Integer(0))
        for k in range(exact.model.m):
            for sign, j, rest in left_inverse_terms(actuation, k):
                for a in range(exact.model.n):
                    entries[k][a] += sign * deltas[j] * vectors[rest][a]
    if squares.is_Pow:
        return _finish([[scale * e / squares for e in row] for row in entries], naming, [])
    entries = [[scale * e / total for e in row] for row in entries]
    return _finish(entries, naming, [(total, squares)])


def structured_projected_control(exact: Exact, speller: Speller, projector: NamedMatrix) -> NamedMatrix:
    """N_B M with N_B in named minors."""
    control = [[speller.quotient(e) for e in row] for row in exact.mechanics.control]
    return NamedMatrix(_product(projector.matrix, control), projector.intermediates)


def structured_inverse_dynamics(
    exact: Exact, speller: Speller, left: NamedMatrix, taken: frozenset[str]
) -> NamedMatrix:
    """u = M~^+ tau with the load tau = G qdd + C qd + Q - Q_a as named intermediates."""
    naming = Naming(speller, taken)
    symbols = [naming.symbol(f"tau_{i + 1}") for i in range(exact.model.n)]
    load = [[symbol if entry else Integer(0)] for symbol, (entry,) in zip(symbols, exact.load, strict=True)]
    matrix = _product(left.matrix, load).applyfunc(_over_common_denominator)
    used = matrix.free_symbols
    terms = sum(len(e.numerator) for symbol, (e,) in zip(symbols, exact.load, strict=True) if symbol in used)
    if terms > LONGEST_LOAD:
        raise TooLargeError(f"tau has {terms} terms")
    named = tuple(
        (symbol, speller.quotient(entry))
        for symbol, (entry,) in zip(symbols, exact.load, strict=True)
        if entry and symbol in used
    )
    return NamedMatrix(matrix, (*named, *left.intermediates))


def structured_pseudoinverse(exact: Exact, speller: Speller, taken: frozenset[str]) -> tuple[tuple[Symbol, Expr], ...]:
    """The entries of S = B B^T by name, for B^+ = B^T S^{-1}; none where they are too long to be read."""
    jacobian = exact.mechanics.jacobian
    naming = Naming(speller, taken)
    size = range(len(jacobian))
    lengths = [[len(entry.numerator) for entry in row] for row in jacobian]
    if sum(a * b for i in size for j in size[i:] for a, b in zip(lengths[i], lengths[j], strict=True)) > MOST_PRODUCTS:
        return ()
    try:
        with exact.ring.work.limited("B B^T"):
            entries = {(i, j): dot(exact.ring, jacobian[i], jacobian[j]) for i in size for j in size[i:]}
            if sum(len(entry.numerator) for entry in entries.values()) > LONGEST_SQUARES:
                return ()
            return tuple(
                (naming.symbol(f"S_{i + 1}_{j + 1}"), speller.quotient(entry)) for (i, j), entry in entries.items()
            )
    except TooLargeError:
        return ()


def _product(left: ImmutableDenseMatrix, right: Sequence[Sequence[Expr]]) -> ImmutableDenseMatrix:
    """left * right; SymPy would ask whether what it multiplies by zero is finite."""
    columns = [[(k, entry) for k, entry in enumerate(column) if entry] for column in zip(*right, strict=True)]
    return ImmutableDenseMatrix(
        [[Add(*(row[k] * entry for k, entry in column)) for column in columns] for row in left.tolist()]
    )


def _over_common_denominator(entry: Expr) -> Expr:
    """A sum whose terms all have the same names in their denominators, as one fraction."""
    terms = Add.make_args(entry)
    shared = set.intersection(*(_names_below(term) for term in terms))
    divisor = Mul(*sorted(shared, key=str))
    return Add(*(term * divisor for term in terms)) / divisor if len(terms) > 1 else entry


def _names_below(term: Expr) -> set[Expr]:
    """The names that a product is divided by once."""
    powers = (factor for factor in Mul.make_args(term) if factor.is_Pow and factor.exp == -1)
    return {power.base for power in powers if power.base.is_Symbol}


def _finish(entries: Sequence[Sequence[Expr]], naming: Naming, sums: Iterable[tuple[Symbol, Expr]]) -> NamedMatrix:
    """Keep the intermediates that the matrix and the sums use."""
    matrix = ImmutableDenseMatrix(entries)
    last = tuple(sums)
    used = set(matrix.free_symbols).union(*(meaning.free_symbols for _, meaning in last))
    first = [(symbol, value) for symbol, value in naming.elements.items() if symbol in used]
    if len(first) > MOST_NAMED_MINORS:
        raise TooLargeError(f"{len(first)} minors")
    named = [(symbol, naming.speller.polynomial(value)) for symbol, value in first]
    length = sum(1 for _, meaning in named for _ in preorder_traversal(meaning))
    if length > LONGEST_MINORS:
        raise TooLargeError(f"minors with {length} symbols and operations")
    return NamedMatrix(matrix, (*named, *last))
