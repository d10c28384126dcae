"""The other ways to a quantity, for when verification rejects the one that was taken: valid ones, by counted cost.

Each is derived on a graph of its own, so that it depends neither on what was derived before nor on what was rejected.
"""

from __future__ import annotations

from symgen.dynamics.catalogue import BY_NAME, Derived, derive, scalars
from symgen.dynamics.compared import MOTIONS
from symgen.dynamics.forms.form import FORM_NAMES
from symgen.dynamics.forms.motions import BY_FRAMES, MOTION_NAMES
from symgen.dynamics.genericity import Genericity
from symgen.dynamics.inverse import FormChoice, InverseDynamics, Offer, derived_on, moved
from symgen.dynamics.mechanics import Mechanics
from symgen.dynamics.select import Choice, block_way, finished, ways
from symgen.graph.traverse import cost
from symgen.model.model import Model
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class Alternative:
    """A quantity along another way, on the graph of `mechanics`; `form` is what is known of it where it is a form."""

    choice: Choice
    mechanics: Mechanics
    derived: Derived
    form: FormChoice | None = None

    @property
    def cost(self) -> int:
        """Counted cost of a regular state, outputs and tested denominators."""
        return dict(self.choice.costs)[self.choice.way]


def alternatives(
    model: Model, generic: Genericity, inverse: InverseDynamics | None, quantity: str
) -> tuple[Alternative, ...]:
    """Every way to a quantity that is valid at all regular states, the one that counts least first.

    `inverse` holds the forms of u that were looked at already.
    """
    named = (_named(model, generic, inverse, quantity, name) for name in names(quantity))
    return tuple(sorted((one for one in named if one is not None), key=lambda one: one.cost))


def alternative(
    model: Model, generic: Genericity, inverse: InverseDynamics | None, quantity: str, name: str
) -> Alternative | None:
    """One way to a quantity by its name; None where the system does not have it."""
    return _named(model, generic, inverse, quantity, name) if name in names(quantity) else None


def names(quantity: str) -> tuple[str, ...]:
    """The names of the ways to a quantity."""
    if quantity == "inverse_dynamics":
        return FORM_NAMES
    return (*MOTION_NAMES, BY_FRAMES) if quantity in MOTIONS else ("minors", "householder", "blocks")


def _named(
    model: Model, generic: Genericity, inverse: InverseDynamics | None, quantity: str, name: str
) -> Alternative | None:
    if quantity == "inverse_dynamics":
        return _of_inputs(model, generic, inverse or InverseDynamics(model, generic), name)
    return (_of_motion if quantity in MOTIONS else _along)(model, generic, quantity, name)


def _of_inputs(model: Model, generic: Genericity, inverse: InverseDynamics, name: str) -> Alternative | None:
    """A form of u that is nowhere singular."""
    offer = inverse.offer(name)
    if not isinstance(offer, Offer):
        return None
    found = inverse.verdict(offer, first_only=True)
    if found.singular:
        return None
    choice = FormChoice(name, found, ((name, offer.form.weight, found.explanation),))
    mechanics = Mechanics(model)
    derived = finished(mechanics, generic, derived_on(mechanics.graph, offer))
    return Alternative(Choice(derived.name, name, choice.costs), mechanics, derived, choice)


def _of_motion(model: Model, generic: Genericity, quantity: str, name: str) -> Alternative | None:
    """A form of q_ddot or lambda that is valid wherever the motion is determined."""
    from symgen.dynamics.by_name import NamedForm, named_form

    form = named_form(model, generic, quantity, name)
    if not isinstance(form, NamedForm) or not form.verdict.admitted:
        return None
    mechanics = Mechanics(model)
    derived = finished(mechanics, generic, moved(mechanics.graph, form.derived))
    return Alternative(Choice(quantity, name, form.choice.costs, name), mechanics, derived, form.choice)


def _along(model: Model, generic: Genericity, quantity: str, name: str) -> Alternative | None:
    """A quantity along a way to the null space."""
    mechanics = Mechanics(model)
    along = {**ways(mechanics, generic), "blocks": block_way(mechanics, generic)}.get(name)
    if along is None:
        return None
    derived = derive(BY_NAME[quantity], along)
    costs = ((name, cost(scalars(derived)).weight),)
    return Alternative(Choice(quantity, name, costs), mechanics, finished(mechanics, generic, derived))
