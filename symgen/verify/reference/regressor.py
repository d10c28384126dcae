"""The regressor by definition: M~+ of the loads of point masses, whose moments the inertial parameters are.

By d'Alembert's principle a mass of 1 at the place s of a frame loads the coordinates with
f(s) = J' (J qdd + J_dot qd - g), which is quadratic in s.  So the load of a body is m f(0) + h . f_s + sum S_ij f_ij,
where S = tr(I)/2 - I holds the second moments of its inertia I about the origin; ten values of f give all of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any
from weakref import WeakKeyDictionary

from flint import arb_mat

from symgen.model.mechanism import AXES
from symgen.verify.reference.arithmetic.linear import column
from symgen.verify.reference.configurations.parts import piece, placed
from symgen.verify.reference.evaluation import Evaluation
from symgen.verify.reference.mechanism.bodies import BODY_ROWS
from symgen.verify.reference.mechanism.point_masses import PLACES, frames_with_bodies, with_point_masses
from symgen.verify.reference.system import ReferenceSystem
from symgen.verify.reference.translation import literal_values

_KNOWN: WeakKeyDictionary[ReferenceSystem, ReferenceSystem] = WeakKeyDictionary()
PAIRS = ((0, 1), (0, 2), (1, 2))


def regressor(e: Evaluation) -> Any:
    """Y (m x p): the least inputs for a unit of m, mx, my, mz, Ixx, Iyy, Izz, Ixy, Ixz, Iyz of each body, then of Ir of
    each rotor."""
    return e.control_inverse * (e.projector * loads_of_units(e))


def loads_of_units(e: Evaluation) -> Any:
    """What a unit of each loads the coordinates with (n x p)."""
    mechanism, n = e.system.model.mechanism, e.system.n
    by_frame = dict(zip(frames_with_bodies(e.system.model), _columns(e), strict=True))
    columns = [one for body in mechanism.bodies for one in by_frame[body.frame]]
    names = [coordinate.name for coordinate in e.system.model.coordinates]
    for rotor in mechanism.rotor_inertias:
        j = names.index(rotor.coordinate)
        columns.append(placed(n, 1, [((j,), (0,), column([e.qdd[j]]))]))
    return arb_mat(n, len(columns), [one[i, 0] for i in range(n) for one in columns])


def _columns(e: Evaluation) -> Iterator[list[Any]]:
    """For each frame that carries bodies the loads for a unit of each of their ten parameters."""
    loads = _loads(_of_point_masses(e))
    for start in range(0, len(loads), len(PLACES)):
        at = dict(zip(PLACES, loads[start : start + len(PLACES)], strict=True))
        origin = at[0, 0, 0]
        ahead, behind = ([at[_along(k, sign)] for k in range(len(AXES))] for sign in (1, -1))
        first = [(one - other) / 2 for one, other in zip(ahead, behind, strict=True)]
        squares = [(one + other) / 2 - origin for one, other in zip(ahead, behind, strict=True)]
        half = (squares[0] + squares[1] + squares[2]) / 2
        mixed = [at[_between(i, j)] - ahead[i] - ahead[j] + origin for i, j in PAIRS]
        yield [origin, *first, *(half - one for one in squares), *(-one for one in mixed)]


def _along(axis: int, sign: int) -> tuple[int, int, int]:
    x, y, z = (sign * int(k == axis) for k in range(3))
    return x, y, z


def _between(one: int, other: int) -> tuple[int, int, int]:
    x, y, z = (int(k in (one, other)) for k in range(3))
    return x, y, z


def _of_point_masses(e: Evaluation) -> Evaluation:
    """The same state with point masses in the place of bodies."""
    if e.system not in _KNOWN:
        _KNOWN[e.system] = ReferenceSystem(with_point_masses(e.system.model))
    return of_other_bodies(e, _KNOWN[e.system])


def of_other_bodies(e: Evaluation, system: ReferenceSystem) -> Evaluation:
    """The same state of a system that is made of parts of this one."""
    own = {id(literal): value for literal, value in zip(e.system.literals, e.literals, strict=True)}
    literals = [own[id(x)] if id(x) in own else literal_values([x])[0] for x in system.literals]
    return Evaluation(system, e.ranks, e.q, e.qd, e.qdd, (), e.parameters, literals)


def _loads(e: Evaluation) -> Sequence[Any]:
    """What each of the point masses loads the coordinates with (n x 1)."""
    gravity = arb_mat(3, 1, e.system.gravity(e.parameters, e.literals))
    jacobian, n = e.at.jacobian, e.system.n
    loads: dict[int, Any] = {}
    for part, rows, rates in zip(jacobian.parts, jacobian.pieces, e.body_rates(e.rate), strict=True):
        qdd, qd = (piece(vector, part.coordinates, (0,)) for vector in (column(e.qdd), e.rate))
        accelerations = rows * qdd + rates * qd
        for place, mass in enumerate(part.bodies):
            own = range(BODY_ROWS * place, BODY_ROWS * place + 3)
            pushed = piece(rows, own, range(rows.ncols())).transpose() * (piece(accelerations, own, (0,)) - gravity)
            loads[mass] = placed(n, 1, [(part.coordinates, (0,), pushed)])
    return [loads[mass] for mass in sorted(loads)]
