"""The range form of u: where M selects rows, the passive rows give the multipliers and the drive rows give u.

The system M u + B^T lambda = tau is solved without N_B, B B^T or any choice of coordinates:

1. multipliers that act on some rows with the same coefficients only are replaced there by their sum (several links
   that meet in one point: each gets its own force and the balance of the point becomes a pair of rows);
2. a pair of multipliers whose coefficients in a passive row are k (f, g) with f^2 + g^2 = 1 is turned into its
   components along and across (f, g), so that the row holds one unknown;
3. rows with one unknown, and unknowns that occur in one passive row only, are solved for where the pivot is a product
   of parameters that are declared nonzero;
4. the few rows that remain are solved by minors, and the internal force z (m - delta = 1) is taken out of u.

Every elementary step is invertible wherever the parameters are in their ranges.  So the minors of the remaining rows
vanish together exactly where [M, B^T] loses rank, an input singularity, and z beside regular ones exactly where the
rank of B drops: the form is valid at every regular configuration.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from symgen.dynamics.exterior import ActuationForms, RowForms, cross_product, unit, wedge_all
from symgen.dynamics.forms.form import Form, form
from symgen.dynamics.genericity import Genericity
from symgen.dynamics.guards import Guard, magnitude
from symgen.dynamics.mechanics import Mechanics
from symgen.graph.matrix import Vector, dot, transpose
from symgen.graph.scalar import Graph, Scalar
from symgen.graph.traverse import substitute
from symgen.ir.kernel import Status

# Larger cores have more minors than other forms need operations.
LARGEST_CORE = 4


@dataclass(slots=True)
class _Row:
    """One equation: coefficients of unknowns, and the right-hand side."""

    coefficients: dict[int, Scalar]
    right: Scalar


def range_form(mechanics: Mechanics, generic: Genericity) -> Form | None:
    """u by the range form, or None where it does not apply; `mechanics` may be in absolute angles."""
    drives = _drive_rows(mechanics)
    if drives is None or not generic.full_actuation or generic.rank < generic.r or generic.m - generic.delta > 1:
        return None
    solved = _Elimination(mechanics, drives).solve(generic.m - generic.delta)
    if solved is None:
        return None
    outputs, guards = solved
    return form("range", "inverse_dynamics", outputs, guards, mechanics.balance)


def _drive_rows(mechanics: Mechanics) -> tuple[int, ...] | None:
    """The row of each input where every column of M is a unit vector and all differ."""
    found = []
    for column in mechanics.inputs:
        entries = [i for i, entry in enumerate(column) if not entry.is_zero]
        if len(entries) != 1 or not column[entries[0]].is_one:
            return None
        found.append(entries[0])
    return tuple(found) if len(set(found)) == len(found) else None


class _Elimination:
    """The rows of M u + B^T lambda = tau on their way to a small core."""

    def __init__(self, mechanics: Mechanics, drives: Sequence[int]) -> None:
        self._mechanics = mechanics
        self._graph: Graph = mechanics.graph
        rows, force = mechanics.constraint_jacobian, mechanics.balance
        every = [
            _Row({j: row[i] for j, row in enumerate(rows) if not row[i].is_zero}, force[i])
            for i in range(mechanics.n)
        ]
        self._drives = [every[i] for i in drives]
        self._passive = [row for i, row in enumerate(every) if i not in drives]
        self._unknowns = len(rows)
        self._points: list[tuple[int, _Row]] = []
        self._explicit: list[tuple[int, _Row]] = []
        self._positive = {
            mechanics.graph.symbol(p.name)
            for p in mechanics.model.parameters
            if p.range is not None and (p.range[0] > 0 or p.range[1] < 0)
        }

    def solve(self, internal: int) -> tuple[Vector, tuple[Guard, ...]] | None:
        """u and its guards; None where the core is too large."""
        self._share_points()
        self._turn_pairs()
        self._pivot()
        names = sorted({j for row in (*self._passive, *self._drives) for j in row.coefficients})
        names = [j for j in names if j not in {j for j, _ in self._explicit}]
        if len(self._passive) > LARGEST_CORE or len(names) - len(self._passive) != internal:
            return None
        graph, size = self._graph, len(self._passive)
        core = tuple(tuple(row.coefficients.get(j, graph.zero) for j in names) for row in self._passive)
        columns = transpose(core, len(names))
        right = tuple(row.right for row in self._passive)
        forms = ActuationForms(RowForms(graph, (), size, 0), columns, size)
        particular = dict(zip(names, self._particular(forms, right), strict=True))
        guards = []
        if size:
            scale = magnitude(graph, [forms.denominator()])[0]
            degree = 1 if forms.single else 2
            cause = (self._regularity(names, columns),)
            guards.append(Guard(Status.ACTUATION_RANK, forms.denominator(), degree, cause, scale))
        u = self._drive_forces(particular, homogeneous=False)
        if internal:
            null = dict(zip(names, cross_product(graph, core, len(names)), strict=True))
            z = self._without_content(self._drive_forces(null, homogeneous=True))
            length = graph.sum(x * x for x in z)
            share = dot(graph, z, u) / length
            u = tuple(a - b * share for a, b in zip(u, z, strict=True))
            guards.append(Guard(Status.CONSTRAINT_RANK, length, 2, scale=self._scale(z, forms)))
        back = self._back()
        u = tuple(substitute(graph, u, back))
        guards = [self._moved(guard, back) for guard in guards]
        return u, tuple(guards)

    # steps -----------------------------------------------------------------------------------------------------------

    def _share_points(self) -> None:
        """Sums of multipliers that act together on two rows or more become unknowns of their own."""
        rows = [*self._passive, *self._drives]
        groups: dict[tuple[int, ...], int] = {}
        for row in rows:
            equal: dict[Scalar, list[int]] = {}
            for j, coefficient in row.coefficients.items():
                equal.setdefault(coefficient, []).append(j)
            for together in map(tuple, equal.values()):
                if len(together) > 1:
                    groups[together] = groups.get(together, 0) + 1
        for members, count in groups.items():
            if count < 2:
                continue
            total = self._unknowns
            self._unknowns += 1
            for row in rows:
                first = row.coefficients.get(members[0])
                if first is not None and all(row.coefficients.get(j) is first for j in members):
                    for j in members:
                        del row.coefficients[j]
                    row.coefficients[total] = first
            one = self._graph.one
            self._points.append((total, _Row({total: one, **dict.fromkeys(members, -one)}, self._graph.zero)))

    def _turn_pairs(self) -> None:
        """Pairs of unknowns are turned into the directions in which a passive row holds one of them only."""
        turned: set[int] = set()
        for row in self._passive:
            if len(row.coefficients) != 2:
                continue
            (j, a), (k, b) = row.coefficients.items()
            if turned & {j, k}:
                continue
            direction = self._direction(a, b)
            if direction is not None:
                turned |= {j, k}
                self._turn(j, k, *direction)
        self._passive += [row for _, row in self._points]

    def _turn(self, j: int, k: int, f: Scalar, g: Scalar) -> None:
        """(x_j, x_k) = (f x_j' - g x_k', g x_j' + f x_k'), and likewise the rows of the sums x_j and x_k."""
        graph = self._graph
        for row in (*self._passive, *self._drives, *(row for _, row in self._points)):
            a, b = row.coefficients.get(j, graph.zero), row.coefficients.get(k, graph.zero)
            self._put(row, j, a * f + b * g)
            self._put(row, k, b * f - a * g)
        sums = dict(self._points)
        if j in sums and k in sums:
            first, second = sums[j], sums[k]
            along, across = _Row({}, graph.zero), _Row({}, graph.zero)
            for name in sorted({*first.coefficients, *second.coefficients}):
                a = first.coefficients.get(name, graph.zero)
                b = second.coefficients.get(name, graph.zero)
                self._put(along, name, a * f + b * g)
                self._put(across, name, b * f - a * g)
            sums[j], sums[k] = along, across
            self._points = list(sums.items())

    def _put(self, row: _Row, name: int, value: Scalar) -> None:
        value = self._mechanics.factoring.cancelled(value)
        if value.is_zero:
            row.coefficients.pop(name, None)
        else:
            row.coefficients[name] = value

    def _direction(self, a: Scalar, b: Scalar) -> tuple[Scalar, Scalar] | None:
        """(f, g) with f^2 + g^2 = 1 where (a, b) = k (f, g) with a safe k."""
        fixed = self._mechanics.factoring.fixed
        (ka, left), (kb, right) = self._graph.products.monomial(a), self._graph.products.monomial(b)
        content = {x: p for x, p in left.items() if fixed(x)}
        if abs(ka) != abs(kb) or content != {x: p for x, p in right.items() if fixed(x)}:
            return None
        products = self._graph.products
        f, g = (products.quotient(x, content, ka if ka > 0 else -ka) for x in (a, b))
        safe = bool(ka) and all(x in self._positive for x in content)
        return (f, g) if safe and (f * f + g * g).is_one else None

    def _safe(self, pivot: Scalar) -> bool:
        """Whether a pivot is a number, or a product of parameters whose declared ranges leave out 0."""
        coefficient, powers = self._graph.products.monomial(pivot)
        return coefficient != 0 and all(factor in self._positive for factor in powers)

    def _pivot(self) -> None:
        """Solves rows with one unknown at once; unknowns of one passive row only are left for the end."""
        while True:
            alone = next((row for row in self._passive if self._solves(row)), None)
            if alone is not None:
                ((name, pivot),) = alone.coefficients.items()
                self._passive.remove(alone)
                # the reciprocal of a length serves every row that is divided by it
                value = alone.right * (1 / pivot)
                for row in (*self._passive, *self._drives):
                    coefficient = row.coefficients.pop(name, None)
                    if coefficient is not None:
                        row.right = row.right - coefficient * value
                continue
            last = next(((name, row) for row in self._passive for name in self._occurs_here_only(row)), None)
            if last is None:
                return
            self._passive.remove(last[1])
            self._explicit.append(last)

    def _solves(self, row: _Row) -> bool:
        return len(row.coefficients) == 1 and self._safe(next(iter(row.coefficients.values())))

    def _occurs_here_only(self, row: _Row) -> list[int]:
        others = [other for other in self._passive if other is not row]
        return [
            name
            for name, pivot in row.coefficients.items()
            if self._safe(pivot) and not any(name in other.coefficients for other in others)
        ]

    # results ---------------------------------------------------------------------------------------------------------

    def _drive_forces(self, values: dict[int, Scalar], homogeneous: bool) -> Vector:
        """What the drives supply for given unknowns, those left for the end worked out first."""
        values = dict(values)
        for name, row in reversed(self._explicit):
            rest = self._rest({j: c for j, c in row.coefficients.items() if j != name}, values, row, homogeneous)
            values[name] = rest / row.coefficients[name]
        return tuple(self._rest(row.coefficients, values, row, homogeneous) for row in self._drives)

    def _rest(
        self, coefficients: dict[int, Scalar], values: dict[int, Scalar], row: _Row, homogeneous: bool
    ) -> Scalar:
        products = self._graph.products
        content = self._content(list(coefficients.values()))
        taken = self._graph.sum(products.quotient(c, content) * values[j] for j, c in coefficients.items())
        for factor, power in content.items():
            taken = taken * self._graph.power(factor, Fraction(power))
        return -taken if homogeneous else row.right - taken

    def _regularity(self, names: Sequence[int], columns: Sequence[Vector]) -> Guard:
        """Vanishes exactly where the rank of B drops: the rows left of it, those of the drives included, by minors."""
        graph = self._graph
        zeros = dict.fromkeys(names, graph.zero)
        whole = [
            (*column, *self._drive_forces({**zeros, name: graph.one}, homogeneous=True))
            for name, column in zip(names, columns, strict=True)
        ]
        minors = wedge_all(unit(graph), whole)
        denominator = graph.sum(value * value for value in minors.values())
        lengths = [graph.sum(x * x for x in magnitude(graph, column)) for column in whole]
        return Guard(Status.CONSTRAINT_RANK, denominator, 2, scale=graph.product(lengths))

    def _without_content(self, z: Vector) -> Vector:
        """z without the parameters that all its entries have as a factor: only its direction counts."""
        content = self._content(z)
        return tuple(self._graph.products.quotient(x, content) for x in z) if content else z

    def _content(self, entries: Sequence[Scalar]) -> dict[Scalar, int]:
        """The parameters, declared nonzero, that are factors of all entries."""
        monomials = [self._graph.products.monomial(x)[1] for x in entries if not x.is_zero]
        common = {
            factor: min(powers.get(factor, 0) for powers in monomials)
            for factor in (monomials[0] if monomials else {})
            if factor in self._positive
        }
        return {factor: power for factor, power in common.items() if power > 0}

    def _particular(self, forms: ActuationForms, right: Vector) -> Vector:
        """Any solution of the core serves, because the internal forces are taken out of u afterwards."""
        if len(right) == 1 and not forms.single:
            share = right[0] / forms.denominator()
            return tuple(column[0] * share for column in forms.inputs)
        return forms.solve(right) if right else (self._graph.zero,) * len(forms.inputs)

    def _scale(self, z: Vector, forms: ActuationForms) -> Scalar:
        """What |z|^2 is measured by: its terms' sizes, small together with the minors of the core."""
        graph = self._graph
        size = graph.sum(x * x for x in magnitude(graph, z))
        if not forms.inputs or not forms.rows.n:
            return size
        return size * forms.square() / magnitude(graph, [forms.square()])[0]

    def _back(self) -> dict[Scalar, Scalar]:
        """The symbols of absolute angles in terms of the model's."""
        mechanics = self._mechanics
        if mechanics.change is None:
            return {}
        graph, model = self._graph, mechanics.model
        found: dict[Scalar, Scalar] = {}
        given = (
            (mechanics.q, [c.name for c in model.coordinates]),
            (mechanics.qd, [c.rate for c in model.coordinates]),
            (mechanics.qdd, [c.acceleration for c in model.coordinates]),
        )
        for own, names in given:
            absolute = mechanics.change.absolute(tuple(graph.symbol(name) for name in names))
            found |= dict(zip(own, absolute, strict=True))
        return found

    def _moved(self, guard: Guard, back: dict[Scalar, Scalar]) -> Guard:
        assert guard.scale is not None
        denominator, scale = substitute(self._graph, [guard.denominator, guard.scale], back)
        first = tuple(self._moved(cause, back) for cause in guard.first)
        return Guard(guard.status, denominator, guard.degree, first, scale)
