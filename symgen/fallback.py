"""What verification rejects takes the next valid way by counted cost, or is left out alone.

Another way is held against the same states by interpretation before anything is printed or compiled; the files that
come of it are then verified like any others.  A way that needs most of what is allowed at these states will need more
at others: it is taken only where no other way keeps a margin.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any, TypeAlias

from symgen.draft import Draft
from symgen.dynamics.alternatives import Alternative, alternative, alternatives
from symgen.dynamics.select import Rejection
from symgen.ir.kernel import Kernel, Scalar
from symgen.results import AUTO, Options
from symgen.verify.certificate import Fault, LeftOut
from symgen.verify.expected import Expected
from symgen.verify.interpreted import measured
from symgen.verify.tolerance import FACTOR

REJECTED = "verification rejects it"
# Of the error that is allowed; what way a quantity takes is decided at a few dozen states.
MARGIN = FACTOR / 2

_Passing: TypeAlias = tuple[float, Alternative, Mapping[Scalar, Kernel]]


class Fallback:
    """The ways of one model that are left, through all rounds of its verification."""

    def __init__(self, options: Options, progress: Callable[[str], None]) -> None:
        self._options = options
        self._progress = progress
        self._left: dict[str, Iterator[Alternative]] = {}
        self._passing: dict[str, list[_Passing]] = {}
        self._tried: dict[str, list[tuple[str, str]]] = {}
        self._kernels: dict[str, list[Mapping[Scalar, Kernel]]] = {}

    def settle(self, draft: Draft, rejected: Mapping[str, Fault], expected: Expected) -> Draft:
        """The draft with every rejected quantity along its next way that passes, or without it."""
        for quantity, fault in rejected.items():
            draft = self._replaced(draft, quantity, fault, expected)
        return draft

    def _replaced(self, draft: Draft, quantity: str, fault: Fault, expected: Expected) -> Draft:
        tried = self._tried.setdefault(quantity, [])
        known = len(tried)
        tried.append((draft.way(quantity), f"{fault.what} ({fault.target})"))
        self._kernels.setdefault(quantity, []).append(draft.kernels(quantity))
        found = self._next(draft, quantity, expected)
        draft = draft.rejecting(tuple(Rejection(quantity, way, why) for way, why in tried[known:]))
        if found is not None:
            return draft.along(*found)
        left_out = LeftOut(quantity, tuple(tried), self._remedy(quantity))
        return replace(draft.without(quantity, REJECTED), left_out=(*draft.left_out, left_out))

    def _next(
        self, draft: Draft, quantity: str, expected: Expected
    ) -> tuple[Alternative, Mapping[Scalar, Kernel]] | None:
        """The next way that passes with a margin, or else the one that passes best; those that do not are noted."""
        passing = self._passing.setdefault(quantity, [])
        if quantity not in self._left:
            self._left[quantity] = iter(self._alternatives(draft, quantity))
        for other in self._left[quantity]:
            self._progress(f"another way to {quantity}, {other.choice.way}")
            kernels = draft.kernels_along(other)
            if kernels in self._kernels[quantity]:
                continue
            largest, fault = _measured(draft, kernels, expected)
            if fault is not None:
                self._tried[quantity].append((other.choice.way, f"{fault.what} ({fault.target})"))
                self._kernels[quantity].append(kernels)
            elif largest <= MARGIN:
                return other, kernels
            else:
                passing.append((largest, other, kernels))
        if not passing:
            return None
        best = min(passing, key=lambda one: one[0])
        passing.remove(best)
        return best[1:]

    def _alternatives(self, draft: Draft, quantity: str) -> tuple[Alternative, ...]:
        if self._options.forms.get(quantity, AUTO) != AUTO:
            return ()
        self._progress(f"other ways to {quantity}")
        derivations = draft.derivations
        return alternatives(draft.model, derivations.generic, derivations.inverse, quantity)

    def _remedy(self, quantity: str) -> str:
        asked = self._options.forms.get(quantity, AUTO)
        if asked != AUTO:
            return f"leave `--form {quantity}={asked}` away: another form may pass"
        return "give narrower `ranges` if states near a singularity are never met; `--no-verify` writes it as it is"


def _measured(draft: Draft, kernels: Mapping[Scalar, Kernel], expected: Expected) -> tuple[float, Fault | None]:
    """The largest error of kernels by interpretation, in the scalar types that are verified, and what is wrong."""
    worst = 0.0
    for scalar in expected.scalars:
        largest, fault = measured(kernels[scalar], draft.programs[scalar].sincos, scalar, expected)
        if fault is not None:
            return largest, fault
        worst = max(worst, largest)
    return worst, None


def as_recorded(draft: Draft, recorded: Mapping[str, Any]) -> Draft:
    """The draft with what an earlier verification of the same model rejected, as its derivation.json tells it.

    Without verification, files can only be compared with those on disk if they are made the way these were.
    """
    if recorded.get("model_sha256") != draft.model.text_hash:
        return draft
    rejected = tuple(Rejection(r["quantity"], r["way"], r["why"]) for r in recorded.get("rejected", ()))
    derivations = draft.derivations
    for quantity in dict.fromkeys(one.quantity for one in rejected):
        if all(choice.quantity != quantity for choice in derivations.choices):
            continue
        kernel = recorded["kernels"].get(quantity)
        if kernel is None:
            draft = draft.without(quantity, REJECTED)
            continue
        other = alternative(draft.model, derivations.generic, derivations.inverse, quantity, kernel["way"])
        if other is not None:
            draft = draft.along(other, draft.kernels_along(other))
    return draft.rejecting(rejected)
