"""Which parameters are positive although no range says so: masses, lengths and moments of inertia are by their nature.

A parameter in kg, m or kg m² (any prefixes), or one that stands alone for a body's mass, a principal element of its
inertia or a rotor's inertia, is taken to be positive where its value is and no range is declared.  Products of inertia
are not: their sign is that of the axes.  Where the value is 0, a mass or a moment of inertia is not negative, and a
length may become anything.
"""

from __future__ import annotations

from symgen.diagnostics import Span
from symgen.model.configurations.mechanics import default_values
from symgen.model.expressions.expression import Expression, Name
from symgen.model.expressions.units import KILOGRAM, METRE, Unit, parse_unit
from symgen.model.expressions.walk import names_in
from symgen.model.file.source import ScalarNode
from symgen.model.mechanism import Mechanism
from symgen.model.model import Model, Parameter

_INERTIAL = (KILOGRAM, KILOGRAM.times(METRE).times(METRE))


def positive_parameters(model: Model) -> frozenset[str]:
    """The parameters that are positive: by their range, or by nature where none is declared."""
    values = default_values(model.parameters)
    own = _inertial(model)
    return frozenset(
        p.name
        for p in model.parameters
        if (p.range[0] > 0 if p.range is not None else values[p.name] > 0 and (p.name in own or _is_in(p, (METRE,))))
    )


def nonnegative_parameters(model: Model) -> frozenset[str]:
    """Masses and moments of inertia without a range, whose value may be 0."""
    values = default_values(model.parameters)
    own = _inertial(model)
    return frozenset(p.name for p in model.parameters if p.range is None and p.name in own and values[p.name] >= 0)


def _inertial(model: Model) -> frozenset[str]:
    """The parameters that are a mass or a moment of inertia, by unit or by use."""
    masses = {expression.name for expression in _masses(model.mechanism) if isinstance(expression, Name)}
    signed = {name.name for expression in _products(model.mechanism) for name in names_in(expression)}
    names = (p.name for p in model.parameters if p.name in masses or _is_in(p, _INERTIAL))
    return frozenset(name for name in names if name not in signed)


def _is_in(parameter: Parameter, units: tuple[Unit, ...]) -> bool:
    """Whether the unit is one of these but for its prefix."""
    text = (parameter.unit or "").strip()
    unit = parse_unit(ScalarNode(text, Span(0, 0, 0), text, False)) if text else None
    return isinstance(unit, Unit) and any(unit.exponents == usual.exponents for usual in units)


def _masses(mechanism: Mechanism) -> list[Expression]:
    bodies = [x for body in mechanism.bodies for x in (body.mass, body.inertia.xx, body.inertia.yy, body.inertia.zz)]
    return [*bodies, *(rotor.inertia for rotor in mechanism.rotor_inertias)]


def _products(mechanism: Mechanism) -> list[Expression]:
    return [x for body in mechanism.bodies for x in (body.inertia.xy, body.inertia.xz, body.inertia.yz)]
