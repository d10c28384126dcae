"""Dimensions inferred through the expressions of a model: only contradictions in what the user wrote are mistakes.

Names without a unit are free and fit everywhere.  So are literals (0.25 may be a length), save those that are plainly
counts: 1/2, 1, 2, 4, and integers that something is divided by (`m/2*x_dot**2` has a unit).  Before a term that names
nothing but coordinates, or is a pure number beside it, every number is free, even 1 or 1/2: a mass, a stiffness, a
torque, the radius in `x - 2*cos(a)`.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TypeAlias

from symgen.diagnostics import Mistake, Span
from symgen.model.blocks.couplings import coupling_row
from symgen.model.blocks.elements import Fit
from symgen.model.checks.body_units import BodyUnits, body_units
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.expressions.units import METRE, NUMBER, SECOND, Unit, parse_unit
from symgen.model.expressions.walk import names_in
from symgen.model.file.reading import entries, member
from symgen.model.file.source import MappingNode, ScalarNode
from symgen.model.mechanism import is_component
from symgen.model.model import Allocation, Model

Dimension: TypeAlias = Unit | None
"""None where a dimension is free."""

_COUNTS = frozenset({Fraction(1), Fraction(2), Fraction(4), Fraction(1, 2)})
_SAME_UNIT = "use one unit for each kind of quantity, such as m throughout; nothing is converted"
_CHECK_TERMS = "check the terms, and the units declared for their names"


# coordinates that joints bring along have units without being declared
JOINT_UNITS = {"m": METRE, "rad": NUMBER}


def check_units(tree: MappingNode, model: Model, fits: tuple[Fit, ...]) -> list[Mistake]:
    """Units that are not read, and contradictions between those that are; `fits` come from springs and friction."""
    mistakes: list[Mistake] = []
    units = _declared(tree, mistakes)
    if not units and not mistakes:
        return []
    for own in model.coordinates:
        if own.name not in units and own.unit in JOINT_UNITS:
            units[own.name] = JOINT_UNITS[own.unit]
    bodies = body_units(model, units)
    inference = _Inference(model, units, mistakes, bodies)
    for parameter in model.parameters:
        what = f"the value of `{parameter.name}`"
        inference.agrees(parameter.value, units.get(parameter.name), what, "its unit")
    kinetic = inference.of_energy(model.kinetic_energy)
    potential = inference.of_energy(model.potential_energy)
    if kinetic is not None and potential is not None and kinetic != potential:
        mistakes.append(
            _clash("the potential energy", potential, "the kinetic energy", kinetic, model.potential_energy)
        )
    energy = kinetic if kinetic is not None else potential
    if model.mechanism.has_mass:
        if energy is not None and energy != bodies.energy:
            written = model.kinetic_energy if kinetic is not None else model.potential_energy
            mistakes.append(_clash("this energy", energy, "the energy of the bodies", bodies.energy, written))
        energy = bodies.energy
    for demand in bodies.demands(model.mechanism):
        inference.agrees(demand.expression, demand.unit, demand.what, demand.other)
    for rotor in model.mechanism.rotor_inertias:
        if energy is not None and rotor.coordinate in units:
            rate = units[rotor.coordinate].times(SECOND, -1)
            demanded = energy.times(rate.to_power(Fraction(2)), -1)
            inference.agrees(rotor.inertia, demanded, f"the rotor inertia of `{rotor.coordinate}`", "its energy")
    blocks = [member(tree.get("constraints"), kind) for kind in ("geometric", "nonholonomic")]
    rows = {key.value for block in blocks for key, _ in entries(block)}
    rows |= {coupling_row(key.value) for key, _ in entries(tree.get("coupling"))}
    for row in model.constraints:
        if row.name in rows:
            inference.of(row.expression)
        else:
            inference.of_made(row.expression, row.span)
    for x in model.task:
        inference.of(x.expression)
    forces = {c.name: energy.times(units[c.name], -1) for c in model.coordinates if energy and c.name in units}
    for force in model.applied_forces:
        what = f"the applied force on `{force.coordinate}`"
        needed = f"the generalized force of `{force.coordinate}`"
        inference.agrees(force.expression, forces.get(force.coordinate), what, needed)
    for column in model.inputs:
        for coordinate, coefficient in column.acts_on:
            force_unit, input_unit = forces.get(coordinate), units.get(column.name)
            coefficient_unit = inference.of(coefficient)
            if force_unit and input_unit and coefficient_unit and input_unit.times(coefficient_unit) != force_unit:
                what = f"the force of `{column.name}` on `{coordinate}`"
                needed = f"the generalized force of `{coordinate}`"
                clash = _clash(what, input_unit.times(coefficient_unit), needed, force_unit, coefficient)
                # `joint: a` has no coefficient of its own in the file
                mistakes.append(replace(clash, span=clash.span or column.span))
        if column.velocity is not None:
            pace, declared = inference.of(column.velocity), units.get(column.name)
            if energy and pace and declared and declared.times(pace) != energy.times(SECOND, -1):
                due = energy.times(SECOND, -1).times(pace, -1)
                clash = _clash(f"`{column.name}`", declared, "what acts there", due, column.velocity)
                mistakes.append(replace(clash, span=column.span))
    for element in model.forces:
        pace, size = inference.of(element.velocity), inference.of(element.magnitude)
        if energy and pace and size and size.times(pace) != energy.times(SECOND, -1):
            due = energy.times(SECOND, -1).times(pace, -1)
            clash = _clash(f"the force `{element.name}`", size, "what acts there", due, element.magnitude)
            mistakes.append(replace(clash, span=element.span))
    for fit in fits:
        measure = inference.of(fit.measure)
        if measure is not None and fit.power < 0:
            inference.agrees(fit.coefficient, measure, fit.what, "what it is compared with")
        elif measure is not None and energy is not None:
            work = energy.times(SECOND, -1) if fit.per_second else energy
            due = work.times(measure.to_power(Fraction(fit.power)), -1)
            inference.agrees(fit.coefficient, due, fit.what, "what fits there")
    if model.allocation is not None:
        _check_allocation(model, model.allocation, units, inference)
    return mistakes


def _check_allocation(model: Model, allocation: Allocation, units: dict[str, Unit], inference: _Inference) -> None:
    """Limits and preferred values have their input's unit; a preload that of every input by the root of its weight."""
    values = {parameter.name: parameter.value for parameter in model.parameters}
    for limit in allocation.limits:
        for name, end in ((limit.lower, "lower"), (limit.upper, "upper")):
            what = f"the {end} limit of `{limit.input}`"
            inference.agrees(values[name], units.get(limit.input), what, f"`{limit.input}`")
    for given, name in allocation.preferred:
        inference.agrees(values[name], units.get(given), f"the preload of `{given}`", f"`{given}`")
    if allocation.preload is None:
        return
    preload = values[allocation.preload]
    preload_unit = inference.of(preload) if any(names_in(preload)) else None
    weights = {given: values[name] for given, name in allocation.weights}
    for item in model.inputs:
        weight = weights.get(item.name, Number(Fraction(1)))
        factor = inference.of(weight) if item.name not in weights or any(names_in(weight)) else None
        unit = units.get(item.name)
        if preload_unit is None or factor is None or unit is None:
            continue
        needed = unit.times(factor.to_power(Fraction(1, 2)))
        if preload_unit != needed:
            other = f"`{item.name}` times the root of its weight" if item.name in weights else f"`{item.name}`"
            # the inputs may differ among themselves: one mistake is enough
            inference.agrees(preload, needed, "the preload", other)
            return


