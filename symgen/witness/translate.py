"""Expression tree to CasADi: one node at a time, names looked up in a scope."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import pi

import casadi

from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.model import Definition, Model


def translate(expression: Expression, scope: Mapping[str, casadi.SX]) -> casadi.SX:
    """The expression over the scope's values (SX or DM); a KeyError for a name the scope lacks is our own bug."""
    match expression:
        case Number(value=value):
            return casadi.SX(float(value))
        case Pi():
            return casadi.SX(pi)
        case Name(name=name):
            return scope[name]
        case Negation(operand=operand):
            return -translate(operand, scope)
        case Binary(operator="+", left=left, right=right):
            return translate(left, scope) + translate(right, scope)
        case Binary(operator="-", left=left, right=right):
            return translate(left, scope) - translate(right, scope)
        case Binary(operator="*", left=left, right=right):
            return translate(left, scope) * translate(right, scope)
        case Binary(left=left, right=right):
            return translate(left, scope) / translate(right, scope)
        case Power(base=base, exponent=exponent):
            return power(translate(base, scope), exponent)
        case Call(function=function, arguments=arguments):
            result: casadi.SX = getattr(casadi, function)(*(translate(argument, scope) for argument in arguments))
            return result


def power(base: casadi.SX, exponent: Fraction) -> casadi.SX:
    """Square roots stay roots: CasADi differentiates `sqrt` better than a power with exponent 1/2."""
    if exponent.denominator == 2:
        return casadi.sqrt(base) ** exponent.numerator
    return base ** float(exponent)


def with_definitions(scope: Mapping[str, casadi.SX], definitions: tuple[Definition, ...]) -> dict[str, casadi.SX]:
    """The scope enlarged by definitions, in order of use; those that need a name the scope lacks are left out.

    A scope without rates is how the definitions of positions alone are picked.
    """
    enlarged = dict(scope)
    for definition in definitions:
        try:
            enlarged[definition.name] = translate(definition.value, enlarged)
        except KeyError:
            continue
    return enlarged


def default_parameters(model: Model) -> casadi.DM:
    """Default values of the parameters, a column in the order of the file."""
    values: dict[str, casadi.SX] = {}
    for parameter in model.parameters:
        values[parameter.name] = translate(parameter.value, values)
    return casadi.evalf(casadi.vertcat(casadi.SX(0, 1), *values.values()))
