"""Ring elements as sums of sines and cosines of angle combinations."""

from __future__ import annotations

from typing import TypeAlias

from sympy import QQ
from sympy.polys.rings import PolyElement

from symgen.closedform.ring import TrigRing

# By the frequencies of the atoms, the coefficients of cosine and sine.
Series: TypeAlias = dict[tuple[int, ...], tuple[PolyElement, PolyElement]]


def least_length(series: Series) -> int:
    """Operations that the sum of a Fourier series has at least: every term of a coefficient is one of a sum, every wave
    is a function, and a multiplication where its coefficient is a sum."""
    waves = [len(part) for frequencies, parts in series.items() if any(frequencies) for part in parts if part]
    constant = sum([len(part) for frequencies, parts in series.items() if not any(frequencies) for part in parts])
    return sum([length + 1 + (length > 1) for length in waves]) + constant - 1


def fourier_series(ring: TrigRing, p: PolyElement) -> Series:
    """Frequencies of the atoms to the coefficients of cosine and sine; the first non-zero frequency is positive."""
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
