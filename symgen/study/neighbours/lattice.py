"""Nodes at regular values of the names that a configuration depends on; those of the study alone say where they are."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from symgen.mechanics.system import System
from symgen.model.model import Model
from symgen.records import dataclass
from symgen.study.chunks import Array, product_of
from symgen.study.plan import StudyPlan, VariedName
from symgen.symbolic.translate import translate
from symgen.symbolic.traverse import reached

Numbers = NDArray[np.intp]
# Nodes at most: a grid of 181 by 181 values of two names has one at each value, and they are solved in a second.
MOST_LATTICE_NODES = 2**15
# Names by which the corners of a cell around a point differ: those in which the point is furthest from its node.
MOST_CORNER_NAMES = 3


@dataclass(frozen=True, slots=True)
class NodeLattice:
    """Nodes over the ranges of `names`, `counts` along each, numbered with the last name first."""

    names: tuple[VariedName, ...]
    counts: tuple[int, ...]

    def __len__(self) -> int:
        return int(np.prod(self.counts, dtype=np.intp))

    @property
    def values(self) -> Array:
        """Those of the names at the nodes, nodes x names."""
        axes = zip(self.names, self.counts, strict=True)
        return product_of([np.linspace(one.axis.first, one.axis.last, count) for one, count in axes])

    def beside(self, nodes: Numbers) -> Iterator[tuple[Numbers, Numbers]]:
        """For each direction along a name and against it those of the nodes that have another there, and these."""
        for place, count in enumerate(self.counts):
            stride = int(np.prod(self.counts[place + 1 :], dtype=np.intp))
            index = nodes // stride % count
            for step, has_one in ((1, index < count - 1), (-1, index > 0)):
                yield nodes[has_one], nodes[has_one] + step * stride

    def corners(self, values: Array) -> Iterator[tuple[Numbers, Numbers]]:
        """The nodes around points with these values of the names (points x names), the nearest one first and then
        others of its cell: each time which of the points have a further one, and these nodes."""
        first, last = (np.array([getattr(one.axis, end) for one in self.names]) for end in ("first", "last"))
        at = (values - first) / (last - first) * (np.array(self.counts) - 1)
        nearest = np.rint(at)
        off = np.sign(at - nearest)
        # of each point the names in which it is furthest from its node
        furthest = np.argsort(-np.abs(at - nearest), axis=1, kind="stable")[:, :MOST_CORNER_NAMES]
        for turned in product((False, True), repeat=furthest.shape[1]):
            changed = furthest[:, turned]
            points = np.flatnonzero((np.take_along_axis(off, changed, axis=1) != 0).all(axis=1))
            corner = nearest[points]
            for name in changed[points].T:
                corner[np.arange(len(points)), name] += off[points, name]
            yield points, np.ravel_multi_index(tuple(corner.astype(np.intp).T), self.counts)

    def spread(self, most: int) -> Numbers:
        """About so many nodes, evenly along all names."""
        sides = _sides(most, len(self.counts), self.counts)
        chosen = [np.linspace(0, count - 1, side).round().astype(np.intp) for side, count in sides]
        return np.unique(np.ravel_multi_index(tuple(np.meshgrid(*chosen, indexing="ij")), self.counts))


def _sides(most: int, names: int, counts: tuple[int, ...]) -> list[tuple[int, int]]:
    side = max(1, int(most ** (1 / names)))
    return [(min(side, count), count) for count in counts]


def node_lattice(plan: StudyPlan) -> NodeLattice | None:
    """The nodes of a study whose places are walked to; None where it varies nothing that a configuration depends on.

    A grid's own values are among those of the nodes where there is room for them.
    """
    used = _used_parameters(plan.model, by_task=plan.placing == "task")
    varied = (one for one in (*plan.over, *plan.along) if one.kind != "parameter" or one.place in used)
    names = tuple(one for one in varied if one.axis.first < one.axis.last)
    if not names:
        return None
    room = max(1, int(MOST_LATTICE_NODES ** (1 / len(names)) + 1e-9) - 1)
    return NodeLattice(names, tuple(_intervals(one.axis.count, room) + 1 for one in names))


def widened(lattice: NodeLattice, p: Array, x: Array) -> NodeLattice:
    """As many nodes over ranges that parameters p and what is given x at a start lie in, too."""
    names = []
    for one in lattice.names:
        here = float((p if one.kind == "parameter" else x)[one.place])
        axis = replace(one.axis, first=min(one.axis.first, here), last=max(one.axis.last, here))
        names.append(replace(one, axis=axis))
    return NodeLattice(tuple(names), lattice.counts)


def _intervals(count: int | None, room: int) -> int:
    """Between the nodes along a name with so many values of its own: a multiple of theirs, or as many as fit."""
    own = (count or 1) - 1
    return own * (room // own) if 0 < own <= room else room


def _used_parameters(model: Model, by_task: bool) -> set[int]:
    """The places of the parameters that constraints, or the task, depend on."""
    system = System(model)
    task = [translate(system.graph, one.expression, system.names) for one in model.task] if by_task else []
    used = reached((*system.constraint_residual, *task))
    return {k for k, one in enumerate(system.parameters) if one in used}
