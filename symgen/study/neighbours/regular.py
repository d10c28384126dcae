"""Places that a machine gets to from its start without passing a singularity, within the ranges of its coordinates.

Steps pass no place where the task, or what is measured, does not determine the configuration.  Where there are as many
inputs as degrees of freedom, det [B; transposed M] keeps the sign it starts with; with more of them singularities lie
in sets too small to part places.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from symgen.model.model import Coordinate, Model
from symgen.study.chunks import Array
from symgen.study.determinants import choices, determinants
from symgen.study.kernels import StudyKernels
from symgen.study.neighbours.continuation import SolvedNodes, WalkStart
from symgen.study.neighbours.lattice import node_lattice, widened
from symgen.study.plan import StudyPlan


def limits(model: Model) -> tuple[Array, Array]:
    """The smallest and the largest value of each coordinate (n each), infinite where no range is stated."""
    low, high = zip(*map(_range, model.coordinates), strict=True)
    return np.array(low), np.array(high)


def _range(coordinate: Coordinate) -> tuple[float, float]:
    low, high = coordinate.range
    return (float(low), float(high)) if coordinate.has_range else (-math.inf, math.inf)


class RegularPlaces:
    """Where a way leads to on which every configuration has the sign of the start and is within ranges."""

    def __init__(self, plan: StudyPlan, kernels: StudyKernels, start: WalkStart) -> None:
        self._model, self._kernels = plan.model, kernels
        self._low, self._high = limits(plan.model)
        self._signed = len(choices(plan.model)) == 1
        self._sign = self._signs(start.p[None], start.q[None])
        lattice = node_lattice(plan)
        self._nodes = (
            None
            if lattice is None
            else SolvedNodes(kernels, widened(lattice, start.p, start.x), start, self._are_admitted)
        )

    @property
    def seconds(self) -> float:
        """How long it took to solve for nodes."""
        return 0.0 if self._nodes is None else self._nodes.seconds

    def reached(self, p: Array, x: Array, q: Array) -> NDArray[np.bool_]:
        """Of places at parameters p and what is given x those that such a way leads to; q, where it is known (NaN
        where not), is that of the start where nothing moves."""
        if self._nodes is None:
            return self._are_admitted(p, q)
        return np.asarray(np.isfinite(self._nodes.hopped(p, x)[:, 0]))

    def _are_admitted(self, p: Array, q: Array) -> NDArray[np.bool_]:
        within = ((q >= self._low) & (q <= self._high)).all(axis=1)
        return np.asarray(within & (self._signs(p, q) == self._sign))

    def _signs(self, p: Array, q: Array) -> Array:
        """Of the determinant at configurations; 0 of all where no single one is looked at."""
        if not self._signed:
            return np.zeros(len(q))
        model = self._model
        columns = self._matrices("control_matrix", p, q).reshape(len(q), model.n, model.m)
        rows = self._matrices("constraint_jacobian", p, q) if model.r else np.empty((len(q), 0))
        return np.asarray(np.sign(determinants(model, rows.reshape(len(q), model.r, model.n), columns)[:, 0]))

    def _matrices(self, name: str, p: Array, q: Array) -> Array:
        """Entries of a quantity, configurations x entries."""
        entries, _ = self._kernels.over(name, {"q": q[:, :, None]}, np.arange(len(q), dtype=np.uintp), p)
        return entries[:, :, 0].copy()
