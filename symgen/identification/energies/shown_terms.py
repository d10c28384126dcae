"""Columns of monomials, by generated inputs at several values of parameters, and which of them a motion tells apart."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from scipy import linalg

from symgen.identification.arrays import Array
from symgen.identification.energies.energy_terms import EnergyTerms
from symgen.identification.independent import independent_columns
from symgen.records import dataclass

# The seed of values of parameters.
TERMS_SEED = 20261129
# Parameters are changed by factors up to this, and down to one over it.
TERMS_FACTOR = 2.0
# So many values for each monomial: the more, the better they tell these apart.
VALUES_A_TERM = 2
# Of the largest coefficient of a sum, what is shown of one.
NAMED_TERM = 1e-6

Inputs = Callable[[Mapping[str, float]], Array]


def columns_of_terms(terms: EnergyTerms, numbers: Mapping[str, float], inputs: Inputs) -> Array:
    """What each monomial adds to inputs (N, m, k), by inputs (N, m) at some values of its parameters."""
    generator = np.random.default_rng(TERMS_SEED)
    count = VALUES_A_TERM * (len(terms.monomials) + 1)
    factors = TERMS_FACTOR ** generator.uniform(-1, 1, (count, len(terms.names)))
    tried = [
        {name: (numbers[name] or 1.0) * factor for name, factor in zip(terms.names, row, strict=True)}
        for row in factors
    ]
    rows = np.array([[1.0, *terms.at(one)] for one in tried])
    sizes = np.linalg.norm(rows, axis=0)
    answers = np.stack([inputs(one) for one in tried])
    solved = linalg.lstsq(rows / sizes, answers.reshape(count, -1))[0] / sizes[:, None]
    return np.asarray(np.moveaxis(solved[1:].reshape(-1, *answers.shape[1:]), 0, -1), dtype=np.float64)


@dataclass(frozen=True, slots=True)
class ShownTerms:
    """Sums of monomials that a motion tells apart: those `kept`, and what others add by rows of `sums` (b, k)."""

    terms: EnergyTerms
    kept: tuple[int, ...]
    sums: Array

    @property
    def labels(self) -> tuple[str, ...]:
        """As `J + 0.25 m`."""
        return tuple(_sum(self.terms.labels, place, row) for place, row in zip(self.kept, self.sums, strict=True))

    @property
    def reached(self) -> set[str]:
        """Parameters of the monomials."""
        return {*self.terms.names}

    @property
    def held(self) -> set[str]:
        """The geometry, and what the file says is fixed."""
        said = self.terms.model.identify
        return {*self.terms.geometry, *((*said.geometry, *said.fixed) if said is not None else ())}

    def at(self, numbers: Mapping[str, float]) -> Array:
        """The sums (b)."""
        return np.asarray(self.sums @ self.terms.at(numbers), dtype=np.float64)


def shown_terms(terms: EnergyTerms, columns: Array) -> ShownTerms:
    """Which sums of monomials columns (N, m, k) at states of a motion tell apart."""
    flat = columns.reshape(-1, columns.shape[2])
    kept = independent_columns(flat)
    lengths = np.linalg.norm(flat[:, kept], axis=0)
    sums = linalg.lstsq(flat[:, kept] / lengths, flat)[0] / lengths[:, None] if kept else np.zeros((0, flat.shape[1]))
    sums[np.abs(sums) < NAMED_TERM * np.max(np.abs(sums), axis=1, initial=0.0, keepdims=True)] = 0.0
    return ShownTerms(terms, tuple(kept), np.asarray(sums, dtype=np.float64))


def _sum(labels: tuple[str, ...], place: int, row: Array) -> str:
    text = labels[place]
    for other, share in zip(labels, row, strict=True):
        if other != labels[place] and share:
            size = f"{abs(share):.4g} "
            text += f" {'-' if share < 0 else '+'} {size if size != '1 ' else ''}{other}"
    return text
