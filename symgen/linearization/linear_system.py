"""A x + B v of a mechanism near a configuration at rest, in orthonormal bases of what its constraints allow.

x stands for changes of configuration along ker B_g and of rates along ker B, v for changes of the inputs.  At rest
q_ddot = J_q dq + J_v dq_dot + J_u du (forward_dynamics_jacobian), of which the part along ker B is free.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from symgen.generation.requested import check_known, configuration_near
from symgen.model.availability import lacking
from symgen.model.model import Model
from symgen.model.quantities import ROWS
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.parameter_values import default_parameters
from symgen.verify.reference.reference import REFERENCE_BITS, Reference, ReferenceValueError, State

Array: TypeAlias = NDArray[np.float64]
Poles: TypeAlias = NDArray[np.complex128]
JACOBIAN = "forward_dynamics_jacobian"
# Newton steps from a start to where the loops close, two at a time, and how far they are open then.
STEPS_TO_CLOSE, SHUT = 20, 1e-30
# Accelerations that count as none, against those without inputs and of a g.
HELD_STILL = 1e-12
# Of a direction of a basis: less is a rounding of none.
DIRECTION = 1e-9
# Of the largest singular value: a pole that inputs do not reach has less.
REACHED = 1e-9


class NotLinearizedError(Exception):
    """There is no linear system here; the text says why."""


@dataclass(frozen=True)
class LinearSystem:
    """x' = A x + B v at a configuration at rest.

    `of_places` (n x k) and `of_rates` (n x delta) are the bases: dq = of_places x[:k], dq_dot = of_rates x[k:].
    """

    model: Model
    q: Array
    u: Array
    of_places: Array
    of_rates: Array
    a: Array
    b: Array

    @property
    def poles(self) -> Poles:
        """The eigenvalues of A, the least stable first."""
        return sorted_poles(self.a)

    @property
    def unreached(self) -> Poles:
        """The poles that no input moves (Popov, Belevitch and Hautus)."""
        size = len(self.a)
        scale = np.linalg.norm(np.hstack([self.a, self.b]), 2)
        unmoved = [
            pole
            for pole in self.poles
            if np.linalg.svd(np.hstack([self.a - pole * np.eye(size), self.b]), compute_uv=False)[-1] < REACHED * scale
        ]
        return np.array(unmoved, dtype=complex)


def linearized(model: Model, start: Mapping[str, float]) -> LinearSystem:
    """The linear system at the file's configuration, or at the `start` where that has a coordinate.

    Raises NotLinearizedError where the loops do not close, the inputs do not hold it still, or it has no derivatives.
    """
    check_known(model, "start", start, [c.name for c in model.coordinates])
    try:
        return _Equilibrium(Reference(model), start).system()
    except ReferenceValueError as reason:
        raise NotLinearizedError(str(reason)) from reason


def sorted_poles(matrix: Array) -> Poles:
    """The eigenvalues, the least stable first, conjugate ones beside each other."""
    poles: Poles = np.linalg.eigvals(matrix).astype(complex)
    return poles[np.lexsort((-poles.imag, abs(poles.imag).round(9), -poles.real.round(9)))]


class _Equilibrium:
    """A configuration at rest, with the inputs that hold it."""

    def __init__(self, reference: Reference, start: Mapping[str, float]) -> None:
        self._reference, self._model = reference, reference.model
        ranks, n = reference.ranks, self._model.n
        reason = lacking(ROWS[JACOBIAN], self._model, n - ranks.constraints, ranks.actuation)
        if reason is not None:
            raise NotLinearizedError(f"no linear system: {reason}")
        with precision(REFERENCE_BITS):
            self._parameters = tuple(x.mid() for x in default_parameters(self._model))
        self._none = (Fraction(0),) * n
        self._u: tuple[Any, ...] = (Fraction(0),) * self._model.m
        self._q: tuple[Any, ...] = tuple(map(Fraction, configuration_near(self._model, start)))
        self._close()

    def system(self) -> LinearSystem:
        """Its linear system."""
        free = self._accelerations()
        if self._model.m:
            self._u = tuple(x.mid() for x in self._evaluated("inverse_dynamics").ravel())
        left = self._accelerations()
        if np.linalg.norm(left) > HELD_STILL * (np.linalg.norm(free) + 1):
            worst = self._model.coordinates[int(np.argmax(abs(left)))].name
            raise NotLinearizedError(
                f"no equilibrium: the inputs do not hold it still there, {worst} accelerates by "
                f"{left[np.argmax(abs(left))]:.3g}; remedy: another place with --start"
            )
        n, m = self._model.n, self._model.m
        allowed = _numbers(self._evaluated("constraint_variations")) if self._model.r else np.eye(2 * n)
        places, rates = _basis(allowed[:n, :n]), _basis(allowed[n : 2 * n, n : 2 * n])
        slopes = _numbers(self._evaluated(JACOBIAN))
        of_places, of_rates = rates.T @ slopes[:, :n] @ places, rates.T @ slopes[:, n : 2 * n] @ rates
        k = places.shape[1]
        a = np.block([[np.zeros((k, k)), places.T @ rates], [of_places, of_rates]])
        b = np.vstack([np.zeros((k, m)), rates.T @ slopes[:, 2 * n :]])
        return LinearSystem(self._model, _numbers(self._q), _numbers(self._u), places, rates, a, b)

    def _close(self) -> None:
        """Goes where Newton's method leads; the loops are closed there."""
        for _ in range(STEPS_TO_CLOSE):
            row, gap = self._widest_gap()
            if gap <= SHUT:
                return
            self._q = tuple(x.mid() for x in self._evaluated("projected_configuration").ravel())
        raise NotLinearizedError(f"no configuration: {row} stays open by {gap:.3g}; remedy: a nearer --start")

    def _widest_gap(self) -> tuple[str, float]:
        """The geometric row that is least closed, and how far it is open."""
        if not self._reference.system.r_geometric:
            return "", 0.0
        gaps = abs(_numbers(self._evaluated("constraint_residual"))).ravel()
        return self._model.constraints[int(np.argmax(gaps))].name, float(gaps.max())

    def _accelerations(self) -> Array:
        return _numbers(self._evaluated("forward_dynamics")).ravel()

    def _evaluated(self, quantity: str) -> NDArray[Any]:
        """A quantity at rest, as balls."""
        state = State(self._q, self._none, self._none, self._u, self._parameters)
        matrix = self._reference.precise(state, (quantity,))[quantity]
        return np.array(matrix.entries(), dtype=object).reshape(matrix.nrows(), matrix.ncols())


def _numbers(values: Sequence[Any] | NDArray[Any]) -> Array:
    return np.vectorize(float, otypes=[np.float64])(np.array(values, dtype=object)) if len(values) else np.zeros(0)


def _basis(projector: Array) -> Array:
    """An orthonormal basis (n x k) of what a projector leaves.

    Each direction is along the coordinate that moves most freely beside those before it (Gram and Schmidt, pivoted), so
    that it is the same everywhere and most of its entries are 0.
    """
    left, directions = projector, list[Array]()
    for _ in range(round(np.trace(projector))):
        place = int(np.argmax(np.diag(left).round(9)))
        direction = left[:, place] / np.sqrt(left[place, place])
        directions.append(np.where(abs(direction) < DIRECTION, 0.0, direction))
        left = left - np.outer(direction, direction)
    return np.array(directions).T.reshape(len(projector), len(directions))
