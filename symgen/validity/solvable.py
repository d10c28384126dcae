"""Where input equations can be solved: the guards of their determinants.

Inputs count by their lengths at a configuration, and rows of B by theirs: a determinant is at most the product of the
lengths of what it is made of (Hadamard's bound; Horn and Johnson, Matrix Analysis, 7.8), and a short row is no loss of
rank.  That an input has a length left is a guard of its own, because what bounds a moment about a turned lever is many
times the moment: of several inputs together that is more than float32 can tell from a drop of the rank.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import reduce

from symgen.ir.kernel import Status
from symgen.linear_algebra.exterior import ActuationForms
from symgen.linear_algebra.guards import Guard, magnitude
from symgen.linear_algebra.minor_sums import elementary_symmetric
from symgen.linear_algebra.null_space.null_spaces import InputEquations, MinorSpace, NullSpace, rests_on_rank
from symgen.linear_algebra.reflected_inputs import ReflectedInputs
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Vector, dot
from symgen.symbolic.polynomials.nested_factors import nested_factors
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import reached


def solvable(
    mechanics: System,
    generic: Genericity,
    space: NullSpace,
    forms: InputEquations,
    columns: Sequence[Vector],
    status: Status,
) -> tuple[Guard, ...]:
    """The guards with `status` of the determinants of `columns`; a drop of the rank of B is named first.

    Where rows lock what they hold, whatever the configuration, determinants hold nothing of the rank of these rows.
    """
    graph, denominator = mechanics.graph, forms.denominator()
    apart = space.guards if rests_on_rank(space) else ()
    if all(node.op != "symbol" for node in reached([denominator])):
        return apart
    if isinstance(forms, ActuationForms) and mechanics.factoring.fixed(denominator):
        return (*apart, Guard(status, denominator, 1 if forms.single else 2, space.guards))
    # behind reflections the terms on the way are bounded by many times what they are
    if isinstance(forms, ActuationForms) and forms.single and isinstance(space, MinorSpace):
        factors = nested_factors(denominator, mechanics.factoring.fixed)
        if len(factors) > 1:
            return (*apart, *(Guard(status, factor, 1, space.guards) for factor in factors))
    sizes, bounds = _lengths(mechanics, columns)
    if isinstance(forms, ReflectedInputs):
        directions = _by_pivots(graph, forms, forms.lengths(sizes), status, space.guards)
    else:
        assert isinstance(forms, ActuationForms)
        directions = _by_minors(mechanics, generic, space, forms, sizes, status)
    short = _short(graph, sizes, bounds, forms.degree)
    return (*apart, *(Guard(status, measure, 2, space.guards, scale) for measure, scale in short), directions)


def standing_out(
    mechanics: System, vectors: Sequence[Vector], status: Status, first: tuple[Guard, ...]
) -> tuple[Guard, ...]:
    """The guards with `status` of vectors whose lengths have to stand out of the rounding of their terms, all of them.

    What is looked at `first` names a cause.
    """
    sizes, bounds = _lengths(mechanics, vectors)
    short = _short(mechanics.graph, sizes, bounds, len(vectors))
    return tuple(Guard(status, measure, 2, first, scale) for measure, scale in short)


def _lengths(mechanics: System, vectors: Sequence[Vector]) -> tuple[list[Scalar], list[Scalar]]:
    """Squared lengths, and what bounds them: this itself where it is near them."""
    graph = mechanics.graph
    lengths = [dot(graph, x, x) for x in vectors]
    bounds = magnitude(graph, lengths)
    sizes = [bound if _near(mechanics, x) else own for x, own, bound in zip(vectors, lengths, bounds, strict=True)]
    return sizes, bounds


def _near(mechanics: System, vector: Vector) -> bool:
    """Whether a bound that needs no sine or cosine is near the length: an entry is fixed, and none a sum that moves."""
    fixed = mechanics.factoring.fixed
    moving = [entry for entry in vector if not fixed(entry)]
    if not any(fixed(entry) and not entry.is_zero for entry in vector):
        return not moving
    while moving:
        node = moving.pop()
        if node.op in ("mul", "neg", "copysign"):
            moving += [part for part in node.args[: 1 if node.op == "copysign" else 2] if not fixed(part)]
        elif node.op not in ("sin", "cos"):
            return False
    return True


def _short(
    graph: Graph, sizes: Sequence[Scalar], bounds: Sequence[Scalar], degree: int
) -> list[tuple[Scalar, Scalar]]:
    """What is small where fewer than `degree` of the squared lengths stand out of the rounding of their terms.

    Beside the sum of products of one length less, a sum of products is about the least of the lengths that count.
    """
    pairs = list(zip(sizes, bounds, strict=True))
    moving = list(dict.fromkeys(pair for pair in pairs if pair[0] is not pair[1]))
    if not moving or (len(moving) == 1 and degree == len(pairs)):
        return moving
    if degree == len(pairs):
        return [(_least(graph, [graph.function("ratio_or_zero", pair) for pair in moving]), graph.one)]
    shares = [graph.one if a is b else graph.function("ratio_or_zero", (a, b)) for a, b in pairs]
    return [(elementary_symmetric(graph, shares, degree), elementary_symmetric(graph, shares, degree - 1))]


def _least(graph: Graph, values: Sequence[Scalar]) -> Scalar:
    return reduce(lambda a, b: graph.function("min", (a, b)), values)


def _by_pivots(
    graph: Graph, forms: ReflectedInputs, lengths: Sequence[Scalar], status: Status, before: tuple[Guard, ...]
) -> Guard:
    """What the inputs before leave of each input, or, of components of all inputs, the product of pivots."""
    if forms.by_columns:
        beside = forms.combinations(lengths)
        shares = [graph.function("ratio_or_zero", pair) for pair in zip(forms.pivots, beside, strict=True)]
        return Guard(status, _least(graph, shares), 2, before, graph.one)
    # in units of their mean size products stay in the range of a float32
    usual = graph.sum(lengths) * Fraction(1, len(lengths))
    own = elementary_symmetric(graph, [x / usual for x in lengths], forms.degree)
    pivots = [pivot / usual for pivot in forms.pivots]
    # no direction is lost where none is short, nor where inputs are short by their units only, and pivots with them
    volume = graph.function("ratio_or_zero", (graph.product(pivots), own))
    return Guard(status, graph.function("max", (volume, _least(graph, pivots))), 2, before, graph.one)


def _by_minors(
    mechanics: System,
    generic: Genericity,
    space: NullSpace,
    forms: ActuationForms,
    lengths: Sequence[Scalar],
    status: Status,
) -> Guard:
    """The sum of squared determinants, beside what it would be if all inputs and rows were orthogonal.

    Of rows that depend on each other on V alone, determinants that are 0 on V hold eps beside it, where rounded
    coordinates are.  They say nothing of u, and their squares have to be eps of the sum at most: its threshold is not
    squared.
    """
    graph, denominator = mechanics.graph, forms.denominator()
    scale = graph.sum(
        graph.product(lengths[k] for k in subset) * forms.importance(subset) for subset in forms.subsets
    )
    directions = forms.degree
    measure, degree = denominator * denominator if forms.single else denominator, 2
    if isinstance(space, MinorSpace):
        directions += generic.rank
        if generic.rank < len(space.rows):
            measure, scale = forms.at_one_length(space.lengths), scale * graph.product(space.lengths)
            degree = 2 if generic.rank_is_identical else 1
        else:
            rows = [_size(mechanics, row) for row in mechanics.constraint_jacobian]
            scale = scale * elementary_symmetric(graph, rows, generic.rank)
    return Guard(status, measure, degree, space.guards, scale, directions, positive=degree == 1)


def _size(mechanics: System, row: Vector) -> Scalar:
    """|b|^2, or a bound near it."""
    square = dot(mechanics.graph, row, row)
    return magnitude(mechanics.graph, [square])[0] if _near(mechanics, row) else square
