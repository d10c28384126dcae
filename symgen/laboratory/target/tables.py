"""What the terminal shows of a model on its targets."""

from __future__ import annotations

from collections.abc import Sequence

from symgen.laboratory.target.record import Cell, CoreReport, KernelCost, TargetReport
from symgen.laboratory.target.selection import FAST, SMALL
from symgen.terminal import columns

HEAD = ("kernel", "scalar", "instructions", "-Os", "code", "linked", "frame", "stack")


def target_tables(report: TargetReport) -> str:
    """Conformance of each place, then the cost of every kernel on every core."""
    vectors = ", ".join(f"{count} {kind}" for kind, count in report.vectors.items())
    sections = [f"{report.model}   test vectors: {vectors}", _conformance(report.cells)]
    sections += [_costs(core) for core in report.cores]
    sections += [f"  note: {note}" for note in report.notes]
    return "\n\n".join(sections) + "\n"


def _conformance(cells: Sequence[Cell]) -> str:
    rows = []
    for where, trig in dict.fromkeys((cell.where, cell.trig) for cell in cells):
        here = [cell for cell in cells if (cell.where, cell.trig) == (where, trig)]
        largest = max(cell.kernels for cell in here)
        marks = {f"{cell.compiler} {cell.level}": "" if cell.kernels == largest else "*" for cell in here}
        levels = [build + mark for build, mark in marks.items()]
        different = sum(cell.different for cell in here)
        distance = max(cell.distance for cell in here)
        agreement = "the same bits" if not different else f"{different} differ, by {distance:.2g} units at most"
        rows.append((where, trig, ", ".join(levels), str(sum(cell.records for cell in here)), agreement))
    note = "\n  * not every kernel" if any("*" in row[2] for row in rows) else ""
    return columns(("beside the host", "trig", "builds", "results", ""), rows, "<<<><") + note


def _costs(core: CoreReport) -> str:
    by_level = {(cost.kernel, cost.scalar, cost.level): cost for cost in core.costs}
    rows = [
        _row(by_level.get((cost.kernel, cost.scalar, FAST)), cost) for cost in core.costs if cost.level == SMALL
    ]
    note = f" ({core.note})" if core.note else ""
    return f"{core.name}{note}\n" + columns(HEAD, rows, "<<>>>>>>") + (
        "\n  instructions per call with status 0 at -O2 and at -Os; bytes at -Os: code of the kernel, growth of an"
        "\n  image that links it, frames by -fstack-usage, stack by painting; RAM 0; –: not built or never 0"
    )


def _row(fast: KernelCost | None, small: KernelCost) -> tuple[str, ...]:
    size = small.footprint
    bytes_ = ("", "", "") if size is None else (str(size.code), str(size.linked), str(size.frame))
    return (small.kernel, small.scalar, _range(fast), _range(small), *bytes_, str(small.stack))


def _range(cost: KernelCost | None) -> str:
    if cost is None or not cost.calls:
        return "–"
    return str(cost.most) if cost.fewest == cost.most else f"{cost.fewest}..{cost.most}"
