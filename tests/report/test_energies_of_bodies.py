"""The energies of machines given by bodies are sums that a reader can evaluate; points of energies stand in a table."""

from __future__ import annotations

from unicodedata import normalize

from report_inputs import input_of

from symgen.model.load import load_text
from symgen.report.compose import compose
from symgen.report.document import Formula
from symgen.report.latex import render_latex
from symgen.report.mathematics.text import text_math
from symgen.report.sections.energies import energies

CART = """model: cart
coordinates: {{x: {{unit: m}}}}
{gravity}
frames: {{cart: {{translation: [x, 0, 0]}}}}
bodies: {{cart: {{mass: 2}}}}
{more}
"""
POINTS = """model: sled
coordinates: {x: {unit: m}, y: {unit: m}}
kinetic_energy: x_dot**2 + y_dot**2
points: {nose: {at: [x + 1, y, 0]}}
"""


def printed(gravity: str, more: str = "") -> list[str]:
    """The two equations."""
    _, shown = energies(load_text(CART.format(gravity=gravity, more=more), "cart.yaml"))
    assert isinstance(shown, Formula)
    return [normalize("NFC", "".join(map(text_math, lines))) for lines in shown.equations]


def test_energies_are_sums_over_bodies_and_rotors() -> None:
    kinetic = normalize("NFC", "T = 1/2 Σ_b (m_b ṗ_bᵀ ṗ_b + ω_bᵀ J_b ω_b)")
    assert printed("gravity: [0, 0, -9.81]") == [kinetic, "U = −Σ_b m_b gᵀ p_b"]
    assert printed("gravity: [0, 0, 0]") == [kinetic, "U = 0"]
    more = "rotor_inertias: {x: 3}\npotential_energy: 5*x**2"
    with_rotor, spring = printed("gravity: [0, 0, 0]", more)
    assert with_rotor == normalize("NFC", f"{kinetic} + 1/2 Σ_i J_i q̇_i²")
    assert spring == "U = 5x²"


def test_points_that_energies_speak_of_have_a_figure_and_a_table() -> None:
    source = " ".join(render_latex(compose(input_of(load_text(POINTS, "sled.yaml")))).split())
    assert "Points of the mechanism where its start leads." in source
    assert r"\texttt{nose}" in source
