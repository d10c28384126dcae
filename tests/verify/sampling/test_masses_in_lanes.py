"""Inertias along what rows leave free, at many states at once, and states that are led to where one vanishes."""

from __future__ import annotations

import numpy as np
import pytest

from symgen.model.load import load_text
from symgen.verify.lanes.loops_in_lanes import LoopsInLanes
from symgen.verify.lanes.masses_in_lanes import MassesInLanes
from symgen.verify.reference.reference import Reference, State
from symgen.verify.sampling.nearby import Surroundings
from symgen.verify.sampling.states import sample_states

# A disc that rolls: lying flat, its heading and its spin are turns about one axis.
DISC = """
model: disc
coordinates: {x: {}, y: {}, z: {}, heading: {unit: rad}, lean: {unit: rad}, spin: {unit: rad}}
parameters: {R: {value: 0.28}, m: {value: 6.7}}
gravity: [0, 0, -9.81]
frames: {disc: {translation: [x, y, z], rotation: [[z, heading], [x, lean], [y, spin]]}}
bodies: {disc: {mass: m, com: [0.01, 0, 0.02], inertia: {xx: m*R**2/4, yy: m*R**2/2, zz: m*R**2/4, xy: 0.003}}}
rolling: {ground: {frame: disc, radius: R}}
inputs: {u: {joint: spin}}
configuration: {z: 0.25, lean: 0.46}
outputs: [forward_dynamics]
"""
# Two masses beside each other, one by its energy and one as a body, where nothing is coupled.
APART = """
model: apart
coordinates: {a: {}, b: {}}
parameters: {m: {value: 2, range: [1, 3]}}
kinetic_energy: m/2*a_dot**2*(1 + a**2)
frames: {slide: {translation: [b, 0, 0]}}
bodies: {slide: {mass: 3*m}}
inputs: {u: {joint: a}}
"""


def in_lanes(reference: Reference) -> MassesInLanes:
    literals = [float(x) for x in reference.literals()]
    loops = LoopsInLanes(reference.system, literals)
    return MassesInLanes(reference.system, reference.ranks.constraints, loops, literals)


@pytest.mark.parametrize("text", [DISC, APART], ids=["disc", "apart"])
def test_shares_are_those_of_the_reference(text: str) -> None:
    reference = Reference(load_text(text, "model.yaml"))
    samples = sample_states(reference, ["forward_dynamics"], 8)
    q, p = (np.array([getattr(one.state, name) for one in samples], float) for name in ("q", "parameters"))
    for sample, share in zip(samples, in_lanes(reference).shares(q, p), strict=True):
        assert share == pytest.approx(by_definition(reference, sample.state), rel=1e-9)


def by_definition(reference: Reference, state: State) -> float:
    """Of N_B G N_B the least eigenvalue beside those of what is held, and the largest."""
    made = reference.matrices(state, ("mass_matrix", "nullspace_projector"))
    mass, projector = (np.array([[float(x) for x in row] for row in made[name].tolist()]) for name in made)
    sizes = np.linalg.eigvalsh(projector @ mass @ projector)[reference.ranks.constraints :]
    return float(sizes[0] / sizes[-1])


def test_states_are_led_to_where_a_direction_loses_its_mass() -> None:
    reference = Reference(load_text(DISC, "disc.yaml"))
    samples = sample_states(reference, ["forward_dynamics"], 16)
    around, masses = Surroundings(reference, samples), in_lanes(reference)
    usual = masses.shares(around.samples.parts["q"], around.samples.parts["p"]).max()
    states = around.towards_no_mass(128, [1e-12, 1e-12], 1e-12)
    shares = masses.shares(states.parts["q"], states.parts["p"]) / usual
    assert shares.min() >= 1e-12
    # some in each decade of the way
    for decade in range(2, 11):
        assert ((shares < 10.0**-decade) & (shares >= 10.0 ** (-decade - 2))).any(), decade
    flat = states.parts["q"][shares < 1e-8]
    assert np.abs(np.cos(flat[:, 4])).max() < 1e-3
    assert around.measures(states, together=True).min() > 1e-3


def test_where_a_direction_loses_its_mass_out_of_the_ranges_is_looked_at() -> None:
    """Lying flat, whatever the file says of how it leans: kernels answer there."""
    text = DISC.rstrip() + "\nranges: {lean: [0.2, 0.8]}\n"
    reference = Reference(load_text(text, "disc.yaml"))
    around, masses = Surroundings(reference, sample_states(reference, ["forward_dynamics"], 16)), in_lanes(reference)
    usual = masses.shares(around.samples.parts["q"], around.samples.parts["p"]).max()
    states = around.no_mass_out_of_ranges(128, [1e-12, 1e-12], 1e-12)
    lean = states.parts["q"][:, 4]
    assert ((lean < 0.2) | (lean > 0.8)).all()
    shares = masses.shares(states.parts["q"], states.parts["p"]) / usual
    assert 1e-12 <= shares.min() < 1e-4
    without = Reference(load_text(DISC, "disc.yaml"))
    around = Surroundings(without, sample_states(without, ["forward_dynamics"], 16))
    assert not len(around.no_mass_out_of_ranges(128, [1e-12, 1e-12], 1e-12))
