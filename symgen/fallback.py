"""What verification rejects takes the next valid way by counted cost, or is left out alone.

Another way is held against the same states by interpretation before anything is printed or compiled; the files that
come of it are then verified like any others.  A way that needs most of what is allowed at these states will need more
at others: it is taken only where no other way keeps a margin.  Where no way passes in float32, float64 stays.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeAlias

from symgen.draft import Draft
from symgen.dynamics.alternatives import Alternative, Alternatives
from symgen.dynamics.select import Choice, Rejection
from symgen.ir.kernel import Kernel, Scalar
from symgen.records import dataclass
from symgen.results import AUTO, Options
from symgen.verify.certificate import Fault, LeftOut
from symgen.verify.expected import Expected
from symgen.verify.interpreted import measured, wrong_exactly
from symgen.verify.tolerance import FACTOR

REJECTED = "verification rejects it"
WRONG = "; wrong in exact arithmetic too: a fault of symgen, please report it"
# Of the error that is allowed; what way a quantity takes is decided at a few dozen states.
MARGIN = FACTOR / 2
Kernels: TypeAlias = Mapping[Scalar, Kernel]


@dataclass(frozen=True, slots=True)
class _Candidate:
    """A way with its kernels and its largest error in `scalars`, where it passes; without `other` the way taken."""

    largest: float
    scalars: tuple[Scalar, ...]
    other: Alternative | None = None
    kernels: Kernels | None = None


class Fallback:
    """The ways of one model that are left, through all rounds of its verification."""

    def __init__(self, options: Options, progress: Callable[[str], None]) -> None:
        self._options = options
        self._progress = progress
        self._alternatives: Alternatives | None = None
        self._left: dict[str, Iterator[Alternative]] = {}
        self._passing: dict[str, list[_Candidate]] = {}
        self._tried: dict[str, list[tuple[str, str]]] = {}
        self._kernels: dict[str, list[Kernels]] = {}

    def settle(self, draft: Draft, rejected: Mapping[str, Sequence[Fault]], expected: Expected) -> Draft:
        """The draft with every rejected quantity along its next way that passes, or without it."""
        if self._alternatives is None:
            derivations = draft.derivations
            self._alternatives = Alternatives(draft.model, derivations.generic, derivations.inverse)
        for quantity, faults in rejected.items():
            draft = self._replaced(draft, quantity, faults, expected)
        return draft

    def _replaced(self, draft: Draft, quantity: str, faults: Sequence[Fault], expected: Expected) -> Draft:
        tried, passing = self._tried.setdefault(quantity, []), self._passing.setdefault(quantity, [])
        known = len(tried)
        kernels = draft.kernels(quantity)
        wrong = wrong_exactly(kernels["float64"], expected)
        tried.append((draft.way(quantity), f"{faults[0].what} ({faults[0].target})" + WRONG * wrong))
        self._kernels.setdefault(quantity, []).append(kernels)
        failing = {fault.scalar for fault in faults}
        if "float64" not in failing:
            passing.append(_Candidate(0.0, ("float64",)))
        found = self._next(draft, quantity, expected)
        draft = draft.rejecting(tuple(Rejection(quantity, way, why) for way, why in tried[known:]))
        if found is not None and found.other is not None and found.kernels is not None:
            draft = draft.along(found.other, found.kernels)
        passed = () if found is None else found.scalars
        without = tuple(scalar for scalar in kernels if scalar not in passed)
        if not without:
            return draft
        left_out = LeftOut(quantity, without, tuple(tried), self._remedy(quantity, without))
        others = (one for one in draft.left_out if one.quantity != quantity)
        return replace(draft.without(quantity, without, REJECTED), left_out=(*others, left_out))

    def _next(self, draft: Draft, quantity: str, expected: Expected) -> _Candidate | None:
        """The next way that passes with a margin, or else the best of those that pass; others are noted."""
        passing, needed = self._passing[quantity], tuple(draft.kernels(quantity))
        for other in self._others(quantity, draft.choice(quantity)):
            self._progress(f"another way to {quantity}, {other.choice.way}")
            kernels = draft.kernels_along(other, needed)
            if kernels in self._kernels[quantity]:
                continue
            self._kernels[quantity].append(kernels)
            one = self._measured(draft, other, kernels, expected)
            if one.scalars == needed and one.largest <= MARGIN:
                return one
            if "float64" in one.scalars:
                passing.append(one)
        if not passing:
            return None
        best = min(passing, key=lambda one: (-len(one.scalars), one.largest))
        passing.remove(best)
        return best

    def _others(self, quantity: str, taken: Choice) -> Iterator[Alternative]:
        if self._options.forms.get(quantity, AUTO) != AUTO or self._alternatives is None:
            return iter(())
        if quantity not in self._left:
            self._progress(f"other ways to {quantity}")
            self._left[quantity] = self._alternatives.of(quantity, taken)
        return self._left[quantity]

    def _measured(self, draft: Draft, other: Alternative, kernels: Kernels, expected: Expected) -> _Candidate:
        """The scalar types in which kernels pass by interpretation, and the largest error there; the rest is noted."""
        passed: list[Scalar] = []
        worst = 0.0
        for scalar, kernel in kernels.items():
            if scalar not in expected.scalars:
                passed.append(scalar)
                continue
            largest, fault = measured(kernel, draft.programs[scalar].sincos, scalar, expected)
            if fault is None:
                passed.append(scalar)
                worst = max(worst, largest)
                continue
            self._tried[other.choice.quantity].append((other.choice.way, f"{fault.what} ({fault.target})"))
            if scalar == "float64":
                break  # float32 alone is of no use: the other type is what Python and the report are made of
        return _Candidate(worst, tuple(passed), other, kernels)

    def _remedy(self, quantity: str, without: Sequence[Scalar]) -> str:
        asked = self._options.forms.get(quantity, AUTO)
        if asked != AUTO:
            return f"leave `--form {quantity}={asked}` away: another form may pass"
        if "float64" not in without:
            return f"float64 has {quantity}; `--scalar float64` asks for that type alone"
        return "give narrower `ranges` if states near a singularity are never met; `--no-verify` writes it as it is"


def as_recorded(draft: Draft, recorded: Mapping[str, Any]) -> Draft:
    """The draft with what an earlier verification of the same model rejected, as its derivation.json tells it.

    Without verification, files can only be compared with those on disk if they are made the way these were.
    """
    if recorded.get("model_sha256") != draft.model.text_hash:
        return draft
    rejected = tuple(Rejection(r["quantity"], r["way"], r["why"]) for r in recorded.get("rejected", ()))
    left_out = {one["quantity"]: tuple(one["scalars"]) for one in recorded.get("left_out", ())}
    present = {choice.quantity for choice in draft.derivations.choices}
    others = Alternatives(draft.model, draft.derivations.generic, draft.derivations.inverse)
    for quantity in dict.fromkeys(one.quantity for one in rejected if one.quantity in present):
        kernel = recorded["kernels"].get(quantity)
        other = None if kernel is None else others.named(quantity, kernel["way"])
        if other is not None and draft.choice(quantity).way != other.choice.way:
            draft = draft.along(other, draft.kernels_along(other, tuple(draft.programs)))
        if quantity in left_out:
            draft = draft.without(quantity, left_out[quantity], REJECTED)
    return draft.rejecting(rejected)
