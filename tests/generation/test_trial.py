"""Kernels are tried before C is made of them: what is rejected takes another method, and C is written once."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from symgen.backends.backend import Variant
from symgen.backends.c import backend
from symgen.backends.c.plain import emit_c
from symgen.diagnostics import ModelError
from symgen.generation import states
from symgen.generation.results import Options, Result
from symgen.ir.kernel import Program
from symgen.methods.quantity import Quantity
from symgen.model.model import Model
from symgen.pipeline import generate
from symgen.quantities import candidates
from symgen.verify.sampling.states import VerificationError

# A ladder slides down between a wall and the ground.
LADDER = """
model: ladder
coordinates:
  x: {unit: m}
  y: {unit: m}
  a: {unit: rad, range: [0.3, 1.2]}
parameters:
  l: {value: 2.5, unit: m, range: [2, 3]}
  m: {value: 9, unit: kg, range: [6, 12]}
  J: {value: 4, unit: kg*m**2, range: [3, 5]}
  g: {value: 9.81, unit: m/s**2}
kinetic_energy: m/2*(x_dot**2 + y_dot**2) + J/2*a_dot**2
potential_energy: m*g*y
constraints:
  geometric:
    foot: x*sin(a) - y*cos(a)
    middle: x*cos(a) + y*sin(a) - l/2
inputs:
  push: {unit: N, acts_on: {x: 1}}
configuration: {x: 0.96, y: 0.8, a: 0.69}
outputs: [inverse_dynamics, forward_dynamics, multipliers, energy]
"""
OPTIONS = Options(parts=("c", "python"), states=8)


@pytest.fixture
def ladder(tmp_path: Path, tool: Callable[[str], str]) -> Path:
    tool("cc")
    path = tmp_path / "ladder.yaml"
    path.write_text(LADDER, encoding="utf-8")
    return path


@pytest.fixture
def written(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The scalar types C was written in."""
    made: list[str] = []

    def noted(model: Model, program: Program) -> dict[str, str]:
        made.append(program.scalar)
        return emit_c(model, program)

    variants = Variant(noted), *backend.BACKEND.variants[1:]
    monkeypatch.setattr(backend, "BACKEND", replace(backend.BACKEND, variants=variants))
    return made


def _spoil(monkeypatch: pytest.MonkeyPatch, factor: Fraction) -> None:
    """λ of the method that selection takes by itself times 1 + factor (cosh^2 - sinh^2 - 1), which loses digits."""
    derived_from = candidates.derived_from

    def worse(entry: Any, along: Any, outputs: Any, guards: Any) -> Quantity:
        if entry.name == "multipliers":
            graph = along.graph
            cosh, sinh = (graph.raw(name, (graph.symbol("a"),)) for name in ("cosh", "sinh"))
            squares = graph.raw("sub", (graph.raw("mul", (cosh, cosh)), graph.raw("mul", (sinh, sinh))))
            lost = graph.raw("mul", (graph.const(factor), graph.raw("sub", (squares, graph.one))))
            outputs = tuple(graph.raw("add", (x, graph.raw("mul", (x, lost)))) for x in outputs)
        return derived_from(entry, along, outputs, guards)

    monkeypatch.setattr(candidates, "derived_from", worse)


def _made(path: Path) -> Result:
    return generate(path, OPTIONS, lambda _: None)


@pytest.mark.parametrize("factor", [pytest.param(Fraction(0), marks=pytest.mark.campaign), Fraction(2**21)])
def test_what_is_rejected_is_never_written(
    factor: Fraction, ladder: Path, written: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    _spoil(monkeypatch, factor)
    made = _made(ladder)
    assert written == ["float64", "float32"]
    rejected = json.loads(made.files["derivation.json"]).get("rejected", [])
    assert [one["quantity"] for one in rejected] == (["multipliers"] if factor else [])
    assert not made.failures
    assert all("cosh" not in text for path, text in made.files.items() if path.startswith("c/") and factor)


def test_what_has_no_states_is_told_before_anything_is_written(
    ladder: Path, written: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def nothing(*_: object) -> None:
        raise VerificationError("ladder: only 3 regular configurations were found; give wider ranges")

    monkeypatch.setattr(states, "Expected", nothing)
    with pytest.raises(ModelError, match="only 3 regular configurations"):
        _made(ladder)
    assert not written
