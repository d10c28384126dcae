"""The loads of places whose friction grows with the reactions that it changes: a fixed point, with its bound.

The reactions are affine in the loads n_j (N), so that

n_i = |R_i0 + sum_j R_ij d_j n_j|,  d_j = mu_j rho_j tanh(s_j^T q_dot / w_j),

R_i0 what place i carries without friction and R_ij what a unit of friction at place j adds to it.  By the triangle
inequality the right-hand side contracts in the largest of the |n_i| with kappa = max_i sum_j |R_ij d_j|: for kappa < 1
there is one solution (Banach).  A place that changes its own reaction is solved for: with a = R_i0 + sum_(j != i),
b = R_ii d_i,

n_i = (a.b + sqrt((a.b)^2 + (1 - b.b) a.a)) / (1 - b.b),

which for one component is |a| / (1 - b sgn a).  What is left is iterated place by place, a stated number of times
(`model/configurations/friction_steps.py`).  Where kappa reaches 1/2 there is a status in place of a result.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import chain

from symgen.ir.kernel import Status
from symgen.linear_algebra.guards import Guard
from symgen.model.configurations.friction_steps import LOCKING_SHARE, MOST_FRICTION_STEPS, FrictionSteps
from symgen.symbolic.graph import Graph
from symgen.symbolic.matrix import Vector, dot
from symgen.symbolic.scalar import Scalar


class FrictionLoads:
    """The fixed point of some places.

    `free` are the R_i0, `answers` the R_ij by j, then i, of vectors without what is 0; `sizes` are mu_j rho_j,
    `directions` the tanh, between -1 and 1.
    """

    def __init__(
        self,
        graph: Graph,
        free: Sequence[Vector],
        answers: Sequence[Sequence[Vector]],
        sizes: Vector,
        directions: Vector,
        steps: FrictionSteps | None,
    ) -> None:
        self.graph, self.free, self.answers, self.sizes, self.directions = graph, free, answers, sizes, directions
        self.steps = MOST_FRICTION_STEPS if steps is None else steps.steps

    @cached_property
    def factors(self) -> Vector:
        """d_j."""
        return tuple(size * way for size, way in zip(self.sizes, self.directions, strict=True))

    @cached_property
    def kappa(self) -> Scalar:
        """What a change of loads comes back as at most, in the largest of them."""
        graph, places = self.graph, range(len(self.free))
        ways = [graph.function("abs", (way,)) for way in self.directions]
        gains = [[self._length(self.answers[j][i]) * self.sizes[j] for j in places] for i in places]
        return self._largest([dot(graph, row, ways) for row in gains])

    @property
    def guards(self) -> tuple[Guard, ...]:
        """That kappa is less than one half, and that the last step has changed nothing any more.

        Beyond the ranges that the steps are counted for kappa may be larger than there, and they too few.
        """
        graph = self.graph
        excess = graph.function("max", (self.kappa - graph.const(LOCKING_SHARE), graph.zero))
        locks = Guard(Status.FRICTION_LOCK, excess, 1, scale=graph.one, positive=True, small=True)
        *_, before, last = self._iterates
        if self.steps == 1:
            return (locks,)
        changes = [graph.function("abs", (x - y,)) for x, y in zip(last, before, strict=True)]
        change, size = self._largest(changes), self._largest(last)
        return (locks, Guard(Status.FRICTION_LOCK, change, 1, scale=size, small=True))

    def _largest(self, values: Sequence[Scalar]) -> Scalar:
        largest = values[0]
        for value in values[1:]:
            largest = self.graph.function("max", (largest, value))
        return largest

    @cached_property
    def _iterates(self) -> tuple[Vector, ...]:
        """n_j (N) from none on: the stated number of steps, and where these are several, one more that shows them."""
        iterates: list[Vector] = [(self.graph.zero,) * len(self.free)]
        for _ in range(self.steps + (self.steps > 1)):
            loads = list(iterates[-1])
            for i in range(len(loads)):
                loads[i] = self._own(i, loads)
            iterates.append(tuple(loads))
        return tuple(iterates)

    @property
    def loads(self) -> Vector:
        """n_j (N) after all steps."""
        return self._iterates[-1]

    @cached_property
    def once_more(self) -> Vector:
        """The loads that come of these."""
        return tuple(self._own(i, self.loads) for i in range(len(self.free)))

    def _own(self, i: int, loads: Sequence[Scalar]) -> Scalar:
        """n_i for the others as they are, with what it does to itself."""
        graph, one = self.graph, self.graph.one
        others = [(j, self.factors[j] * load) for j, load in enumerate(loads) if j != i]
        a = [
            graph.sum((own, *(x * self.answers[j][i][k] for j, x in others))) for k, own in enumerate(self.free[i])
        ]
        b = [self.factors[i] * x for x in self.answers[i][i]]
        if all(x.is_zero for x in b):
            return self._length(a)
        across, square = dot(graph, a, b), dot(graph, b, b)
        # less than one half only where there is a status; there it keeps what is worked out a number
        left = graph.function("max", (one - square, graph.const(LOCKING_SHARE)))
        if len(a) == 1:
            return (graph.function("abs", (a[0],)) + across) / left
        return (graph.function("sqrt", (across * across + left * dot(graph, a, a),)) + across) / left

    def _length(self, vector: Sequence[Scalar]) -> Scalar:
        left = [x for x in vector if not x.is_zero]
        if len(left) < 2:
            return self.graph.function("abs", (left[0],)) if left else self.graph.zero
        return self.graph.function("sqrt", (dot(self.graph, left, left),))

    @property
    def given(self) -> tuple[Scalar, ...]:
        """The reactions that loads are made of."""
        return (*chain(*self.free), *(x for answers in self.answers for reaction in answers for x in reaction))

    def added(self, start: Vector, columns: Sequence[Vector], loads: Vector) -> Vector:
        """A vector with what each place adds to it, `columns` for a unit of its friction."""
        shares = [factor * load for factor, load in zip(self.factors, loads, strict=True)]
        return tuple(
            self.graph.sum((x, *(share * column[k] for share, column in zip(shares, columns, strict=True))))
            for k, x in enumerate(start)
        )
