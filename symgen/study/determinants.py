"""Determinants that change their signs where a choice of inputs is singular."""

from __future__ import annotations

from itertools import combinations
from math import comb

import numpy as np

from symgen.mechanics.genericity import assembly_of
from symgen.model.model import Model
from symgen.study.chunks import Array

# Choices of as many inputs as there are degrees of freedom whose determinants are shown.
MOST_CHOICES_SHOWN = 20


def choices(model: Model) -> tuple[tuple[int, ...], ...]:
    """Choices of as many inputs as there are degrees of freedom, where [B; transposed M] is square with them."""
    freedom = model.n - assembly_of(model).ranks.constraints
    if model.n - model.r != freedom or not 0 < freedom <= model.m or comb(model.m, freedom) > MOST_CHOICES_SHOWN:
        return ()
    return tuple(combinations(range(model.m), freedom))


def determinants(model: Model, rows: Array, columns: Array) -> Array:
    """Of [B; transposed M] with rows of length 1, for each choice of inputs (... x choices): B is `rows` (... x r x n),
    M is `columns` (... x n x m); NaN where one of them is not known."""
    inputs = np.swapaxes(columns, -1, -2)
    made = []
    for subset in choices(model):
        square = np.concatenate([rows, inputs[..., list(subset), :]], axis=-2)
        known = np.isfinite(square).all(axis=(-2, -1))
        lengths = np.sqrt((square * square).sum(axis=-1, keepdims=True))
        scaled = np.divide(square, lengths, out=np.zeros_like(square), where=lengths > 0)
        made.append(np.where(known, np.linalg.det(np.where(known[..., None, None], scaled, 0.0)), np.nan))
    return np.stack(made, axis=-1)
