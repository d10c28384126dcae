"""The first line of a log: which column holds what, in which unit."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from symgen.diagnostics import Mistake, Span
from symgen.model.checks.feasibility import measures_places
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.expressions.names import did_you_mean
from symgen.model.expressions.units import NUMBER, SECOND, Unit, parse_unit
from symgen.model.file.source import ScalarNode
from symgen.model.model import Model
from symgen.records import dataclass

TIME = "t"
_CELL = re.compile(r"^(?P<name>[^\[\]]*?)\s*(?:\[(?P<unit>[^\[\]]*)\])?$")
# Spellings of units that are no products of the model language, but plain enough.
_SPELLED = {"·": "*", "^": "**", "²": "**2", "Nm": "N*m"}


@dataclass(frozen=True, slots=True)
class HeaderCell:
    """A name with its unit, as they stand in the first line."""

    name: str
    unit: str | None
    span: Span


def cells_of(line: str) -> list[tuple[str, int]]:
    """The cells of a line without blanks around them, each with the column at which it begins."""
    made, column = [], 1
    for cell in line.split(","):
        made.append((cell.strip(), column + len(cell) - len(cell.lstrip())))
        column += len(cell) + 1
    return made


def read_header(model: Model, line: str) -> tuple[dict[str, int], list[Mistake]]:
    """The place of each column by its name, and what is wrong with the line."""
    if (wrong := not_separated(line)) is not None:
        return {}, [wrong]
    places, mistakes = read_columns(_units(model), line, "a coordinate, rate, acceleration or input")
    return places, mistakes + _missing(model, places, Span(1, 1, max(2, len(line) + 1)))


def not_separated(line: str) -> Mistake | None:
    """What is wrong where columns are separated by something else than commas."""
    mark = next((mark for mark in (";", "\t") if mark in line), None)
    if mark is None or "," in line:
        return None
    message = f"columns are separated by {'tabs' if mark == chr(9) else f'`{mark}`'}"
    return Mistake(message, "separate them by commas, and write decimals with a point", Span(1, 1, 2))


def read_columns(
    units: Mapping[str, Unit | None], line: str, known: str
) -> tuple[dict[str, int], list[Mistake]]:
    """The place of each column with a name of `units`, which are `known` as this, and what is wrong with the others."""
    mistakes = list[Mistake]()
    places: dict[str, int] = {}
    for place, cell in enumerate(map(_cell, cells_of(line))):
        wrong = _wrong(cell, units, places, known)
        if wrong is not None:
            mistakes.append(wrong)
        if cell.name in units and cell.name not in places:
            places[cell.name] = place
    return places, mistakes


def measured_in(model: Model, names: Mapping[str, int]) -> tuple[str, ...]:
    """The coordinates in a log, in the order of the model."""
    return tuple(c.name for c in model.coordinates if c.name in names)


def _cell(given: tuple[str, int]) -> HeaderCell:
    text, column = given
    parts = _CELL.match(text)
    name, unit = (parts["name"], parts["unit"]) if parts else (text, None)
    return HeaderCell(name.strip(), unit, Span(1, column, column + max(1, len(text))))


def _units(model: Model) -> dict[str, Unit | None]:
    """What each column is in; None where the model does not say."""
    units: dict[str, Unit | None] = {TIME: SECOND}
    for c in model.coordinates:
        unit = NUMBER if c.is_angle else _read(c.unit)
        for power, name in enumerate((c.name, c.rate, c.acceleration)):
            units[name] = None if unit is None else unit.times(SECOND.to_power(SECOND.exponents[2] * power), -1)
    return units | {one.name: _read(one.unit) for one in model.inputs}


def _read(unit: str | None) -> Unit | None:
    parsed = None if unit is None else parse_unit(ScalarNode(unit, Span(1, 1, 2), unit, False))
    return parsed if isinstance(parsed, Unit) else None


def _wrong(
    cell: HeaderCell, units: Mapping[str, Unit | None], places: Mapping[str, int], known: str
) -> Mistake | None:
    if cell.name in places:
        return Mistake(f"a second column `{cell.name}`", "remove one of the two", cell.span)
    if cell.name not in units:
        shown = f"unknown column `{cell.name}`" if cell.name else "a column without a name"
        remedy = did_you_mean(cell.name, units, f"remove the column, or name {known}")
        return Mistake(shown, remedy, cell.span, cell.name)
    return None if cell.unit is None else _wrong_unit(cell, units[cell.name])


def _wrong_unit(cell: HeaderCell, expected: Unit | None) -> Mistake | None:
    text = str(cell.unit)
    for spelling, meaning in _SPELLED.items():
        text = text.replace(spelling, meaning)
    if not text.strip():
        return Mistake(f"the unit of `{cell.name}` is empty", "write it, or no brackets", cell.span, cell.name)
    unit = parse_unit(ScalarNode(text, cell.span, text, False))
    if isinstance(unit, Mistake):
        message = f"the unit of `{cell.name}`, `{cell.unit}`, is not read"
        return Mistake(message, f"{unit.remedy}, the numbers too", cell.span, cell.name)
    if expected is None or unit == expected:
        return None
    message = f"`{cell.name}` is in {cell.unit}, which is {unit}: it should be in {expected}"
    return Mistake(message, f"convert the numbers, and write {expected} or no unit", cell.span)


def _missing(model: Model, places: Mapping[str, int], span: Span) -> list[Mistake]:
    """What a log must have: time, inputs, and coordinates that determine the motion."""
    needed = [TIME, *(one.name for one in model.inputs)]
    mistakes = [
        Mistake(f"there is no column `{name}`", f"add the column `{name}`", span, name)
        for name in needed
        if name not in places
    ]
    measured = measured_in(model, places)
    usual = _usually_measured(model)
    if not _determine(model, measured):
        lacking = [name for name in usual if name not in measured]
        for name in lacking:
            message = f"there is no column `{name}`, and the other coordinates do not determine the motion"
            mistakes.append(Mistake(message, f"add the column `{name}`", span, name))
    return mistakes


def _usually_measured(model: Model) -> Sequence[str]:
    """What the file calls measured, else what inputs drive alone, else all coordinates."""
    driven = [pairs[0][0] for pairs in (one.acts_on for one in model.inputs) if len(pairs) == 1]
    for names in (model.measured, tuple(dict.fromkeys(driven))):
        if names and _determine(model, names):
            return names
    return [c.name for c in model.coordinates]


def _determine(model: Model, measured: Sequence[str]) -> bool:
    if len(measured) == model.n or model.assembly is None:
        return len(measured) == model.n
    parts = model.coordinates, model.parameters, model.definitions, model.constraints, model.kinetic_energy
    return measures_places(NumericSystem(*parts, model.mechanism), model.assembly, tuple(measured))
