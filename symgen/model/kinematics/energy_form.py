"""The same model written with energies: frames, bodies and points become named sub-expressions.

For readers that know energies only: closed forms, the CasADi witness, the peers of the benchmark.  The kernels and the
reference walk the frames themselves.  Every intermediate has a name, so nothing is written out twice.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from symgen.model.expressions.combine import minus, plus, times
from symgen.model.expressions.expression import Expression, Name, Number, Power
from symgen.model.expressions.walk import exact_value, names_in
from symgen.model.kinematics.components import components_in, definitions_before_frames, printed_formulas
from symgen.model.kinematics.formulas import ExpressionArithmetic, ExpressionNumber, Form, coefficients, rate_of
from symgen.model.kinematics.triples import Rates, Triple, applied, inner
from symgen.model.kinematics.walk import Kinematics
from symgen.model.mechanism import NO_MECHANISM, WORLD, ZERO, component, is_component
from symgen.model.model import AppliedForce, Definition, Input, Model

HALF = Number(Fraction(1, 2))
ONE = Number(Fraction(1))


def energy_form(model: Model) -> Model:
    """The model without bodies form; itself where it has none."""
    mechanism = model.mechanism
    if not (mechanism.frames or mechanism.bodies or mechanism.rotor_inertias or model.forces or mechanism.points):
        return model
    return _EnergyWriter(model).written()


def points_written(model: Model) -> tuple[Model, tuple[str, ...], tuple[str, ...]]:
    """`energy_form` with places and velocities of all points as definitions, and the names of these: x, y, z of each
    point in the order of the file, then vx, vy, vz."""
    points = model.mechanism.points
    places = tuple(f"{point.name}.{axis}" for point in points for axis in "xyz")
    velocities = tuple(f"{point.name}.v{axis}" for point in points for axis in "xyz")
    written = _EnergyWriter(model, (*places, *velocities)).written() if points else energy_form(model)
    return written, places, velocities


class _EnergyWriter:
    def __init__(self, model: Model, more: tuple[str, ...] = ()) -> None:
        self.model, self.more = model, more
        self.before = definitions_before_frames(model)
        self.formulas = ExpressionArithmetic(model.coordinates, {d.name: d.value for d in self.before})
        self.kinematics: Kinematics[ExpressionNumber, Form] = Kinematics(model.mechanism, self.formulas)

    def written(self) -> Model:
        model, formulas = self.model, self.formulas
        kinetic = plus(model.kinetic_energy, self._kinetic_energy())
        potential = plus(model.potential_energy, self._potential_energy())
        components = [Definition(name, self._component(name)) for name in self._components()]
        kinematic = tuple(formulas.definitions)
        # what inputs and forces work on contains components and definitions of the file, and comes after these
        inputs = tuple(self._input(one) for one in model.inputs)
        forces = self._forces()
        of_forces = tuple(formulas.definitions[len(kinematic) :])
        earlier = {definition.name for definition in self.before}
        later = tuple(definition for definition in model.definitions if definition.name not in earlier)
        return replace(
            model,
            definitions=(*self.before, *kinematic, *components, *later, *of_forces),
            kinetic_energy=kinetic,
            potential_energy=potential,
            inputs=inputs,
            applied_forces=forces,
            mechanism=NO_MECHANISM,
            forces=(),
        )

    def _kinetic_energy(self) -> Expression:
        total: Expression = ZERO
        space = self.kinematics.space
        for body in self.model.mechanism.bodies:
            twist = self.kinematics.twist(body.frame)
            arm = space.values(body.com)
            linear = space.summed(twist.linear, space.crossed(twist.angular, arm))
            if self.kinematics.plane(WORLD, body.frame) is not None:
                # in the plane, velocities in world axes have one sine or cosine a link, of absolute angles
                still = self.kinematics.twist(body.frame, WORLD)
                arm = applied(self.kinematics.axes(body.frame), arm)
                linear = space.summed(still.linear, space.crossed(still.angular, arm))
            speed = self._named_rates(f"{body.name}.v", linear)
            spin = self._named_rates(f"{body.name}.w", twist.angular)
            squares = inner(speed, speed).expression
            total = plus(total, times(times(HALF, body.mass), squares))
            rows = tuple(space.values(row) for row in body.inertia.rows)
            total = plus(total, times(HALF, inner(spin, applied((rows[0], rows[1], rows[2]), spin)).expression))
        for rotor in self.model.mechanism.rotor_inertias:
            rate = Name(f"{rotor.coordinate}_dot")
            total = plus(total, times(times(HALF, rotor.inertia), Power(rate, Fraction(2))))
        return total

    def _potential_energy(self) -> Expression:
        space = self.kinematics.space
        gravity = space.values(self.model.mechanism.gravity)
        weight: Expression = ZERO
        for body in self.model.mechanism.bodies if any(exact_value(g.expression) != 0 for g in gravity) else ():
            place = self.kinematics.place(body.frame, space.values(body.com))
            weight = minus(weight, times(body.mass, inner(gravity, place).expression))
        return weight

    def _components(self) -> tuple[str, ...]:
        """Components in the motion equations, in printed formulas and in paths."""
        components = dict.fromkeys((*components_in(self.model), *self.more))
        for path in self.model.paths:
            for _, condition in path.conditions:
                components |= dict.fromkeys(name.name for name in names_in(condition) if is_component(name.name))
        for expression in printed_formulas(self.model.published):
            components |= dict.fromkeys(name.name for name in names_in(expression) if is_component(name.name))
        return tuple(components)

    def _component(self, name: str) -> Expression:
        one = component(name)
        if one.is_rate:
            return rate_of(self.kinematics.component_rate(one))
        return self.kinematics.component(one).expression

    def _named_rates(self, name: str, rates: Rates[Form]) -> Triple[ExpressionNumber]:
        x, y, z = (self.formulas.named(name, ExpressionNumber(rate_of(form))) for form in rates)
        return x, y, z

    def _input(self, one: Input) -> Input:
        if one.velocity is None:
            return one
        column = tuple((name, value.expression) for name, value in self._coefficients(one.velocity).items())
        return replace(one, acts_on=column, velocity=None)

    def _coefficients(self, velocity: Expression) -> Form:
        definitions = {definition.name: definition.value for definition in self.model.definitions}
        return coefficients(velocity, self._rates_of_name, definitions, self.formulas.combination)

    def _rates_of_name(self, name: str) -> Form | None:
        """The coefficients of a name that is a rate."""
        if is_component(name):
            one = component(name)
            return self.kinematics.component_rate(one) if one.is_rate else None
        coordinate = name.removesuffix("_dot")
        known = any(coordinate == c.name for c in self.model.coordinates)
        return {coordinate: ExpressionNumber(ONE)} if known and coordinate != name else None

    def _forces(self) -> tuple[AppliedForce, ...]:
        total = {force.coordinate: force.expression for force in self.model.applied_forces}
        for force in self.model.forces:
            for name, coefficient in self._coefficients(force.velocity).items():
                total[name] = plus(total.get(name, ZERO), times(force.magnitude, coefficient.expression))
        return tuple(AppliedForce(c.name, total[c.name]) for c in self.model.coordinates if c.name in total)
