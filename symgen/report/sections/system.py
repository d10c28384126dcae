"""The section on the model: coordinates, parameters, energies, constraints and inputs, as the file gives them."""

from __future__ import annotations

from fractions import Fraction

from symgen.model.blocks.coordinates import ANGLE_RANGE
from symgen.model.expressions.expression import Expression, Number
from symgen.model.model import Input, Model, Range
from symgen.model.open_task import directions, norm_of_motions
from symgen.report.context import Context, text_of
from symgen.report.document import (
    Block,
    Figure,
    FigureReference,
    InlineCode,
    InlineMath,
    Section,
    Table,
    Text,
    displayed,
)
from symgen.report.mathematics.from_expression import expression_layout
from symgen.report.mathematics.layout import (
    Layout,
    Letter,
    Punctuation,
    Row,
    Scripts,
    Sum,
    equation,
    signed,
)
from symgen.report.mathematics.matrices import packed
from symgen.report.mathematics.names import name_layout
from symgen.report.mathematics.numerals import decimal_text, rational_text
from symgen.report.mathematics.setting import product
from symgen.report.prose import (
    ONE,
    SYMBOLS,
    ZERO,
    B,
    Q,
    Qa,
    equals,
    juxtaposed,
    lam,
    listed,
    number,
    paragraph,
    q,
    qd,
    say,
    small_m,
    small_n,
    small_r,
    u,
)
from symgen.report.sections.bodies import mechanism
from symgen.report.sections.energies import energies

SUPERSCRIPTS = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def _drawing(context: Context) -> tuple[Block, ...]:
    """The machine, where it has frames or points."""
    model = context.model
    if context.input.drawing is None:
        return ()
    shown = "The mechanism where its start leads, with its coordinates; driven joints are filled{}."
    if not model.pictured.frames:
        shown = "Points of the mechanism where its start leads{}."
    arrows = any(one.velocity is not None for one in model.inputs)
    caption = say(shown.format(", inputs that act on bodies are named where they do" if arrows else ""))
    figure = Figure(context.input.drawing, caption, "mechanism", wide=False)
    return (paragraph("{} shows the mechanism.", FigureReference(figure.label)), figure)


def system(context: Context) -> Section:
    """Everything the model file says, with units, descriptions and defaults."""
    model = context.model
    blocks: list[Block] = [
        *_drawing(context),
        paragraph(
            "The coordinates, {}, are the entries of {} in this order. A dot denotes the time derivative; states for "
            "verification are drawn from the ranges.",
            equals(small_n, number(model.n)),
            q,
        ),
        _coordinates(context),
    ]
    if model.parameters:
        blocks.append(
            paragraph("The parameters are run-time arguments of the generated code; the values are their defaults.")
        )
        blocks.append(_parameters(context))
    else:
        blocks.append(paragraph("The model has no parameters."))
    if model.definitions:
        named = tuple(equation(name_layout(d.name), expression_layout(d.value)) for d in model.definitions)
        blocks += [paragraph("These expressions have names of their own:"), displayed(tuple(packed(named)))]
    blocks += mechanism(context)
    blocks += [*energies(model), *_constraints(context), *_inputs(context), *_applied_forces(context)]
    blocks += _given(context)
    return Section(say("The system"), tuple(blocks))


def unit_text(unit: str | None) -> str:
    """A unit as it is written on paper: kg·m²."""
    if not unit:
        return "–"
    head, *powers = unit.replace(" ", "").split("**")
    text = head
    for part in powers:
        digits = len(part) - len(part.lstrip("-0123456789"))
        text += part[:digits].translate(SUPERSCRIPTS) + part[digits:]
    return text.replace("*", "·")


def _coordinates(context: Context) -> Table:
    rows = tuple(
        (
            (InlineMath(name_layout(c.name)),),
            (InlineCode(c.name),),
            say("{}", unit_text(c.unit)),
            say("{}", text_of(c.description) or "–"),
            say("{}", _range_text(c.range)),
        )
        for c in context.model.coordinates
    )
    return Table((say("Symbol"), say("Name"), say("Unit"), say("Meaning"), say("Range")), rows, (0, 0, 0, 1, 0))


def _range_text(bounds: Range) -> str:
    low, high = map(_bound_text, bounds)
    return f"{low} … {high}"


def _bound_text(bound: Fraction) -> str:
    """A bound in four digits, half turns by name."""
    if abs(bound) == ANGLE_RANGE[1]:
        return "π" if bound > 0 else "−π"
    return f"{float(bound):.4g}".replace("-", "−")


def _parameters(context: Context) -> Table:
    rows = tuple(
        (
            (InlineMath(name_layout(p.name)),),
            (InlineCode(p.name),),
            say("{}", unit_text(p.unit)),
            _default(p.value),
            say("{}", text_of(p.description) or "–"),
        )
        for p in context.model.parameters
    )
    return Table((say("Symbol"), say("Name"), say("Unit"), say("Default"), say("Meaning")), rows, (0, 0, 0, 0, 1))


def _default(value: Expression) -> Text:
    if isinstance(value, Number) and decimal_text(value.value) is not None:
        return say("{}", rational_text(value.value))
    return (InlineMath(expression_layout(value)),)


