"""Units of frames, bodies and points: lengths, masses and what follows from them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction

from symgen.model.expressions.expression import Expression
from symgen.model.expressions.units import KILOGRAM, METRE, NUMBER, SECOND, Unit
from symgen.model.expressions.walk import names_in
from symgen.model.mechanism import Mechanism, Quaternion, component, is_component
from symgen.model.model import Model

# The exponent of a square.
TWO = Fraction(2)


@dataclass(frozen=True)
class Demand:
    """An expression and the unit it must have: `what` is it, and what has that unit otherwise."""

    expression: Expression
    unit: Unit
    what: str
    other: str


@dataclass(frozen=True)
class BodyUnits:
    """The units of length and mass that a mechanism is written in: m and kg, or with the prefixes first used."""

    length: Unit
    mass: Unit

    @property
    def energy(self) -> Unit:
        """mass * length^2 / s^2."""
        return self.mass.times(self.length.to_power(TWO)).times(SECOND.to_power(TWO), -1)

    def component(self, name: str) -> Unit:
        """The unit of a component of a point or frame."""
        one = component(name)
        if one.what[0] in "rw":
            return NUMBER.times(SECOND, -1) if one.is_rate else NUMBER
        return self.length.times(SECOND, -1) if one.is_rate else self.length

    def demands(self, mechanism: Mechanism) -> Iterator[Demand]:
        """What each part of the mechanism must be in."""
        acceleration = self.length.times(SECOND.to_power(TWO), -1)
        inertia = self.mass.times(self.length.to_power(TWO))
        yield from (Demand(entry, acceleration, "`gravity`", "an acceleration") for entry in mechanism.gravity)
        for frame in mechanism.frames:
            what = f"the translation of `{frame.name}`"
            yield from (Demand(entry, self.length, what, "a length") for entry in frame.translation)
            if not isinstance(frame.rotation, Quaternion):
                what = f"a turn of `{frame.name}`"
                yield from (Demand(turn.angle, NUMBER, what, "an angle") for turn in frame.rotation)
        for body in mechanism.bodies:
            yield Demand(body.mass, self.mass, f"the mass of `{body.name}`", "a mass")
            what = f"the centre of mass of `{body.name}`"
            yield from (Demand(entry, self.length, what, "a length") for entry in body.com)
            tensor, what = body.inertia, f"the inertia of `{body.name}`"
            for entry in (tensor.xx, tensor.yy, tensor.zz, tensor.xy, tensor.xz, tensor.yz):
                yield Demand(entry, inertia, what, "a moment of inertia")
        for point in mechanism.points:
            yield from (Demand(entry, self.length, f"the place of `{point.name}`", "a length") for entry in point.at)


def body_units(model: Model, units: Mapping[str, Unit]) -> BodyUnits:
    """The units of length and mass, from the first names that have one."""
    mechanism = model.mechanism
    lengths = [
        *(entry for frame in mechanism.frames for entry in frame.translation),
        *(entry for point in mechanism.points for entry in point.at),
        *(entry for body in mechanism.bodies for entry in body.com),
    ]
    masses = (body.mass for body in mechanism.bodies)
    return BodyUnits(_first(lengths, units, METRE), _first(masses, units, KILOGRAM))


def _first(expressions: Iterable[Expression], units: Mapping[str, Unit], usual: Unit) -> Unit:
    for expression in expressions:
        for name in names_in(expression):
            unit = units.get(name.name)
            if unit is not None and not is_component(name.name) and unit.exponents == usual.exponents:
                return unit
    return usual
