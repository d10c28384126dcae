"""(31)-(47) through the `published` blocks of the models: verdicts, sign flips, and what exactly the misprints are."""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from mpmath import mpf
from sympy import Symbol, zeros

from symgen.closedform.algebra.matrices import determinant, multiply, transpose
from symgen.closedform.algebra.quotient import Quotient
from symgen.closedform.forms import ClosedForms, derive_closed_forms
from symgen.closedform.manifold import Manifold
from symgen.closedform.points import RingPoint
from symgen.closedform.published import IDENTICAL, MISPRINTED, ON_MANIFOLD, Verdict, decide_published
from symgen.model.expressions.expression import Binary, Call, Expression, Negation, Number, Power
from symgen.model.load import load_model
from symgen.model.model import Model
from symgen.model.published import Matrix, Published, PublishedEquations, PublishedMatrix, PublishedSingularSet

MODELS = Path(__file__).parents[2] / "models"
PAPER = ("skate", "front_car", "front_car_wheelset", "rear_car")


@cache
def derived(name: str) -> tuple[Model, ClosedForms]:
    model = load_model(MODELS / f"{name}.yaml")
    return model, derive_closed_forms(model)


def decide(name: str, item: Published) -> Verdict:
    model, forms = derived(name)
    (verdict,) = decide_published(replace(model, published=(item,)), forms)
    return verdict


def kind(item: Published) -> str:
    match item:
        case PublishedMatrix():
            return item.quantity
        case PublishedEquations():
            return "equations"
        case PublishedSingularSet():
            return " ".join(("singular", *item.independent))


EXPECTED = {
    "skate": [
        ("(31)", "constraint_jacobian", IDENTICAL),
        ("(32)", "equations", MISPRINTED),
        ("(33)", "control_matrix", IDENTICAL),
        ("(34)", "nullspace_projector", IDENTICAL),
        ("(35)", "equations", ON_MANIFOLD),
        ("(36)", "projected_control_pseudoinverse", IDENTICAL),
        ("(37)", "inverse_dynamics", ON_MANIFOLD),
        ("(38)", "orthogonal_complement", IDENTICAL),
        ("(38)", "singular phi x", MISPRINTED),
        ("(38)", "singular phi y", IDENTICAL),
    ],
    "front_car": [
        ("(39)", "equations", IDENTICAL),
        ("(40)", "constraint_jacobian", IDENTICAL),
        ("(41)", "mass_matrix", IDENTICAL),
        ("(41)", "coriolis_matrix", IDENTICAL),
        ("(42)", "control_matrix", IDENTICAL),
        ("(43)", "nullspace_projector", IDENTICAL),
        ("(44)", "projected_control_pseudoinverse", IDENTICAL),
        ("(45)", "orthogonal_complement", MISPRINTED),
        ("(45)", "singular x phi", MISPRINTED),
        ("(45)", "singular y phi", MISPRINTED),
    ],
    "front_car_wheelset": [
        ("(41)", "mass_matrix", MISPRINTED),
        ("(41)", "coriolis_matrix", IDENTICAL),
    ],
    "rear_car": [
        ("(46)", "control_matrix", IDENTICAL),
        ("(47)", "projected_control_pseudoinverse", IDENTICAL),
        ("(47)", "singular", MISPRINTED),
    ],
}


@pytest.mark.parametrize("name", PAPER)
def test_verdicts_of_the_errata_table(name: str) -> None:
    model, forms = derived(name)
    verdicts = decide_published(model, forms)
    decided = [(i.equation, kind(i), v.verdict) for i, v in zip(model.published, verdicts, strict=True)]
    for expected in EXPECTED[name]:
        assert expected in decided
    for verdict in verdicts:
        assert verdict.corrected_proven is (True if verdict.verdict == MISPRINTED else None), verdict
        assert verdict.explanation


def test_every_equation_from_31_to_47_is_decided() -> None:
    numbers = {item.equation for name in PAPER for item in derived(name)[0].published}
    assert {f"({k})" for k in range(31, 48)} <= numbers