def _constraints(context: Context) -> list[Block]:
    model = context.model
    if not model.constraints:
        return [paragraph("There are no constraints, {}: every velocity is admissible.", equals(small_r, ZERO))]
    blocks: list[Block] = []
    intros = {
        "geometric": (
            "A geometric constraint, paper (4), defines the configuration space:",
            "Geometric constraints, paper (4), define the configuration space:",
        ),
        "nonholonomic": (
            "A constraint linear in the rates, paper (1), restricts the velocities:",
            "Constraints linear in the rates, paper (1), restrict the velocities:",
        ),
    }
    for kind, (singular, plural) in intros.items():
        rows = [row for row in model.constraints if row.kind == kind]
        if rows:
            intro = singular if len(rows) == 1 else plural
            equations = tuple(equation(expression_layout(row.expression), ZERO) for row in rows)
            blocks += [paragraph(intro), displayed(equations, f"constraints_{kind}")]
    names: list[InlineCode | str] = []
    for row in model.constraints:
        names += [", ", InlineCode(row.name)] if names else [InlineCode(row.name)]
    if len(names) == 1:
        blocks.append(paragraph("In the file it is called {}.", *names))
        return blocks
    pattern = "In the file they are called " + "{}" * len(names)
    blocks.append(
        paragraph(f"{pattern}; their order is that of the rows of {{}} and of the multipliers {{}}.", *names, B, lam)
    )
    return blocks


def _given(context: Context) -> list[Block]:
    """What is measured, and the task with its derivatives by the coordinates."""
    model = context.model
    blocks: list[Block] = []
    if model.measured:
        names = listed(tuple(name_layout(name) for name in model.measured))
        weighed = ", weighed by the standard deviations of their encoders" if model.deviations else ""
        blocks.append(paragraph(f"Measured are {{}}; the other coordinates are found from these{weighed}.", names))
    if model.task:
        equations = tuple(equation(name_layout(x.name), expression_layout(x.expression)) for x in model.task)
        one = len(model.task) == 1
        blocks += [
            paragraph(f"Motions are planned in {'this coordinate' if one else 'these coordinates'} of a task:"),
            displayed(equations, "task"),
            paragraph(
                f"{'Its rate is' if one else 'Their rates are'} {{}}, with the derivatives by the coordinates",
                equals(SYMBOLS["task_velocity"], juxtaposed(SYMBOLS["task_jacobian"], qd)),
            ),
            *context.quantity("task_jacobian", "Jx"),
        ]
        blocks += _least_motion(model)
    return blocks


def _least_motion(model: Model) -> list[Block]:
    """What is taken of the motions that a task leaves open."""
    if not model.task_leaves.rates or model.task_leaves.idle:
        return []
    quantities = ("velocity_from_task", "acceleration_from_task", "task_nullspace_projector")
    return [
        paragraph(
            f"This leaves {directions(model.task_leaves.rates)} open. Of all rates with which the constraints hold and "
            f"the task moves as it shall, {{}} are the least, {norm_of_motions(model)}; {{}} are the accelerations of "
            "the motion that has these rates, and {} projects onto the rates that leave the task still.",
            *(SYMBOLS[name] for name in quantities),
        )
    ]


def _inputs(context: Context) -> list[Block]:
    model = context.model
    if not model.inputs:
        return [paragraph("There are no inputs, {}.", equals(small_m, ZERO))]
    rows = tuple(
        (
            (InlineMath(name_layout(i.name)),),
            (InlineCode(i.name),),
            say("{}", unit_text(i.unit)),
            say("{}", text_of(i.description) or "–"),
            (InlineMath(_virtual_power(i)),),
        )
        for i in model.inputs
    )
    return [
        paragraph(
            "The inputs {}, {}, are given by their virtual power: the coefficient of a rate is the generalized "
            "force per "
            "unit of the input.",
            u,
            equals(small_m, number(model.m)),
        ),
        Table((say("Symbol"), say("Name"), say("Unit"), say("Meaning"), say("Power per unit")), rows, (0, 0, 0, 1, 0)),
    ]


def _virtual_power(control: Input) -> Layout:
    if control.velocity is not None:
        return expression_layout(control.velocity)
    terms = []
    for coordinate, coefficient in control.acts_on:
        sign, factor = signed(expression_layout(coefficient))
        rate = name_layout(f"{coordinate}_dot")
        terms.append((sign, rate if factor == ONE else product([factor, rate])))
    return Sum(tuple(terms)) if terms else ZERO


def _applied_forces(context: Context) -> list[Block]:
    forces = context.model.applied_forces
    elements = _force_elements(context)
    if not forces:
        return elements
    equations = tuple(
        equation(_component(name_layout(force.coordinate)), expression_layout(force.expression)) for force in forces
    )
    return [
        paragraph("Further generalized forces {}, damping for example, stand on the right-hand side:", Qa),
        displayed(equations),
        *elements,
    ]


def _force_elements(context: Context) -> list[Block]:
    if not context.model.forces:
        return []
    rows = tuple(
        (
            (InlineCode(force.name),),
            (InlineMath(expression_layout(force.magnitude)),),
            (InlineMath(expression_layout(force.velocity)),),
        )
        for force in context.model.forces
    )
    intro = "Dampers, friction and given forces act with a magnitude each, and work on a rate:"
    return [paragraph(intro), Table((say("Name"), say("Magnitude"), say("Rate")), rows, (0, 1, 1))]


def _component(index: Layout) -> Layout:
    """The component of the applied force at a coordinate."""
    return Scripts(Q, Row((Letter("a"), Punctuation(","), index)))
