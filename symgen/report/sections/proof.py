"""The section about proofs: alarms of Eva, and Gappa's bounds beside measured errors."""

from __future__ import annotations

from symgen.report.context import Context
from symgen.report.document import Block, InlineCode, Section, Table
from symgen.report.proof import ProofFacts
from symgen.report.prose import paragraph, say

INTRO = (
    "Over the ranges of the model file, with u in float32. Frama-C Eva analysed the generated C by intervals; without "
    "alarms no input of the box leads to a division by 0, an infinity, a NaN or a wrong access."
)
ROUNDING = (
    "The largest rounding error of an entry of u, certified by Gappa for every input of the box, and measured at a "
    "million random ones. Intervals forget how values depend on each other; the truth lies between the two."
)


def proof(context: Context) -> tuple[Section, ...]:
    """Nothing where nothing was proved about this C."""
    facts = context.input.proof
    if facts is None:
        return ()
    blocks: list[Block] = [paragraph("{}", INTRO), paragraph("{}", _alarms(facts))]
    if facts.others:
        blocks.append(paragraph("{}", f"What remains: {'; '.join(facts.others)}.".replace("`", "")))
    if facts.rounding:
        blocks += [paragraph("{}", ROUNDING), _table(context, facts)]
    else:
        blocks.append(paragraph("Gappa certifies no rounding error: {}.", facts.without))
    return (Section(say("Proofs"), tuple(blocks)),)


def _alarms(facts: ProofFacts) -> str:
    known = "Eva: 0 alarms." if facts.unproven == "0" else f"Eva: {facts.unproven}" + (
        " statements remain unproven." if facts.unproven.isdigit() else "."
    )
    left = len(facts.denominators)
    kept = "Intervals keep every denominator from 0." if not left else (
        f"Intervals do not keep {left} of the denominators from 0; proof/README.md names them."
    )
    return f"{known} {kept}"


def _table(context: Context, facts: ProofFacts) -> Table:
    inputs = context.input.model.inputs
    rows = tuple(
        (
            (InlineCode(f"u[{entry}]"),),
            *(say("{}", text) for text in (inputs[entry].name, f"{bound:.2g}", f"{measured:.2g}")),
        )
        for entry, bound, measured in facts.rounding
    )
    headings = ("Entry", "Input", "Certified", "Measured")
    return Table(tuple(say("{}", heading) for heading in headings), rows, (0, 1, 0, 0))
