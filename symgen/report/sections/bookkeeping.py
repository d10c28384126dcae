"""The sections on what was left out and why, notices, and operation counts."""

from __future__ import annotations

from symgen.model.quantities import QUANTITIES
from symgen.report.context import Context, sentence
from symgen.report.document import (
    Block,
    InlineCode,
    InlineMath,
    Items,
    Section,
    Table,
    Text,
)
from symgen.report.prose import SYMBOLS, paragraph, say, worded

KINDS = {"add": "+ −", "mul": "×", "div": "÷", "sqrt": "√", "sincos": "sincos", "other": "other"}


def omissions(context: Context) -> Section:
    """Decisions of the generator with their reasons."""
    blocks: list[Block] = []
    if context.input.skipped:
        rows = tuple((_quantity_or_text(what), worded(sentence(why))) for what, why in context.input.skipped)
        blocks += [
            paragraph("This system does not need everything the general theory provides:"),
            Table((say("What"), say("Why")), rows, (2, 3)),
        ]
    else:
        blocks.append(paragraph("Nothing was left out."))
    if context.input.notices:
        blocks += [paragraph("Notices:"), Items(tuple(worded(sentence(text)) for text in context.input.notices))]
    return Section(say("What was left out, and why"), tuple(blocks))


def operations(context: Context) -> Section:
    """What the generated kernels cost."""
    counts = context.input.operation_counts
    kinds = [kind for kind in KINDS if any(one.get(kind) for one in counts.values())]
    rows = tuple(
        (
            _symbol(name),
            (InlineCode(name),),
            *(say("{}", str(one.get(kind, 0))) for kind in kinds),
            say("{}", str(sum(one.values()))),
        )
        for name, one in counts.items()
    )
    headings = (say("Symbol"), say("Kernel"), *(say("{}", KINDS[kind]) for kind in kinds), say("Total"))
    intro = (
        "Operations of the generated straight-line code, counted one by one; the sine and cosine of an angle count "
        "as one "
        "operation. Each kernel is complete in itself: it evaluates whatever it needs from its arguments."
    )
    return Section(say("Operation counts"), (paragraph(intro), Table(headings, rows, (1, 0, *(0 for _ in kinds), 0))))


def _symbol(name: str) -> Text:
    return (InlineMath(SYMBOLS[name]),) if name in SYMBOLS else say("–")


def _quantity_or_text(what: str) -> Text:
    """Names of quantities in fixed pitch, other subjects as a sentence begins."""
    if any(quantity.name == what for quantity in QUANTITIES):
        return (InlineCode(what),)
    return say("{}", what[:1].upper() + what[1:])
