"""M u + B^T lambda = tau, reduced to a small core by steps that are invertible wherever parameters are in their ranges
and [M, B^T] has full rank.

1. Multipliers that act on some rows with the same coefficients only are replaced there by their sum: several links
   that meet in one point get their own force each, and the balance of the point becomes a pair of rows.
2. A pair of multipliers whose coefficients in a row are k (f, g) with f^2 + g^2 = 1 is turned into its components
   along and across (f, g), so that the row holds one of them; likewise a pair of rows in which an unknown has such
   coefficients is turned, so that one of them holds it (body axes in place of world axes).
3. Rows with one unknown are solved at once, unknowns of one row only are left for the end: where the pivot is a
   number or a product of parameters that are declared nonzero.
4. Of a large core rows with one unknown are solved whatever the pivot, such as the length of a leg: where it vanishes
   a row of [M, B^T] does, so that the rank drops.  `lengths` belongs to what is tested.  Rows that are a rotation of as
   many unknowns, such as a free body's forces in its own axes, are turned back.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from symgen.linear_algebra.balance import along_rates, multipliers_alone
from symgen.linear_algebra.null_space.null_spaces import LONGEST_PRODUCT
from symgen.mechanics.system import System
from symgen.methods.inverse_dynamics.taken_back import SolvedUnknown, Step, TurnedUnknowns, taken_back
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Matrix, Vector, dot
from symgen.symbolic.passes.factoring import LONGEST_CANCELLED
from symgen.symbolic.polynomials.content import divided, usual_number
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost


@dataclass(slots=True, eq=False)
class LinearEquation:
    """One equation: coefficients of unknowns, and the right-hand side."""

    coefficients: dict[int, Scalar]
    right: Scalar


class Elimination:
    """The rows and unknowns that are left; `core` and `names` after `reduce`.

    Unknowns are numbered: multipliers first, then the inputs, then sums of multipliers.
    """

    def __init__(self, mechanics: System, force: Vector | None = None) -> None:
        self._mechanics = mechanics
        self._graph: Graph = mechanics.graph
        rows, force = mechanics.constraint_jacobian, mechanics.balance if force is None else force
        # u does not depend on the lengths of the rows of B: the numbers that their terms have are left out
        numbers = [usual_number(x for x in row if not x.is_zero) for row in rows]
        primitive = [tuple(divided(self._graph, x, k) for x in row) for row, k in zip(rows, numbers, strict=True)]
        self.columns: tuple[Vector, ...] = (*self._cancelled(primitive), *mechanics.inputs)
        self.inputs = range(len(rows), len(self.columns))
        self.core = [
            LinearEquation({j: column[i] for j, column in enumerate(self.columns) if not column[i].is_zero}, force[i])
            for i in range(mechanics.n)
        ]
        self._unknowns = len(self.columns)
        self._points: dict[int, LinearEquation] = {}
        self._explicit: list[tuple[int, LinearEquation]] = []
        self._tested: list[Scalar] = []
        self._steps: list[Step] = []
        self._moments = [[self.core[j] for j in angles] for angles, _ in mechanics.turnings]
        self.multipliers_alone: Matrix = ()
        self._nonzero = {
            mechanics.graph.symbol(p.name)
            for p in mechanics.model.parameters
            if p.name in mechanics.positive or (p.range is not None and p.range[1] < 0)
        }

    def reduce(self) -> None:
        """All steps, in order."""
        self._share_points()
        self._leave_single_inputs()
        self._turn_multipliers()
        self.core += self._points.values()
        self._turn_rows()
        self._pivot()
        if len(self.core) > LONGEST_PRODUCT:
            # too many rows for a determinant to be tested as it stands: fewer are left by pivots that are tested too
            self._points.clear()  # rows like all others from here on
            self._turn_back()
            self._turn_multipliers(lengths=True)
            self.multipliers_alone = self._without_inputs()
            self._pivot(lengths=True)
        if len(self.core) > 1:
            self._divide_rows()

    @property
    def names(self) -> list[int]:
        """The unknowns of the core, and those the unknowns left for the end still need."""
        known = {name for name, _ in self._explicit}
        rows = [*self.core, *(row for _, row in self._explicit)]
        return sorted({j for row in rows for j in row.coefficients} - known)

    def values(self, core: dict[int, Scalar], homogeneous: bool) -> Vector:
        """The inputs for given unknowns of the core, with right-hand sides or without."""
        unknowns = self._with_explicit(core, homogeneous)
        return tuple(unknowns.get(j, self._graph.zero) for j in self.inputs)

    def all_values(self, core: dict[int, Scalar], homogeneous: bool) -> Vector:
        """A value for each of `columns`: the multipliers before they were turned and solved for, and the inputs."""
        zero = self._graph.zero
        unknowns = taken_back(self._steps, self._with_explicit(core, homogeneous), zero, homogeneous)
        return tuple(unknowns.get(j, zero) for j in range(len(self.columns)))

    def _with_explicit(self, core: dict[int, Scalar], homogeneous: bool) -> dict[int, Scalar]:
        unknowns = dict(core)
        for name, row in reversed(self._explicit):
            others = {j: c for j, c in row.coefficients.items() if j != name}
            pivot = row.coefficients[name]
            value = self._rest(others, unknowns, row, homogeneous)
            unknowns[name] = value if pivot.is_one else value * (1 / pivot)
        return unknowns

    def lengths(self) -> tuple[Scalar, ...]:
        """The factors of pivots that depend on coordinates, each of them once."""
        monomials = (self._graph.products.monomial(pivot)[1] for pivot in self._tested)
        factors = dict.fromkeys(factor for powers in monomials for factor, power in powers.items() if power > 0)
        return tuple(factor for factor in factors if not self._safe(factor))

    def content(self, entries: Sequence[Scalar]) -> dict[Scalar, int]:
        """The parameters, declared nonzero, that are factors of all entries."""
        monomials = [self._graph.products.monomial(x)[1] for x in entries if not x.is_zero]
        common = {
            factor: min(powers.get(factor, 0) for powers in monomials)
            for factor in (monomials[0] if monomials else {})
            if factor in self._nonzero
        }
        return {factor: power for factor, power in common.items() if power > 0}

    def _cancelled(self, rows: Sequence[Vector]) -> list[Vector]:
        """The rows with what cancels inside of entries left out.

        A shorter entry is taken where it gains more by itself than all rows and f lose that it had in common with them.
        """
        shortened = [list(row) for row in rows]
        weight: int | None = None
        for row in shortened:
            for j, entry in enumerate(row):
                shorter = self._mechanics.factoring.cancelled(entry)
                if shorter is entry:
                    continue
                weight = self._weight(shortened) if weight is None else weight
                row[j] = shorter
                now = self._weight(shortened)
                if now - weight < _sums_and_products(entry) - _sums_and_products(shorter):
                    weight = now
                else:
                    row[j] = entry
        return [tuple(row) for row in shortened]

    def _weight(self, rows: Sequence[Sequence[Scalar]]) -> int:
        return cost([*(x for row in rows for x in row), *self._mechanics.balance]).weight

    # steps -----------------------------------------------------------------------------------------------------------

    def _share_points(self) -> None:
        """Sums of multipliers that act together on two rows or more become unknowns of their own."""
        groups: dict[tuple[int, ...], int] = {}
        for row in self.core:
            equal: dict[Scalar, list[int]] = {}
            for j, coefficient in row.coefficients.items():
                if j not in self.inputs:
                    equal.setdefault(coefficient, []).append(j)
            for together in map(tuple, equal.values()):
                if len(together) > 1:
                    groups[together] = groups.get(together, 0) + 1
        one = self._graph.one
        for members, count in groups.items():
            if count < 2:
                continue
            total = self._unknowns
            self._unknowns += 1
            for row in self.core:
                first = row.coefficients.get(members[0])
                if first is not None and all(row.coefficients.get(j) is first for j in members):
                    for j in members:
                        del row.coefficients[j]
                    row.coefficients[total] = first
            self._points[total] = LinearEquation({total: one, **dict.fromkeys(members, -one)}, self._graph.zero)

    def _leave_single_inputs(self) -> None:
        """Inputs of one row only, so that the rows without inputs decide on directions."""
        while True:
            single_input = next(
                ((j, row) for row in self.core for j in self._occurs_here_only(row) if j in self.inputs), None
            )
            if single_input is None:
                return
            self._leave(*single_input)

    def _turn_multipliers(self, lengths: bool = False) -> None:
        """Pairs of multipliers are turned into the directions in which a row holds one of them only.

        With `lengths` also where what both are multiples of depends on coordinates, and again in other directions.
        """
        turned: set[int] = set()
        for row in list(self.core):
            if len(row.coefficients) != 2:
                continue
            (j, a), (k, b) = row.coefficients.items()
            if turned & {j, k} or j in self.inputs or k in self.inputs:
                continue
            direction = self._direction(a, b, lengths)
            if direction is not None:
                turned |= {j} if lengths else {j, k}
                self._turn_unknowns(j, k, *direction)

    def _turn_unknowns(self, j: int, k: int, f: Scalar, g: Scalar) -> None:
        """(x_j, x_k) = (f x_j' - g x_k', g x_j' + f x_k'), and likewise the rows of the sums x_j and x_k."""
        zero = self._graph.zero
        self._steps.append(TurnedUnknowns(j, k, f, g))
        for row in (*self.core, *(row for _, row in self._explicit), *self._points.values()):
            a, b = row.coefficients.get(j, zero), row.coefficients.get(k, zero)
            self._put(row, j, a * f + b * g)
            self._put(row, k, b * f - a * g)
        if j in self._points and k in self._points:
            self._points[j], self._points[k] = self._turned(self._points[j], self._points[k], f, g)

    def _turn_rows(self) -> None:
        """Pairs of rows are turned so that one of them holds an unknown that both held, and nothing else holds."""
        for name in sorted({j for row in self.core for j in row.coefficients}):
            holders = [row for row in self.core if name in row.coefficients]
            if len(holders) != 2 or any(row in self._points.values() for row in holders):
                continue
            first, second = holders
            direction = self._direction(first.coefficients[name], second.coefficients[name])
            if direction is None:
                continue
            along, across = self._turned(first, second, *direction)
            for row in holders:
                self.core.remove(row)
            self.core += [along, across]

    def _turned(
        self, first: LinearEquation, second: LinearEquation, f: Scalar, g: Scalar
    ) -> tuple[LinearEquation, LinearEquation]:
        """(f first + g second, f second - g first)."""
        zero = self._graph.zero
        rights = [first.right * f + second.right * g, second.right * f - first.right * g]
        shorter = [self._mechanics.factoring.cancelled(x) if x.size <= LONGEST_CANCELLED else x for x in rights]
        along, across = LinearEquation({}, shorter[0]), LinearEquation({}, shorter[1])
        for name in sorted({*first.coefficients, *second.coefficients}):
            a, b = first.coefficients.get(name, zero), second.coefficients.get(name, zero)
            self._put(along, name, a * f + b * g)
            self._put(across, name, b * f - a * g)
        return along, across

    def _put(self, row: LinearEquation, name: int, value: Scalar) -> None:
        if value.size <= LONGEST_CANCELLED:
            value = self._mechanics.factoring.cancelled(value)
        if value.is_zero:
            row.coefficients.pop(name, None)
        else:
            row.coefficients[name] = value

    def _direction(self, a: Scalar, b: Scalar, lengths: bool = False) -> tuple[Scalar, Scalar] | None:
        """(f, g) with f^2 + g^2 = 1 where (a, b) = k (f, g) with a safe k, or with any k in case of `lengths`."""
        fixed, products = self._mechanics.factoring.fixed, self._graph.products
        (ka, left), (kb, right) = products.monomial(a), products.monomial(b)
        content = {x: p for x, p in left.items() if (right.get(x) == p if lengths else fixed(x))}
        if abs(ka) != abs(kb) or (not lengths and content != {x: p for x, p in right.items() if fixed(x)}):
            return None
        f, g = (products.quotient(x, content, ka if ka > 0 else -ka) for x in (a, b))
        safe = bool(ka) and (lengths or all(x in self._nonzero for x in content))
        return (f, g) if safe and (f * f + g * g).is_one else None

    def _safe(self, pivot: Scalar) -> bool:
        """Whether a pivot is a number, or a product of parameters whose declared ranges leave out 0."""
        coefficient, powers = self._graph.products.monomial(pivot)
        return coefficient != 0 and all(factor in self._nonzero for factor in powers)

    def _pivot(self, lengths: bool = False) -> None:
        """Solves rows with one unknown at once; unknowns of one row only are left for the end."""
        while True:
            alone = next((row for row in self.core if self._solves(row)), None)
            if alone is None and lengths:
                alone = next((row for row in self.core if len(row.coefficients) == 1), None)
                self._tested += alone.coefficients.values() if alone is not None else ()
            if alone is not None:
                self._solve(alone)
                continue
            last = next(((name, row) for row in self.core for name in self._occurs_here_only(row)), None)
            if last is None:
                return
            self._leave(*last)

    def _divide_rows(self) -> None:
        """The rows of the core without the lengths that all coefficients of one have: determinants become shorter."""
        graph, products = self._graph, self._graph.products
        for row in self.core:
            content = self.content(list(row.coefficients.values()))
            if not content:
                continue
            divisor = graph.product(factor for factor, power in content.items() for _ in range(power))
            for name, coefficient in row.coefficients.items():
                row.coefficients[name] = products.quotient(coefficient, content)
            right = row.right / divisor
            row.right = self._mechanics.factoring.cancelled(right) if right.size <= LONGEST_CANCELLED else right

    def _turn_back(self) -> None:
        """Solves rows A x = b with an orthogonal A, all entries of which may vary: x = A^T b."""
        together: dict[tuple[int, ...], list[LinearEquation]] = {}
        for row in self.core:
            together.setdefault(tuple(sorted(row.coefficients)), []).append(row)
        for names, rows in together.items():
            if len(names) == len(rows) > 1 and self._is_orthogonal(names, rows):
                for name in names:
                    value = self._graph.sum(row.coefficients[name] * row.right for row in rows)
                    value = self._mechanics.factoring.cancelled(value) if value.size <= LONGEST_CANCELLED else value
                    self.core.append(LinearEquation({name: self._graph.one}, value))
                for row in rows:
                    self.core.remove(row)

    def _is_orthogonal(self, names: Sequence[int], rows: Sequence[LinearEquation]) -> bool:
        columns = [[row.coefficients[name] for row in rows] for name in names]
        products = {(i, j): dot(self._graph, columns[i], columns[j]) for i in range(len(names)) for j in range(i + 1)}
        return all(value.is_one if i == j else value.is_zero for (i, j), value in products.items())

    def _without_inputs(self) -> Matrix:
        """The rows with inputs at 0, in the model's coordinates; none where moments were turned with other rows."""
        rows = [*self.core, *(row for _, row in self._explicit)]
        left = [{j: c for j, c in row.coefficients.items() if j not in self.inputs} for row in rows]
        for (_, turning), moments in zip(self._mechanics.turnings, self._moments, strict=True):
            places = [k for moment in moments for k, row in enumerate(rows) if row is moment]
            if len(places) < len(moments):
                return ()
            turned = along_rates(self._graph, [left[k] for k in places], turning)
            for k, row in zip(places, turned, strict=True):
                left[k] = row
        return multipliers_alone(left, self._safe, self._graph.zero)

    def _solves(self, row: LinearEquation) -> bool:
        """One unknown with a safe pivot; an input is left for the end instead where no other row needs it."""
        if len(row.coefficients) != 1:
            return False
        ((name, pivot),) = row.coefficients.items()
        needed = name not in self.inputs or any(name in other.coefficients for other in self.core if other is not row)
        return needed and self._safe(pivot)

    def _solve(self, row: LinearEquation) -> None:
        ((name, pivot),) = row.coefficients.items()
        self.core.remove(row)
        if name in self.inputs:
            self._explicit.append((name, row))
        # the reciprocal of a length serves every row that is divided by it
        value = row.right if pivot.is_one else row.right * (1 / pivot)
        if name not in self.inputs:
            self._steps.append(SolvedUnknown(name, value))
        for other in (*self.core, *(row for _, row in self._explicit)):
            if other is row:
                continue
            coefficient = other.coefficients.pop(name, None)
            if coefficient is not None:
                other.right = other.right - coefficient * value

    def _leave(self, name: int, row: LinearEquation) -> None:
        self.core.remove(row)
        self._explicit.append((name, row))

    def _occurs_here_only(self, row: LinearEquation) -> list[int]:
        others = [*(other for other in self.core if other is not row), *self._pending()]
        return [
            name
            for name, pivot in row.coefficients.items()
            if self._safe(pivot) and not any(name in other.coefficients for other in others)
        ]

    def _pending(self) -> list[LinearEquation]:
        """The rows of points, before they join the core."""
        return [row for row in self._points.values() if row not in self.core and not self._left(row)]

    def _left(self, row: LinearEquation) -> bool:
        return any(row is other for _, other in self._explicit)

    def _rest(
        self, coefficients: dict[int, Scalar], values: dict[int, Scalar], row: LinearEquation, homogeneous: bool
    ) -> Scalar:
        products = self._graph.products
        content = self.content(list(coefficients.values()))
        taken = self._graph.sum(products.quotient(c, content) * values[j] for j, c in coefficients.items())
        for factor, power in content.items():
            taken = taken * self._graph.power(factor, Fraction(power))
        return -taken if homogeneous else row.right - taken


def _sums_and_products(scalar: Scalar) -> int:
    operations = cost([scalar])
    return operations.additive + operations.multiplications
