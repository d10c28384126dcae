"""Laws of matrices as reports print them, evaluated from their factors against singular value decompositions."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import mpmath
import pytest
import sympy
from mpmath import mp
from sympy import Symbol

from symgen.closedform.algebra.limits import TooLargeError
from symgen.closedform.forms import ClosedForms, derive_closed_forms
from symgen.closedform.laws.choice import Laws, derive_laws
from symgen.closedform.laws.terms import (
    DefinedFactor,
    DerivedFactor,
    IndependentRows,
    LawDifference,
    LawFactor,
    LawInverse,
    LawMatrix,
    LawOpposite,
    LawProduct,
    LawQuotient,
    LawTerm,
    LawTransposed,
    LawUnit,
    ListedFactor,
    MatrixLaw,
    PartFactor,
)
from symgen.closedform.points import RingPoint, generic_points
from symgen.model.expressions.expression import Name
from symgen.model.load import load_model, load_text

MODELS = Path(__file__).parents[2] / "models"
LONG = ("delta", "rapkm_bodies", "five_bar", "gough_stewart", "three_rrr", "rolling_disc", "chain8", "slider_crank")
# Those of them that are derived in no time, and the others in the campaign of tests.
SHORT_TO_DERIVE = ("rapkm_bodies", "five_bar", "rolling_disc", "slider_crank")
LONG_TESTED = [pytest.param(name, marks=() if name in SHORT_TO_DERIVE else pytest.mark.campaign) for name in LONG]


@cache
def shipped(name: str) -> tuple[ClosedForms, Laws]:
    forms = derive_closed_forms(load_model(MODELS / f"{name}.yaml"))
    return forms, derive_laws(forms)


def numbers(matrix: sympy.Matrix, values: Mapping[Symbol, sympy.Expr]) -> mpmath.matrix:
    return mpmath.matrix([[mp.mpf(str(e.evalf(40, subs=values))) for e in row] for row in matrix.tolist()])


class Values:
    """The matrices of a law at one point: B, M and tau are the model's, all others are made of what is printed."""

    def __init__(self, forms: ClosedForms, point: RingPoint, law: MatrixLaw) -> None:
        exact = forms.exact
        jacobian = mpmath.matrix(point.matrix(exact.mechanics.jacobian))
        self.known = {"B": jacobian, **load_of(forms, point)}
        if exact.model.inputs:
            self.known["M"] = mpmath.matrix(point.matrix(exact.mechanics.control))
        self.unit = exact.model.n if not law.part else exact.model.m
        self.forms, self.point, self.law = forms, point, law
        names = [d.name for d in exact.model.definitions] if law.kind == "chain" else []
        places = {name: point.quotient(exact.mechanics.translator.value(Name(name))) for name in names}
        self.values = {Symbol(name): sympy.Float(value, 50) for name, value in places.items()}
        self.values |= {Symbol(name): sympy.Float(value, 50) for name, value in point.values.items()}
        for i in range(jacobian.rows):
            for j in range(jacobian.cols):
                self.values[Symbol(f"B[{i + 1},{j + 1}]")] = sympy.Float(jacobian[i, j], 50)
        for symbol, meaning in law.intermediates:
            self.values[symbol] = meaning.evalf(40, subs=self.values)
        for factor in law.factors:
            self.known[factor.name] = self.factor(factor)

    def factor(self, factor: LawFactor) -> mpmath.matrix:
        match factor:
            case ListedFactor(matrix=matrix, term=term):
                value = numbers(matrix, self.values)
                assert term is None or mpmath.norm(self.term(term) - value) < 1e-30 * mpmath.norm(value)
                return value
            case DefinedFactor(term=term):
                return self.term(term)
            case DerivedFactor(column=column):
                return self.derivatives(column)
            case IndependentRows(places=places):
                return mpmath.matrix([self.known["B"].tolist()[i] for i in places])
            case PartFactor(whole=whole, places=places):
                rows = self.known[whole].tolist()
                return mpmath.matrix(
                    [[row[j] for j in places] for row in rows] if whole == "B" else [rows[i] for i in places]
                )

    def derivatives(self, column: str) -> mpmath.matrix:
        """Of the names in a listed column by the coordinates."""
        (listed,) = (f.matrix for f in self.law.factors if isinstance(f, ListedFactor) and f.name == column)
        translator, coordinates = self.forms.exact.mechanics.translator, self.forms.exact.model.coordinates
        rows = [translator.value(Name(symbol.name)) for symbol in listed]
        slopes = tuple(tuple(translator.derivative(row, c.name) for c in coordinates) for row in rows)
        return mpmath.matrix(self.point.matrix(slopes))

    def term(self, term: LawTerm) -> mpmath.matrix:
        match term:
            case LawMatrix(name=name):
                return self.known[name]
            case LawUnit():
                return mpmath.eye(self.unit)
            case LawTransposed(inside=inside):
                return self.term(inside).T
            case LawInverse(inside=inside):
                return self.term(inside) ** -1
            case LawProduct(factors=factors):
                value = self.term(factors[0])
                for factor in factors[1:]:
                    value = value * self.term(factor)
                return value
            case LawDifference(first=first, second=second):
                return self.term(first) - self.term(second)
            case LawOpposite(inside=inside):
                return -self.term(inside)
            case LawQuotient(inside=inside, divisor=divisor):
                return self.term(inside) / mp.mpf(str(self.values[divisor]))


