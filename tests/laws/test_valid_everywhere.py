"""u, accelerations and multipliers at every regular configuration: no chosen coordinates, columns or rows."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from math import acos, atan2, cos, hypot, pi, sin

import pytest
from laws_harness import System, shipped_system

from symgen.ir.kernel import Status

NAMES = ("inverse_dynamics", "forward_dynamics", "multipliers")
EVEN = (1.0, 1.0, 1.0)


def manipulator() -> System:
    return shipped_system("rapkm_2rrr_rr")


def pose(given: System, x: float, y: float, elbows: Sequence[float]) -> list[float] | None:
    """The joint angles that put the tip at (x, y); None out of reach."""
    values = given.state([0.0] * 6).parameters
    p = dict(zip((parameter.name for parameter in given.model.parameters), values, strict=True))
    l_1, l_2 = p["l_1"], p["l_2"]
    bases, bends = [], []
    for i, sign in enumerate(elbows, 1):
        dx, dy = x - p[f"x_{i}"], y - p[f"y_{i}"]
        reach = hypot(dx, dy)
        cosine = (reach**2 - l_1**2 - l_2**2) / (2 * l_1 * l_2)
        if abs(cosine) > 1:
            return None
        bend = sign * acos(cosine)
        bases.append(atan2(dy, dx) - atan2(l_2 * sin(bend), l_1 + l_2 * cos(bend)))
        bends.append(bend)
    return [*bases, *bends]


def along_the_path(given: System, count: int) -> Iterator[list[float]]:
    """The paper's circle about the centroid, on which every pair of drives is singular twice (Fig. 6)."""
    for k in range(count):
        angle = 2 * pi * (k + 0.5) / count
        q = pose(given, 0.2 + 0.12 * cos(angle), 0.3464 / 3 + 0.12 * sin(angle), EVEN)
        assert q is not None
        yield q


def determinant(q: Sequence[float], first: int, second: int) -> float:
    """sin(b_k) sin(psi_i - psi_j) of the drives i and j, k the third: 0 where the pair alone is singular (theory 5)."""
    third = 3 - first - second
    psi = [q[i] + q[3 + i] for i in range(3)]
    return sin(q[3 + third]) * sin(psi[first] - psi[second])


@pytest.mark.parametrize("pair", [(0, 1), (0, 2), (1, 2)])
def test_where_a_pair_of_drives_is_singular(pair: tuple[int, int]) -> None:
    given = manipulator()
    sign_changes = 0
    path = list(along_the_path(given, 96))
    for left, right in zip(path, [*path[1:], path[0]], strict=True):
        values = [determinant(q, *pair) for q in (left, right)]
        if values[0] * values[1] < 0:
            q = _zero(left, right, pair)
            given.assert_right(given.state(q), NAMES)
            given.assert_right(given.state(q, scalar="float32"), NAMES, "float32")
            sign_changes += 1
    assert sign_changes == 2


def _zero(left: Sequence[float], right: Sequence[float], pair: tuple[int, int]) -> list[float]:
    """A configuration between two others where the pair's determinant is 0 but for rounding, by bisection."""
    low, high = 0.0, 1.0
    start = determinant(left, *pair)
    for _ in range(60):
        middle = (low + high) / 2
        q = [a + middle * ((b - a + pi) % (2 * pi) - pi) for a, b in zip(left, right, strict=True)]
        if determinant(q, *pair) * start > 0:
            low = middle
        else:
            high = middle
    assert abs(determinant(q, *pair)) < 1e-14
    return q


def test_at_random_configurations_and_elbows() -> None:
    given = manipulator()
    source = random.Random("everywhere")
    tried = 0
    while tried < 8:
        elbows = [source.choice((-1.0, 1.0)) for _ in range(3)]
        q = pose(given, source.uniform(0.0, 0.4), source.uniform(0.0, 0.35), elbows)
        if q is None:
            continue
        tried += 1
        rates = [source.uniform(-3, 3) for _ in range(6)]
        scalar = "float32" if tried % 2 else "float64"
        given.assert_right(given.state(q, rates, scalar=scalar), NAMES, scalar)


@pytest.mark.parametrize("arm", [0, 1, 2])
@pytest.mark.parametrize("gap", [0.0, 1e-7, 1e-3])
def test_near_a_stretched_arm(arm: int, gap: float) -> None:
    given = manipulator()
    x, y = ((0.0, 0.0), (0.4, 0.0), (0.2, 0.3464))[arm]
    # towards the centroid, as far as the arm reaches
    reach = 0.4 * cos(gap / 2)
    heading = atan2(0.3464 / 3 - y, 0.2 - x)
    q = pose(given, x + reach * cos(heading) * 0.9999999999, y + reach * sin(heading) * 0.9999999999, EVEN)
    assert q is not None
    q[3 + arm] = gap
    given.assert_right(given.state(q), NAMES)


@pytest.mark.parametrize("name", ["front_car", "skate"])
def test_cars_at_the_singularities_of_their_parametrisations(name: str) -> None:
    given = shipped_system(name)
    n = len(given.model.coordinates)
    names = [*NAMES, "nullspace_projector", "projected_control_pseudoinverse"]
    for theta in (0.0, pi / 2, pi):
        for phi in (0.0, 0.4, pi / 2):
            q = [theta, 0.5, 0.3] if n == 3 else [0.2, -0.3, theta, phi]
            for scalar in ("float64", "float32"):
                given.assert_right(given.state(q, scalar=scalar), names, scalar)


def test_independent_velocities_bound_only_what_they_name() -> None:
    given = shipped_system("front_car")
    across = given.state([0.2, -0.3, pi / 2, 0.3])  # x does not determine the motion here
    assert given.run("orthogonal_complement", across)[0] is Status.CONSTRAINT_RANK
    given.assert_right(across, ["nullspace_projector", "inverse_dynamics", "forward_dynamics", "multipliers"])
