"""Frames and points in floats, or other numbers, at one configuration, for the checks made while loading."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeAlias

from symgen.model.configurations.dense import Rows
from symgen.model.configurations.gradient import Dual, Gradients
from symgen.model.expressions.expression import Expression
from symgen.model.kinematics.triples import Rates, Triple, minus
from symgen.model.kinematics.walk import Kinematics
from symgen.model.mechanism import WORLD, Mechanism, component

Form: TypeAlias = dict[int, float]
"""Coefficients of the rates by the number of the coordinate."""


class FloatArithmetic:
    """The arithmetic of `Kinematics` in floats; raises ArithmeticError or ValueError outside a domain."""

    def __init__(self, gradients: Gradients) -> None:
        self._gradients = gradients

    def value(self, expression: Expression) -> float:
        """The value of an expression."""
        return self._gradients.of(expression)[0]

    def rate(self, expression: Expression) -> Form:
        """Its gradient."""
        return self._gradients.of(expression)[1]

    def number(self, value: int) -> float:
        """A whole number."""
        return self._gradients.numbers.rational(value)

    def function(self, name: str, operand: float) -> float:
        """sin, cos or sqrt."""
        return self._gradients.numbers.functions[name](operand)

    def combination(self, terms: Iterable[tuple[float, Form]]) -> Form:
        """Sum of products."""
        total: Form = {}
        for factor, form in terms:
            if factor != 0.0:
                for index, value in form.items():
                    total[index] = total.get(index, 0.0) + factor * value
        return total

    def named(self, _: str, value: float, /) -> float:
        """Floats have no names."""
        return value


class FloatKinematics:
    """Components, and the mass matrix of the bodies, at one configuration."""

    def __init__(self, mechanism: Mechanism, gradients: Gradients) -> None:
        self._mechanism, self._index = mechanism, gradients.index
        self._arithmetic = FloatArithmetic(gradients)
        self._kinematics: Kinematics[float, Form] = Kinematics(mechanism, self._arithmetic, False)
        self._places: dict[tuple[str, str], tuple[Triple[float], Rates[Form]]] = {}

    def place(self, name: str) -> Dual:
        """Value and gradient of a component that is no rate."""
        one = component(name)
        if one.is_rate:
            raise KeyError(name)
        if one.what.startswith("r"):
            return self._kinematics.component(one), self._kinematics.component_rate(one)
        key = one.owner, one.axes
        if key not in self._places:
            position = self._kinematics.position(*key)
            in_world = one.axes == WORLD
            rates = self._motion(one.owner, position) if in_world else self._kinematics.position_rate(*key)
            self._places[key] = position, rates
        position, rates = self._places[key]
        return position[one.index], rates[one.index]

    def _motion(self, owner: str, position: Triple[float]) -> Rates[Form]:
        """The gradient of a position in the world: each joint on the way moves it and turns it about its own place.

        A twist carried from frame to frame would have as many entries as there are coordinates on the way, at each.
        """
        kinematics, space = self._kinematics, self._kinematics.space
        total: Rates[Form] = ({}, {}, {})
        frame = owner
        if owner in kinematics.points:
            point = kinematics.points[owner]
            frame = point.frame
            _add(total, space.turned(kinematics.axes(frame), space.rates(point.at)))
        for name in kinematics.lineage(frame)[:-1]:
            joint, parent = kinematics.joint(name), kinematics.frames[name].parent
            if any(joint.place_rate):
                _add(total, space.turned(kinematics.axes(parent), joint.place_rate))
            if any(joint.turning_before):
                arm = minus(position, kinematics.origin(name))
                _add(total, space.crossed(space.turned(kinematics.axes(parent), joint.turning_before), arm))
        return total

    def value(self, name: str) -> float:
        """The value of a component that is no rate."""
        return self._kinematics.component(component(name))

    def rate(self, name: str) -> Form:
        """Coefficients of a component that is a rate."""
        return self._kinematics.component_rate(component(name))

    def turning(self, frame: str) -> tuple[Form, Form, Form]:
        """The angular velocity of a frame in its own axes, as coefficients of the rates."""
        return self._kinematics.twist(frame).angular

    def mass_matrix(self, n: int) -> Rows:
        """G of the bodies and rotors, n x n."""
        matrix = [[0.0] * n for _ in range(n)]
        for rotor in self._mechanism.rotor_inertias:
            i = self._index[rotor.coordinate]
            matrix[i][i] += self._arithmetic.value(rotor.inertia)
        for body in self._mechanism.bodies:
            twist, space = self._kinematics.twist(body.frame), self._kinematics.space
            mass, com = self._arithmetic.value(body.mass), space.values(body.com)
            linear = space.summed(twist.linear, space.crossed(twist.angular, com))
            rows = tuple(space.values(row) for row in body.inertia.rows)
            momenta = [self._arithmetic.combination(zip(row, twist.angular, strict=True)) for row in rows]
            pairs = [(self._arithmetic.combination([(mass, v)]), v) for v in linear]
            for momentum, rate in (*pairs, *zip(momenta, twist.angular, strict=True)):
                along = sorted(rate.items())
                for i, a in momentum.items():
                    row = matrix[i]
                    for j, b in along:
                        if j > i:
                            break
                        row[j] += a * b
        # that is what stands left of the diagonal
        for i, row in enumerate(matrix):
            for j in range(i):
                matrix[j][i] = row[j]
        return matrix


def _add(total: Rates[Form], rates: Rates[Form]) -> None:
    """Add to what is there."""
    for sum_of_all, form in zip(total, rates, strict=True):
        for index, value in form.items():
            sum_of_all[index] = sum_of_all.get(index, 0.0) + value
