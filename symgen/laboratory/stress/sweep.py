"""Runs the families: errors of every method against 50 digits, in units of the tolerance, and the statuses."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any, TypeAlias

import numpy as np

from symgen.generation.runnable import PIECES, STRESSED, RunnableKernels, rounded_state
from symgen.ir.kernel import UNIT_ROUNDOFF, Scalar, Status
from symgen.laboratory.stress.conditions import Conditions, Measures
from symgen.laboratory.stress.families import Family
from symgen.laboratory.stress.formulas import Data, partitioned, projected, switched
from symgen.laboratory.stress.method_kernels import LABELS, MethodKernels
from symgen.laboratory.stress.series import FIXED, PARTITION, SWITCHING, SYMGEN, Error, Series
from symgen.laboratory.stress.statuses.rule import ANGLE_LIMITS
from symgen.model.quantities import MOTIONS
from symgen.verify.reference.reference import Reference, ReferenceValueError, State
from symgen.verify.running.compile import Outcome
from symgen.verify.tolerance import FACTOR, Expectation, expectations

DEEPEST: dict[Scalar, int] = {"float64": 24, "float32": 12}  # half decades below 1
BELOW = (1e-14, 1e-16, 1e-18, 1e-24, 0.0)  # where statuses are tested as well
PAPER_KINDS = ("parameter", "input", "constraint", "large angles", "mass ratios")
RANKS = (Status.CONSTRAINT_RANK, Status.ACTUATION_RANK)  # what the measures of singularity speak of


@dataclass(frozen=True, slots=True)
class StatusCount:
    """Statuses of one kernel over all states of one scalar type.

    `singular` states lie below (n eps)², `regular` ones above (1e3 n eps)² of the measures that count.
    """

    quantity: str
    scalar: Scalar
    states: int
    refused: int
    singular: int
    singular_passed: int
    regular: int
    regular_refused: int

    def plus(self, other: StatusCount) -> StatusCount:
        """Both counts of one kernel."""
        names = ("states", "refused", "singular", "singular_passed", "regular", "regular_refused")
        return replace(self, **{name: getattr(self, name) + getattr(other, name) for name in names})


@dataclass(frozen=True, slots=True)
class Sweep:
    """Everything measured along the families, what is wrong with symgen's kernels (empty: nothing), and where known
    limits show: normwise stable results that the data determine better.
    """

    series: tuple[Series, ...]
    statuses: tuple[StatusCount, ...]
    failures: tuple[str, ...]
    limits: tuple[str, ...]

    def joined(self, other: Sweep) -> Sweep:
        """Both together; statuses of one kernel are counted together."""
        counts = {(one.quantity, one.scalar): one for one in self.statuses}
        for one in other.statuses:
            mine = counts.get((one.quantity, one.scalar))
            counts[one.quantity, one.scalar] = one if mine is None else mine.plus(one)
        return Sweep(
            (*self.series, *other.series),
            tuple(counts.values()),
            (*self.failures, *other.failures),
            (*self.limits, *other.limits),
        )


ErrorsBySeries: TypeAlias = dict[tuple[int, Scalar, str, str], dict[float, Error]]


class Sweeper:
    """One model's families run through the generated kernels, the paper's formulas, and other `methods`."""

    def __init__(
        self,
        reference: Reference,
        kernels: RunnableKernels,
        families: Sequence[Family],
        methods: MethodKernels | None = None,
    ) -> None:
        self._reference = reference
        self._conditions = Conditions(reference)
        self._kernels = kernels
        self._families = families
        self._names = tuple(name for name in STRESSED if name in kernels.names)
        self._methods = methods
        self._errors: ErrorsBySeries = {}
        self._counts: dict[tuple[str, Scalar], list[int]] = {}
        self._failures: list[str] = []

    def family(self, index: int) -> None:
        """Runs one family."""
        for scalar, deepest in DEEPEST.items():
            for curve in range(len(self._families[index].curves)):
                choice: tuple[tuple[int, ...] | None, tuple[int, ...] | None] | None = None
                for d in (*(10 ** (-k / 2) for k in range(deepest + 1)), *BELOW):
                    state = self._families[index].curves[curve](d) if d or self._singular(index) else None
                    if state is None:
                        continue
                    state = rounded_state(state, scalar)
                    if choice is None:
                        choice = self._choices(index, curve)
                    truths = self._families[index].truths
                    truth = rounded_state(truths[curve], scalar) if truths else state
                    self._state(index, scalar, d, state, truth, choice)

    def result(self) -> Sweep:
        """What was found so far."""
        series = tuple(
            Series(family, scalar, quantity, method, tuple(errors[d] for d in sorted(errors, reverse=True)))
            for (family, scalar, quantity, method), errors in self._errors.items()
        )
        statuses = tuple(StatusCount(name, scalar, *counts) for (name, scalar), counts in self._counts.items())
        exceeded = [(self._families[one.family], one) for one in series if one.method == SYMGEN and one.breaks]
        reasons = [self._reason(family, one) for family, one in exceeded]
        sentences = [_sentence(family, one) for family, one in exceeded]
        others = [_within(series, one) for _, one in exceeded]
        limits = tuple(f"{text}; {why}{o}" for text, why, o in zip(sentences, reasons, others, strict=True) if why)
        failures = (text for text, why in zip(sentences, reasons, strict=True) if not why)
        return Sweep(series, statuses, (*failures, *self._failures), limits)

    def _reason(self, family: Family, one: Series) -> str:
        """Why errors beyond the tolerance are to be expected, or nothing."""
        if family.kind != "mass ratios" and all(e.normwise for e in one.errors if not e.units <= FACTOR):
            return "within eps times the condition of B" + (
                " and FᵀM" if one.quantity == "inverse_dynamics" else " and G" if one.quantity in MOTIONS else ""
            )
        if family.kind == "constraint" and self._reference.ranks.constraints < self._reference.system.r:
            return "where rows depend on each other, what a result is beside V is a matter of definition"
        return ""

    def _singular(self, index: int) -> bool:
        return self._families[index].kind in ("parameter", "input", "constraint")

    def _choices(self, index: int, curve: int) -> tuple[tuple[int, ...] | None, tuple[int, ...] | None]:
        """The coordinates of (9) and the inputs of (28) that are closest to failing where the family leads."""
        ranks, system = self._reference.ranks, self._reference.system
        delta = system.n - ranks.constraints
        if ranks.constraints < system.r or self._families[index].kind not in PAPER_KINDS:
            return None, None
        state = self._families[index].curves[curve](1e-3)
        if state is None:
            return None, None
        N = self._conditions.matrix("nullspace_projector", state)
        # a choice that is singular everywhere is no choice
        sizes = {J: float(np.linalg.det(N[np.ix_(J, J)])) for J in combinations(range(system.n), delta)}
        usable = {J: size for J, size in sizes.items() if size > 1e-20}
        family = self._families[index]
        coordinates = min(usable, key=lambda J: (J not in family.partitions, usable[J])) if system.r else None
        inputs = None
        if system.m and ranks.actuation == delta:
            M = N @ self._conditions.matrix("control_matrix", state)
            minors = {J: float(np.linalg.det(M[:, J].T @ M[:, J])) for J in combinations(range(system.m), delta)}
            inputs = min(minors, key=lambda J: minors[J])
        return coordinates, inputs

    def _state(
        self,
        index: int,
        scalar: Scalar,
        d: float,
        state: State,
        truth: State,
        choice: tuple[tuple[int, ...] | None, tuple[int, ...] | None],
    ) -> None:
        outcomes = {name: self._kernels.run(name, state, scalar) for name in self._names}
        measures = self._conditions.measures(state)
        where = f"{self._families[index].kind} {self._families[index].label}, d = {d:.3g}, {scalar}"
        for name, outcome in outcomes.items():
            self._status(name, scalar, state, outcome, measures, where)
        if d < 10 ** (-DEEPEST[scalar] / 2) * 0.99:
            return
        try:
            seed = f"{scalar} {index} {d}"
            expected = expectations(self._reference, truth, self._names, scalar, seed, all_literals=True)
            if truth is not state:
                expected = self._drifted(expected, state, truth)
        except ReferenceValueError:
            return
        floors = {name: self._conditions.floor(name, scalar, state, measures) for name in self._names}
        for name, outcome in outcomes.items():
            if outcome.status == Status.OK:
                self._record(index, scalar, name, SYMGEN, d, expected[name], outcome.entries, floors[name])
        for method, name, entries in self._methods.run(state, scalar) if self._methods else ():
            # where the generated kernel refuses the state, no method needs an answer
            if outcomes[name].status == Status.OK:
                self._record(index, scalar, name, method, d, expected[name], entries, floors[name])
        for method, values in self._paper(scalar, state, choice):
            for name in self._names:
                if name in values or values == {}:
                    entries = np.asarray(values[name], dtype=np.float64).ravel().tolist() if name in values else None
                    self._record(index, scalar, name, method, d, expected[name], entries, floors[name])

    def _drifted(
        self, expected: dict[str, Expectation], state: State, truth: State
    ) -> dict[str, Expectation]:
        """The unit of error grows by what the distance between both states does to the exact result."""
        apart = math.dist(truth.q, state.q)
        here = self._reference.evaluate(state, self._names)
        changes = {name: expected[name].distance([float(x) for x in here[name]]) for name in self._names}
        return {name: replace(e, unit=e.unit + max(apart * e.size, changes[name])) for name, e in expected.items()}

    def _record(
        self,
        index: int,
        scalar: Scalar,
        name: str,
        method: str,
        d: float,
        expected: Expectation,
        entries: Sequence[float] | None,
        floor: float,
    ) -> None:
        if entries is None or not all(map(math.isfinite, entries)):
            error = Error(d, math.inf, math.inf, floor)
        else:
            distance = expected.distance(entries)
            relative = distance / expected.size if expected.size else distance
            error = Error(d, relative, expected.in_units(distance), floor)
        errors = self._errors.setdefault((index, scalar, name, method), {})
        errors[d] = errors[d].worse(error) if d in errors else error

    def _paper(
        self, scalar: Scalar, state: State, choice: tuple[tuple[int, ...] | None, tuple[int, ...] | None]
    ) -> Iterator[tuple[str, dict[str, Any]]]:
        """Results of the paper's methods; empty where a method has none at all."""
        coordinates, inputs = choice
        if coordinates is None or self._reference.system.r == 0:
            return
        data = self._data(scalar, state)
        if data is None:
            return
        delta = len(coordinates)
        choices = list(combinations(range(self._reference.system.m), delta)) if inputs is not None else [()]
        for method in (PARTITION, FIXED, SWITCHING):
            if inputs is None and method != PARTITION:
                continue
            try:
                with np.errstate(all="ignore"):
                    if method == PARTITION:
                        values = partitioned(data, coordinates)
                    else:
                        values = projected(data, inputs or ()) if method == FIXED else switched(data, choices)
            except np.linalg.LinAlgError:
                values = {}
            yield method, values

    def _data(self, scalar: Scalar, state: State) -> Data | None:
        kernels, n = self._kernels, self._reference.system.n
        values: dict[str, Any] = {}
        for name in PIECES:
            if name not in kernels.names:
                return None
            outcome = kernels.run(name, state, scalar)
            if outcome.status != Status.OK:
                return None
            values[name] = np.array(outcome.entries, dtype=scalar).reshape(kernels.kernel(name, scalar).shape)
        qd, qdd, u = (np.array(part, dtype=scalar) for part in (state.qd, state.qdd, state.u))
        assert len(qd) == n
        return Data(
            G=values["mass_matrix"],
            C=values["coriolis_matrix"],
            B=values["constraint_jacobian"],
            B_dot=values["constraint_jacobian_dot"],
            M=values["control_matrix"],
            Q=values["potential_force"] - values["applied_force"],
            qd=qd,
            qdd=qdd,
            u=u,
        )

    def _status(
        self,
        name: str,
        scalar: Scalar,
        state: State,
        outcome: Outcome,
        measures: Measures | None,
        where: str,
    ) -> None:
        counts = self._counts.setdefault((name, scalar), [0] * 6)
        counts[0] += 1
        refused = outcome.status != Status.OK
        counts[1] += refused
        if not refused and not all(map(math.isfinite, outcome.entries)):
            self._failures.append(f"{name}, {where}: a result that is not finite with status 0")
        angles = [x for x, c in zip(state.q, self._reference.model.coordinates, strict=True) if c.is_angle]
        if max((abs(x) for x in angles), default=0.0) > ANGLE_LIMITS[scalar] / 2:
            return  # sums of angles may leave the range
        if measures is None:
            return
        model, ranks = self._reference.model, self._reference.ranks
        eps = float(UNIT_ROUNDOFF[scalar])
        low, high = (model.n * eps) ** 2, (1e3 * model.n * eps) ** 2
        input_counts = name == "inverse_dynamics" and ranks.actuation == model.n - ranks.constraints
        counting = (*measures, self._conditions.columns(state)) if input_counts else measures[:1]
        given = (model.constraint_rank_tolerance, model.actuation_rank_tolerance)
        if min(counting) < low:
            counts[2] += 1
            if not refused:
                counts[3] += 1
                self._failures.append(f"{name}, {where}: status 0 at measures {_texts(counting)}, below {low:.2g}")
        elif min(counting) > high and given == (None, None):
            counts[4] += 1
            if refused and outcome.status in RANKS and not self._conditions.graded(state):
                counts[5] += 1
                self._failures.append(
                    f"{name}, {where}: status {outcome.status} at measures {_texts(counting)}, above {high:.2g}"
                )


def _sentence(family: Family, one: Series) -> str:
    worst = one.largest
    return (
        f"{one.quantity}, {family.kind}, {family.label}, {one.scalar}: beyond the tolerance from d = {one.breaks:.2g}, "
        f"at most {worst.units:.2g} times d + eps |y*| ({FACTOR:g} is allowed) at d = {worst.distance:.2g}, "
        f"relative {worst.relative:.2g}"
    )


def _within(series: Sequence[Series], exceeded: Series) -> str:
    """Which methods by name stay within the tolerance where the generated one does not."""
    methods = [
        one.method.removeprefix("method ")
        for one in series
        if (one.family, one.scalar, one.quantity) == (exceeded.family, exceeded.scalar, exceeded.quantity)
        and one.method in LABELS.values()
        and one.breaks is None
    ]
    return f"; within it: --method {exceeded.quantity}={' or '.join(methods)}" if methods else ""


def _texts(values: Sequence[float]) -> str:
    return ", ".join(f"{x:.2g}" for x in values)