class _Inference:
    """The dimensions of expressions; each contradiction is recorded once and then counts as free."""

    def __init__(self, model: Model, units: dict[str, Unit], mistakes: list[Mistake], bodies: BodyUnits) -> None:
        self._units, self._bodies = dict(units), bodies
        for coordinate in model.coordinates:
            if coordinate.name in units:
                self._units[coordinate.rate] = units[coordinate.name].times(SECOND, -1)
        self._mistakes = mistakes
        self._counts = _COUNTS
        # parameters and components of bodies, and definitions that are made of them
        self._measured = {parameter.name for parameter in model.parameters}
        for definition in model.definitions:
            if self._is_measured(definition.value):
                self._measured.add(definition.name)
        for definition in model.definitions:
            dimension = self.of_term(definition.value)
            if dimension is not None:
                self._units[definition.name] = dimension

    def agrees(self, expression: Expression, declared: Dimension, what: str, other: str) -> None:
        """Records a mistake where `what`, the expression, has another dimension than `other`, which is `declared`."""
        dimension = self.of_term(expression)
        if declared is not None and dimension is not None and dimension != declared:
            self._mistakes.append(_clash(what, dimension, other, declared, expression))

    def of_energy(self, expression: Expression) -> Dimension:
        """The dimension of an energy, free where its terms are made of coordinates and numbers, divisors included."""
        match expression:
            case Negation(operand=operand):
                return self.of_energy(operand)
            case Binary(operator="+" | "-", left=left, right=right):
                return self._same(self.of_energy(left), self.of_energy(right), right)
        dimension = self.of_term(expression)
        return dimension if self._is_measured(expression) or not _has_number(expression) else None

    def _is_measured(self, expression: Expression) -> bool:
        return any(is_component(name.name) or name.name in self._measured for name in names_in(expression))

    def of(self, expression: Expression) -> Dimension:
        """The dimension of an expression."""
        match expression:
            case Number(value=value):
                return NUMBER if value in self._counts else None
            case Pi():
                return NUMBER
            case Name(name=name) if is_component(name):
                return self._bodies.component(name)
            case Name(name=name):
                return self._units.get(name)
            case Negation(operand=operand):
                return self.of(operand)
            case Binary(operator="+" | "-", left=left, right=right):
                return self._sum(left, right)
            case Binary(operator=operator, left=left, right=right):
                return self._product(operator, left, right)
            case Power(base=base, exponent=exponent):
                dimension = self.of(base)
                return None if dimension is None else dimension.to_power(exponent)
            case Call():
                return self._call(expression)

    def of_made(self, expression: Expression, span: Span | None) -> None:
        """Checks a row that was made for the entry at `span`: numbers in it have the unit their place demands."""
        before = len(self._mistakes)
        self._counts, counts = frozenset(), self._counts
        self.of(expression)
        self._counts = counts
        self._mistakes[before:] = [replace(one, span=one.span or span) for one in self._mistakes[before:]]

    def of_term(self, expression: Expression) -> Dimension:
        """As `of`, but a number by itself, or before coordinates or a pure number, has the unit its place demands."""
        dimension = self.of(expression)
        if not any(names_in(expression)):
            return None
        fits = _has_factor(expression) and (dimension == NUMBER or not self._is_measured(expression))
        return None if fits else dimension

    def _sum(self, left: Expression, right: Expression) -> Dimension:
        return self._same(self.of_term(left), self.of_term(right), right)

    def _same(self, a: Dimension, b: Dimension, right: Expression) -> Dimension:
        """The dimension of a sum of two terms."""
        if a is not None and b is not None and a != b:
            self._mistakes.append(_clash("this term", b, "the one before", a, right))
            return None
        return a if a is not None else b

    def _product(self, operator: str, left: Expression, right: Expression) -> Dimension:
        if operator == "/" and isinstance(right, Number) and right.value.denominator == 1:
            return self.of(left)
        a, b = self.of(left), self.of(right)
        return None if a is None or b is None else a.times(b, 1 if operator == "*" else -1)

    def _call(self, call: Call) -> Dimension:
        units = [self.of(argument) for argument in call.arguments]
        if call.function == "sqrt":
            return None if units[0] is None else units[0].to_power(Fraction(1, 2))
        if call.function == "atan2":
            if units[0] is not None and units[1] is not None and units[0] != units[1]:
                self._mistakes.append(_clash("this argument", units[1], "the first", units[0], call.arguments[1]))
        elif units[0] is not None and units[0] != NUMBER:
            self._mistakes.append(
                Mistake(
                    f"`{call.function}` of something in {units[0]}",
                    "the argument must be an angle in rad or a number",
                    call.arguments[0].span,
                )
            )
        return NUMBER


