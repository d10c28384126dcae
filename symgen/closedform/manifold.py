"""Restriction to the constraint manifold: qd = W nu, qdd = W nu-dot + W-dot nu with a symbolic null-space basis W."""

from __future__ import annotations

from functools import cached_property

from symgen.closedform.algebra.matrices import dot, zero
from symgen.closedform.algebra.quotient import Quotient, polynomial
from symgen.closedform.exact import Exact
from symgen.closedform.mechanics import time_derivative
from symgen.model.model import Model


class Manifold:
    """Substitutes admissible rates and accelerations into fractions."""

    def __init__(self, model: Model, exact: Exact) -> None:
        self.model = model
        self.exact = exact
        self.ring = exact.ring

    @cached_property
    def _rates(self) -> dict[int, Quotient]:
        """Position of every rate to its row of W nu."""
        names = [self.exact.mechanics.translator.name(f"_velocity_{k}") for k in range(self.exact.delta)]
        return {
            self.ring.position[c.rate]: dot(self.ring, row, names)
            for c, row in zip(self.model.coordinates, self.exact.kernel, strict=True)
        }

    @cached_property
    def _accelerations(self) -> dict[int, Quotient]:
        """Position of every acceleration to its row of W nu-dot + W-dot nu."""
        translator = self.exact.mechanics.translator
        velocities = [translator.name(f"_velocity_{k}") for k in range(self.exact.delta)]
        changes = [translator.name(f"_acceleration_{k}") for k in range(self.exact.delta)]
        result = {}
        for c, row in zip(self.model.coordinates, self.exact.kernel, strict=True):
            slopes = [self._replace(time_derivative(translator, entry, self.model), self._rates) for entry in row]
            result[self.ring.position[c.acceleration]] = dot(self.ring, row, changes) + dot(
                self.ring, slopes, velocities
            )
        return result

    def restrict(self, value: Quotient) -> Quotient:
        """The fraction as a function of q, nu and nu-dot (and inputs and multipliers)."""
        if not self.model.constraints:
            return value
        return self._replace(value, {**self._rates, **self._accelerations})

    def _replace(self, value: Quotient, values: dict[int, Quotient]) -> Quotient:
        parts = []
        for p in (value.numerator, value.denominator):
            total = zero(self.ring)
            for monomial, coefficient in p.items():
                rest = self.ring.polys.zero.copy()
                rest[tuple(0 if i in values else e for i, e in enumerate(monomial))] = coefficient
                term = polynomial(self.ring, rest)
                for position, replacement in values.items():
                    for _ in range(monomial[position]):
                        term = term * replacement
                total = total + term
            parts.append(total)
        return parts[0] / parts[1]
