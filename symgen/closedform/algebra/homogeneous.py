"""Common factors and factorisation of ring elements, by way of homogeneous polynomials.

A polynomial whose monomials all have the same degree parity in (s_i, c_i) becomes homogeneous in each pair after
multiplication with powers of s_i^2 + c_i^2 = 1.  There the ordinary polynomial ring is a unique factorisation domain,
so ordinary gcd and factorisation recognise sin(a - b) and the like.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import prod
from typing import TypeAlias

import flint
from sympy import QQ
from sympy.polys.rings import PolyElement

from symgen.closedform.algebra.ring import TrigRing, primitive
from symgen.closedform.algebra.used import Monomial, UsedGenerators

# A polynomial of more terms, once homogeneous, is factored as an ordinary one only: its length doubles with every angle
# that a monomial lacks.
MOST_HOMOGENEOUS_TERMS = 3_000


# The terms of one degree parity in every pair (s_i, c_i), by the powers of s_i^2 + c_i^2 that each lacks.
_Parts: TypeAlias = Mapping[Monomial, Mapping[Monomial, flint.fmpq]]


def _classes(used: UsedGenerators, p: PolyElement) -> list[_Parts]:
    """The parity classes of p; with the powers they lack all terms of one have the same degree in a pair."""
    classes: dict[tuple[int, ...], list[tuple[Monomial, flint.fmpq, list[int]]]] = {}
    for monomial, coefficient in used.terms(p).items():
        degrees = [monomial[s] + monomial[c] for s, c in used.pairs]
        classes.setdefault(tuple([d % 2 for d in degrees]), []).append((monomial, coefficient, degrees))
    return [_parts(classes[key]) for key in sorted(classes)]


def _parts(terms: Sequence[tuple[Monomial, flint.fmpq, list[int]]]) -> _Parts:
    tops = [max(column) for column in zip(*(degrees for _, _, degrees in terms), strict=True)]
    parts: dict[Monomial, dict[Monomial, flint.fmpq]] = {}
    for monomial, coefficient, degrees in terms:
        missing = tuple([(top - d) // 2 for top, d in zip(tops, degrees, strict=True)])
        parts.setdefault(missing, {})[monomial] = coefficient
    return parts


def _images(used: UsedGenerators, p: PolyElement) -> list[flint.fmpq_mpoly]:
    """The parity classes of p, each made homogeneous in every pair (s_i, c_i)."""
    return [_raised(used, parts) for parts in _classes(used, p)]


def _raised(used: UsedGenerators, parts: _Parts) -> flint.fmpq_mpoly:
    """One parity class times powers of s_i^2 + c_i^2 = 1, so that all its terms have the same degree in a pair."""
    if len(parts) == 1:
        (part,) = parts.values()
        return used.polynomial(part)  # one of its terms lacks nothing
    total = used.polynomial({})
    for missing, part in parts.items():
        raised = used.polynomial(part)
        for circle, times in zip(used.circles, missing, strict=True):
            if times:
                raised *= circle**times
        total += raised
    return total


def parity_classes(ring: TrigRing, p: PolyElement) -> list[PolyElement]:
    """The parts of p with one degree parity in every pair (s_i, c_i); their sum is p."""
    parts: dict[tuple[int, ...], PolyElement] = {}
    pairs = tuple(zip(ring.sine, ring.cosine, strict=True))
    for monomial, coefficient in p.items():
        key = tuple([(monomial[s] + monomial[c]) % 2 for s, c in pairs])
        parts.setdefault(key, ring.polys.zero.copy())[monomial] = coefficient
    return [parts[key] for key in sorted(parts)]


def homogeneous(ring: TrigRing, p: PolyElement) -> PolyElement:
    """A normal form of one parity class, made homogeneous in every pair (s_i, c_i)."""
    used = UsedGenerators(ring, [p])
    (result,) = _images(used, p)
    return used.element(result)


def _homogeneous_terms(parts: _Parts) -> int:
    """How many terms a parity class has at most when it is homogeneous."""
    return sum(len(part) * prod([times + 1 for times in missing]) for missing, part in parts.items())


def common_factor(ring: TrigRing, polynomials: Iterable[PolyElement]) -> PolyElement:
    """The greatest common factor of normal forms: homogeneous, primitive, leading coefficient positive."""
    ordered = sorted((p for p in polynomials if p), key=len)
    if not ordered or any(p.is_ground for p in ordered):
        return ring.one
    used = UsedGenerators(ring, ordered)
    result: flint.fmpq_mpoly | None = None
    for p in ordered:
        for image in _images(used, p):
            result = image if result is None else result.gcd(image)
            if result.is_constant():
                return ring.one
    return _upright(used.element(result))


def _upright(p: PolyElement) -> PolyElement:
    _, p = primitive(p)
    return -p if p.LC < 0 else p


def divide(ring: TrigRing, p: PolyElement, factor: PolyElement) -> PolyElement:
    """p / factor for a homogeneous common factor, in normal form."""
    if factor == 1:
        return p
    used = UsedGenerators(ring, (p, factor))
    divisor = used.image(factor)
    result = ring.zero
    for image in _images(used, p):
        quotient, remainder = divmod(image, divisor)
        if remainder != 0:
            raise ArithmeticError("not a common factor")
        result = result + ring.normal(used.element(quotient))
    return result


def cancel_plain(ring: TrigRing, numerator: PolyElement, denominator: PolyElement) -> tuple[PolyElement, PolyElement]:
    """Cancel a common factor of the normal forms as ordinary polynomials, which helps a denominator of mixed parity."""
    if len(denominator) == 1 or len(parity_classes(ring, denominator)) == 1:
        return numerator, denominator
    used = UsedGenerators(ring, (numerator, denominator))
    top, bottom = used.image(numerator), used.image(denominator)
    shared = top.gcd(bottom)
    if shared.is_constant():
        return numerator, denominator
    return used.element(divmod(top, shared)[0]), used.element(divmod(bottom, shared)[0])


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
        return ring.polys.ground_new(coefficient), tuple(single)
    ring.work.spend(len(p) * ring.polys.ngens)
    whole = UsedGenerators(ring, [p])
    classes = _classes(whole, p)
    if any(_homogeneous_terms(parts) > MOST_HOMOGENEOUS_TERMS for parts in classes):
        images = [(whole, whole.image(p))]
    elif len(classes) == 1:
        images = [(whole, _raised(whole, classes[0]))]
    else:
        content = common_factor(ring, [p])
        over = ((UsedGenerators(ring, [q]), q) for q in (content, divide(ring, p, content)) if q != 1)
        images = [(used, used.image(q)) for used, q in over]
    constant = ring.one
    factors: list[tuple[PolyElement, int]] = []
    for used, image in images:
        leading, parts = image.factor()
        constant = constant * ring.polys.ground_new(QQ(leading.numerator, leading.denominator))
        for part, multiplicity in parts:
            q = used.element(part)
            upright = _upright(q)
            constant = constant * (q.LC / upright.LC) ** int(multiplicity)
            factors.append((upright, int(multiplicity)))
    if len(factors) > 1:
        factors.sort(key=lambda item: _order(item[0]))
    return constant, tuple(factors)


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
