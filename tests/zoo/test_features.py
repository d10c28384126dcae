"""Everything that the zoo is there to draw is drawn, by few enough draws that a campaign meets it."""

from __future__ import annotations

from collections import Counter

import pytest

from symgen.laboratory.zoo.draws.describe import Description
from symgen.laboratory.zoo.draws.families import draw
from symgen.laboratory.zoo.features import ALL, features

DRAWS, LEAST = 500, 1


@pytest.mark.campaign
def test_nothing_is_missing() -> None:
    count: Counter[str] = Counter()
    for index in range(DRAWS):
        count.update(features(draw(50, index)))
        if all(count[feature] >= LEAST for feature in ALL):
            break
    assert set(count) <= set(ALL)
    assert {feature: count[feature] for feature in ALL if count[feature] < LEAST} == {}


def test_what_is_counted_is_read_from_the_file() -> None:
    blocks = {
        "model": "zoo",
        "coordinates": {"x": {"unit": "m"}, "INPUT": {"unit": "rad"}, "s": {"unit": "m"}},
        "parameters": {"m": "1e3", "k": "1e-6", "o": {"value": "0", "range": ["0", "1"]}},
        "kinetic_energy": "m/2*x_dot**2 + INPUT_dot**2/2",
        "potential_energy": "k*atan2(x, 3)",
        "constraints": {"geometric": {"first": "x - s", "second": "1e-6*(s - x)"}},
        "inputs": {"u": {"acts_on": {"x": "cos(INPUT)", "INPUT": "1"}}, "v": {"acts_on": {"x": "0"}}},
        "outputs": ["inverse_dynamics"],
    }
    assert features(Description("", blocks, {"x": 0.1, "INPUT": 0.2, "s": 0.1})) == {
        "energies", "3 coordinates", "rows that depend on each other", "row times 1e-6", "underactuated",
        "input that others replace", "input that moves nothing", "M depends on q", "coordinate without mass",
        "atan2 in a potential", "parameter that is zero", "parameters 1e9 apart", "parameter with a range",
        "names that hurt in Arduino", "outputs chosen at random", "start left out",
    }  # fmt: skip
