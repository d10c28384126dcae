"""G and C of a system by whichever way counts least, for quantities that are made of them as they are.

Christoffel symbols are short where most slopes of G vanish, what momenta change by where coordinates move much
together, composite bodies in long trees.  The ways are compared on graphs apart: what they leave behind would come into
other quantities.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
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

# Times what the first way takes to be made, after which another is not looked at: what takes more counts more.
TAKEN = 3
_Way: TypeAlias = "Callable[[System], Matrix]"


class Matrices:
    """Those of one system."""

    def __init__(self, system: System) -> None:
        self._system = system

    @cached_property
    def mass_matrix(self) -> Matrix:
        """G (3)."""
        return self._shortest({**self._composites(0), "energies": lambda system: system.mass_matrix})

    @cached_property
    def _coriolis_matrix(self) -> Matrix:
        ways: dict[str, _Way] = {"momenta": _by_momenta, "Christoffel symbols": _by_symbols}
        return self._shortest({**self._composites(1), **ways})

    def coriolis_matrix(self, velocity: Vector) -> Matrix:
        """C (3) along a velocity: that of Christoffel symbols, by whichever way."""
        system, n = self._system, self._system.n
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

    def _shortest(self, ways: Mapping[str, _Way]) -> Matrix:
        """By the way that counts least, the first of those that count as much."""
        most, weights = math.inf, dict[str, int]()
        for name, way in ways.items() if len(ways) > 1 else ():
            before = done()
            with suppress(TooLongError), at_most(most):
                weights[name] = cost(flatten(way(self._system.apart()))).weight
            most = min(most, TAKEN * (done() - before))
        return ways[min(ways, key=lambda name: weights.get(name, math.inf))](self._system)


def _by_composites(which: int, system: System, in_world_axes: bool) -> Matrix:
    return composite_matrices(system.bodies, lumped=True, in_world_axes=in_world_axes)[which]


def _by_momenta(system: System) -> Matrix:
    return by_momenta(system.graph, system.q, system.qd, system.mass_matrix, system.momentum)


def _by_symbols(system: System) -> Matrix:
    return by_christoffel_symbols(system.graph, system.mass_matrix_gradient, system.qd)
