"""Linear algebra on scalars of any tool: products without the terms known to vanish, Cholesky, elimination."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from symgen.laboratory.bench.peers.engines.engine import Engine, Matrix, Symbol

Row = Sequence[Symbol]


class DeadPivotError(Exception):
    """A method divides by what is 0 at every state: a fixed choice of columns, or a mass matrix without some mass."""


def zero(engine: Engine) -> Symbol:
    """The number 0 in the tool."""
    return engine.number(Fraction(0))


def total(engine: Engine, terms: Sequence[Symbol]) -> Symbol:
    """The sum of the terms that are not 0."""
    present = [term for term in terms if not engine.is_zero(term)]
    if not present:
        return zero(engine)
    result = present[0]
    for term in present[1:]:
        result = result + term
    return result


def dot(engine: Engine, left: Row, right: Row) -> Symbol:
    """Σ left_i right_i."""
    return total(
        engine, [a * b for a, b in zip(left, right, strict=True) if not (engine.is_zero(a) or engine.is_zero(b))]
    )


def transposed(matrix: Matrix) -> Matrix:
    """The transpose of a matrix with at least one row."""
    return [list(column) for column in zip(*matrix, strict=True)]


def product(engine: Engine, left: Matrix, right: Matrix) -> Matrix:
    """left @ right."""
    columns = transposed(right)
    return [[dot(engine, row, column) for column in columns] for row in left]


def named(engine: Engine, matrix: Matrix) -> Matrix:
    """Every entry as an intermediate."""
    return [[engine.name(entry) for entry in row] for row in matrix]


def cholesky_solve(engine: Engine, S: Matrix, columns: Matrix) -> Matrix:
    """S⁻¹ applied to each of the columns, for symmetric positive definite S = L Lᵀ."""
    n = len(S)
    L: Matrix = [[] for _ in range(n)]
    for j in range(n):
        L[j].append(engine.name(engine.call("sqrt", [S[j][j] - dot(engine, L[j], L[j])])))
        for i in range(j + 1, n):
            L[i].append(engine.name((S[i][j] - dot(engine, L[i][:j], L[j][:j])) / L[j][j]))
    solutions = []
    for column in columns:
        y: list[Symbol] = []
        for i in range(n):
            y.append(engine.name((column[i] - dot(engine, L[i][:i], y)) / L[i][i]))
        solutions.append(_back(engine, L, y, [L[i][i] for i in range(n)]))
    return solutions


def ldl_solve(engine: Engine, S: Matrix, columns: Matrix) -> Matrix:
    """S⁻¹ applied to each of the columns, for symmetric positive definite S = L D Lᵀ: no roots, fewer divisions."""
    n = len(S)
    L: Matrix = [[] for _ in range(n)]
    D: list[Symbol] = []
    for j in range(n):
        scaled = [L[j][k] * D[k] for k in range(j)]
        D.append(engine.name(S[j][j] - dot(engine, L[j][:j], scaled)))
        for i in range(j + 1, n):
            L[i].append(engine.name((S[i][j] - dot(engine, L[i][:j], scaled)) / D[j]))
    solutions = []
    for column in columns:
        y: list[Symbol] = []
        for i in range(n):
            y.append(engine.name(column[i] - dot(engine, L[i][:i], y)))
        solutions.append(_back(engine, L, [y[i] / D[i] for i in range(n)], None))
    return solutions


def _back(engine: Engine, L: Matrix, y: Sequence[Symbol], diagonal: Sequence[Symbol] | None) -> list[Symbol]:
    """x with Lᵀ x = y; the diagonal of L is 1 where it is not given."""
    n = len(y)
    x: list[Symbol] = [zero(engine)] * n
    for i in reversed(range(n)):
        below = range(i + 1, n)
        rest = y[i] - dot(engine, [L[j][i] for j in below], [x[j] for j in below])
        x[i] = engine.name(rest if diagonal is None else rest / diagonal[i])
    return x


def eliminate(engine: Engine, A: Matrix, columns: Matrix) -> Matrix:
    """A⁻¹ applied to each of the columns by Gaussian elimination along the first pivots that are not known to be 0."""
    n = len(A)
    if not n:
        return [[] for _ in columns]
    A, X = [list(row) for row in A], transposed(columns)
    for k in range(n):
        pivot = next((i for i in range(k, n) if not engine.is_zero(A[i][k])), None)
        if pivot is None:
            raise DeadPivotError
        A[k], A[pivot], X[k], X[pivot] = A[pivot], A[k], X[pivot], X[k]
        for i in range(k + 1, n):
            if engine.is_zero(A[i][k]):
                continue
            factor = engine.name(A[i][k] / A[k][k])
            A[i][k + 1 :] = _reduced(engine, A[i][k + 1 :], factor, A[k][k + 1 :])
            X[i] = _reduced(engine, X[i], factor, X[k])
    for k in reversed(range(n)):
        for j, known in enumerate(X[k]):
            rest = dot(engine, A[k][k + 1 :], [X[i][j] for i in range(k + 1, n)])
            numerator = known if engine.is_zero(rest) else known - rest
            X[k][j] = engine.name(numerator / A[k][k]) if not engine.is_zero(numerator) else numerator
    return transposed(X)


def _reduced(engine: Engine, row: Row, factor: Symbol, by: Row) -> list[Symbol]:
    return [x if engine.is_zero(y) else engine.name(x - factor * y) for x, y in zip(row, by, strict=True)]


def null_space_basis(
    engine: Engine, B: Matrix, n: int, independent: Sequence[int], further: Matrix | None = None
) -> tuple[Matrix, Matrix]:
    """Rows of n entries that span ker B, the unit of each independent coordinate with what the others follow by.

    Beside them what the dependent columns of B solve each of `further` to.
    """
    dependent = [i for i in range(n) if i not in independent]
    sides = [[row[i] for row in B] for i in independent]
    solved = eliminate(engine, [[row[i] for i in dependent] for row in B], [*sides, *(further or [])])
    basis = []
    for i, column in zip(independent, solved, strict=False):
        entries = {k: -x for k, x in zip(dependent, column, strict=True)} | {i: engine.number(Fraction(1))}
        basis.append([entries.get(k, zero(engine)) for k in range(n)])
    return basis, solved[len(basis) :]
