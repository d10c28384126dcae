"""Generated results against the reference: error records, and what counts as a failure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from statistics import median
from typing import TypeAlias

from symgen.ir.kernel import Status
from symgen.verify.certificate import ErrorRecord, Fault, InvariantRecord
from symgen.verify.invariants import defects
from symgen.verify.reference.reference import Reference
from symgen.verify.running.compile import Outcome
from symgen.verify.sampling.states import Sample
from symgen.verify.tolerance import FACTOR, Expectation

Results: TypeAlias = Mapping[str, Sequence[Outcome]]
# The error of a result that is no number.
INFINITE = float("inf")
# How faults begin that are a matter of digits.
INACCURATE = "error"
VIOLATES = "violates"


def compare(quantity: str, target: str, expected: Sequence[Expectation], outcomes: Sequence[Outcome]) -> ErrorRecord:
    """Errors of one quantity over the states; a state without a finite result counts as an infinite error."""
    errors = []
    relatives = []
    for expectation, outcome in zip(expected, outcomes, strict=True):
        if outcome.valid:
            distance = expectation.distance(outcome.entries)
            errors.append(expectation.in_units(distance))
            relatives.append(distance / expectation.size if distance and expectation.size else 0.0)
        else:
            errors.append(INFINITE)
    ordered = sorted(errors)
    return ErrorRecord(
        quantity=quantity,
        target=target,
        states=len(errors),
        median=median(ordered),
        percentile_99=ordered[min(len(ordered) - 1, int(0.99 * len(ordered)))],
        largest=ordered[-1],
        largest_relative=max(relatives, default=INFINITE),
        worst_state=errors.index(ordered[-1]),
        refused=sum(not outcome.valid for outcome in outcomes),
    )


def faults_of(record: ErrorRecord, outcomes: Sequence[Outcome], samples: Sequence[Sample]) -> Iterator[Fault]:
    """What is wrong with one quantity of one target, if anything."""
    if record.refused:
        index = next(i for i, outcome in enumerate(outcomes) if not outcome.valid)
        first, second = samples[index].measures
        status = outcomes[index].status
        what = "a result that is not finite" if status == Status.OK else f"status {status}"
        yield Fault(
            f"{what} at {record.refused} of {record.states} regular states, first at state {index} "
            f"(singularity measures {first:.3g}, {second:.3g})",
            record.quantity,
            record.target,
            index,
        )
    elif not record.largest <= FACTOR:
        yield Fault(
            f"{INACCURATE} {record.largest:.3g} times d + eps |y*| at state {record.worst_state}, "
            f"{FACTOR:g} is allowed (relative error {record.largest_relative:.3g})",
            record.quantity,
            record.target,
            record.worst_state,
        )


def check_laws(
    target: str,
    reference: Reference,
    samples: Sequence[Sample],
    expected: Sequence[Mapping[str, Expectation]],
    results: Results,
) -> list[InvariantRecord]:
    """The laws the results of a target can be tested on, over all states where every result is valid."""
    by_law: dict[tuple[str, str], list[float]] = {}
    for index, sample in enumerate(samples):
        entries = {name: outcomes[index].entries for name, outcomes in results.items() if outcomes[index].valid}
        for name, quantity, share in defects(reference, sample, expected[index], entries):
            by_law.setdefault((name, quantity), []).append(share)
    return [InvariantRecord(name, target, len(shares), max(shares), of) for (name, of), shares in by_law.items()]
