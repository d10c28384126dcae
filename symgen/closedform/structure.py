"""Degrees of freedom, actuation and integrability of a model."""

from __future__ import annotations

from itertools import combinations
from typing import Literal

from symgen.closedform.algebra.limits import TooLargeError
from symgen.closedform.algebra.matrices import dot, multiply, null_space, transpose
from symgen.closedform.algebra.quotient import Matrix, Quotient
from symgen.closedform.mechanics import ExactSystem
from symgen.closedform.points import RingPoint, rank
from symgen.closedform.spelling import Speller
from symgen.model.model import Model
from symgen.records import dataclass

LONGEST_CURVATURE = 12
"""A component of the object of non-holonomy with more terms than this is not printed."""


@dataclass(frozen=True, slots=True)
class RankStructure:
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


def derive_structure(model: Model, mechanics: ExactSystem, points: list[RingPoint]) -> RankStructure:
    """Ranks at points of V; the largest one over the points is the generic one."""
    geometric = len(mechanics.residual)
    geometric_rank = constraint_rank = actuation_degree = 0
    for point in points:
        jacobian = point.constraints(mechanics, model)
        own = rank(jacobian)
        geometric_rank = max(geometric_rank, rank(jacobian[:geometric]))
        constraint_rank = max(constraint_rank, own)
        if model.inputs:
            joined = jacobian + [list(column) for column in zip(*point.matrix(mechanics.control), strict=True)]
            actuation_degree = max(actuation_degree, rank(joined) - own)
    freedom = model.n - constraint_rank
    return RankStructure(
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


def derive_integrability(model: Model, mechanics: ExactSystem, basis: Matrix | None) -> tuple[Integrability, ...]:
    """The largest integrable part of the constraints by derived systems; one verdict for every non-holonomic row.

    A row w of the current system I stays when dw vanishes on all pairs of admissible directions, which is what the
    object of non-holonomy (12) measures; I shrinks to the combinations that stay until nothing changes (Frobenius).
    `basis` is W (n x delta), whose columns the evidence refers to; None where there is none to show.
    """
    rows = [(i, row.name) for i, row in enumerate(model.constraints) if row.kind == "nonholonomic"]
    if not rows:
        return ()
    try:
        with mechanics.ring.work.limited("the test of integrability"):
            return _integrable_part(model, mechanics, rows, basis)
    except TooLargeError as large:
        return tuple(Integrability(name, "not decided", str(large)) for _, name in rows)


def _integrable_part(
    model: Model, mechanics: ExactSystem, rows: list[tuple[int, str]], basis: Matrix | None
) -> tuple[Integrability, ...]:
    system = mechanics.jacobian
    while system:
        smaller = _derived_system(model, mechanics, system)
        if len(smaller) == len(system):
            break
        system = smaller
    free = null_space(mechanics.ring, system, model.n)
    part = f"the largest integrable part of all constraints has dimension {len(system)}"
    result = []
    for i, name in rows:
        row = mechanics.jacobian[i]
        if all(not dot(mechanics.ring, row, vector) for vector in free):
            text = "the row belongs to an integrable part of the constraints: it fixes a function of the coordinates"
            result.append(Integrability(name, "integrable", text))
            continue
        evidence = "" if basis is None else _evidence(model, mechanics, row, transpose(basis))
        result.append(Integrability(name, "not integrable", evidence + part))
    return tuple(result)


def _evidence(model: Model, mechanics: ExactSystem, row: tuple[Quotient, ...], kernel: Matrix) -> str:
    """The first component of the row's exterior derivative on columns of W that is not zero, in words."""
    for (i, x), (j, y) in combinations(enumerate(kernel, 1), 2):
        value = _exterior(model, mechanics, row, x, y)
        if value and len(value.numerator) + len(value.denominator) <= LONGEST_CURVATURE:
            shown = Speller(mechanics.ring).quotient(value)
            return f"its exterior derivative on columns {i} and {j} of the null-space basis W is `{shown}`, not zero; "
        if value:
            return f"its exterior derivative on columns {i} and {j} of the null-space basis W is not zero; "
    return "its exterior derivative vanishes on all admissible velocities, but "


def _derived_system(model: Model, mechanics: ExactSystem, system: Matrix) -> Matrix:
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
    model: Model, mechanics: ExactSystem, form: tuple[Quotient, ...], x: tuple[Quotient, ...], y: tuple[Quotient, ...]
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
