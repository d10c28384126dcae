"""From base parameters to parameters of the file: the least change that meets what the data determine.

Base parameters are combinations, so that a file has parameters to spare, or fewer where several bodies share some.
Each parameter is held at its value of the file by a standard deviation as large as that value; where the data say
more, they decide.  Bodies stay such as can be (Wensing, Kim and Slotine, Linear matrix inequalities for physically
consistent inertial parameter identification, 2018): masses are positive, principal moments and their differences too.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from scipy import optimize

from symgen.identification.arrays import Array
from symgen.identification.bodies.pseudo_inertia import about_centre
from symgen.identification.combinations import Combinations, default_like, inertial_values
from symgen.identification.estimates.inverse_root import inverse_root
from symgen.identification.estimates.least_squares import LinearEstimate
from symgen.identification.estimates.linear_terms import EstimatedNames
from symgen.identification.estimates.whitened import deviation_before, whitening
from symgen.model.expressions.walk import exact_value
from symgen.model.model import Model
from symgen.records import dataclass

# Of a mass or moment of the file, the least that is left where the data ask for less than nothing.
LEAST_LEFT = 1e-3
# Of the largest principal moment, what rounding makes negative.
ROUNDED_MOMENT = 1e-9
# Of its size, what the cost still changes by where an optimisation ends.
OPTIMISED = 1e-10
# How often it begins anew where it ended, with a cost of the size that it has there.
ROUNDS_OF_OPTIMISING = 8
# Steps of differences, in standard deviations of parameters before the log.
PARAMETER_STEP = 1e-6
# Steps of an optimisation at most.
MOST_OPTIMISING_STEPS = 200


@dataclass(frozen=True, slots=True)
class FileValues:
    """Values of parameters of the file by name, with those before and standard errors.

    `misfit` is how far base parameters made of them are from the estimates, in standard errors of these (rms).
    `impossible` are bodies that the data alone would have given no mass distribution, `kept` whether all had to keep
    what they had.
    """

    names: tuple[str, ...]
    before: Array
    values: Array
    errors: Array
    misfit: float
    impossible: tuple[str, ...]
    kept: bool


def file_values(
    model: Model,
    combinations: Combinations,
    names: EstimatedNames,
    known: Mapping[str, float],
    estimate: LinearEstimate,
) -> FileValues:
    """The parameters of the file that are nearest to what they were and say what the log says."""
    return _Nearest(model, combinations, names, known, estimate).result()


class _Nearest:
    def __init__(
        self,
        model: Model,
        combinations: Combinations,
        names: EstimatedNames,
        known: Mapping[str, float],
        estimate: LinearEstimate,
    ) -> None:
        self._model, self._known, self._further = model, known, names.with_columns
        self._names = (*names.inertial, *names.with_columns)
        self._before = np.array([known[name] for name in self._names])
        self._combinations = combinations
        self._estimate, self._target = estimate, estimate.values[estimate.closed_columns]
        self._whitening = whitening(estimate)
        by_name = {p.name: p for p in model.parameters}
        self._held = np.array([deviation_before(by_name[name], known[name]) for name in self._names])
        self._at_first = body_margins(model, self._numbers(self._before))

    def result(self) -> FileValues:
        """The nearest values, with what they leave."""
        if not self._names:
            return FileValues((), np.empty(0), np.empty(0), np.empty(0), 0.0, (), False)
        solved = optimize.least_squares(self._distances, self._before, x_scale=self._held)
        values, jacobian = solved.x, solved.jac
        impossible, kept = self._impossible(values), False
        if impossible:
            values = self._possible()
            kept = bool(self._impossible(values))
            values = self._kept(values) if kept else values
        errors = np.linalg.norm(inverse_root(jacobian), axis=1)
        off = self._whitening @ (self._combined(values) - self._target)
        misfit = float(np.sqrt(np.mean(off**2))) if len(off) else 0.0
        return FileValues(self._names, self._before, values, errors, misfit, impossible, kept)

    def _numbers(self, values: Array) -> dict[str, float]:
        return default_like(self._model, self._known, dict(zip(self._names, map(float, values), strict=True)))

    def _combined(self, values: Array) -> Array:
        """Base parameters and further ones (c) that the log determines."""
        numbers = self._numbers(values)
        combined = self._combinations.at(numbers)
        return self._estimate.shown(np.concatenate([combined, [numbers[name] for name in self._further]]))

    def _distances(self, values: Array) -> Array:
        """In standard deviations: from the estimates, and from the file."""
        off = self._whitening @ (self._combined(values) - self._target)
        return np.concatenate([off, (values - self._before) / self._held])

    def _margins(self, values: Array) -> Array:
        """What has to be positive, body by body, as shares of what the file has."""
        pairs = zip(body_margins(self._model, self._numbers(values)), self._at_first, strict=True)
        return np.array([now / then for (_, now), (_, then) in pairs if then > 0])

    def _spare(self, values: Array) -> Array:
        return self._margins(values) - LEAST_LEFT

    def _impossible(self, values: Array) -> tuple[str, ...]:
        pairs = zip(body_margins(self._model, self._numbers(values)), self._at_first, strict=True)
        return tuple(dict.fromkeys(name for (name, now), (_, then) in pairs if then > 0 >= now))

    def _possible(self) -> Array:
        """The nearest values of bodies that can be, from those of the file on.

        They are looked for along directions in which distances change alike, as what the data say of one combination
        may be 10^8 times as much as what they say of another, and parameter by parameter, where products bend these
        directions.
        """
        values, along = self._before, np.diag(self._held)
        for _ in range(ROUNDS_OF_OPTIMISING):
            size = self._cost(values)
            directions = math.sqrt(size) * inverse_root(self._slopes(self._distances, values))
            for units in (directions, along):
                values = self._nearer(values, units)
            if not self._cost(values) < (1 - OPTIMISED) * size:
                break
        return values

    def _nearer(self, values: Array, units: Array) -> Array:
        """Values of less cost of bodies that can be, by steps in these units (k, k); the same where none are found."""
        size = self._cost(values)
        if not size > 0:
            return values
        moved = self._optimised(values, units, size)
        return values if self._impossible(moved) or not self._cost(moved) < size else moved

    def _optimised(self, start: Array, units: Array, size: float) -> Array:
        """The nearest values of bodies that can be, by steps in units (k, k) and for a cost of this size: the optimiser
        takes both for what they are where they are about one."""

        def at(steps: Array) -> Array:
            return np.asarray(start + units @ steps, dtype=np.float64)

        def slope(steps: Array) -> Array:
            values = at(steps)
            return np.asarray(2 * self._distances(values) @ self._slopes(self._distances, values) @ units / size)

        spare = {
            "type": "ineq",
            "fun": lambda steps: self._spare(at(steps)),
            "jac": lambda steps: self._slopes(self._spare, at(steps)) @ units,
        }
        solved = optimize.minimize(
            lambda steps: self._cost(at(steps)) / size,
            np.zeros(len(start)),
            jac=slope,
            method="SLSQP",
            constraints=[spare],
            options={"maxiter": MOST_OPTIMISING_STEPS, "ftol": OPTIMISED},
        )
        return at(solved.x)

    def _slopes(self, of: Callable[[Array], Array], values: Array) -> Array:
        """The derivatives of a function by the parameters, by differences."""
        here, columns = of(values), []
        for k, step in enumerate(PARAMETER_STEP * self._held):
            moved = values.copy()
            moved[k] += step
            columns.append((of(moved) - here) / step)
        return np.stack(columns, axis=1)

    def _cost(self, values: Array) -> float:
        return float(np.sum(self._distances(values) ** 2))

    def _kept(self, values: Array) -> Array:
        """Bodies as in the file, all else as estimated."""
        count = len(self._names) - len(self._further)
        return np.concatenate([self._before[:count], values[count:]])


def body_margins(model: Model, numbers: Mapping[str, float]) -> list[tuple[str, float]]:
    """Of each body and rotor what is positive where it can exist: mass, principal moments, two of them less the third.

    A body whose file gives it no moments about some axes, as in the plane, is asked for those that it has.
    """
    known = inertial_values(model, numbers)
    margins: list[tuple[str, float]] = []
    for k, body in enumerate(model.mechanism.bodies):
        mass, _, tensor = about_centre(known[10 * k : 10 * k + 10])
        margins.append((body.name, mass))
        given = [i for i, row in enumerate(body.inertia.rows) if exact_value(row[i]) != 0]
        if not given:
            continue
        moments = np.linalg.eigvalsh(tensor[np.ix_(given, given)])
        margins.append((body.name, float(moments[0])))
        if len(given) == 3:
            margins.append((body.name, float(moments[0] + moments[1] - moments[2] + ROUNDED_MOMENT * moments[2])))
    rotors = zip(model.mechanism.rotor_inertias, known[10 * len(model.mechanism.bodies) :], strict=True)
    return margins + [(rotor.coordinate, float(inertia)) for rotor, inertia in rotors]

