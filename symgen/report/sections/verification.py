"""What verification measured, and charts."""

from __future__ import annotations

from symgen.report.content import ErrorRow, Verification
from symgen.report.context import Context, sentence
from symgen.report.document import Block, Figure, FigureReference, InlineCode, Section, Table, Text
from symgen.report.mathematics.layout import Accent, Layout, Letter, Scripts
from symgen.report.prose import (
    NB,
    TWO,
    ZERO,
    B,
    C,
    G,
    Mt,
    N,
    bold,
    equals,
    juxtaposed,
    minus_sum,
    paragraph,
    pseudoinverse,
    qd,
    say,
    transposed,
    worded,
)

Nx, Jx, Gt, Ct = Scripts(N, Letter("x")), Scripts(bold("J"), Letter("x")), Accent(G, "tilde"), Accent(C, "tilde")
Mp = pseudoinverse(Mt)
"""Matrices that laws are about: of a task, projected ones, and the pseudoinverse of M̃."""
LAWS: dict[str, tuple[str, Layout] | tuple[str, Layout, Layout]] = {
    "N N = N": ("{}", equals(juxtaposed(NB, NB), NB)),
    "N' = N": ("{}", equals(transposed(NB), NB)),
    "B N = 0": ("{}", equals(juxtaposed(B, NB), ZERO)),
    "A X A = A (A = M~, X = M~+)": ("{}", equals(juxtaposed(Mt, Mp, Mt), Mt)),
    "X A X = X": ("{}", equals(juxtaposed(Mp, Mt, Mp), Mp)),
    "(A X)' = A X": ("{} is symmetric", juxtaposed(Mt, Mp)),
    "(X A)' = X A": ("{} is symmetric", juxtaposed(Mp, Mt)),
    "N_x N_x = N_x": ("{}", equals(juxtaposed(Nx, Nx), Nx)),
    "N_x' = N_x": ("{}", equals(transposed(Nx), Nx)),
    "B N_x = 0": ("{}", equals(juxtaposed(B, Nx), ZERO)),
    "J_x N_x = 0": ("{}", equals(juxtaposed(Jx, Nx), ZERO)),
    "N_x qd = 0 (qd the least rates)": ("{} for the least rates {}", equals(juxtaposed(Nx, qd), ZERO), qd),
    "d/dt G~ - 2 C~ is skew": ("{} is skew-symmetric", minus_sum((Accent(Gt, "dot"),), (juxtaposed(TWO, Ct),))),
}
"""How laws that verification names are set."""
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
    figures = tuple(
        Figure(chart.svg, say("{}", sentence(chart.caption)), f"chart_{position}")
        for position, chart in enumerate(context.input.charts, start=1)
    )
    first, last = FigureReference(figures[0].label), FigureReference(figures[-1].label)
    if len(figures) == 1:
        intro = paragraph("{} is drawn along a path of the model.", first)
    else:
        intro = paragraph("{} to {} are drawn along paths of the model.", first, last)
    return (Section(say("Charts"), (intro, *figures)),)


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
        (_law(law), *(say("{}", values.get((target, law), "")) for target in targets))
        for law in dict.fromkeys(law for _, law, _ in measured.invariants)
    )
    return Table(tuple(say("{}", heading) for heading in ("Law", *targets)), rows, (0, *(1 for _ in targets)))


def _law(law: str) -> Text:
    """A law as it is set; what it is not known by is in words."""
    known = LAWS.get(law)
    return worded(law) if known is None else say(*known)


def _spread(row: ErrorRow) -> str:
    """Median and largest error; one figure where both are alike."""
    median, largest = _units(row.median), _units(row.largest)
    return median if median == largest else f"{median} / {largest}"


def _units(value: float) -> str:
    """An error in its unit: two digits, and no powers of ten."""
    return "< 0.001" if 0 < value < SMALLEST_SHOWN else f"{value:.2g}"
