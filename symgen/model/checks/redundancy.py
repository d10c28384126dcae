"""Whether the inputs leave anything to allocate: ranks of B and M at configurations of the mechanism."""

from __future__ import annotations

from collections.abc import Iterator

from symgen.diagnostics import Mistake, Notice
from symgen.model.checks.feasibility import SAMPLES
from symgen.model.configurations.assembly import Assembly, RankedConfiguration
from symgen.model.configurations.dense import Rows, rank
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.expressions.names import counted
from symgen.model.model import Allocation, Input


def check_redundancy(
    mechanics: NumericSystem,
    assembly: Assembly,
    inputs: tuple[Input, ...],
    allocation: Allocation,
) -> Iterator[Mistake | Notice]:
    """What the block `allocation` asks for and these inputs cannot do.

    Needed are more inputs than the rank of the projected control matrix, for a preload along one direction and for
    limits exactly one more than δ, and independent constraints (else that direction has no sign of its own).
    """
    n, m = len(mechanics.coordinates), len(inputs)
    constraints, degree = assembly.ranks.constraints, assembly.ranks.actuation
    delta = n - constraints
    if m == degree:
        share = f"{counted(m, 'input')} for δ = {delta}, determined by the motion" if m else "the model has no inputs"
        yield Mistake(
            f"nothing to allocate: {share}",
            "remove `allocation`; it shares the work of more inputs than are needed",
            allocation.span,
        )
        return
    if allocation.directed:
        yield from _check_direction(mechanics, allocation, m, delta, degree, constraints)
    samples = [_dense(mechanics, place, inputs) for place in assembly.places[:SAMPLES]] if allocation.limits else []
    for limit in allocation.limits:
        index = [item.name for item in inputs].index(limit.input)
        if all(rank([*b, *columns[:index], *columns[index + 1 :]]) < constraints + degree for b, columns in samples):
            yield Notice(
                f"the motion alone determines `{limit.input}`: no other input can take over what is beyond its limits",
                allocation.span,
            )


def _check_direction(
    mechanics: NumericSystem, allocation: Allocation, m: int, delta: int, degree: int, constraints: int
) -> Iterator[Mistake]:
    """Limits and a single preload need one direction of internal force, with a sign of its own."""
    if degree < delta:
        why = f"the inputs reach {degree} of δ = {delta} directions of motion"
    elif m - delta != 1:
        why = f"here are m - δ = {m - delta} directions of internal force"
    elif constraints < len(mechanics.constraints):
        why = "constraints depend on each other, which leaves this direction without a sign"
    else:
        return
    one = "one direction of internal force (m = δ + 1)"
    if allocation.preload:
        remedy = "name a value for each input instead: `preload: {input: value}`"
        yield Mistake(f"a single `preload` needs {one}: {why}", remedy, allocation.span)
    if allocation.limits:
        remedy = "remove `limits`; keeping limits is a quadratic program otherwise, which a kernel does not solve"
        yield Mistake(f"`limits` need {one}: {why}", remedy, allocation.span)


def _dense(mechanics: NumericSystem, place: RankedConfiguration, inputs: tuple[Input, ...]) -> tuple[Rows, Rows]:
    """B and the columns of M at a configuration."""
    columns = mechanics.columns(place.q, inputs)
    return mechanics.jacobian(place.q), [[column.get(j, 0.0) for j in range(len(place.q))] for column in columns]
