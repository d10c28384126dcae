"""The sections of the PDF alone: what verification measured, and charts."""

from __future__ import annotations

from symgen.report.content import ErrorRow, Verification
from symgen.report.context import Context, sentence
from symgen.report.document import Block, Figure, InlineCode, Section, Table
from symgen.report.prose import paragraph, say, worded

# Units of error: less than this is shown as less.
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
        "not exceed 16. Each target shows the median and the largest of its errors; the certificate has more."
    )
    blocks: list[Block] = [paragraph("{}", intro), _errors(measured)]
    if twins := [target for target in _targets(measured) if _is_twin(target)]:
        blocks.append(paragraph("The same bits came from: {}.", ", ".join(twins)))
    if measured.invariants:
        blocks += [
            paragraph("Laws that hold at every state, with the largest violation found:"),
            _laws(measured),
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


def _targets(measured: Verification) -> list[str]:
    return list(dict.fromkeys(row.target for row in measured.errors))


def _is_twin(target: str) -> bool:
    """Whether a target has to return the bits of another, such as `C float64 batch`: a column would say it again."""
    return target.endswith((" batch", " prepared"))


def _errors(measured: Verification) -> Table:
    """One line for each kernel, one column for each target."""
    targets = [target for target in _targets(measured) if not _is_twin(target)]
    by_cell = {(row.quantity, row.target): row for row in measured.errors}
    rows = tuple(
        (
            (InlineCode(quantity),),
            *(say("{}", _spread(by_cell[quantity, t])) if (quantity, t) in by_cell else say("") for t in targets),
        )
        for quantity in dict.fromkeys(row.quantity for row in measured.errors)
    )
    headings = ("Kernel", *targets)
    return Table(tuple(say("{}", heading) for heading in headings), rows, (0, *(1 for _ in targets)))


def _laws(measured: Verification) -> Table:
    targets = list(dict.fromkeys(target for target, _, _ in measured.invariants))
    values = {(target, law): value for target, law, value in measured.invariants}
    rows = tuple(
        (worded(law), *(say("{}", values.get((target, law), "")) for target in targets))
        for law in dict.fromkeys(law for _, law, _ in measured.invariants)
    )
    return Table(tuple(say("{}", heading) for heading in ("Law", *targets)), rows, (0, *(1 for _ in targets)))


def _spread(row: ErrorRow) -> str:
    """Median and largest error; one figure where both are alike."""
    median, largest = _units(row.median), _units(row.largest)
    return median if median == largest else f"{median} / {largest}"


def _units(value: float) -> str:
    """An error in its unit: two digits, and no powers of ten."""
    return "< 0.001" if 0 < value < SMALLEST_SHOWN else f"{value:.2g}"
