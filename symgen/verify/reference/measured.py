"""What measured coordinates determine, from its definition.

S selects the measured coordinates; (S N)^+ is the least-squares solution among admissible rates.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import Any

from flint import ctx

from symgen.verify.reference.arithmetic.linear import column, identity, norm, right_pseudoinverse, rows_of
from symgen.verify.reference.evaluation import Evaluation

# Seconds after which encoders are read.
MOMENT = 2.0**-10
# Steps that all digits usually take, and those at most: each leaves a share of what is missing, by which the encoders
# disagree.
USUAL_STEPS, MOST_NEWTON_STEPS = 8, 200
# Times by which steps grow shorter at first.
QUICK = 8.0
# Of the binary digits, what rounding may keep from standing still.
RESTLESS = 24


def _selected(e: Evaluation) -> Any:
    """S."""
    return rows_of(identity(e.system.n), e.system.model.measured_places)


def _inverse(e: Evaluation) -> Any:
    """(S N)^+, of the rank of N."""
    return right_pseudoinverse(_selected(e) * e.projector, e.system.n - e.ranks.constraints)


def velocity_from_measured(e: Evaluation) -> Any:
    """The admissible rates whose measured ones are nearest to those given, here those of qd."""
    return _inverse(e) * (_selected(e) * e.rate)


def acceleration_from_measured(e: Evaluation) -> Any:
    """The same of accelerations, given those of qdd, at that velocity."""
    selected, inverse = _selected(e), _inverse(e)
    least = -(e.inverse * e.motion(velocity_from_measured(e))[1])
    return least + inverse * (selected * (column(e.qdd) - least))


def configuration_from_measured(e: Evaluation) -> Any:
    """By Gauss and Newton's method from q, until nothing moves any more; measured is what q is a moment later.

    Raises ZeroDivisionError where its steps grow: q is not near what they lead to.
    """
    first, before = 0.0, 0.0
    for k, (q, length) in enumerate(islice(_places(e), MOST_NEWTON_STEPS)):
        if length <= 2.0 ** (RESTLESS - ctx.prec) * (1 + norm(q)):
            return q
        if k and length > max(before, first) / 2:
            break
        first, before = first or length, length
    raise ZeroDivisionError("the configuration is not near enough to one with what is measured")


def is_near(e: Evaluation) -> bool:
    """Whether Newton's method is quick from q on: the configuration is well within where it leads back."""
    (_, first), (_, second) = islice(_places(e), 2)
    return second <= first / QUICK


def _places(e: Evaluation) -> Iterator[tuple[Any, float]]:
    """Where Gauss and Newton's steps lead, and how long they are."""
    selected, q, n, rank = _selected(e), column(e.q), e.system.n, e.ranks.geometric
    given = selected * (q + MOMENT * e.rate)
    while True:
        place = [x.mid() for x in q.entries()]
        residual, rows = e.system.geometry(place, e.parameters, e.literals)
        inverse = right_pseudoinverse(rows, rank)
        least = -(inverse * residual)
        moving = selected - (selected * inverse) * rows
        step = least + right_pseudoinverse(moving, n - rank) * (given - selected * (column(place) + least))
        q = column(place) + step
        yield q, norm(step)
