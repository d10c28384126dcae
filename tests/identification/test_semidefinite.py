"""CVXPY's semidefinite program and the barrier method of symgen come to the same bodies."""

from __future__ import annotations

import numpy as np
import pytest
import semidefinite_packages  # noqa: F401
from nearest_problems import IMPOSSIBLE, problem_of, whole_of

from symgen.identification.bodies.barrier import by_barrier
from symgen.identification.bodies.semidefinite import by_semidefinite_program
from symgen.identification.estimates.whole_bodies import BY_PROGRAM

# Of the cost, what both may differ by.
COST_DIGITS = 1e-7


@pytest.mark.parametrize("case", IMPOSSIBLE)
def test_both_ways_have_the_same_bodies(case: str) -> None:
    """Costs to seven digits, and unknowns as near to each other as such costs allow: they are squares of distances."""
    problem = problem_of(*IMPOSSIBLE[case])
    program, barrier = by_semidefinite_program(problem), by_barrier(problem)
    assert program is not None
    assert problem.least(program).min() > -1e-8
    cost = problem.cost(barrier)
    assert problem.cost(program) == pytest.approx(cost, rel=COST_DIGITS)
    assert np.linalg.norm(problem.factor @ (program - barrier)) < 2 * np.sqrt(COST_DIGITS * cost)


def test_it_is_taken_where_it_is_installed() -> None:
    assert whole_of("wheel", {"hub.Izz": -0.72}).method == BY_PROGRAM