def load_of(forms: ClosedForms, point: RingPoint) -> dict[str, mpmath.matrix]:
    """tau at a point, where it is not too long to be made."""
    try:
        return {"tau": mpmath.matrix(point.matrix(forms.exact.load))}
    except TooLargeError:
        return {}


def pseudoinverse(matrix: mpmath.matrix, rank: int) -> mpmath.matrix:
    wide = matrix.rows < matrix.cols
    u, s, v = mpmath.svd_r(matrix.T if wide else matrix)
    inverse = mpmath.matrix(v.cols, u.rows)
    for k in range(rank):
        inverse += v[k, :].T * u[:, k].T / s[k]
    return inverse.T if wide else inverse


def expected(forms: ClosedForms, point: RingPoint) -> dict[str, mpmath.matrix]:
    """What the quantities are, by singular value decompositions and a solution of the equations of motion."""
    exact, structure = forms.exact, forms.structure
    jacobian = mpmath.matrix(point.matrix(exact.mechanics.jacobian))
    inverse = pseudoinverse(jacobian, structure.constraint_rank)
    projector = mpmath.eye(exact.model.n) - inverse * jacobian
    known = {"constraint_jacobian": jacobian, "constraint_pseudoinverse": inverse, "nullspace_projector": projector}
    if exact.model.inputs:
        control = mpmath.matrix(point.matrix(exact.mechanics.control))
        left = pseudoinverse(projector * control, structure.degree_of_actuation)
        known["projected_control_pseudoinverse"] = left
        for load in load_of(forms, point).values():
            u = left * load
            # B^T lambda = M u - tau
            known |= {"inverse_dynamics": u, "multipliers": inverse.T * (control * u - load)}
    return known


def error(forms: ClosedForms, point: RingPoint, law: MatrixLaw) -> mpmath.mpf:
    """How far a law is from its quantity, relative to that."""
    right = expected(forms, point)[law.quantity]
    values = Values(forms, point, law)
    if law.part:
        (places,) = (f.places for f in law.factors if f.name == f"B_{law.part}" and isinstance(f, PartFactor))
        right = mpmath.matrix([[right[i, j] for j in places] for i in range(right.rows)])
    return mpmath.norm(values.term(law.term) - right) / mpmath.norm(right)


@pytest.mark.parametrize("name", LONG_TESTED)
def test_laws_give_the_models_own_matrices(name: str) -> None:
    mp.dps = 50
    forms, laws = shipped(name)
    assert "nullspace_projector" in laws
    for point in generic_points(forms.exact.model, forms.exact.mechanics, 2):
        for law in (law for several in laws.values() for law in several):
            assert error(forms, point, law) < 1e-25, (law.quantity, law.kind)


def wrong(factor: ListedFactor, row: int) -> ListedFactor:
    """The factor with the sign of one entry turned, the last of a row."""
    matrix = factor.matrix.as_mutable()
    *_, j = (j for j in range(matrix.cols) if matrix[row, j] != 0)
    matrix[row, j] = -matrix[row, j]
    return replace(factor, matrix=matrix.as_immutable())


def is_noticed(forms: ClosedForms, point: RingPoint, law: MatrixLaw) -> bool:
    try:
        return error(forms, point, law) > 1e-6
    except AssertionError:  # a factor is not what it is in others
        return True