# sign flips


def flips(expression: Expression) -> Iterator[Expression]:
    """Every tree with the sign of one term inside it turned."""
    match expression:
        case Negation(operand):
            yield operand
            yield from (Negation(x) for x in flips(operand))
        case Binary(operator, left, right):
            if operator in "+-":
                yield Binary("-" if operator == "+" else "+", left, right)
            yield from (Binary(operator, x, right) for x in flips(left))
            yield from (Binary(operator, left, x) for x in flips(right))
        case Power(base, exponent):
            if exponent % 2:
                yield from (Power(x, exponent) for x in flips(base))
        case Call(function, arguments):
            yield from (Call(function, (x,)) for x in flips(arguments[0]))
        case _:
            pass


def entry_flips(expression: Expression) -> Iterator[Expression]:
    """Flips inside an entry, and of the entry itself when it is not zero."""
    yield from flips(expression)
    if not (isinstance(expression, Number) and expression.value == 0) and not isinstance(expression, Negation):
        yield Negation(expression)


def matrix_flips(matrix: Matrix) -> Iterator[Matrix]:
    for i, row in enumerate(matrix):
        for j, entry in enumerate(row):
            for flipped in entry_flips(entry):
                yield (*matrix[:i], (*row[:j], flipped, *row[j + 1 :]), *matrix[i + 1 :])


Equations = tuple[tuple[Expression, Expression], ...]


def equation_flips(equations: Equations) -> Iterator[Equations]:
    for i, (left, right) in enumerate(equations):
        sides = [(x, right) for x in flips(left)]
        if not (isinstance(right, Number) and right.value == 0):
            sides += [(left, x) for x in entry_flips(right)]
        for pair in sides:
            yield (*equations[:i], pair, *equations[i + 1 :])


def other_set(expression: Expression) -> Expression:
    """The zeros of cosines where those of sines were, and the other way round: a sign changes no set of zeros."""
    match expression:
        case Call("sin", arguments):
            return Call("cos", arguments)
        case Call("cos", arguments):
            return Call("sin", arguments)
        case Binary(operator, left, right):
            return Binary(operator, other_set(left), other_set(right))
        case _:
            return expression


def variants(item: Published) -> Iterator[Published]:
    """The formula with one sign of the form that is right turned; that form stands in place of the print."""
    match item:
        case PublishedMatrix():
            right = item.corrected or item.value
            yield from (replace(item, value=x, corrected=None) for x in matrix_flips(right))
        case PublishedEquations():
            equations = item.corrected or item.equations
            yield from (replace(item, equations=x, corrected=()) for x in equation_flips(equations))
        case PublishedSingularSet():
            zeros_of = item.corrected or item.where_zero
            yield replace(item, where_zero=other_set(zeros_of), corrected=None)


@pytest.mark.parametrize("name", PAPER)
def test_a_flipped_sign_changes_the_verdict(name: str) -> None:
    for item in derived(name)[0].published:
        verdicts = [decide(name, variant).verdict for variant in variants(item)]
        assert verdicts, item.equation
        assert set(verdicts) == {MISPRINTED}, item.equation


@pytest.mark.parametrize("name", PAPER)
def test_a_wrong_correction_is_not_accepted_and_a_right_print_is(name: str) -> None:
    for item in derived(name)[0].published:
        if item.corrected is None or item.corrected == ():
            continue
        wrong = next(variants(item))
        match item, wrong:
            case PublishedMatrix(), PublishedMatrix():
                broken: Published = replace(item, corrected=wrong.value)
                assert item.corrected is not None
                mended: Published = replace(item, value=item.corrected, corrected=None)
            case PublishedEquations(), PublishedEquations():
                broken = replace(item, corrected=wrong.equations)
                mended = replace(item, equations=item.corrected, corrected=())
            case PublishedSingularSet(), PublishedSingularSet():
                broken = replace(item, corrected=wrong.where_zero)
                assert item.corrected is not None
                mended = replace(item, where_zero=item.corrected, corrected=None)
            case _:
                raise AssertionError(item)
        assert decide(name, broken).corrected_proven is False
        assert decide(name, mended).verdict == IDENTICAL


