"""The coordinates: which are angles, and the ranges states are sampled from."""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction

from symgen.model.blocks.joint_forms import JointCoordinate
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Power
from symgen.model.file.declarations import DeclaredRanges
from symgen.model.file.reading import description_of, entries, member, text_of
from symgen.model.file.source import MappingNode
from symgen.model.model import Coordinate, Definition, Range

ANGLE_RANGE: Range = (Fraction(-math.pi), Fraction(math.pi))
# The range of what is no angle, in the units of the file, and of rates and accelerations, where the file says none.
UNIT_RANGE: Range = (Fraction(-1), Fraction(1))


def read_coordinates(
    tree: MappingNode,
    ranges: DeclaredRanges,
    definitions: tuple[Definition, ...],
    expressions: Iterable[Expression],
    joints: tuple[JointCoordinate, ...],
) -> tuple[Coordinate, ...]:
    """The coordinates in the order of the file, those that joints bring along after the others.

    An angle is what has the unit rad or, without a unit, is used inside sines, cosines and tangents only.
    """
    bare, inside = _uses(definitions, expressions)
    coordinates: list[Coordinate] = []
    for key, node in entries(tree.get("coordinates")):
        name, unit = key.value, text_of(member(node, "unit"))
        is_angle = unit == "rad" or (unit is None and name in inside and name not in bare)
        coordinates.append(
            Coordinate(
                name,
                unit,
                description_of(node),
                is_angle,
                ranges.get(name, ANGLE_RANGE if is_angle else UNIT_RANGE),
                ranges.get(f"{name}_dot", UNIT_RANGE),
                ranges.get(f"{name}_ddot", UNIT_RANGE),
                key.span,
                *_stated(name, ranges),
            )
        )
    for joint in joints:
        is_angle = joint.unit == "rad"
        usual = ANGLE_RANGE if is_angle else UNIT_RANGE
        name = joint.name
        rates = ranges.get(f"{name}_dot", UNIT_RANGE), ranges.get(f"{name}_ddot", UNIT_RANGE)
        where = ranges.get(name, usual)
        coordinates.append(
            Coordinate(name, joint.unit, joint.description, is_angle, where, *rates, joint.span, *_stated(name, ranges))
        )
    return tuple(coordinates)


def _stated(name: str, ranges: DeclaredRanges) -> tuple[bool, bool, bool]:
    """Whether the file has ranges of a coordinate, its rate, its acceleration."""
    return name in ranges, f"{name}_dot" in ranges, f"{name}_ddot" in ranges


def _uses(definitions: tuple[Definition, ...], expressions: Iterable[Expression]) -> tuple[set[str], set[str]]:
    """The names used outside and inside of sines, cosines, tangents; definitions pass their own uses on."""
    bare: set[str] = set()
    inside: set[str] = set()
    for expression in expressions:
        _collect(expression, bare, inside)
    for definition in reversed(definitions):
        if definition.name in bare:
            _collect(definition.value, bare, inside)
        if definition.name in inside:
            _collect(definition.value, inside, inside)
    return bare, inside


def _collect(expression: Expression, bare: set[str], inside: set[str]) -> None:
    match expression:
        case Name(name=name):
            bare.add(name)
        case Negation(operand=inner) | Power(base=inner):
            _collect(inner, bare, inside)
        case Binary(left=left, right=right):
            _collect(left, bare, inside)
            _collect(right, bare, inside)
        case Call(function=function, arguments=arguments):
            for argument in arguments:
                _collect(argument, inside if function in ("sin", "cos", "tan") else bare, inside)
        case _:
            pass
