"""The other methods of a quantity, for when verification rejects the one that was taken: valid ones, by counted cost.

Each is derived on a graph of its own, so that it depends neither on what was derived before nor on what was rejected.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.methods.graphs import derived_on, forget_others
from symgen.methods.quantity import Quantity, scalars
from symgen.methods.selection import MethodChoice, Methods
from symgen.methods.spaces import SPACES
from symgen.methods.table import Use, methods
from symgen.model.model import Model
from symgen.model.quantities import MOTIONS
from symgen.quantities.candidates import ARTICULATED
from symgen.quantities.catalogue import BY_NAME, derive
from symgen.quantities.finish import complete, with_groups
from symgen.quantities.row_units import in_ordinary_units
from symgen.quantities.select import Choice
from symgen.records import dataclass
from symgen.runtime.effort import TooLongError, at_most, worth_trying
from symgen.symbolic.traverse import cost, reached

# Scalars of an alternative beyond which numbers are grouped only in what is taken: that is most of the work there.
LONG_ALTERNATIVE = 2_000
# Counted cost of a method beyond which refined ones and those of last resort are given up: they take as long as others.
LONGEST_OF_LAST_RESORT = 10_000
# How many times other methods are offered: valid ones, then those of last resort.
TIERS = 2


@dataclass(frozen=True, slots=True)
class Alternative:
    """A quantity by another method, on the graph of `mechanics`; `known` is what is known of its validity.

    A long one has its numbers `grouped` only once it is known to be of use.
    """

    choice: Choice
    mechanics: System
    derived: Quantity
    known: MethodChoice | None = None
    grouped: bool = True

    @property
    def cost(self) -> int:
        """Counted cost of a regular state, outputs and tested denominators."""
        return dict(self.choice.costs)[self.choice.title]


class Alternatives:
    """The methods of the quantities of one model; those of u that were `looked_at` already are not built again."""

    def __init__(self, model: Model, generic: Genericity, looked_at: Methods | None) -> None:
        self._model = in_ordinary_units(model)
        self._generic = generic
        self._methods = looked_at or Methods(self._model, generic)
        self.too_long: dict[str, list[str]] = defaultdict(list)

    def settle(self) -> None:
        """Lets go of what several quantities share; it is derived again where it is asked for."""
        self._methods.settle()

    def of(self, quantity: str, taken: Choice, tier: int) -> tuple[Alternative, ...]:
        """A quantity by the methods of a tier, but the one taken, that are valid at all regular states.

        The one that counts least comes first.  Methods that take much longer to derive than the one taken is are given
        up, and named in `too_long`; so are refined ones and those of last resort where that one is long itself.
        """
        same = taken.method if taken.title in ("minors", "householder", taken.method, ARTICULATED) else ""
        cost_taken = dict(taken.costs)[taken.title]
        names = _names(quantity, tier)
        if cost_taken > LONGEST_OF_LAST_RESORT:
            long = (Use.SPARE, Use.LAST) if quantity in MOTIONS else (Use.LAST,)
            given_up = [row.name for row in methods(quantity) if row.use in long and row.name in names]
            self.too_long[quantity] += given_up
            names = tuple(name for name in names if name not in given_up)
        most = worth_trying(cost_taken)
        alternatives = []
        for name in names:
            if name in (taken.title, same):
                continue
            try:
                with at_most(most):
                    one = self._named(quantity, name)
            except TooLongError:
                self.too_long[quantity].append(name)
                continue
            if one is not None:
                alternatives.append(one)
        return tuple(sorted(alternatives, key=lambda one: one.cost))

    def named(self, quantity: str, name: str) -> Alternative | None:
        """A quantity by the method of a name; None where the system does not have it."""
        one = self._named(quantity, name) if any(name in _names(quantity, tier) for tier in range(TIERS)) else None
        return None if one is None else grouped(one)

    def _named(self, quantity: str, name: str) -> Alternative | None:
        mechanics = System(self._model)
        if not _is_along_spaces(quantity):
            return self._by_method(quantity, name, mechanics)
        if name in SPACES:
            along = SPACES[name](mechanics, self._generic)
            derived = along if isinstance(along, str) else derive(BY_NAME[quantity], along)
        else:
            made = self._methods.candidate(quantity, name)
            derived = made if isinstance(made, str) else derived_on(mechanics.graph, made)
        if isinstance(derived, str):
            return None
        # counted alike along null spaces and by methods
        return self._alone(derived, Choice(quantity, name, ((name, cost(scalars(derived)).weight),)), mechanics)

    def _by_method(self, quantity: str, name: str, mechanics: System) -> Alternative | None:
        """u, q_ddot or lambda by a method that is nowhere singular."""
        candidate = self._methods.candidate(quantity, name)
        if isinstance(candidate, str):
            return None
        validity = self._methods.validity(candidate, first_only=True)
        if validity.singular:
            return None
        known = MethodChoice(name, validity, ((name, candidate.weight, validity.explanation),))
        choice = Choice(quantity, name, known.costs, name if quantity in MOTIONS else "")
        return self._alone(derived_on(mechanics.graph, candidate), choice, mechanics, known)

    def _alone(
        self, derived: Quantity, choice: Choice, mechanics: System, known: MethodChoice | None = None
    ) -> Alternative:
        """A quantity as it is scheduled, on a graph that holds nothing else any more."""
        made = complete(mechanics, self._generic, derived)
        alternative = Alternative(choice, mechanics, made, known, grouped=False)
        if len(reached(scalars(made))) > LONG_ALTERNATIVE:
            forget_others(mechanics, (made,))
            return alternative
        return grouped(alternative)


def grouped(one: Alternative) -> Alternative:
    """The same with its numbers grouped."""
    if one.grouped:
        return one
    made = with_groups(one.mechanics, one.derived)
    forget_others(one.mechanics, (made,))
    return replace(one, derived=made, grouped=True)


def _names(quantity: str, tier: int) -> tuple[str, ...]:
    """The methods of a tier by name: null spaces, and those that the table has."""
    spaces = tuple(SPACES) if tier == 0 and _is_along_spaces(quantity) else ()
    uses = (Use.CHOSEN, Use.SPARE) if tier == 0 else (Use.LAST,)
    return (*spaces, *(row.name for row in methods(quantity) if row.use in uses))


def _is_along_spaces(quantity: str) -> bool:
    return BY_NAME[quantity].outputs is not None
