"""Polynomials of a ring as flint's, in those generators only that they use: a ring may have more than a hundred."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any, TypeAlias

import flint
from sympy import QQ
from sympy.polys.rings import PolyElement

if TYPE_CHECKING:
    from symgen.closedform.algebra.ring import TrigRing

Monomial: TypeAlias = tuple[int, ...]

# SymPy's rationals are flint's own unless gmpy2 is there.
_FLINTS = QQ.dtype is flint.fmpq


@lru_cache(maxsize=256)
def _context(generators: int) -> flint.fmpq_mpoly_ctx:
    return flint.fmpq_mpoly_ctx.get([f"x{i}" for i in range(generators)], flint.Ordering.lex)


class UsedGenerators:
    """The generators of `ring` that some polynomials use, and both of a pair (s_i, c_i) where they use one.

    Their order is that of the ring, and so are leading terms.  `pairs` has the places of s_i and c_i among them.
    """

    def __init__(self, ring: TrigRing, polynomials: Iterable[PolyElement]) -> None:
        positions = {0}  # flint wants one
        for p in polynomials:
            positions.update(ring.shape(p))
        pairs = [pair for pair in zip(ring.sine, ring.cosine, strict=True) if not positions.isdisjoint(pair)]
        positions.update(position for pair in pairs for position in pair)
        self._ring = ring
        self._positions = tuple(sorted(positions))
        place = {position: index for index, position in enumerate(self._positions)}
        self.pairs = tuple((place[s], place[c]) for s, c in pairs)
        self._context = _context(len(place))

    def terms(self, p: PolyElement) -> dict[Monomial, flint.fmpq]:
        """Coefficients by monomial."""
        positions = self._positions
        return {tuple([monomial[i] for i in positions]): _coefficient(c) for monomial, c in p.items()}

    def polynomial(self, terms: Mapping[Monomial, flint.fmpq]) -> flint.fmpq_mpoly:
        """Coefficients by monomial as a polynomial."""
        return self._context.from_dict(terms)

    def image(self, p: PolyElement) -> flint.fmpq_mpoly:
        """An element of the ring as flint's."""
        return self.polynomial(self.terms(p))

    def generator(self, place: int) -> flint.fmpq_mpoly:
        """The generator at a place."""
        return self._context.gen(place)

    @cached_property
    def circles(self) -> tuple[flint.fmpq_mpoly, ...]:
        """s_i^2 + c_i^2 of the pairs."""
        return tuple(self.generator(s) ** 2 + self.generator(c) ** 2 for s, c in self.pairs)

    def element(self, p: flint.fmpq_mpoly) -> PolyElement:
        """One of flint's as an element of the ring."""
        result = self._ring.polys.zero.copy()
        nothing = [0] * self._ring.polys.ngens
        for reduced, c in p.to_dict().items():
            monomial = nothing.copy()
            for position, exponent in zip(self._positions, reduced, strict=True):
                monomial[position] = int(exponent)
            result[tuple(monomial)] = c if _FLINTS else QQ(c.numerator, c.denominator)
        return result


def _coefficient(value: Any) -> flint.fmpq:
    return value if _FLINTS else flint.fmpq(int(value.numerator), int(value.denominator))
