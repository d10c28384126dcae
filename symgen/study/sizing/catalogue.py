"""A catalogue of motors with gears: a CSV file with a motor a line."""

from __future__ import annotations

import math
from pathlib import Path

from symgen.diagnostics import Mistake, ModelError, Span
from symgen.identification.logs.header import cells_of, not_separated, read_columns
from symgen.model.expressions.units import NUMBER, Unit, parse_unit
from symgen.model.file.source import ScalarNode
from symgen.records import dataclass

# Motors of a catalogue: each is tried with each drive at every state.
MOST_MOTORS = 50
MOTOR, RATIO = "motor", "ratio"
# The numbers of a motor that a catalogue must have, with their units.
_NUMBERS = {"peak_torque": "N*m", "rated_torque": "N*m", "speed": "rad/s", "inertia": "kg*m**2"}
# Of these 0 is allowed.
_MAY_VANISH = ("inertia",)


@dataclass(frozen=True, slots=True)
class Motor:
    """A motor with its gear: torques (N m) and largest `speed` (rad/s) of its shaft, `inertia` (kg m²) of what turns
    with it, and how many times faster than its drive the shaft turns: `ratio`, in rad/m where the drive slides."""

    name: str
    peak_torque: float
    rated_torque: float
    speed: float
    inertia: float
    ratio: float


def read_catalogue(path: Path) -> tuple[Motor, ...]:
    """The motors of a file.  Raises ModelError with all of its mistakes, OSError where it cannot be read."""
    text = path.read_bytes().decode("utf-8-sig", errors="replace")
    lines = text.splitlines() or [""]
    if (wrong := not_separated(lines[0])) is not None:
        raise ModelError(str(path), text, (wrong,))
    known = (MOTOR, *_NUMBERS, RATIO)
    places, mistakes = read_columns(_units(), lines[0], ", ".join(known))
    line_span = Span(1, 1, max(2, len(lines[0]) + 1))
    for name in (MOTOR, *_NUMBERS):
        if name not in places:
            mistakes.append(Mistake(f"there is no column `{name}`", f"add the column `{name}`", line_span, name))
    if mistakes:
        raise ModelError(str(path), text, tuple(mistakes))
    motors: list[Motor] = []
    for number, line in enumerate(lines[1:], 2):
        if line.strip():
            motors += _motor(number, cells_of(line), places, {one.name for one in motors}, mistakes)
    if not motors and not mistakes:
        mistakes.append(Mistake("there is no motor in the catalogue", "write a motor a line", line_span))
    if len(motors) > MOST_MOTORS:
        remedy = f"keep the {MOST_MOTORS} that come closest: each is tried with each drive at every state"
        mistakes.append(Mistake(f"{len(motors)} motors are too many", remedy, line_span))
    if mistakes:
        raise ModelError(str(path), text, tuple(mistakes))
    return tuple(motors)


def _units() -> dict[str, Unit | None]:
    made: dict[str, Unit | None] = {MOTOR: NUMBER, RATIO: None}
    for name, text in _NUMBERS.items():
        unit = parse_unit(ScalarNode(text, Span(1, 1, 2), text, False))
        assert isinstance(unit, Unit)
        made[name] = unit
    return made


def _motor(
    line: int, cells: list[tuple[str, int]], places: dict[str, int], before: set[str], mistakes: list[Mistake]
) -> list[Motor]:
    """The motor of a line; none where something is wrong with it."""
    wrong = len(mistakes)
    if len(cells) <= max(places.values()):
        whole = Span(line, 1, max(2, cells[-1][1] + len(cells[-1][0])))
        message = f"{len(cells)} cells where the first line has more"
        mistakes.append(Mistake(message, "write a cell for each column", whole))
        return []
    name, column = cells[places[MOTOR]]
    span = Span(line, column, column + max(1, len(name)))
    if not name or name in before:
        message = f"a second motor `{name}`" if name else "a motor without a name"
        mistakes.append(Mistake(message, "give each motor a name of its own", span))
    numbers = {RATIO: 1.0}
    for key in (*_NUMBERS, RATIO):
        if key in places:
            numbers[key] = _number(line, key, cells[places[key]], mistakes)
    return [Motor(name, **numbers)] if len(mistakes) == wrong else []


def _number(line: int, key: str, cell: tuple[str, int], mistakes: list[Mistake]) -> float:
    text, column = cell
    span = Span(line, column, column + max(1, len(text)))
    try:
        value = float(text)
    except ValueError:
        mistakes.append(Mistake(f"`{text}` is no number", f"write `{key}` as a number", span))
        return math.nan
    if not math.isfinite(value) or value < 0 or (value == 0 and key not in _MAY_VANISH):
        least = "0 or more" if key in _MAY_VANISH else "more than 0"
        mistakes.append(Mistake(f"`{key}` is {text}", f"give a number that is {least}", span))
    return value
