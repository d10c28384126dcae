"""Generic ranks where lengths of very different sizes meet."""

from __future__ import annotations

import pytest

from symgen.dynamics.genericity import genericity, rank
from symgen.dynamics.mechanics import Mechanics
from symgen.model.load import load_text

TINY = """
model: tiny
coordinates: {{x: {{}}, a: {{}}, b: {{}}}}
parameters: {{l: {length}}}
kinetic_energy: x_dot**2 + a_dot**2 + b_dot**2
constraints: {{geometric: {{first: x - l*sin(a), second: x - l*cos(b)}}}}
inputs: {{push: {{acts_on: {{x: 1}}}}}}
"""


@pytest.mark.parametrize("length", ["1", "1e-3", "1e-6"])
def test_ranks_do_not_depend_on_the_size_of_a_mechanism(length: str) -> None:
    generic = genericity(Mechanics(load_text(TINY.format(length=length), "tiny.yaml")))
    assert (generic.rank, generic.geometric_rank, generic.delta, generic.alpha) == (2, 2, 1, 1)


def test_a_rank_is_given_only_where_it_is_clear() -> None:
    assert rank([[1.0, 0.0], [1.0, 1e-3]]) == 2
    assert rank([[1.0, 0.0], [1.0, 1e-12]]) == 1
    assert rank([[1.0, 0.0], [1.0, 1e-7]]) is None
    assert rank([[1.0, 0.0], [1.0, 1e-7]], plain=1e-9) == 2
    assert rank([[0.0, 0.0]]) == 0
    assert rank([[float("nan"), 0.0]]) is None
    assert rank([]) == 0
