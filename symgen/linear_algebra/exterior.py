"""Exterior algebra of sparse multivectors: minors, projections and minimum-norm solutions without choosing anything.

A multivector of grade k over R^n is a mapping from k-subsets of the axes (as bit masks) to scalars.  With
omega = b_1 ^ ... ^ b_r, the entries of omega are the r x r minors of B; a vector x loses its part in the row space of
B in x ^ omega, because |x ^ omega|^2 = |N_B x|^2 |omega|^2.  Every formula below is a polynomial in the entries and
one division, symmetric in rows, columns and inputs, hence valid wherever the ranks are what they generically are
(Bourbaki, Algebra I, ch. III; Ben-Israel and Greville, Generalized Inverses, ch. 6 for the sums over minors).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import combinations
from typing import TypeAlias

from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector
from symgen.symbolic.passes.factoring import LONGEST_CANCELLED
from symgen.symbolic.scalar import Scalar

Multivector: TypeAlias = dict[int, Scalar]

# Products of a family of determinants beyond which equations are solved by reflections: as for nine dense directions.
LARGEST_FAMILY = 4096
# Products on the way to minors of rows, of which there may be few at the end: as for ten dense rows of twelve entries.
LARGEST_ROW_FAMILY = 32768


def unit(graph: Graph) -> Multivector:
    """The scalar 1, of grade 0."""
    return {0: graph.one}


def wedge(a: Multivector, x: Sequence[Scalar]) -> Multivector:
    """a ^ x for a vector x."""
    result: Multivector = {}
    for mask, value in a.items():
        for axis, entry in enumerate(x):
            if entry.is_zero or mask >> axis & 1:
                continue
            # moving e_axis to its place passes every higher axis of the mask
            term = value * entry
            if (mask >> (axis + 1)).bit_count() & 1:
                term = -term
            key = mask | 1 << axis
            result[key] = result[key] + term if key in result else term
    return {mask: result[mask] for mask in sorted(result) if not result[mask].is_zero}


def wedge_all(start: Multivector, vectors: Sequence[Sequence[Scalar]]) -> Multivector:
    """start ^ x_1 ^ x_2 ^ ..."""
    for vector in vectors:
        start = wedge(start, vector)
    return start


def in_either_sign(forms: Iterable[Multivector]) -> frozenset[Scalar]:
    """All components and what they are with the other sign, in which they stand in results as well."""
    components = [value for form in forms for value in form.values()]
    return frozenset((*components, *(-value for value in components)))


def inner(graph: Graph, a: Multivector, b: Multivector) -> Scalar:
    """The inner product in which the basis multivectors are orthonormal."""
    return graph.sum(a[mask] * b[mask] for mask in sorted(a.keys() & b.keys()))


def square(graph: Graph, a: Multivector) -> Scalar:
    """|a|^2 as a sum of squares."""
    return graph.sum(value * value for value in a.values())


def cross_product(graph: Graph, rows: Matrix, n: int) -> Vector:
    """The generalized cross product of n - 1 vectors of R^n: orthogonal to all, |w|^2 the sum of squared minors."""
    minors = wedge_all(unit(graph), rows)
    full = (1 << n) - 1
    return tuple((-1) ** (n - 1 - i) * minors.get(full & ~(1 << i), graph.zero) for i in range(n))


def basis_wedges(graph: Graph, a: Multivector, n: int) -> list[Multivector]:
    """a ^ e_i for every axis i."""
    axes = [tuple(graph.one if i == j else graph.zero for j in range(n)) for i in range(n)]
    return [wedge(a, axis) for axis in axes]


def small_family(starts: Iterable[Iterable[int]], columns: Sequence[Vector], degree: int) -> bool:
    """Whether wedging `degree` of the columns on multivectors with these masks takes few products."""
    return _family_size(starts, columns, degree, LARGEST_FAMILY) is not None


def few_minors(rows: Matrix, rank: int, most: int) -> bool:
    """Whether rows have at most so many minors of a rank that are not 0 for their zeros, and few products make them."""
    size = _family_size([[0]], rows, rank, LARGEST_ROW_FAMILY)
    return size is not None and size <= most


def _family_size(starts: Iterable[Iterable[int]], columns: Sequence[Vector], degree: int, most: int) -> int | None:
    """How many components such a family has in all; None where it takes more than `most` products."""
    places = [[axis for axis, entry in enumerate(column) if not entry.is_zero] for column in columns]
    products = size = 0
    for start in starts:
        for subset in combinations(range(len(columns)), degree):
            masks = set(start)
            for k in subset:
                next_masks = set()
                for mask in masks:
                    products += 1
                    for axis in places[k]:
                        if not mask >> axis & 1:
                            products += 1
                            next_masks.add(mask | 1 << axis)
                    if products > most:
                        return None
                masks = next_masks
            size += len(masks)
    return size


class RowForms:
    """omega_I = wedge of the rows I of B, for all row subsets I of the generic rank rho (one when rho = r).

    `shortened` may write minors otherwise, such as one product: det [a, b] as l m sin(knee), all of whose digits hold
    where it is small, and not as the difference of two products.
    """

    def __init__(
        self, graph: Graph, rows: Matrix, n: int, rank: int, shortened: Callable[[Scalar], Scalar] | None = None
    ) -> None:
        self.graph = graph
        self.rows = rows
        self.n = n
        self.rank = rank
        self.subsets = list(combinations(range(len(rows)), rank))
        self.forms = [wedge_all(unit(graph), [rows[k] for k in subset]) for subset in self.subsets]
        if shortened is not None:
            self.forms = [{mask: shortened(x) for mask, x in form.items()} for form in self.forms]
        self.square = graph.sum(square(graph, form) for form in self.forms)

    def at_one_length(self, squares: Sequence[Scalar]) -> Scalar:
        """The sum of |omega_I|^2 with the lengths of the rows left out, by their `squares`; at most prod |b_k|^2 C.

        Where one long row follows from others, what the sum of |omega_I|^2 is of its own bound says nothing of ranks.
        """
        terms = zip((square(self.graph, form) for form in self.forms), self.lengths_left_out(squares), strict=True)
        return self.graph.sum(a * b for a, b in terms)

    def lengths_left_out(self, squares: Sequence[Scalar]) -> list[Scalar]:
        """For each row subset the product of the squared lengths of the other rows."""
        every = range(len(self.rows))
        return [self.graph.product(squares[k] for k in every if k not in subset) for subset in self.subsets]

    @property
    def minors(self) -> frozenset[Scalar]:
        """The r x r minors of B, all of them small where its rank drops."""
        return in_either_sign(self.forms)

    def projector(self) -> Matrix:
        """N_B (21): the smaller of (e_i ^ omega, e_j ^ omega) and its complement, over |omega|^2."""
        graph, n = self.graph, self.n
        if self.rank == 0:
            return tuple(tuple(graph.one if i == j else graph.zero for j in range(n)) for i in range(n))
        families = [basis_wedges(graph, form, n) for form in self.forms]
        inverse = 1 / self.square
        upper = {
            (i, j): graph.sum(inner(graph, family[i], family[j]) for family in families) * inverse
            for i in range(n)
            for j in range(i, n)
        }
        return tuple(tuple(upper[min(i, j), max(i, j)] for j in range(n)) for i in range(n))

    def pseudoinverse(self) -> Matrix:
        """B^+ (n x r): entry (i, k) is the inner product of omega with omega where b_k gives way to e_i."""
        graph, n, r = self.graph, self.n, len(self.rows)
        columns: list[list[Scalar]] = [[graph.zero] * n for _ in range(r)]
        for subset, form in zip(self.subsets, self.forms, strict=True):
            for place, k in enumerate(subset):
                others = [self.rows[other] for other in subset if other != k]
                rest = wedge_all(unit(graph), others)
                # b_k stands at `place`; e_i joins at the end and has to move back over the rows behind it
                sign = -1 if (len(subset) - 1 - place) & 1 else 1
                for i, replaced in enumerate(basis_wedges(graph, rest, n)):
                    term = inner(graph, form, replaced)
                    columns[k][i] = columns[k][i] + (term if sign > 0 else -term)
        inverse = 1 / self.square
        return tuple(tuple(columns[k][i] * inverse for k in range(r)) for i in range(n))


class ActuationForms:
    """The products M_J ^ omega over the input subsets J of size alpha, for every row subset of `rows`.

    With `weights` w the sums are those of the columns M_j / sqrt(w_j): each subset counts by the weights outside it.
    """

    def __init__(
        self, rows: RowForms, inputs: Sequence[Vector], degree: int, weights: Sequence[Scalar] = ()
    ) -> None:
        self.graph = rows.graph
        self.weights = weights
        self.rows = rows
        self.inputs = inputs
        self.degree = degree
        self.subsets = list(combinations(range(len(inputs)), degree))
        self.products = [[self._product(form, subset) for subset in self.subsets] for form in rows.forms]
        self._without: dict[int, dict[tuple[int, ...], Multivector]] = {}

    def _product(self, form: Multivector, subset: tuple[int, ...]) -> Multivector:
        return wedge_all(form, [self.inputs[k] for k in subset])

    def weighted(self, weights: Sequence[Scalar]) -> ActuationForms:
        """The same with weights of the inputs."""
        return ActuationForms(self.rows, self.inputs, self.degree, weights)

    @property
    def single(self) -> bool:
        """Whether there is one determinant only, so that a plain quotient solves (m = delta, independent rows)."""
        return len(self.products) == 1 and len(self.subsets) == 1 and self.degree + self.rows.rank == self.rows.n

    def determinant(self) -> Scalar:
        """The one determinant Delta of a `single` family."""
        (product,) = self.products[0]
        return product.get((1 << self.rows.n) - 1, self.graph.zero)

    def cancelled(self, cancel: Callable[[Scalar], Scalar]) -> ActuationForms:
        """The same family with Delta multiplied out by `cancel` when `single`.

        What vanishes at a singularity is a factor then, not a difference of products that do not vanish.
        """
        if not self.single or self.determinant().size > LONGEST_CANCELLED:
            return self
        other = ActuationForms(self.rows, self.inputs, self.degree, self.weights)
        other.products = [[{(1 << self.rows.n) - 1: cancel(self.determinant())}]]
        return other

    @property
    def minors(self) -> frozenset[Scalar]:
        """What the products consist of, all of it small where the inputs lose an effect; none where Delta divides."""
        if self.single:
            return frozenset()
        return in_either_sign(product for family in self.products for product in family)

    def importance(self, subset: tuple[int, ...]) -> Scalar:
        """The factor of a subset's determinants in the sums."""
        return self.graph.product(w for k, w in enumerate(self.weights) if k not in subset)

    def square(self) -> Scalar:
        """Sum of |M_J ^ omega_I|^2; 0 where the rank of B or of the projected control matrix drops."""
        graph = self.graph
        return graph.sum(
            square(graph, product) * self.importance(subset)
            for family in self.products
            for subset, product in zip(self.subsets, family, strict=True)
        )

    def at_one_length(self, squares: Sequence[Scalar]) -> Scalar:
        """The same with the lengths of the rows left out of each row subset, by their `squares`."""
        graph = self.graph
        shares = (
            graph.sum(
                square(graph, product) * self.importance(subset)
                for subset, product in zip(self.subsets, family, strict=True)
            )
            for family in self.products
        )
        return graph.sum(a * b for a, b in zip(shares, self.rows.lengths_left_out(squares), strict=True))

    def denominator(self) -> Scalar:
        """Delta itself when `single`, else the sum of squares."""
        return self.determinant() if self.single else self.square()

    def solve(self, force: Vector) -> Vector:
        """Minimum-norm least-squares u of N_B M u = N_B force: Cramer's rule summed over all minors (theory 3.1)."""
        graph = self.graph
        numerators = [graph.zero] * len(self.inputs)
        for number, family in enumerate(self.products):
            replaced = self._replaced(number, force)
            for subset, product in zip(self.subsets, family, strict=True):
                factor = self.importance(subset)
                for place, k in enumerate(subset):
                    others = subset[:place] + subset[place + 1 :]
                    term = self._pair(product, replaced[others]) * factor
                    if (len(subset) - 1 - place) & 1:
                        term = -term
                    numerators[k] = numerators[k] + term
        denominator = self.denominator()
        if all(numerator.is_zero for numerator in numerators):
            return tuple(numerators)
        if len([numerator for numerator in numerators if not numerator.is_zero]) == 1 or denominator.is_one:
            return tuple(numerator / denominator for numerator in numerators)
        inverse = 1 / denominator
        return tuple(numerator * inverse for numerator in numerators)

    @property
    def rank_measures(self) -> list[Scalar]:
        """None: what is divided by is the denominator."""
        return []

    def internal_force(self) -> tuple[Vector, Scalar]:
        """Of one input more than directions: (-1)^k det[omega, M without column k], and their squared weighted norm."""
        (family,) = self.products
        # the subset that comes last leaves out the first input
        minors = [product.get((1 << self.rows.n) - 1, self.graph.zero) for product in reversed(family)]
        return tuple(-minor if k & 1 else minor for k, minor in enumerate(minors)), self.square()

    def _replaced(self, number: int, force: Vector) -> dict[tuple[int, ...], Multivector]:
        """By subset, the products of one row subset in which the force stands for the input that is missing."""
        if number not in self._without:
            form = self.rows.forms[number]
            subsets = sorted({subset[:i] + subset[i + 1 :] for subset in self.subsets for i in range(len(subset))})
            self._without[number] = {subset: self._product(form, subset) for subset in subsets}
        return {subset: wedge(product, force) for subset, product in self._without[number].items()}

    def _pair(self, product: Multivector, replaced: Multivector) -> Scalar:
        if self.single:
            return replaced.get((1 << self.rows.n) - 1, self.graph.zero)
        return inner(self.graph, product, replaced)
