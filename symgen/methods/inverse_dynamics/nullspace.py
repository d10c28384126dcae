"""The null-space method: a closed basis W of ker B, then u = (W^T M)^+ W^T tau with delta x delta determinants.

B q_dot = 0 is first reduced by steps that cannot fail (`rates`).  The small rest falls into components that share no
rate.  Where one direction is left in a component, it is the cross product of its rows; where more are, some rates have
to be solved for by Cramer's rule, and the basis fails where their determinant vanishes although the rest keeps its
rank: that determinant is one of the method's pivots.

Inputs that load no row, B M = 0 in every configuration, need no basis: N_B M = M, so that u = M^+ tau where they are
independent of each other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import combinations, islice, product

from symgen.ir.kernel import Status
from symgen.linear_algebra.blocks import components
from symgen.linear_algebra.exterior import ActuationForms, RowForms, cross_product, small_family
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_space.null_spaces import MinorSpace
from symgen.methods.admission import OfInputs, proof_for
from symgen.methods.inverse_dynamics.estimates import least_of_basis
from symgen.methods.inverse_dynamics.rates import Rates, reduced_rates
from symgen.methods.method import Candidate, Method, solved_for_u
from symgen.methods.system import MethodInput
from symgen.methods.workspace import Workspace
from symgen.records import dataclass
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot, identity, matmul, transpose
from symgen.symbolic.polynomials.nested_factors import nested_factors
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost

# Bases of the null space that are tried: where each of the first has a determinant that vanishes, others mostly have.
MOST_BASES = 6


@dataclass(frozen=True, slots=True)
class _Basis:
    """W (n x delta) and the determinants that must not vanish for its columns to be independent."""

    columns: Matrix
    pivots: Vector
    parts: tuple[Matrix, ...]  # of the rest, each with the rank of its rows where B has full rank


@dataclass(frozen=True, slots=True)
class _NullVectors:
    """Null vectors of the rest, and the determinants that make them independent."""

    vectors: Matrix
    pivots: Vector


def nullspace_candidate(system: MethodInput, allowed: Callable[[Scalar], bool]) -> Candidate | str:
    """u along the first choice of rates whose determinant is `allowed`, or along the first of all."""
    graph, mechanics, generic = system.mechanics.graph, system.mechanics, system.generic
    if _loads_nothing(system):
        basis = _Basis(identity(graph, mechanics.n), (), ())
    else:
        reason = system.driven or system.regular
        if reason is not None:
            return reason
        choices = list(islice(_bases(system), MOST_BASES))
        if not choices:
            return "too many constraint rows are left that no safe step solves"
        basis = next((choice for choice in choices if all(map(allowed, choice.pivots))), choices[0])
    w = transpose(basis.columns, len(basis.columns[0]))
    inputs = transpose(matmul(graph, w, mechanics.control_matrix, generic.m), generic.m)
    force = tuple(row[0] for row in matmul(graph, w, tuple((f,) for f in mechanics.balance), 1))
    regular = tuple(guard for part in basis.parts for guard in MinorSpace(graph, part, len(part[0]), len(part)).guards)
    u = [graph.zero] * generic.m
    guards: list[Guard] = []
    for directions, acting in _decoupled(inputs, system):
        columns = tuple(tuple(inputs[k][i] for i in directions) for k in acting)
        degree = min(len(directions), len(acting))
        if not small_family([[0]], columns, degree):
            return "the determinants of the inputs are too many"
        forms = ActuationForms(RowForms(graph, (), len(directions), 0), columns, degree)
        guards += _guards(system, forms, regular)
        for k, value in zip(acting, forms.solve(tuple(force[i] for i in directions)), strict=True):
            u[k] = value
    made = solved_for_u(system, u, dict.fromkeys(guards))
    pivots = tuple(pivot for pivot in basis.pivots if pivot not in made.divisors and pivot.constant is None)
    return replace(made, divisors=(*made.divisors, *pivots))


def _guards(system: MethodInput, forms: ActuationForms, regular: tuple[Guard, ...]) -> Iterator[Guard]:
    """A determinant of blocks is compared block by block: of many the product is small far from where one vanishes."""
    degree = 1 if forms.single else 2
    whole = forms.denominator()
    for factor in nested_factors(whole, system.mechanics.factoring.fixed) if forms.single else (whole,):
        yield Guard(Status.ACTUATION_RANK, factor, degree, regular, directions=forms.degree)


def _loads_nothing(system: MethodInput) -> bool:
    """Whether inputs that are independent of each other do no work on any row, wherever the system is."""
    mechanics, generic = system.mechanics, system.generic
    if mechanics.model.allocation is not None or mechanics.model.rough or generic.m > generic.alpha or not generic.m:
        return False
    pairs = ((row, column) for row in mechanics.constraint_jacobian for column in mechanics.inputs)
    return all(dot(mechanics.graph, row, column).is_zero for row, column in pairs)


def _decoupled(inputs: Matrix, system: MethodInput) -> list[tuple[Sequence[int], Sequence[int]]]:
    """Directions and the inputs that act on them, in parts that have no input in common.

    Of many independent parts the product of all determinants is small, however far each of them is from 0.  Inputs that
    are independent of each other fall apart where they are orthogonal, others where they share no direction.
    """
    graph, generic = system.mechanics.graph, system.generic
    if generic.m > generic.alpha:
        return [(part.columns, part.rows) for part in components(inputs) if part.columns]
    products = tuple(tuple(dot(graph, a, b) for b in inputs) for a in inputs)
    parts: list[tuple[Sequence[int], Sequence[int]]] = []
    for part in components(products):
        moved = {j for k in part.rows for j, entry in enumerate(inputs[k]) if not entry.is_zero}
        parts.append((sorted(moved), part.rows))
    return parts


def _bases(system: MethodInput) -> Iterator[_Basis]:
    graph, mechanics, delta = system.mechanics.graph, system.mechanics, system.generic.delta
    rest = reduced_rates(graph, system.definite, mechanics.constraint_jacobian, mechanics.n)
    parts = _parts(rest)
    families = [_kernels(graph, rest, rows, rates) for rows, rates in parts]
    blocks = tuple(tuple(tuple(rest.core[i][j] for j in rates) for i in rows) for rows, rates in parts if rows)
    for choice in product(*families):
        vectors = [vector for kernel in choice for vector in kernel.vectors]
        if len(vectors) == delta:
            columns = matmul(graph, rest.motion, transpose(tuple(vectors), rest.width), delta)
            yield _Basis(columns, tuple(pivot for kernel in choice for pivot in kernel.pivots), blocks)


def _parts(rest: Rates) -> list[tuple[list[int], list[int]]]:
    """The connected components (rows, rates) of the rest; a rate in no row is one of its own."""
    parts: list[tuple[list[int], list[int]]] = []
    left = list(range(rest.width))
    while left:
        rates, rows = [left.pop(0)], list[int]()
        for rate in rates:
            for i, row in enumerate(rest.core):
                if i not in rows and not row[rate].is_zero:
                    rows.append(i)
                    fresh = [j for j in left if not row[j].is_zero]
                    rates += fresh
                    left = [j for j in left if j not in fresh]
        parts.append((sorted(rows), sorted(rates)))
    return parts


def _kernels(graph: Graph, rest: Rates, rows: list[int], rates: list[int]) -> list[_NullVectors]:
    """Bases of the null space of one component, the cheapest first."""
    part = tuple(tuple(rest.core[i][j] for j in rates) for i in rows)
    width = rest.width
    if len(rows) > len(rates) or not small_family([[0]], part, len(part)):
        return []
    if not rows:
        return [_NullVectors(_spread(graph, identity(graph, len(rates)), rates, width), ())]
    if len(rates) == len(rows):
        return [_NullVectors((), ())]
    if len(rates) == len(rows) + 1:
        return [_NullVectors(_spread(graph, (cross_product(graph, part, len(rates)),), rates, width), ())]
    solutions = [_solved(graph, part, chosen) for chosen in combinations(range(len(rates)), len(rows))]
    kernels = [_NullVectors(_spread(graph, k.vectors, rates, width), k.pivots) for k in solutions if k is not None]
    return sorted(kernels, key=lambda kernel: cost(x for v in kernel.vectors for x in v).weight)


def _spread(graph: Graph, vectors: Matrix, rates: list[int], width: int) -> Matrix:
    """Vectors of a component as vectors of all rates."""
    placed = [dict(zip(rates, vector, strict=True)) for vector in vectors]
    return tuple(tuple(values.get(j, graph.zero) for j in range(width)) for values in placed)


def _solved(graph: Graph, core: Matrix, chosen: tuple[int, ...]) -> _NullVectors | None:
    """Null vectors with the rates `chosen` solved for, and det C_S; None where that is always 0.

    The vector of a free rate f is the cross product of the rows on the columns S and f.
    """
    width = len(core[0])
    vectors: list[Vector] = []
    determinant = graph.zero
    for free in (j for j in range(width) if j not in chosen):
        places = sorted((*chosen, free))
        part = cross_product(graph, tuple(tuple(row[j] for j in places) for row in core), len(places))
        determinant = part[places.index(free)]
        if determinant.is_zero:
            return None
        values = dict(zip(places, part, strict=True))
        vectors.append(tuple(values.get(j, graph.zero) for j in range(width)))
    return _NullVectors(tuple(vectors), (determinant,))


def _nullspace(workspace: Workspace) -> Candidate | str:
    system = workspace.fresh()
    return nullspace_candidate(system, proof_for(system, workspace.minor_measures).shown)


def _least(system: MethodInput) -> int:
    """Nothing is known of what inputs that load no row take: forces along them may be those of bodies as they are."""
    return 0 if _loads_nothing(system) else least_of_basis(system)


NULLSPACE: Method = OfInputs(_nullspace, least=_least)