@pytest.mark.parametrize("name", ["delta", "rapkm_bodies", "five_bar", "gough_stewart"])
def test_a_wrong_factor_is_noticed(name: str) -> None:
    mp.dps = 50
    forms, laws = shipped(name)
    (point,) = generic_points(forms.exact.model, forms.exact.mechanics, 1)
    for law in (law for several in laws.values() for law in several):
        for k, factor in enumerate(law.factors):
            # what a column of names has wrong is no value
            if isinstance(factor, ListedFactor) and factor.name != "s":
                # of tau and Phi a law may use some rows alone
                changed = (
                    replace(law, factors=(*law.factors[:k], wrong(factor, row), *law.factors[k + 1 :]))
                    for row in (0, factor.matrix.rows - 1)
                )
                assert any(is_noticed(forms, point, other) for other in changed), (law.quantity, factor.name)


def test_written_out_forms_have_no_laws() -> None:
    assert shipped("front_car")[1] == {}


GEARED = """
model: geared
coordinates:
  a: {unit: rad, range: [-1, 1]}
  b: {unit: rad, range: [-1, 1]}
  x: {unit: m, range: [0.5, 1.5]}
  y: {unit: m, range: [0.5, 1.5]}
  z: {unit: m, range: [0.5, 1.5]}
parameters:
  l: {value: 0.7, unit: m}
  i: {value: 3, unit: "1"}
  m: {value: 2, unit: kg}
  J: {value: 0.1, unit: kg*m**2}
kinetic_energy: J/2*(a_dot**2 + b_dot**2) + m/2*(x_dot**2 + y_dot**2 + z_dot**2)
potential_energy: m*9.81*z
constraints:
  geometric:
    first: (x - l*cos(a))**2 + (y - l*sin(a))**2 + z**2 - 1
    second: (x + l*cos(b))**2 + (z - l*sin(b))**2 + y**2 - 1
inputs:
  u_1: {unit: N*m, acts_on: {a: i}}
  u_2: {unit: N*m, acts_on: {b: 2}}
  u_3: {unit: N, acts_on: {x: 1}}
configuration: {a: 0.1, b: 0.2, x: 0.6, y: 0.6, z: 0.6}
"""


def test_gears_of_drives_are_in_the_laws() -> None:
    mp.dps = 50
    forms = derive_closed_forms(load_text(GEARED, "geared.yaml"))
    laws = derive_laws(forms)
    assert any(factor.name == "M_a" for law in laws["inverse_dynamics"] for factor in law.factors)
    for point in generic_points(forms.exact.model, forms.exact.mechanics, 2):
        for law in (law for several in laws.values() for law in several):
            assert error(forms, point, law) < 1e-25, (law.quantity, law.kind)


ROCKERS = """
model: rockers
gravity: [0, -9.81, 0]
parameters: {l: {value: 0.4, unit: m}, d: {value: 0.6, unit: m}}
joints:
  left: {type: revolute, axis: z, coordinate: a}
  right: {type: revolute, axis: z, at: [d, 0, 0], coordinate: b}
  middle: {type: revolute, axis: z, at: [d/2, 0, 0], coordinate: c}
  table: {type: revolute, parent: left, at: [l, 0, 0], axis: z, coordinate: e}
bodies:
  left: {mass: 1, com: [l/2, 0, 0], inertia: {zz: 0.02}}
  table: {mass: 2, com: [d/2, 0, 0], inertia: {zz: 0.1}}
points:
  end: {frame: table, at: [d, 0, 0]}
  right_end: {frame: right, at: [l, 0, 0]}
  half: {frame: table, at: [d/2, 0, 0]}
  middle_end: {frame: middle, at: [l, 0, 0]}
loops:
  first: {type: point, between: [end, right_end]}
  second: {type: point, between: [half, middle_end]}
inputs:
  u: {unit: N*m, acts_on: {a: 2}}
configuration: {a: 1, b: 1, c: 1, e: -1}
outputs: [inverse_dynamics]
"""


def test_rows_that_depend_on_each_other_have_laws() -> None:
    """A table on three rockers: of the four rows of its pins three are independent, and lambda is the smallest."""
    mp.dps = 50
    forms = derive_closed_forms(load_text(ROCKERS, "rockers.yaml"))
    assert (forms.structure.constraint_rank, forms.exact.model.r) == (3, 4)
    laws = derive_laws(forms)
    assert {"nullspace_projector", "projected_control_pseudoinverse", "inverse_dynamics", "multipliers"} <= set(laws)
    for point in generic_points(forms.exact.model, forms.exact.mechanics, 2):
        for law in (law for several in laws.values() for law in several):
            assert error(forms, point, law) < 1e-25, (law.quantity, law.kind)
