"""What all entries have in common is left out of them exactly, however many parameters it consists of."""

from __future__ import annotations

import random

import pytest

from symgen.mechanics.never_zero import Definite
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.symbolic.identity import every_identity_evaluated, same_values
from symgen.symbolic.products import MOST_FACTORS
from symgen.symbolic.scalar import Scalar

LENGTHS = [f"l_{i}" for i in range(MOST_FACTORS)]
RANGES = ", ".join(f"{name}: {{value: 1, range: [0.5, 2]}}" for name in LENGTHS)
SLIDER = f"""model: slider
parameters: {{m: {{value: 1}}, r: {{value: 1}}, k: {{value: 1}}, {RANGES}}}
coordinates: {{x: {{unit: m}}, a: {{unit: rad}}}}
kinetic_energy: m*(x_dot**2 + r**2*a_dot**2)
inputs: {{push: {{acts_on: {{x: 1}}}}}}
outputs: [inverse_dynamics]
"""
DRAWS = 200


def _definite() -> tuple[Definite, System]:
    system = System(load_text(SLIDER, "slider.yaml"))
    return Definite(system), system


@pytest.mark.campaign
def test_entries_are_their_content_times_the_rest() -> None:
    shared = 0
    for seed in range(DRAWS):
        (definite, system), draw = _definite(), random.Random(seed)
        graph, a, k = system.graph, system.q[1], system.graph.symbol("k")
        lengths = [graph.symbol(name) for name in LENGTHS[:4]]
        total = lengths[0] + lengths[1] * lengths[2]
        factors = [*lengths, total, k, a, lengths[0] - 3, graph.trig("sin", a)]
        common = [draw.choice(factors) for _ in range(3)]
        entries = []
        for _ in range(3):
            own = [draw.choice(factors) for _ in range(2)]
            entry = graph.product(draw.sample([*common, *own], 5)) * draw.choice((1, -1, 3))
            entries.append(entry / draw.choice(factors) if draw.random() < 0.4 else entry)
        content = definite.content(entries)
        rest = [definite.without(entry, content) for entry in entries]
        divisor = draw.choice([*lengths, total])
        with every_identity_evaluated():
            same_values("leaving out", entries, [graph.raw("mul", (content, x)) for x in rest])
            ratios = [definite.ratio(entry, divisor) for entry in entries]
            same_values("dividing", entries, [graph.raw("mul", (divisor, x)) for x in ratios])
        shared += not content.is_one
    assert shared > DRAWS // 4


def test_a_content_of_many_squares_is_divided_by_too() -> None:
    """As a product it has more factors than are taken apart."""
    definite, system = _definite()
    graph = system.graph
    lengths = [graph.symbol(name) for name in LENGTHS]
    left, right = graph.product(lengths[:6]), graph.product(lengths[6:])
    entries: list[Scalar] = [left * lengths[0] * left * (right * right), left * left * (right * lengths[7] * right)]
    content = definite.content(entries)
    assert [definite.without(entry, content) for entry in entries] == [lengths[0], lengths[7]]
