"""The test vectors of a model: regular states, states at and near singularities, numbers no state should hold."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from math import inf, nan
from typing import Literal, TypeAlias

from symgen.generation.runnable import rounded_state
from symgen.ir.kernel import UNIT_ROUNDOFF, Scalar
from symgen.laboratory.stress.families import search
from symgen.verify.reference.reference import Reference, State
from symgen.verify.sampling.states import sample_states
from symgen.verify.sampling.task_ahead import with_task

FEWEST = 256
CONFIGURATIONS = 64  # finding one on the constraints takes a mechanism of many links a tenth of a second
# Zeros of determinants are looked for in models of so many coordinates; beyond, one determinant takes ten seconds.
SEARCHED = 8
MOST_DETERMINANTS = 2  # of each kind
SINGULAR_KINDS = ("constraint", "input", "parameter")
NEAR = (0.0, 1e-8)  # distances from a singular configuration
FAR = (1e-3, 1e-6)  # angles of a thousand and a million
PERTURBATIONS = 6

Part: TypeAlias = Literal["q", "qd", "qdd", "u", "parameters", "task"]
PARTS: tuple[Part, ...] = ("q", "qd", "qdd", "u", "parameters", "task")


@dataclass(frozen=True, slots=True)
class Vectors:
    """States in float64 numbers: regular ones first, then singular ones and those with large angles, then odd ones."""

    regular: tuple[State, ...]
    singular: tuple[State, ...]
    odd: tuple[State, ...]

    def rounded(self, scalar: Scalar) -> tuple[State, ...]:
        """All of them in numbers of a scalar type."""
        return tuple(rounded_state(state, scalar) for state in (*self.regular, *self.singular, *self.odd))


def vectors_of(reference: Reference) -> Vectors:
    """Seeded and deterministic; raises VerificationError where hardly any state is found."""
    states = [sample.state for sample in sample_states(reference, (), CONFIGURATIONS, seed=2)]
    regular = tuple(islice(_mixed(states), FEWEST))
    singular = (with_task(reference, state) for state in _singular(reference))
    return Vectors(regular, (*singular, *_degenerate(regular[0])), tuple(_odd(regular[0])))


def _mixed(states: Sequence[State]) -> Iterator[State]:
    """Each configuration with its own rates, accelerations and inputs, then with those of its neighbours in turn."""
    for shift in range(len(states)):
        for place, state in enumerate(states):
            other = states[(place + shift) % len(states)]
            yield replace(state, qd=other.qd, qdd=other.qdd, u=other.u)


def perturbed(states: tuple[State, ...], scalar: Scalar) -> tuple[State, ...]:
    """Each state `PERTURBATIONS` times, every number moved by one unit roundoff of the scalar type up or down."""
    generator = random.Random("perturbed")
    eps = float(UNIT_ROUNDOFF[scalar])
    return tuple(
        replace(state, **{part: tuple(x * (1 + eps * generator.choice((-1, 1))) for x in getattr(state, part))
                          for part in PARTS})
        for state in states
        for _ in range(PERTURBATIONS)
    )


def _singular(reference: Reference) -> Iterator[State]:
    if reference.model.n > SEARCHED:
        return
    for family in search(reference, MOST_DETERMINANTS).families:
        distances = NEAR if family.kind in SINGULAR_KINDS else FAR if family.kind == "large angles" else ()
        for curve in family.curves:
            yield from (state for d in distances if (state := curve(d)) is not None)


def _degenerate(state: State) -> Iterator[State]:
    """Every coordinate 0, where mechanisms are stretched; and every parameter 0 in turn, such as a length or a mass."""
    yield replace(state, q=(0.0,) * len(state.q))
    for place in range(len(state.parameters)):
        yield replace(state, parameters=(*state.parameters[:place], 0.0, *state.parameters[place + 1 :]))


def _odd(state: State) -> Iterator[State]:
    """Every number in turn replaced by one that is none, the first of each array by infinity and a huge one as well."""
    for part in PARTS:
        values = getattr(state, part)
        for place in range(len(values)):
            for odd in (nan, inf, -3e38) if place == 0 else (nan,):
                yield replace(state, **{part: (*values[:place], odd, *values[place + 1 :])})
