"""B by the chain rule, where its entries are long: constraints are short functions of places that have names."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from sympy import ImmutableDenseMatrix, Symbol

from symgen.closedform.exact import Exact
from symgen.closedform.laws.terms import DerivedFactor, ListedFactor, MatrixLaw, product
from symgen.closedform.spelling import spell_expression
from symgen.model.expressions.derivative import derivative
from symgen.model.expressions.expression import Expression, Name, Number
from symgen.model.expressions.walk import names_in

JACOBIAN = "constraint_jacobian"


def law_by_chain_rule(exact: Exact) -> tuple[MatrixLaw, ...]:
    """B = K J with K = dg/ds and J = ds/dq, s the names that geometric constraints are written in.

    Nothing where these are coordinates alone, or constraints are not geometric.
    """
    rows = [row.expression for row in exact.model.constraints if row.kind == "geometric"]
    written = list(dict.fromkeys(name.name for row in rows for name in names_in(row)))
    names = [name for name in written if _moves(exact, name)]
    if len(rows) < exact.model.r or {c.name for c in exact.model.coordinates}.issuperset(names):
        return ()
    symbols = [Symbol(name) for name in names]
    outer = [[spell_expression(derivative(row, _slope_of(name))) for name in names] for row in rows]
    factors = (
        ListedFactor("s", ImmutableDenseMatrix([[symbol] for symbol in symbols])),
        ListedFactor("K", ImmutableDenseMatrix(outer)),
        DerivedFactor("J", "s"),
    )
    return (MatrixLaw(JACOBIAN, "chain", product("K", "J"), factors),)


def _slope_of(name: str) -> Callable[[str], Expression]:
    """The derivatives of names by one of them."""
    return lambda other: Number(Fraction(int(other == name)))


def _moves(exact: Exact, name: str) -> bool:
    """Whether a named value depends on the configuration."""
    translator = exact.mechanics.translator
    value = translator.value(Name(name))
    return any(translator.derivative(value, c.name) for c in exact.model.coordinates)
