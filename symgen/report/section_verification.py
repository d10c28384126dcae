"""The sections of the PDF alone: what verification measured, and charts."""

from __future__ import annotations

from symgen.report.content import Verification
from symgen.report.context import Context, sentence
from symgen.report.document import Block, Figure, InlineCode, Section, Table, Text
from symgen.report.prose import paragraph, say

SMALLEST_SHOWN = 1e-3

def verification(context: Context) -> tuple[Section, ...]:
    """Errors of every kernel, invariants, and what was measured with what."""
    measured = context.input.verification
    if measured is None:
        return ()
    intro = (
        f"The generated code was run at {measured.states} admissible states and compared with a reference that "
        f"shares no code with "
        "the derivation: it differentiates the energies and constraints as they stand in the file, with 50 digits. "
        "Errors are in "
        "units of the change that rounding the arguments, parameters and literals causes, plus one rounding of the "
        "result; they must "
        "not exceed 16. The last column is the largest relative error."
    )
    blocks: list[Block] = [paragraph("{}", intro), _errors(measured)]
    if measured.invariants:
        rows = tuple((say("{}", name), say("{}", value)) for name, value in measured.invariants)
        blocks += [
            paragraph("Laws that hold at every state, with the largest violation found:"),
            Table((say("Law"), say("Largest violation")), rows, (1, 0)),
        ]
    if measured.facts:
        rows = tuple((say("{}", name), say("{}", value)) for name, value in measured.facts)
        blocks += [paragraph("Further facts of this run:"), Table((say("What"), say("Value")), rows, (1, 2))]
    return (Section(say("Verification"), tuple(blocks)),)


def charts(context: Context) -> tuple[Section, ...]:
    """The drawings of the model's paths."""
    if not context.input.charts:
        return ()
    figures = tuple(Figure(chart.svg, say("{}", sentence(chart.caption))) for chart in context.input.charts)
    return (Section(say("Charts"), figures),)


def _errors(measured: Verification) -> Table:
    rows = tuple(
        (
            (InlineCode(row.quantity),),
            say("{}", row.target),
            *(say("{}", _units(value)) for value in (row.median, row.percentile_99, row.largest)),
            # beside a reference of 1e-50 for what is zero a relative error says nothing
            say("–") if 0 < row.largest < SMALLEST_SHOWN else _power(row.relative),
        )
        for row in measured.errors
    )
    headings = ("Kernel", "Target", "Median", "99 %", "Largest", "Relative")
    return Table(tuple(say("{}", heading) for heading in headings), rows, (1, 0, 0, 0, 0, 0))


def _units(value: float) -> str:
    """An error in its unit: two digits, and no powers of ten."""
    return "< 0.001" if 0 < value < SMALLEST_SHOWN else f"{value:.2g}"


def _power(value: float) -> Text:
    """A small number as 1.2·10⁻¹⁶."""
    if value == 0:
        return say("0")
    mantissa, exponent = f"{value:.1e}".split("e")
    digits = str(int(exponent)).translate(str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"))
    return say("{}", f"{mantissa}·10{digits}")
