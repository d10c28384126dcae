"""The inverse dynamics u along the cheapest admitted form, or along the form that is asked for.

Forms are counted on graphs of their own; the chosen one is brought to the graph of the other quantities.  A form that
is not cheaper than one already admitted is not examined.  Chosen by themselves are elimination, minor, nullspace and
householder; the others work on whole matrices and are there to be asked for.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cached_property

from symgen.linear_algebra.guards import Guard
from symgen.mechanics.absolute_angles import absolute_angles
from symgen.mechanics.genericity import Genericity, configurations, genericity
from symgen.mechanics.system import System
from symgen.methods.admission import FAILS, Verdict, proof_for, verdict
from symgen.methods.derivation import Derivation
from symgen.methods.form import FORM_NAMES, Method, form
from symgen.methods.inverse_dynamics.by_space import form_along, householder_derivation, minor_derivation
from symgen.methods.inverse_dynamics.estimates import least_costs
from symgen.methods.inverse_dynamics.forces_eliminated import elimination_form
from symgen.methods.inverse_dynamics.nullspace import nullspace_form
from symgen.methods.inverse_dynamics.printed import printed_form
from symgen.methods.inverse_dynamics.weighted import kkt_form, weighted_form
from symgen.methods.quantity import Quantity
from symgen.methods.system import MethodInput
from symgen.model.model import Model
from symgen.records import dataclass
from symgen.symbolic.scalar import Graph, Scalar
from symgen.symbolic.transplant import transplanted
from symgen.symbolic.traverse import cost
from symgen.validity.resolution import stands_out

AUTOMATIC = ("elimination", "minor", "nullspace", "householder")
# Longer outputs are not multiplied out; multiplied out, terms that vanish have cancelled exactly, which is worth a few
# operations more where minors were summed.
FACTORING_LIMIT = 450
CANCELLATION_WORTH = Fraction(1, 4)
FACTORING_GAIN = Fraction(1, 3)
# Parameters are regrouped where that takes a twentieth off: they are computed at each call.
LUMPING_GAIN = Fraction(1, 20)
RESOLVED_AT = 2
# Forms that are not taken and count more than this are not derived only to say where they fail.
LONGEST_EXAMINED = 600


@dataclass(frozen=True, slots=True)
class Offer:
    """A form with the system it was derived on; `way` tells whether it was multiplied out."""

    way: str
    system: MethodInput
    form: Method


@dataclass(frozen=True, slots=True)
class MethodChoice:
    """The form u takes, why it is valid or where it is not, and what is known of the others (name, cost, remark)."""

    way: str
    verdict: Verdict
    others: tuple[tuple[str, int, str], ...]

    @property
    def failed(self) -> tuple[tuple[str, str], ...]:
        """Cheaper forms that were examined and are singular at regular states, and where."""
        return tuple((name, remark) for name, _, remark in self.others if remark.startswith(FAILS))

    @property
    def costs(self) -> tuple[tuple[str, int], ...]:
        """Counted cost of every form that was derived."""
        return tuple((name, weight) for name, weight, _ in self.others)


class InverseDynamics:
    """The forms of u of one model, each built when it is first needed."""

    def __init__(self, model: Model, generic: Genericity) -> None:
        self._model = model
        self._generic = generic
        self._offers: dict[str, Offer | str] = {}
        self._verdicts: dict[str, Verdict] = {}

    @cached_property
    def minor(self) -> Derivation | str:
        """The derivation along minors, which also tells where ranks drop."""
        return minor_derivation(MethodInput.fresh(self._model, self._generic, self._lumped))

    @cached_property
    def _lumped(self) -> bool:
        """Whether the motion equations of the bodies are shorter with their parameters regrouped."""
        if not self._model.mechanism.has_mass:
            return False
        apart, together = (cost(System(self._model, lumped=lumped).balance).weight for lumped in (False, True))
        return together <= apart * (1 - LUMPING_GAIN)

    def offer(self, name: str) -> Offer | str:
        """A form by name, or why this system does not have it."""
        if name not in self._offers:
            derivation = self.minor if name == "minor" else None
            if isinstance(derivation, Derivation):
                system = MethodInput(derivation.mechanics, self._generic)
            else:
                system = MethodInput.fresh(self._model, self._generic, self._lumped)
            if name == "elimination":
                system = self._in_body_axes(system)
            made = _BUILDERS[name](self, system)
            self._offers[name] = made if isinstance(made, str) else Offer(name, system, made)
        return self._offers[name]

    def _in_body_axes(self, system: MethodInput) -> MethodInput:
        """The system with the twists of free bodies for rates, where its equations count less that way."""
        if not self._model.mechanism.has_mass:
            return system
        from symgen.mechanics.free_bodies import free_bodies  # models given by energies start without it

        if not free_bodies(system.mechanics):
            return system
        from symgen.mechanics.body_axes import BodyAxes

        turned = MethodInput(BodyAxes(self._model, self._lumped), self._generic)
        return turned if cost(turned.given).weight < cost(system.given).weight else system

    def verdict(self, offer: Offer, first_only: bool = False) -> Verdict:
        """Whether the form may be chosen by itself."""
        found = verdict(offer.system, offer.form, self._measures(offer), first_only)
        if found.admitted and offer.form.guards and not stands_out(offer.form.guards, self._generic.n, self._points):
            return replace(found, lost=True)
        return found

    def choose(self, name: str = "auto") -> tuple[Offer, MethodChoice] | str:
        """The form asked for, or the cheapest admitted one; why there is none by that name."""
        if name != "auto":
            offer = self.offer(name)
            if isinstance(offer, str):
                return offer
            found = self.verdict(offer)
            return offer, MethodChoice(offer.way, found, ((offer.way, offer.form.weight, found.explanation),))
        return self._cheapest()

    def failing(self) -> tuple[tuple[str, str], ...]:
        """The forms among those that are chosen by themselves that fail at regular states, and where each does.

        None of them is derived to be told of where all are long.
        """
        if min(self._least_costs.values()) > LONGEST_EXAMINED:
            return ()
        offers = [offer for name in AUTOMATIC if isinstance(offer := self.offer(name), Offer)]
        verdicts = [(offer.way, self.verdict(offer)) for offer in offers if not self._is_admitted(offer)]
        return tuple((way, found.explanation) for way, found in verdicts if not found.admitted)

    def _is_admitted(self, offer: Offer) -> bool:
        """Whether the form was found valid already."""
        return offer.way in self._verdicts and self._verdicts[offer.way].admitted

    def _cheapest(self) -> tuple[Offer, MethodChoice] | str:
        offers = self._built()
        weights = {name: offer.form.weight for name, offer in offers.items()}
        remarks: dict[str, str] = {}
        verdicts: dict[str, Verdict] = {}
        chosen: str | None = None
        for name in sorted(offers, key=lambda name: (weights[name], AUTOMATIC.index(name))):
            if chosen is not None:
                remarks[name] = "not examined, because it is not cheaper"
                continue
            found = verdicts[name] = self._first_verdict(offers[name])
            remarks[name] = found.explanation
            if found.admitted:
                chosen = name
        if chosen is None:
            # in double precision a form whose denominators are lost in float32 may do
            lost = (name for name in verdicts if verdicts[name].lost)
            chosen = next(lost, None)
        if chosen is None:
            if not offers:
                return "this system has none of the forms that are chosen by themselves"
            # a status where it is singular is told, and better than no u at all
            chosen = min(verdicts, key=lambda name: weights[name])
        best = offers[chosen]
        shorter = self._factored(best) if "minor" in offers else None
        if shorter is not None:
            weights[shorter.way] = weight = shorter.form.weight
            found = verdicts[shorter.way] = self.verdict(shorter, first_only=True)
            remarks[shorter.way] = found.explanation
            worth = CANCELLATION_WORTH if chosen == "minor" else 0
            if found.admitted and weight < weights[chosen] * (1 + worth):
                best = shorter
        others = tuple((name, weights[name], remarks[name]) for name in sorted(weights, key=lambda n: (weights[n], n)))
        return best, MethodChoice(best.way, verdicts[best.way], others)

    def _built(self) -> dict[str, Offer]:
        """The forms that may be the cheapest: those that cannot fall below an admitted elimination are not derived."""
        offers: dict[str, Offer] = {}
        limit: int | None = None
        for name in AUTOMATIC[:-1]:
            if limit is not None and self._least_costs[name] > limit:
                continue
            offer = self.offer(name)
            if isinstance(offer, str):
                continue
            offers[name] = offer
            if name == "elimination" and self._first_verdict(offer).admitted:
                limit = max(offer.form.weight, _factoring_limit(offer))
        last = AUTOMATIC[-1]
        if not offers or self._least_costs[last] < min(offer.form.weight for offer in offers.values()):
            householder = self.offer(last)
            if isinstance(householder, Offer):
                offers[last] = householder
        return offers

    def _first_verdict(self, offer: Offer) -> Verdict:
        """The verdict on a form by name, decided once."""
        if offer.way not in self._verdicts:
            self._verdicts[offer.way] = self.verdict(offer, first_only=True)
        return self._verdicts[offer.way]

    def _factored(self, best: Offer) -> Offer | None:
        """The minor form multiplied out and factored, where it is short enough to compete.

        Minors of rows that depend on each other become small together: multiplied out, their squares would cancel.
        The other forms have nothing to cancel that their steps have left.
        """
        minor = self.offer("minor")
        limit = _factoring_limit(best)
        if self._generic.rank < self._generic.r or isinstance(minor, str) or not 0 < minor.form.weight <= limit:
            return None
        kept = frozenset[Scalar]() if isinstance(self.minor, str) else self.minor.whole_for_inputs
        system = minor.system
        outputs = system.mechanics.factoring.shorten(minor.form.outputs, kept)
        made = form(minor.form.name, minor.form.quantity, outputs, minor.form.guards, system.given)
        return Offer("minor factored", system, made)

    @cached_property
    def _points(self) -> list[dict[str, float]]:
        """Configurations on V at which denominators are looked at."""
        return configurations(System(self._model), RESOLVED_AT)

    @cached_property
    def _least_costs(self) -> dict[str, int]:
        offer = next((offer for offer in self._offers.values() if isinstance(offer, Offer)), None)
        mechanics = System(self._model) if offer is None else offer.system.mechanics
        return least_costs(mechanics, self._generic)

    @property
    def minor_measures(self) -> list[Scalar]:
        """Determinants that vanish only where a rank drops."""
        return [] if isinstance(self.minor, str) else _denominators(self.minor)

    def _measures(self, offer: Offer) -> list[Scalar]:
        """Denominators that vanish only where a rank drops, by theorem: minors, pivots of reflections, or else the
        rest that the elimination's invertible steps leave."""
        found = self.minor_measures
        if offer.form.name == "householder":
            derivation = householder_derivation(offer.system)
            return [*found, *([] if isinstance(derivation, str) else _denominators(derivation))]
        if not found and offer.form.name == "elimination":
            return [guard.denominator for guard in offer.form.guards]
        return found


