"""NumPy as its user writes (27): batched `pinv`, with τ, B and M from CasADi's functions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import casadi
import numpy as np

from symgen.laboratory.bench.candidate import PythonCandidate
from symgen.model.model import Model
from symgen.witness.lagrange import differentiate


def numpy_pinv(model: Model) -> PythonCandidate:
    """u = (N M)⁺ N τ with `numpy.linalg.pinv`."""
    s = differentiate(model)
    arguments = [s.q, s.qd, s.qdd, s.p]
    parts = [s.balance, s.jacobian, s.control]
    packed = casadi.vertcat(*(casadi.vec(casadi.densify(x)) for x in parts))
    evaluate = casadi.Function("matrices", arguments, [packed])
    n, r, m = model.n, model.r, model.m

    def solve(values: Any) -> Any:
        tau = values[..., :n]
        B = np.swapaxes(values[..., n : n + r * n].reshape(*values.shape[:-1], n, r), -1, -2)
        M = np.swapaxes(values[..., n + r * n :].reshape(*values.shape[:-1], m, n), -1, -2)
        N = np.eye(n) - np.linalg.pinv(B) @ B if r else np.broadcast_to(np.eye(n), (*values.shape[:-1], n, n))
        inverse = np.linalg.pinv(N @ M, rcond=1e-9)
        return (inverse @ (N @ tau[..., None]))[..., 0]

    def batch(q: Any, qd: Any, qdd: Any, p: Any) -> Any:
        return solve(np.ascontiguousarray(evaluate(q.T, qd.T, qdd.T, p.T).full().T))

    def single(q: Sequence[float], qd: Sequence[float], qdd: Sequence[float], p: Sequence[float]) -> Any:
        return solve(evaluate(q, qd, qdd, p).full().ravel())

    return PythonCandidate("NumPy", "pinv", batch, single)
