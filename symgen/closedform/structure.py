"""Degrees of freedom, actuation and integrability of a model."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Literal

from symgen.closedform.limits import TooLargeError
from symgen.closedform.matrices import dot, multiply, null_space, transpose
from symgen.closedform.mechanics import Mechanics
from symgen.closedform.points import Point, rank
from symgen.closedform.quotient import Matrix, Quotient
from symgen.model.model import Model


@dataclass(frozen=True, slots=True)
class Structure:
    """Generic ranks and what follows from them (paper, sections 2 and 4.1)."""

    geometric_rank: int
    constraint_rank: int
    local_freedom: int
    differential_freedom: int
    degree_of_actuation: int
    actuation: str


@dataclass(frozen=True, slots=True)
class Integrability:
    """Whether a non-holonomic row belongs to the largest integrable part of the constraints (Frobenius)."""

    row: str
    verdict: Literal["integrable", "not integrable", "not decided"]
    explanation: str


def derive_structure(model: Model, mechanics: Mechanics, points: list[Point]) -> Structure:
    """Ranks at points of V; the largest one over the points is the generic one."""
    geometric = len(mechanics.residual)
    geometric_rank = constraint_rank = actuation_degree = 0
    for point in points:
        jacobian = point.matrix(mechanics.jacobian)
        own = rank(jacobian)
        geometric_rank = max(geometric_rank, rank(jacobian[:geometric]))
        constraint_rank = max(constraint_rank, own)
        if model.inputs:
            joined = jacobian + [list(column) for column in zip(*point.matrix(mechanics.control), strict=True)]
            actuation_degree = max(actuation_degree, rank(joined) - own)
    freedom = model.n - constraint_rank
    return Structure(
        geometric_rank=geometric_rank,
        constraint_rank=constraint_rank,
        local_freedom=model.n - geometric_rank,
        differential_freedom=freedom,
        degree_of_actuation=actuation_degree,
        actuation=describe_actuation(model.m, actuation_degree, freedom),
    )


def describe_actuation(inputs: int, degree: int, freedom: int) -> str:
    """The words of section 4.1 for m inputs, degree of actuation alpha and delta degrees of freedom."""
    if inputs == 0:
        return "not actuated"
    first = "redundantly" if inputs > degree else "non-redundantly"
    return f"{first} {'full-actuated' if degree == freedom else 'under-actuated'}"


def derive_integrability(model: Model, mechanics: Mechanics) -> tuple[Integrability, ...]:
    """The largest integrable part of the constraints by derived systems; one verdict for every non-holonomic row.

    A row w of the current system I stays when dw vanishes on all pairs of admissible directions, which is what the
    object of non-holonomy (12) measures; I shrinks to the combinations that stay until nothing changes (Frobenius).
    """
    rows = [(i, row.name) for i, row in enumerate(model.constraints) if row.kind == "nonholonomic"]
    if not rows:
        return ()
    try:
        with mechanics.ring.work.limited("the test of integrability"):
            return _integrable_part(model, mechanics, rows)
    except TooLargeError as large:
        return tuple(Integrability(name, "not decided", str(large)) for _, name in rows)


def _integrable_part(model: Model, mechanics: Mechanics, rows: list[tuple[int, str]]) -> tuple[Integrability, ...]:
    system = mechanics.jacobian
    while system:
        smaller = _derived_system(model, mechanics, system)
        if len(smaller) == len(system):
            break
        system = smaller
    basis = null_space(mechanics.ring, system, model.n)
    result = []
    for i, name in rows:
        if all(not dot(mechanics.ring, mechanics.jacobian[i], vector) for vector in basis):
            text = "the row belongs to an integrable part of the constraints: it fixes a function of the coordinates"
            result.append(Integrability(name, "integrable", text))
        else:
            text = f"largest integrable part of the {len(mechanics.jacobian)} constraints has dimension {len(system)}"
            result.append(Integrability(name, "not integrable", text))
    return tuple(result)


def _derived_system(model: Model, mechanics: Mechanics, system: Matrix) -> Matrix:
    """The combinations of the rows whose exterior derivative vanishes on the kernel of the rows."""
    ring = mechanics.ring
    kernel = null_space(ring, system, model.n)
    pairs = list(combinations(kernel, 2))
    if not pairs:
        return system
    curvature = [[_exterior(model, mechanics, row, x, y) for x, y in pairs] for row in system]
    keep = null_space(ring, transpose(tuple(tuple(row) for row in curvature)), len(system))
    return multiply(ring, keep, system) if keep else ()


def _exterior(
    model: Model, mechanics: Mechanics, form: tuple[Quotient, ...], x: tuple[Quotient, ...], y: tuple[Quotient, ...]
) -> Quotient:
    """d(form)(x, y) = sum_ij (d_i w_j - d_j w_i) x_i y_j."""
    translator = mechanics.translator
    names = [c.name for c in model.coordinates]
    total = translator.constant(0)
    for j, entry in enumerate(form):
        for i, name in enumerate(names):
            slope = translator.derivative(entry, name)
            if slope:
                total = total + slope * (x[i] * y[j] - x[j] * y[i])
    return total
