"""A log of a machine: a CSV file with a column for the time, each measured coordinate and each input."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from symgen.diagnostics import Mistake, ModelError, Span
from symgen.identification.arrays import Array
from symgen.identification.logs.header import TIME, cells_of, measured_in, read_header
from symgen.model.model import Model
from symgen.records import dataclass

# Samples of a log: with fewer nothing is left of it once it is filtered.
FEWEST_SAMPLES = 100
# A share of a step by which steps of the time may differ: times are often written with few digits.
STEP_TOLERANCE = 0.05
# Mistakes in the samples of a log that are told.
MOST_LOG_MISTAKES = 40


@dataclass(frozen=True, slots=True)
class MeasuredLog:
    """Samples at equal steps: `t` (N) in s; coordinates, rates, accelerations and inputs by name, (N) each.

    Units are those of the model.  Sample k stands in line k + 2 of `file`.
    """

    file: str
    t: Array
    columns: Mapping[str, Array]
    measured: tuple[str, ...]

    @property
    def rate(self) -> float:
        """Samples a second."""
        return (len(self.t) - 1) / float(self.t[-1] - self.t[0])


def read_log(path: Path, model: Model) -> MeasuredLog:
    """The log of a machine.  Raises ModelError with all of its mistakes, OSError where it cannot be read."""
    data = path.read_bytes()
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        mistake = Mistake("the file is not text in UTF-8", "save it as UTF-8", Span(line, 1, 2))
        raise ModelError(str(path), data.decode("utf-8", "replace"), (mistake,)) from None
    lines = text.rstrip().splitlines() or [""]
    places, mistakes = read_header(model, lines[0])
    if mistakes and not places:  # nothing is a cell where columns are not separated
        raise ModelError(str(path), text, tuple(mistakes))
    width = lines[0].count(",") + 1
    table = _table(lines[1:], width)
    if table is None:
        table, wrong = _table_with_mistakes(lines[1:], width)
        mistakes += wrong[:MOST_LOG_MISTAKES]
    if len(table) < FEWEST_SAMPLES:
        remedy = f"record {FEWEST_SAMPLES} at least, over all of the motion"
        mistakes.append(Mistake(f"{len(table)} samples are too few", remedy, Span(1, 1, 2)))
    elif TIME in places:
        mistakes += list(_wrong_times(lines, table[:, places[TIME]], places[TIME]))[:MOST_LOG_MISTAKES]
    if mistakes:
        raise ModelError(str(path), text, tuple(mistakes))
    columns = {name: table[:, place] for name, place in places.items()}
    return MeasuredLog(str(path), columns.pop(TIME), columns, measured_in(model, places))


def _table(lines: Sequence[str], width: int) -> Array | None:
    """All numbers, where each cell is one."""
    try:
        table = np.array([line.split(",") for line in lines], dtype=np.float64)
    except ValueError:
        return None
    return table if table.ndim == 2 and table.shape[1] == width and np.isfinite(table).all() else None


def _table_with_mistakes(lines: Sequence[str], width: int) -> tuple[Array, list[Mistake]]:
    """NaN stands where there is no number."""
    table, mistakes = np.full((len(lines), width), math.nan), list[Mistake]()
    for k, line in enumerate(lines):
        cells = cells_of(line)
        if not line.strip():
            message, remedy = "an empty line, where a sample is missing", "remove it, or resample the log"
            mistakes.append(Mistake(message, remedy, Span(k + 2, 1, 2)))
        elif len(cells) != width:
            message = f"a sample of {len(cells)} cells, where the first line names {width} columns"
            remedy = "give each column one cell, and write decimals with a point"
            mistakes.append(Mistake(message, remedy, Span(k + 2, 1, len(line) + 1)))
        else:
            for column, (cell, start) in enumerate(cells):
                number, wrong = _number(cell, Span(k + 2, start, start + max(1, len(cell))))
                table[k, column] = number
                mistakes += wrong
    return table, mistakes


def _number(cell: str, span: Span) -> tuple[float, list[Mistake]]:
    try:
        value = float(cell)
    except ValueError:
        message = f"`{cell[:40]}` is no number" if cell else "an empty cell"
        remedy = "write a number with a decimal point; where samples are missing, resample the log"
        return math.nan, [Mistake(message, remedy, span, cell[:40])]
    if math.isfinite(value):
        return value, []
    remedy = "leave out what was not measured and what is around it: a log is one motion without gaps"
    return math.nan, [Mistake(f"`{cell}` is no measured value", remedy, span, cell)]


def _wrong_times(lines: Sequence[str], times: Array, place: int) -> Iterator[Mistake]:
    """Where the time stands still, runs backwards, leaves samples out or has a step of its own."""
    steps = np.diff(times)
    usual = float(np.nanmedian(steps))
    if not usual > 0:
        remedy = "sort the samples by time, and give `t` in s"
        yield Mistake("the time does not run forwards", remedy, _span(lines, 0, place))
        return
    for k in np.flatnonzero(np.abs(steps - usual) > STEP_TOLERANCE * usual):
        share = float(steps[k]) / usual
        if share <= 0:
            message, remedy = "the time runs backwards or stands still here", "sort the samples, each time once"
        elif abs(share - round(share)) <= STEP_TOLERANCE * share:
            message = "a gap in the time: samples are missing before this one"
            remedy = "take a part of the log without gaps, or resample it"
        else:
            message = "a step of the time that differs from the others"
            remedy = f"resample the log at equal steps; the usual one is {usual:.6g} s"
        yield Mistake(message, remedy, _span(lines, int(k) + 1, place))


def _span(lines: Sequence[str], sample: int, place: int) -> Span:
    cell, start = cells_of(lines[sample + 1])[place]
    return Span(sample + 2, start, start + max(1, len(cell)))
