"""Published formulas, decided by computation: identical, equal on the constraint manifold only, or misprinted.

Matrices are compared by normal form in the ring.  The constraint manifold is reached by substituting qd = W nu and
qdd = W nu-dot + W-dot nu with a null-space basis W of B; where geometric constraints matter, points of V at 40 digits
decide and the verdict says so.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

from mpmath import mpf, nstr
from sympy import ImmutableDenseMatrix
from sympy.polys.rings import PolyElement

from symgen.closedform.algebra.limits import TooLargeError
from symgen.closedform.algebra.matrices import dot, multiply, solve, transpose
from symgen.closedform.algebra.minors import common_denominator
from symgen.closedform.algebra.quotient import Matrix, Quotient
from symgen.closedform.algebra.substitution import substitute
from symgen.closedform.exact import Exact
from symgen.closedform.forms import ClosedForms, dynamic_names
from symgen.closedform.manifold import Manifold
from symgen.closedform.points import RingPoint, generic_points
from symgen.closedform.singular import essential_factors
from symgen.closedform.spelling import Speller
from symgen.model.expressions.expression import Expression
from symgen.model.model import Model
from symgen.model.published import Matrix as ExpressionMatrix
from symgen.model.published import Published, PublishedEquations, PublishedMatrix, PublishedSingularSet
from symgen.records import dataclass

IDENTICAL = "identical"
ON_MANIFOLD = "equal on the constraint manifold only"
MISPRINTED = "misprinted"
CHECKED = "identical as checked at 40 digits"
UNDECIDED = "not decided"
_ORDER = (IDENTICAL, CHECKED, ON_MANIFOLD, UNDECIDED, MISPRINTED)
ZERO_AT_40_DIGITS = mpf(10) ** -32


@dataclass(frozen=True, slots=True)
class Verdict:
    """What was found about one entry of `published`, by its position there.

    `corrected_proven` is None unless the print is wrong and a corrected form is given.  `difference` is derived minus
    printed for a matrix that is not identical.
    """

    position: int
    equation: str
    quantity: str
    verdict: str
    corrected_proven: bool | None
    explanation: str
    difference: ImmutableDenseMatrix | None = None


@dataclass(frozen=True, slots=True)
class _FormVerdict:
    """A verdict on one form of a formula with the text that goes with it."""

    verdict: str
    text: str
    difference: ImmutableDenseMatrix | None = None


def decide_published(model: Model, forms: ClosedForms) -> tuple[Verdict, ...]:
    """One verdict per entry of `published`, in the order of the file."""
    judge = _Judge(model, forms.exact)
    return tuple(judge.verdict(position, item) for position, item in enumerate(model.published))


class _Judge:
    """Decides formulas for one model."""

    def __init__(self, model: Model, exact: Exact) -> None:
        self.model = model
        self.exact = exact
        self.translator = exact.mechanics.translator
        self.ring = exact.ring
        self.speller = Speller(exact.ring, dynamic_names(model))
        self.manifold = Manifold(model, exact)

    @cached_property
    def points(self) -> list[RingPoint]:
        """Points on V at 40 digits."""
        return generic_points(self.model, self.exact.mechanics, 3)

    @cached_property
    def free_points(self) -> list[RingPoint]:
        """Points anywhere at 40 digits."""
        return generic_points(self.model, self.exact.mechanics, 3, on_constraints=False)

    def verdict(self, position: int, item: Published) -> Verdict:
        """The verdict on the print, and on the corrected form where the print is wrong."""
        quantity, decide, corrected = self._reading(item)
        try:
            with self.ring.work.limited(f"the decision of {item.equation}"):
                finding = decide(False)
            proven: bool | None = None
            text = finding.text
            if finding.verdict == MISPRINTED and corrected:
                with self.ring.work.limited(f"the decision of {item.equation}"):
                    right = decide(True)
                proven = right.verdict in (IDENTICAL, CHECKED, ON_MANIFOLD)
                text += f"; corrected form: {right.verdict}, {right.text}"
        except TooLargeError as large:
            return Verdict(position, item.equation, quantity, UNDECIDED, None, str(large))
        return Verdict(position, item.equation, quantity, finding.verdict, proven, text, finding.difference)

    def _reading(self, item: Published) -> tuple[str, Callable[[bool], _FormVerdict], bool]:
        """The quantity, how to decide the printed (False) or corrected (True) form, and whether there is one."""
        match item:
            case PublishedMatrix():
                given = item.corrected
                return (
                    item.quantity,
                    lambda use: self._matrix(item, given if use and given is not None else item.value),
                    given is not None,
                )
            case PublishedEquations():
                return (
                    "equations",
                    lambda use: self._equations(item.corrected if use else item.equations, dict(item.where)),
                    bool(item.corrected),
                )
            case PublishedSingularSet():
                right = item.corrected
                return (
                    f"singular set of {item.quantity}",
                    lambda use: self._singular_set(item, right if use and right is not None else item.where_zero),
                    right is not None,
                )

    def _value(self, expression: Expression, where: Mapping[str, Expression]) -> Quotient:
        return self.translator.value(substitute(expression, where))

    # matrices

    def _matrix(self, item: PublishedMatrix, printed: ExpressionMatrix) -> _FormVerdict:
        derived = self.derived(item.quantity, item.independent)
        if derived is None:
            return _FormVerdict(UNDECIDED, f"no closed form of {item.quantity}")
        where = dict(item.where)
        values = tuple(tuple(self._value(entry, where) for entry in row) for row in printed)
        if len(values) != len(derived) or any(len(a) != len(b) for a, b in zip(values, derived, strict=True)):
            return _FormVerdict(MISPRINTED, "the shape is another one")
        difference = tuple(
            tuple(a - b for a, b in zip(u, v, strict=True)) for u, v in zip(derived, values, strict=True)
        )
        flat = [entry for row in difference for entry in row]
        finding = self._zero(flat)
        if finding.verdict == IDENTICAL:
            return replace(finding, text="derived minus printed has the normal form 0 in every entry")
        shown = ImmutableDenseMatrix([[self.speller.quotient(entry) for entry in row] for row in difference])
        index = next(i for i, entry in enumerate(flat) if entry)
        place = divmod(index, len(difference[0]))
        text = f"entry ({place[0] + 1}, {place[1] + 1}): derived minus printed is `{shown[place]}`{finding.text}"
        return _FormVerdict(finding.verdict, text, shown)

    def derived(self, quantity: str, independent: Sequence[str]) -> Matrix | None:
        """The derived matrix of a quantity; None when there is no closed form of that name."""
        exact, mechanics = self.exact, self.exact.mechanics
        if quantity == "orthogonal_complement":
            return exact.complement(independent or self.model.independent_velocities)
        known: Mapping[str, Callable[[], Matrix]] = {
            "mass_matrix": lambda: mechanics.mass,
            "coriolis_matrix": lambda: mechanics.coriolis,
            "coriolis_force": lambda: mechanics.coriolis_force,
            "potential_force": lambda: mechanics.potential_force,
            "applied_force": lambda: mechanics.applied_force,
            "constraint_residual": lambda: mechanics.residual,
            "constraint_jacobian": lambda: mechanics.jacobian,
            "constraint_jacobian_dot": lambda: mechanics.jacobian_dot,
            "constraint_pseudoinverse": lambda: exact.pseudoinverse,
            "control_matrix": lambda: mechanics.control,
            "nullspace_projector": lambda: exact.projector,
            "nullspace_projector_dot": lambda: exact.projector_dot,
            "projected_control_matrix": lambda: exact.projected_control,
            "projected_control_pseudoinverse": lambda: exact.control_pseudoinverse,
            "inverse_dynamics": lambda: exact.inverse_dynamics,
        }
        build = known.get(quantity)
        return build() if build is not None else None

    # zero or not

    def _zero(self, values: Sequence[Quotient]) -> _FormVerdict:
        """Whether all values are zero: in the ring, at 40 digits, on the manifold, or not."""
        rest = [value for value in values if value]
        if not rest:
            return _FormVerdict(IDENTICAL, "")
        if not self.ring.is_complete and all(self._vanishes(value, self.free_points) for value in rest):
            return _FormVerdict(CHECKED, "; it contains what the ring does not hold and vanishes at 40 digits")
        projected = [value for value in (self.manifold.restrict(value) for value in rest) if value]
        if not projected:
            return _FormVerdict(ON_MANIFOLD, "; it vanishes identically for qd = W nu and qdd = W nu-dot + W-dot nu")
        if self.exact.mechanics.residual and all(self._vanishes(value, self.points) for value in projected):
            return _FormVerdict(ON_MANIFOLD, "; it vanishes on V as checked at 40 digits")
        return _FormVerdict(MISPRINTED, f"; {self._sample(projected[0])} on the constraint manifold")

    def _vanishes(self, value: Quotient, points: Sequence[RingPoint]) -> bool:
        for point in points:
            scale = sum((abs(point.polynomial(_single(value, m))) for m in value.numerator), mpf(0))
            if abs(point.polynomial(value.numerator)) > ZERO_AT_40_DIGITS * scale:
                return False
        return bool(points)

    def _sample(self, value: Quotient) -> str:
        """The value at a point, as evidence."""
        if not self.points:
            return "its normal form is not zero"
        point = self.points[0]
        used = [self.ring.variables[i] for i in self.ring.shape(value.numerator) if i < len(self.ring.variables)]
        state = dict.fromkeys([c.name for c in self.model.coordinates] + used)
        shown = ", ".join(f"{_shown(name)} = {nstr(point.values[name], 4)}" for name in state)
        return f"its value is {nstr(point.quotient(value), 6)} at {shown}"

    # equations

    def _equations(
        self, equations: Sequence[tuple[Expression, Expression]], where: Mapping[str, Expression]
    ) -> _FormVerdict:
        findings = [self._equation(self._value(a, where) - self._value(b, where)) for a, b in equations]
        worst = max(findings, key=lambda f: _ORDER.index(f.verdict))
        if worst.verdict == IDENTICAL:
            return worst
        index = findings.index(worst)
        return replace(worst, text=f"equation {index + 1}: {worst.text}")

    def _equation(self, residual: Quotient) -> _FormVerdict:
        """One equation `residual = 0`: a combination of the motion equations (3) or of the constraints, or not."""
        if not residual:
            return _FormVerdict(IDENTICAL, "both sides are the same")
        dynamic = [c.acceleration for c in self.model.coordinates] + [i.name for i in self.model.inputs]
        dynamic += [f"multiplier_{row.name}" for row in self.model.constraints]
        if any(self.translator.derivative(residual, name) for name in dynamic):
            return self._dynamic(residual)
        return self._kinematic(residual)

    def _dynamic(self, residual: Quotient) -> _FormVerdict:
        """Find c with residual = c^T E, E = tau + B^T lambda - M u; the remainder decides.

        c is unique: B c is the coefficient of lambda, W^T G c that of the accelerations along W.
        """
        exact, ring, translator = self.exact, self.ring, self.translator
        names = [c.acceleration for c in self.model.coordinates]
        slopes = tuple((translator.derivative(residual, name),) for name in names)
        kernel = transpose(exact.kernel)
        left = (*exact.mechanics.jacobian, *multiply(ring, kernel, exact.mechanics.mass))
        reactions = tuple(
            (translator.derivative(residual, f"multiplier_{row.name}"),) for row in self.model.constraints
        )
        right = (*reactions, *multiply(ring, kernel, slopes))
        weights = solve(left, right)
        if weights is None:
            return _FormVerdict(UNDECIDED, "the combination of motion equations is not unique")
        combination = dot(ring, [w for (w,) in weights], [e for (e,) in exact.reaction_load])
        remainder = residual - combination
        finding = self._zero([remainder])
        if finding.verdict == IDENTICAL:
            return _FormVerdict(IDENTICAL, "a combination c(q)^T of the motion equations (3), identically")
        shown = self.speller.quotient(remainder)
        return _FormVerdict(finding.verdict, f"the remainder over the motion equations (3) is `{shown}`{finding.text}")

    def _kinematic(self, residual: Quotient) -> _FormVerdict:
        """A combination of the rows of B times qd, or a function of q that vanishes on V."""
        translator = self.translator
        slopes = [translator.derivative(residual, c.rate) for c in self.model.coordinates]
        rates = [translator.name(c.rate) for c in self.model.coordinates]
        rest = residual - dot(self.ring, slopes, rates)
        if not rest and any(slopes):
            along = [dot(self.ring, slopes, vector) for vector in transpose(self.exact.kernel)]
            if not any(along):
                return _FormVerdict(IDENTICAL, "a combination of the rows of B")
        finding = self._zero([residual])
        if finding.verdict == ON_MANIFOLD and not any(slopes):
            return _FormVerdict(CHECKED, "it vanishes on V as checked at 40 digits")
        return replace(finding, text=f"left minus right is `{self.speller.quotient(residual)}`{finding.text}")

    # singular sets

    def _singular_set(self, item: PublishedSingularSet, where_zero: Expression) -> _FormVerdict:
        derived = self.derived(item.quantity, item.independent)
        if derived is None:
            return _FormVerdict(UNDECIDED, f"no closed form of {item.quantity}")
        bottom = common_denominator(self.ring, [entry for row in derived for entry in row])
        own = self._zero_sets(bottom)
        printed = self._zero_sets(self.translator.value(where_zero).numerator)
        if own == printed:
            zeros = self._list(own)
            return _FormVerdict(IDENTICAL, f"the denominator vanishes with {zeros}" if own else "it vanishes nowhere")
        parts = []
        if printed - own:
            parts.append(f"it exists where {self._list(printed - own)} vanishes, if nothing else does")
        if own - printed:
            parts.append(f"it does not exist where {self._list(own - printed)} vanishes")
        return _FormVerdict(MISPRINTED, "; ".join(parts))

    def _zero_sets(self, p: PolyElement) -> set[PolyElement]:
        """The factors that can vanish; on V a factor that is the same everywhere cannot."""
        return {factor for factor in essential_factors(self.ring, p) if not self._constant_on_constraints(factor)}

    def _constant_on_constraints(self, factor: PolyElement) -> bool:
        if not self.exact.mechanics.residual or len(self.points) < 2:
            return False
        first, *others = (point.polynomial(factor) for point in self.points)
        return bool(abs(first) > ZERO_AT_40_DIGITS) and all(abs(x - first) < ZERO_AT_40_DIGITS for x in others)

    def _list(self, factors: set[PolyElement]) -> str:
        return " or ".join(sorted(f"`{self.speller.polynomial(self.ring.normal(f))}`" for f in factors))


def _shown(name: str) -> str:
    """A variable's name for a reader: the coefficients of W are nu_1, nu_2, ..."""
    for prefix, letter in (("_velocity_", "nu"), ("_acceleration_", "nu_dot")):
        if name.startswith(prefix):
            return f"{letter}_{int(name.removeprefix(prefix)) + 1}"
    return name


def _single(value: Quotient, monomial: tuple[int, ...]) -> PolyElement:
    term = value.ring.polys.zero.copy()
    term[monomial] = value.numerator[monomial]
    return term
