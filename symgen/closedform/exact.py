"""All exact matrices of one model, computed when asked for: N_B, N_B-dot, B^+, M~, M~^+, F, u and kernel vectors."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import combinations
from math import comb

from sympy.polys.rings import PolyElement

from symgen.closedform.algebra.homogeneous import common_factor, divide
from symgen.closedform.algebra.limits import LIMIT_OF_MODEL, WORK_LIMIT, TooLargeError
from symgen.closedform.algebra.matrices import add, determinant, identity, multiply, transpose, zero
from symgen.closedform.algebra.minors import (
    Actuation,
    Minors,
    Rows,
    actuation_minors,
    common_denominator,
    estimated_work,
    kernel_minors,
    left_inverse_terms,
    polynomial_rows,
    projector_numerator,
    square_sum,
)
from symgen.closedform.algebra.quotient import Matrix, Quotient, polynomial, quotient
from symgen.closedform.algebra.ring import TrigRing
from symgen.closedform.mechanics import ExactSystem, load, time_derivative
from symgen.closedform.structure import RankStructure
from symgen.model.model import Model


class Exact:
    """Exact matrices of a model over the field of fractions of its ring."""

    def __init__(self, model: Model, mechanics: ExactSystem, structure: RankStructure) -> None:
        self.model = model
        self.mechanics = mechanics
        self.structure = structure
        self.delta = structure.differential_freedom

    @property
    def ring(self) -> TrigRing:
        """The ring of all entries."""
        return self.mechanics.ring

    @property
    def full_actuation(self) -> bool:
        """Whether the degree of actuation is the differential degree of freedom."""
        return self.structure.degree_of_actuation == self.delta

    @cached_property
    def rows(self) -> Rows:
        """B with rows freed of denominators and common factors."""
        jacobian = self.mechanics.jacobian
        with self.ring.work.limited("B without denominators", LIMIT_OF_MODEL):
            return polynomial_rows(self.ring, jacobian)

    @cached_property
    def minor_sets(self) -> tuple[Minors, ...]:
        """The minors Phi for every choice of as many rows as the generic rank (one choice for independent rows)."""
        subsets = list(combinations(range(self.model.r), self.structure.constraint_rank))
        work = sum(estimated_work(tuple(self.rows[i] for i in subset)) for subset in subsets)
        if work > WORK_LIMIT:
            raise TooLargeError(f"the minors of B need about {work} products of terms, more than {WORK_LIMIT}")
        all_minors = [kernel_minors(self.ring, tuple(self.rows[i] for i in subset), self.model.n) for subset in subsets]
        return tuple(minors for minors in all_minors if any(minors.values.values()))

    @cached_property
    def phi_squares(self) -> PolyElement:
        """The sum of squares of all minors."""
        values = [value for minors in self.minor_sets for value in minors.values.values()]
        self._admit(sum(len(v) ** 2 for v in values), "the sum of squares of the minors")
        return square_sum(self.ring, values)

    def _admit(self, work: int, what: str) -> None:
        if work > WORK_LIMIT:
            raise TooLargeError(f"{what} needs about {work} products of terms, more than {WORK_LIMIT}")

    def projector_work(self) -> int:
        """Products of terms in the numerators of N_B."""
        least = self.model.n**2 // 2 * comb(self.model.n, self.delta - 1) if self.delta else 0
        if least > WORK_LIMIT:
            return least
        work = 0
        for minors in self.minor_sets:
            lines = [
                [
                    len(minors.signed((i, *rest), self.ring))
                    for rest in combinations(range(self.model.n), self.delta - 1)
                ]
                for i in range(self.model.n)
            ]
            work += sum(a * b for u, v in combinations(lines, 2) for a, b in zip(u, v, strict=True))
            work += sum(a * a for u in lines for a in u)
        return work

    @cached_property
    def projector(self) -> Matrix:
        """N_B = sum_K Phi_K Phi_K^T / sum_J Phi_J^2."""
        if not self.model.constraints:
            return identity(self.ring, self.model.n)
        self._admit(self.projector_work(), "N_B")
        parts = [projector_numerator(self.ring, minors, self.model.n, self.delta) for minors in self.minor_sets]
        return tuple(
            tuple(
                quotient(self.ring, sum((part[i][j] for part in parts), self.ring.zero), self.phi_squares)
                for j in range(self.model.n)
            )
            for i in range(self.model.n)
        )

    @cached_property
    def projector_dot(self) -> Matrix:
        """The time derivative of N_B along q-dot."""
        translator = self.mechanics.translator
        rows: list[tuple[Quotient, ...]] = []
        for i, row in enumerate(self.projector):
            line = [rows[j][i] for j in range(i)]
            line += [time_derivative(translator, entry, self.model) for entry in row[i:]]
            rows.append(tuple(line))
        return tuple(rows)

    @cached_property
    def pseudoinverse(self) -> Matrix:
        """B^+ = B^T (B B^T)^{-1} by Cramer's rule, for independent rows."""
        if self.structure.constraint_rank < self.model.r:
            raise TooLargeError("the constraints depend on each other: B^+ is not B^T (B B^T)^{-1}")
        jacobian = self.mechanics.jacobian
        terms = max(sum(len(e.numerator) for e in row) for row in jacobian)
        self._admit(terms ** (2 * self.model.r), "B^+")
        right = transpose(jacobian)
        gram = multiply(self.ring, jacobian, right)
        bottom = determinant(self.ring, gram)
        r = self.model.r
        adjugate = tuple(tuple(self._cofactor(gram, j, i) / bottom for j in range(r)) for i in range(r))
        return multiply(self.ring, right, adjugate)

    def _cofactor(self, matrix: Matrix, i: int, j: int) -> Quotient:
        minor = tuple(tuple(e for q, e in enumerate(row) if q != j) for p, row in enumerate(matrix) if p != i)
        value = determinant(self.ring, minor)
        return value if (i + j) % 2 == 0 else -value

    @cached_property
    def projected_control(self) -> Matrix:
        """M~ = N_B M."""
        terms = sum(len(e.numerator) for row in self.projector for e in row)
        self._admit(terms * sum(len(e.numerator) for row in self.mechanics.control for e in row), "N_B M")
        return multiply(self.ring, self.projector, self.mechanics.control)

    @cached_property
    def control_scale(self) -> PolyElement:
        """The common denominator of the control matrix."""
        return common_denominator(self.ring, [entry for row in self.mechanics.control for entry in row])

    @cached_property
    def actuations(self) -> tuple[Actuation, ...]:
        """Delta_J and v_L for every choice of rows, of M times its common denominator."""
        return self._spanned(self.mechanics.control, self.control_scale, "the determinants of the input equations")

    def determined_by(self, slopes: Matrix) -> list[PolyElement]:
        """The determinants of delta functions at a time with B: where all vanish they do not determine the rates.

        Of fewer functions the minors of B and them together: where all vanish the functions lose rank.
        """
        columns = transpose(slopes)
        scale = common_denominator(self.ring, [entry for row in columns for entry in row])
        if len(slopes) < self.delta:
            return self._minors_with(slopes, scale)
        spanned = self._spanned(columns, scale, "the determinants of what is given")
        return [value for one in spanned for value in one.determinants.values()]

    def _minors_with(self, slopes: Matrix, scale: PolyElement) -> list[PolyElement]:
        """Those of as many rows of B as their rank at a time with the slopes times their common denominator."""
        factor = polynomial(self.ring, scale)
        own = tuple(tuple((entry * factor).numerator for entry in row) for row in slopes)
        subsets = combinations(range(self.model.r), self.structure.constraint_rank)
        together = [(*(self.rows[i] for i in subset), *own) for subset in subsets]
        self._admit(sum(map(estimated_work, together)), "the minors of B and the task")
        all_minors = [kernel_minors(self.ring, rows, self.model.n) for rows in together]
        return [self.ring.product(v, one.content) for one in all_minors for v in one.values.values()]

    def _spanned(self, columns: Matrix, scale: PolyElement, what: str) -> tuple[Actuation, ...]:
        """Delta_J and v_L of columns (n x k) times their common denominator."""
        others = self.delta - 1
        contractions = comb(len(columns[0]), others) * self.model.n * comb(self.model.n, others)
        self._admit(contractions * len(self.minor_sets), what)
        factor = polynomial(self.ring, scale)
        whole = tuple(tuple((entry * factor).numerator for entry in row) for row in columns)
        return tuple(actuation_minors(self.ring, minors, whole, self.delta) for minors in self.minor_sets)

    @cached_property
    def delta_squares(self) -> PolyElement:
        """The sum of squares of all Delta_J."""
        values = [value for actuation in self.actuations for value in actuation.determinants.values()]
        self._admit(sum(len(v) ** 2 for v in values), "the sum of squares of the actuation determinants")
        return square_sum(self.ring, values)

    def control_pseudoinverse_work(self) -> int:
        """Products of terms in the numerators of M~^+ (for full actuation)."""
        if self.structure.degree_of_actuation < self.delta:
            return self.projector_work() * self.model.m
        return sum(
            len(actuation.determinants[j]) * sum(len(e) for e in actuation.vectors[rest])
            for actuation in self.actuations
            for k in range(self.model.m)
            for _, j, rest in left_inverse_terms(actuation, k)
        )

    @cached_property
    def control_pseudoinverse(self) -> Matrix:
        """M~^+: by minors for full actuation, by a rank factorisation of N_B M otherwise."""
        if self.structure.degree_of_actuation < self.delta:
            return self._underactuated_pseudoinverse()
        scale = polynomial(self.ring, self.control_scale)
        rows = []
        self._admit(self.control_pseudoinverse_work(), "the pseudoinverse of the projected control matrix")
        for k in range(self.model.m):
            row = []
            for a in range(self.model.n):
                total = self.ring.zero
                for actuation in self.actuations:
                    for sign, j, rest in left_inverse_terms(actuation, k):
                        total = total + sign * actuation.determinants[j] * actuation.vectors[rest][a]
                row.append(quotient(self.ring, self.ring.normal(total), self.delta_squares) * scale)
            rows.append(tuple(row))
        return tuple(rows)

    def _underactuated_pseudoinverse(self) -> Matrix:
        """(28) with alpha columns of M~ that are independent: [I; R^T] (I + R R^T)^{-1} M~_1^+."""
        ring, alpha = self.ring, self.structure.degree_of_actuation
        if alpha == 0:
            return tuple(tuple(zero(ring) for _ in range(self.model.n)) for _ in range(self.model.m))
        for chosen in combinations(range(self.model.m), alpha):
            first = tuple(tuple(row[j] for j in chosen) for row in self.projected_control)
            gram = multiply(ring, transpose(first), first)
            if determinant(ring, gram):
                break
        left = multiply(ring, self._inverse(gram), transpose(first))
        ratio = multiply(ring, left, self.projected_control)
        core = self._inverse(multiply(ring, ratio, transpose(ratio)))
        return multiply(ring, transpose(ratio), multiply(ring, core, left))

    def _inverse(self, matrix: Matrix) -> Matrix:
        bottom = determinant(self.ring, matrix)
        size = range(len(matrix))
        return tuple(tuple(self._cofactor(matrix, j, i) / bottom for j in size) for i in size)

    def complement(self, independent: Sequence[str]) -> Matrix | None:
        """F of (8) for chosen independent velocities; None when they are never independent."""
        names = [c.name for c in self.model.coordinates]
        chosen = [names.index(name) for name in independent]
        if len(chosen) != self.delta:
            return None
        for minors in self.minor_sets:
            bottom = minors.signed(chosen, self.ring)
            if bottom:
                return tuple(
                    tuple(
                        quotient(
                            self.ring,
                            minors.signed((*chosen[:k], a, *chosen[k + 1 :]), self.ring),
                            bottom,
                        )
                        for k in range(self.delta)
                    )
                    for a in range(self.model.n)
                )
        return None

    @cached_property
    def kernel(self) -> Matrix:
        """W: polynomial kernel vectors of B as columns (n x delta), from the shortest minor that is not zero."""
        minors = self.minor_sets[0]
        best = min((s for s, v in minors.values.items() if v), key=lambda s: (len(minors.values[s]), s))
        columns = []
        for k in range(self.delta):
            entries = [minors.signed((*best[:k], a, *best[k + 1 :]), self.ring) for a in range(self.model.n)]
            shared = common_factor(self.ring, entries)
            if next(e for e in entries if e).LC < 0:
                shared = -shared
            columns.append(tuple(polynomial(self.ring, divide(self.ring, e, shared)) for e in entries))
        return transpose(tuple(columns))

    @cached_property
    def load(self) -> Matrix:
        """tau = G qdd + C qd + Q - Q_a."""
        return load(self.model, self.mechanics)

    def inverse_dynamics_work(self) -> int:
        """Products of terms in the numerators of u."""
        longest = max((len(tau.numerator) for (tau,) in self.load), default=0)
        return self.control_pseudoinverse_work() * longest

    @cached_property
    def inverse_dynamics(self) -> Matrix:
        """u = M~^+ tau (27)."""
        self._admit(self.inverse_dynamics_work() * 4, "u")
        left = self.control_pseudoinverse
        return multiply(self.ring, left, self.load)

    @cached_property
    def reaction_load(self) -> Matrix:
        """E = tau + B^T lambda - M u, the motion equations (3) with everything on the left."""
        total = self.load
        if self.model.constraints:
            names = [f"multiplier_{row.name}" for row in self.model.constraints]
            multipliers = tuple((self.mechanics.translator.name(name),) for name in names)
            total = add(total, multiply(self.ring, transpose(self.mechanics.jacobian), multipliers))
        if self.model.inputs:
            controls = tuple((-self.mechanics.translator.name(i.name),) for i in self.model.inputs)
            total = add(total, multiply(self.ring, self.mechanics.control, controls))
        return total
