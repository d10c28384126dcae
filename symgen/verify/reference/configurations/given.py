"""What measured coordinates or a task determine, from its definition.

S has the derivatives of what is given by the coordinates; (S N)^+ is the least-squares solution among admissible rates.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from math import hypot
from typing import Any

from flint import arb, arb_mat

from symgen.verify.reference.arithmetic.linear import column, norm, right_pseudoinverse
from symgen.verify.reference.evaluation import Evaluation

# Seconds after which encoders are read, or a task is to be met.
MOMENT = 2.0**-10
# Steps that all digits usually take, and those at most: each leaves a share of what is missing, by which the encoders
# disagree.
USUAL_STEPS, MOST_NEWTON_STEPS = 8, 200
# Times by which steps grow shorter at first.
QUICK = 8.0
# Of the first step, a third one that is rounding alone.
NOTHING_LEFT = 2.0**-40
# Times as fast as what is given that other coordinates move at most: gears do by their ratio, and beyond that something
# moves where what is given stands still, as on a branch of its own.
FASTEST = 1e5


@dataclass(frozen=True)
class GivenValues:
    """What is given of functions of q: at a place their values and derivatives, how these turn along a velocity, and
    the values, rates and accelerations that they are to have."""

    at: Callable[[Sequence[Any]], tuple[Any, Any]]
    turning: Callable[[Any], Any]
    values: Any
    rates: Any
    accelerations: Any


def _measured(e: Evaluation) -> GivenValues:
    """A moment later, at rates and accelerations as they are."""
    model, n = e.system.model, e.system.n
    scales = [arb(scale.numerator) / scale.denominator for scale in model.measured_scales]
    scaled = zip(model.measured_places, scales, strict=True)
    selected = arb_mat([[scale * (place == j) for j in range(n)] for place, scale in scaled])
    still = arb_mat(selected.nrows(), n)
    return GivenValues(
        lambda q: (selected * column(q), selected),
        lambda _: still,
        selected * (column(e.q) + MOMENT * e.rate),
        selected * e.rate,
        selected * column(e.qdd),
    )


def _task(e: Evaluation) -> GivenValues:
    """Coordinates of the task that come with the state; its rates and accelerations are numbers that stand there."""
    rates, accelerations = (one.places for one in e.system.model.further_arguments if one.name in ("xd_t", "xdd_t"))
    return GivenValues(
        lambda q: e.system.task(q, e.parameters, e.literals),
        e.task_jacobian_dot,
        column(e.task),
        column([e.qd[k] for k in rates]),
        column([e.qdd[k] for k in accelerations]),
    )


def _inverse(e: Evaluation, given: GivenValues) -> Any:
    """(S N)^+, of the rank of N, or of S where that leaves directions open."""
    slopes = given.at(e.q)[1]
    return right_pseudoinverse(slopes * e.projector, min(slopes.nrows(), e.system.n - e.ranks.constraints))


def _velocity(e: Evaluation, given: GivenValues) -> Any:
    """The admissible rates that are nearest to those given, the least of them where directions stay open."""
    return _inverse(e, given) * given.rates


def _acceleration(e: Evaluation, given: GivenValues) -> Any:
    """The same of accelerations, at that velocity; where directions stay open, those of the least motion.

    These are d/dt A^+ y of A = [B; S], y = [0; x_dot]: the derivative of a pseudoinverse of constant rank (Golub and
    Pereyra, SIAM J. Numer. Anal. 10, 1973) adds (I - A^+ A) A_dot^T (A^+)^T q_dot to the least accelerations.
    """
    velocity, inverse = _velocity(e, given), _inverse(e, given)
    slopes, turning = given.at(e.q)[1], given.turning(velocity)
    least = -(e.inverse * e.motion(velocity)[1])
    nearest = least + inverse * (given.accelerations - turning * velocity - slopes * least)
    if slopes.nrows() >= e.system.n - e.ranks.constraints:
        return nearest
    by_task = inverse.transpose() * velocity
    drift = turning.transpose() * by_task
    if e.system.r:
        by_rows = e.inverse.transpose() * (velocity - slopes.transpose() * by_task)
        drift += e.constraints_dot(velocity).transpose() * by_rows
    return nearest + _still(e, given) * drift


def _still(e: Evaluation, given: GivenValues) -> Any:
    """The projector onto admissible rates that leave what is given still: (I - (S N)^+ S) N."""
    return e.projector - _inverse(e, given) * (given.at(e.q)[1] * e.projector)


def _configuration(e: Evaluation, given: GivenValues) -> Any:
    """By Gauss and Newton's method from q, until nothing moves by more than rounding may move it.

    Rows in units far apart lose digits, and steps never get shorter than these; balls hold what is lost.
    Raises ZeroDivisionError where its steps grow: q is not near what they lead to.
    """
    first, before = 0.0, 0.0
    for k, (q, length) in enumerate(islice(_places(e, given), MOST_NEWTON_STEPS)):
        if length <= hypot(*(float(x.rad()) for x in q.entries())):
            return q
        if k and length > max(before, first) / 2:
            break
        if _drifts(e, given, length, before, first):
            return q
        first, before = first or length, length
    raise ZeroDivisionError("the configuration is not near enough to one with what is given")


def _drifts(e: Evaluation, given: GivenValues, length: float, before: float, first: float) -> bool:
    """Whether steps are what the roundings of rows that depend on each other drive along directions that stay open.

    Moved by roundings such rows contradict each other: least steps then end in one of about the square of a rounding,
    along what neither rows nor the task hold, which is taken each time.  Before that each is far shorter than the last.
    """
    rank = e.ranks.geometric
    contradict = rank < e.system.r_geometric and given.values.nrows() < e.system.n - rank
    return contradict and before < 2 * length and length <= first * NOTHING_LEFT


def _places(e: Evaluation, given: GivenValues) -> Iterator[tuple[Any, float]]:
    """Where Gauss and Newton's steps lead, and how long they are."""
    q, n, rank = column(e.q), e.system.n, e.ranks.geometric
    while True:
        place = [x.mid() for x in q.entries()]
        values, slopes = given.at(place)
        residual, rows = e.system.geometry(place, e.parameters, e.literals)
        closing = right_pseudoinverse(rows, rank)
        least = -(closing * residual)
        moving = slopes - (slopes * closing) * rows
        inverse = right_pseudoinverse(moving, min(slopes.nrows(), n - rank))
        step = least + inverse * (given.values - values - slopes * least)
        q = column(place) + step
        yield q, norm(step)


