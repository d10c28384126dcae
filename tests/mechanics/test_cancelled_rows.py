"""What cancels inside of the entries of B is left out of the rows that elimination starts from."""

from __future__ import annotations

import pytest
import shipped

from symgen.mechanics.system import System
from symgen.methods.inverse_dynamics.elimination import Elimination
from symgen.model.configurations.mechanics import default_values
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.polynomials.content import usual_number
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, reached


def test_the_length_of_a_rod_has_no_product_of_sine_and_cosine() -> None:
    """s . ds/da of s = p - l e(a) is -p . de/da l: two products with sine and cosine, one with l."""
    mechanics = System(shipped.model("delta"))
    place = default_values(mechanics.model.parameters) | {"a_1": 0.3, "a_2": -0.2, "a_3": 0.9} | {"x": 0.1, "y": -0.05}
    place["z"] = -0.7
    core = Elimination(mechanics).core
    for k, row in enumerate(mechanics.constraint_jacobian):
        number = usual_number(entry for entry in row if not entry.is_zero)
        arm = core[k].coefficients[k]
        assert not any(trigonometric(a) and trigonometric(b) for a, b in products(arm))
        assert cost([arm]).multiplications < cost([row[k]]).multiplications
        given, shorter = Evaluator([row[k], arm])(place)
        assert shorter * float(number) == pytest.approx(given, rel=1e-14)


def products(scalar: Scalar) -> list[tuple[Scalar, Scalar]]:
    return [(node.args[0], node.args[1]) for node in reached([scalar]) if node.op == "mul"]


def trigonometric(scalar: Scalar) -> bool:
    return any(node.op in ("sin", "cos") for node in reached([scalar]))
