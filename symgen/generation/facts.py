"""What a draft states beside its kernels: operations, what is skipped and why, where methods are not valid."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symgen.backends.operations import count_operations
from symgen.generation.draft import Draft
from symgen.methods.forward_dynamics.motions import BY_FRAMES
from symgen.quantities.select import Selection

if TYPE_CHECKING:
    from symgen.report.facts import Facts


def facts(draft: Draft) -> Facts:
    """What the report and `symgen explain` are given of a draft."""
    from symgen.report.facts import Facts

    operations = {kernel.name: count_operations(kernel.statements) for kernel in draft.program.kernels}
    decisions = tuple((decision.what, decision.why) for decision in draft.structure.decisions)
    derivations = draft.derivations
    rejected = (
        (f"method {r.method} of {r.quantity}", f"verification rejects it: {r.why}") for r in derivations.rejected
    )
    return Facts(operations, (*decisions, *derivations.absent, *rejected, *_failing_methods(draft)))


def _failing_methods(draft: Draft) -> tuple[tuple[str, str], ...]:
    """Where what is generated is not valid if a method was asked for, and which are left to be asked for and where
    they fail."""
    derivations = draft.derivations
    of_u, methods = derivations.method_of_u, derivations.methods
    remarks = list(invalid_methods(derivations, ()))
    if of_u is not None and methods is not None and of_u.validity.admitted:
        others = methods.failing() or of_u.failed
        remarks += ((f"method {name} of u", f"{why}; {_asked_for(f'--method {name}')}") for name, why in others)
    # articulated inertias are taken only where G is definite, and then no method fails
    moving = [choice.quantity for choice in derivations.choices if choice.method not in ("", BY_FRAMES)]
    if moving:
        from symgen.methods.forward_dynamics.motions import failing_motions

        for name, why in failing_motions(derivations.mechanics):
            asked = " ".join(f"--method {quantity}={name}" for quantity in moving)
            remarks.append((f"method {name} of {' and '.join(moving)}", f"{why}; {_asked_for(asked)}"))
    return tuple(remarks)


def _asked_for(options: str) -> str:
    return f"it is made if asked for by `{options}`"


def invalid_methods(derivations: Selection, failed: tuple[tuple[str, str], ...]) -> tuple[tuple[str, str], ...]:
    """Whether methods that were asked for are not valid at every regular state; if not, those of u that `failed`."""
    of_u = derivations.method_of_u
    asked = ((("u", of_u),) if of_u is not None else ()) + derivations.named
    return (
        *(
            (f"validity of {quantity} at every regular state", f"method {one.name}: {one.validity.explanation}")
            for quantity, one in asked
            if not one.validity.admitted
        ),
        *((f"method {name} of u", why) for name, why in failed if of_u is not None and of_u.validity.admitted),
    )
