"""Verdicts beyond the paper's examples: geometric constraints, what the ring cannot hold, right and wrong sets."""

import pytest

from symgen.closedform.forms import derive_closed_forms
from symgen.closedform.published import CHECKED, IDENTICAL, MISPRINTED, ON_MANIFOLD, Verdict, decide_published
from symgen.model.load import load_text

PENDULUM = """
model: pendulum
coordinates: {x: {}, y: {}, a: {unit: rad}}
parameters: {m: 2, g: 9.81, l: 0.5}
kinetic_energy: m/2*(x_dot**2 + y_dot**2) + a_dot**2*exp(2*x)
potential_energy: m*g*y
constraints:
  geometric: {rod: x**2 + y**2 - l**2}
inputs: {f: {acts_on: {x: -y, y: x}}, t_a: {acts_on: {a: cos(a)}}}
independent_velocities: [x, a]
configuration: {x: 0.3, y: -0.4}
published:
"""


def verdict(entry: str) -> Verdict:
    model = load_text(PENDULUM + f"  - {entry}\n", "pendulum.yaml")
    (decision,) = decide_published(model, derive_closed_forms(model))
    return decision


def equation(left: str, right: str) -> str:
    return f'{{equation: "(1)", equations: [{{left: "{left}", right: "{right}"}}]}}'


PROJECTOR = "[[y**2/{0}, -x*y/{0}, 0], [-x*y/{0}, x**2/{0}, 0], [0, 0, 1]]"


@pytest.mark.parametrize(
    ("entry", "expected"),
    [
        (
            '{equation: "(1)", quantity: nullspace_projector, value: ' + PROJECTOR.format("(x**2 + y**2)") + "}",
            IDENTICAL,
        ),
        ('{equation: "(1)", quantity: nullspace_projector, value: ' + PROJECTOR.format("l**2") + "}", ON_MANIFOLD),
        ('{equation: "(1)", quantity: nullspace_projector, value: ' + PROJECTOR.format("l") + "}", MISPRINTED),
        (
            equation("m*(x*y_ddot - y*x_ddot) + m*g*x + 2*y*exp(2*x)*a_dot**2", "l**2*f"),
            ON_MANIFOLD,
        ),
        (equation("m*(x*y_ddot - y*x_ddot) + m*g*x + 2*y*exp(2*x)*a_dot**2", "(x**2 + y**2)*f"), IDENTICAL),
        (equation("m*(x*y_ddot - y*x_ddot) - m*g*x + 2*y*exp(2*x)*a_dot**2", "(x**2 + y**2)*f"), MISPRINTED),
        (equation("m*(x*y_ddot - y*x_ddot) + m*g*x + 2*y*exp(x)**2*a_dot**2", "(x**2 + y**2)*f"), CHECKED),
        (equation("m*y_ddot + m*g + 2*y*multiplier_rod", "x*f"), IDENTICAL),
        (equation("m*y_ddot + m*g - 2*y*multiplier_rod", "x*f"), MISPRINTED),
        (equation("x*x_dot", "-y*y_dot"), IDENTICAL),
        (equation("x*x_dot", "y*y_dot"), MISPRINTED),
        (equation("x**2", "l**2 - y**2"), CHECKED),
        (equation("x**2", "l**2 + y**2"), MISPRINTED),
        (
            '{equation: "(1)", singular_set: {quantity: orthogonal_complement, independent: [x, a], where_zero: y}}',
            IDENTICAL,
        ),
        (
            '{equation: "(1)", singular_set: {quantity: orthogonal_complement, independent: [x, a], where_zero: x*y}}',
            MISPRINTED,
        ),
        ('{equation: "(1)", singular_set: {quantity: projected_control_pseudoinverse, where_zero: cos(a)}}', IDENTICAL),
        (
            '{equation: "(1)", singular_set: {quantity: projected_control_pseudoinverse, where_zero: sin(2*a)}}',
            MISPRINTED,
        ),
        ('{equation: "(1)", singular_set: {quantity: nullspace_projector, where_zero: 1}}', IDENTICAL),
    ],
)
def test_verdicts(entry: str, expected: str) -> None:
    assert verdict(entry).verdict == expected


def test_evidence_is_given() -> None:
    decision = verdict(equation("x*x_dot", "y*y_dot"))
    assert "its value is" in decision.explanation
    assert "x = " in decision.explanation
