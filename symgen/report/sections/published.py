"""The section on published formulas: what is printed, the verdict, why, and the corrected form."""

from __future__ import annotations

from symgen.closedform.published import Verdict
from symgen.model.expressions.expression import Expression
from symgen.model.published import Published, PublishedEquations, PublishedMatrix, PublishedSingularSet
from symgen.report.context import Context, sentence
from symgen.report.document import Block, Formula, InlineMath, Section, Table, Text, displayed
from symgen.report.mathematics.from_expression import expression_layout
from symgen.report.mathematics.layout import Array, Layout, Letter, Relation, Row, equation
from symgen.report.mathematics.matrices import array_blocks
from symgen.report.mathematics.names import name_layout
from symgen.report.prose import SYMBOLS, ZERO, listed, paragraph, say, worded


def published(context: Context) -> tuple[Section, ...]:
    """The table of verdicts, and every formula that is not identical with its corrected form."""
    verdicts = {verdict.position: verdict for verdict in context.input.verdicts}
    items = list(enumerate(context.model.published))
    if not items or not verdicts:
        return ()
    rows = tuple(
        (
            say("{}", item.equation),
            _subject(item),
            say("{}", verdicts[k].verdict),
            worded(sentence(verdicts[k].explanation)),
        )
        for k, item in items
        if k in verdicts
    )
    table = Table((say("Printed"), say("Subject"), say("Verdict"), say("Why")), rows, (0, 0, 2, 5))
    intro = (
        "The formulas the source prints for this system are decided by computation: they are identical with what is "
        "derived here, "
        "equal to it on the constraint manifold only, or misprinted."
    )
    details: list[Block] = []
    for k, item in items:
        if k in verdicts and not verdicts[k].verdict.startswith("identical"):
            details += _detail(item, verdicts[k])
    return (Section(say("Published equations"), (paragraph(intro), table, *details)),)


def _subject(item: Published) -> Text:
    match item:
        case PublishedMatrix(quantity=quantity):
            return (InlineMath(_symbol(quantity)),)
        case PublishedSingularSet(quantity=quantity):
            return say("singular set of {}", _symbol(quantity))
        case PublishedEquations():
            return say("equations")


def _symbol(quantity: str) -> Layout:
    return SYMBOLS.get(quantity, Letter(quantity.replace("_", " "), "upright"))


def _detail(item: Published, verdict: Verdict) -> list[Block]:
    """The printed form, and the corrected one where it is wrong."""
    label = item.equation
    blocks: list[Block]
    match item:
        case PublishedMatrix():
            blocks = [
                paragraph(f"Equation {{}} prints{_chosen(item.independent)}", label, *_velocities(item.independent))
            ]
            blocks += _matrix(item.quantity, item.value)
            blocks += _where(item.where)
            if item.corrected is not None and verdict.verdict == "misprinted":
                blocks += [paragraph("Correct is"), *_matrix(item.quantity, item.corrected)]
        case PublishedEquations():
            blocks = [paragraph("Equations {} are printed as", label), _equations(item.equations), *_where(item.where)]
            if item.corrected and verdict.verdict == "misprinted":
                blocks += [paragraph("Correct is"), _equations(item.corrected)]
        case PublishedSingularSet():
            blocks = [
                paragraph(
                    f"After equation {{}} the singular set of {{}}{_chosen(item.independent)} is given as",
                    label,
                    _symbol(item.quantity),
                    *_velocities(item.independent),
                ),
                displayed((_vanishing(item.where_zero),)),
            ]
            if item.corrected is not None and verdict.verdict == "misprinted":
                blocks += [paragraph("Correct is"), displayed((_vanishing(item.corrected),))]
    return blocks


def _chosen(independent: tuple[str, ...]) -> str:
    return " for the independent velocities {}" if independent else ""


def _velocities(independent: tuple[str, ...]) -> tuple[Layout, ...]:
    return (listed(tuple(name_layout(f"{name}_dot") for name in independent)),) if independent else ()


def _matrix(quantity: str, rows: tuple[tuple[Expression, ...], ...]) -> tuple[Block, ...]:
    array = Array(tuple(tuple(expression_layout(entry) for entry in row) for row in rows))
    return array_blocks(_symbol(quantity), array, None)


def _where(where: tuple[tuple[str, Expression], ...]) -> tuple[Block, ...]:
    if not where:
        return ()
    return (
        paragraph("where"),
        displayed(tuple(equation(name_layout(name), expression_layout(value)) for name, value in where)),
    )


def _equations(pairs: tuple[tuple[Expression, Expression], ...]) -> Formula:
    return displayed(tuple(equation(expression_layout(left), expression_layout(right)) for left, right in pairs))


def _vanishing(expression: Expression) -> Row:
    return Row((expression_layout(expression), Relation("="), ZERO))
