"""The methods of one model, and the selection that all quantities share: of valid candidates the one that counts least.

Each is counted on a graph of its own; the chosen one is brought to the graph of the other quantities.  One that is not
cheaper than one already known to be valid is not examined.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from typing import TypeAlias

from symgen.mechanics.genericity import Genericity, genericity
from symgen.mechanics.system import System
from symgen.methods.admission import FAILS, Validity
from symgen.methods.driven_blocks import where_inputs_act
from symgen.methods.forward_dynamics.minor_motion import CANCELLATION_WORTH
from symgen.methods.graphs import derived_on
from symgen.methods.method import INPUTS, Candidate, solved_for_u
from symgen.methods.quantity import Quantity
from symgen.methods.system import MethodInput
from symgen.methods.table import METHODS, Use, method, methods
from symgen.methods.workspace import Workspace
from symgen.model.model import Model
from symgen.model.quantities import MOTIONS
from symgen.records import dataclass
from symgen.symbolic.scalar import Scalar

# Operations of outputs up to which they are multiplied out.
FACTORING_LIMIT = 450
# Share of operations more than the best method up to which u of the minor method is multiplied out to compete.
FACTORING_GAIN = Fraction(1, 3)
# Operations beyond which a method that is not taken is not derived only to say where it fails.
LONGEST_EXAMINED = 600
AUTO = "auto"
Weight: TypeAlias = Fraction | int | tuple[bool, Fraction]
FACTORED = "minor factored"


@dataclass(frozen=True, slots=True)
class MethodChoice:
    """The method taken, why it is valid or where it is not, and what is known of the others (name, cost, remark)."""

    name: str
    validity: Validity
    others: tuple[tuple[str, int, str], ...]

    @property
    def failed(self) -> tuple[tuple[str, str], ...]:
        """Cheaper methods that were examined and are singular at regular states, and where."""
        return tuple((name, remark) for name, _, remark in self.others if remark.startswith(FAILS))

    @property
    def costs(self) -> tuple[tuple[str, int], ...]:
        """Counted cost of every method that was derived."""
        return tuple((name, weight) for name, weight, _ in self.others)


class Methods:
    """The methods of one model, each built when it is first needed."""

    def __init__(self, model: Model, generic: Genericity) -> None:
        self.workspace = Workspace(model, generic)
        self._candidates: dict[tuple[str, str], Candidate | str] = {}
        self._validities: dict[tuple[str, str], Validity] = {}

    def candidate(self, quantity: str, name: str) -> Candidate | str:
        """A quantity by the method of a name, or why this system does not have it."""
        key = quantity, name
        if key not in self._candidates:
            made = method(quantity, name).build(self._workspace(quantity, name), quantity)
            self._candidates[key] = made if isinstance(made, str) else replace(made, method=name)
        return self._candidates[key]

    def validity(self, candidate: Candidate, first_only: bool = False) -> Validity:
        """Whether a candidate may be chosen by itself."""
        quantity, name = candidate.derived.name, candidate.method
        return method(quantity, name).validity(self._workspace(quantity, name), candidate, first_only)

    @cached_property
    def _of_inputs(self) -> Workspace:
        whole = self.workspace.relieved
        driven = where_inputs_act(whole.model, whole.generic)
        return whole if driven is None else Workspace(*driven)

    def _workspace(self, quantity: str, name: str) -> Workspace:
        """Of u without the rows and forces that it does not depend on; what is compared with it has all of them."""
        compared = any(row.name == name and row.use is Use.COMPARISON for row in methods(quantity))
        if compared:
            return self.workspace
        return self._of_inputs if quantity == INPUTS else self.workspace.of(quantity)

    def choose(self, quantity: str, name: str = AUTO) -> tuple[Candidate, MethodChoice] | str:
        """The method asked for, or the cheapest valid one; why there is none by that name."""
        if name == AUTO:
            return self._cheapest(quantity)
        candidate = self.candidate(quantity, name)
        if isinstance(candidate, str):
            return candidate
        validity = self.validity(candidate)
        return candidate, MethodChoice(name, validity, ((name, candidate.weight, validity.explanation),))

    def failing(self) -> tuple[tuple[str, str], ...]:
        """The methods of u among those that are chosen by themselves that fail at regular states, and where each does.

        None of them is derived to be told of where all are long.
        """
        rows = methods(INPUTS, Use.CHOSEN)
        bounds = [bound for row in rows if (bound := row.load().least_cost(self._counted))]
        if min(bounds, default=0) > LONGEST_EXAMINED:
            return ()
        made = [one for row in rows if isinstance(one := self.candidate(INPUTS, row.name), Candidate)]
        validities = [(one.method, self.validity(one)) for one in made if not self._is_admitted(one)]
        return tuple((name, validity.explanation) for name, validity in validities if not validity.admitted)

    def _is_admitted(self, candidate: Candidate) -> bool:
        """Whether it was found valid already."""
        key = candidate.derived.name, candidate.title
        return key in self._validities and self._validities[key].admitted

    def compared(self, quantity: str, taken: str) -> MethodChoice | None:
        """Every method of a quantity by counted cost, with `taken` as the name of the one taken; None without any."""
        made = [one for row in methods(quantity) if isinstance(one := self.candidate(quantity, row.name), Candidate)]
        if not made:
            return None
        known = sorted((one.weight, one.method, self.validity(one)) for one in made)
        chosen = next((validity for _, name, validity in known if name == taken), known[0][2])
        return MethodChoice(taken, chosen, tuple((name, weight, one.explanation) for weight, name, one in known))

    def settle(self) -> None:
        """Lets go of what several quantities share; it is derived again where it is asked for."""
        self.workspace.motions.clear()
        self.workspace.relieved.motions.clear()
        self.workspace.weightless.motions.clear()
        self._candidates = {key: one for key, one in self._candidates.items() if key[0] == INPUTS}

    def _cheapest(self, quantity: str) -> tuple[Candidate, MethodChoice] | str:
        made = self._built(quantity)
        if not made:
            return "this system has none of the methods that are chosen by themselves"
        taken = select(made.values(), self._first_validity, lambda one: one.weight, self._factored)
        weights, best = taken.costs, taken.candidate
        remarks = dict.fromkeys(made, "not examined, because it is not cheaper")
        remarks |= {name: validity.explanation for name, validity in taken.validities.items()}
        others = tuple((name, weights[name], remarks[name]) for name in sorted(weights, key=lambda n: (weights[n], n)))
        return best, MethodChoice(best.title, taken.validities[best.title], others)

    def _built(self, quantity: str) -> dict[str, Candidate]:
        """The methods that may be the cheapest: those that cannot fall below a valid first one are not derived.

        The last is derived only where it may fall below all others.
        """
        made: dict[str, Candidate] = {}
        limit: int | None = None
        first, *between, last = methods(quantity, Use.CHOSEN)
        for row in (first, *between):
            if limit is not None and row.load().least_cost(self._counted) > limit:
                continue
            one = self.candidate(quantity, row.name)
            if isinstance(one, str):
                continue
            made[row.name] = one
            if row is first and self._first_validity(one).admitted:
                limit = max(one.weight, _factoring_limit(one))
        if not made or last.load().least_cost(self._counted) < min(one.weight for one in made.values()):
            one = self.candidate(quantity, last.name)
            if isinstance(one, Candidate):
                made[last.name] = one
        return made

    def _first_validity(self, candidate: Candidate) -> Validity:
        """That of a method by name, decided once."""
        key = candidate.derived.name, candidate.title
        if key not in self._validities:
            self._validities[key] = self.validity(candidate, first_only=True)
        return self._validities[key]

    def _factored(self, best: Candidate) -> Candidate | None:
        """u of the minor method multiplied out and factored, where it is short enough to compete.

        Minors of rows that depend on each other become small together: multiplied out, their squares would cancel.
        The other methods have nothing to cancel that their steps have left, nor has what is chosen among limits, nor a
        fixed point of friction.
        """
        if best.derived.name != INPUTS:
            return None
        model = self.workspace.model
        if model.keeps_limits or model.rough or (model.allocation is not None and model.allocation.scale):
            return None
        generic, minor = self._of_inputs.generic, self._candidates.get((INPUTS, "minor"), "")
        if generic.rank < generic.r or isinstance(minor, str) or not 0 < minor.weight <= _factoring_limit(best):
            return None
        along = self._of_inputs.minor
        kept = frozenset[Scalar]() if isinstance(along, str) else along.whole_for_inputs
        outputs = minor.system.mechanics.factoring.shorten(minor.derived.outputs, kept)
        return replace(solved_for_u(minor.system, outputs, minor.derived.guards), method="minor", along=FACTORED)

    @cached_property
    def _counted(self) -> MethodInput:
        """The system whose expressions bounds of costs are counted on: one that is at hand."""
        at_hand = (one.system for one in self._candidates.values() if isinstance(one, Candidate))
        return next(at_hand, None) or MethodInput.fresh(self.workspace.model, self.workspace.generic)


@dataclass(frozen=True, slots=True)
class Selected:
    """The candidate that is taken; by title, the counted cost of each and the validity of those that were examined."""

    candidate: Candidate
    costs: Mapping[str, int]
    validities: Mapping[str, Validity]


def select(
    candidates: Iterable[Candidate],
    validity: Callable[[Candidate], Validity],
    counted: Callable[[Candidate], int],
    factored: Callable[[Candidate], Candidate | None],
    weight: Callable[[Candidate], Weight] | None = None,
) -> Selected:
    """The valid candidate of least counted cost, or of least `weight` where that is something else.

    `factored` is what competes with the best one: the same by minors, multiplied out and factored.
    """
    made = tuple(candidates)
    best, validities = cheapest(made, validity, weight or counted)
    costs = {one.title: counted(one) for one in made}
    shorter = factored(best)
    if shorter is not None:
        costs[shorter.title] = counted(shorter)
        validities[shorter.title] = validity(shorter)
        # multiplied out, terms that vanish have cancelled exactly: worth a few operations more, but than other methods,
        # and than q_ddot and lambda, whose masses do not cancel
        cancels = best.method in ("", "minor") and best.derived.name not in MOTIONS
        most = costs[best.title] * (1 + CANCELLATION_WORTH * cancels)
        if validities[shorter.title].admitted and costs[shorter.title] < most:
            best = shorter
    return Selected(best, costs, validities)


def cheapest(
    candidates: Iterable[Candidate], validity: Callable[[Candidate], Validity], weight: Callable[[Candidate], Weight]
) -> tuple[Candidate, dict[str, Validity]]:
    """The valid candidate of least weight, with the validity of it and of those before it; the first of equals.

    In double precision one whose denominators are lost in single precision may do; a status where it is singular is
    told, and better than nothing at all.
    """
    order = sorted(candidates, key=weight)
    validities: dict[str, Validity] = {}
    for one in order:
        validities[one.title] = validity(one)
        if validities[one.title].admitted:
            return one, validities
    return next((one for one in order if validities[one.title].lost), order[0]), validities


def _factoring_limit(best: Candidate) -> int:
    """The cost up to which u of the minor method is multiplied out to compete with the best."""
    return min(FACTORING_LIMIT, int(best.weight * (1 + FACTORING_GAIN)))


def every_method(model: Model, quantities: Iterable[str]) -> list[tuple[str, System, list[Quantity]]]:
    """Every method that a system has by name: what it was derived on, and the quantities there."""
    made = Methods(model, genericity(System(model)))
    by_method: list[tuple[str, System, list[Quantity]]] = []
    for row, quantity in ((row, quantity) for row in METHODS for quantity in quantities if quantity in row.quantities):
        one = made.candidate(quantity, row.name)
        if isinstance(one, str):
            continue
        mechanics = one.system.mechanics
        if not by_method or by_method[-1][1] is not mechanics:
            by_method.append((row.name, mechanics, []))
        by_method[-1][2].append(derived_on(mechanics.graph, one))
    return by_method
