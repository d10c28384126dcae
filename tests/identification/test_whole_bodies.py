"""Full sets of parameters: bodies that can be, by integrals over masses and by conditions that an optimum has."""

from __future__ import annotations

import numpy as np
import pytest
from nearest_problems import IMPOSSIBLE, KNOWN_TO, base_of_text, estimate_of, problem_of, whole_of

from symgen.identification.arrays import Array
from symgen.identification.bodies.barrier import by_barrier
from symgen.identification.bodies.nearest_bodies import LEAST_EIGENVALUE, NearestBodies
from symgen.identification.bodies.pseudo_inertia import (
    about_centre,
    coordinates,
    nearest_possible,
    of_coordinates,
    pseudo_inertia,
    ten_parameters,
)
from symgen.identification.combinations import base_map
from symgen.identification.estimates.whole_bodies import AS_ESTIMATED, BY_BARRIER, BY_PROGRAM

# Of the cost, what is left to the optimum.
LEFT_OVER = 1e-7


def point_masses(seed: int, count: int = 9) -> tuple[Array, Array]:
    generator = np.random.default_rng(seed)
    return generator.uniform(0.1, 1, count), generator.uniform(-0.5, 1, (count, 3))


def ten_of_masses(masses: Array, places: Array) -> Array:
    """By the definitions of mass, first moments and moments of inertia."""
    x, y, z = places.T
    return np.array(
        [
            masses.sum(), *(masses @ places),
            masses @ (y**2 + z**2), masses @ (x**2 + z**2), masses @ (x**2 + y**2),
            -masses @ (x * y), -masses @ (x * z), -masses @ (y * z),
        ]
    )  # fmt: skip


@pytest.mark.parametrize("seed", range(3))
def test_a_pseudo_inertia_is_an_integral(seed: int) -> None:
    masses, places = point_masses(seed)
    ten = ten_of_masses(masses, places)
    matrix = pseudo_inertia(ten)
    lifted = np.column_stack([places, np.ones(len(masses))])
    assert np.allclose(matrix, lifted.T @ (masses[:, None] * lifted), atol=1e-14)
    assert np.allclose(ten_parameters(matrix), ten, atol=1e-14)
    assert np.allclose(of_coordinates(coordinates(matrix)), matrix, atol=1e-14)
    assert np.linalg.norm(coordinates(matrix)) == pytest.approx(np.linalg.norm(matrix))
    mass, centre, tensor = about_centre(ten)
    moved = ten_of_masses(masses, places - masses @ places / masses.sum())
    assert (mass, *centre) == pytest.approx((masses.sum(), *(masses @ places / masses.sum())))
    assert np.allclose([*np.diag(tensor), tensor[0, 1], tensor[0, 2], tensor[1, 2]], moved[4:], atol=1e-14)


def test_three_masses_lie_in_a_plane() -> None:
    """Their pseudo-inertia has an eigenvalue 0, and a smaller largest moment makes them impossible."""
    ten = ten_of_masses(*point_masses(5, 3))
    matrix = pseudo_inertia(ten)
    assert abs(np.linalg.eigvalsh(matrix)[0]) < 1e-14
    wrong = matrix - 0.01 * np.outer(*[np.linalg.eigh(matrix)[1][:, 0]] * 2)
    assert np.linalg.eigvalsh(wrong)[0] == pytest.approx(-0.01)
    # the nearest possible one is the plane again
    assert np.allclose(nearest_possible(wrong, 0.0), matrix, atol=1e-14)


