"""Newton and Euler's recursion of a machine, frame by frame: its equation of motion where no matrix is written out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from symgen.closedform.frame_steps import FrameStep
from symgen.model.expressions.walk import exact_value
from symgen.model.mechanism import Body
from symgen.model.model import Model
from symgen.report.context import Context
from symgen.report.document import Block, InlineCode, displayed
from symgen.report.mathematics.from_expression import expression_layout
from symgen.report.mathematics.layout import Accent, Fenced, Layout, Letter, Relation, Row, Scripts, Sign, equation
from symgen.report.mathematics.matrices import packed
from symgen.report.mathematics.names import name_layout
from symgen.report.prose import (
    TWO,
    ZERO,
    B,
    M,
    Qa,
    bold,
    equals,
    juxtaposed,
    lam,
    listed,
    minus_sum,
    number,
    paragraph,
    plus,
    tau,
    transposed,
    u,
)

# Frames that are written out one by one; those of longer chains repeat.
FRAMES_PRINTED = 16
WEIGHT = bold("g")


def recursion(context: Context) -> list[Block]:
    """The recursion; nothing where the model has no bodies, or its mass matrix is written out."""
    steps = context.input.frame_steps
    if not steps:
        return []
    blocks: list[Block] = [
        paragraph(
            "So the motion equations are given as Newton and Euler's recursion over the frames, numbered in the order "
            "of their table without those that carry no body; 0 is the world. Vectors have their components in the "
            "axes of their own frame: its angular velocity {}, the acceleration {} of its origin, less gravity, the "
            "force {} and the moment {} about its origin that it takes. {} turns components in frame {} into those in "
            "its parent, {} is the place of its origin there, {} its angular velocity against its parent. {} and {} "
            "are centre of mass and inertia of a body by its table. Dots differentiate component by component.",
            *(bold(letter) for letter in "ωafn"), R(Letter("k")), Letter("k"), r(Letter("k")), nu(Letter("k")),
            bold("c"), bold("J"),
        ),
        displayed((_load(context),), "load"),
    ]  # fmt: skip
    laws = _FrameLaws(steps)
    for step in steps[:FRAMES_PRINTED]:
        blocks.append(paragraph("Frame {}, {}:", number(step.number), InlineCode(step.name)))
        blocks.append(displayed((*packed(_given(context, step)), *packed(laws.of(step)))))
    if len(steps) > FRAMES_PRINTED:
        blocks.append(paragraph(f"The other {len(steps) - FRAMES_PRINTED} frames follow in the same way."))
    pattern = "The entries of {} are the power of these forces and moments per unit of a rate"
    beside = "" if _bodies_alone(context.model) else ", and what follows from energies that are written out"
    blocks.append(paragraph(f"{pattern}{beside}:", tau))
    blocks.append(displayed(tuple(packed(_loads(context, steps)))))
    return blocks


def _bodies_alone(model: Model) -> bool:
    """Whether no energy is written out."""
    return all(exact_value(energy) == 0 for energy in (model.kinetic_energy, model.potential_energy))


def _load(context: Context) -> Layout:
    """tau = M u + Q_a - B' lambda."""
    right: list[Layout] = [juxtaposed(M, u)] if context.model.m else []
    if context.model.has_applied_forces:
        right.append(Qa)
    if context.model.r:
        return equals(tau, minus_sum((plus(*right),) if right else (), (juxtaposed(transposed(B), lam),)))
    return equals(tau, plus(*right) if right else ZERO)


def _indexed(letter: str, index: Layout) -> Layout:
    return Scripts(bold(letter), index)


def R(index: Layout) -> Layout:
    """R_k."""
    return _indexed("R", index)


def r(index: Layout) -> Layout:
    """r_k."""
    return _indexed("r", index)


def nu(index: Layout) -> Layout:
    """ν_k."""
    return _indexed("ν", index)


def cross(left: Layout, right: Layout) -> Layout:
    """left × right."""
    return Row((left, Relation("×"), right))


def _dotted(letter: str, index: Layout) -> Layout:
    return Scripts(Accent(bold(letter), "dot"), index)


def _given(context: Context, step: FrameStep) -> Iterator[Layout]:
    """The numbers of a frame: R, r, ν and, where its origin slides, the rate of r."""
    k = number(step.number)
    if not step.axes.is_Identity:
        yield equation(R(k), context.layout.matrix(step.axes))
    for symbol, vector in ((r(k), step.place), (_dotted("r", k), step.place_rate), (nu(k), step.turning)):
        if not vector.is_zero_matrix:
            yield equation(symbol, Fenced(listed(tuple(context.layout.expression(x) for x in vector))))