def _factoring_limit(best: Offer) -> int:
    """The cost up to which the minor form is multiplied out to compete with the best."""
    return min(FACTORING_LIMIT, int(best.form.weight * (1 + FACTORING_GAIN)))


def _denominators(derivation: Derivation) -> list[Scalar]:
    return [guard.denominator for guard in (*derivation.actuation_guards, *derivation.space.guards)]


def _nullspace(forms: InverseDynamics, system: MethodInput) -> Method | str:
    return nullspace_form(system, proof_for(system, forms.minor_measures).shown)


def _elimination(_: InverseDynamics, system: MethodInput) -> Method | str:
    if system.driven is not None:
        return system.driven
    made = elimination_form(_in_absolute_angles(system.mechanics), system.generic)
    return "its steps leave more than a few rows, or M does not select rows" if made is None else made


def _in_absolute_angles(mechanics: System) -> System:
    """The system in absolute angles, where it has relative ones and its rates are those of the coordinates."""
    if not mechanics.twist_determinant.is_one:
        return mechanics
    change = absolute_angles(mechanics.graph, mechanics.q, mechanics.constraint_jacobian)
    return mechanics if change.is_identity else System(mechanics.model, mechanics, change, mechanics.lumped)


_BUILDERS: dict[str, Callable[[InverseDynamics, MethodInput], Method | str]] = {
    "minor": lambda forms, system: form_along(system, "minor", forms.minor),
    "nullspace": _nullspace,
    "elimination": _elimination,
    "householder": lambda _, system: form_along(system, "householder", householder_derivation(system)),
    "printed": lambda _, system: printed_form(system),
    "weighted": lambda _, system: weighted_form(system),
    "kkt": lambda _, system: kkt_form(system),
}
assert tuple(_BUILDERS) == FORM_NAMES


