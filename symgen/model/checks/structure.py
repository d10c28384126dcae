"""Whether energies and constraints have the form the theory needs: T quadratic, constraints linear in the rates."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from symgen.diagnostics import Mistake
from symgen.model.configurations.algebra import BEYOND, Monomial, NotPolynomialError, Polynomial, is_zero
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.expressions.expression import Binary, Expression, Negation
from symgen.model.model import ConstraintRow


def check_kinetic_energy(mechanics: NumericSystem, kinetic: Expression) -> Iterator[Mistake]:
    """T must be a quadratic form in the rates."""
    remedy = "write T as a sum of products of two rates with coefficients of coordinates and parameters"
    mistakes = list(_check_degree(mechanics, kinetic, 2, "the kinetic energy is not quadratic in the rates", remedy))
    yield from mistakes
    if not mistakes and _is_zero(mechanics.polynomials(kinetic)):
        yield Mistake("the kinetic energy is zero", "write the kinetic energy of the masses", kinetic.span)


def check_nonholonomic(mechanics: NumericSystem, row: ConstraintRow) -> Iterator[Mistake]:
    """A row must be linear and homogeneous in the rates."""
    message = f"the constraint `{row.name}` is not linear in the rates"
    remedy = (
        "write a sum of rates with coefficients of coordinates and parameters, = 0; g(q) = 0 belongs to `geometric`"
    )
    yield from _check_degree(mechanics, row.expression, 1, message, remedy)


def check_domain(mechanics: NumericSystem, expression: Expression, what: str) -> Iterator[Mistake]:
    """The expression must have a value somewhere in the ranges of coordinates and parameters."""
    try:
        exists = bool(mechanics.polynomials(expression))
    except NotPolynomialError:
        return
    if not exists:
        yield Mistake(
            f"{what} has no finite value at any sampled configuration",
            "check divisions, roots and logarithms, and give `range`s in which it exists",
            expression.span,
        )


def _check_degree(
    mechanics: NumericSystem, expression: Expression, degree: int, message: str, remedy: str
) -> Iterator[Mistake]:
    try:
        whole = _wrong_term(mechanics, expression, degree)
        if whole is None:
            return
        # Point at the first summand at fault, unless only the whole sum is.
        for summand in _summands(expression):
            wrong = _wrong_term(mechanics, summand, degree)
            if wrong is not None:
                yield Mistake(f"{message}: it has {_shown(wrong)}", remedy, summand.span)
                return
        yield Mistake(f"{message}: it has {_shown(whole)}", remedy, expression.span)
    except NotPolynomialError as error:
        yield Mistake(f"{message}: it {error.what}", remedy, error.span)


def _wrong_term(mechanics: NumericSystem, expression: Expression, degree: int) -> Monomial | None:
    monomials = (_wrong_monomial(polynomial, degree) for polynomial in mechanics.polynomials(expression))
    return next((monomial for monomial in monomials if monomial is not None), None)


def _wrong_monomial(polynomial: Polynomial, degree: int) -> Monomial | None:
    wrong = (m for m, coefficient in polynomial.items() if len(m) != degree and not is_zero(coefficient))
    return min(wrong, key=lambda m: (len(m), m), default=None)


def _shown(monomial: Monomial) -> str:
    if monomial == BEYOND:
        return "a term of fourth or higher degree in the rates"
    return f"a term with {'*'.join(monomial)}" if monomial else "a term without rates"


def _summands(expression: Expression) -> Iterable[Expression]:
    match expression:
        case Binary(operator="+" | "-", left=left, right=right):
            yield from _summands(left)
            yield from _summands(right)
        case Negation(operand=operand):
            yield from _summands(operand)
        case _:
            yield expression


def _is_zero(polynomials: Iterable[Polynomial]) -> bool:
    return all(is_zero(coefficient) for polynomial in polynomials for coefficient in polynomial.values())
