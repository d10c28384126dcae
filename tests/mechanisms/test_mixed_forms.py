"""Energies written out and bodies in one model: they add up to the same machine."""

from __future__ import annotations

from functools import cache

import pytest
from shipped import ROOT

from symgen.mechanics.system import System
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_model, load_text
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.verify.reference.reference import Reference, State

BODIES = ROOT / "models" / "front_car_bodies.yaml"
VALUES = {
    "x": 1.0, "y": -2.0, "theta": 0.7, "phi": 0.4, "x_dot": 3.0, "y_dot": 1.0, "theta_dot": -0.5, "phi_dot": 0.8,
    "x_ddot": -1.0, "y_ddot": 2.0, "theta_ddot": 0.3, "phi_ddot": -2.0, "K_f": 100.0, "T": 5.0,
}  # fmt: skip


@cache
def mixed() -> Model:
    """The car whose chassis is a body and whose wheelset is an energy of the point that it sits at."""
    text = BODIES.read_text(encoding="utf-8")
    wheelset, rotor = "  wheels:  {mass: m_2}\n", "rotor_inertias: {phi: Theta_2}"
    assert wheelset in text
    assert rotor in text
    energy = "kinetic_energy: m_2/2*(wheels.vx**2 + wheels.vy**2) + Theta_2/2*phi_dot**2\npotential_energy: 0*m_2\n"
    text = text.replace(wheelset, "").replace(rotor, "#").replace("gravity:", f"{energy}gravity:", 1)
    return load_text(text, "mixed.yaml")


def test_both_references_agree() -> None:
    models = mixed(), load_model(ROOT / "models" / "front_car.yaml")
    assert mixed().mechanism.has_mass
    coordinates = mixed().coordinates
    q, qd = tuple(VALUES[c.name] for c in coordinates), tuple(VALUES[c.rate] for c in coordinates)
    qdd = tuple(VALUES[c.acceleration] for c in coordinates)
    state = State(q, qd, qdd, (100, 5), tuple(default_values(mixed().parameters).values()))
    names = ["mass_matrix", "coriolis_matrix", "inverse_dynamics", "forward_dynamics", "multipliers"]
    one, other = (Reference(model).matrices(state, names) for model in models)
    for name in names:
        size = max(abs(float(x)) for x in other[name].entries())
        assert all(abs(float(x)) <= 1e-40 * size for x in (one[name] - other[name]).entries()), name


def test_both_derivations_agree() -> None:
    values = default_values(mixed().parameters) | VALUES
    by_form = [
        {one.name: Evaluator(one.outputs)(values) for one in derive_quantities(model, model.outputs).quantities}
        for model in (mixed(), load_model(BODIES))
    ]
    assert by_form[0].keys() == by_form[1].keys()
    for name, expected in by_form[1].items():
        assert by_form[0][name] == pytest.approx(expected, rel=1e-11), name
    balance = Evaluator(System(mixed()).balance)(values)
    assert balance == pytest.approx(Evaluator(System(load_model(BODIES)).balance)(values), rel=1e-12)
