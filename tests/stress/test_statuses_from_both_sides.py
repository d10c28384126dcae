"""Every status from both sides, on every shipped model that can reach it (interface, section 4)."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import pytest
from shipped import NAMES, model, sparing
from test_families import reference

from symgen.generation.runnable import SCALARS, STRESSED, RunnableKernels, rounded_state
from symgen.ir.kernel import UNIT_ROUNDOFF, Scalar, Status
from symgen.laboratory.stress.variants.dimensions import parameter_dimensions
from symgen.verify.reference.reference import ReferenceValueError, State
from symgen.verify.sampling.states import sample_states
from symgen.verify.tolerance import FACTOR, expectations

STATES = 40
QUARTER = math.pi / 2
BITS = 384
GRADED = 1e-2
# where ranks can drop at all: arms in a line, cos phi = 0, the crank and the rod upright
CONSTRAINT = {"rapkm_2rrr_rr", "rapkm_two_drives"}
ACTUATION = {"rapkm_2rrr_rr", "rapkm_two_drives", "rear_car", "slider_crank"}


@pytest.fixture(scope="module", params=sparing(NAMES))
def kernels(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> RunnableKernels:
    name: str = request.param
    return RunnableKernels(model(name), tmp_path_factory.mktemp(name), STRESSED)


@cache
def regular(name: str) -> tuple[State, ...]:
    return tuple(sample.state for sample in sample_states(reference(name), (), 8))


def beside_special_angles(name: str) -> list[State]:
    """Configurations, mostly off V, at tiny distances from quarter turns, where determinants have their zeros."""
    source, states = random.Random(name), []
    for _ in range(STATES):
        given = source.choice(regular(name))
        d = 10 ** source.uniform(-16, -1) if source.random() < 0.8 else 0.0
        q = [
            source.randrange(-1, 3) * QUARTER + d * source.uniform(-1, 1) if c.is_angle and source.random() < 0.7 else x
            for x, c in zip(given.q, model(name).coordinates, strict=True)
        ]
        states.append(replace(given, q=tuple(q)))
    return states


@cache
def rows_of_one_size(name: str, state: State) -> bool:
    """Whether lengths are O(1), as the thresholds assume."""
    if model(name).r == 0:
        return True
    sizes = reference(name).matrices(state, ("constraint_jacobian",), BITS)["constraint_jacobian"]
    rows = [math.hypot(*(float(sizes[i, j]) for j in range(sizes.ncols()))) for i in range(sizes.nrows())]
    return min(rows) > GRADED * max(rows)


@cache
def both_measures(name: str, state: State) -> tuple[float, ...]:
    return tuple(float(x) for x in reference(name).matrices(state, ("singularity",), BITS)["singularity"].entries())


def measures(name: str, state: State, quantity: str) -> tuple[float, ...]:
    """What the rank of a kernel's result depends on."""
    ranks, sizes, both = reference(name).ranks, model(name), both_measures(name, state)
    driven = quantity == "inverse_dynamics" and ranks.actuation == sizes.n - ranks.constraints
    return both if driven else both[:1]


def units_off(name: str, state: State, quantity: str, scalar: Scalar, entries: Sequence[float]) -> float:
    """The error in units of what rounding the inputs and the result does to it."""
    expected = expectations(reference(name), state, (quantity,), scalar, "both sides")[quantity]
    return math.dist(entries, [float(x) for x in expected.value.entries()]) / expected.unit


@pytest.mark.parametrize("scalar", SCALARS)
def test_ranks_are_judged_as_the_exact_measures_do(kernels: RunnableKernels, scalar: Scalar) -> None:
    name, eps = kernels.model.name, float(UNIT_ROUNDOFF[scalar])
    low, high = (kernels.model.n * eps) ** 2, (1e3 * kernels.model.n * eps) ** 2
    for given in beside_special_angles(name):
        state = rounded_state(given, scalar)
        for quantity in kernels.names:
            outcome = kernels.run(quantity, state, scalar)
            try:
                smallest = min(measures(name, state, quantity))
            except ReferenceValueError:
                continue
            if smallest < low / 9:
                assert outcome.status != Status.OK, (quantity, state.q)
            elif smallest < low and outcome.status == Status.OK:
                # a few eps of rounding moved the measure across the threshold: what is returned has to be right
                assert units_off(name, state, quantity, scalar, outcome.entries) <= FACTOR, (quantity, state.q)
            if smallest > high and (quantity != "inverse_dynamics" or rows_of_one_size(name, state)):
                assert outcome.status == Status.OK, (quantity, state.q, Status(outcome.status))
            assert outcome.status != Status.OK or all(map(math.isfinite, outcome.entries))


