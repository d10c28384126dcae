"""The three cheap methods of u that are equal to (27) with (28) wherever the system is fully actuated.

u is the minimum-norm solution of M u + Bᵀλ = τ.  `lean` projects with B Bᵀ on vectors; `part` takes any basis F of
ker B, made from a choice of independent coordinates; `elimination` is for M that selects coordinates.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction

from symgen.laboratory.bench.peers.engines.engine import Engine, Matrix, Symbol
from symgen.laboratory.bench.peers.formulas.algebra import (
    cholesky_solve,
    dot,
    eliminate,
    ldl_solve,
    named,
    null_space_basis,
    product,
    transposed,
)
from symgen.laboratory.bench.peers.formulas.mechanics import PeerSystem

Solver = Callable[[Engine, Matrix, Matrix], Matrix]


def lean(engine: Engine, s: PeerSystem, solve: Solver = cholesky_solve) -> list[Symbol]:
    """(28) with its fixed choice of the first δ inputs; M~ = M − Bᵀ(B Bᵀ)⁻¹B M by columns, N_B never formed."""
    n, m, r = len(s.M), len(s.M[0]), len(s.B)
    delta = n - r
    moved = product(engine, s.B, s.M)
    columns = [j for j in range(m) if not all(engine.is_zero(row[j]) for row in moved)]
    projected = [list(row) for row in s.M]
    if columns:
        S = named(engine, product(engine, s.B, transposed(s.B)))
        solved = solve(engine, S, [[row[j] for row in moved] for j in columns])
        for j, x in zip(columns, solved, strict=True):
            for i in range(n):
                projected[i][j] = engine.name(s.M[i][j] - dot(engine, [row[i] for row in s.B], x))
    inputs = transposed(projected)
    first, rest = inputs[:delta], inputs[delta:]
    normal = named(engine, product(engine, first, transposed(first)))
    right = [[engine.name(dot(engine, a, b)) for a in first] for b in [*rest, s.balance]]
    *R, v = solve(engine, normal, right)  # R holds the columns of M~1⁺ M~2
    if not R:
        return v
    weight = product(engine, R, transposed(R))
    for k in range(len(R)):
        weight[k][k] = engine.number(Fraction(1)) + weight[k][k]
    (w,) = solve(engine, named(engine, weight), [[dot(engine, column, v) for column in R]])
    return [v[i] - dot(engine, [column[i] for column in R], w) for i in range(delta)] + w


def part(
    engine: Engine, s: PeerSystem, independent: Sequence[int], solve: Solver = cholesky_solve, direct: bool = False
) -> list[Symbol]:
    """F from the independent coordinates, A = FᵀM, u = Aᵀ(A Aᵀ)⁻¹Fᵀτ; `direct`: A u = Fᵀτ where m = δ."""
    m = len(s.M[0])
    basis, _ = null_space_basis(engine, named(engine, s.B), len(s.M), independent)  # the columns of F
    A = named(engine, product(engine, basis, s.M))
    right = [engine.name(dot(engine, f, s.balance)) for f in basis]
    if direct and m == len(basis):
        return eliminate(engine, A, [right])[0]
    (y,) = solve(engine, named(engine, product(engine, A, transposed(A))), [right])
    return [dot(engine, [row[j] for row in A], y) for j in range(m)]


def selected_rows(engine: Engine, M: Matrix) -> list[int] | None:
    """The coordinate each input acts on alone with coefficient 1, or None when M is more than such a selection."""
    rows = []
    for column in transposed(M):
        present = [i for i, entry in enumerate(column) if not engine.is_zero(entry)]
        if len(present) != 1 or not engine.is_zero(column[present[0]] - engine.number(Fraction(1))):
            return None
        rows += present
    return rows if len(set(rows)) == len(rows) else None


def elimination(engine: Engine, s: PeerSystem, free: Sequence[int]) -> list[Symbol]:
    """The passive rows give λ but for the `free` multipliers (m − δ of them), and these minimise the norm of u."""
    active = selected_rows(engine, s.M)
    assert active is not None
    passive = [i for i in range(len(s.M)) if i not in active]
    bound = [k for k in range(len(s.B)) if k not in free]
    B = named(engine, s.B)
    square = [[B[k][i] for k in bound] for i in passive]
    right = [[s.balance[i] for i in passive], *([B[k][i] for i in passive] for k in free)]
    given, *carried = eliminate(engine, square, right)

    def through(known: Symbol, i: int, multipliers: Sequence[Symbol]) -> Symbol:
        rest = dot(engine, [B[k][i] for k in bound], multipliers)
        return known if engine.is_zero(rest) else engine.name(known - rest)

    particular = [through(s.balance[i], i, given) for i in active]
    if not free:
        return particular
    Z = [[through(B[k][i], i, column) for i in active] for k, column in zip(free, carried, strict=True)]
    normal = named(engine, product(engine, Z, transposed(Z)))
    (y,) = ldl_solve(engine, normal, [[dot(engine, z, particular) for z in Z]])
    return [u - dot(engine, [z[j] for z in Z], y) for j, u in enumerate(particular)]
