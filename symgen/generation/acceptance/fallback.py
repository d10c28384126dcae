"""What verification rejects takes the next valid method by counted cost, or is left out alone.

Another method is held against the same states by interpretation before anything is printed or compiled; the files that
come of it are then verified like any others.  A method that needs most of what is allowed at these states will need
more at others: it is taken only where no other keeps a margin.  Where none does, one that loses digits works with
twice as many, and so does one that needs nearly all.  Where no method passes in float32, float64 stays.
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import inf

from symgen.diagnostics import SymgenBug
from symgen.generation.acceptance.passing import Passing, remedy
from symgen.generation.acceptance.tried_methods import TriedMethods
from symgen.generation.acceptance.worst_errors import Kernels, WorstErrors, faults_at_worst
from symgen.generation.draft import REJECTED, Draft
from symgen.generation.results import AUTO, Options
from symgen.ir.kernel import Kernel, Scalar
from symgen.methods.quantity import scalars
from symgen.model.quantities import MAIN, MOTIONS
from symgen.quantities.alternatives import TIERS, Alternative, Alternatives, grouped
from symgen.quantities.everything import (
    OPERATIONS_TRIED,
    asked_for,
    most_with_twice_the_digits,
    too_many_tried,
    too_wide,
)
from symgen.quantities.select import Rejection
from symgen.runtime.garbage import let_go, let_go_and_keep, let_go_of_all
from symgen.symbolic.traverse import cost
from symgen.verify.certificate import Certificate, Fault, LeftOut
from symgen.verify.comparison import INACCURATE, VIOLATES
from symgen.verify.exactness import ExactStates
from symgen.verify.expected import Expected
from symgen.verify.tolerance import FACTOR

TOO_LONG = "not tried: it takes too long to derive"
# Of the error that is allowed; which method a quantity takes is decided at a few dozen states.
MARGIN = FACTOR / 2
# Beyond this u, q_ddot and lambda take twice the digits where nothing else keeps a margin: of a state in thousands more
# is lost.  Others, which drive nothing, do where next to nothing is left of what is allowed.
NARROW, NARROWEST = FACTOR * 3 / 4, FACTOR * 7 / 8
# Share of operations more that keeping a margin may cost.
MARGIN_WORTH = Fraction(1, 2)
# Counted cost of the longest kernels for which another method is looked for where theirs passes with half of what is
# allowed: each takes seconds, and seldom has half of the error.
LONGEST_WEIGHED = 6_000
# Counted cost of all long methods together that are tried for a quantity, or for accelerations and multipliers, before
# twice the digits are: the rest may do with fewer digits, but each takes seconds to be derived and measured.
LONG_TRIED = 20_000
# Counted cost of all methods together that are tried for the quantities of a model before the long ones among the rest
# begin with twice the digits: what one loses, another is likely to lose in the next quantity, too.
TRIED_IN_ALL = 40_000


class Fallback:
    """The methods of one model that are left, through all rounds of its verification."""

    def __init__(self, options: Options, progress: Callable[[str], None]) -> None:
        self._options = options
        self._progress = progress
        self._alternatives: Alternatives | None = None
        self._exactly: ExactStates | None = None
        self.errors = WorstErrors(progress)
        self._left: dict[tuple[str, int], deque[Alternative]] = {}
        # by quantities
        self._tried: defaultdict[str, TriedMethods] = defaultdict(TriedMethods)
        self._weighed: set[str] = set()
        # by quantities that are made because all are: what they count at least by methods that lose digits
        self._too_wide: dict[str, int] = {}
        # counted cost of methods that were tried for these
        self._tried_unasked = 0

    def other(self, draft: Draft, certificate: Certificate, expected: Expected) -> Draft | None:
        """The draft with other methods for what is rejected or keeps no margin; None where nothing is better."""
        if self._alternatives is None:
            let_go_and_keep()
            derivations = draft.derivations
            self._alternatives = Alternatives(draft.model, derivations.generic, derivations.methods)
            self.errors.begin(expected)
            self._exactly = ExactStates(expected)
        rejected = certificate.rejected | self.errors.faults(draft, certificate, expected)
        made = self._all_replaced(draft, rejected, expected)
        if not certificate.faults:
            worst = {one.quantity: one for one in sorted(certificate.errors, key=lambda record: record.largest)}
            for quantity, record in worst.items():
                largest = max(record.largest, self.errors.largest(quantity))
                if quantity in self._weighed or self._is_given_up(draft, quantity):
                    continue
                counted = cost(scalars(draft.taken(quantity).derived)).weight
                narrow = NARROW if quantity in MAIN else NARROWEST
                if largest > narrow or (largest > MARGIN and counted <= LONGEST_WEIGHED):
                    before, made = made, self._with_margin(made, quantity, largest, expected)
                    if made is before and largest > narrow:
                        made = self._with_digits(made, quantity, largest, narrow, expected)
                    let_go()
        if made is draft:
            # methods that were looked at for a margin may have led to states at which what stays is worse
            made = self._all_replaced(draft, self.errors.faults(draft, certificate, expected), expected)
        return None if made is draft else made

    def settle(self) -> None:
        """Lets go of what is hardly needed any more, and derived again where it is."""
        if self._alternatives is not None:
            self._alternatives.settle()
            self._left.clear()
            let_go_of_all()

    def _all_replaced(self, draft: Draft, rejected: Mapping[str, Sequence[Fault]], expected: Expected) -> Draft:
        """The draft without the methods that are rejected, those of short quantities first."""
        for quantity in sorted(rejected, key=lambda name: cost(scalars(draft.taken(name).derived)).weight):
            draft = self._replaced(draft, quantity, rejected[quantity], expected)
            let_go()
        return draft

    def _replaced(self, draft: Draft, quantity: str, faults: Sequence[Fault], expected: Expected) -> Draft:
        """The draft with a rejected quantity by its next method that passes, or without it."""
        tried = self._tried[quantity]
        known, kernels = len(tried.against), draft.kernels(quantity)
        self._weighed.add(quantity)
        self._check_algebra(kernels["float64"], draft.method(quantity), faults[0].state)
        tried.against.append((draft.method(quantity), f"{faults[0].what} ({faults[0].target})"))
        tried.operations += cost(scalars(draft.taken(quantity).derived)).weight
        tried.saw(kernels)
        # laws that a number with few digits violates beside are no reason of their own: its algebra is right; nor is a
        # status of float32, whose thresholds twice the digits bring down
        judged = [fault for fault in faults if fault.scalar == "float64"] or faults
        if all(fault.what.startswith((INACCURATE, VIOLATES)) for fault in judged):
            tried.keep_for_more_digits(draft.taken(quantity))
        if all(fault.scalar == "float32" for fault in faults):
            tried.passing.append(Passing(0.0, ("float64",), draft.taken(quantity), kernels))
        # one type may have been left out before
        others = tuple(one for one in draft.left_out if one.quantity != quantity)
        if self._is_given_up(draft, quantity):
            return replace(draft.without(quantity, tuple(kernels), too_many_tried()), left_out=others)
        replacement = self._next(draft, quantity, expected)
        if replacement is None and quantity in self._too_wide:
            why = too_wide(self._too_wide[quantity])
            return replace(draft.without(quantity, tuple(kernels), why), left_out=others)
        draft = draft.rejecting(tuple(Rejection(quantity, method, why) for method, why in tried.against[known:]))
        if replacement is not None:
            draft = draft.along(replacement.alternative, replacement.kernels)
        passed = () if replacement is None else replacement.scalars
        without = tuple(scalar for scalar in kernels if scalar not in passed)
        if not without:
            return draft
        given_up = () if self._alternatives is None else self._alternatives.too_long.get(quantity, ())
        every = (*tried.against, *((name, TOO_LONG) for name in given_up))
        what_to_do = remedy(self._options.methods.get(quantity, AUTO), quantity, without)
        left_out = LeftOut(quantity, without, every, what_to_do)
        return replace(draft.without(quantity, without, REJECTED), left_out=(*others, left_out))

    def _is_given_up(self, draft: Draft, quantity: str) -> bool:
        """Whether enough was tried for quantities that are made because all are."""
        return self._tried_unasked > OPERATIONS_TRIED and not self._is_asked_for(draft, quantity)

    def _is_asked_for(self, draft: Draft, quantity: str) -> bool:
        return quantity in asked_for(self._options.outputs or draft.model.outputs, self._options.methods)

    def _next(self, draft: Draft, quantity: str, expected: Expected) -> Passing | None:
        """The next method that passes with a margin, or else the best of those that pass; others are noted."""
        needed = tuple(draft.kernels(quantity))
        for operations in (LONG_TRIED, inf):
            plain = operations == inf or not self._begins_with_more_digits(draft, quantity)
            if plain and (first := self._first_of(draft, quantity, expected, operations)) is not None:
                return first
            # what passes narrowly may not where it is worst, and is then left to more digits
            widened = True
            while widened:
                widened = False
                for one in self._with_more_digits(draft, quantity, expected):
                    widened = True
                    # more digits in float64, too, are worth a margin only where next to none is left
                    most = MARGIN if one.alternative.choice.wide == needed else NARROW
                    if one.scalars == needed and one.largest <= most:
                        return one
                    if "float64" in one.scalars:
                        self._tried[quantity].passing.append(one)
                if (best := self._best_of(draft, quantity, expected, needed)) is not None:
                    return best
        return self._best_of(draft, quantity, expected, ())

    def _best_of(
        self, draft: Draft, quantity: str, expected: Expected, needed: tuple[Scalar, ...]
    ) -> Passing | None:
        """The best of those that pass in the types that are needed, or in any, where it is worst, too."""
        tried = self._tried[quantity]
        while (best := tried.take_best(needed)) is not None:
            one = self._grouped(draft, best, expected)
            if one.scalars == best.scalars:
                return one
            if one.scalars:
                tried.passing.append(one)
        return None

    def _first_of(self, draft: Draft, quantity: str, expected: Expected, operations: float) -> Passing | None:
        """The first method that passes with a margin; others that pass are noted."""
        needed = tuple(draft.kernels(quantity))
        for one in self._of_all_tiers(draft, quantity, expected, operations):
            if one.scalars == needed and one.largest <= MARGIN:
                return one
            if "float64" in one.scalars:
                self._tried[quantity].passing.append(one)
        return None

    def _with_margin(self, draft: Draft, quantity: str, largest: float, expected: Expected) -> Draft:
        """The draft with a quantity that passes narrowly by a method with half of its error, where that is not long."""
        self._weighed.add(quantity)
        taken, kernels = draft.taken(quantity), draft.kernels(quantity)
        here = Passing(largest, tuple(kernels), taken, kernels)
        self._tried[quantity].saw(kernels)
        most = cost(scalars(taken.derived)).weight * (1 + MARGIN_WORTH)
        for one in self._candidates(draft, quantity, 0, expected, largest / 2, most):
            if one.scalars == here.scalars and 2 * one.largest <= here.largest:
                return self._in_place_of(draft, here, one)
            if "float64" in one.scalars:
                self._tried[quantity].passing.append(one)
        return draft

    def _with_digits(self, draft: Draft, quantity: str, largest: float, narrow: float, expected: Expected) -> Draft:
        """The draft with twice the digits for a quantity that needs nearly all that is allowed, where these help."""
        taken, kernels, tried = draft.taken(quantity), draft.kernels(quantity), self._tried[quantity]
        if taken.choice.wide:
            return draft
        here = Passing(largest, tuple(kernels), taken, kernels)
        # one type may keep what the other lacks
        alone = tuple(one for one, error in self.errors.of_types(draft, quantity, expected).items() if error > narrow)
        if 0 < len(alone) < len(kernels) and tried.may_widen(taken, alone):
            one = self._with_pairs(draft, taken, here.scalars, alone, expected)
            if one.scalars == here.scalars and one.largest <= narrow:
                return self._in_place_of(draft, here, one)
        tried.keep_for_more_digits(taken)
        for one in self._with_more_digits(draft, quantity, expected):
            if one.scalars == here.scalars and one.largest <= MARGIN:
                return self._in_place_of(draft, here, one)
            if "float64" in one.scalars:
                self._tried[quantity].passing.append(one)
        return draft

    def _in_place_of(self, draft: Draft, here: Passing, one: Passing) -> Draft:
        """The draft with a method that keeps a margin in place of one that does not, which stays at hand."""
        quantity = here.alternative.choice.quantity
        tried = self._tried[quantity]
        tried.passing.append(here)
        why = f"error {here.largest:.3g} times d + eps |y*| of {FACTOR:g} leaves no margin"
        tried.against.append((draft.method(quantity), why))
        return draft.along(one.alternative, one.kernels).rejecting((Rejection(quantity, draft.method(quantity), why),))

    def _of_all_tiers(self, draft: Draft, quantity: str, expected: Expected, operations: float) -> Iterator[Passing]:
        """One tier after the other, until what was tried counts so many operations; short ones in any case."""
        for tier in range(TIERS):
            yield from self._candidates(draft, quantity, tier, expected, MARGIN, draft.taken(quantity).cost)
            longer = self._candidates(draft, quantity, tier, expected, MARGIN)
            while self._tried_long(quantity) <= operations and (one := next(longer, None)) is not None:
                yield one

    def _begins_with_more_digits(self, draft: Draft, quantity: str) -> bool:
        """Whether enough was tried for the quantities of the model, and what is rejected is long."""
        in_all = sum(one.operations for one in self._tried.values())
        return in_all > TRIED_IN_ALL and draft.taken(quantity).cost > LONGEST_WEIGHED

    def _tried_long(self, quantity: str) -> int:
        """Counted cost of the long methods tried for a quantity; accelerations and multipliers count together."""
        return sum(self._tried[name].operations for name in (MOTIONS if quantity in MOTIONS else (quantity,)))

    def _candidates(
        self, draft: Draft, quantity: str, tier: int, expected: Expected, most: float, longest: float | Fraction = inf
    ) -> Iterator[Passing]:
        """Those of a tier that are left, measured; what fails is noted.  Up to an error of `most` they are taken.

        Those that count more operations than the `longest` stay for later.
        """
        if self._options.methods.get(quantity, AUTO) != AUTO or self._alternatives is None:
            return
        if (quantity, tier) not in self._left:
            self._progress(f"other methods of {quantity}")
            self._left[quantity, tier] = deque(self._alternatives.of(quantity, draft.choice(quantity), tier))
        left = self._left[quantity, tier]
        while left and left[0].cost <= longest:
            other = left.popleft()
            self._progress(f"another method of {quantity}, {other.choice.title}")
            kernels = draft.kernels_along(other, tuple(draft.kernels(quantity)))
            if not self._tried[quantity].saw(kernels):
                one = self._measured(draft, other, kernels, expected)
                # long ones are grouped where that may be what is taken: it takes longer than measuring
                yield self._grouped(draft, one, expected) if one.largest <= most else one

    def _grouped(self, draft: Draft, one: Passing, expected: Expected) -> Passing:
        """What passes where it is worst, too, with its numbers grouped and measured anew."""
        if one.alternative.grouped or "float64" not in one.scalars:
            return one
        before = one.scalars
        # of long ones grouping takes longer than looking for their worst states
        one = self._at_its_worst(draft, one, expected)
        if one.scalars != before:
            return one
        whole = grouped(one.alternative)
        return self._measured(draft, whole, draft.kernels_along(whole, tuple(one.kernels)), expected)

    def _with_more_digits(self, draft: Draft, quantity: str, expected: Expected) -> Iterator[Passing]:
        """What loses digits in float32 alone with twice as many there, then the shortest with more in both."""
        if self._options.methods.get(quantity, AUTO) != AUTO:
            return
        scalars, tried = tuple(draft.kernels(quantity)), self._tried[quantity]
        for one in tried.short_of_digits_in_float32(MARGIN) if "float32" in scalars else ():
            yield self._with_pairs(draft, one, scalars, ("float32",), expected)
        # those among them that are beyond what is allowed in float64 where they are worst
        inaccurate = tried.take_inaccurate()
        asked = self._options.outputs or draft.model.outputs
        if inaccurate and inaccurate[0].cost > most_with_twice_the_digits(quantity, asked, self._options.methods):
            self._too_wide[quantity] = inaccurate[0].cost
            return
        for one in tried.short_of_digits(inaccurate, scalars):
            yield self._with_pairs(draft, one, scalars, scalars, expected)

    def _with_pairs(
        self, draft: Draft, one: Alternative, scalars: tuple[Scalar, ...], wide: tuple[Scalar, ...], expected: Expected
    ) -> Passing:
        """An alternative with twice the digits in some types, measured."""
        self._progress(f"twice the digits for {one.choice.quantity}, {one.choice.title}")
        one = self._tried[one.choice.quantity].widens(grouped(one), wide)
        return self._measured(draft, one, draft.kernels_along(one, scalars), expected)

    def _measured(self, draft: Draft, one: Alternative, kernels: Kernels, expected: Expected) -> Passing:
        """The scalar types in which kernels pass by interpretation, and the largest error there; the rest is noted."""
        passed: dict[Scalar, Kernel] = {}
        worst = 0.0
        tried = self._tried[one.choice.quantity]
        if not one.choice.wide and not one.grouped:
            tried.operations += one.cost
        if not self._is_asked_for(draft, one.choice.quantity):
            self._tried_unasked += one.cost
        for scalar, kernel in kernels.items():
            if scalar in expected.scalars:
                record, fault = self.errors.measurements.of(kernel, draft.programs[scalar].sincos, scalar, expected)
                if scalar == "float64":
                    tried.loses(one, record.largest)
                if fault is not None:
                    name = one.choice.title + one.choice.digits
                    self._check_algebra(kernels["float64"], name, record.worst_state)
                    tried.note(one, fault, inaccurate=not record.refused)
                    if scalar == "float64":
                        break  # float32 alone is of no use: the other type is what Python and the report are made of
                    continue
                worst = max(worst, record.largest)
            passed[scalar] = kernel
        return self._at_its_worst(draft, Passing(worst, tuple(passed), one, kernels), expected, one.grouped)

    def _at_its_worst(self, draft: Draft, one: Passing, expected: Expected, own: bool = True) -> Passing:
        """What passes at the states that were searched for, too, its `own` worst ones among them."""
        passed, quantity = list(one.scalars), one.alternative.choice.quantity
        judged = {scalar: one.kernels[scalar] for scalar in passed if scalar in expected.scalars}
        looked_at = one.alternative if own and "float64" in passed else None
        errors = self.errors.at_worst(draft, judged, looked_at) if judged else {}
        self._tried[quantity].loses(one.alternative, errors.get("float64", 0.0))
        for fault in faults_at_worst(quantity, errors):
            self._tried[quantity].note(one.alternative, fault, inaccurate=True)
            passed.remove(fault.scalar)
        scalars = tuple(passed) if "float64" in passed else ()
        worst = max((one.largest, *(error for scalar, error in errors.items() if scalar in scalars)))
        if scalars and one.alternative.grouped:
            self.errors.keep(quantity, one.kernels, worst)
        return Passing(worst, scalars, one.alternative, one.kernels)

    def _check_algebra(self, kernel: Kernel, method: str, worst: int) -> None:
        """Raises SymgenBug where a rejected kernel computes something else: falling back would hide wrong algebra."""
        assert self._exactly is not None
        if wrong := self._exactly.difference(kernel, worst):
            raise SymgenBug(f"{kernel.name} by {method}: {wrong}, in exact arithmetic")
