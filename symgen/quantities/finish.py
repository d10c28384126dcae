"""What is done to a quantity once its method is chosen, before it is scheduled."""

from __future__ import annotations

from dataclasses import replace

from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.methods.method import INPUTS
from symgen.methods.quantity import Quantity, is_fixed, scalars
from symgen.model.inertial_parameters import in_words, named
from symgen.model.model import Model
from symgen.model.open_task import left_open, norm_of_motions
from symgen.model.quantities import BASE_PARAMETERS, BASE_REGRESSOR, MOTIONS, REGRESSOR
from symgen.quantities.excess import with_test_of_excess
from symgen.quantities.locked_rates import vanishing_with_locked_rates
from symgen.quantities.moving_axes import in_moving_axes
from symgen.quantities.row_units import in_units_of_the_file
from symgen.quantities.vanishing_parameters import vanishing_with_parameters
from symgen.symbolic.hidden_zeros import without_hidden_zeros
from symgen.symbolic.passes.grouping import grouped as grouped_scalars

# What is least where a task leaves directions open.
_LEAST = {
    "configuration_from_task": "reached from q by steps that are the least each, {}",
    "velocity_from_task": "of all such rates the least, {}",
    "acceleration_from_task": "those of the motion that has the least rates, {}; not the least themselves",
}


def finished(mechanics: System, generic: Genericity, derived: Quantity) -> Quantity:
    """A quantity on the graph of `mechanics` as it is scheduled: complete, and numbers grouped."""
    return with_groups(mechanics, complete(mechanics, generic, derived))


def complete(mechanics: System, generic: Genericity, derived: Quantity) -> Quantity:
    """A quantity without entries that are 0 unseen, with ranks tested that other branches may exceed, told what its
    reader must know, rows in the units of the file."""
    derived = in_moving_axes(mechanics, derived)
    outputs = without_hidden_zeros(derived.outputs)
    # what is locked is so where B has its rank, and results that are fixed may rest on that
    needless = is_fixed(outputs) and not (generic.locked and is_fixed(derived.outputs))
    derived = replace(derived, outputs=outputs, guards=() if needless else derived.guards)
    derived = vanishing_with_parameters(mechanics, derived)
    derived = vanishing_with_locked_rates(mechanics, generic, derived)
    tested = with_test_of_excess(mechanics, generic, derived)
    tested = in_units_of_the_file(mechanics, generic, tested)
    return _remarked(tested, generic, mechanics.model)


def _remarked(derived: Quantity, generic: Genericity, model: Model) -> Quantity:
    """What dependent rows or a task leave open, or inputs cannot produce, is said where the quantity is called."""
    if derived.name in _LEAST and model.task_leaves.rates:
        return replace(derived, remark=f"{left_open(model)}: {_LEAST[derived.name].format(norm_of_motions(model))}")
    if derived.name == MOTIONS[1] and generic.rank < generic.r:
        which = f"not unique, as the constraints depend on each other (rank {generic.rank} of {generic.r})"
        return replace(derived, remark=f"{which}: these are the smallest; u and q̈ are not affected")
    if derived.name == REGRESSOR:
        least = "" if model.allocation is None else "the least whatever `allocation` says; "
        return replace(derived, remark=f"{least}columns {in_words(model.mechanism)}")
    if derived.name in (BASE_REGRESSOR, BASE_PARAMETERS) and model.inertial_base is not None:
        least = "the least whatever `allocation` says; " if derived.name == BASE_REGRESSOR and model.allocation else ""
        return replace(derived, remark=f"{least}in the order {named(model.mechanism, model.inertial_base.columns)}")
    if derived.name == INPUTS and not generic.full_actuation:
        return replace(derived, remark=short_of_inputs(generic))
    return derived


def short_of_inputs(generic: Genericity) -> str:
    """What u is where inputs span fewer directions than the system has."""
    spans = f"the inputs span {generic.alpha} of {generic.delta} directions"
    return f"{spans}: of the motions that they cannot produce it is the part they can, see inverse_dynamics_residual"


def with_groups(mechanics: System, derived: Quantity) -> Quantity:
    """The quantity with numbers multiplied into groups of parameters, where that saves operations."""
    # with the scales of denominators, so that they go on sharing what they have in common with results
    scales = [guard.scale for guard in derived.guards if guard.scale is not None]
    mark = mechanics.graph.mark()
    regrouped = grouped_scalars(mechanics.graph, mechanics.factoring, [*scalars(derived), *scales])
    mechanics.factoring.forget(mark, regrouped)
    remaining = iter(regrouped)
    outputs = tuple(next(remaining) for _ in derived.outputs)
    denominators = [next(remaining) for _ in derived.guards]
    guards = tuple(
        replace(guard, denominator=denominator, scale=None if guard.scale is None else next(remaining))
        for guard, denominator in zip(derived.guards, denominators, strict=True)
    )
    return replace(derived, outputs=outputs, guards=guards)
