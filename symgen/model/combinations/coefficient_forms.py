"""Coefficients as closed forms in the geometry: seen at other values of its parameters, checked in balls.

A coefficient that every length scales by a whole power is a product; else a polynomial of degree two in the parameters
that change it is looked for, which may be over one of them.  What is neither stays a number.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations_with_replacement
from math import floor, log10
from typing import TypeAlias

from flint import arb, arb_mat

from symgen.model.combinations.taylor_balls import Ball, WideBallError, ball, may_vanish, wide

# Powers of one parameter that are looked at.
COMPARED_POWERS = (0, 1, -1, 2, -2, 3, -3)
# Denominators of numbers that are printed as they are.
MOST_DENOMINATOR = 10**6
# Parameters of a polynomial at most.
MOST_VARIABLES = 4
# Decimal digits of a factor that is no short fraction: more than the reference has.
FACTOR_DIGITS = 70

Powers: TypeAlias = tuple[tuple[str, int], ...]
"""Parameters with their powers."""


@dataclass(frozen=True, slots=True)
class FormTerm:
    """factor * sqrt(root) * parameters to their powers; a factor that was not recognized as a fraction is rounded."""

    factor: Fraction
    root: int
    powers: Powers
    is_recognized: bool = True


@dataclass(frozen=True, slots=True)
class CoefficientForm:
    """A sum of terms; none where no form was found, and then the parameters that change the value."""

    value: float
    terms: tuple[FormTerm, ...]
    changed_by: tuple[str, ...] = ()


@dataclass(frozen=True)
class CoefficientSample:
    """Values of parameters, and one coefficient there."""

    given: Mapping[str, Fraction]
    value: Ball


def product_form(here: CoefficientSample, scaled: Mapping[str, CoefficientSample]) -> CoefficientForm | None:
    """The product that it is; `scaled` holds samples with one parameter changed each."""
    powers = []
    for name, other in scaled.items():
        power = _power(here, other, name)
        if power is None:
            return None
        if power:
            powers.append((name, power))
    rest = here.value
    for name, power in powers:
        rest /= ball(here.given[name]) ** power
    return CoefficientForm(float(here.value.mid()), (_term(rest, tuple(powers)),))


def changing(here: CoefficientSample, scaled: Mapping[str, CoefficientSample]) -> tuple[str, ...]:
    """The parameters that change the coefficient."""
    return tuple(name for name, other in scaled.items() if not may_vanish(other.value - here.value))


def form_value(form: CoefficientForm, given: Mapping[str, Fraction]) -> Ball:
    """A form that has terms, for values of the parameters."""
    terms = (_factor(one) * arb(one.root).sqrt() * _evaluated(one.powers, given) for one in form.terms)
    return sum(terms, arb(0))


def _factor(term: FormTerm) -> Ball:
    """A factor, with what was rounded of it."""
    exact = ball(term.factor)
    return exact if term.is_recognized else exact + exact * arb(0, 10.0**-FACTOR_DIGITS)


def samples_needed(variables: int) -> int:
    """For a polynomial in so many parameters, and one to check it at."""
    return (variables + 1) * (variables + 2) // 2 + 1


def quotient_form(
    here: CoefficientSample, names: Sequence[str], samples: Sequence[CoefficientSample]
) -> CoefficientForm | None:
    """The polynomial of degree two that it is, over one of the parameters or 1; all are changed in the samples."""
    for below in ("", *names):
        factors = _polynomial(here, names, samples, below)
        if factors is not None:
            terms = tuple(_term(factor, powers) for factor, powers in factors)
            return CoefficientForm(float(here.value.mid()), terms)
    return None


def _polynomial(
    here: CoefficientSample, names: Sequence[str], samples: Sequence[CoefficientSample], below: str
) -> list[tuple[Ball, Powers]] | None:
    """Factors and powers, found at some of the samples and seen to hold at the others."""
    monomials = [_divided(monomial, below) for monomial in _monomials(names)]
    count = len(monomials)
    rows = [[_evaluated(monomial, one.given) for monomial in monomials] for one in samples[:count]]
    if len(samples) <= count:
        return None
    try:
        solved = arb_mat(rows).solve(arb_mat([[one.value] for one in samples[:count]]))
    except ZeroDivisionError:
        return None
    kept = [(solved[k, 0], monomial) for k, monomial in enumerate(monomials) if not may_vanish(solved[k, 0])]
    for one in (*samples[count:], here):
        total = sum((factor * _evaluated(monomial, one.given) for factor, monomial in kept), arb(0))
        if not may_vanish(total - one.value):
            return None
    return kept


def _term(factor: Ball, powers: Powers) -> FormTerm:
    known = recognized(factor)
    return FormTerm(_rounded(factor), 1, powers, False) if known is None else FormTerm(*known, powers)


def _rounded(value: Ball) -> Fraction:
    """The middle of a ball to so many digits."""
    exact = Fraction(*_numerator_and_denominator(value))
    scale = Fraction(10) ** (FACTOR_DIGITS - floor(log10(abs(float(exact)))))
    return round(exact * scale) / scale


def recognized(value: Ball) -> tuple[Fraction, int] | None:
    """A number as a fraction times the square root of 1 or of a small whole number; None where it is neither."""
    for root in (1, 2, 3):
        number = _fraction(value / arb(root).sqrt())
        if number is not None:
            return number, root
    return None


def _fraction(value: Ball) -> Fraction | None:
    """The fraction with a small denominator in a ball; None where there is none."""
    if not value.rad() < wide():
        raise WideBallError
    nearest = Fraction(*_numerator_and_denominator(value)).limit_denominator(MOST_DENOMINATOR)
    return nearest if may_vanish(value - ball(nearest)) else None


def _numerator_and_denominator(value: Ball) -> tuple[int, int]:
    mantissa, exponent = (int(x) for x in value.mid().man_exp())
    return (mantissa << exponent, 1) if exponent >= 0 else (mantissa, 1 << -exponent)


def _power(here: CoefficientSample, other: CoefficientSample, name: str) -> int | None:
    factor = ball(other.given[name] / here.given[name])
    return next((power for power in COMPARED_POWERS if may_vanish(other.value - here.value * factor**power)), None)


def _monomials(names: Sequence[str]) -> Iterator[Powers]:
    for degree in range(3):
        for chosen in combinations_with_replacement(names, degree):
            yield tuple((name, chosen.count(name)) for name in dict.fromkeys(chosen))


def _divided(monomial: Powers, below: str) -> Powers:
    powers = dict(monomial)
    if below:
        powers[below] = powers.get(below, 0) - 1
    return tuple((name, power) for name, power in powers.items() if power)


def _evaluated(monomial: Powers, given: Mapping[str, Fraction]) -> Ball:
    value = arb(1)
    for name, power in monomial:
        value *= ball(given[name]) ** power
    return value
