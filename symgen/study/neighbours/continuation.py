"""Continuation from solved neighbours: configurations at the nodes of a lattice, then at places between them.

From what is reached of the nodes by walks from the model's start, it goes to nodes beside, and from these on, until
no further one is reached.  A place that no walk reaches is then hopped to from the nodes around it.  What a place has
depends on the study and on its own values alone: any block of points, in any worker, makes the same of it.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from threading import Lock
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from symgen.study.chunks import Array
from symgen.study.kernels import StudyKernels
from symgen.study.neighbours.lattice import NodeLattice, Numbers, node_lattice
from symgen.study.plan import StudyPlan

# Which of some configurations (parameters p, q; places x ... each) may be passed.
Admission: TypeAlias = Callable[[Array, Array], NDArray[np.bool_]]
# Nodes that walks from the start are tried to: what they reach in parts that are apart is spread from all of them.
WALKED_NODES = 128


@dataclass(frozen=True, slots=True)
class WalkStart:
    """Where walks begin and what makes them: a kernel, parameters p, what is given there (x) and the configuration."""

    kernel: str
    p: Array
    x: Array
    q: Array


class SolvedNodes:
    """The nodes of a lattice with their configurations, where one is reached (nodes x n, else NaN)."""

    def __init__(
        self, kernels: StudyKernels, lattice: NodeLattice, start: WalkStart, admits: Admission | None = None
    ) -> None:
        began = time.perf_counter()
        self._kernels, self._lattice, self._start, self._admits = kernels, lattice, start, admits
        self._p, self._x = self._places(lattice.values)
        self._q = np.full((len(lattice), len(start.q)), np.nan)
        self._spread(self._walked() if admits is None else self._nearest())
        self.seconds = time.perf_counter() - began
        """How long it took to solve for them."""

    @property
    def solved(self) -> NDArray[np.bool_]:
        """Which nodes are reached."""
        return np.asarray(np.isfinite(self._q[:, 0]))

    def hopped(self, p: Array, x: Array) -> Array:
        """Configurations (places x n, else NaN) at parameters p and what is given x (places x ...), from the nodes
        around each place."""
        q = np.full((len(p), self._q.shape[1]), np.nan)
        for places, nodes in self._lattice.corners(self._values(p, x)):
            able = self.solved[nodes] & ~np.isfinite(q[places, 0])
            places, nodes = places[able], nodes[able]
            q[places] = self._hop(nodes, p[places], x[places])
        return q

    def _places(self, values: Array) -> tuple[Array, Array]:
        """Parameters and what is given where the names have these values, all others as at the start."""
        p, x = (np.tile(one, (len(values), 1)) for one in (self._start.p, self._start.x))
        for k, one in enumerate(self._lattice.names):
            (p if one.kind == "parameter" else x)[:, one.place] = values[:, k]
        return p, x

    def _values(self, p: Array, x: Array) -> Array:
        """Those of the names at some places."""
        names = self._lattice.names
        return np.stack([(p if one.kind == "parameter" else x)[:, one.place] for one in names], axis=-1)

    def _walked(self) -> Numbers:
        """Some nodes that walks from the start reach."""
        nodes = self._lattice.spread(WALKED_NODES)
        start = (self._start.p, self._start.x, self._start.q)
        q, status = self._kernels.walked(self._start.kernel, start, self._p[nodes], self._x[nodes, None])
        self._q[nodes] = q[:, :, 0]
        return np.asarray(nodes[status[:, 0] == 0])

    def _nearest(self) -> Numbers:
        """The node nearest to the start, where a hop leads to it."""
        _, nodes = next(self._lattice.corners(self._values(self._start.p[None], self._start.x[None])))
        start = self._start.p[None], self._start.x[None], self._start.q[None]
        self._q[nodes] = self._admitted(start, self._p[nodes], self._x[nodes])
        return np.asarray(nodes[self.solved[nodes]])

    def _spread(self, fresh: Numbers) -> None:
        """From solved nodes to all that hops lead to; each hop between two nodes is tried once."""
        while len(fresh):
            further = []
            for nodes, beside in self._lattice.beside(fresh):
                open_ones = ~self.solved[beside]
                nodes, beside = nodes[open_ones], beside[open_ones]
                q = self._hop(nodes, self._p[beside], self._x[beside])
                ended = np.isfinite(q[:, 0])
                self._q[beside[ended]] = q[ended]
                further.append(beside[ended])
            fresh = np.concatenate(further)

    def _hop(self, nodes: Numbers, p: Array, x: Array) -> Array:
        """Configurations at places, each from a node."""
        return self._admitted((self._p[nodes], self._x[nodes], self._q[nodes]), p, x)

    def _admitted(self, start: tuple[Array, Array, Array], p: Array, x: Array) -> Array:
        """The ends of hops, NaN where they are not admitted."""
        q = self._kernels.hopped(self._start.kernel, start, p, x)
        if self._admits is not None:
            q[~self._admits(p, q)] = np.nan
        return q


class Neighbours:
    """The solved nodes of a study for each start of walks, an assembly mode; made where they are first asked for."""

    def __init__(self, plan: StudyPlan, kernels: StudyKernels) -> None:
        self._plan, self._kernels = plan, kernels
        self._made: dict[bytes, SolvedNodes] = {}
        self._lock = Lock()

    @property
    def seconds(self) -> float:
        """How long it took to solve for all of them until now."""
        return sum(one.seconds for one in self._made.values())

    def of(self, start: WalkStart) -> SolvedNodes | None:
        """Those for a start; None where a study varies nothing that configurations depend on."""
        key = start.q.tobytes()
        with self._lock:
            if key not in self._made and self._lattice is not None:
                self._made[key] = SolvedNodes(self._kernels, self._lattice, start)
            return self._made.get(key)

    @cached_property
    def _lattice(self) -> NodeLattice | None:
        return node_lattice(self._plan)
