"""Base parameters: which combinations of inertial parameters the equations of a mechanism show, and which none.

Rows of F^T Y at random admissible motions, in balls, until three motions more bring no new direction: there is no
tolerance, a number counts where its ball leaves 0 out.  Restricted energies would do for holonomic systems alone
(Gautier and Khalil, Direct calculation of minimum set of inertial parameters of serial robots, 1990).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TypeVar

from symgen.model.combinations.ball_matrices import Echelon, extended
from symgen.model.combinations.coefficient_forms import (
    MOST_VARIABLES,
    CoefficientForm,
    CoefficientSample,
    changing,
    product_form,
    quotient_form,
    samples_needed,
)
from symgen.model.combinations.constrained_regressor import ConstrainedRegressor
from symgen.model.combinations.geometry import angular_parameters, geometry_values
from symgen.model.combinations.motion_states import BallSystem, NoMotionError, motion_states
from symgen.model.combinations.taylor_balls import (
    FIRST_BALL_BITS,
    MOST_BALL_BITS,
    Ball,
    WideBallError,
    ball_precision,
    may_vanish,
)
from symgen.model.configurations.gradient import Gradients
from symgen.model.configurations.mechanics import default_values
from symgen.model.inertial_parameters import InertialParameter, inertial_parameters, values
from symgen.model.model import Model
from symgen.runtime.activity import working

# Motions that bring nothing new before the rank counts.
SURE = 3
# Of the terms of a sum that vanishes.
VANISHING_SUM = 1e-14
# The factor by which one parameter of the geometry is changed.
CHANGE = Fraction(33, 32)
# All of them are changed by one over this at most.
CHANGED_BY = 64
Searched = TypeVar("Searched")


class NoBodiesError(Exception):
    """A model without bodies has no inertial parameters."""


@dataclass(frozen=True, slots=True)
class BaseParameter:
    """A combination that counts: a parameter and what others add to it."""

    stays: InertialParameter
    added: tuple[tuple[InertialParameter, CoefficientForm], ...]
    value: float


@dataclass(frozen=True, slots=True)
class BaseParameters:
    """Those of one model.

    `as_tree` counts them without the constraints, `elsewhere` at other values of the geometry (None where the
    mechanism does not close there).  Parameters `without_effect` are in no combination.
    """

    model: Model
    parameters: tuple[InertialParameter, ...]
    base: tuple[BaseParameter, ...]
    without_effect: tuple[InertialParameter, ...]
    as_tree: int
    elsewhere: int | None

    @property
    def columns(self) -> tuple[int, ...]:
        """The numbers of the parameters that stand for all."""
        return tuple(self.parameters.index(one.stays) for one in self.base)


def base_parameters(model: Model) -> BaseParameters:
    """The base parameters of a model with bodies.

    Raises NoBodiesError where there are none, and NoMotionError where no regular motion was found.
    """
    if not model.mechanism.has_mass:
        raise NoBodiesError
    return with_enough_digits(lambda: CombinationSearch(model).result())


def with_enough_digits(work: Callable[[], Searched]) -> Searched:
    """What some work in balls comes to, with more digits where they are too wide to decide; else NoMotionError."""
    bits = FIRST_BALL_BITS
    while True:
        try:
            with ball_precision(bits):
                return work()
        except WideBallError:
            if bits == MOST_BALL_BITS:
                raise NoMotionError from None
            bits *= 2


class CombinationSearch:
    """The search in one model, at the working precision."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._parameters = inertial_parameters(model.mechanism)
        self._order = sorted(range(len(self._parameters)), key=lambda k: (self._parameters[k].staying, k))
        self._geometry, self._angles = geometry_values(model), angular_parameters(model)

    def result(self) -> BaseParameters:
        """All of it."""
        with working("base parameters"):
            here = self.echelon({})
            tree = self.echelon({}, is_open=True).rank if self._model.constraints else here.rank
            combined = [*self._combined(here)]
            others = self._changed(here, combined)
            forms = dict(self._forms(here, combined, others)) if others is not None else {}
            elsewhere = self._elsewhere(here)
        model = self._model
        definitions = {one.name: one.value for one in model.definitions}
        evaluated = Gradients(default_values(model.parameters), {}, definitions)
        numbers = values(model.mechanism, lambda expression: evaluated.of(expression)[0])
        by_pivot: dict[int, list[tuple[int, CoefficientForm]]] = {pivot: [] for pivot in here.pivots}
        for (row, column), value in combined:
            form = forms.get((row, column), CoefficientForm(float(value.mid()), ()))
            by_pivot[here.pivots[row]].append((column, form))
        base = tuple(
            BaseParameter(
                self._parameters[pivot],
                tuple((self._parameters[column], form) for column, form in added),
                _sum([numbers[pivot], *(form.value * numbers[column] for column, form in added)]),
            )
            for pivot, added in sorted(by_pivot.items())
        )
        shown = {*here.pivots, *(column for (_, column), _ in combined)}
        idle = tuple(one for k, one in enumerate(self._parameters) if k not in shown)
        return BaseParameters(model, self._parameters, base, idle, tree, elsewhere)

    def echelon(self, given: Mapping[str, Fraction], is_open: bool = False, rank: int | None = None) -> Echelon:
        """Reduced rows at as many motions as it takes, or as this rank does."""
        model = self._model
        system = BallSystem(model, given, is_open)
        regressor = ConstrainedRegressor(system)
        rows = 0
        if model.assembly is None:
            start = tuple(float(sum(c.range)) / 2 for c in model.coordinates)
        else:
            # an attitude in the middle of its ranges is none
            start, rows = model.assembly.places[0].q, 0 if is_open else model.assembly.ranks.constraints
        echelon, quiet = Echelon([], ()), 0
        for state in motion_states(system, start, rows):
            more = extended(echelon, regressor.rows(state), self._order)
            quiet = quiet + 1 if more.rank == echelon.rank else 0
            echelon = more
            if quiet == SURE or echelon.rank == rank:
                break
        return echelon

    def _combined(self, echelon: Echelon) -> Iterator[tuple[tuple[int, int], Ball]]:
        """By row and column, what parameters that are no pivots add."""
        for i, row in enumerate(echelon.rows):
            for j, entry in enumerate(row):
                if j not in echelon.pivots and not may_vanish(entry):
                    yield (i, j), entry

    def _changed(
        self, here: Echelon, combined: Sequence[tuple[tuple[int, int], Ball]]
    ) -> dict[str, Echelon] | None:
        """With each parameter of the geometry changed; None where nothing is combined, or the pivots differ."""
        made: dict[str, Echelon] = {}
        if not combined:
            return None
        for name, value in self._geometry.items():
            try:
                other = self.echelon({name: value * CHANGE}, rank=here.rank)
            except NoMotionError:
                return None
            if sorted(other.pivots) != sorted(here.pivots):
                return None
            made[name] = other
        return made

    def _forms(
        self, here: Echelon, combined: Sequence[tuple[tuple[int, int], Ball]], others: Mapping[str, Echelon]
    ) -> Iterator[tuple[tuple[int, int], CoefficientForm]]:
        """Closed forms, by row and column."""
        left: list[tuple[tuple[int, int], CoefficientSample, tuple[str, ...]]] = []
        for (i, j), value in combined:
            own = CoefficientSample(self._geometry, value)
            scaled = {
                name: CoefficientSample(
                    {**self._geometry, name: self._geometry[name] * CHANGE}, _entry(other, here.pivots[i], j)
                )
                for name, other in others.items()
            }
            form = product_form(own, scaled)
            if form is not None:
                yield (i, j), form
            else:
                left.append(((i, j), own, changing(own, scaled)))
        fitted = [len(names) for _, _, names in left if self._fits(names)]
        samples = [*self._anywhere(here, max(map(samples_needed, fitted)))] if fitted else []
        for (i, j), own, names in left:
            seen = [CoefficientSample(given, _entry(echelon, here.pivots[i], j)) for given, echelon in samples]
            form = quotient_form(own, names, seen) if self._fits(names) else None
            yield (i, j), form or replace(CoefficientForm(float(own.value.mid()), ()), changed_by=names)

    def _fits(self, names: Sequence[str]) -> bool:
        """Whether a polynomial in these parameters is looked for."""
        return len(names) <= MOST_VARIABLES and self._angles.isdisjoint(names)

    def _anywhere(self, here: Echelon, count: int) -> Iterator[tuple[dict[str, Fraction], Echelon]]:
        """So many times with all parameters of the geometry changed, each time in another way."""
        for k in range(count):
            given = self.moved(k)
            try:
                echelon = self.echelon(given, rank=here.rank)
            except NoMotionError:
                return
            if sorted(echelon.pivots) != sorted(here.pivots):
                return
            yield given, echelon

    def moved(self, number: int) -> dict[str, Fraction]:
        """Values of the geometry in general position: their quotients are fractions of large primes."""
        return in_general_position(self._geometry, number)

    def _elsewhere(self, here: Echelon) -> int | None:
        if not self._geometry:
            return here.rank
        try:
            return self.echelon(self.moved(1)).rank
        except NoMotionError:
            return None


def in_general_position(values: Mapping[str, Fraction], number: int) -> dict[str, Fraction]:
    """These values, each changed by another share, which differ from one number to the next."""
    return {
        name: value * (1 + Fraction((31 * (k + 1) + 17 * number * (k + 2)) % 101 - 50, 50 * CHANGED_BY))
        for k, (name, value) in enumerate(values.items())
    }


def _sum(terms: Sequence[float]) -> float:
    """The sum, and 0 for what rounding leaves of one."""
    total = sum(terms)
    return 0.0 if abs(total) <= VANISHING_SUM * sum(map(abs, terms)) else total


def _entry(echelon: Echelon, pivot: int, column: int) -> Ball:
    return echelon.rows[echelon.pivots.index(pivot)][column]
