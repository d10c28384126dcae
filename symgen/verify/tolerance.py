"""How far a correct kernel may be from the reference.

|y - y*| <= 16 (d + eps |y*|), where d is the largest |y*(x + dx) - y*| over 8 random dx with |dx_i| = eps |x_i| in
all inputs, run-time parameters and literals of the model.  So d holds the condition of the quantity at this state.

Verification is stricter: literals that the scalar type holds do not move, such as the ones in the direction of a slide
along [1, 1, 0], which stays parallel to the axis of its joint.  Moved they would make an over-constrained linkage count
as ill-conditioned where nothing that is rounded makes it so.  Axes and quarter turns are no literals here.  Sweeps
towards singular sets take the rule as it stands, and so does what solves g(q) = 0: the terms of g are rounded, be they
literals or not.
"""

from __future__ import annotations

import random
import struct
from bisect import bisect_left, insort
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isclose
from typing import Any

from flint import arb, arb_mat

from symgen.ir.kernel import UNIT_ROUNDOFF, Scalar
from symgen.model.expressions.expression import Pi
from symgen.verify.reference.arithmetic.linear import norm
from symgen.verify.reference.arithmetic.tape import ball, precision
from symgen.verify.reference.quantities import ITERATED
from symgen.verify.reference.reference import VANISHING, Reference, ReferenceValueError, State

# Units of error that a correct kernel may be away.
FACTOR = 16.0
# Random changes of which d is the largest effect.
PERTURBATIONS = 8
# Numbers of a state are of equal size up to this share, which is some roundings of float32.
ALIKE = 1e-6
# Binary digits of states that are moved, and of what they make of results; next to singular states this leaves none,
# and more are taken where results are not known to a share of eps.
PERTURBED_BITS, MOST_PERTURBED = 160, 640
# A result is known where its radius is below this share of eps of its size; else more digits are taken.
KNOWN = 1 / 16
# Binary digits of a distance: only its size counts.
DISTANCE_BITS = 64


@dataclass(frozen=True, slots=True)
class Expectation:
    """The reference value y* of a quantity at a state, |y*|, and the unit of error d + eps |y*| of a scalar type."""

    value: Any
    size: float
    unit: float

    def distance(self, entries: Sequence[float]) -> float:
        """|y - y*|, exact to a float; NaN when an entry is not finite."""
        with precision(DISTANCE_BITS):
            return norm(arb_mat(self.value.nrows(), self.value.ncols(), list(entries)) - self.value)

    def in_units(self, distance: float) -> float:
        """A distance in units of d + eps |y*|; 0 for an exact result, infinite for another where the unit is 0."""
        if distance == 0:
            return 0.0
        return distance / self.unit if self.unit else float("inf")


def expectations(
    reference: Reference,
    state: State,
    quantities: Sequence[str],
    scalar: Scalar,
    seed: str,
    all_literals: bool = False,
) -> dict[str, Expectation]:
    """Reference values and error units of the quantities at a state rounded to the scalar type.

    With `all_literals` those move too that the type holds.
    """
    for estimate in _estimates(reference, state, quantities, scalar, seed, all_literals):
        made = estimate
    return made


def is_beyond(
    reference: Reference, state: State, quantity: str, scalar: Scalar, seed: str, entries: Sequence[float], units: float
) -> bool:
    """Whether entries are more than so many units away from the reference value of `expectations`."""
    return GrowingUnit(reference, state, quantity, scalar, seed).units_above(entries, units) > units


class GrowingUnit:
    """What `expectations` has for a quantity at a state, with no more changes looked at than it takes.

    Raises ReferenceValueError where there is no value.
    """

    def __init__(self, reference: Reference, state: State, quantity: str, scalar: Scalar, seed: str) -> None:
        self._quantity = quantity
        self._estimates = _estimates(reference, state, [quantity], scalar, seed)
        self._last = next(self._estimates)[quantity]

    def units_above(self, entries: Sequence[float], least: float) -> float:
        """How many units entries are away from the reference value, or the `least` where they are no more than that.

        Raises ReferenceValueError where there is none beside the state.
        """
        distance = self._last.distance(entries)
        while (units := self._last.in_units(distance)) > least:
            following = next(self._estimates, None)
            if following is None:
                return units
            self._last = following[self._quantity]
        return least


def _estimates(
    reference: Reference,
    state: State,
    quantities: Sequence[str],
    scalar: Scalar,
    seed: str,
    all_literals: bool = False,
) -> Iterator[dict[str, Expectation]]:
    """Expectations with no change looked at, with one, and so on: units of error grow up to the last ones."""
    exact = reference.precise(state, quantities)
    eps = float(UNIT_ROUNDOFF[scalar])
    sizes = {name: norm(exact[name]) for name in quantities}
    worst = dict.fromkeys(quantities, 0.0)
    solved = [name for name in quantities if name in ITERATED]
    others = [name for name in quantities if name not in ITERATED]

    def made() -> dict[str, Expectation]:
        return {name: Expectation(exact[name], sizes[name], worst[name] + eps * sizes[name]) for name in quantities}

    yield made()
    generator = random.Random(seed)
    with precision(PERTURBED_BITS):
        state = State(*(tuple(map(ball, part)) for part in state.parts))

    def values(names: Sequence[str], signs: Sequence[int], whole: bool, bits: int) -> dict[str, Any]:
        with precision(bits):
            moved, literals = perturbed(reference, state, scalar, signs, whole)
        made = reference.matrices(moved, names, bits, literals)
        # what vanishes has no digits that more of them would show
        seen = (name for name in names if sizes[name] > VANISHING)
        vague = any(_radius(made[name]) > KNOWN * eps * sizes[name] for name in seen)
        return values(names, signs, whole, 2 * bits) if vague and bits < MOST_PERTURBED else made

    drawn = _signs(reference, state, generator)
    # what is solved for holds few numbers, of which two may be all that counts
    apart = _set_apart(drawn, generator) if solved else drawn
    for signs, signs_of_solved in zip(drawn, apart, strict=True):
        results: dict[str, Any] = {}
        if others:
            results |= values(others, signs, all_literals, PERTURBED_BITS)
        if solved:
            try:
                results |= values(solved, signs_of_solved, True, PERTURBED_BITS)
            except ReferenceValueError:
                # a loop that stands twice in a file does not close where its numbers move apart; no type does that
                results |= values(solved, _alike(reference, signs_of_solved), True, PERTURBED_BITS)
        with precision(DISTANCE_BITS):
            for name, matrix in results.items():
                worst[name] = max(worst[name], norm(matrix - exact[name]))
        yield made()


