"""Common factors and factorisation of ring elements, by way of homogeneous polynomials.

A polynomial whose monomials all have the same degree parity in (s_i, c_i) becomes homogeneous in each pair after
multiplication with powers of s_i^2 + c_i^2 = 1.  There the ordinary polynomial ring is a unique factorisation domain,
so ordinary gcd and factorisation recognise sin(a - b) and the like (theory.md, section 5).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from math import prod

import flint
from sympy import QQ
from sympy.polys.rings import PolyElement

from symgen.closedform.ring import TrigRing

# A polynomial of more terms, once homogeneous, is factored as an ordinary one only: its length doubles with every angle
# that a monomial lacks.
MOST_TERMS = 3_000


@lru_cache(maxsize=64)
def _context(generators: int) -> flint.fmpq_mpoly_ctx:
    return flint.fmpq_mpoly_ctx.get([f"x{i}" for i in range(generators)], flint.Ordering.lex)


def _to_flint(p: PolyElement) -> flint.fmpq_mpoly:
    terms = {m: flint.fmpq(int(c.numerator), int(c.denominator)) for m, c in p.items()}
    return _context(p.ring.ngens).from_dict(terms)


def _from_flint(ring: TrigRing, p: flint.fmpq_mpoly) -> PolyElement:
    result = ring.polys.zero.copy()
    for monomial, c in p.to_dict().items():
        result[tuple(int(e) for e in monomial)] = QQ(int(c.numerator), int(c.denominator))
    return result


def parity_classes(ring: TrigRing, p: PolyElement) -> list[PolyElement]:
    """The parts of p with one degree parity in every pair (s_i, c_i); their sum is p."""
    parts: dict[tuple[int, ...], PolyElement] = {}
    pairs = tuple(zip(ring.sine, ring.cosine, strict=True))
    for monomial, coefficient in p.items():
        key = tuple((monomial[s] + monomial[c]) % 2 for s, c in pairs)
        parts.setdefault(key, ring.polys.zero.copy())[monomial] = coefficient
    return [parts[key] for key in sorted(parts)]


def homogeneous(ring: TrigRing, p: PolyElement) -> PolyElement:
    """A normal form of one parity class, made homogeneous in every pair (s_i, c_i)."""
    for s, c in zip(ring.sine, ring.cosine, strict=True):
        degrees = {monomial[s] + monomial[c] for monomial in p}
        if len(degrees) < 2:
            continue
        top = max(degrees)
        one = ring.generator(s) ** 2 + ring.generator(c) ** 2
        parts: dict[int, PolyElement] = {}
        for monomial, coefficient in p.items():
            missing = (top - monomial[s] - monomial[c]) // 2
            parts.setdefault(missing, ring.polys.zero.copy())[monomial] = coefficient
        p = sum((part * one**missing for missing, part in parts.items()), ring.zero)
    return p


def _homogeneous_terms(ring: TrigRing, p: PolyElement) -> int:
    """How many terms `homogeneous` has to write at most."""
    pairs = tuple(zip(ring.sine, ring.cosine, strict=True))
    degrees = [[monomial[s] + monomial[c] for s, c in pairs] for monomial in p]
    tops = [max(column) for column in zip(*degrees, strict=True)]
    return sum(prod((top - degree) // 2 + 1 for top, degree in zip(tops, row, strict=True)) for row in degrees)


def common_factor(ring: TrigRing, polynomials: Iterable[PolyElement]) -> PolyElement:
    """The greatest common factor of normal forms: homogeneous, primitive, leading coefficient positive."""
    result: flint.fmpq_mpoly | None = None
    for p in sorted((p for p in polynomials if p), key=len):
        for part in parity_classes(ring, p):
            image = _to_flint(homogeneous(ring, part))
            result = image if result is None else result.gcd(image)
            if result.is_constant():
                return ring.one
    return ring.one if result is None else _primitive(_from_flint(ring, result))


def _primitive(p: PolyElement) -> PolyElement:
    _, p = p.primitive()
    return -p if p.LC < 0 else p


def divide(ring: TrigRing, p: PolyElement, factor: PolyElement) -> PolyElement:
    """p / factor for a homogeneous common factor, in normal form."""
    if factor == 1:
        return p
    divisor = _to_flint(factor)
    result = ring.zero
    for part in parity_classes(ring, p):
        quotient, remainder = divmod(_to_flint(homogeneous(ring, part)), divisor)
        if remainder != 0:
            raise ArithmeticError("not a common factor")
        result = result + ring.normal(_from_flint(ring, quotient))
    return result


def cancel_plain(ring: TrigRing, numerator: PolyElement, denominator: PolyElement) -> tuple[PolyElement, PolyElement]:
    """Cancel a common factor of the normal forms as ordinary polynomials, which helps a denominator of mixed parity."""
    if len(denominator) == 1 or len(parity_classes(ring, denominator)) == 1:
        return numerator, denominator
    top, bottom = _to_flint(numerator), _to_flint(denominator)
    shared = top.gcd(bottom)
    if shared.is_constant():
        return numerator, denominator
    return _from_flint(ring, divmod(top, shared)[0]), _from_flint(ring, divmod(bottom, shared)[0])


def factorise(ring: TrigRing, p: PolyElement) -> tuple[PolyElement, tuple[tuple[PolyElement, int], ...]]:
    """(rational constant, irreducible factors with multiplicities) of a normal form.

    Factors are homogeneous, with coprime integer coefficients and a positive leading coefficient.  A part of mixed
    parity is factored as an ordinary polynomial, and so is what would be too long when homogeneous.
    """
    if not p or p.is_ground:
        return p, ()
    if len(p) == 1:
        ((monomial, coefficient),) = p.items()
        single = [(ring.generator(i), e) for i, e in enumerate(monomial) if e]
        return ring.polys.ground_new(coefficient), tuple(sorted(single, key=lambda item: _order(item[0])))
    ring.work.spend(len(p) * ring.polys.ngens)
    long = any(_homogeneous_terms(ring, part) > MOST_TERMS for part in parity_classes(ring, p))
    content = ring.one if long else common_factor(ring, [p])
    rest = divide(ring, p, content)
    constant = ring.one
    factors: list[tuple[PolyElement, int]] = []
    for image in (content, rest):
        leading, parts = _to_flint(image).factor()
        constant = constant * ring.polys.ground_new(QQ(int(leading.numerator), int(leading.denominator)))
        for part, multiplicity in parts:
            q = _from_flint(ring, part)
            primitive = _primitive(q)
            constant = constant * (q.LC / primitive.LC) ** int(multiplicity)
            factors.append((primitive, int(multiplicity)))
    return constant, tuple(sorted(factors, key=lambda item: _order(item[0])))


def _order(p: PolyElement) -> tuple[int, Sequence[tuple[int, ...]], Sequence[str]]:
    terms = sorted(p.terms(), reverse=True)
    return (len(terms), [tuple(-e for e in m) for m, _ in terms], [str(c) for _, c in terms])


def never_zero(ring: TrigRing, factor: PolyElement) -> bool:
    """Whether a homogeneous factor is certainly free of real zeros, for parameters other than zero.

    True for a factor without angles and coordinates that is a monomial, and for sums of even monomials with positive
    coefficients that contain, for one pair (s, c), both a pure power of s and a pure power of c.
    """
    positive = all(c > 0 for c in factor.coeffs()) and all(e % 2 == 0 for m in factor for e in m)
    used = ring.shape(factor)
    angles = [i for i in range(len(ring.sine)) if ring.sine[i] in used or ring.cosine[i] in used]
    if not angles:
        return False
    if not positive:
        return False
    corners = set()
    for monomial in factor:
        corner = []
        for i in angles:
            s, c = monomial[ring.sine[i]], monomial[ring.cosine[i]]
            if s and c:
                break
            corner.append(s > 0)
        else:
            corners.add(tuple(corner))
    return bool(len(corners) == 2 ** len(angles))
