"""The sections on what was left out and why, notices, and operation counts."""

from __future__ import annotations

from symgen.diagnostics import Mistake, Span
from symgen.model.expressions.parser import parse_expression
from symgen.model.expressions.walk import names_in
from symgen.model.file.source import ScalarNode
from symgen.model.model import Model
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
from symgen.report.mathematics.from_expression import expression_layout
from symgen.report.mathematics.layout import Layout
from symgen.report.prose import SYMBOLS, paragraph, say, worded

KINDS = {"add": "+ −", "mul": "×", "div": "÷", "sqrt": "√", "sincos": "sincos", "sign": "±", "other": "other"}


def omissions(context: Context) -> Section:
    """Decisions of the generator with their reasons."""
    blocks: list[Block] = []
    if context.input.skipped:
        rows = tuple((subject(what, context.model), worded(sentence(why))) for what, why in context.input.skipped)
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
    signs = ", ± is a change of sign" if "sign" in kinds else ""
    intro = (
        "Operations of the generated straight-line code, counted one by one; the sine and cosine of an angle count "
        f"as one operation{signs}. Each kernel is complete in itself: it evaluates whatever it needs from its "
        "arguments."
    )
    return Section(say("Operation counts"), (paragraph(intro), Table(headings, rows, (1, 0, *(0 for _ in kinds), 0))))


def _symbol(name: str) -> Text:
    return (InlineMath(SYMBOLS[name]),) if name in SYMBOLS else say("–")


def subject(what: str, model: Model) -> Text:
    """Names of quantities in fixed pitch, other subjects as a sentence begins, coordinates and sums of them set."""
    if any(quantity.name == what for quantity in QUANTITIES):
        return (InlineCode(what),)
    begins = what[:1].upper() + what[1:]
    words, of, listed = begins.rpartition(" of ")
    formulas = [_of_coordinates(text, model) for text in listed.split(", ")]
    if not of or None in formulas:
        return worded(begins)
    set_apart = [part for formula in formulas if formula for part in (", ", InlineMath(formula))]
    return (f"{words} of ", *set_apart[1:])


def _of_coordinates(text: str, model: Model) -> Layout | None:
    """An expression of coordinates and nothing else, set."""
    tree = parse_expression(ScalarNode(text, Span(1, 1, 1), text, quoted=False))
    known = {coordinate.name for coordinate in model.coordinates}
    if isinstance(tree, Mistake) or not {name.name for name in names_in(tree)} <= known:
        return None
    return expression_layout(tree)
