"""What `symgen explain MODEL.yaml base_parameters` prints."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator
from fractions import Fraction

from symgen.model.combinations.base_parameters import BaseParameter, BaseParameters
from symgen.model.combinations.coefficient_forms import CoefficientForm, FormTerm
from symgen.model.inertial_parameters import InertialParameter

# Columns of a terminal that lines keep to.
LINE_WIDTH = 80
# Digits of values, and of coefficients without a closed form.
VALUE_DIGITS = 6
_RAISED = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


def base_parameters_text(made: BaseParameters) -> str:
    """The counts, each base parameter with its value, and what has no effect."""
    lines = [f"base parameters of {made.model.name}", *_wrapped(_counts(made)), ""]
    lines += ["first moments (m x) and inertias (I) are about the origin and in the axes of the"]
    lines += ["frame of a body; Ir is the inertia of a rotor", ""]
    for number, one in enumerate(made.base, 1):
        lines += _entry(number, one)
    if any(not form.terms for one in made.base for _, form in one.added):
        names = sorted({name for one in made.base for _, form in one.added for name in form.changed_by})
        why = f"depend on {', '.join(names)}" if names else "are those of this geometry alone"
        lines += ["", *_wrapped(f"numbers in brackets {why}; no short closed form was made")]
    if made.without_effect:
        lines += ["", *_wrapped(f"no effect on the inputs: {_grouped(made.without_effect)}")]
    return "\n".join(lines)


def _counts(made: BaseParameters) -> str:
    text = f"{len(made.base)} of {len(made.parameters)} inertial parameters can be told apart by any motion"
    if made.model.constraints:
        text += f"; without the constraints {made.as_tree} could"
    if made.elsewhere is None:
        text += "; with other lengths it does not close"
    elif made.elsewhere != len(made.base):
        text += f"; with other lengths {made.elsewhere} can: this geometry is special"
    return text


def _entry(number: int, one: BaseParameter) -> Iterator[str]:
    text = combination(one)
    value = f"{one.value:.{VALUE_DIGITS}g}"
    wrapped = textwrap.wrap(text, LINE_WIDTH - 20, break_long_words=False, subsequent_indent="    ")
    for k, line in enumerate(wrapped):
        head = f"{number:>4}  " if not k else "      "
        end = f"{value:>14}" if k == len(wrapped) - 1 else ""
        yield f"{head}{line.replace(_TIED, ' '):<{LINE_WIDTH - 20}}{end}".rstrip()


def combination(one: BaseParameter) -> str:
    """A base parameter as a sum; blanks inside its terms do not break."""
    return one.stays.name + "".join(_added(other, form) for other, form in one.added)


# What keeps a coefficient and its parameter in one line.
_TIED = "\u00a0"


def _added(parameter: InertialParameter, form: CoefficientForm) -> str:
    if not form.terms:
        sign, size = ("-", -form.value) if form.value < 0 else ("+", form.value)
        return f" {sign}{_TIED}[{size:.{VALUE_DIGITS}g}]{_TIED}{parameter.name}"
    if len(form.terms) == 1:
        sign, factor = _factor(form.terms[0])
        return f" {sign}{_TIED}{factor}{_TIED if factor else ''}{parameter.name}"
    texts = sorted((_factor(term) for term in form.terms), key=lambda text: text[0] == "-")
    inner = "".join(f"{_TIED}{sign}{_TIED}{factor or '1'}" for sign, factor in texts).lstrip(_TIED)
    return f" +{_TIED}({inner.removeprefix('+' + _TIED)}){_TIED}{parameter.name}"


def _factor(term: FormTerm) -> tuple[str, str]:
    """The sign, and a product with a quotient in brackets; nothing for 1."""
    given = abs(term.factor)
    size = given if term.is_recognized else Fraction(f"{float(given):.{VALUE_DIGITS}g}")
    above = [_number(Fraction(size.numerator))] if size.numerator != 1 else []
    below = [_number(Fraction(size.denominator))] if size.denominator != 1 else []
    if below and _is_decimal(size):
        above, below = [_number(size)], []
    above += [f"√{term.root}"] if term.root != 1 else []
    above += [_power(name, power) for name, power in term.powers if power > 0]
    below += [_power(name, -power) for name, power in term.powers if power < 0]
    numerator, denominator = _TIED.join(above), _TIED.join(below)
    if denominator:
        numerator = f"({numerator or '1'}/{f'({denominator})' if len(below) > 1 else denominator})"
    return "-" if term.factor < 0 else "+", numerator


def _is_decimal(value: Fraction) -> bool:
    return Fraction(f"{float(value):.{VALUE_DIGITS}g}") == value


def _number(value: Fraction) -> str:
    return f"{float(value):.{VALUE_DIGITS}g}" if _is_decimal(value) else str(value)


def _power(name: str, power: int) -> str:
    return name if power == 1 else f"{name}{str(power).translate(_RAISED)}"


def _grouped(parameters: Iterable[InertialParameter]) -> str:
    """Body by body."""
    by_owner: dict[str, list[str]] = {}
    for one in parameters:
        by_owner.setdefault(one.owner, []).append(one.element)
    return "; ".join(f"{owner} {' '.join(elements)}" for owner, elements in by_owner.items())


def _wrapped(text: str) -> list[str]:
    return textwrap.wrap(text, LINE_WIDTH - 1, break_long_words=False, subsequent_indent="  ")
