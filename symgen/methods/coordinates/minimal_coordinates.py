"""The equations in independent velocities (8), (9): an orthogonal complement F of B, and what it makes of matrices."""

from __future__ import annotations

from functools import cached_property

from symgen.ir.kernel import Status
from symgen.linear_algebra.guards import Guard
from symgen.linear_algebra.null_space.null_spaces import InputEquations, NullSpace, Restriction
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.system import System
from symgen.symbolic.matrix import Matrix, Vector, add, identity, matmul, matvec, scale, subtract, transpose
from symgen.validity.solvable import solvable


class MinimalCoordinates:
    """Those of the velocities that a model names as independent, along one `NullSpace`."""

    def __init__(self, mechanics: System, generic: Genericity, space: NullSpace) -> None:
        self._mechanics, self._generic, self._space = mechanics, generic, space
        self._graph = mechanics.graph

    @cached_property
    def _independent(self) -> tuple[int, ...]:
        names = [c.name for c in self._mechanics.model.coordinates]
        return tuple(names.index(name) for name in self._mechanics.model.independent_velocities)

    @cached_property
    def _partition(self) -> tuple[InputEquations, Restriction]:
        axes = identity(self._graph, self._mechanics.n)
        family = [axes[i] for i in self._independent]
        forms, restriction = self._space.actuation(family, len(self._independent))
        return forms.cancelled(self._mechanics.factoring.cancelled), restriction

    @cached_property
    def complement(self) -> Matrix:
        """F (8), n x delta: B F = 0, the identity in the independent rows; (M~^+)^T for an M that selects those."""
        forms, restriction = self._partition
        rows = tuple(forms.solve(restriction(axis)) for axis in identity(self._graph, self._mechanics.n))
        chosen = {i: k for k, i in enumerate(self._independent)}
        units = identity(self._graph, len(self._independent))
        return tuple(units[chosen[i]] if i in chosen else row for i, row in enumerate(rows))

    @property
    def guards(self) -> tuple[Guard, ...]:
        """The parametrisation singularity of the chosen independent velocities; reported as a drop of rank."""
        forms, _ = self._partition
        axes = identity(self._graph, self._mechanics.n)
        columns = [axes[i] for i in self._independent]
        return solvable(self._mechanics, self._generic, self._space, forms, columns, Status.CONSTRAINT_RANK)

    def complement_dot(self, velocity: Vector) -> Matrix:
        """F_dot = -(I - F E) B^+ B_dot F, with E selecting the independent rows."""
        graph, n, delta = self._graph, self._mechanics.n, self._generic.delta
        if self._mechanics.r == 0:
            return scale(self.complement, graph.zero)
        rates = matmul(graph, self._mechanics.constraint_jacobian_dot(velocity), self.complement, delta)
        lifted = matmul(graph, self._space.pseudoinverse, rates, delta)
        selected = tuple(lifted[i] for i in self._independent)
        correction = matmul(graph, self.complement, selected, delta)
        dependent = subtract(correction, lifted)
        zeros = (graph.zero,) * delta
        return tuple(zeros if i in self._independent else dependent[i] for i in range(n))

    def matrix(self, a: Matrix) -> Matrix:
        """F^T A F for symmetric A."""
        graph, delta = self._graph, self._generic.delta
        product = matmul(graph, transpose(self.complement, delta), matmul(graph, a, self.complement, delta), delta)
        return tuple(tuple(product[min(i, j)][max(i, j)] for j in range(delta)) for i in range(delta))

    def vector(self, x: Vector) -> Vector:
        """F^T x."""
        return matvec(self._graph, transpose(self.complement, self._generic.delta), x)

    @property
    def coriolis_matrix(self) -> Matrix:
        """C- = F^T (C F + G F_dot), along q_dot as given."""
        graph, delta, qd = self._graph, self._generic.delta, self._mechanics.qd
        coriolis = matmul(graph, self._mechanics.matrices.coriolis_matrix(qd), self.complement, delta)
        inertial = matmul(graph, self._mechanics.matrices.mass_matrix, self.complement_dot(qd), delta)
        return matmul(graph, transpose(self.complement, delta), add(coriolis, inertial), delta)
