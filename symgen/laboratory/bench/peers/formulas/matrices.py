"""The matrices of the motion equations as an expert writes them with a symbolic tool, row by row as symgen has them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import TypeAlias

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
)
from symgen.laboratory.bench.peers.formulas.frames import Written, written
from symgen.model.model import Model

Outputs: TypeAlias = list[Symbol]
# What is made of rows.
BY_ROWS = ("constraint_jacobian", "nullspace_projector", "nullspace_projector_dot")
# What takes a basis of ker B from chosen coordinates.
BY_BASIS = ("projected_control_pseudoinverse",)


def matrix_of(
    quantity: str, independent: Sequence[int] = ()
) -> Callable[[Engine, Model], tuple[Inputs, Outputs]] | None:
    """How a matrix is made, with the `independent` coordinates where a basis is; None for what is no such matrix."""
    make = _MATRICES.get(quantity)
    if make is None:
        return None

    def made(engine: Engine, model: Model) -> tuple[Inputs, Outputs]:
        s = written(engine, model)
        rows = make(engine, s, independent)
        return s.inputs, [entry for row in rows for entry in row]

    return made


def _mass_matrix(engine: Engine, s: Written, _: Sequence[int]) -> Matrix:
    momentum = engine.gradient(s.kinetic, s.inputs["qd"])
    n = len(momentum)
    upper = [engine.gradient(p, s.inputs["qd"][i:]) for i, p in enumerate(momentum)]
    return [[engine.name(upper[min(i, j)][abs(i - j)]) for j in range(n)] for i in range(n)]


def _coriolis_matrix(engine: Engine, s: Written, _: Sequence[int]) -> Matrix:
    """C_ij = (dG_ij/dt + d(G q_dot)_i/dq_j - d(G q_dot)_j/dq_i) / 2: the symbols of Christoffel along q_dot."""
    q, qd = s.inputs["q"], s.inputs["qd"]
    momentum = engine.gradient(s.kinetic, qd)
    n, half = len(momentum), engine.number(Fraction(1, 2))
    rates = [engine.rates(row, q, qd) for row in _mass_matrix(engine, s, ())]
    slopes = [engine.gradient(p, q) for p in momentum]
    return [
        [half * total(engine, [rates[i][j], slopes[i][j], -slopes[j][i]]) for j in range(n)] for i in range(n)
    ]


def _coriolis_force(engine: Engine, s: Written, _: Sequence[int]) -> Matrix:
    q, qd = s.inputs["q"], s.inputs["qd"]
    turning = engine.rates(engine.gradient(s.kinetic, qd), q, qd)
    return [[a - b] for a, b in zip(turning, engine.gradient(s.kinetic, q), strict=True)]


def _jacobian(engine: Engine, s: Written, _: Sequence[int]) -> Matrix:
    geometric = [engine.gradient(row, s.inputs["q"]) for row in s.geometric]
    return named(engine, [*geometric, *(engine.gradient(row, s.inputs["qd"]) for row in s.nonholonomic)])


def _projector(engine: Engine, s: Written, _: Sequence[int]) -> Matrix:
    """1 - B' (B B')^-1 B, of which one half is worked out."""
    B = _jacobian(engine, s, ())
    solved = ldl_solve(engine, named(engine, product(engine, B, transposed(B))), transposed(B))
    columns, n = transposed(B), len(B[0])
    one = engine.number(Fraction(1))
    upper = [
        [one - x if i == j else -x for j in range(i, n) for x in [dot(engine, columns[i], solved[j])]] for i in range(n)
    ]
    return [[engine.name(upper[min(i, j)][abs(i - j)]) for j in range(n)] for i in range(n)]


def _projector_dot(engine: Engine, s: Written, _: Sequence[int]) -> Matrix:
    """-(B+ B_dot N) - (B+ B_dot N)'."""
    q, qd = s.inputs["q"], s.inputs["qd"]
    B, N = _jacobian(engine, s, ()), _projector(engine, s, ())
    moved = named(engine, product(engine, [engine.rates(row, q, qd) for row in B], N))
    solved = ldl_solve(engine, named(engine, product(engine, B, transposed(B))), transposed(moved))
    half = named(engine, product(engine, transposed(B), transposed(solved)))
    n = len(half)
    return [[-(half[i][j] + half[j][i]) for j in range(n)] for i in range(n)]


def _control_inverse(engine: Engine, s: Written, independent: Sequence[int]) -> Matrix:
    """A+ W' with A = W' M for a basis W of ker B, where the inputs span all motions."""
    basis, _ = null_space_basis(engine, _jacobian(engine, s, ()), len(s.control), independent)
    A = named(engine, product(engine, basis, s.control))
    columns = transposed(basis)
    if len(A) == len(A[0]):
        return transposed(eliminate(engine, A, columns))
    shares = ldl_solve(engine, named(engine, product(engine, A, transposed(A))), columns)
    return product(engine, transposed(A), transposed(shares))


_MATRICES: Mapping[str, Callable[[Engine, Written, Sequence[int]], Matrix]] = {
    "mass_matrix": _mass_matrix,
    "coriolis_matrix": _coriolis_matrix,
    "coriolis_force": _coriolis_force,
    "constraint_jacobian": _jacobian,
    "nullspace_projector": _projector,
    "nullspace_projector_dot": _projector_dot,
    "projected_control_pseudoinverse": _control_inverse,
}
