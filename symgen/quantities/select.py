"""The quantities of a model, each along the cheapest valid way by counted cost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from types import MappingProxyType

from symgen.ir.kernel import Scalar
from symgen.mechanics.genericity import Genericity, genericity
from symgen.mechanics.reflected_rows import reflected_rows
from symgen.mechanics.system import System
from symgen.methods.derivation import Derivation
from symgen.methods.forward_dynamics.absolute import brought_back, in_absolute_angles
from symgen.methods.forward_dynamics.minor_motion import LARGEST_DELTA
from symgen.methods.forward_dynamics.motions import BY_FRAMES, cost_factor
from symgen.methods.quantity import Quantity, is_fixed, resting_on, scalars
from symgen.methods.selection import (
    AUTO,
    CANCELLATION_WORTH,
    FACTORING_LIMIT,
    MethodChoice,
    Methods,
    derived_on,
    moved,
)
from symgen.methods.spaces import derivations as derivations_of
from symgen.model.model import Model
from symgen.quantities.catalogue import BY_NAME, CATALOGUE, PARTITION, POINTS, by_blocks, derive, missing
from symgen.quantities.everything import Everything, too_long
from symgen.quantities.excess import with_test_of_excess
from symgen.quantities.row_units import in_ordinary_units, in_units_of_the_file
from symgen.records import dataclass
from symgen.runtime.activity import each, working
from symgen.symbolic.hidden_zeros import without_hidden_zeros
from symgen.symbolic.passes.grouping import grouped as grouped_scalars
from symgen.symbolic.traverse import cost, reached

# Their forms have multiplied out what may cancel.
MOTIONS = ("forward_dynamics", "multipliers")
ABSOLUTE = "householder in absolute angles"
ARTICULATED = "articulated inertias"
# What errors that act like turns of joints are worth in operations.
STRUCTURED_WORTH = Fraction(1, 20)


@dataclass(frozen=True, slots=True)
class Choice:
    """Which way a quantity took, and the counted cost of each way tried; q_ddot and lambda have a form along it.

    `wide` are the scalar types in which its kernel works with twice the digits.
    """

    quantity: str
    way: str
    costs: tuple[tuple[str, int], ...]
    form: str = ""
    wide: tuple[Scalar, ...] = ()

    @property
    def digits(self) -> str:
        """What is told of it beside the way: empty where it works with plain numbers."""
        return f", with twice the digits in {' and '.join(self.wide)}" if self.wide else ""


@dataclass(frozen=True, slots=True)
class Rejection:
    """A way that verification rejected, and why."""

    quantity: str
    way: str
    why: str


@dataclass(frozen=True, slots=True)
class Selection:
    """The derived quantities of a model and how they were chosen."""

    mechanics: System
    generic: Genericity
    quantities: tuple[Quantity, ...]
    choices: tuple[Choice, ...]
    absent: tuple[tuple[str, str], ...]
    form: MethodChoice | None = None  # of the inverse dynamics, where they are among the quantities
    named: tuple[tuple[str, MethodChoice], ...] = ()  # of other quantities, where a form was asked for by name
    methods: Methods | None = None  # those of u that were looked at
    rejected: tuple[Rejection, ...] = ()  # by verification
    left_out: tuple[tuple[str, tuple[str, ...]], ...] = ()  # quantities with the scalar types in which no way passes


class NoSuchFormError(Exception):
    """A form of a quantity that this system does not have, with the reason."""

    def __init__(self, quantity: str, form: str, reason: str) -> None:
        super().__init__(f"no form {form!r} of {quantity}: {reason}")


def absolute_way(model: Model, generic: Genericity) -> Derivation | None:
    """The derivation of q_ddot and lambda along reflections in absolute angles, on a graph of its own.

    Taken where angles are relative and minors too many: the rounding errors of G in relative angles grow with the
    length of a chain.
    """
    seen = in_absolute_angles(model) if model.constraints and generic.delta > LARGEST_DELTA else None
    if seen is None:
        return None
    return Derivation(seen, generic, reflected_rows(seen, generic))


def articulated_motion(model: Model, generic: Genericity) -> dict[str, Quantity]:
    """q_ddot and lambda by articulated inertias, on a graph of their own; none where the system lacks that form.

    Where rows depend on each other, choosing among them is most of the work by any form: left for when others fail.
    """
    if not model.mechanism.has_mass or generic.rank < generic.r:
        return {}
    from symgen.methods.forward_dynamics.articulated import articulated  # models given by energies start without it

    found = articulated(model, generic)
    if found is None:
        return {}
    motion = found[1]
    outputs = dict(zip(MOTIONS, (motion.accelerations, motion.multipliers), strict=True))
    return {name: resting_on(motion.guards, name, values) for name, values in outputs.items() if values}


def requested(model: Model, generic: Genericity, outputs: Sequence[str]) -> tuple[list[str], list[tuple[str, str]]]:
    """The names to derive, in catalogue order, and what was asked for that this system does not have."""
    everything = "all" in outputs
    present: list[str] = []
    absent: list[tuple[str, str]] = []
    for entry in CATALOGUE:
        # `all` does not ask a system without points for theirs
        if entry.name in outputs or (everything and (entry.needs != POINTS or model.mechanism.points)):
            reason = missing(entry, model, generic)
            if reason is None:
                present.append(entry.name)
            else:
                absent.append((entry.name, reason))
    return present, absent


def derive_quantities(
    model: Model, outputs: Sequence[str], forms: Mapping[str, str] = MappingProxyType({})
) -> Selection:
    """Derive what is asked for and nothing else; `forms` by quantity are taken whatever they cost.

    Raises NoSuchFormError where the system does not have one of them.
    """
    model = in_ordinary_units(model)
    with working("motion equations"):
        mechanics = System(model)
        generic = genericity(mechanics)
    present, absent = requested(model, generic, outputs)
    derivations = derivations_of(mechanics, generic)
    blocks = derivations.pop("blocks", None)
    moving = [name for name in MOTIONS if name in present and name not in forms]
    with working("articulated inertias"):
        by_frames = articulated_motion(model, generic) if moving else {}
    # where minors are not listed, no other form is derived to be counted: they grow faster than the articulated one
    many = generic.r > 0 and generic.delta > LARGEST_DELTA
    absolute = absolute_way(model, generic) if moving and not by_frames else None
    along = {**derivations, "factored": derivations.get("minors"), ABSOLUTE: absolute}
    quantities: list[Quantity] = []
    choices: list[Choice] = []
    chosen_form: MethodChoice | None = None
    methods: Methods | None = None
    named: list[tuple[str, MethodChoice]] = []
    everything = Everything(outputs, forms)
    for name in each("ways to", present, str):
        if name == "inverse_dynamics":
            methods = Methods(model, generic)
            found = methods.choose(name, forms.get(name, AUTO))
            if isinstance(found, str):
                raise NoSuchFormError(name, forms.get(name, AUTO), found)
            candidate, chosen_form = found
            quantities.append(derived_on(mechanics.graph, candidate))
            choices.append(Choice(name, chosen_form.way, chosen_form.costs))
            continue
        if name in forms:
            quantity, choice = _named(mechanics, generic, name, forms[name])
            quantities.append(quantity)
            choices.append(Choice(name, choice.way, choice.costs))
            named.append((name, choice))
            continue
        entry = BY_NAME[name]
        if name in by_frames and many:
            candidates = {ARTICULATED: moved(mechanics.graph, by_frames[name])}
        elif name in MOTIONS and absolute is not None:
            candidates = {ABSOLUTE: brought_back(mechanics.graph, absolute.mechanics, derive(entry, absolute))}
        else:
            found_along = {way: partial(derive, entry, derivation) for way, derivation in derivations.items()}
            if blocks is not None and by_blocks(entry):
                found_along["blocks"] = partial(derive, entry, blocks)
            # a tree has articulated inertias; what goes without them may take as long as they are worth, and no longer
            least = cost(scalars(by_frames[name])).weight if name in by_frames else None
            candidates = everything.derived(name, found_along, least)
        if name in by_frames and not many:
            candidates[ARTICULATED] = moved(mechanics.graph, by_frames[name])
        if not candidates:
            absent.append((name, too_long()))
            continue
        costs = {way: cost(scalars(derived)).weight for way, derived in candidates.items()}
        formed = {way: _form_along(along.get(way), name) for way in costs}
        weights = {way: count * cost_factor(formed[way], mechanics) for way, count in costs.items()}
        if ARTICULATED in weights:
            weights[ARTICULATED] *= 1 - STRUCTURED_WORTH
        best = min(weights, key=lambda way: weights[way])
        # F is unbounded near its singularities: there it is the one determinant of the minors that keeps its digits
        if entry.needs == PARTITION and "minors" in costs and costs["minors"] <= costs[best] * (1 + CANCELLATION_WORTH):
            best = "minors"
        # minors of rows that depend on each other become small together: multiplied out, their squares would cancel
        if generic.rank == generic.r and 0 < costs.get("minors", 0) <= FACTORING_LIMIT:
            chosen, kept = candidates["minors"], derivations["minors"].whole
            shorter = replace(chosen, outputs=mechanics.factoring.shorten(chosen.outputs, kept))
            costs["factored"] = cost(scalars(shorter)).weight
            # multiplied out, terms that vanish have cancelled exactly: worth a few operations more
            worth = 0 if name in MOTIONS else CANCELLATION_WORTH
            if costs["factored"] <= costs[best] * (1 + worth):
                candidates["factored"], best = shorter, "factored"
        quantities.append(candidates[best])
        form = BY_FRAMES if best == ARTICULATED else _form_along(along.get(best), name)
        choices.append(Choice(name, best, tuple(costs.items()), form))
    costs = {choice.quantity: dict(choice.costs)[choice.way] for choice in choices}
    if surplus := everything.surplus(costs):
        absent += [(name, too_long(costs[name])) for name in surplus]
        quantities = [one for one in quantities if one.name not in surplus]
        choices = [one for one in choices if one.quantity not in surplus]
    lengths = [len(reached(scalars(derived))) for derived in quantities]
    named_so = each("shortening", quantities, lambda derived: derived.name, lengths)
    grouped = tuple(finished(mechanics, generic, derived) for derived in named_so)
    if forms.get("inverse_dynamics", "auto") == "auto":
        grouped = tuple(_with_alike_bodies(model, derived) for derived in grouped)
    return Selection(mechanics, generic, grouped, tuple(choices), tuple(absent), chosen_form, tuple(named), methods)


def finished(mechanics: System, generic: Genericity, derived: Quantity) -> Quantity:
    """A quantity on the graph of `mechanics` as it is scheduled: complete, and numbers grouped."""
    return with_groups(mechanics, complete(mechanics, generic, derived))


def complete(mechanics: System, generic: Genericity, derived: Quantity) -> Quantity:
    """A quantity without entries that are 0 unseen, with ranks tested that other branches may exceed, told what its
    reader must know, rows in the units of the file."""
    outputs = without_hidden_zeros(derived.outputs)
    # what is locked is so where B has its rank, and results that are fixed may rest on that
    needless = is_fixed(outputs) and not (generic.locked and is_fixed(derived.outputs))
    derived = replace(derived, outputs=outputs, guards=() if needless else derived.guards)
    tested = with_test_of_excess(mechanics, generic, derived)
    tested = in_units_of_the_file(mechanics.graph, mechanics.model, tested)
    return _remarked(tested, generic)


def _with_alike_bodies(model: Model, derived: Quantity) -> Quantity:
    """u with what its bodies have in common, where there are bodies."""
    if derived.name != "inverse_dynamics" or not model.mechanism.has_mass:
        return derived
    from symgen.mechanics.alike import alike_bodies  # models given by energies start without it

    return replace(derived, alike=alike_bodies(model, derived.outputs))


def _remarked(derived: Quantity, generic: Genericity) -> Quantity:
    """What dependent rows leave open, or inputs cannot produce, is said where the quantity is called."""
    if derived.name == MOTIONS[1] and generic.rank < generic.r:
        which = f"not unique, as the constraints depend on each other (rank {generic.rank} of {generic.r})"
        return replace(derived, remark=f"{which}: these are the smallest; u and q̈ are not affected")
    if derived.name == "inverse_dynamics" and not generic.full_actuation:
        return replace(derived, remark=short_of_inputs(generic))
    return derived


def short_of_inputs(generic: Genericity) -> str:
    """What u is where inputs span fewer directions than the system has."""
    spans = f"the inputs span {generic.alpha} of {generic.delta} directions"
    return f"{spans}: of the motions that they cannot produce it is the part they can, see inverse_dynamics_residual"


def _named(mechanics: System, generic: Genericity, quantity: str, name: str) -> tuple[Quantity, MethodChoice]:
    """A form asked for by name on the graph of the other quantities; forms and their validity are rarely needed."""
    from symgen.methods.by_name import named_form

    found = named_form(mechanics.model, generic, quantity, name)
    if isinstance(found, str):
        raise NoSuchFormError(quantity, name, found)
    return moved(mechanics.graph, found.derived), found.choice


def _form_along(derivation: Derivation | None, quantity: str) -> str:
    """The form that q_ddot or lambda takes along a null space."""
    if derivation is None or quantity not in MOTIONS:
        return ""
    return (derivation.acceleration if quantity == MOTIONS[0] else derivation.reaction).name


def with_groups(mechanics: System, derived: Quantity) -> Quantity:
    """The quantity with numbers multiplied into groups of parameters, where that saves operations."""
    # with the scales of denominators, so that they go on sharing what they have in common with results
    scales = [guard.scale for guard in derived.guards if guard.scale is not None]
    mark = mechanics.graph.mark()
    regrouped = grouped_scalars(mechanics.graph, mechanics.factoring, [*scalars(derived), *scales])
    mechanics.factoring.forget(mark, regrouped)
    found = iter(regrouped)
    outputs = tuple(next(found) for _ in derived.outputs)
    denominators = [next(found) for _ in derived.guards]
    guards = tuple(
        replace(guard, denominator=denominator, scale=None if guard.scale is None else next(found))
        for guard, denominator in zip(derived.guards, denominators, strict=True)
    )
    return replace(derived, outputs=outputs, guards=guards)
