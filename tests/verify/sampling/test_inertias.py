"""States all but without the inertia of a direction judge no kernel that divides by masses."""

from __future__ import annotations

import pytest

from symgen.model.load import load_text
from symgen.verify.reference.reference import Reference, State
from symgen.verify.sampling.inertias import NEEDED, Inertias

# A bead on a rod that turns: about the pivot it has no inertia.
BEAD = """
model: bead
coordinates:
  x: {unit: m}
  a: {unit: rad}
  b: {unit: rad}
parameters: {m: 2}
kinetic_energy: m/2*(x_dot**2 + x**2*a_dot**2) + b_dot**2
potential_energy: 0
constraints:
  nonholonomic:
    together: b_dot - 0*a_dot
inputs: {push: {acts_on: {x: 1}}}
"""
FAR, NEAR, NEXT = 0.7, 0.01, 1e-4


def _share(reference: Reference, inertias: Inertias, x: float) -> float:
    state = State((x, 0.3, 0.2), (0.0,) * 3, (0.0,) * 3, (0.0,), (2.0,))
    return inertias.share(reference.matrices(state, NEEDED))


@pytest.mark.parametrize("quantity", ["forward_dynamics", "weighted_pseudoinverse"])
def test_what_is_next_to_no_inertia_is_told_from_little_of_it(quantity: str) -> None:
    reference = Reference(load_text(BEAD, "bead.yaml"))
    inertias = Inertias(reference, (quantity, "energy"))
    assert inertias.names == NEEDED
    assert _share(reference, inertias, FAR) == pytest.approx(FAR**2)
    assert inertias.is_regular(_share(reference, inertias, NEAR))
    assert not inertias.is_regular(_share(reference, inertias, NEXT))


def test_what_divides_by_no_mass_is_judged_anywhere() -> None:
    reference = Reference(load_text(BEAD, "bead.yaml"))
    inertias = Inertias(reference, ("inverse_dynamics", "projected_mass_matrix"))
    assert inertias.names == ()
    assert inertias.is_regular(_share(reference, inertias, 0.0))