class _FrameLaws:
    """The laws of each frame without what is zero there."""

    def __init__(self, steps: Sequence[FrameStep]) -> None:
        self._steps = steps
        self._turning = {0: False}
        for step in steps:
            self._turning[step.number] = self._turning[step.parent] or not step.turning.is_zero_matrix

    def of(self, step: FrameStep) -> Iterator[Layout]:
        """Outwards the motion, inwards force and moment."""
        k = number(step.number)
        if self._turning[step.number]:
            yield equation(_indexed("ω", k), self._velocity(step))
            yield equation(_dotted("ω", k), self._acceleration(step))
        yield equation(_indexed("a", k), self._linear(step))
        yield from (equation(_force(step, body), self._inertial(step, body)) for body in step.bodies)
        outer = [other for other in self._steps if other.parent == step.number]
        yield equation(_indexed("f", k), _total([*(_force(step, body) for body in step.bodies), *map(_handed, outer)]))
        yield equation(_indexed("n", k), _total([*self._moments(step), *self._moments_handed(outer)]))

    def _velocity(self, step: FrameStep) -> Layout:
        terms = [_inwards(step, _indexed("ω", number(step.parent)))] if self._turning[step.parent] else []
        return _total([*terms, *([] if step.turning.is_zero_matrix else [nu(number(step.number))])])

    def _acceleration(self, step: FrameStep) -> Layout:
        k, parent, terms = number(step.number), number(step.parent), []
        if self._turning[step.parent]:
            terms.append(_inwards(step, _dotted("ω", parent)))
        if not step.turning.is_zero_matrix:
            terms.append(_dotted("ν", k))
            if self._turning[step.parent]:
                velocity = _inwards(step, _indexed("ω", parent))
                terms.append(cross(velocity if step.axes.is_Identity else Fenced(velocity), nu(k)))
        return _total(terms)

    def _linear(self, step: FrameStep) -> Layout:
        """R' (a + ω' x r + ω x (ω x r) + 2 ω x r' + r'') of the parent's a and ω."""
        k, parent = number(step.number), number(step.parent)
        terms: list[Layout] = [_indexed("a", parent)] if step.parent else []
        if self._turning[step.parent] and not step.place.is_zero_matrix:
            terms += _about(parent, r(k))
        if not step.place_rate.is_zero_matrix:
            if self._turning[step.parent]:
                terms.append(cross(juxtaposed(TWO, _indexed("ω", parent)), _dotted("r", k)))
            terms.append(Scripts(Accent(bold("r"), "ddot"), k))
        inside = _total(terms) if step.parent else minus_sum(tuple(terms), (WEIGHT,))
        return _inwards(step, inside, len(terms) > 1 or not step.parent)

    def _inertial(self, step: FrameStep, body: Body) -> Layout:
        """m (a + ω' x c + ω x (ω x c))."""
        k = number(step.number)
        terms = [_indexed("a", k)]
        if self._turning[step.number] and _has_arm(body):
            terms += _about(k, _of_body("c", step, body))
        return juxtaposed(expression_layout(body.mass), Fenced(_total(terms)) if len(terms) > 1 else terms[0])

    def _moments(self, step: FrameStep) -> Iterator[Layout]:
        k = number(step.number)
        for body in step.bodies:
            if self._turning[step.number] and any(exact_value(x) != 0 for row in body.inertia.rows for x in row):
                inertia = _of_body("J", step, body)
                yield juxtaposed(inertia, _dotted("ω", k))
                yield cross(_indexed("ω", k), juxtaposed(inertia, _indexed("ω", k)))
            if _has_arm(body):
                yield cross(_of_body("c", step, body), _force(step, body))

    def _moments_handed(self, outer: Sequence[FrameStep]) -> Iterator[Layout]:
        for other in outer:
            yield _outwards(other, _indexed("n", number(other.number)))
            if not other.place.is_zero_matrix:
                yield cross(r(number(other.number)), _handed(other))


def _about(frame: Layout, arm: Layout) -> list[Layout]:
    """ω' x r + ω x (ω x r)."""
    velocity = _indexed("ω", frame)
    return [cross(_dotted("ω", frame), arm), cross(velocity, Fenced(cross(velocity, arm)))]


def _inwards(step: FrameStep, vector: Layout, fenced: bool = False) -> Layout:
    """R' times a vector of the parent's axes."""
    if step.axes.is_Identity:
        return vector
    return juxtaposed(transposed(R(number(step.number))), Fenced(vector) if fenced else vector)


def _outwards(step: FrameStep, vector: Layout) -> Layout:
    """R times a vector of the frame's axes."""
    return vector if step.axes.is_Identity else juxtaposed(R(number(step.number)), vector)


def _handed(step: FrameStep) -> Layout:
    """The force that a frame hands to its parent."""
    return _outwards(step, _indexed("f", number(step.number)))


def _of_body(letter: str, step: FrameStep, body: Body) -> Layout:
    """A symbol of a body: with the number of its frame, and its own where that carries several."""
    k = number(step.number)
    if len(step.bodies) == 1:
        return _indexed(letter, k)
    return _indexed(letter, listed((k, number(step.bodies.index(body) + 1))))


def _force(step: FrameStep, body: Body) -> Layout:
    return _of_body("F", step, body)


def _has_arm(body: Body) -> bool:
    return any(exact_value(x) != 0 for x in body.com)


def _total(terms: Sequence[Layout]) -> Layout:
    return plus(*terms) if terms else ZERO


def _loads(context: Context, steps: Sequence[FrameStep]) -> Iterator[Layout]:
    """Of each coordinate the power of forces and moments on what its rate moves, and its rotor."""
    rotors = {rotor.coordinate: rotor.inertia for rotor in context.model.mechanism.rotor_inertias}
    for place, coordinate in enumerate(context.model.coordinates):
        terms: list[Layout] = []
        for step in steps:
            k = number(step.number)
            turning, sliding = (x.diff(coordinate.rate) for x in (step.turning, step.place_rate))
            terms += _power(context, turning, _indexed("n", k))
            terms += _power(context, sliding, _handed(step))
        if coordinate.name in rotors:
            rotor = expression_layout(rotors[coordinate.name])
            terms.append(juxtaposed(rotor, name_layout(coordinate.acceleration)))
        if terms:
            yield equation(Scripts(Letter("τ"), number(place + 1)), _total(terms))


def _power(context: Context, direction: Any, load: Layout) -> Iterator[Layout]:
    """What a force or moment does along a direction."""
    if not direction.is_zero_matrix:
        yield Row((Fenced(listed(tuple(map(context.layout.expression, direction)))), Sign("·"), load))
