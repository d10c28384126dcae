"""The candidates for a quantity beside the others: along null spaces on their graph, and by methods that need none."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import nullcontext, suppress
from dataclasses import replace
from fractions import Fraction
from functools import partial

from symgen.mechanics.genericity import Genericity
from symgen.mechanics.reflected_rows import reflected_rows
from symgen.mechanics.system import System
from symgen.methods.admission import Validity
from symgen.methods.derivation import Derivation
from symgen.methods.derivatives.differentiated import FUNCTIONS, derivatives
from symgen.methods.forward_dynamics.absolute import brought_back, in_absolute_angles
from symgen.methods.forward_dynamics.minor_motion import CANCELLATION_WORTH, LARGEST_DELTA
from symgen.methods.forward_dynamics.motion import Motion
from symgen.methods.forward_dynamics.motions import BY_FRAMES, cost_factor, motions_alone, motions_along
from symgen.methods.graphs import derived_on, moved
from symgen.methods.method import INPUTS, Candidate, counted_weight
from symgen.methods.quantity import scalars
from symgen.methods.selection import FACTORING_LIMIT, Methods, cheapest, select
from symgen.methods.spaces import derivations
from symgen.methods.system import MethodInput
from symgen.methods.table import Use
from symgen.methods.table import methods as methods_of
from symgen.model.quantities import MAIN, MOTIONS, PARTITION, TASK_OPEN, TASK_RATES
from symgen.quantities.catalogue import BY_NAME, CatalogueEntry, by_blocks, derive, derived_from, sizes
from symgen.quantities.everything import WorkBudget
from symgen.quantities.moving_axes import in_moving_axes
from symgen.runtime.activity import working
from symgen.runtime.effort import TooLongError, at_most, worth_trying
from symgen.symbolic.traverse import cost

ABSOLUTE = "householder in absolute angles"
# What derivation.json calls methods that need no null space.
ARTICULATED = "articulated inertias"
TITLES = {BY_FRAMES: ARTICULATED}
MOST_WORTH = 1 + CANCELLATION_WORTH
VALID = Validity(0, 0, (), "along null spaces only ranks are divided by")


class Candidates:
    """The candidates for the quantities of a model; `asked` are those for which no method is named."""

    def __init__(self, mechanics: System, methods: Methods, everything: WorkBudget, asked: Sequence[str]) -> None:
        model, generic = mechanics.model, methods.workspace.generic
        self._mechanics, self._generic = mechanics, generic
        self._system = MethodInput(mechanics, generic)
        self._methods, self._everything = methods, everything
        self._spaces = {methods.workspace: _NullSpaces(mechanics, generic)}
        wanted = {*asked, *(FUNCTIONS[name] for name in asked if name in FUNCTIONS)}
        moving = [name for name in MOTIONS if name in wanted]
        with working("articulated inertias"):
            self._alone = {name: self._without_null_space(name) for name in moving}
        if moving and not any(self._alone.values()) and not model.rough:
            for name in moving:
                self._along_spaces(name).look_for_absolute_angles()
        self._motions: dict[Derivation, dict[str, Motion]] = {}

    def cheapest(self, entry: CatalogueEntry) -> tuple[Candidate, Mapping[str, int]] | None:
        """The one that is taken, and the counted cost of all by title; None where each takes too long."""
        # first, because beside nodes that others are made of, equal functions would take their place
        made = self._differentiated(entry, FUNCTIONS[entry.name]) if entry.name in FUNCTIONS else {}
        made = self._of(entry, min(map(_counted, made.values()), default=None)) | made
        if not made:
            return None
        minors = made.get("minors")
        taken = select(
            made.values(),
            self._validity,
            _counted,
            lambda best: None if minors is None else self._factored(minors, best),
            # F is unbounded near its singularities: there it is the one determinant of the minors that keeps its digits
            lambda one: self._weight(one) / (MOST_WORTH if entry.needs == PARTITION and one is minors else 1),
        )
        return taken.candidate, taken.costs

    def _of(self, entry: CatalogueEntry, known: int | None) -> dict[str, Candidate]:
        """By methods and along null spaces, beside one of `known` cost if there is any."""
        alone = self._alone.get(entry.name) or self._by_methods(entry.name, known)
        if entry.outputs is None and entry.name not in MOTIONS:
            return self._brought(alone)
        # where minors are not listed, no other method is derived to be counted: they grow faster than these
        if alone and self._generic.r > 0 and self._generic.delta > LARGEST_DELTA:
            return self._brought(alone)
        spaces = self._along_spaces(entry.name)
        if entry.name in MOTIONS and spaces.absolute is not None:
            one = self._along(entry, ABSOLUTE, spaces.absolute)
            back = brought_back(self._mechanics.graph, spaces.absolute.mechanics, one.derived)
            return {ABSOLUTE: replace(one, derived=back)}
        along = {
            space: partial(self._along, entry, space, derivation)
            for space, derivation in spaces.derivations.items()
            if space != "blocks" or by_blocks(entry)
        }
        # a tree has articulated inertias; what goes without them may take as long as they are worth, and no longer
        least = min(map(_counted, alone.values()), default=None)
        return {**self._everything.derived(entry.name, along, least), **self._brought(alone)}

    def _along_spaces(self, quantity: str) -> _NullSpaces:
        """What a quantity is derived along: without the forces that it does not depend on."""
        workspace = self._methods.workspace.of(quantity)
        if workspace not in self._spaces:
            self._spaces[workspace] = _NullSpaces(System(workspace.model), self._generic)
        return self._spaces[workspace]

    def _along(self, entry: CatalogueEntry, space: str, derivation: Derivation) -> Candidate:
        """A quantity along a null space, q_ddot and lambda by the method that counts least there."""
        if entry.name not in MOTIONS:
            return self._here(Candidate(self._system, derive(entry, derivation), along=space), derivation)
        if derivation not in self._motions:
            self._motions[derivation] = motions_along(derivation)
        made = [self._moving(entry, name, derivation, one) for name, one in self._motions[derivation].items()]
        # a basis is normwise accurate in the units that B is given in, and loses what masses and lengths are apart by:
        # it is left for systems in which G is definite along the constraints only
        best, _ = cheapest(made, self._validity, lambda one: (one.method == "nullspace", self._weight(one)))
        return self._here(replace(best, along=space), derivation)

    def _here(self, one: Candidate, derivation: Derivation) -> Candidate:
        """On the graph of the other quantities, but for what is brought back from other coordinates."""
        elsewhere = derivation.graph is not self._mechanics.graph and derivation.mechanics.change is None
        return replace(one, derived=moved(self._mechanics.graph, one.derived)) if elsewhere else one

    def _moving(self, entry: CatalogueEntry, name: str, derivation: Derivation, motion: Motion) -> Candidate:
        derived = derived_from(entry, derivation, motion.part(entry.name), lambda _: motion.guards)
        return Candidate(self._system, derived, method=name)

    def _differentiated(self, entry: CatalogueEntry, quantity: str) -> dict[str, Candidate]:
        """The derivatives of a quantity by the method that it takes itself."""
        graph, seen = self._mechanics.graph, self._mechanics
        if quantity == INPUTS:
            chosen = self._methods.choose(quantity)
            one = None if isinstance(chosen, str) else replace(chosen[0], derived=derived_on(graph, chosen[0]))
        else:
            best = self.cheapest(BY_NAME[quantity])
            one = None if best is None else best[0]
        if one is None:
            return {}
        outputs = derivatives(seen, entry.name, one.derived.outputs, swept=True)
        shape = entry.shape(sizes(seen.model, self._generic))
        derived = replace(one.derived, name=entry.name, shape=shape, outputs=outputs)
        return {one.title: Candidate(self._system, derived, along=one.title)}

    def _without_null_space(self, quantity: str) -> dict[str, Candidate]:
        """By methods that need none.

        Where rows depend on each other, choosing among them is most of the work by any method: left for when others
        fail.
        """
        if self._generic.rank < self._generic.r:
            return {}
        made: dict[str, Candidate] = {}
        names = motions_alone()
        for name in sorted(names, key=lambda name: name != BY_FRAMES):
            least = min((one.weight for one in made.values()), default=None)
            # what factors a whole matrix of a long chain may take as long as what goes from body to body is worth
            with suppress(TooLongError), nullcontext() if least is None else at_most(worth_trying(least)):
                one = self._methods.candidate(quantity, name)
                if isinstance(one, Candidate):
                    made[name] = replace(one, along=TITLES.get(name, name))
        return {made[name].along: made[name] for name in names if name in made}

    def _by_methods(self, quantity: str, known: int | None) -> dict[str, Candidate]:
        """What is not derived along null spaces alone, by methods that are chosen by themselves."""
        if quantity in MAIN:
            return {}
        made: dict[str, Candidate] = {}
        for row in methods_of(quantity, Use.CHOSEN):
            with suppress(TooLongError), nullcontext() if known is None else at_most(worth_trying(known)):
                one = self._methods.candidate(quantity, row.name)
                if isinstance(one, Candidate):
                    made[row.name] = replace(one, along=row.name)
        return made

    def _brought(self, made: dict[str, Candidate]) -> dict[str, Candidate]:
        """The same on the graph of the other quantities."""
        graph = self._mechanics.graph
        return {title: replace(one, derived=moved(graph, one.derived)) for title, one in made.items()}

    def _factored(self, minors: Candidate, best: Candidate) -> Candidate | None:
        """What was derived along minors multiplied out and factored, where that is short.

        Minors of rows that depend on each other become small together: multiplied out, their squares would cancel.  So
        do those of a task that leaves directions open, beside its singularities.  Derivatives of steps that are no
        minors, or of equations, have nothing to cancel: beside them it has to count less.
        """
        of_task = BY_NAME[minors.derived.name].needs in (TASK_RATES, TASK_OPEN)
        cancels = self._generic.rank < self._generic.r or (of_task and self._mechanics.model.task_leaves.rates > 0)
        if cancels or not 0 < _counted(minors) <= FACTORING_LIMIT:
            return None
        kept = self._spaces[self._methods.workspace].derivations["minors"].whole
        outputs = self._mechanics.factoring.shorten(minors.derived.outputs, kept)
        made = replace(minors, derived=replace(minors.derived, outputs=outputs), along="factored")
        of_steps = minors.derived.name in FUNCTIONS and best is not minors
        return None if of_steps and _counted(made) >= _counted(best) else made

    def _validity(self, one: Candidate) -> Validity:
        """Of a method; along a null space only ranks are divided by."""
        return self._methods.validity(one, first_only=True) if one.method else VALID

    def _weight(self, one: Candidate) -> Fraction:
        """What is compared: of q_ddot and lambda the cost in axes that they are finished in, on a graph of its own."""
        if one.derived.name in MOTIONS:
            apart = System(self._mechanics.model)
            one = replace(one, derived=in_moving_axes(apart, moved(apart.graph, one.derived)))
        return _counted(one) * cost_factor(one.method, self._mechanics)


def _counted(one: Candidate) -> int:
    """The counted cost of outputs and tested denominators, as they stand on a graph that others share.

    Derivatives of equations in absolute angles hold sums of angles, which cost less than they do as they stand.
    """
    if one.derived.name in FUNCTIONS:
        return counted_weight(one.derived)
    return cost(scalars(one.derived)).weight


class _NullSpaces:
    """What quantities of one system are derived along: null spaces on its graph, or reflections in absolute angles."""

    def __init__(self, mechanics: System, generic: Genericity) -> None:
        self._model, self._generic = mechanics.model, generic
        self.derivations = derivations(mechanics, generic)
        self.absolute: Derivation | None = None

    def look_for_absolute_angles(self) -> None:
        """Reflections in absolute angles for q_ddot and lambda, on a graph of their own, where they are to be had.

        Taken where angles are relative and minors too many: the rounding errors of G in relative angles grow with the
        length of a chain.
        """
        if self.absolute is None and self._model.constraints and self._generic.delta > LARGEST_DELTA:
            seen = in_absolute_angles(self._model)
            if seen is not None:
                self.absolute = Derivation(seen, self._generic, reflected_rows(seen, self._generic))
