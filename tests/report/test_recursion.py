"""The recursion that a report prints, read back term by term and evaluated, gives the loads of the reference."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import sympy
from report_inputs import MODELS, report_input

from symgen.closedform.frame_steps import frame_steps
from symgen.closedform.spelling import spell_expression
from symgen.model.load import load_model, load_text
from symgen.model.model import Model
from symgen.report import document
from symgen.report.context import Context
from symgen.report.document import Formula
from symgen.report.mathematics import matrices
from symgen.report.mathematics.layout import (
    Accent,
    Application,
    Array,
    Fenced,
    Fraction,
    Gap,
    Layout,
    Letter,
    Numeral,
    Product,
    Punctuation,
    Relation,
    Root,
    Row,
    Scripts,
    Sign,
    Sum,
)
from symgen.report.mathematics.names import name_layout
from symgen.report.sections.recursion import recursion
from symgen.verify.reference.reference import Reference, State

# Slides on a slanting rail and on a boom that turns, two bodies on one frame, a fixed frame, a ball joint, a rotor.
CRANE = """
model: crane
gravity: [0, 0, -9.81]
joints:
  rail: {type: prismatic, axis: [1, 0, 1], coordinate: s, child: trolley}
  mast: {type: revolute, axis: y, at: [0.1, h, 0.3], rotation: [[x, pi/3]], coordinate: a, parent: trolley, child: boom}
  reach: {type: prismatic, axis: x, coordinate: x, parent: boom, child: arm}
  ball: {type: spherical, at: [l, 0, 0.2], coordinates: [e0, e1, e2, e3], parent: arm, child: load}
frames:
  hook: {parent: load, translation: [0, 0, -0.4]}
bodies:
  trolley: {mass: 3}
  boom: {mass: m, com: [l/2, 0, 0], inertia: {xx: 0.1, yy: 0.3, zz: 0.2, xy: 0.02}}
  motor: {frame: boom, mass: 2, com: [0, 0.1, 0]}
  hook: {mass: 5, com: [0, 0.1, 0], inertia: {xx: 0.2, yy: 0.1, zz: 0.1, yz: 0.03}}