def _has_number(expression: Expression) -> bool:
    """Whether a product has a factor or divisor that is a number."""
    match expression:
        case Number():
            return True
        case Negation(operand=operand):
            return _has_number(operand)
        case Binary(operator="*" | "/", left=left, right=right):
            return _has_number(left) or _has_number(right)
    return False


def _has_factor(expression: Expression) -> bool:
    """Whether a product has a factor that is a number; what it is divided by is a count."""
    match expression:
        case Number():
            return True
        case Negation(operand=operand):
            return _has_factor(operand)
        case Binary(operator="*", left=left, right=right):
            return _has_factor(left) or _has_factor(right)
        case Binary(operator="/", left=left):
            return _has_factor(left)
    return False


def _declared(tree: MappingNode, mistakes: list[Mistake]) -> dict[str, Unit]:
    """The units of coordinates, parameters and inputs by name; unreadable ones are mistakes."""
    units: dict[str, Unit] = {}
    for block in ("coordinates", "parameters", "inputs"):
        for key, value in entries(tree.get(block)):
            node = member(value, "unit")
            if isinstance(node, ScalarNode) and node.value.strip():
                unit = parse_unit(node)
                if isinstance(unit, Mistake):
                    mistakes.append(unit)
                else:
                    units.setdefault(key.value, unit)
    return units


def _clash(what: str, unit: Unit, other: str, expected: Unit, expression: Expression) -> Mistake:
    span: Span | None = expression.span
    scale_only = unit.exponents == expected.exponents
    message = f"{what} is in {unit}, {other} in {expected}"
    return Mistake(message, _SAME_UNIT if scale_only else _CHECK_TERMS, span)
