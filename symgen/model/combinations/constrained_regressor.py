"""F^T Y: what each inertial parameter adds to the equations along admissible directions.

By d'Alembert's principle in Lagrange's form, the virtual power of a mass element of a body at s is that of its
acceleration less gravity: for x = r + R s it is quadratic in s, whose moments the parameters are.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias, cast

from flint import arb

from symgen.model.combinations.ball_matrices import Matrix
from symgen.model.combinations.motion_states import BallSystem, MotionState
from symgen.model.combinations.taylor_balls import Ball, TimeSeries, series_of
from symgen.model.configurations.gradient import Gradients
from symgen.model.kinematics.float_kinematics import FloatArithmetic
from symgen.model.kinematics.walk import Kinematics

_Form: TypeAlias = Any
_Vector: TypeAlias = Sequence[Ball]


class ConstrainedRegressor:
    """The regressor of the inertial parameters of one system in balls."""

    def __init__(self, system: BallSystem) -> None:
        self._system, self._mechanism = system, system.model.mechanism
        self._frames = list(dict.fromkeys(body.frame for body in self._mechanism.bodies))
        self._index = {c.name: j for j, c in enumerate(system.model.coordinates)}
        self._definitions = {one.name: one.value for one in system.model.definitions}
        numeric = system.numeric
        still = Gradients(numeric.defaults, {}, self._definitions, numbers=numeric.numbers)
        self._gravity = [series_of(still.of(entry)[0]).c[0] for entry in self._mechanism.gravity]

    def rows(self, state: MotionState) -> Matrix:
        """delta rows, a column for each of `inertial_parameters`."""
        along, instant = self._kinematics(state.q, {}), self._kinematics(_at_once(state.q), self._index)
        by_frame = {
            frame: _shown(along, instant, frame, self._gravity, state.directions) for frame in self._frames
        }
        made: Matrix = []
        for k in range(len(state.directions[0])):
            row = [entry for body in self._mechanism.bodies for entry in by_frame[body.frame][k]]
            for rotor in self._mechanism.rotor_inertias:
                j = self._index[rotor.coordinate]
                row.append(state.directions[j][k] * 2 * state.q[j].c[2])
            made.append(row)
        return made

    def _kinematics(self, q: Sequence[TimeSeries], index: dict[str, int]) -> Kinematics[float, _Form]:
        numeric = self._system.numeric
        named = {c.name: cast(float, x) for c, x in zip(self._system.model.coordinates, q, strict=True)}
        gradients = Gradients({**numeric.defaults, **named}, index, self._definitions, numbers=numeric.numbers)
        return Kinematics(self._mechanism, FloatArithmetic(gradients), False)


def _at_once(q: Sequence[TimeSeries]) -> list[TimeSeries]:
    return [TimeSeries(one.c[:1]) for one in q]


def _shown(
    along: Kinematics[float, _Form],
    instant: Kinematics[float, _Form],
    frame: str,
    gravity: _Vector,
    directions: Matrix,
) -> list[list[Ball]]:
    """For each direction what the ten parameters of a body with this frame add."""
    axes = [[series_of(entry) for entry in row] for row in along.axes(frame)]
    origin = [series_of(entry) for entry in along.origin(frame)]
    turned = [[axes[i][k].c[0] for i in range(3)] for k in range(3)]  # R^T
    felt = [2 * origin[i].c[2] - gravity[i] for i in range(3)]
    acceleration = [_dot(row, felt) for row in turned]
    # R^T R''
    bending = [[_dot(row, [2 * axes[i][k].c[2] for i in range(3)]) for k in range(3)] for row in turned]
    twist = instant.twist(frame)
    return [
        _ten(
            [_along(form, directions, k) for form in twist.linear],
            [_along(form, directions, k) for form in twist.angular],
            acceleration,
            bending,
        )
        for k in range(len(directions[0]))
    ]


def _ten(moved: _Vector, turned: _Vector, acceleration: _Vector, bending: Matrix) -> list[Ball]:
    """Mass, first moments, inertias: in the body's axes, for a virtual motion of its frame."""
    wx, wy, wz = turned
    zero = arb(0)
    # w x e_k
    arms = ((zero, wz, -wy), (-wz, zero, wx), (wy, -wx, zero))
    columns = [[bending[i][k] for i in range(3)] for k in range(3)]
    first = [_dot(moved, columns[k]) + _dot(arms[k], acceleration) for k in range(3)]
    # of the moments of x x, y y, z z, and of x y, x z, y z
    squares = [_dot(arms[k], columns[k]) for k in range(3)]
    mixed = [_dot(arms[k], columns[j]) + _dot(arms[j], columns[k]) for k, j in ((0, 1), (0, 2), (1, 2))]
    # I_xx is that of y y and z z: moments are half of the trace less the tensor
    half = sum(squares, zero) / 2
    return [_dot(moved, acceleration), *first, *(half - one for one in squares), *(-one for one in mixed)]


def _dot(left: _Vector, right: _Vector) -> Ball:
    return left[0] * right[0] + left[1] * right[1] + left[2] * right[2]


def _along(form: dict[int, Any], directions: Matrix, k: int) -> Ball:
    return sum((series_of(value).c[0] * directions[j][k] for j, value in form.items()), arb(0))
