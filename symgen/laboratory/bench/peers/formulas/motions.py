"""Accelerations and multipliers as an expert writes them with a symbolic tool: two methods, in the tool's own scalars.

G q_ddot + B' lambda = f, B q_ddot = -drift.  `schur` factors G and the Schur complement B G^-1 B'; `null space` takes a
basis of ker B from chosen coordinates, and the multipliers from the rows of the others (Featherstone, Rigid Body
Dynamics Algorithms, 2008, ch. 8; Murray, Li and Sastry, 1994, ch. 6).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from symgen.laboratory.bench.peers.engines.engine import Engine, Inputs, Matrix, Symbol
from symgen.laboratory.bench.peers.formulas.algebra import (
    dot,
    eliminate,
    ldl_solve,
    named,
    null_space_basis,
    product,
    total,
    transposed,
    zero,
)
from symgen.laboratory.bench.peers.formulas.frames import written
from symgen.model.model import Model


@dataclass(frozen=True, slots=True)
class MotionSystem:
    """G (n x n), f = M u - C q_dot - Q + Q_a (n), B (r x n) and the drift B_dot q_dot (r)."""

    inputs: Inputs
    G: Matrix
    force: list[Symbol]
    B: Matrix
    drift: list[Symbol]


def motion_system(engine: Engine, model: Model) -> MotionSystem:
    """From the energies, by the tool's own derivatives along directions."""
    s = written(engine, model)
    q, qd, u = s.inputs["q"], s.inputs["qd"], engine.symbols("u", len(model.inputs))
    momentum = engine.gradient(s.kinetic, qd)
    upper = [engine.gradient(p, qd[i:]) for i, p in enumerate(momentum)]
    G = [[engine.name(upper[min(i, j)][abs(i - j)]) for j in range(model.n)] for i in range(model.n)]
    turning = engine.rates(momentum, q, qd)
    shifts = engine.gradient(s.kinetic - s.potential, q)
    force = [
        engine.name(total(engine, [dot(engine, row, u), -rate, shift, applied]))
        for row, rate, shift, applied in zip(s.control, turning, shifts, s.applied, strict=True)
    ]
    geometric = [engine.gradient(row, q) for row in s.geometric]
    rates = [*(dot(engine, row, qd) for row in geometric), *s.nonholonomic]
    B = named(engine, [*geometric, *(engine.gradient(row, qd) for row in s.nonholonomic)])
    drift = [engine.name(x) for x in engine.rates(rates, q, qd)]
    inputs = {"q": q, "qd": qd, "u": u, "p": s.inputs["p"]}
    return MotionSystem(inputs, G, force, B, drift)


def schur(engine: Engine, s: MotionSystem) -> tuple[list[Symbol], list[Symbol]]:
    """q_ddot and lambda through factors of G."""
    free, *moved = ldl_solve(engine, s.G, [s.force, *s.B])
    if not s.B:
        return free, []
    complement = named(engine, product(engine, s.B, transposed(moved)))
    right = [engine.name(dot(engine, row, free) + own) for row, own in zip(s.B, s.drift, strict=True)]
    (multipliers,) = ldl_solve(engine, complement, [right])
    columns = transposed(moved)
    return [x - dot(engine, row, multipliers) for x, row in zip(free, columns, strict=True)], multipliers


def along_null_space(
    engine: Engine, s: MotionSystem, independent: Sequence[int]
) -> tuple[list[Symbol], list[Symbol]]:
    """q_ddot = W y + a with B W = 0, B a = -drift, and lambda from the rows of the dependent coordinates."""
    n = len(s.G)
    dependent = [i for i in range(n) if i not in independent]
    basis, (held,) = null_space_basis(engine, s.B, n, independent, [s.drift])
    beside = dict(zip(dependent, held, strict=True))
    particular = [-beside[k] if k in beside else zero(engine) for k in range(n)]
    rest = [engine.name(f - dot(engine, row, particular)) for f, row in zip(s.force, s.G, strict=True)]
    pushed = named(engine, product(engine, basis, s.G))
    normal = named(engine, product(engine, pushed, transposed(basis)))
    (y,) = ldl_solve(engine, normal, [[engine.name(dot(engine, w, rest)) for w in basis]])
    moving = [dot(engine, [w[k] for w in basis], y) for k in range(n)]
    accelerations = [engine.name(total(engine, pair)) for pair in zip(moving, particular, strict=True)]
    left = [engine.name(s.force[i] - dot(engine, s.G[i], accelerations)) for i in dependent]
    (multipliers,) = eliminate(engine, [[row[i] for row in s.B] for i in dependent], [left])
    return accelerations, multipliers
