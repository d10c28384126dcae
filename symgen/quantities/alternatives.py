"""The other ways to a quantity, for when verification rejects the one that was taken: valid ones, by counted cost.

Each is derived on a graph of its own, so that it depends neither on what was derived before nor on what was rejected.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace

from symgen.mechanics.genericity import Genericity
from symgen.mechanics.reflected_rows import reflected_rows
from symgen.mechanics.system import System
from symgen.methods.compared import MOTIONS, quantities_by
from symgen.methods.forward_dynamics.motions import BY_BODIES, BY_FRAMES
from symgen.methods.method import Candidate
from symgen.methods.quantity import Quantity, scalars
from symgen.methods.selection import MethodChoice, Methods, derived_on, moved
from symgen.methods.spaces import SPACES
from symgen.model.model import Model
from symgen.quantities.catalogue import BY_NAME, derive
from symgen.quantities.row_units import in_ordinary_units
from symgen.quantities.select import Choice, complete, with_groups
from symgen.records import dataclass
from symgen.runtime.effort import TooLongError, at_most, worth_trying
from symgen.symbolic.matrix import flatten
from symgen.symbolic.passes.forgetting import START
from symgen.symbolic.traverse import cost, reached

# Those of a tier come before any of the next.  The second ones square the condition of B, or are long.
INPUTS = (("elimination", "minor", "nullspace", "householder"), ("printed", "weighted", "kkt"))
MOTION = (("minor", "schur_qr", "nullspace", BY_FRAMES, BY_BODIES), ("schur_ldl", "shifted", "kkt"))
OTHERS = (("minors", "householder", "blocks"), ())
WEIGHTED = (("minors", "householder", "blocks", "schur_qr", BY_FRAMES), ())
# Scalars of a way beyond which numbers are grouped in what is taken only: that is most of the work there.
LONG = 6_000
ELIMINATIONS = ("schur_qr", BY_FRAMES)
TIERS = 2


@dataclass(frozen=True, slots=True)
class Alternative:
    """A quantity along another way, on the graph of `mechanics`; `form` is what is known of it where it is a form.

    A long one has its numbers `grouped` only once it is known to be of use.
    """

    choice: Choice
    mechanics: System
    derived: Quantity
    form: MethodChoice | None = None
    grouped: bool = True

    @property
    def cost(self) -> int:
        """Counted cost of a regular state, outputs and tested denominators."""
        return dict(self.choice.costs)[self.choice.way]


class Alternatives:
    """The ways to the quantities of one model; `methods` holds those of u that were looked at already."""

    def __init__(self, model: Model, generic: Genericity, methods: Methods | None) -> None:
        self._model = in_ordinary_units(model)
        self._generic = generic
        self._methods = methods
        self._motions: dict[str, tuple[System, tuple[Quantity, ...]]] = {}
        self.too_long: dict[str, list[str]] = defaultdict(list)

    def settle(self) -> None:
        """Lets go of what several quantities share; it is derived again where it is asked for."""
        self._motions.clear()

    def of(self, quantity: str, taken: Choice, tier: int) -> tuple[Alternative, ...]:
        """The ways of a tier to a quantity, but the one taken, that are valid at all regular states.

        The one that counts least comes first.  Ways that take much longer to derive than the one taken is are given
        up, and named in `too_long`.
        """
        same = taken.form if taken.way in ("minors", "householder", taken.form) else ""
        most = worth_trying(dict(taken.costs)[taken.way])
        found = []
        for name in _tiers(quantity)[tier]:
            if name in (taken.way, same):
                continue
            try:
                with at_most(most):
                    one = self._named(quantity, name)
            except TooLongError:
                self.too_long[quantity].append(name)
                continue
            if one is not None:
                found.append(one)
        return tuple(sorted(found, key=lambda one: one.cost))

    def named(self, quantity: str, name: str) -> Alternative | None:
        """One way to a quantity by its name; None where the system does not have it."""
        found = self._named(quantity, name) if any(name in tier for tier in _tiers(quantity)) else None
        return None if found is None else grouped(found)

    def _named(self, quantity: str, name: str) -> Alternative | None:
        if quantity == "inverse_dynamics":
            return self._of_inputs(name)
        if quantity in MOTIONS:
            return self._of_motion(quantity, name)
        return self._by_elimination(quantity, name) if name in ELIMINATIONS else self._along(quantity, name)

    def _of_inputs(self, name: str) -> Alternative | None:
        """A form of u that is nowhere singular."""
        if self._methods is None:
            self._methods = Methods(self._model, self._generic)
        candidate = self._methods.candidate("inverse_dynamics", name)
        if not isinstance(candidate, Candidate):
            return None
        found = self._methods.verdict(candidate, first_only=True)
        if found.singular:
            return None
        choice = MethodChoice(name, found, ((name, candidate.weight, found.explanation),))
        mechanics = System(self._model)
        return self._alone(derived_on(mechanics.graph, candidate), name, choice.costs, mechanics, choice)

    def _of_motion(self, quantity: str, name: str) -> Alternative | None:
        """A form of q_ddot or lambda that is valid wherever the motion is determined."""
        from symgen.methods.by_name import valid_form

        if name not in self._motions:
            found = self._motions[name] = quantities_by(self._model, self._generic, name)
            _forget_others(*found)
        form = valid_form(*self._motions[name], quantity, name)
        if form is None:
            return None
        mechanics = System(self._model)
        derived = moved(mechanics.graph, form.derived)
        return self._alone(derived, name, form.choice.costs, mechanics, form.choice, form=name)

    def _along(self, quantity: str, name: str) -> Alternative | None:
        """A quantity along a way to the null space."""
        mechanics = System(self._model)
        along = SPACES[name](mechanics, self._generic)
        if isinstance(along, str):
            return None
        derived = derive(BY_NAME[quantity], along)
        return self._alone(derived, name, ((name, cost(scalars(derived)).weight),), mechanics)

    def _by_elimination(self, quantity: str, name: str) -> Alternative | None:
        """A weighted projection as accelerations."""
        # few models need it
        from symgen.methods.forward_dynamics.weighted_projection import projection_of_bodies, weighted_projection

        by = weighted_projection if name == "schur_qr" else projection_of_bodies
        mechanics = System(self._model)
        space = reflected_rows(mechanics, self._generic)
        found = by(mechanics, self._generic, quantity, space.guards)
        if found is None:
            return None
        matrix, guards = found
        derived = Quantity(quantity, (len(matrix), len(matrix[0])), flatten(matrix), guards)
        return self._alone(derived, name, ((name, cost(scalars(derived)).weight),), mechanics)

    def _alone(
        self,
        derived: Quantity,
        way: str,
        costs: tuple[tuple[str, int], ...],
        mechanics: System,
        known: MethodChoice | None = None,
        form: str = "",
    ) -> Alternative:
        """A quantity as it is scheduled, on a graph that holds nothing else any more."""
        made = complete(mechanics, self._generic, derived)
        found = Alternative(Choice(derived.name, way, costs, form), mechanics, made, known, grouped=False)
        if len(reached(scalars(made))) > LONG:
            _forget_others(mechanics, (made,))
            return found
        return grouped(found)


def grouped(way: Alternative) -> Alternative:
    """A way with its numbers grouped."""
    if way.grouped:
        return way
    made = with_groups(way.mechanics, way.derived)
    _forget_others(way.mechanics, (made,))
    return replace(way, derived=made, grouped=True)


def _forget_others(mechanics: System, quantities: Sequence[Quantity]) -> None:
    """Lets the graph of quantities go of all that they do not hold: no others are derived there."""
    held = [*mechanics.q, *mechanics.qd, *mechanics.qdd, *mechanics.parameters, *mechanics.u]
    held += [output for derived in quantities for output in derived.outputs]
    guards = [guard for derived in quantities for guard in derived.guards]
    while guards:
        guard = guards.pop()
        held += [guard.denominator] if guard.scale is None else [guard.denominator, guard.scale]
        guards += guard.first
    mechanics.factoring.forget(START, held)


def _tiers(quantity: str) -> tuple[tuple[str, ...], ...]:
    if quantity == "inverse_dynamics":
        return INPUTS
    if quantity in MOTIONS:
        return MOTION
    return WEIGHTED if quantity in ("weighted_pseudoinverse", "weighted_nullspace_projector") else OTHERS
