"""Plain C on numeric matrices: Householder reflections of Bᵀ applied to [M τ], then least squares of least norm.

τ, B and M come from CasADi's C.  No choice of coordinates and no normal equations; the safe way at run time.
"""

from __future__ import annotations

import casadi

from symgen.laboratory.bench.candidate import CUnit
from symgen.laboratory.bench.peers.engines.casadi_engine import generated
from symgen.laboratory.bench.peers.formulas.native import user_matrices
from symgen.model.model import Model
from symgen.witness.lagrange import Lagrange

_SOURCE = """#include <math.h>
enum { N = %(n)d, R = %(r)d, M = %(m)d, D = N - R };
int %(matrices)s(const REAL **, REAL **, long long *, REAL *, int);
int %(entry)s(const REAL *q, const REAL *qd, const REAL *qdd, const REAL *p, REAL *u);

/* Column-major a (rows x columns): reflect its first `steps` columns to upper triangular form. */
static void reflect(REAL *a, int rows, int columns, int steps)
{
    for (int k = 0; k < steps; ++k) {
        REAL *v = a + k * rows;
        REAL square = 0;
        for (int i = k; i < rows; ++i) {
            square += v[i] * v[i];
        }
        const REAL length = v[k] >= 0 ? -sqrt(square) : sqrt(square);
        v[k] -= length;
        const REAL scale = length * v[k];
        for (int j = k + 1; j < columns; ++j) {
            REAL *x = a + j * rows;
            REAL sum = 0;
            for (int i = k; i < rows; ++i) {
                sum += v[i] * x[i];
            }
            sum /= scale;
            for (int i = k; i < rows; ++i) {
                x[i] += sum * v[i];
            }
        }
        v[k] = length;
    }
}

int %(entry)s(const REAL *q, const REAL *qd, const REAL *qdd, const REAL *p, REAL *u)
{
    REAL work[N * (R + M + 1)];
    const REAL *arguments[4] = {q, qd, qdd, p};
    REAL *results[1] = {work};
    %(matrices)s(arguments, results, 0, 0, 0);
    reflect(work, N, R + M + 1, R);
    const REAL *a = work + N * R + R, *b = work + N * (R + M) + R;
%(solve)s
    return 0;
}
"""
_LEAST_NORM = """    /* A u = b, no fewer inputs than rows: A' = Q S, S' y = b, u = Q y by the same reflections. */
    REAL t[M * (D + M)];
    for (int i = 0; i < D; ++i) {
        for (int j = 0; j < M; ++j) {
            t[i * M + j] = a[j * N + i];
        }
    }
    for (int j = 0; j < M; ++j) {
        for (int i = 0; i < M; ++i) {
            t[(D + j) * M + i] = i == j;
        }
    }
    reflect(t, M, D + M, D);
    REAL y[D];
    for (int k = 0; k < D; ++k) {
        REAL sum = b[k];
        for (int i = 0; i < k; ++i) {
            sum -= t[k * M + i] * y[i];
        }
        y[k] = sum / t[k * M + k];
    }
    for (int j = 0; j < M; ++j) {
        u[j] = 0;
        for (int k = 0; k < D; ++k) {
            u[j] += t[(D + j) * M + k] * y[k];
        }
    }"""
_LEAST_SQUARES = """    /* More rows than inputs: reflect [A b] and substitute back. */
    REAL t[D * (M + 1)];
    for (int i = 0; i < D; ++i) {
        for (int j = 0; j < M; ++j) {
            t[j * D + i] = a[j * N + i];
        }
        t[M * D + i] = b[i];
    }
    reflect(t, D, M + 1, M);
    for (int k = M - 1; k >= 0; --k) {
        REAL sum = t[M * D + k];
        for (int j = k + 1; j < M; ++j) {
            sum -= t[j * D + k] * u[j];
        }
        u[k] = sum / t[k * D + k];
    }"""


def householder_units(model: Model, s: Lagrange, entry: str) -> tuple[tuple[CUnit, ...], tuple[str, ...]]:
    """The units and the functions that count."""
    n, r, m = model.n, model.r, model.m
    matrices = f"{entry}_matrices"
    value = casadi.densify(casadi.horzcat(s.jacobian.T, s.control, user_matrices(s)))
    source, functions = generated(matrices, [s.q, s.qd, s.qdd, s.p], casadi.vec(value))
    solve = _LEAST_NORM if m >= n - r else _LEAST_SQUARES
    own = _SOURCE % {"n": n, "r": r, "m": m, "matrices": matrices, "entry": entry, "solve": solve}
    return (CUnit(source), CUnit(own)), (*functions, entry, "reflect")
