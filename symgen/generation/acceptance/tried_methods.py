"""What is known of the methods of one quantity that verification was held against."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from symgen.generation.acceptance.passing import Passing, digest
from symgen.generation.acceptance.worst_errors import Kernels
from symgen.ir.kernel import Scalar
from symgen.quantities.alternatives import Alternative
from symgen.verify.certificate import Fault

# Methods that are tried once more with twice the digits.
WIDENED = 3
# Counted cost of the longest of them.
LONGEST_WIDENED = 60_000


class TriedMethods:
    """Through all rounds of a verification: what speaks against methods, which pass, and which lose digits."""

    def __init__(self) -> None:
        self.against: list[tuple[str, str]] = []
        """Methods by their names, and what was wrong with each."""
        self.passing: list[Passing] = []
        self.operations = 0
        """Counted cost of all that were tried with the usual digits."""
        # by their hashes: kernels that were rejected need not stay
        self._seen: set[int] = set()
        self._inaccurate: list[Alternative] = []
        # by methods: what float64 loses
        self._lost: dict[str, float] = {}
        # methods, and the types that had twice the digits
        self._widened: set[tuple[str, tuple[Scalar, ...]]] = set()

    def saw(self, kernels: Kernels) -> bool:
        """Whether these kernels were looked at before; from now on they were."""
        before = len(self._seen)
        self._seen.add(digest(kernels))
        return len(self._seen) == before

    def note(self, one: Alternative, fault: Fault, inaccurate: bool) -> None:
        """What speaks against an alternative; one that is inaccurate may work with more digits."""
        self.against.append((one.choice.title + one.choice.digits, f"{fault.what} ({fault.target})"))
        if inaccurate:
            self.keep_for_more_digits(one)

    def keep_for_more_digits(self, one: Alternative) -> None:
        """What is inaccurate may work with twice the digits in all types, where those in one did not do."""
        one = replace(one, choice=replace(one.choice, wide=()))
        if one not in self._inaccurate:
            self._inaccurate.append(one)

    def loses(self, one: Alternative, error: float) -> None:
        """The error of an alternative in float64, of which the largest counts."""
        if not one.choice.wide:
            self._lost[one.choice.title] = max(self._lost.get(one.choice.title, 0.0), error)

    def take_best(self, needed: Sequence[Scalar]) -> Passing | None:
        """The best of those that pass in the types that are needed, or in any; it stands no longer among them."""
        left = [one for one in self.passing if tuple(needed) in ((), one.scalars)]
        if not left:
            return None
        best = min(left, key=lambda one: (-len(one.scalars), one.largest))
        self.passing.remove(best)
        return best

    def may_widen(self, one: Alternative, wide: tuple[Scalar, ...]) -> bool:
        """Whether a method may be tried with twice the digits in these types: it is not long, and was not yet."""
        return one.cost <= LONGEST_WIDENED and not one.choice.wide and (one.choice.title, wide) not in self._widened

    def widens(self, one: Alternative, wide: tuple[Scalar, ...]) -> Alternative:
        """The alternative with twice the digits in these types; it is not tried so again."""
        self._widened.add((one.choice.title, wide))
        return replace(one, choice=replace(one.choice, wide=wide))

    def short_of_digits_in_float32(self, most: float) -> list[Alternative]:
        """What passes in float64 alone, and may with twice the digits in float32: first what keeps an error of `most`
        there, then the shorter."""
        passing = [
            one
            for one in self.passing
            if one.scalars == ("float64",) and self.may_widen(one.alternative, ("float32",))
        ]
        passing.sort(key=lambda one: (one.largest > most, one.alternative.cost))
        return [one.alternative for one in passing[:WIDENED]]

    def take_inaccurate(self) -> list[Alternative]:
        """Those that lose digits and were not taken yet, the shorter first."""
        inaccurate, self._inaccurate = self._inaccurate, []
        return sorted(inaccurate, key=lambda one: one.cost)

    def short_of_digits(self, inaccurate: Sequence[Alternative], scalars: tuple[Scalar, ...]) -> list[Alternative]:
        """Which of them may pass with twice the digits in these types: the shortest, then those that lose least.

        What these divide by keeps more digits in float32, too.
        """
        shortest: dict[str, Alternative] = {}
        for one in inaccurate:
            if self.may_widen(one, scalars):
                shortest.setdefault(one.choice.title, one)
        candidates = list(shortest.values())
        candidates[1:] = sorted(candidates[1:], key=lambda one: self._lost.get(one.choice.title, 0.0))
        return candidates[:WIDENED]
