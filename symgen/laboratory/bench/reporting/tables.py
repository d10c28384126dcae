"""What the terminal shows of a benchmark."""

from __future__ import annotations

from symgen.laboratory.bench.reporting.batch_pages import many_lines
from symgen.laboratory.bench.run import Benchmark, Comparison, MeasuredCandidate
from symgen.terminal import columns

HEAD = ("", "", "ns", "instructions", "code", "stack", "median", "99 %", "largest", "units", "front")


def bench_tables(result: Benchmark) -> str:
    """One table for each quantity, then what was left out."""
    sections = [result.model]
    for comparison in result.comparisons:
        sections.append(f"{comparison.task.quantity}, {comparison.states} states\n{_table(comparison)}")
        beyond = sum(m.beyond or 0 for m in comparison.measured)
        sections += [f"  generated kernels at {beyond} states beyond 16 units"] if beyond else []
        sections += [many_lines(comparison.many)] if comparison.many else []
        lines = [f"  not measured: {name} ({why})" for name, why in comparison.left_out]
        sections += ["\n".join(lines)] if lines else []
    sections += [f"  note: {note}" for note in result.notes]
    return "\n\n".join(sections) + "\n"


def _table(comparison: Comparison) -> str:
    ordered = sorted(comparison.measured, key=lambda m: (m.language, m.scalar != "float64", m.nanoseconds))
    return columns(HEAD, [_row(m) for m in ordered], "<<>>>>>>>><") + (
        "\n  code and stack in bytes; relative errors; units of d + eps |y|; front: nothing else is faster and closer"
    )


def _row(m: MeasuredCandidate) -> tuple[str, ...]:
    return (
        m.label + (" *" if m.chosen and m.language == "C" else ""),
        m.scalar,
        f"{m.nanoseconds:.0f}",
        "" if m.instructions is None else f"{m.instructions:.0f}",
        "" if m.footprint is None else str(m.footprint.code),
        "" if m.footprint is None else str(m.footprint.stack),
        f"{m.errors.median:.1e}",
        f"{m.errors.percentile_99:.1e}",
        f"{m.errors.largest:.1e}",
        f"{m.errors.largest_in_units:.2g}",
        "yes" if m.on_front else "",
    )
