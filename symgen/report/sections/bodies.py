"""Frames, bodies and points of a model as tables, for the section on the system."""

from __future__ import annotations

from symgen.model.expressions.expression import Expression
from symgen.model.expressions.walk import exact_value
from symgen.model.inertial_parameters import in_words, named
from symgen.model.mechanism import INERTIA_ELEMENTS, Frame, Mechanism, Quaternion, Vector3
from symgen.model.model import Model
from symgen.model.quantities import BASE_PARAMETERS, BASE_REGRESSOR, REGRESSOR
from symgen.report.context import Context, text_of
from symgen.report.document import Block, InlineCode, InlineMath, Table, Text
from symgen.report.mathematics.from_expression import expression_layout
from symgen.report.mathematics.layout import Fenced, Layout, Letter
from symgen.report.mathematics.names import name_layout
from symgen.report.prose import SYMBOLS, equals, listed, paragraph, say

NOTHING = say("{}", "–")
GRAVITY = Letter("g", "bold")


def weighs(parts: Mechanism) -> bool:
    """Whether there is gravity."""
    return any(exact_value(entry) != 0 for entry in parts.gravity)


def mechanism(context: Context) -> list[Block]:
    """Tables of what the mechanism is made of; nothing for a model with energies only and without points."""
    parts = context.model.mechanism
    if not parts.frames and not parts.points and not parts.rotor_inertias:
        return []
    blocks: list[Block] = []
    if parts.frames:
        intro = (
            "Frames are moved along a vector in the axes of their parent and then turned, by one angle after the "
            "other, about the axes reached so far."
        )
        blocks += [paragraph(intro), _frames(context)]
    if parts.bodies:
        intro = "Bodies are given in the axes of their frames, inertias about the centres of mass."
        blocks += [paragraph(intro), _bodies(context)]
        if weighs(parts):
            blocks.append(paragraph("Weight acts with the acceleration {}.", equals(GRAVITY, _fenced(parts.gravity))))
        else:
            blocks.append(paragraph("There is no gravity."))
    if parts.points:
        intro = "Points are places in frames; in equations their coordinates in the world carry their names."
        blocks += [paragraph(intro), _points(context)]
    if parts.rotor_inertias:
        rows = tuple(((InlineCode(r.coordinate),), _math(expression_layout(r.inertia))) for r in parts.rotor_inertias)
        blocks.append(paragraph("Rotors that are geared to a coordinate add their inertia to its rate alone."))
        blocks.append(Table((say("Coordinate"), say("Inertia")), rows, (0, 1)))
    if REGRESSOR in context.input.operation_counts:
        blocks += [_regressor(context.model), *context.quantity(REGRESSOR)]
    return [*blocks, *_base(context)]


def _base(context: Context) -> list[Block]:
    """Which columns stand for all, and what these are multiplied with."""
    made = [name for name in (BASE_REGRESSOR, BASE_PARAMETERS) if name in context.input.operation_counts]
    base = context.model.inertial_base
    if not made or base is None:
        return []
    text = (
        "Motions that the constraints allow show no more than some combinations of inertial parameters, the base "
        "parameters {}: each of {}, and what others add to it. Their columns are those of {}."
    )
    names = InlineCode(named(context.model.mechanism, base.columns))
    first = paragraph(text, SYMBOLS[BASE_PARAMETERS], names, SYMBOLS[BASE_REGRESSOR])
    return [first, *(block for name in made for block in context.quantity(name))]


def _regressor(model: Model) -> Block:
    """What the columns of Y are."""
    text = (
        "What bodies and rotors ask of the inputs is linear in their inertial parameters: masses, first moments, and "
        "inertias about the origins of frames, all in the axes of these. The columns of {} are the least inputs for a "
        "unit of each, in the order {}."
    )
    return paragraph(text, SYMBOLS[REGRESSOR], InlineCode(in_words(model.mechanism)))


def _frames(context: Context) -> Table:
    frames = context.model.mechanism.frames
    described = any(text_of(frame.description) for frame in frames)
    rows = []
    for frame in frames:
        row = ((InlineCode(frame.name),), (InlineCode(frame.parent),), _vector_text(frame.translation), _turns(frame))
        rows.append((*row, say("{}", text_of(frame.description) or "–")) if described else row)
    header = (say("Frame"), say("Parent"), say("Moved by"), say("Turned by"))
    if not described:
        return Table(header, tuple(rows), (0, 0, 0, 1))
    return Table((*header, say("Meaning")), tuple(rows), (0, 0, 0, 0, 1))


def _bodies(context: Context) -> Table:
    rows = []
    for body in context.model.mechanism.bodies:
        elements = zip(INERTIA_ELEMENTS, _elements(body.inertia.rows), strict=True)
        given = tuple(
            equals(name_layout(f"J_{name}"), expression_layout(value))
            for name, value in elements
            if exact_value(value) != 0
        )
        # several formulas: a line of text breaks between them
        inertia = say(", ".join("{}" for _ in given), *given) if given else NOTHING
        rows.append(
            (
                (InlineCode(body.name),),
                (InlineCode(body.frame),),
                _math(expression_layout(body.mass)),
                _vector_text(body.com),
                inertia,
            )
        )
    header = (say("Body"), say("Frame"), say("Mass"), say("Centre of mass"), say("Inertia"))
    return Table(header, tuple(rows), (0, 0, 0, 0, 1))


def _points(context: Context) -> Table:
    rows = tuple(
        ((InlineCode(p.name),), (InlineCode(p.frame),), _vector_text(p.at), (InlineCode(p.carrier),))
        for p in context.model.mechanism.points
    )
    return Table((say("Point"), say("Frame"), say("Place"), say("Moves with")), rows, (0, 0, 1, 0))


def _elements(rows: tuple[Vector3, Vector3, Vector3]) -> tuple[Expression, ...]:
    return rows[0][0], rows[1][1], rows[2][2], rows[0][1], rows[0][2], rows[1][2]


def _turns(frame: Frame) -> Text:
    if isinstance(frame.rotation, Quaternion):
        return say("the quaternion {}", _fenced(frame.rotation.parts))
    if not frame.rotation:
        return NOTHING
    pieces: list[Layout | str] = []
    pattern = ""
    for turn in frame.rotation:
        pattern += ("; " if pattern else "") + "{} about {}"
        axis = [exact_value(entry) for entry in turn.axis]
        main = next((name for name, value in zip("xyz", axis, strict=True) if value == 1), None)
        alone = sum(value != 0 for value in axis) == 1
        pieces += [expression_layout(turn.angle), main if main is not None and alone else _fenced(turn.axis)]
    return say(pattern, *pieces)


def _vector_text(vector: Vector3) -> Text:
    return NOTHING if all(exact_value(entry) == 0 for entry in vector) else _math(_fenced(vector))


def _fenced(entries: tuple[Expression, ...]) -> Layout:
    return Fenced(listed(tuple(expression_layout(entry) for entry in entries)))


def _math(layout: Layout) -> Text:
    return (InlineMath(layout),)
