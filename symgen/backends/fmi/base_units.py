"""Units of variables, told in base units where these say all: an angle is none of the dimensions of symgen."""

from __future__ import annotations

import re
from collections.abc import Iterable

from symgen.diagnostics import Mistake, Span
from symgen.model.expressions.units import BASE, parse_unit
from symgen.model.file.source import ScalarNode
from symgen.records import dataclass

_ANGLES = re.compile(r"\b(?:rad|sr)\b")


@dataclass(frozen=True, slots=True)
class UnitDefinition:
    """A unit by its name, and attributes of its base units: exponents and the factor, where they are whole."""

    name: str
    base: tuple[tuple[str, str], ...]


def unit_definitions(units: Iterable[str | None]) -> tuple[UnitDefinition, ...]:
    """Each unit once, in the order in which variables have it."""
    return tuple(UnitDefinition(unit, _base(unit)) for unit in dict.fromkeys(units) if unit is not None)


def _base(unit: str) -> tuple[tuple[str, str], ...]:
    parsed = parse_unit(ScalarNode(unit, Span(1, 1, 2), unit, False))
    if isinstance(parsed, Mistake) or _ANGLES.search(unit):
        return ()
    if any(power.denominator != 1 for power in (*parsed.exponents, parsed.ten)):
        return ()
    exponents = tuple((name, str(power)) for name, power in zip(BASE, parsed.exponents, strict=True) if power)
    return (*exponents, ("factor", f"1e{parsed.ten}")) if parsed.ten else exponents
