"""Whether the inputs leave anything to allocate: ranks of B and M at configurations of the mechanism."""

from __future__ import annotations

from collections.abc import Iterator
from math import comb

from symgen.diagnostics import Mistake, Notice
from symgen.model.checks.feasibility import SAMPLES
from symgen.model.configurations.assembly import Assembly, RankedConfiguration
from symgen.model.configurations.dense import Rows, rank
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.expressions.names import counted
from symgen.model.model import Allocation, Input

# Sets of limits that a kernel works out: each takes some thirty-five operations.
MOST_PLANES = 1_000
UTILISATION = "utilisation"


def check_redundancy(
    mechanics: NumericSystem,
    assembly: Assembly,
    inputs: tuple[Input, ...],
    allocation: Allocation,
    outputs: tuple[str, ...],
) -> Iterator[Mistake | Notice]:
    """What the block `allocation` asks for and these inputs cannot do.

    Needed are more inputs than the rank of the projected control matrix, for limits more than δ, and for a preload
    along one direction exactly one more and independent constraints (else that direction has no sign of its own).
    """
    n, m = len(mechanics.coordinates), len(inputs)
    constraints, degree = assembly.ranks.constraints, assembly.ranks.actuation
    delta = n - constraints
    if m == degree and m and not (allocation.weights or allocation.preload or allocation.preferred):
        if UTILISATION not in outputs:
            yield Notice(
                f"the motion determines the inputs, whatever their `limits` are: name `{UTILISATION}` in `outputs`",
                allocation.span,
            )
        return
    if m == degree:
        share = f"{counted(m, 'input')} for δ = {delta}, determined by the motion" if m else "the model has no inputs"
        yield Mistake(
            f"nothing to allocate: {share}",
            "remove `allocation`; it shares the work of more inputs than are needed",
            allocation.span,
        )
        return
    if allocation.directed:
        yield from _check_direction(allocation, m, delta, degree, constraints < len(mechanics.constraints))
    samples = [_dense(mechanics, place, inputs) for place in assembly.places[:SAMPLES]] if allocation.limits else []
    for limit in allocation.limits:
        index = [item.name for item in inputs].index(limit.input)
        if all(rank([*b, *columns[:index], *columns[index + 1 :]]) < constraints + degree for b, columns in samples):
            yield Notice(
                f"the motion alone determines `{limit.input}`: no other input can take over what is beyond its limits",
                allocation.span,
            )


def _check_direction(allocation: Allocation, m: int, delta: int, degree: int, dependent: bool) -> Iterator[Mistake]:
    """A single preload needs one direction of internal force, with a sign of its own; limits need some."""
    reached = "" if degree == delta else f"the inputs reach {degree} of δ = {delta} directions of motion"
    if allocation.preload:
        why = reached
        if not why and m - delta != 1:
            why = f"here are m - δ = {m - delta} directions of internal force"
        elif not why and dependent:
            why = "constraints depend on each other, which leaves this direction without a sign"
        if why:
            message = f"a single `preload` needs one direction of internal force (m = δ + 1): {why}"
            remedy = "name a value for each input instead: `preload: {input: value}`"
            yield Mistake(message, remedy, allocation.span)
    if not allocation.limits:
        return
    if reached:
        yield Mistake(f"`limits` need inputs for every direction: {reached}", "remove `limits`", allocation.span)
    elif (count := planes(len(allocation.limits), m - delta)) > MOST_PLANES:
        yield Mistake(
            f"{len(allocation.limits)} limits along m - δ = {m - delta} directions of internal force leave {count} "
            f"ways in which they may be reached; {MOST_PLANES} at most are worked out",
            "give limits to fewer inputs, or join drives that do the same",
            allocation.span,
        )


def planes(limits: int, directions: int) -> int:
    """How many sets of no more limits than directions there are, each of which may be what inputs reach."""
    return sum(comb(limits, k) for k in range(1, directions + 1))


def _dense(mechanics: NumericSystem, place: RankedConfiguration, inputs: tuple[Input, ...]) -> tuple[Rows, Rows]:
    """B and the columns of M at a configuration."""
    columns = mechanics.columns(place.q, inputs)
    return mechanics.jacobian(place.q), [[column.get(j, 0.0) for j in range(len(place.q))] for column in columns]
