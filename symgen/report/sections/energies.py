"""The energies: as the file writes them, and of bodies and rotors as sums over their tables."""

from __future__ import annotations

from symgen.model.model import Model
from symgen.report.document import Block, displayed
from symgen.report.mathematics.from_expression import expression_layout
from symgen.report.mathematics.layout import (
    Accent,
    Fenced,
    Fraction,
    Layout,
    Letter,
    Numeral,
    Scripts,
    Sum,
    equation,
    minus,
    total,
)
from symgen.report.prose import ONE, ZERO, T, U, bold, equals, juxtaposed, paragraph, transposed
from symgen.report.sections.bodies import GRAVITY, weighs

BODY, ROTOR = Letter("b"), Letter("i")
MASS, INERTIA, TURNING = (Scripts(letter, BODY) for letter in (Letter("m"), bold("J"), bold("ω")))
PLACE, SPEED = Scripts(bold("p"), BODY), Scripts(Accent(bold("p"), "dot"), BODY)
HALF = Fraction(ONE, Numeral("2"))


def energies(model: Model) -> list[Block]:
    """T and U."""
    if model.mechanism.has_mass:
        return _of_bodies(model)
    potential = expression_layout(model.potential_energy)
    blocks: list[Block] = [
        paragraph("The kinetic energy is quadratic in the rates:"),
        displayed((equation(T, expression_layout(model.kinetic_energy)),), "T"),
    ]
    if potential == ZERO:
        blocks.append(paragraph("There is no potential energy, {}.", equals(U, ZERO)))
    else:
        blocks += [paragraph("The potential energy is"), displayed((equation(U, potential),), "U")]
    return blocks


def _of_bodies(model: Model) -> list[Block]:
    kinetic, potential = _kinetic(model), _potential(model)
    equations = [equation(T, kinetic), equation(U, potential)]
    said = "The kernels come from a recursion that never writes the energies out. They are sums"
    slots: list[Layout] = []
    if model.mechanism.bodies:
        said += (
            " over the bodies {}, whose centres of mass are at {} in the world and which turn with the angular "
            "velocity {}, its components along the axes of their inertia {}"
        )
        slots += [BODY, PLACE, TURNING, INERTIA]
    if model.mechanism.rotor_inertias:
        said += f"{', and' if slots else ''} over the rotors by their coordinates {{}}"
        slots.append(ROTOR)
    return [paragraph(f"{said}:", *slots), displayed(tuple(equations), "T")]


def _kinetic(model: Model) -> Layout:
    parts: list[Layout] = []
    if model.mechanism.bodies:
        moving = juxtaposed(MASS, transposed(SPEED), SPEED)
        turning = juxtaposed(transposed(TURNING), INERTIA, TURNING)
        parts.append(juxtaposed(HALF, _over(BODY), Fenced(Sum((("+", moving), ("+", turning))))))
    if model.mechanism.rotor_inertias:
        rate = Scripts(Accent(Letter("q"), "dot"), ROTOR, Numeral("2"))
        parts.append(juxtaposed(HALF, _over(ROTOR), Scripts(Letter("J"), ROTOR), rate))
    return _with(parts, expression_layout(model.kinetic_energy))


def _potential(model: Model) -> Layout:
    parts: list[Layout] = []
    if model.mechanism.bodies and weighs(model.mechanism):
        parts.append(minus(juxtaposed(_over(BODY), MASS, transposed(GRAVITY), PLACE)))
    return _with(parts, expression_layout(model.potential_energy))


def _with(parts: list[Layout], written: Layout) -> Layout:
    """The sum of the parts and what the file writes."""
    terms = (*parts, *(() if written == ZERO else (written,)))
    return total(terms) if terms else ZERO


def _over(index: Letter) -> Layout:
    return Scripts(Letter("Σ", "upright"), index)
