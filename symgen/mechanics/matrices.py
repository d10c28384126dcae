"""G and C of a system by whichever way counts least, for quantities that are made of them as they are.

Christoffel symbols are short where most slopes of G vanish, what momenta change by where coordinates move much
together, composite bodies in long trees.  The ways are compared on graphs apart: what they leave behind would come into
other quantities.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from functools import cached_property, partial
from typing import TYPE_CHECKING, TypeAlias

from symgen.mechanics.christoffel import by_christoffel_symbols, by_momenta
from symgen.mechanics.rigid_bodies.composite_bodies import composite_matrices
from symgen.runtime.effort import TooLongError, at_most, done
from symgen.symbolic.matrix import Matrix, Vector, flatten
from symgen.symbolic.traverse import cost, substitute

if TYPE_CHECKING:
    from symgen.mechanics.system import System

# Times what the shortest of the ways so far took to be made, after which another is given up: it would count more.
TAKEN = 3
SYMBOLS = "Christoffel symbols"
_Way: TypeAlias = "Callable[[System], Matrix]"


class Matrices:
    """Those of one system."""

    def __init__(self, system: System) -> None:
        self._system = system

    @cached_property
    def mass_matrix(self) -> Matrix:
        """G (3)."""
        ways: dict[str, _Way] = {**self._composites(0), "energies": lambda system: system.mass_matrix}
        return ways[self._shortest(ways)](self._system)

    @cached_property
    def _of_coriolis(self) -> dict[str, _Way]:
        return {**self._composites(1), "momenta": _by_momenta, SYMBOLS: _by_symbols}

    @cached_property
    def _coriolis_way(self) -> str:
        return self._shortest(self._of_coriolis)

    @cached_property
    def _coriolis_matrix(self) -> Matrix:
        return self._of_coriolis[self._coriolis_way](self._system)

    def coriolis_matrix(self, velocity: Vector) -> Matrix:
        """C (3) along a velocity: that of Christoffel symbols, by whichever way."""
        system, n = self._system, self._system.n
        if self._coriolis_way == SYMBOLS:
            return by_christoffel_symbols(system.graph, system.mass_matrix_gradient, velocity)
        if velocity == system.qd:
            return self._coriolis_matrix
        rates = dict(zip(system.qd, velocity, strict=True))
        along = substitute(system.graph, flatten(self._coriolis_matrix), rates)
        return tuple(tuple(along[i * n : (i + 1) * n]) for i in range(n))

    def _composites(self, which: int) -> dict[str, _Way]:
        """The ways by composite bodies, where there are such and nothing else moves."""
        if not self._system.is_of_bodies_alone:
            return {}
        return {
            f"composite bodies, {axes}": partial(_by_composites, which, in_world_axes=in_world_axes)
            for axes, in_world_axes in (("own axes", False), ("axes of the world", True))
        }

    def _shortest(self, ways: dict[str, _Way]) -> str:
        """The way that counts least, the last of those that count as much."""
        most, weights = math.inf, dict[str, int]()
        for name, way in ways.items() if len(ways) > 1 else ():
            before = done()
            with suppress(TooLongError), at_most(most):
                weights[name] = cost(flatten(way(self._system.apart()))).weight
            most = min(most, TAKEN * (done() - before))
        return min(reversed(ways), key=lambda name: weights.get(name, math.inf))


def _by_composites(which: int, system: System, in_world_axes: bool) -> Matrix:
    return composite_matrices(system.bodies, in_world_axes)[which]


def _by_momenta(system: System) -> Matrix:
    return by_momenta(system.graph, system.q, system.qd, system.mass_matrix, system.momentum)


def _by_symbols(system: System) -> Matrix:
    return by_christoffel_symbols(system.graph, system.mass_matrix_gradient, system.qd)
