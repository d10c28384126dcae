"""Ring elements as sums of sines and cosines of angle combinations."""

from __future__ import annotations

from fractions import Fraction
from math import prod
from operator import sub
from typing import TypeAlias

from sympy import QQ
from sympy.polys.rings import PolyElement

from symgen.closedform.algebra.ring import TrigRing
from symgen.model.expressions.expression import Expression, Name

# By the frequencies of the atoms, the coefficients of cosine and sine.
Series: TypeAlias = dict[tuple[int, ...], tuple[PolyElement, PolyElement]]


def least_length(ring: TrigRing, series: Series) -> int:
    """Operations that the sum of a Fourier series has at least; 0 where squares of roots may cancel."""
    if any(m[i] > 1 for parts in series.values() for part in parts for m in part for i in ring.opaque_position):
        return 0
    total = -1
    for frequencies, parts in series.items():
        for part in filter(None, parts):
            if any(frequencies):
                total += 2 + _operations_of_angle(ring, frequencies) + _operations_of_coefficient(part)
            else:
                total += len(part)
    return total


def _operations_of_angle(ring: TrigRing, frequencies: tuple[int, ...]) -> int:
    """Additions, and multiplications with whole numbers; 0 where it is not a sum of names."""
    sums: dict[Expression, Fraction] = {}
    for frequency, atom in zip(frequencies, ring.basis.atoms, strict=True):
        if frequency:
            for base, factor in atom:
                if not isinstance(base, Name):
                    return 0
                sums[base] = sums.get(base, Fraction(0)) + frequency * factor
    factors = [factor for factor in sums.values() if factor]
    return len(factors) - 1 + sum([abs(factor) != 1 for factor in factors])


def _operations_of_coefficient(p: PolyElement) -> int:
    """Those of its terms, after what they share was taken out, and of the product with a wave."""
    common = tuple(map(min, *p)) if len(p) > 1 else next(iter(p))
    outside = _factors_and_powers(common)
    if len(p) == 1:
        return outside
    inside = [max(_factors_and_powers(tuple(map(sub, monomial, common))) - 1, 0) for monomial in p]
    return outside + len(p) + sum(inside)


def _factors_and_powers(monomial: tuple[int, ...]) -> int:
    return sum([1 if exponent == 1 else 2 for exponent in monomial if exponent])


def fourier_series(ring: TrigRing, p: PolyElement) -> Series:
    """Frequencies of the atoms to the coefficients of cosine and sine; the first non-zero frequency is positive.

    Raises TooLargeError where that is more work than is left: each power of a factor multiplies the waves of a product.
    """
    ring.work.spend(sum(_waves_of(ring, monomial) for monomial in p))
    waves: dict[tuple[int, ...], tuple[PolyElement, PolyElement]] = {}
    for monomial, coefficient in p.terms():
        rest = list(monomial)
        for position in ring.angle_positions:
            rest[position] = 0
        degree = sum(monomial[position] for position in ring.angle_positions)
        scale = ring.polys.zero.copy()
        scale[tuple(rest)] = coefficient / 2**degree
        for frequencies, (real, imaginary) in _wave_product(ring, monomial).items():
            leading = next((k for k in frequencies if k), 0)
            key = tuple(-k for k in frequencies) if leading < 0 else frequencies
            if leading < 0:
                imaginary = -imaginary
            cosine, sine = waves.get(key, (ring.zero, ring.zero))
            waves[key] = (
                cosine + scale.mul_ground(QQ(real)) if real else cosine,
                sine - scale.mul_ground(QQ(imaginary)) if imaginary else sine,
            )
    constant = (0,) * len(ring.sine)
    if constant in waves:
        waves[constant] = (waves[constant][0], ring.zero)
    return {key: value for key, value in sorted(waves.items()) if value[0] or value[1]}


def _waves_of(ring: TrigRing, monomial: tuple[int, ...]) -> int:
    """How many waves the sines and cosines of a monomial are at most."""
    return prod([1 + monomial[s] + monomial[c] for s, c in zip(ring.sine, ring.cosine, strict=True)])


def _wave_product(ring: TrigRing, monomial: tuple[int, ...]) -> dict[tuple[int, ...], tuple[int, int]]:
    """2^degree times the sines and cosines of a monomial as complex exponentials, coefficients (real, imaginary)."""
    waves: dict[tuple[int, ...], tuple[int, int]] = {(): (1, 0)}
    for s, c in zip(ring.sine, ring.cosine, strict=True):
        if not monomial[s] and not monomial[c]:
            waves = {(*frequencies, 0): value for frequencies, value in waves.items()}
            continue
        single: dict[int, tuple[int, int]] = {0: (1, 0)}
        for kind, power in ((0, monomial[s]), (1, monomial[c])):
            for _ in range(power):
                step: dict[int, tuple[int, int]] = {}
                for k, (x, y) in single.items():
                    for shift in (1, -1):
                        # 2 cos = e + 1/e, 2 sin = -i (e - 1/e)
                        add = (x, y) if kind else (y * shift, -x * shift)
                        old = step.get(k + shift, (0, 0))
                        step[k + shift] = (old[0] + add[0], old[1] + add[1])
                single = step
        waves = {
            (*frequencies, k): (x * u - y * v, x * v + y * u)
            for frequencies, (x, y) in waves.items()
            for k, (u, v) in single.items()
        }
    return waves