def test_estimates_of_possible_bodies_stay() -> None:
    """Izz of a wheel from 0.52 to 0.6 can be: base parameters are the estimates, the rest is as in the file."""
    made = whole_of("wheel", {"hub.Izz": 0.08})
    assert made.method == AS_ESTIMATED
    assert made.at_edge == ()
    assert made.misfit < 0.01
    combined = base_map(base_of_text("wheel")) @ made.values
    assert np.allclose(combined, estimate_of("wheel", {"hub.Izz": 0.08}).values, rtol=1e-6, atol=1e-9)
    values = {one.element: value for one, value in zip(made.parameters, made.values, strict=True)}
    assert (values["m"], values["mz"]) == pytest.approx((2, 0))
    # Izz is Sxx + Syy: each takes half of what is new
    before = dict(zip((one.element for one in made.parameters), made.before, strict=True))
    assert values["Ixx"] - before["Ixx"] == pytest.approx(0.04, rel=1e-3)
    errors = {one.element: error for one, error in zip(made.parameters, made.errors, strict=True)}
    assert errors["Izz"] < 2 * KNOWN_TO
    assert errors["m"] == pytest.approx(2, rel=1e-3)


def test_what_no_wheel_has_is_mended() -> None:
    """An Izz of -0.2 becomes the least that the first moment allows, m x as it is known."""
    made = whole_of("wheel", {"hub.Izz": -0.72})
    assert made.method in (BY_PROGRAM, BY_BARRIER)
    assert made.at_edge == ("hub",)
    matrix = pseudo_inertia(made.values)
    assert np.linalg.eigvalsh(matrix)[0] > 0
    assert made.misfit > 10
    mass, _, tensor = about_centre(made.values)
    moments = np.linalg.eigvalsh(tensor)
    assert mass > 0
    assert moments[0] > 0
    assert moments[0] + moments[1] > moments[2]


@pytest.mark.parametrize(
    "case", [pytest.param(one, marks=pytest.mark.campaign if k else ()) for k, one in enumerate(IMPOSSIBLE)]
)
def test_no_other_bodies_are_nearer(case: str) -> None:
    """Slopes of the cost are matrices without negative eigenvalues, which vanish where bodies are inside.

    The problem is convex: what is left to the optimum is the sum of their products at most (Karush, Kuhn, Tucker).
    """
    problem = problem_of(*IMPOSSIBLE[case])
    assert np.any(problem.least(problem.centre) < 0)
    x = by_barrier(problem)
    assert np.all(problem.least(x) > 0)
    assert duality_gap(problem, x) < LEFT_OVER * (1 + problem.cost(x))


def duality_gap(problem: NearestBodies, x: Array) -> float:
    slopes = 2 * problem.factor.T @ problem.factor @ (x - problem.centre)
    scale = 1 + float(np.linalg.norm(slopes))
    gap = 0.0
    for k, matrix in enumerate(problem.pseudo_inertias(x)):
        slope = of_coordinates(slopes[10 * k : 10 * k + 10])
        assert np.linalg.eigvalsh(slope)[0] > -1e-6 * scale
        gap += float(np.sum(slope * (matrix - LEAST_EIGENVALUE * np.eye(4))))
    rotors = problem.fixed_sign
    assert np.all(slopes[rotors] > -1e-6 * scale)
    gap += float(slopes[rotors] @ (x[rotors] - LEAST_EIGENVALUE))
    assert np.all(np.abs(slopes[rotors.stop :]) < 1e-6 * scale)
    return gap


def test_bodies_in_the_plane_get_a_thickness() -> None:
    """A file in the plane gives one moment, which no body has alone: the nearest ones have the same base parameters."""
    made = whole_of("four_bar", {})
    for k in range(3):
        assert np.linalg.eigvalsh(pseudo_inertia(made.before[10 * k : 10 * k + 10]))[0] < 0
        assert np.linalg.eigvalsh(pseudo_inertia(made.values[10 * k : 10 * k + 10]))[0] > 0
    assert made.misfit < 0.01


def test_a_rotor_stays_positive() -> None:
    """The rotor and the hub share Izz: far below what the hub needs, both are at their edges."""
    made = whole_of("geared", {"a.Ir": -0.9})
    assert made.at_edge == ("hub", "a")
    assert made.values[-1] > 0
