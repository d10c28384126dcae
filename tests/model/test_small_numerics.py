"""The float checks of the loader against NumPy, derivatives in 50 digits and cases with known answers."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest

from symgen.diagnostics import Mistake, Span
from symgen.model.configurations.algebra import BEYOND, Expansion, NotPolynomialError, is_zero
from symgen.model.configurations.dense import is_positive, null_space, rank
from symgen.model.configurations.gradient import Gradients
from symgen.model.expressions.expression import Expression
from symgen.model.expressions.parser import parse_expression
from symgen.model.file.source import ScalarNode

VALUES = {"x": 0.6, "y": 0.3, "m": 1.7}


def tree(text: str) -> Expression:
    """The tree of a good expression."""
    parsed = parse_expression(ScalarNode(text, Span(1, 1, 2), text, False))
    assert not isinstance(parsed, Mistake)
    return parsed


@pytest.mark.parametrize(
    "text",
    [
        "x*y - m*x/y",
        "sin(x)*cos(y) + tan(x*y)",
        "asin(x*y) + acos(x) + atan(y/m)",
        "atan2(y, x*m) - atan2(m, y)",
        "sqrt(x + y) + exp(x*y) + log(x/m)",
        "sinh(x) + cosh(y) + tanh(x*m)",
        "x**3 - y**-2 + (x*y)**(1/2)",
        "-(x - d)**2 + d*m",
    ],
)
def test_gradients(text: str) -> None:
    """Beside derivatives of the same text read by Python and worked out in 50 digits."""
    value, gradient = Gradients(VALUES, {"x": 0, "y": 1}, {"d": tree("x*y + 2*m")}).of(tree(text))

    def at(x: Any, y: Any) -> Any:
        m = mpmath.mpf(VALUES["m"])
        return eval(text, {**vars(mpmath), "x": x, "y": y, "m": m, "d": x * y + 2 * m})

    point = VALUES["x"], VALUES["y"]
    with mpmath.workdps(50):
        assert value == pytest.approx(float(at(*map(mpmath.mpf, point))), rel=1e-14)
        for index, orders in enumerate(((1, 0), (0, 1))):
            exact = float(mpmath.diff(at, point, orders))
            assert gradient.get(index, 0.0) == pytest.approx(exact, rel=1e-13, abs=1e-14)


def test_expansion_in_the_rates() -> None:
    expansion = Expansion(VALUES, frozenset({"x_dot", "y_dot"}), {"v": tree("x_dot + x*y_dot")})
    polynomial = expansion.of(tree("m/2*v**2 - m*x*x_dot*y_dot + 3*y_dot - y_dot*3 + x_dot**4"))
    kept = {monomial: value for monomial, (value, size) in polynomial.items() if not is_zero((value, size))}
    assert kept == {
        ("x_dot", "x_dot"): pytest.approx(0.85),
        ("y_dot", "y_dot"): pytest.approx(0.85 * 0.36),
        BEYOND: pytest.approx(1.0),
    }


@pytest.mark.parametrize("text", ["1/x_dot", "sin(x_dot)", "x_dot**(1/2)", "x_dot**-1", "atan2(x, v)"])
def test_no_polynomials(text: str) -> None:
    with pytest.raises(NotPolynomialError):
        Expansion(VALUES, frozenset({"x_dot"}), {"v": tree("2*x_dot")}).of(tree(text))


@pytest.mark.parametrize("true_rank", [0, 1, 3, 4])
def test_rank_and_null_space(true_rank: int) -> None:
    generator = np.random.default_rng(7 + true_rank)
    matrix = generator.normal(size=(4, true_rank)) @ generator.normal(size=(true_rank, 6))
    rows = [[float(value) * 10 ** (3 * i) for value in row] for i, row in enumerate(matrix)]
    assert rank(rows) == true_rank
    basis = np.array(null_space(rows, 6))
    assert basis.shape == (6 - true_rank, 6)
    assert np.allclose(basis @ basis.T, np.eye(6 - true_rank))
    assert np.allclose(matrix @ basis.T, 0)


@pytest.mark.parametrize(
    ("matrix", "expected"),
    [
        ([[2.0, 1.0], [1.0, 2.0]], (True, True)),
        ([[1.0, 1.0], [1.0, 1.0]], (True, False)),
        ([[1.0, 2.0], [2.0, 1.0]], (False, False)),
        ([[1.0, 0.0], [0.0, 0.0]], (True, False)),
        ([[0.0, 1e-3], [1e-3, 1.0]], (False, False)),
        ([[-1.0]], (False, False)),
        ([[1e-8, 0.0], [0.0, 1e8]], (True, True)),
        ([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 3.0]], (True, False)),
        ([[1.0, 0.9, 0.9], [0.9, 1.0, -0.9], [0.9, -0.9, 1.0]], (False, False)),
        ([], (True, True)),
    ],
)
def test_is_positive(matrix: list[list[float]], expected: tuple[bool, bool]) -> None:
    assert is_positive(matrix) == expected
