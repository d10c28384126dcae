"""The regressor: the least inputs for a unit of each inertial parameter, u = Y pi for bodies alone."""

from __future__ import annotations

from symgen.mechanics.system import System
from symgen.methods.derivation import Derivation
from symgen.model.inertial_base import InertialBase
from symgen.symbolic.matrix import Matrix, Vector, matmul, transpose
from symgen.symbolic.translate import translate


def regressor(d: Derivation) -> Matrix:
    """Y = M~^+ Y_tau (m x p), with what each inertial parameter loads the coordinates with as columns of Y_tau.

    The pseudoinverse is made once; what loads no coordinate is a column of zeros.
    """
    return _least_inputs(d, inertial_columns(d.mechanics))


def base_regressor(d: Derivation) -> Matrix:
    """The columns of Y for parameters that stand for all (m x p_b): Y pi = Y_base beta on the constraints."""
    return _least_inputs(d, base_columns(d.mechanics))


def base_parameters(d: Derivation) -> Vector:
    """beta (p_b): each parameter that stays, and what the others add to it."""
    base = _base(d.mechanics)
    return tuple(translate(d.graph, value, d.mechanics.names) for value in base.values)


def base_columns(mechanics: System) -> tuple[Vector, ...]:
    """What parameters that stand for all load the coordinates with (n each)."""
    columns = inertial_columns(mechanics)
    return tuple(columns[k] for k in _base(mechanics).columns)


def inertial_columns(mechanics: System) -> tuple[Vector, ...]:
    """What each inertial parameter loads the coordinates with (n each)."""
    from symgen.mechanics.rigid_bodies import inertial_columns as columns  # other models start without it

    return columns.inertial_columns(mechanics.bodies, mechanics.model.mechanism, mechanics.qd, mechanics.qdd)


def _least_inputs(d: Derivation, columns: tuple[Vector, ...]) -> Matrix:
    return matmul(d.graph, d.control_pseudoinverse, transpose(columns, d.n), len(columns))


def _base(mechanics: System) -> InertialBase:
    base = mechanics.model.inertial_base
    assert base is not None
    return base
