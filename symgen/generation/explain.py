"""`symgen explain`: structure and closed forms of a model, with its valid methods, as text for the terminal."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from symgen.closedform.algebra.limits import TooLargeError
from symgen.generation.acceptance.recorded import as_recorded
from symgen.generation.draft import Draft
from symgen.generation.explain_text import methods_text, overview, quantity_text, wrapped
from symgen.generation.facts import facts
from symgen.generation.notices import replaced
from symgen.generation.requested import unknown_quantity
from symgen.generation.results import LINEARIZATION, NAMED_METHODS, Options
from symgen.methods.selection import MethodChoice
from symgen.model.asked_base import with_inertial_base
from symgen.model.load import load_model
from symgen.model.quantities import NAMED, ROWS
from symgen.quantities.catalogue import BY_NAME
from symgen.report.gather import gather


def explain(
    path: Path,
    quantity: str | None,
    progress: Callable[[str], None],
    methods: Mapping[str, str] | None = None,
    out: Path | None = None,
) -> str:
    """Structure and closed forms as text for the terminal; of one quantity when it is named.

    `methods` are those whose validity is reported, by quantity.  Kernels are those of OUT/<model>, where a run has
    verified some.
    """
    if quantity is not None and quantity not in BY_NAME:
        raise unknown_quantity(quantity, LINEARIZATION)
    progress("reading the model")
    model = load_model(path)
    if quantity is not None:
        model = with_inertial_base(replace(model, outputs=(*model.outputs, quantity)), (quantity,))
    progress("deriving")
    # what `all` leaves to those who name it has a kernel here where it is asked for
    outputs = ("all", quantity) if quantity is not None and ROWS[quantity].needs == NAMED else ("all",)
    draft = as_recorded(model, outputs, Options(scalars=("float64",), methods=methods or {}, measured=out))
    progress("closed forms")
    try:
        report = gather(model, facts(draft))
    except TooLargeError as large:
        return f"closed forms are left out: {large}"
    text = overview(report) if quantity is None else quantity_text(report, quantity)
    names = dict.fromkeys(("inverse_dynamics", *(methods or ())) if quantity is None else (quantity,))
    compared = ((name, _compared(draft, name)) for name in names)
    parts = [text, *(methods_text(name, choice) for name, choice in compared if choice is not None)]
    notices = [*draft.notes, *(notice.message for notice in replaced(draft, None if quantity is None else names))]
    return "\n".join([*parts, *("\n" + "\n".join(wrapped(notice)) for notice in notices)])


def _compared(draft: Draft, quantity: str) -> MethodChoice | None:
    """What is known of the methods of a quantity; of the one asked for alone, where one was asked for."""
    derivations = draft.derivations
    if quantity == "inverse_dynamics":
        return derivations.method_of_u
    taken = {choice.quantity: choice.method for choice in derivations.choices}
    named = dict(derivations.named)
    if quantity in named or quantity not in NAMED_METHODS or quantity not in taken:
        return named.get(quantity)
    known = derivations.methods
    return None if known is None else known.compared(quantity, taken[quantity])