def derived_on(graph: Graph, offer: Offer) -> Quantity:
    """The form as a quantity on the graph of the other quantities."""
    outputs, guards = offer.form.outputs, offer.form.guards
    if all(output.constant is not None for output in outputs):
        guards = ()  # a status is decided on what the result depends on: here on nothing
    return moved(graph, Quantity(offer.form.quantity, (len(outputs),), outputs, guards))


def moved(graph: Graph, derived: Quantity) -> Quantity:
    """A quantity on another graph."""
    there = Moved(graph)
    return replace(derived, outputs=there.scalars(derived.outputs), guards=there.guards(derived.guards))


class Moved:
    """Guards and scalars on another graph; equal guards stay equal."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph

    def scalars(self, given: tuple[Scalar, ...]) -> tuple[Scalar, ...]:
        """The scalars on the other graph."""
        return tuple(transplanted(self._graph, given))

    def guards(self, given: tuple[Guard, ...]) -> tuple[Guard, ...]:
        """The guards with all their scalars on the other graph."""
        return tuple(map(self._guard, given))

    def _guard(self, guard: Guard) -> Guard:
        (denominator,) = self.scalars((guard.denominator,))
        scale = None if guard.scale is None else self.scalars((guard.scale,))[0]
        return replace(guard, denominator=denominator, scale=scale, first=self.guards(guard.first))


def forms_of(model: Model) -> dict[str, tuple[System, Quantity]]:
    """Every form of u this system has, by name: the mechanics it was derived on, and the quantity on their graph."""
    forms = InverseDynamics(model, genericity(System(model)))
    offers = {name: offer for name in FORM_NAMES if isinstance(offer := forms.offer(name), Offer)}
    return {
        name: (offer.system.mechanics, derived_on(offer.system.mechanics.graph, offer))
        for name, offer in offers.items()
    }
