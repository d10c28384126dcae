"""B^+, N_B and the pseudoinverse of N_B M as laws: by the matrix of minors, by B B^T, and by a short basis W."""

from __future__ import annotations

from sympy import Expr, ImmutableDenseMatrix, Integer, Symbol

from symgen.closedform.algebra.limits import TooLargeError
from symgen.closedform.algebra.minors import permutation_sign
from symgen.closedform.exact import Exact
from symgen.closedform.laws.bases import ShortBasis
from symgen.closedform.laws.known import KnownNames
from symgen.closedform.laws.terms import (
    DefinedFactor,
    IndependentRows,
    LawDifference,
    LawInverse,
    LawMatrix,
    LawQuotient,
    LawTerm,
    LawTransposed,
    LawUnit,
    ListedFactor,
    MatrixLaw,
    flipped,
    product,
)
from symgen.closedform.points import generic_points, rank
from symgen.closedform.structured import name_minors
from symgen.records import dataclass

OF_CONSTRAINTS = "constraint_pseudoinverse"
PROJECTOR = "nullspace_projector"
INVERSE = "projected_control_pseudoinverse"

MOST_MINOR_OPERATIONS = 1000
"""Minors of more operations together fill pages, and the projector is a law of B instead."""

WIDEST_MATRIX_OF_MINORS = 60
"""A matrix of minors with more operations in its entries, signs and products, is wider than a page."""


@dataclass(frozen=True, slots=True)
class NamedMinors:
    """Phi (n x 1 or n x n) of the names of minors, and what these stand for, the sum of their squares last."""

    matrix: ImmutableDenseMatrix
    meanings: tuple[tuple[Symbol, Expr], ...]
    total: Symbol


def named_minors(exact: Exact, known: KnownNames) -> NamedMinors | None:
    """The minors as a column (one degree of freedom) or a skew-symmetric matrix (two), where they can be read."""
    if exact.delta not in (1, 2) or not _single_set(exact):
        return None
    naming = known.naming()
    (names,) = name_minors(exact, naming)
    meanings = tuple((symbol, known.polynomial(symbol, value)) for symbol, value in naming.elements.items())
    if sum(int(meaning.count_ops()) for _, meaning in meanings) > MOST_MINOR_OPERATIONS:
        return None
    size = range(exact.model.n)

    def signed(*indices: int) -> Expr:
        value = names.get(tuple(sorted(indices)), Integer(0))
        return value if permutation_sign(indices) > 0 else -value

    rows = [[signed(i)] if exact.delta == 1 else [signed(i, j) if i != j else Integer(0) for j in size] for i in size]
    if sum(int(entry.count_ops()) for row in rows for entry in row) > WIDEST_MATRIX_OF_MINORS:
        return None
    squares = sum((value**2 for value in names.values()), Integer(0))
    total = naming.symbol("Sigma_Phi")
    return NamedMinors(ImmutableDenseMatrix(rows), (*meanings, (total, squares)), total)


def _single_set(exact: Exact) -> bool:
    """Whether the rows of B are independent and their minors not too long."""
    try:
        return len(exact.minor_sets) == 1
    except TooLargeError:
        return False


def laws_by_minors(exact: Exact, known: KnownNames, minors: NamedMinors) -> tuple[MatrixLaw, ...]:
    """N_B = Phi Phi^T / Sigma_Phi, and for two directions the pseudoinverse of N_B M."""
    square = LawQuotient(product("Phi", flipped("Phi")), minors.total)
    projector = MatrixLaw(PROJECTOR, "minors", square, (ListedFactor("Phi", minors.matrix),), minors.meanings)
    return (projector, *_pseudoinverse_by_minors(exact, known, minors))