rotor_inertias: {s: 0.7}
parameters: {h: 0.2, l: 1.5, m: 4}
"""


def arm7() -> Model:
    return load_model(MODELS / "arm7.yaml")


def crane() -> Model:
    return load_text(CRANE, "crane.yaml")


@pytest.mark.parametrize("model", [arm7(), crane()], ids=lambda model: model.name)
def test_what_is_printed_gives_the_loads(model: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    printed = _PrintedRecursion(model, monkeypatch)
    source = random.Random(model.name)
    numbers = {p.name: float(spell_expression(p.value)) for p in model.parameters}
    kinds = [[getattr(c, kind) for c in model.coordinates] for kind in ("name", "rate", "acceleration")]
    numbers |= {name: source.uniform(-2, 2) for names in kinds for name in names}
    q, qd, qdd = (tuple(numbers[name] for name in names) for names in kinds)
    state = State(q, qd, qdd, (0.0,) * model.m, tuple(numbers[p.name] for p in model.parameters))
    named = ("mass_matrix", "coriolis_force", "potential_force")
    mass, coriolis, potential = (_floats(x) for x in Reference(model).precise(state, named).values())
    wanted = (mass @ np.array(qdd)[:, None] + coriolis + potential).ravel()
    assert printed.loads(numbers) == pytest.approx(wanted, rel=1e-12, abs=1e-12 * np.abs(wanted).max())


def test_frames_of_long_chains_are_not_all_printed() -> None:
    model = load_model(MODELS / "chain32.yaml")
    given = replace(report_input("five_bar"), model=model, frame_steps=frame_steps(model), forms={})
    text = repr(recursion(Context(given)))
    assert "The other 16 frames follow in the same way" in text
    assert "link_16" in text
    assert "link_17" not in text


def _floats(matrix: Any) -> Any:
    return np.array([[float(x) for x in row] for row in matrix.tolist()])


class _PrintedRecursion:
    """The displayed equations of a model's recursion, by what stands on their left."""

    def __init__(self, model: Model, monkeypatch: pytest.MonkeyPatch) -> None:
        for module in (document, matrices):
            monkeypatch.setattr(module, "ROOM", 1e9)  # no line is broken
        self.model, self.steps = model, frame_steps(model)
        given = replace(report_input("five_bar"), model=model, frame_steps=self.steps, forms={})
        formulas = [block for block in recursion(Context(given)) if isinstance(block, Formula)]
        self.equations = {left: right for formula in formulas[1:] for left, right in _equations(formula)}

    def loads(self, numbers: dict[str, float]) -> list[float]:
        """Every τ_i."""
        known = {name_layout(name): value for name, value in numbers.items()} | self._of_tables(numbers)
        return [self._value(Scripts(Letter("τ"), Numeral(str(i + 1))), known) for i in range(self.model.n)]

    def _of_tables(self, numbers: dict[str, float]) -> dict[Layout, Any]:
        """Centres of mass, inertias, gravity; and the derivatives of what is printed."""

        def at(expressions: Any) -> Any:
            return np.array([float(spell_expression(x).subs(numbers)) for x in expressions])

        known: dict[Layout, Any] = {Letter("g", "bold"): at(self.model.mechanism.gravity)}
        rates = [(c.name, c.rate) for c in self.model.coordinates] + [
            (c.rate, c.acceleration) for c in self.model.coordinates
        ]
        for step in self.steps:
            for body in step.bodies:
                index = (Numeral(str(step.number)),)
                if len(step.bodies) > 1:
                    index = (*index, Punctuation(","), Numeral(str(step.bodies.index(body) + 1)))
                lower = index[0] if len(index) == 1 else Row(index)
                known[Scripts(Letter("c", "bold"), lower)] = at(body.com)
                known[Scripts(Letter("J", "bold"), lower)] = np.array([at(row) for row in body.inertia.rows])
            for letter, vector, mark in (("ν", step.turning, "dot"), ("r", step.place_rate, "ddot")):
                changing = sum(
                    (vector.diff(sympy.Symbol(x)) * sympy.Symbol(y) for x, y in rates), sympy.zeros(3, 1)
                ).subs(numbers)
                known[Scripts(Accent(Letter(letter, "bold"), mark), Numeral(str(step.number)))] = np.array(
                    [float(x) for x in changing]
                )
        return known

    def _value(self, node: Layout, known: dict[Layout, Any]) -> Any:
        if node in known:
            return known[node]
        if node in self.equations:
            known[node] = self._value(self.equations[node], known)
            return known[node]
        match node:
            case Numeral(text=text):
                return float(text)
            case Scripts(base=base, lower=lower, upper=Letter("T", "upright")):
                return self._value(base if lower is None else Scripts(base, lower), known).T
            case Scripts(base=base, lower=lower, upper=Numeral(text=power)):
                return self._value(base if lower is None else Scripts(base, lower), known) ** int(power)
            case Fenced(body=Row(pieces=pieces)) if Punctuation(",") in pieces:
                return np.array([self._value(x, known) for x in pieces if x != Punctuation(",")])
            case Fenced(body=body):
                return self._value(body, known)
            case Fraction(numerator=above, denominator=below):
                return self._value(above, known) / self._value(below, known)
            case Root(radicand=radicand):
                return np.sqrt(self._value(radicand, known))
            case Application(function=Letter(text=name), argument=argument):
                return {"sin": np.sin, "cos": np.cos}[name](self._value(argument, known))
            case Array(rows=rows):
                return np.array([[self._value(x, known) for x in row] for row in rows])
            case Sum(terms=terms):
                return sum(self._value(x, known) * (1 if sign == "+" else -1) for sign, x in terms)
            case Product(factors=factors):
                product = self._value(factors[-1], known)
                for factor in factors[-2::-1]:
                    left = self._value(factor, known)
                    product = left @ product if np.ndim(left) == 2 else left * product
                return product
            case Row(pieces=(left, Relation("×"), right)):
                return np.cross(self._value(left, known), self._value(right, known))
            case Row(pieces=(left, Sign("·"), right)):
                return self._value(left, known) @ self._value(right, known)
            case Row(pieces=(inner,)):
                return self._value(inner, known)
        raise AssertionError(f"not printed: {node}")


def _equations(formula: Formula) -> Iterator[tuple[Layout, Layout]]:
    for (line,) in formula.equations:
        (whole,) = line.pieces
        pieces = whole.pieces if isinstance(whole, Row) and isinstance(whole.pieces[0], Row) else (whole,)
        for piece in pieces:
            if not isinstance(piece, (Punctuation, Gap)):
                left, _, right = piece.pieces
                yield left, right
