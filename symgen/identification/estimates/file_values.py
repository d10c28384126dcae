"""From base parameters to parameters of the file: the least change that meets what the data determine.

Base parameters are combinations, so that a file has parameters to spare, or fewer where several bodies share some.
Each parameter is held at its value of the file by a standard deviation as large as that value; where the data say
more, they decide.  Bodies stay such as can be (Wensing, Kim and Slotine, Linear matrix inequalities for physically
consistent inertial parameter identification, 2018): masses are positive, principal moments and their differences too.
"""

from __future__ import annotations

from collections.abc import Mapping

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
ROUNDS_OF_OPTIMISING = 3
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
        self._model, self._known, self._linear = model, known, names.linear
        self._names = (*names.inertial, *names.linear)
        self._before = np.array([known[name] for name in self._names])
        self._combinations = combinations
        closed = estimate.closed_columns
        self._closed, self._target = closed, estimate.values[closed]
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
        """Base parameters and linear ones (c) that the log determines."""
        numbers = self._numbers(values)
        combined = self._combinations.at(numbers)
        return np.concatenate([combined, [numbers[name] for name in self._linear]])[self._closed]

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
        """The nearest values of bodies that can be, from those of the file on."""
        values = self._before
        for _ in range(ROUNDS_OF_OPTIMISING):
            # the optimiser takes functions of about one for what they are
            size = self._cost(values) or 1.0
            solved = optimize.minimize(
                lambda shares, size: self._cost(self._before + shares * self._held) / size,
                (values - self._before) / self._held,
                args=(size,),
                method="SLSQP",
                constraints=[{"type": "ineq", "fun": lambda shares: self._spare(self._before + shares * self._held)}],
                options={"maxiter": MOST_OPTIMISING_STEPS, "ftol": OPTIMISED},
            )
            values = np.asarray(self._before + solved.x * self._held, dtype=np.float64)
        return values

    def _cost(self, values: Array) -> float:
        return float(np.sum(self._distances(values) ** 2))

    def _kept(self, values: Array) -> Array:
        """Bodies as in the file, all else as estimated."""
        count = len(self._names) - len(self._linear)
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