# what the misprints are


def test_32_the_printed_multiplier_is_twice_the_true_one() -> None:
    """sin(phi) (second) - cos(phi) (third) gives lambda; on the manifold the true one is m v phi_dot."""
    model, forms = derived("skate")
    (item,) = (p for p in model.published if isinstance(p, PublishedEquations) and p.equation == "(32)")
    translator, manifold = forms.exact.mechanics.translator, Manifold(model, forms.exact)
    sine, cosine = forms.exact.mechanics.jacobian[0][1], -forms.exact.mechanics.jacobian[0][2]

    def multiplier(equations: Equations) -> Quotient:
        second, third = (translator.value(a) - translator.value(b) for a, b in equations[1:])
        residual = manifold.restrict(sine * second - cosine * third)
        unknown = translator.name("multiplier_edge")
        assert translator.derivative(residual, "multiplier_edge").equals(translator.constant(1))
        return unknown - residual

    true, printed = multiplier(item.corrected), multiplier(item.equations)
    assert true
    assert printed.equals(translator.constant(2) * true)


def test_35_has_two_independent_equations() -> None:
    """-sin(phi) (second) + cos(phi) (third) of (35) vanishes: rank 2, not 3."""
    model, forms = derived("skate")
    (item,) = (p for p in model.published if isinstance(p, PublishedEquations) and p.equation == "(35)")
    translator = forms.exact.mechanics.translator
    sine, cosine = forms.exact.mechanics.jacobian[0][1], -forms.exact.mechanics.jacobian[0][2]
    _, second, third = (translator.value(a) - translator.value(b) for a, b in item.equations)
    assert not (cosine * third - sine * second)
    assert second


def test_41_the_printed_mass_matrix_lacks_the_yaw_inertia_of_the_wheelset() -> None:
    model, forms = derived("front_car_wheelset")
    position = next(i for i, p in enumerate(model.published) if kind(p) == "mass_matrix")
    difference = decide_published(model, forms)[position].difference
    expected = zeros(4, 4)
    expected[2, 2] = expected[2, 3] = expected[3, 2] = Symbol("Theta_2")
    assert difference == expected.as_immutable()


def test_43_a_is_twice_the_determinant() -> None:
    _, forms = derived("front_car")
    exact = forms.exact
    (item,) = (p for p in derived("front_car")[0].published if p.equation == "(43)" and isinstance(p, PublishedMatrix))
    jacobian = exact.mechanics.jacobian
    gram = multiply(exact.ring, jacobian, transpose(jacobian))
    printed = exact.mechanics.translator.value(dict(item.where)["a"])
    assert printed.equals(exact.mechanics.translator.constant(2) * determinant(exact.ring, gram))


def test_45_as_printed_is_not_in_the_kernel() -> None:
    """B F of the print at theta = 0.3, phi = 0.2, L = 1.7: [[0.591, 0], [1.230, -0.271]]."""
    model, forms = derived("front_car")
    item = next(p for p in model.published if kind(p) == "orthogonal_complement" and isinstance(p, PublishedMatrix))
    translator, exact = forms.exact.mechanics.translator, forms.exact
    printed = tuple(tuple(translator.value(entry) for entry in row) for row in item.value)
    product = multiply(exact.ring, exact.mechanics.jacobian, printed)
    values = {"theta": 0.3, "phi": 0.2, "L": 1.7}
    point = RingPoint(exact.mechanics, {name: mpf(v) for name, v in values.items()})
    numbers = [[float(x) for x in row] for row in point.matrix(product)]
    assert numbers[0] == pytest.approx([0.591, 0], abs=1e-3)
    assert numbers[1] == pytest.approx([1.230, -0.271], abs=1e-3)
