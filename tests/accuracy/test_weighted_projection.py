"""B_G^+ and N_{B,G} as accelerations: right where masses are far apart, joints relative, rows dependent."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import pytest

from symgen.lowering.schedule import schedule
from symgen.mechanics.genericity import genericity
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.alternatives import Alternatives
from symgen.verify.expected import Expected
from symgen.verify.interpreted import measured
from symgen.verify.tolerance import FACTOR

QUANTITIES = ("weighted_pseudoinverse", "weighted_nullspace_projector")


def hanging_chain() -> Model:
    """Links that carry points of mass, each relative to the one before, between a trolley and the wall."""
    links = 4
    lines = ["model: hanging_chain", "joints:", "  trolley: {type: prismatic, axis: x, coordinate: x}"]
    parent, at = "trolley", ""
    for k in range(1, links + 1):
        lines.append(f"  link{k}: {{type: revolute, parent: {parent}, axis: y{at}, coordinate: a{k}}}")
        parent, at = f"link{k}", ", at: [0.3, 0, 0]"
    lines += ["bodies:", "  trolley: {mass: 20}"]
    lines += [f"  link{k}: {{mass: {0.3 / k**3:.3g}, com: [0.15, 0, 0]}}" for k in range(1, links + 1)]
    lines += ["points:", f"  end: {{frame: link{links}, at: [0.3, 0, 0]}}", "  wall: {at: [0.9, 0, 0]}"]
    lines += ["loops:", "  close: {type: point, between: [end, wall]}"]
    lines += ["configuration: {x: 0, a1: 0.7, a2: -0.5, a3: -0.4, a4: -0.3}", ""]
    return load_text("\n".join(lines), "hanging_chain.yaml")


def beam_on_three_cranks() -> Model:
    """Six rows of rank five."""
    rows = []
    for name, offset in (("a", "-c"), ("b", "0"), ("d", "c")):
        rows += [f"l*cos({name}) + ({offset}) - x - ({offset})*cos(p)", f"l*sin({name}) - y - ({offset})*sin(p)"]
    lines = ["model: beam", "coordinates: {a: {unit: rad}, b: {unit: rad}, d: {unit: rad}, x: , y: , p: {unit: rad}}"]
    lines += ["parameters: {l: 1, c: 3/2, J: 0.001, m: 3}"]
    lines += ["kinetic_energy: J/2*(a_dot**2 + b_dot**2 + d_dot**2) + m/2*(x_dot**2 + y_dot**2 + c**2/3*p_dot**2)"]
    lines += ["constraints:", "  geometric:", *(f"    row_{k}: {row}" for k, row in enumerate(rows))]
    lines += ["configuration: {a: 0.9, b: 0.9, d: 0.9, x: 0.62, y: 0.78, p: 0}", ""]
    return load_text("\n".join(lines), "beam.yaml")


@cache
def given(make: Callable[[], Model]) -> tuple[Alternatives, Expected]:
    model = make()
    return Alternatives(model, genericity(System(model)), None), Expected(model, QUANTITIES, 16, lambda _: None)


@pytest.mark.campaign
@pytest.mark.slow
@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize("make", [hanging_chain, beam_on_three_cranks])
def test_within_what_verification_allows(make: Callable[[], Model], quantity: str) -> None:
    others, expected = given(make)
    made = others.named(quantity, "schur_qr")
    assert made is not None
    for scalar, program in schedule(made.mechanics, [made.derived], ("float64", "float32")).items():
        record, fault = measured(program.kernels[0], program.sincos, scalar, expected)
        assert fault is None
        assert record.largest <= FACTOR


def test_missing_where_a_coordinate_has_no_mass() -> None:
    model = load_text(
        """
model: massless
coordinates: {x: {}, y: {}}
kinetic_energy: x_dot**2/2
constraints: {geometric: {row: x - y**3 - y}}
""",
        "massless.yaml",
    )
    assert Alternatives(model, genericity(System(model)), None).named(QUANTITIES[0], "schur_qr") is None
