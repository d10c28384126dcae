"""Derivatives of u where choices fail: those of the generated kernel beside those of the paper's formulas.

Formulas that choose coordinates (9) or inputs (28) are differentiated by CasADi, in double precision.  Off the
constraints each of them is another function; along changes that constraints allow (`constraint_variations`) all
have the same derivatives, and these are compared with the reference.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import casadi
import numpy as np

from symgen.generation.runnable import rounded_state
from symgen.laboratory.stress.families import Family
from symgen.laboratory.stress.series import FIXED, PARTITION, SYMGEN
from symgen.lowering.schedule import schedule
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.verify.interpreted import outcomes
from symgen.verify.reference.reference import Reference, State
from symgen.witness.lagrange import Lagrange, differentiate

Values: TypeAlias = Any  # array of float64
JACOBIAN, VARIATIONS = "inverse_dynamics_jacobian", "constraint_variations"
DEEPEST = 24  # half decades below 1


@dataclass(frozen=True, slots=True)
class DerivativeErrors:
    """Of one method: (d, |J X - J* X| / |J* X|) from d = 1 downwards, infinite where it has no result."""

    method: str
    errors: tuple[tuple[float, float], ...]


def derivative_errors(model: Model, reference: Reference, family: Family) -> tuple[DerivativeErrors, ...]:
    """The largest errors of each method over the curves of a family whose choices fail."""
    selection = derive_quantities(model, (JACOBIAN,))
    program = schedule(selection.mechanics, selection.quantities, ("float64",))["float64"]
    lagrange = differentiate(model)
    formulas = {
        PARTITION: _slopes(lagrange, _partitioned(lagrange, family.partitions[0])),
        FIXED: _slopes(lagrange, _projected(lagrange, family.inputs[0])),
    }
    worst: dict[str, dict[float, float]] = {name: {} for name in (*formulas, SYMGEN)}
    for k in range(DEEPEST + 1):
        d = 10 ** (-k / 2)
        for state in (curve(d) for curve in family.curves):
            if state is None:
                continue
            at = rounded_state(state, "float64")
            exact, variations = _exact(reference, at)
            given = [np.array(x) for x in (at.q, at.qd, at.qdd, at.parameters)]
            slopes_of = {name: np.array(formula(*given)) for name, formula in formulas.items()}
            outcome = outcomes(program.kernels[0], program.sincos, "float64", [at])[0]
            slopes_of[SYMGEN] = np.array(outcome.entries).reshape(exact.shape) if outcome.valid else exact * np.nan
            for name, slopes in slopes_of.items():
                error = float(np.linalg.norm((slopes - exact) @ variations) / np.linalg.norm(exact @ variations))
                worst[name][d] = max(worst[name].get(d, 0.0), error if np.isfinite(error) else np.inf)
    return tuple(DerivativeErrors(name, tuple(errors.items())) for name, errors in worst.items())


def _exact(reference: Reference, state: State) -> tuple[Values, Values]:
    """J* (m x 3n) and X (3n x 3n) to double precision."""
    made = reference.evaluate(state, (JACOBIAN, VARIATIONS))
    columns = 3 * reference.model.n
    first, second = (np.array([float(x.mid()) for x in made[name]]) for name in (JACOBIAN, VARIATIONS))
    return first.reshape(-1, columns), second.reshape(-1, columns)


def _slopes(s: Lagrange, u: casadi.SX) -> casadi.Function:
    by = casadi.vertcat(s.q, s.qd, s.qdd)
    return casadi.Function("slopes", [s.q, s.qd, s.qdd, s.p], [casadi.densify(casadi.jacobian(u, by))])


def _partitioned(s: Lagrange, independent: Sequence[int]) -> casadi.SX:
    """u by (9), of least norm where inputs are redundant."""
    n = s.q.shape[0]
    chosen, dependent = list(independent), [j for j in range(n) if j not in independent]
    F, F_dot = casadi.SX.zeros(n, len(chosen)), casadi.SX.zeros(n, len(chosen))
    first = casadi.inv(s.jacobian[:, dependent])
    F[chosen, :] = casadi.SX.eye(len(chosen))
    F[dependent, :] = -first @ s.jacobian[:, chosen]
    F_dot[dependent, :] = -first @ (s.jacobian_dot @ F)
    accelerations = F @ s.qdd[chosen] + F_dot @ s.qd[chosen]
    force = F.T @ (s.mass @ accelerations + s.coriolis_force + s.potential_force - s.applied_force)
    M = F.T @ s.control
    return M.T @ (casadi.inv(M @ M.T) @ force)


def _projected(s: Lagrange, first: Sequence[int]) -> casadi.SX:
    """u by (27) with (28): the columns `first` of N_B M span the others, M_1 V = M_2."""
    B, columns = s.jacobian, list(first)
    N = casadi.SX.eye(s.q.shape[0]) - B.T @ casadi.inv(B @ B.T) @ B
    M = N @ s.control
    others = [j for j in range(M.shape[1]) if j not in columns]
    M_1 = M[:, columns]
    inverse = casadi.inv(M_1.T @ M_1) @ M_1.T
    V = inverse @ M[:, others]
    W = casadi.horzcat(casadi.SX.eye(len(columns)), V)
    spread = W.T @ casadi.inv(W @ W.T) @ inverse @ (N @ s.balance)
    u = casadi.SX.zeros(M.shape[1])
    u[[*columns, *others]] = spread
    return u
