"""The own table of units against pint, which is too slow to import in a run."""

from __future__ import annotations

import math
from fractions import Fraction

import pint
import pytest

from symgen.diagnostics import Mistake, ModelError, Span
from symgen.model.expressions.units import BASE, UNITS, Unit, parse_unit
from symgen.model.file.source import ScalarNode
from symgen.model.load import load_text

PINT_NAMES = {
    "kg": "kilogram",
    "m": "meter",
    "s": "second",
    "A": "ampere",
    "K": "kelvin",
    "mol": "mole",
    "cd": "candela",
}
REGISTRY: pint.UnitRegistry = pint.UnitRegistry()


def by_pint(text: str) -> tuple[list[float], float]:
    """Exponents of the base units and the power of ten."""
    quantity = REGISTRY.Quantity(1.0, text).to_base_units()
    powers = dict(quantity.unit_items())
    powers.pop("radian", None)
    exponents = [float(powers.pop(PINT_NAMES[base], 0)) for base in BASE]
    assert not powers, text
    return exponents, math.log10(quantity.magnitude)


def by_symgen(text: str) -> Unit | Mistake:
    """The unit as symgen reads it."""
    return parse_unit(ScalarNode(text, Span(1, 1, 2), text, False))


@pytest.mark.parametrize("name", sorted(UNITS))
def test_each_unit(name: str) -> None:
    exponents, ten = by_pint(name)
    unit = UNITS[name]
    assert [float(exponent) for exponent in unit.exponents] == exponents
    assert float(unit.ten) == pytest.approx(ten, abs=1e-9)


@pytest.mark.parametrize("text", ["kg*m**2", "N*m*s/rad", "m/s**2", "1/s", "kN/mm", "(J/m)**2", "m**(1/2)", "W*s/kg"])
def test_products(text: str) -> None:
    unit = by_symgen(text)
    assert isinstance(unit, Unit)
    exponents, ten = by_pint(text)
    assert [float(exponent) for exponent in unit.exponents] == pytest.approx(exponents)
    assert float(unit.ten) == pytest.approx(ten, abs=1e-9)


def test_shown_in_base_units() -> None:
    assert str(UNITS["N"]) == "kg*m/s**2"
    assert str(UNITS["mm"]) == "10**-3*m"
    assert str(UNITS["rad"]) == "1"
    assert str(UNITS["Hz"]) == "1/s"
    assert str(UNITS["m"].to_power(Fraction(1, 2))) == "m**(1/2)"


@pytest.mark.parametrize("text", ["deg", "rpm", "furlong", "2*m", "m + s", "m^2", "sin(m)"])
def test_refused(text: str) -> None:
    assert isinstance(by_symgen(text), Mistake)


@pytest.mark.parametrize(
    ("written", "remedy"),
    [
        ("Nm", "write `N*m`"),
        ("kgm2", "write `kg*m**2`"),
        ("m2", "write `m**2`"),
        ("Ns", "write `N*s`"),
        ("newton", "use SI units"),
    ],
)
def test_what_was_run_together_is_taken_apart(written: str, remedy: str) -> None:
    text = f"model: m\ncoordinates: {{x: {{unit: {written}}}}}\nkinetic_energy: x_dot**2\n"
    with pytest.raises(ModelError) as raised:
        load_text(text, "m.yaml")
    assert raised.value.mistakes[0].remedy.startswith(remedy)
