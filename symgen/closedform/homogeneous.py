"""Common factors and factorisation of ring elements, by way of homogeneous polynomials.

A polynomial whose monomials all have the same degree parity in (s_i, c_i) becomes homogeneous in each pair after
multiplication with powers of s_i^2 + c_i^2 = 1.  There the ordinary polynomial ring is a unique factorisation domain,
so ordinary gcd and factorisation recognise sin(a - b) and the like (theory.md, section 5).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import prod

import flint
from sympy import QQ
from sympy.polys.rings import PolyElement

from symgen.closedform.ring import TrigRing
from symgen.closedform.used import Monomial, Used

# A polynomial of more terms, once homogeneous, is factored as an ordinary one only: its length doubles with every angle
# that a monomial lacks.
MOST_TERMS = 3_000


def _images(used: Used, p: PolyElement) -> list[flint.fmpq_mpoly]:
    """The parity classes of p, each made homogeneous in every pair (s_i, c_i)."""
    classes: dict[tuple[int, ...], dict[Monomial, flint.fmpq]] = {}
    for monomial, coefficient in used.terms(p).items():
        key = tuple([(monomial[s] + monomial[c]) % 2 for s, c in used.pairs])
        classes.setdefault(key, {})[monomial] = coefficient
    return [_raised(used, classes[key]) for key in sorted(classes)]


def _raised(used: Used, terms: Mapping[Monomial, flint.fmpq]) -> flint.fmpq_mpoly:
    """One parity class times powers of s_i^2 + c_i^2 = 1, so that all its terms have the same degree in a pair."""
    degrees = {monomial: [monomial[s] + monomial[c] for s, c in used.pairs] for monomial in terms}
    tops = [max(column) for column in zip(*degrees.values(), strict=True)]
    parts: dict[Monomial, dict[Monomial, flint.fmpq]] = {}
    for monomial, coefficient in terms.items():
        missing = tuple([(top - d) // 2 for top, d in zip(tops, degrees[monomial], strict=True)])
        parts.setdefault(missing, {})[monomial] = coefficient
    total = used.polynomial({})
    for missing, part in parts.items():
        raised = used.polynomial(part)
        for (s, c), times in zip(used.pairs, missing, strict=True):
            if times:
                raised *= (used.generator(s) ** 2 + used.generator(c) ** 2) ** times
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
    used = Used(ring, [p])
    (result,) = _images(used, p)
    return used.element(result)


def _homogeneous_terms(ring: TrigRing, p: PolyElement) -> int:
    """How many terms `homogeneous` has to write at most."""
    pairs = tuple(zip(ring.sine, ring.cosine, strict=True))
    degrees = [[monomial[s] + monomial[c] for s, c in pairs] for monomial in p]
    tops = [max(column) for column in zip(*degrees, strict=True)]
    return sum(prod([(top - degree) // 2 + 1 for top, degree in zip(tops, row, strict=True)]) for row in degrees)


def common_factor(ring: TrigRing, polynomials: Iterable[PolyElement]) -> PolyElement:
    """The greatest common factor of normal forms: homogeneous, primitive, leading coefficient positive."""
    ordered = sorted((p for p in polynomials if p), key=len)
    if not ordered or any(p.is_ground for p in ordered):
        return ring.one
    used = Used(ring, ordered)
    result: flint.fmpq_mpoly | None = None
    for p in ordered:
        for image in _images(used, p):
            result = image if result is None else result.gcd(image)
            if result.is_constant():
                return ring.one
    return _primitive(used.element(result))


def _primitive(p: PolyElement) -> PolyElement:
    _, p = p.primitive()
    return -p if p.LC < 0 else p


def divide(ring: TrigRing, p: PolyElement, factor: PolyElement) -> PolyElement:
    """p / factor for a homogeneous common factor, in normal form."""
    if factor == 1:
        return p
    used = Used(ring, (p, factor))
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
    used = Used(ring, (numerator, denominator))
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
    long = any(_homogeneous_terms(ring, part) > MOST_TERMS for part in parity_classes(ring, p))
    content = ring.one if long else common_factor(ring, [p])
    rest = divide(ring, p, content)
    constant = ring.one
    factors: list[tuple[PolyElement, int]] = []
    for image in (content, rest):
        if image == 1:
            continue
        used = Used(ring, [image])
        leading, parts = used.image(image).factor()
        constant = constant * ring.polys.ground_new(QQ(leading.numerator, leading.denominator))
        for part, multiplicity in parts:
            q = used.element(part)
            primitive = _primitive(q)
            constant = constant * (q.LC / primitive.LC) ** int(multiplicity)
            factors.append((primitive, int(multiplicity)))
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
