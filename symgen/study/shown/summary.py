"""What a study comes to: states by status, and the worst value of each channel with its state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass

import numpy as np

from symgen import __version__
from symgen.ir.kernel import Status
from symgen.simulate.plant import MEANING
from symgen.study.asked.request import GRID, MOTOR_TORQUE
from symgen.study.chunks import Array, along_values, chunk_values
from symgen.study.interest import Interest, interests
from symgen.study.plan import StudyPlan, VariedName
from symgen.study.reductions import worse
from symgen.study.states import NO_PATH
from symgen.study.work import ChunkOutcome, StudyWork

NO_PLACE = {
    Status.NOT_CLOSED, Status.BRANCH, Status.MEASURED_RANK, Status.TASK_RANK, Status.CONSTRAINT_RANK, NO_PATH
}  # fmt: skip
_OF_TASKS = {
    Status.TASK_RANK: "the task does not determine the configuration",
    Status.NOT_CLOSED: "the place is out of reach: no configuration closes the loops",
    Status.BRANCH: "the place is too far from the configuration before it on the way there",
}
_MEANINGS: dict[int, str] = {
    **{int(code): text for code, text in (*MEANING.items(), *_OF_TASKS.items())},
    NO_PATH: "the path has no solution there",
}
# Between what is varied and the configuration that follows.
AND_COORDINATES = "; "
TableRows = tuple[str, tuple[str, ...], Sequence[tuple[str, ...]]]


@dataclass(frozen=True, slots=True)
class StudySummary:
    """Tables of the page, lines of the terminal, attributes of the results; `failed` says where failed chunks are."""

    statuses: Mapping[int, int]
    tables: tuple[TableRows, ...]
    attributes: Mapping[str, object]
    failed: Mapping[int, str]

    @property
    def valid(self) -> int:
        """How many states have a result."""
        return self.statuses.get(0, 0)

    @property
    def nowhere(self) -> str:
        """Why nothing came of the study."""
        if self.statuses and all(code in NO_PLACE for code in self.statuses):
            what = "the model cannot be assembled anywhere in the study"
        else:
            what = "no state of the study has a result"
        reasons = [f"{count} states: {_MEANINGS[code]}" for code, count in sorted(self.statuses.items())]
        return "\n  ".join((what, *reasons, "remedy: other ranges, or a `configuration` of the model nearer to them"))

    @property
    def lines(self) -> list[str]:
        """What the terminal shows, without the coordinates of the worst states."""
        made = []
        for heading, _, rows in self.tables:
            short = [tuple(cell.partition(AND_COORDINATES)[0] for cell in row) for row in rows]
            widths = [max(len(row[k]) for row in short) for k in range(len(short[0]))] if short else []
            made += [f"  {heading}"] if short else []
            for row in short:
                cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
                made.append(f"    {'  '.join(cells).rstrip()}")
        return made


def settings_of(plan: StudyPlan, kernels: str) -> dict[str, object]:
    """What a study is, in plain data: two with the same settings have the same results."""
    request = plan.request
    return {
        "model": plan.model.name,
        "model_hash": plan.model.text_hash,
        "kernels_hash": kernels,
        "symgen": __version__,
        "over": {one.axis.name: _range(one) for one in plan.over},
        "sample": request.sample,
        "count": request.count or 0,
        "seed": request.seed,
        "path": request.path.name if request.path else "",
        "along": {one.axis.name: _range(one) for one in plan.along},
        "show": list(plan.shown),
        "quantiles": list(request.quantiles),
        "motors": [list(astuple(one)) for one in request.motors],
    }


def _range(one: VariedName) -> list[float]:
    axis = one.axis
    return [axis.first, axis.last, *([] if axis.count is None else [axis.count])]


def settings_rows(plan: StudyPlan, summary: StudySummary) -> list[tuple[str, str]]:
    """The settings as they stand on the page."""
    request = plan.request
    rows = [("model", f"{plan.model.name}, SHA-256 {plan.model.text_hash[:16]}…")]
    rows += [("over", _range_text(one)) for one in plan.over]
    if request.sample != GRID:
        rows.append(("sample", f"{request.sample.replace('_', ' ')}, {request.count} points, seed {request.seed}"))
    if request.path is not None:
        rows.append(("along", f"path {request.path.name}, {plan.states} states"))
    rows += [("along", _range_text(one)) for one in plan.along]
    if request.motors:
        rows.append(("motors", ", ".join(one.name for one in request.motors)))
    rows.append(("states", f"{plan.points * plan.states}, of which {summary.valid} have a result"))
    rows.append(("made by", f"symgen {__version__}"))
    return rows


def _range_text(one: VariedName) -> str:
    axis = one.axis
    values = f", {axis.count} values" if axis.count is not None else ""
    unit = f" {one.unit}" if one.unit else ""
    return f"{axis.name} from {axis.first:g} to {axis.last:g}{unit}{values}"


def summarised(work: StudyWork, failed: Sequence[ChunkOutcome]) -> StudySummary:
    """The summary of all chunks, in their order."""
    statuses: dict[int, int] = {}
    worst: dict[str, list[tuple[int, tuple[float, int, int]] | None]] = {}
    for one in interests(work.plan):
        worst[one.name] = [None] * len(one.channels)
    for number, note in work.store.notes():
        for code, count in note.statuses.items():
            statuses[code] = statuses.get(code, 0) + count
        for one in interests(work.plan):
            for k, new in enumerate(note.worst[one.name]):
                old = worst[one.name][k]
                if new is not None and worse(one, new, old and old[1]):
                    worst[one.name][k] = number, new
    rows = [row for one in interests(work.plan) for row in _worst_rows(work, one, worst[one.name])]
    listed = [(str(count), _MEANINGS[code]) for code, count in sorted(statuses.items()) if code]
    places = {one.number: _where(work, one.number) for one in failed}
    tables: tuple[TableRows, ...] = (
        ("worst values", ("quantity", "value", "at"), rows),
        ("states without a result", ("states", "why"), listed),
        ("chunks that failed", ("chunk", "where"), [(str(number), text) for number, text in places.items()]),
    )
    counts = {str(code): count for code, count in sorted(statuses.items())}
    attributes = {"statuses": counts, "failed": list(places.values())}
    return StudySummary(statuses, tables, attributes, places)


def _where(work: StudyWork, number: int) -> str:
    """The ranges of the varied names in a chunk."""
    values = chunk_values(work.plan, work.chunks, number)
    ends = zip(work.plan.over, values.min(axis=0), values.max(axis=0), strict=True)
    return f"{len(values)} points, " + ", ".join(f"{one.axis.name} {low:g} to {high:g}" for one, low, high in ends)


def _worst_rows(
    work: StudyWork, one: Interest, kept: Sequence[tuple[int, tuple[float, int, int]] | None]
) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = []
    if one.counted or one.name == MOTOR_TORQUE:
        return []
    for label, unit, entry in zip(one.channels, one.units, kept, strict=True):
        if entry is not None:
            number, (value, point, state) = entry
            values = chunk_values(work.plan, work.chunks, number)[point]
            shown = f"{value:.4g} {unit}".removesuffix(" 1").strip()
            word = "smallest" if one.smallest else "largest"
            rows.append((f"{word} {one.name} {label}".rstrip(), shown, _state_text(work, values, state)))
    return rows


def _state_text(work: StudyWork, values: Array, state: int) -> str:
    """The values of the varied names at a point, and which of its states it is."""
    plan = work.plan
    named = [f"{one.axis.name} = {x:.4g}" for one, x in zip(plan.over, values, strict=True)]
    if plan.along:
        named += [f"{one.axis.name} = {x:.4g}" for one, x in zip(plan.along, along_values(plan)[state], strict=True)]
    path = next((one for one in plan.model.paths if plan.request.path and one.name == plan.request.path.name), None)
    if path is not None:
        named.append(f"t = {float(path.duration) * state / max(1, path.samples - 1):.4g} s")
    q = work.states.of(values[None]).parts["q"][0, :, state]
    pairs = zip(plan.model.coordinates, np.asarray(q), strict=True)
    varied = {one.axis.name for one in (*plan.over, *plan.along)}
    following = (f"{c.name} = {x:.4g}" for c, x in pairs if c.name not in varied)
    return f"{', '.join(named)}{AND_COORDINATES}{', '.join(following)}"
