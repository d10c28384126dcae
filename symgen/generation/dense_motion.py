"""What is told where accelerations or multipliers of bodies are long because they cannot go from body to body."""

from __future__ import annotations

from symgen.backends.operations import count_operations
from symgen.diagnostics import Notice
from symgen.generation.draft import Draft
from symgen.generation.results import Options
from symgen.ir.pairs.wide_functions import works_with_pairs
from symgen.methods.forward_dynamics.motions import BY_FRAMES
from symgen.model.quantities import MOTIONS
from symgen.quantities.candidates import ARTICULATED

# Operations of q_ddot or of lambda beyond which a notice tells why it is long.
LONG_MOTION = 3000


def dense_motions(draft: Draft, options: Options) -> tuple[Notice, ...]:
    """A notice for long kernels that factor the whole mass matrix: what they cost, why, and what would change it."""
    # of what works with pairs of numbers the steps: it is the method that is long
    counts = {
        kernel.name: len(kernel.statements)
        if works_with_pairs(kernel)
        else count_operations(kernel.statements).total
        for kernel in draft.program.kernels
    }
    choices = [choice for choice in draft.derivations.choices if choice.quantity in MOTIONS]
    # articulated inertias that were counted and lost are no loss, and a method that was asked for is what was wanted
    dense = [c for c in choices if c.method != BY_FRAMES and ARTICULATED not in dict(c.costs)]
    names = [c.quantity for c in dense if c.quantity not in options.methods]
    long = [name for name in names if counts.get(name, 0) > LONG_MOTION]
    if not long or not draft.model.mechanism.has_mass or draft.model.rough:
        return ()
    from symgen.methods.forward_dynamics.articulated import lacking

    counted = " and ".join(f"{name} ({counts[name]} operations)" for name in long)
    grows = "the whole mass matrix is factored, where articulated inertias take a fraction of that"
    return (Notice(f"{counted}: {grows}; {lacking(draft.model, draft.derivations.generic)}"),)
