"""Whether a refusal is true: reasons for which a legal draw may be refused, looked at with the zoo's own numbers."""

from __future__ import annotations

from collections.abc import Callable

from symgen.laboratory.zoo.draws.describe import MISTAKE, Description
from symgen.laboratory.zoo.draws.drawn import DrawnEquations
from symgen.laboratory.zoo.verdict import FAILED, REFUSED, DrawVerdict
from symgen.laboratory.zoo.witness.reading.urdf_file import expanded

UNREPORTED = "mistake not told"
# what symgen says of a system as a whole, and what must be so then
REASONS: dict[str, Callable[[DrawnEquations], bool]] = {
    "the accelerations are undetermined": lambda drawn: drawn.undetermined,
    "the mechanism cannot move": lambda drawn: drawn.freedom == 0,
    "only singular configurations were found": lambda drawn: drawn.singular,
}


def judged(description: Description, verdict: DrawVerdict) -> DrawVerdict:
    """The verdict, a failure where a legal draw was refused, or a mistake that was drawn on purpose was not told."""
    mistaken = MISTAKE in description.marks
    if mistaken and not verdict.failed and verdict.ending != REFUSED:
        return DrawVerdict(FAILED, UNREPORTED, verdict.signature)
    if verdict.ending != REFUSED or mistaken:
        return verdict
    for words, is_true in REASONS.items():
        if words in verdict.signature:
            drawn = DrawnEquations(expanded(description.blocks, description.files), description.start)
            return verdict if is_true(drawn) else DrawVerdict(FAILED, "refused without reason", verdict.signature)
    return DrawVerdict(FAILED, "refused without reason", verdict.signature)
