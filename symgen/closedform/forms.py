"""Closed forms of a model for the report: exact in the ring of sines and cosines, printed in the paper's style."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from sympy import Expr, ImmutableDenseMatrix, Symbol

from symgen.closedform.algebra.limits import TooLargeError
from symgen.closedform.algebra.matrices import column
from symgen.closedform.algebra.quotient import Matrix
from symgen.closedform.algebra.substitution import substitute
from symgen.closedform.allocated import structured_allocation
from symgen.closedform.display import latex_name
from symgen.closedform.exact import Exact
from symgen.closedform.mechanics import ExactSystem, make_translator
from symgen.closedform.points import POINT_DIGITS, generic_points
from symgen.closedform.regressor import ExactRegressor
from symgen.closedform.singular import SingularSet, derive_singular_sets
from symgen.closedform.spelling import Speller
from symgen.closedform.structure import Integrability, RankStructure, derive_integrability, derive_structure
from symgen.closedform.structured import (
    NamedMatrix,
    structured_control_pseudoinverse,
    structured_inverse_dynamics,
    structured_projected_control,
    structured_projector,
    structured_pseudoinverse,
)
from symgen.model.availability import lacking
from symgen.model.expressions.expression import Expression, Name
from symgen.model.kinematics.energy_form import energy_form, points_written
from symgen.model.model import Allocation, Model
from symgen.model.published import PublishedEquations, PublishedMatrix, PublishedSingularSet
from symgen.model.quantities import BASE_PARAMETERS, BASE_REGRESSOR, REGRESSOR, ROWS
from symgen.records import dataclass

_OF_COLUMNS = (REGRESSOR, BASE_REGRESSOR)
LONG_MATRIX = 60
"""A derived matrix whose numerators have more terms than this is printed in named minors when such a form exists."""

SHORT_WORK = 500
"""Products of terms below which a matrix is built to see how long it is."""

LONGEST_MATRIX = 600
"""A matrix with more terms than this is not printed."""


@dataclass(frozen=True, slots=True)
class ClosedForm:
    """One quantity: its matrix in SymPy (None when not attempted), intermediates in order of use, and what to say."""

    quantity: str
    matrix: ImmutableDenseMatrix | None
    intermediates: tuple[tuple[Symbol, Expr], ...]
    note: str


@dataclass(frozen=True, slots=True)
class ClosedForms:
    """All closed forms of a model and its structure; `exact` holds the same in the ring.

    `null_space` has a basis W of ker B as columns, polynomial in sines and cosines (None where it is too long).
    `actuation_determinants` are (inputs J, Delta_J = det[M_J, B^T]) for every choice of as many inputs as degrees of
    freedom, without the common factor of the minors Phi of B: det(N_B M_J)^T (N_B M_J) = Delta_J^2 / sum Phi^2, the
    curves of Fig. 6.  Empty for under-actuated models, dependent constraints and where the minors are too large.
    """

    model: str
    forms: Mapping[str, ClosedForm]
    structure: RankStructure
    null_space: ImmutableDenseMatrix | None
    integrability: tuple[Integrability, ...]
    singular_sets: tuple[SingularSet, ...]
    actuation_determinants: tuple[tuple[tuple[str, ...], Expr], ...]
    symbol_table: Mapping[str, str]
    exact: Exact


def derive_closed_forms(model: Model, straight_line_operations: Mapping[str, int] | None = None) -> ClosedForms:
    """Derive every closed form of a model that is worth printing.

    `straight_line_operations` are the operation counts of the generated kernels: a closed form that is estimated at
    more than ten times that is given in named intermediates or not at all.  Raises ArithmeticError for a model that
    divides by something identically zero, TooLargeError when already B or M is too long to write out, or where no
    configuration was found at which ranks are seen.
    """
    of_columns = [name for name in _OF_COLUMNS if name in model.outputs and lacking(ROWS[name], model) is None]
    described = model
    asked = not {"all", "point_position", "point_jacobian"}.isdisjoint(model.outputs)
    model, places, velocities = points_written(model) if asked else (energy_form(model), (), ())
    of_points = map(Name, (*places, *velocities))
    translator = make_translator(model, (*published_expressions(model), *of_points, *_base_values(model)))
    mechanics = ExactSystem(model, translator)
    points = generic_points(model, mechanics, 3)
    if not points:
        # ranks are those on V: off it, rows that depend on each other are independent
        raise TooLargeError(f"no configuration was found that satisfies the constraints to {POINT_DIGITS} digits")
    structure = derive_structure(model, mechanics, points)
    exact = Exact(model, mechanics, structure)
    speller = Speller(exact.ring, dynamic_names(model))
    kernel = _short_kernel(exact)
    columns = ExactRegressor(described, structure) if of_columns else None
    writer = _FormWriter(model, exact, speller, straight_line_operations or {}, places, velocities, of_columns, columns)
    return ClosedForms(
        model=model.name,
        forms={form.quantity: form for form in writer.all_forms()},
        structure=structure,
        null_space=None if kernel is None else _spelled(speller, kernel),
        integrability=derive_integrability(model, mechanics, kernel),
        singular_sets=derive_singular_sets(model, exact, speller),
        actuation_determinants=_actuation_determinants(model, exact, speller),
        symbol_table=writer.symbol_table(),
        exact=exact,
    )


def _base_values(model: Model) -> tuple[Expression, ...]:
    """The base parameters as expressions, where they are asked for."""
    base = model.inertial_base
    return base.values if base is not None and BASE_PARAMETERS in model.outputs else ()


def _short_kernel(exact: Exact) -> Matrix | None:
    """W, unless it is too long to print."""
    try:
        kernel = exact.kernel
    except TooLargeError:
        return None
    return kernel if sum(len(entry.numerator) for row in kernel for entry in row) <= LONGEST_MATRIX else None


def _spelled(speller: Speller, matrix: Matrix) -> ImmutableDenseMatrix:
    return ImmutableDenseMatrix([[speller.quotient(entry) for entry in row] for row in matrix])


def _actuation_determinants(model: Model, exact: Exact, speller: Speller) -> tuple[tuple[tuple[str, ...], Expr], ...]:
    if not model.inputs or not exact.full_actuation:
        return ()
    try:
        choices = exact.actuations
    except TooLargeError:
        return ()
    if len(choices) != 1:
        return ()
    (actuation,) = choices
    scale = speller.polynomial(exact.control_scale) ** exact.delta
    return tuple(
        (tuple(model.inputs[k].name for k in subset), speller.polynomial(value) / scale)
        for subset, value in actuation.determinants.items()
    )


def dynamic_names(model: Model) -> tuple[str, ...]:
    """Rates and accelerations, by which long sums are collected."""
    return tuple(name for c in model.coordinates for name in (c.rate, c.acceleration))


def published_expressions(model: Model) -> Iterable[Expression]:
    """Every expression of the model's published formulas, so that the ring can hold them."""
    for item in model.published:
        match item:
            case PublishedMatrix():
                for matrix in (item.value, item.corrected or ()):
                    for row in matrix:
                        yield from (substitute(entry, dict(item.where)) for entry in row)
            case PublishedEquations():
                for sides in (*item.equations, *item.corrected):
                    yield from (substitute(side, dict(item.where)) for side in sides)
            case PublishedSingularSet():
                yield item.where_zero
                if item.corrected is not None:
                    yield item.corrected