def _radius(matrix: Any) -> float:
    """The largest of its entries."""
    return max((float(x.rad()) for x in matrix.entries()), default=0.0)


def perturbed(
    reference: Reference, state: State, scalar: Scalar, signs: Sequence[int], all_literals: bool = False
) -> tuple[State, list[Any]]:
    """The state and the literals with every number x moved by +-eps |x| (rounded to the working precision).

    `signs` are 1 for outwards and 0 for inwards, one a number: those of the state, then literals.  Literals
    that the scalar type holds stay as they are unless `all_literals` move.
    """
    eps = ball(UNIT_ROUNDOFF[scalar])
    factors = (arb(1) - eps, arb(1) + eps)
    sign = iter(signs)

    def move(values: Sequence[Any]) -> tuple[Any, ...]:
        return tuple((ball(x) * factors[next(sign)]).mid() for x in values)

    parts = [move(part) for part in state.parts]
    held = [
        not (all_literals or isinstance(literal, Pi)) and _is_held(literal.value, scalar)
        for literal in reference.system.literals
    ]
    exact = reference.literals()
    literals = [x if stays else moved for stays, x, moved in zip(held, exact, move(exact), strict=True)]
    return State(*parts), literals


def _is_held(value: Fraction, scalar: Scalar) -> bool:
    """Whether the scalar type has this number."""
    try:
        nearest = float(value)
        return Fraction(nearest if scalar == "float64" else struct.unpack("f", struct.pack("f", nearest))[0]) == value
    except OverflowError:
        return False


def _signs(reference: Reference, state: State, generator: random.Random) -> list[list[int]]:
    """Random signs for each perturbation, of which every two numbers of equal size have both pairs that are not alike.

    By chance one pair in 16 lacks one of these, and of many equal numbers a few go on doing so.  What vanishes where
    the two are equal, as on a parallelogram, shows no change at all if they move together every time, nor if they
    change places only, and there is no unit of error.  Nor has what a difference of two literals holds, such as the
    closure of a loop.
    """
    parts = (*state.parts, reference.literals())
    count = sum(map(len, parts))
    drawn = [[generator.getrandbits(1) for _ in range(count)] for _ in range(PERTURBATIONS)]
    # of each number a bit for each perturbation
    moves = [sum(sign << k for k, sign in enumerate(signs)) for signs in zip(*drawn, strict=True)]
    begin = 0
    for part in parts:
        sizes = [abs(float(x)) for x in part]
        for j, alike in enumerate(_earlier_alike(sizes)):
            own = moves[begin + j]
            for i in alike:
                outwards = moves[begin + i]
                inwards = outwards ^ 2**PERTURBATIONS - 1
                if inwards and not own & inwards:
                    own ^= inwards & -inwards
                if outwards and own & outwards == outwards:
                    own ^= outwards & -outwards
            moves[begin + j] = own
        begin += len(part)
    return [[move >> k & 1 for move in moves] for k in range(PERTURBATIONS)]


def _earlier_alike(sizes: Sequence[float]) -> Iterator[list[int]]:
    """Of each number the places of those before it that are as large, in order; none of what is 0."""
    before: list[tuple[float, int]] = []
    for j, size in enumerate(sizes):
        near = before[bisect_left(before, (size * (1 - 2 * ALIKE),)) : bisect_left(before, (size * (1 + 2 * ALIKE),))]
        yield sorted(i for other, i in near if isclose(other, size, rel_tol=ALIKE)) if size else []
        insort(before, (size, j))


def _set_apart(drawn: Sequence[Sequence[int]], generator: random.Random) -> list[list[int]]:
    """The signs, and others for a number that would move as an earlier one does each time, or the opposite way.

    By chance one pair in 128 does.  What depends on how two numbers lie to each other, such as a task where its slope
    all but vanishes, shows no change at all then.
    """
    made, met = [list(signs) for signs in drawn], set[tuple[int, ...]]()
    for number in range(len(drawn[0])):
        while (own := tuple(signs[number] ^ made[0][number] for signs in made)) in met:
            if len(met) == 2 ** (len(made) - 1):
                met.clear()
            for signs in made:
                signs[number] = generator.getrandbits(1)
        met.add(own)
    return made


def _alike(reference: Reference, signs: Sequence[int]) -> list[int]:
    """The signs, with literals of one size moving together."""
    sizes = [abs(float(x)) for x in reference.literals()]
    numbers = len(signs) - len(sizes)
    first = dict(zip(sizes, signs[numbers:], strict=True))
    return [*signs[:numbers], *(first[size] for size in sizes)]
