"""Printers and line breaking: SymPy and model expressions as MathML, LaTeX, Typst and terminal text."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from fractions import Fraction

import pytest
import sympy
import typst

from symgen.diagnostics import SymgenBug
from symgen.model.expressions.expression import FUNCTION_ARITY, Binary, Call, Name, Number
from symgen.report.document import Formula
from symgen.report.mathematics.breaking import break_lines
from symgen.report.mathematics.from_expression import expression_layout
from symgen.report.mathematics.from_sympy import COORDINATE, PARAMETER, SympyLayout
from symgen.report.mathematics.latex import latex_math
from symgen.report.mathematics.layout import Layout, Letter, minus, rounded, total
from symgen.report.mathematics.mathml import mathml
from symgen.report.mathematics.matrices import Denominators, matrix_blocks
from symgen.report.mathematics.measure import page_width
from symgen.report.mathematics.names import name_layout
from symgen.report.mathematics.numerals import rational_layout, rational_text
from symgen.report.mathematics.text import columns, text_lines, text_math
from symgen.report.mathematics.typst import typst_math
from symgen.report.terminal import render_text_math

ORDER = {"L": (PARAMETER, 0), "m_2": (PARAMETER, 1), "theta": (COORDINATE, 0), "phi": (COORDINATE, 1)}
L, M2, THETA, PHI, X = sympy.symbols("L m_2 theta phi x")


def layout(expression: sympy.Expr) -> Layout:
    return SympyLayout(ORDER).expression(expression)


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        (L**2 + (L**2 - 1) * sympy.cos(2 * PHI) + 1, "L² + (L² − 1) cos 2φ + 1"),
        (2 * L**2 * sympy.cos(THETA) ** 2 * sympy.cos(PHI) ** 2, "2L² cos² θ cos² φ"),
        (-L * M2 * sympy.Symbol("theta_dot") * sympy.sin(THETA), "−L m₂ θ̇ sin θ"),
        (sympy.sin(PHI + THETA), "sin(θ + φ)"),
        (sympy.sin(PHI) / L, "sin φ/L"),
        (-X + 1, "1 − x"),
        (X / 2, "1/2 x"),
        (1 / (X * L), "1/(L x)"),
        (sympy.sqrt(X + 1) * L, "L √(x + 1)"),
        (sympy.Rational(866, 1000) * X, "0.866 x"),
        (sympy.exp(-X), "e^(−x)"),
        ((X + 1) ** sympy.Rational(-3, 2), "1/(x + 1)^(3/2)"),
    ],
)
def test_textbook_order_and_notation(expression: sympy.Expr, text: str) -> None:
    assert text_math(layout(expression)).replace("0.866x", "0.866 x") == text


def test_names_become_letters_with_indices_and_dots() -> None:
    assert latex_math(name_layout("theta_1_ddot")) == r"{\ddot{\theta }}_{1}"
    assert latex_math(name_layout("q1_dot")) == r"{\dot{q}}_{1}"
    assert latex_math(name_layout("m_payload")) == r"m_{\mathrm{payload}}"
    assert latex_math(name_layout("multiplier_rear_axle")) == r"\lambda _{\mathrm{rear~axle}}"
    assert text_math(name_layout("a_1_2")) == "a₁,₂"


def test_numbers_stay_exact() -> None:
    assert rational_text(Fraction("1e-12")) == "1e-12"
    assert rational_text(Fraction(2, 3)) == "2/3"
    assert latex_math(rational_layout(Fraction("3e-12"))) == r"3 \cdot 10^{-12}"
    assert latex_math(rational_layout(Fraction(1, 3))) == r"\frac{1}{3}"
    assert latex_math(rational_layout(Fraction("0.05"), prefer_decimal=True)) == "0.05"


@pytest.mark.parametrize(
    ("number", "text"),
    [
        ("4.26861086943407", "4.26861"),
        ("123456789012", "1.23457·10¹¹"),
        ("1.23456789012e-13", "1.23457·10⁻¹³"),
        ("2.1e11", "2.1·10¹¹"),
        ("1e400", "10⁴⁰⁰"),
        ("0.123456789", "0.123456789"),
        ("22/7", "22/7"),
        ("7294375000000091491935483871/312500000000000000000000000000", "0.023342"),
    ],
)
def test_long_numbers_are_rounded_and_marked(number: str, text: str) -> None:
    node = rational_layout(Fraction(number))
    assert text_math(node) == text
    assert rounded(node) == (abs(Fraction(number) - _meant(text)) > 0)
    assert rounded(total((Letter("x"), minus(node)))) == rounded(node)


def _meant(text: str) -> Fraction:
    """The number that is shown."""
    mantissa, ten, exponent = text.partition("·10")
    if text.startswith("10"):
        mantissa, ten, exponent = "1", "10", text[2:]
    raised = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
    return Fraction(mantissa) * (Fraction(10) ** int(exponent.translate(raised)) if ten else 1)


def test_decimals_go_into_sums_and_signs_out_of_them() -> None:
    y, z = sympy.symbols("y z")
    assert text_math(layout(z * (-7744 * X - 3872 * y) / 10**6)) == "−z (0.007744x + 0.003872y)"
    assert text_math(layout(z * (11 * X + 11 * y) * sympy.cos(X) / 50)) == "0.22z (x + y) cos x"
    assert text_math(layout(-z * (-5 * X - 20 * y) / 4)) == "1/4 z (5x + 20y)"
    assert text_math(layout(X / (-y - 1) ** 3)) == "−x/(y + 1)³"
    assert text_math(layout(sympy.Rational(426861086943407, 10**14) * X / (y + 1))) == "4.26861x/(y + 1)"


def test_names_in_denominators_are_cancelled_where_that_is_shorter() -> None:
    y = sympy.Symbol("y")
    assert text_math(layout((L * X + L**2 * y + PHI) / L)) == "L y + φ/L + x"
    assert text_math(layout((X + y + L) / M2)) == "(L + x + y)/m₂"


def test_words_stand_apart_from_numbers_with_their_dots_too() -> None:
    assert latex_math(layout(sympy.Symbol("left_motor") / 50)) == r"0.02\,\mathrm{left}_{\mathrm{motor}}"
    assert latex_math(layout(sympy.Symbol("left_motor_dot") / 50)) == r"0.02\,{\dot{\mathrm{left}}}_{\mathrm{motor}}"


def test_equal_letters_that_follow_each_other_are_a_power() -> None:
    l_1, sine = Name("l_1"), Call("sin", (Name("b_2"),))
    three = Binary("*", Binary("*", l_1, l_1), Binary("*", l_1, sine))
    assert text_math(expression_layout(three)) == "l₁³ sin b₂"
    assert text_math(expression_layout(Binary("*", Number(Fraction(2)), Number(Fraction(2))))) == "2·2"


def test_a_number_stays_with_what_it_multiplies() -> None:
    """In a formula that is broken: 11 · sin reads as if the line ended there."""
    angle = sympy.Symbol("left_motor") - sympy.Symbol("right_motor") + sympy.Symbol("left_elbow")
    lines = break_lines(layout(11 * sympy.sin(angle) - 8 * sympy.sin(X + angle)), page_width, 30.0)
    assert len(lines) == 2
    assert not [line for line in lines if "·" in text_math(line)]


def test_fractions_too_wide_for_a_line_have_their_denominator_named() -> None:
    """A sine of long names that divides most entries; short fractions stay as they are."""

    def printed(names: str) -> list[str]:
        a, b, c, d = sympy.symbols(names)
        sine, other = sympy.sin(a - b + c - d), sympy.sin(b - a + d)
        matrix = sympy.Matrix([[1, (8 * other - 11 * sine) / (11 * sine)], [-8 * sympy.sin(c) / (11 * sine), 0]])
        fresh = Denominators(frozenset(), frozenset())
        blocks = matrix_blocks(Letter("M", "bold"), matrix, SympyLayout({}), fresh, "M")
        formulas = [block for block in blocks if isinstance(block, Formula)]
        return ["".join(map(text_math, lines)) for one in formulas for lines in one.equations]

    whole, named = printed("left_motor right_motor left_elbow right_elbow")
    assert named == "a = sin(left_elbow + left_motor − right_elbow − right_motor)"
    assert whole == "M = 1/a [a, 8/11 sin(right_elbow − left_motor + right_motor) − a; −8/11 sin left_elbow, 0]"
    assert not [line for line in printed("p q r s") if line.startswith("a =")]


def test_a_factor_one_is_not_written() -> None:
    assert text_math(expression_layout(Binary("*", Number(Fraction(-1)), Name("z")))) == "−z"


def test_every_function_of_the_language_has_a_printer_everywhere() -> None:
    source = []
    for function, arity in FUNCTION_ARITY.items():
        written = expression_layout(Call(function, (Name("x"), Name("y"))[:arity]))
        derived = layout(getattr(sympy, function)(*sympy.symbols("x y")[:arity]))
        for node in (written, derived):
            ElementTree.fromstring(f"<math>{mathml(node)}</math>")
            assert "x" in text_math(node)
            assert latex_math(node).count("{") == latex_math(node).count("}")
            source.append(f"$ {typst_math(node)} $")
    assert typst.compile("\n".join(source).encode(), format="pdf").startswith(b"%PDF")


def test_unknown_sympy_nodes_are_a_fault_of_symgen() -> None:
    with pytest.raises(SymgenBug, match="Derivative"):
        layout(sympy.Derivative(sympy.Function("f")(X), X))


def test_written_products_keep_their_meaning() -> None:
    three = Number(Fraction(3))
    node = Binary("*", Binary("*", Name("x"), Binary("-", Name("y"), three)), three)
    assert text_math(expression_layout(node)) == "x (y − 3)·3"
    nested = Binary("-", Name("x"), Binary("-", Name("y"), three))
    assert text_math(expression_layout(nested)) == "x − (y − 3)"


def long_expression() -> sympy.Expr:
    """Squares of products of sines, as the minors of a planar manipulator give them, below a long denominator."""
    a, psi = sympy.symbols("a_1:4"), sympy.symbols("psi_1:4")
    terms = [
        M2 * L**2 * sympy.sin(a[i] - psi[i]) ** 2 * sympy.sin(psi[j] - psi[k]) ** 2 * (1 + sympy.cos(a[j]) * L**k)
        for i in range(3)
        for j in range(3)
        for k in range(3)
    ]
    return sympy.Add(*terms) / (1 + sympy.Add(*terms[::2]) * sympy.sqrt(sympy.Add(*terms[:5])))


@pytest.mark.parametrize("room", [25.0, 40.0])
def test_no_line_of_a_long_formula_is_wider_than_its_room(room: float) -> None:
    lines = break_lines(layout(long_expression()), page_width, room)
    assert len(lines) > 10
    assert all(page_width(line) <= room for line in lines)


def test_breaking_loses_nothing() -> None:
    node = layout(sympy.expand((X + L + M2) ** 6))
    joined = "".join(text_math(line) for line in break_lines(node, page_width, 30.0))
    assert "".join(joined.split()) == "".join(text_math(node).split())


def test_short_formulas_stay_whole() -> None:
    assert len(break_lines(layout(X + 1), page_width, 40.0)) == 1


@pytest.mark.parametrize("width", [60, 100])
def test_terminal_lines_keep_to_the_width(width: int) -> None:
    for line in text_lines(layout(long_expression()), width):
        assert columns(line) <= width


def test_terminal_matrices_are_grids_or_entries() -> None:
    matrix = sympy.Matrix([[1, X], [0, L * sympy.sin(THETA)]])
    grid = render_text_math(matrix, symbol="mass_matrix").splitlines()
    assert grid[0].startswith("G = [ 1")
    assert len({len(line) for line in grid}) == 1
    narrow = render_text_math(matrix * long_expression(), symbol="mass_matrix", width=70)
    assert "[1,1] = " in narrow
    assert "[2,1]" not in narrow
