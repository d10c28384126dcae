"""Frame by frame what Newton and Euler's recursion takes: turns, places and their rates, as SymPy matrices."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import sympy
from sympy import Add, Expr, Integer, Matrix, Symbol, diff

from symgen.closedform.spelling import spell_expression
from symgen.model.expressions.expression import Expression
from symgen.model.kinematics.joints import joint_of
from symgen.model.kinematics.triples import Space
from symgen.model.mechanism import WORLD, Body
from symgen.model.model import Model


@dataclass(frozen=True)
class FrameStep:
    """A frame against its parent, by numbers from 1 (0 is the world), and the bodies that it carries.

    `axes` (R, 3 x 3) turns components in the frame into components in the parent, `place` (r, 3 x 1) is its origin in
    the parent's axes and `place_rate` its time derivative, `turning` (3 x 1) the relative angular velocity in its own.
    """

    number: int
    parent: int
    name: str
    axes: Any
    place: Any
    place_rate: Any
    turning: Any
    bodies: tuple[Body, ...]


def frame_steps(model: Model) -> tuple[FrameStep, ...]:
    """Of every frame that carries a body, itself or further out, parents first."""
    space = Space(_Spelt(model))
    frames = {frame.name: frame for frame in model.mechanism.frames}
    carried: dict[str, list[Body]] = {}
    for body in model.mechanism.bodies:
        name = body.frame
        carried.setdefault(name, []).append(body)
        while name != WORLD:
            name = frames[name].parent
            carried.setdefault(name, [])
    numbers = {WORLD: 0}
    steps = []
    for name, frame in frames.items():
        if name not in carried:
            continue
        numbers[name] = len(numbers)
        joint = joint_of(space, frame)
        place, rate, turning = (Matrix(3, 1, x) for x in (joint.place, joint.place_rate, joint.turning))
        parent, axes = numbers[frame.parent], Matrix(joint.axes)
        steps.append(FrameStep(numbers[name], parent, name, axes, place, rate, turning, tuple(carried[name])))
    return tuple(steps)


class _Spelt:
    """Numbers and rates as SymPy expressions, definitions written out."""

    def __init__(self, model: Model) -> None:
        self._definitions: dict[str, Expr] = {}
        for definition in model.definitions:
            self._definitions[definition.name] = spell_expression(definition.value, self._definitions)
        self._moving = [(Symbol(c.name), Symbol(c.rate)) for c in model.coordinates]

    def value(self, expression: Expression) -> Expr:
        return spell_expression(expression, self._definitions)

    def rate(self, expression: Expression) -> Expr:
        value = self.value(expression)
        return Add(*(diff(value, place) * rate for place, rate in self._moving if value.has(place)))

    def number(self, value: int) -> Expr:
        return Integer(value)

    def function(self, name: str, operand: Expr) -> Expr:
        return getattr(sympy, name)(operand)

    def combination(self, terms: Iterable[tuple[Expr, Expr]]) -> Expr:
        return Add(*(factor * rate for factor, rate in terms))

    def named(self, _: str, value: Expr, /) -> Expr:
        return value