def _line(name: str, code: Status) -> State | None:
    """A state exactly at a drop of rank; None for a model that has none."""
    given = regular(name)[0]
    angles = {
        # all links along one line; and the middle links parallel, which leaves the drives without effect
        ("rapkm_2rrr_rr", Status.CONSTRAINT_RANK): (0.4, 0.4, 0.4, 0.0, 0.0, 0.0),
        ("rapkm_two_drives", Status.CONSTRAINT_RANK): (0.4, 0.4, 0.4, 0.0, 0.0, 0.0),
        ("rapkm_2rrr_rr", Status.ACTUATION_RANK): (0.3, 0.9, -0.4, 0.7, 0.1, 1.4),
        ("rapkm_two_drives", Status.ACTUATION_RANK): (0.3, 0.9, -0.4, 0.7, 0.1, 0.0),
        ("rear_car", Status.ACTUATION_RANK): (0.0, 0.0, 0.3, QUARTER),
        ("slider_crank", Status.ACTUATION_RANK): (0.4, QUARTER, 0.3),
    }.get((name, code))
    return None if angles is None else replace(given, q=angles)


@pytest.mark.parametrize("code", [Status.CONSTRAINT_RANK, Status.ACTUATION_RANK])
@pytest.mark.parametrize("scalar", SCALARS)
def test_ranks_from_both_sides(kernels: RunnableKernels, scalar: Scalar, code: Status) -> None:
    name = kernels.model.name
    at = _line(name, code)
    assert (at is not None) == (name in (CONSTRAINT if code == Status.CONSTRAINT_RANK else ACTUATION))
    if at is None:
        return
    quantity = "inverse_dynamics" if code == Status.ACTUATION_RANK else "nullspace_projector"
    direction = random.Random(name)
    steps = [direction.choice((-1, 1)) * direction.uniform(0.5, 1) for _ in at.q]
    statuses = []
    for exponent in range(1, 22):
        q = tuple(x + 10.0**-exponent * step for x, step in zip(at.q, steps, strict=True))
        statuses.append(kernels.run(quantity, rounded_state(replace(at, q=q), scalar), scalar).status)
    assert statuses[0] == Status.OK
    assert statuses[-1] == code
    # once refused, refused all the way
    first = statuses.index(code)
    assert set(statuses[:first]) == {Status.OK}
    assert Status.OK not in statuses[first:]


@pytest.mark.parametrize("scalar", SCALARS)
def test_the_range_of_angles(kernels: RunnableKernels, scalar: Scalar) -> None:
    name, limit = kernels.model.name, {"float64": 1e5, "float32": 100.0}[scalar]
    given, reached = regular(name)[0], 0
    for i, coordinate in enumerate(kernels.model.coordinates):
        if not coordinate.is_angle:
            continue
        for quantity in kernels.names:
            statuses = []
            for value in (0.9 * limit - 3, 1.1 * limit + 3):
                q = tuple(value if j == i else x for j, x in enumerate(given.q))
                statuses.append(kernels.run(quantity, rounded_state(replace(given, q=q), scalar), scalar).status)
            assert statuses[0] != Status.ANGLE_RANGE
            # an angle that does not enter is not looked at
            assert statuses[1] in (Status.ANGLE_RANGE, Status.OK)
            reached += statuses[1] == Status.ANGLE_RANGE
    assert reached > 0 or name == "skate"


@pytest.mark.parametrize("scalar", SCALARS)
def test_no_mass_and_little_mass(kernels: RunnableKernels, scalar: Scalar) -> None:
    given = regular(kernels.model.name)[0]
    heavy = [d is not None and d[0] == 1 and d[2] == 0 for d in parameter_dimensions(kernels.model)]
    for quantity in ("forward_dynamics", "multipliers"):
        if quantity not in kernels.names:
            continue
        for factor, wanted in ((1.0, Status.OK), (1e-6, Status.OK), (0.0, Status.MASS_RANK)):
            scaled = tuple(x * factor if is_mass else x for x, is_mass in zip(given.parameters, heavy, strict=True))
            outcome = kernels.run(quantity, rounded_state(replace(given, parameters=scaled), scalar), scalar)
            assert outcome.status == wanted or (quantity, factor) == ("multipliers", 0.0), (quantity, factor)


@pytest.mark.parametrize("scalar", SCALARS)
def test_what_is_not_finite(kernels: RunnableKernels, scalar: Scalar) -> None:
    given = rounded_state(regular(kernels.model.name)[0], scalar)
    for quantity in kernels.names:
        assert kernels.run(quantity, given, scalar).status == Status.OK
    for rates in (math.nan, math.inf):
        state = replace(given, qd=(rates,) * kernels.model.n)
        status = kernels.run("forward_dynamics", state, scalar).status
        assert status == Status.NOT_FINITE or kernels.model.name == "skate"


