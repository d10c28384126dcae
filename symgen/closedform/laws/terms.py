"""Laws of matrices as data: what a report prints and what tests evaluate is one tree, over matrices known by name."""

from __future__ import annotations

from typing import Literal, TypeAlias

from sympy import Expr, ImmutableDenseMatrix, Symbol

from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class LawMatrix:
    """A matrix by its name, such as B, or B_p for the columns p of B."""

    name: str


@dataclass(frozen=True, slots=True)
class LawUnit:
    """The unit matrix, of whatever size stands beside it."""


@dataclass(frozen=True, slots=True)
class LawTransposed:
    """The transpose of what is inside."""

    inside: LawTerm


@dataclass(frozen=True, slots=True)
class LawInverse:
    """The inverse of a square matrix."""

    inside: LawTerm


@dataclass(frozen=True, slots=True)
class LawProduct:
    """Factors from left to right."""

    factors: tuple[LawTerm, ...]


@dataclass(frozen=True, slots=True)
class LawDifference:
    """The first minus the second."""

    first: LawTerm
    second: LawTerm


@dataclass(frozen=True, slots=True)
class LawOpposite:
    """What is inside with its sign turned."""

    inside: LawTerm


@dataclass(frozen=True, slots=True)
class LawQuotient:
    """A matrix over a number by its name, which is among the intermediates of its law."""

    inside: LawTerm
    divisor: Symbol


LawTerm: TypeAlias = (
    LawMatrix | LawUnit | LawTransposed | LawInverse | LawProduct | LawDifference | LawOpposite | LawQuotient
)


@dataclass(frozen=True, slots=True)
class ListedFactor:
    """A matrix that is printed; its entries are expressions of the model, names of minors, or `entry_symbol`s of B.

    `term` is what it is in other matrices, where these stand in the report too.
    """

    name: str
    matrix: ImmutableDenseMatrix
    term: LawTerm | None = None


@dataclass(frozen=True, slots=True)
class DefinedFactor:
    """A matrix by a law of its own, such as S = B B^T."""

    name: str
    term: LawTerm


@dataclass(frozen=True, slots=True)
class PartFactor:
    """Rows of tau, columns of B, or rows of M that belong to some of the coordinates, by their places."""

    name: str
    whole: str
    places: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class IndependentRows:
    """Rows of B by their places, as many as its rank, which are independent at almost every configuration."""

    name: str
    places: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class DerivedFactor:
    """The derivatives of a listed column of named values by the coordinates, a row for each."""

    name: str
    column: str


LawFactor: TypeAlias = ListedFactor | DefinedFactor | PartFactor | IndependentRows | DerivedFactor


LawKind: TypeAlias = Literal["minors", "squares", "rows", "basis", "kernel", "driven", "chain"]


@dataclass(frozen=True, slots=True)
class MatrixLaw:
    """A quantity as a term in matrices that stand in the report and in `factors`, listed in order of use.

    Where `part` is not empty the term is not the whole of it but its columns of that index.  `intermediates` are the
    names in listed factors, and divisors.  It holds where the rank of B is generic and, for u, the inputs reach their
    generic number of directions, and where none of `divisors` (entries of B, by `entry_symbol`) vanishes.
    """

    quantity: str
    kind: LawKind
    term: LawTerm
    factors: tuple[LawFactor, ...] = ()
    intermediates: tuple[tuple[Symbol, Expr], ...] = ()
    divisors: tuple[Expr, ...] = ()
    part: str = ""


def product(*factors: LawTerm | str) -> LawProduct:
    """The product of terms and of matrices by name."""
    return LawProduct(tuple(LawMatrix(factor) if isinstance(factor, str) else factor for factor in factors))


def flipped(name: str) -> LawTransposed:
    """The transpose of a matrix by its name."""
    return LawTransposed(LawMatrix(name))


def entry_symbol(i: int, j: int) -> Symbol:
    """The entry of B in row i and column j, from 0; no name of a model has brackets."""
    return Symbol(f"B[{i + 1},{j + 1}]")
