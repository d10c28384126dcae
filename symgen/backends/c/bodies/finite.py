"""The test that all results are finite: terms that are 0 for finite results, and one of them NaN otherwise."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

# Results in a term.  Intervals of the terms must stay finite too, which tools that know no correlation need.
_IN_A_TERM = 3
# What the terms are summed in, and what a term after the first is made in.
SUM, TERM = "rest", "term"


def rests(results: Sequence[str]) -> list[str]:
    """The terms as expressions: x - x, and its product with others."""
    groups = [results[start : start + _IN_A_TERM] for start in range(0, len(results), _IN_A_TERM)]
    return [" * ".join((f"({x} - {x})" if others else f"{x} - {x}", *others)) for x, *others in groups]


class FiniteTest:
    """The same terms as C statements, a factor for each result as soon as that is known.

    A result that is read before the next one is computed stays a value of its own: compilers that pack the last
    operations of neighbouring results into vectors take more code, and more stack, to collect what these need.
    """

    def __init__(self, kind: str, results: Iterable[str]) -> None:
        self._kind = kind
        self._waiting = dict.fromkeys(results)
        self._count = len(self._waiting)
        self._known = 0

    def factor(self, result: str) -> list[str]:
        """The lines for a result that is known by now; none for other values, and none the second time."""
        if result not in self._waiting:
            return []
        del self._waiting[result]
        first_term, place = self._known < _IN_A_TERM, self._known % _IN_A_TERM
        self._known += 1
        last = place == _IN_A_TERM - 1 or self._known == self._count
        if first_term:
            return [f"{self._kind} {SUM} = {result} - {result};" if place == 0 else f"{SUM} *= {result};"]
        if place == 0 and last:
            return [f"{SUM} += {result} - {result};"]
        declared = "" if self._known > _IN_A_TERM + 1 else f"{self._kind} "
        line = f"{declared}{TERM} = {result} - {result};" if place == 0 else f"{TERM} *= {result};"
        return [line, f"{SUM} += {TERM};"] if last else [line]

    def remaining(self) -> list[str]:
        """The lines for all results that are still to come."""
        return [line for result in [*self._waiting] for line in self.factor(result)]
