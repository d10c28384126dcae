"""Motions of leading coordinates: Fourier series of one period that begin and end at rest.

A series is what encoders and filters know best: it repeats, and holds no frequency but its own (Swevers, Ganseman,
Tükel, De Schutter and Van Brussel, Optimal robot excitation and identification, 1997).
"""

from __future__ import annotations

import numpy as np
from scipy import linalg

from symgen.identification.arrays import Array

# Harmonics of a series: more of them need drives that are faster, fewer show less.
HARMONICS = 5


class RestingSeries:
    """Series of one period (s) with q̇ = q̈ = 0 at its beginning; `shapes` of them are independent.

    A leading coordinate is c + w (z_0 + sum of z_k times shape k), with c and w of its `middles` and `widths`.
    """

    def __init__(self, period: float, middles: Array, widths: Array) -> None:
        self.period, self._middles, self._widths = period, middles, widths
        orders = np.arange(1, HARMONICS + 1)
        # of sin k w t the rates vanish together, of cos k w t the accelerations
        blocks = [linalg.null_space(row[None, :]) for row in (orders, orders**2)]
        self._weights: Array = linalg.block_diag(*blocks).T
        # shapes of one size, so that a step of each moves the machine alike
        self._weights = self._weights / np.max(np.abs(self._at(np.linspace(0, period, 200))[0]), axis=0)[:, None]
        self.shapes = len(self._weights)

    @property
    def variables(self) -> int:
        """How many numbers a motion has."""
        return len(self._middles) * (1 + self.shapes)

    def motions(self, z: Array, t: Array) -> tuple[Array, Array, Array]:
        """Places, rates and accelerations (B, N, d) at times t (N) of motions z (B, variables)."""
        given = z.reshape(len(z), len(self._middles), 1 + self.shapes)
        moved = [np.einsum("bdk,tk->btd", given[:, :, 1:], shape) * self._widths for shape in self._at(t)]
        middle = self._middles + self._widths * given[:, :, 0]
        return middle[:, None, :] + moved[0], moved[1], moved[2]

    def coefficients(self, z: Array) -> tuple[Array, Array]:
        """Of one motion z the constants (d), and the factors (d, 2 H) of sin k w t, then of cos k w t."""
        given = z.reshape(len(self._middles), 1 + self.shapes)
        factors = self._widths[:, None] * (given[:, 1:] @ self._weights)
        return self._middles + self._widths * given[:, 0], np.asarray(factors, dtype=np.float64)

    def _at(self, t: Array) -> tuple[Array, Array, Array]:
        """The shapes (N, k) with their first and second derivatives."""
        w = 2 * np.pi / self.period * np.arange(1, HARMONICS + 1)
        sin, cos = np.sin(np.outer(t, w)), np.cos(np.outer(t, w))
        parts = ((sin, cos), (w * cos, -w * sin), (-(w**2) * sin, -(w**2) * cos))
        made = [np.hstack(part) @ self._weights.T for part in parts]
        return made[0], made[1], made[2]