class _FormWriter:
    """Chooses the form of every quantity."""

    def __init__(
        self,
        model: Model,
        exact: Exact,
        speller: Speller,
        operations: Mapping[str, int],
        places: tuple[str, ...],
        velocities: tuple[str, ...],
        of_columns: Sequence[str] = (),
        columns: ExactRegressor | None = None,
    ) -> None:
        self.model = model
        self.places, self.velocities = places, velocities
        self.of_columns, self.columns, self.base = of_columns, columns, _base_values(model)
        self.exact = exact
        self.speller = speller
        self.operations = operations
        self.taken = frozenset(exact.ring.variables)
        self.names: set[str] = set()

    def all_forms(self) -> Iterable[ClosedForm]:
        """The forms in the order of the derivation."""
        mechanics, exact, model = self.exact.mechanics, self.exact, self.model
        yield self._direct("mass_matrix", lambda: mechanics.mass)
        yield self._direct("coriolis_matrix", lambda: mechanics.coriolis)
        yield self._direct("coriolis_force", lambda: mechanics.coriolis_force)
        yield self._direct("potential_force", lambda: mechanics.potential_force)
        yield self._direct("applied_force", lambda: mechanics.applied_force)
        if mechanics.residual:
            yield self._direct("constraint_residual", lambda: mechanics.residual)
        if model.constraints:
            yield self._direct("constraint_jacobian", lambda: mechanics.jacobian)
            yield self._direct("constraint_jacobian_dot", lambda: mechanics.jacobian_dot)
            yield self._pseudoinverse()
        projector = self._direct(
            "nullspace_projector",
            lambda: exact.projector,
            "N_B = I - B^+ B",
            lambda: structured_projector(exact, self.speller, self.taken),
            exact.projector_work,
        )
        yield projector
        if projector.note:
            text = "not written out, as N_B is not; the derivative of N_B is -X - X^T, X = B^+ Bdot N_B"
            yield ClosedForm("nullspace_projector_dot", None, (), text)
        else:
            yield self._direct("nullspace_projector_dot", lambda: exact.projector_dot)
        if model.independent_velocities:
            yield self._direct("orthogonal_complement", self._complement)
        if model.inputs:
            yield from self._actuation_forms(projector)
        if self.columns is not None:
            yield from (self._regressor(name, self.columns) for name in self.of_columns)
        if self.base:
            translator = mechanics.translator
            yield self._direct(BASE_PARAMETERS, lambda: column([translator.value(one) for one in self.base]))
        if model.task:
            yield self._direct("task_jacobian", lambda: mechanics.task_jacobian)
        if self.places:
            yield self._direct("point_position", lambda: mechanics.places(self.places))
            yield self._direct("point_jacobian", lambda: mechanics.rate_coefficients(self.velocities))

    def _actuation_forms(self, projector: ClosedForm) -> Iterable[ClosedForm]:
        """M, N_B M, its pseudoinverse and u."""
        exact, speller, taken = self.exact, self.speller, self.taken
        shown = None if projector.matrix is None else NamedMatrix(projector.matrix, projector.intermediates)
        yield self._direct("control_matrix", lambda: exact.mechanics.control)
        yield self._direct(
            "projected_control_matrix",
            lambda: exact.projected_control,
            "N_B M",
            None if shown is None else lambda: structured_projected_control(exact, speller, shown),
            exact.projector_work,
        )
        pseudoinverse = self._direct(
            "projected_control_pseudoinverse",
            lambda: exact.control_pseudoinverse,
            "(28)",
            (lambda: structured_control_pseudoinverse(exact, speller, taken)) if exact.full_actuation else None,
            exact.control_pseudoinverse_work,
        )
        yield pseudoinverse
        if self.model.allocation is not None:
            yield self._allocated(self.model.allocation)
            return
        if self.model.rough:
            reason = "not written out: friction grows with reactions, and reactions with friction"
            yield ClosedForm("inverse_dynamics", None, (), reason)
            return
        left = pseudoinverse.matrix
        known = None if left is None else NamedMatrix(left, pseudoinverse.intermediates)
        yield self._direct(
            "inverse_dynamics",
            lambda: exact.inverse_dynamics,
            "the pseudoinverse of N_B M times tau",
            None if known is None else lambda: structured_inverse_dynamics(exact, speller, known, taken),
            exact.inverse_dynamics_work,
        )

    def _allocated(self, allocation: Allocation) -> ClosedForm:
        """u as the model's allocation says, in named parts."""
        quantity, reason = "inverse_dynamics", "not written out: the inputs do not reach every direction of motion"
        if self.model.keeps_limits:
            reason = "not written out: of all sets of limits that inputs may reach one is taken at each state"
        elif self.exact.full_actuation:
            try:
                with self.exact.ring.work.limited("inverse dynamics"):
                    form = structured_allocation(self.exact, self.speller, self.taken, allocation)
                return self._record(ClosedForm(quantity, form.matrix, form.intermediates, ""))
            except TooLargeError as large:
                reason = f"not written out: {large}"
        return ClosedForm(quantity, None, (), f"{reason}; the allocation of redundant inputs")

    def _regressor(self, quantity: str, columns: ExactRegressor) -> ClosedForm:
        """Y or columns of it, in a ring of its own."""
        exact, base = columns.exact, self.model.inertial_base
        numbers = base.columns if base is not None and quantity == BASE_REGRESSOR else None
        speller = Speller(exact.ring, dynamic_names(exact.model))
        own = _FormWriter(exact.model, exact, speller, self.operations, (), ())
        of_tau = "the pseudoinverse of N_B M times the columns of tau"
        form = own._direct(quantity, lambda: columns.matrix(numbers), of_tau)
        self.names |= own.names
        return form

    def _pseudoinverse(self) -> ClosedForm:
        """B^+, or the entries of S = B B^T with the formula."""
        quantity = "constraint_pseudoinverse"
        form = self._direct(quantity, lambda: self.exact.pseudoinverse, "B^+ = B^T S^{-1} with S = B B^T")
        if form.matrix is None and self.exact.structure.constraint_rank == self.model.r:
            return ClosedForm(quantity, None, structured_pseudoinverse(self.exact, self.speller, self.taken), form.note)
        return form

    def _complement(self) -> Matrix:
        matrix = self.exact.complement(self.model.independent_velocities)
        if matrix is None:
            raise TooLargeError("the chosen velocities are never independent")
        return matrix

    def _direct(
        self,
        quantity: str,
        build: Callable[[], Matrix],
        formula: str = "",
        structured: Callable[[], NamedMatrix] | None = None,
        work: Callable[[], int] | None = None,
    ) -> ClosedForm:
        """The matrix written out when it is short, else in named minors, else only the formula with the reason."""
        try:
            reason = self._estimate(quantity, work)
            if not reason:
                with self.exact.ring.work.limited(quantity.replace("_", " ")):
                    matrix = build()
                terms = sum(len(e.numerator) + len(e.denominator) - 1 for row in matrix for e in row)
                if terms <= (LONG_MATRIX if structured else LONGEST_MATRIX):
                    printed = _spelled(self.speller, matrix)
                    return self._record(ClosedForm(quantity, printed, (), ""))
                reason = f"not written out: {terms} terms"
            if structured is not None:
                form = structured()
                return self._record(ClosedForm(quantity, form.matrix, form.intermediates, reason))
        except TooLargeError as large:
            reason = f"not written out: {large}"
        return ClosedForm(quantity, None, (), f"{reason}; {formula}" if formula else reason)

    def _estimate(self, quantity: str, work: Callable[[], int] | None) -> str:
        """Why a matrix is not even built, from the number of products of terms it needs; empty when it is."""
        if work is None:
            return ""
        products, operations = work(), self.operations.get(quantity)
        if operations is not None and products > max(10 * operations, SHORT_WORK):
            kernel = f"above ten times the {operations} operations of the kernel"
            return f"not written out: about {products} products of terms, {kernel}"
        if products > SHORT_WORK:
            return f"not written out: about {products} products of terms"
        return ""

    def _record(self, form: ClosedForm) -> ClosedForm:
        if form.matrix is not None:
            self.names |= {s.name for s in form.matrix.free_symbols}
        for symbol, meaning in form.intermediates:
            self.names |= {symbol.name} | {s.name for s in meaning.free_symbols}
        return form

    def symbol_table(self) -> Mapping[str, str]:
        """LaTeX for every name of the model and of the forms."""
        return {name: latex_name(name) for name in sorted(self.names | self.taken) if not name.startswith("_")}