def measured_determine(e: Evaluation) -> bool:
    """Whether measured rates determine all others, beyond doubt: kernels have a status elsewhere."""
    return _determine(e, _measured(e))


def task_determines(e: Evaluation) -> bool:
    """The same of the rates of the task."""
    return _determine(e, _task(e))


def _determine(e: Evaluation, given: GivenValues) -> bool:
    return all(abs(entry) < FASTEST for entry in _inverse(e, given).entries())


def is_near_measured(e: Evaluation) -> bool:
    """Whether Newton's method is quick from q on: the configuration is well within where it leads back."""
    return _is_near(e, _measured(e))


def is_near_task(e: Evaluation) -> bool:
    """The same of the task."""
    return _is_near(e, _task(e))


def _is_near(e: Evaluation, given: GivenValues) -> bool:
    first, second, third = (length for _, length in islice(_places(e, given), 3))
    # a long first step may end where the second one happens to be short
    return second <= first / QUICK and third <= max(second / QUICK, first * NOTHING_LEFT)


QUANTITIES_OF_GIVEN: dict[str, Callable[[Evaluation], Any]] = {
    "configuration_from_measured": lambda e: _configuration(e, _measured(e)),
    "velocity_from_measured": lambda e: _velocity(e, _measured(e)),
    "acceleration_from_measured": lambda e: _acceleration(e, _measured(e)),
    "task_position": lambda e: e.system.task(e.q, e.parameters, e.literals)[0],
    "task_velocity": lambda e: e.system.task(e.q, e.parameters, e.literals)[1] * e.rate,
    "task_jacobian": lambda e: e.system.task(e.q, e.parameters, e.literals)[1],
    "configuration_from_task": lambda e: _configuration(e, _task(e)),
    "velocity_from_task": lambda e: _velocity(e, _task(e)),
    "acceleration_from_task": lambda e: _acceleration(e, _task(e)),
    "task_nullspace_projector": lambda e: _still(e, _task(e)),
}