def _pseudoinverse_by_minors(exact: Exact, known: KnownNames, minors: NamedMinors) -> tuple[MatrixLaw, ...]:
    """With Delta = M^T Phi M: Delta^-1 M^T Phi for two inputs, Delta^T M^T Phi over its squares for more of them.

    Phi is W J W^T for a basis W of two columns and J a turn by a right angle, up to a factor; then Delta^T M^T Phi is
    P^T adj(P P^T) W^T with P = W^T M.
    """
    control = [[known.speller.quotient(entry) for entry in row] for row in exact.mechanics.control]
    if exact.delta != 2 or not exact.full_actuation or not all(e.is_number for row in control for e in row):
        return ()
    chosen = ImmutableDenseMatrix(control)
    delta = ImmutableDenseMatrix(chosen.T * minors.matrix * chosen)
    factors = (ListedFactor("Phi", minors.matrix), ListedFactor("Delta", delta, product(flipped("M"), "Phi", "M")))
    through = (flipped("M"), LawMatrix("Phi"))
    meanings = minors.meanings[:-1]
    if exact.model.m == 2:
        return (MatrixLaw(INVERSE, "minors", product(LawInverse(LawMatrix("Delta")), *through), factors, meanings),)
    total = known.naming().symbol("Sigma_Delta")
    squares = sum((delta[i, j] ** 2 for j in range(exact.model.m) for i in range(j)), Integer(0))
    term = LawQuotient(product(flipped("Delta"), *through), total)
    return (MatrixLaw(INVERSE, "minors", term, factors, (*meanings, (total, squares))),)


def laws_by_squares(exact: Exact) -> tuple[MatrixLaw, ...]:
    """B^+ = B^T S^-1 and N_B = I - B^T S^-1 B with S = B B^T; of rows that depend on each other N_B by some of them."""
    if exact.structure.constraint_rank < exact.model.r:
        return _projector_by_rows(exact)
    squares = DefinedFactor("S", product("B", flipped("B")))
    left = product(flipped("B"), LawInverse(LawMatrix("S")))
    projector = LawDifference(LawUnit(), product(*left.factors, "B"))
    return (
        MatrixLaw(OF_CONSTRAINTS, "squares", left, (squares,)),
        MatrixLaw(PROJECTOR, "squares", projector, (squares,)),
    )


def _projector_by_rows(exact: Exact) -> tuple[MatrixLaw, ...]:
    """N_B = I - B_i^T S^-1 B_i with S = B_i B_i^T, for rows i that are independent where a generic point is."""
    points = generic_points(exact.model, exact.mechanics, 1)
    if not points:
        return ()
    jacobian = points[0].matrix(exact.mechanics.jacobian)
    chosen: list[int] = []
    for i in range(len(jacobian)):
        if rank([jacobian[k] for k in (*chosen, i)]) > len(chosen):
            chosen.append(i)
    factors = (IndependentRows("B_i", tuple(chosen)), DefinedFactor("S", product("B_i", flipped("B_i"))))
    held = product(flipped("B_i"), LawInverse(LawMatrix("S")), "B_i")
    return (MatrixLaw(PROJECTOR, "rows", LawDifference(LawUnit(), held), factors),)


def laws_by_basis(exact: Exact, basis: ShortBasis) -> tuple[MatrixLaw, ...]:
    """N_B = W (W^T W)^-1 W^T, and the pseudoinverse of N_B M by P = W^T M."""
    listed = ListedFactor("W", basis.matrix)
    inverse = LawInverse(product(flipped("W"), "W"))
    projector = product("W", inverse, flipped("W"))
    laws = [MatrixLaw(PROJECTOR, basis.kind, projector, (listed,), divisors=basis.divisors)]
    if exact.model.inputs and exact.full_actuation:
        seen = LawMatrix("P")
        left: tuple[LawTerm, ...] = (LawInverse(seen),)
        if exact.model.m > exact.delta:
            left = (LawTransposed(seen), LawInverse(product(seen, LawTransposed(seen))))
        factors = (listed, DefinedFactor("P", product(flipped("W"), "M")))
        laws.append(MatrixLaw(INVERSE, basis.kind, product(*left, flipped("W")), factors, divisors=basis.divisors))
    return tuple(laws)
