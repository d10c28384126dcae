"""The nearest bodies that can be, as data: what is unknown, what it costs, and what has to be positive."""

from __future__ import annotations

import numpy as np

from symgen.identification.arrays import Array
from symgen.identification.bodies.pseudo_inertia import of_coordinates
from symgen.records import dataclass

# Of a pseudo-inertia at mass and length of its body, the smallest eigenvalue that is left: a radius of gyration of a
# hundredth of the length.  A thinner plate is one in no log, and 6 digits of a file still keep this one positive.
LEAST_EIGENVALUE = 1e-4


@dataclass(frozen=True, slots=True)
class NearestBodies:
    """Minimise |factor (x - centre)|^2 where bodies and rotors can be.

    x (v) holds ten coordinates of the scaled pseudo-inertia of each of `bodies`, then `rotors` scaled inertias, then
    what is free.  `factor` (v, v) is upper triangular; `possible` (v) is a point where everything is.
    """

    centre: Array
    factor: Array
    bodies: int
    rotors: int
    possible: Array

    @property
    def fixed_sign(self) -> slice:
        """Where in x the rotors are."""
        return slice(10 * self.bodies, 10 * self.bodies + self.rotors)

    def pseudo_inertias(self, x: Array) -> list[Array]:
        """Those (4, 4) of the bodies, scaled."""
        return [of_coordinates(x[10 * k : 10 * k + 10]) for k in range(self.bodies)]

    def least(self, x: Array) -> Array:
        """What each body and rotor has beyond the least, negative where it cannot be."""
        of_bodies = [float(np.linalg.eigvalsh(one)[0]) for one in self.pseudo_inertias(x)]
        return np.array([*of_bodies, *x[self.fixed_sign]]) - LEAST_EIGENVALUE

    def cost(self, x: Array) -> float:
        """What is minimised, beyond its least value without conditions."""
        return float(np.sum((self.factor @ (x - self.centre)) ** 2))
