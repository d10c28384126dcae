"""q_ddot and lambda by the minors of B: polynomials and one division, for delta = 1 and 2.

With omega = b_1 ^ ... ^ b_r, W its complement (a delta-vector that spans ker B) and p = G W (G applied to each of its
delta directions), D = p ^ omega = det(F^T G F) |omega|^2 for an orthonormal basis F of ker B, and for any force f

    K f = W (W^T G W)^-1 W^T f,   (B_G^+)^T f = (-1)^k p ^ f ^ omega_k / D,   omega_k = omega without b_k,

so that B_G^+ is never the difference B^+ - K G B^+, which cancels where masses differ a lot (Bourbaki, Algebra I,
ch. III; the rule of Cramer for (15)).  The division by D is the only one: valid wherever B has full rank and G is
positive definite on ker B.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property

from symgen.ir.kernel import Status
from symgen.linear_algebra.constrained_inverse import diagonal_sizes
from symgen.linear_algebra.exterior import Multivector, in_either_sign, unit, wedge, wedge_all
from symgen.linear_algebra.guards import Guard, magnitude
from symgen.mechanics.never_zero import Definite
from symgen.methods.forward_dynamics.motion import Motion, Problem
from symgen.symbolic.matrix import Matrix, Vector, dot, identity, matmul, matvec, transpose
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, weights_alone

# Degrees of freedom up to which accelerations are written by minors.
LARGEST_DELTA = 2
# Share of operations more that is worth multiplying minors out: what vanishes has cancelled exactly.
CANCELLATION_WORTH = Fraction(1, 4)


class MinorMotion:
    """K, B_G^+ and the motion of a system with independent rows and delta = n - r of 1 or 2."""

    def __init__(self, problem: Problem, expanded: bool) -> None:
        self._problem = problem
        self._graph, self._n = problem.graph, problem.n
        self._expanded = expanded
        graph, rows = problem.graph, problem.rows
        self._omega = wedge_all(unit(graph), rows)
        self._rests = [wedge_all(unit(graph), [*rows[:k], *rows[k + 1 :]]) for k in range(problem.r)]
        self._weighted = self._directions()
        self._denominator = _top(self._weighted, self._omega, self._n, graph.zero)
        if expanded:
            kept = in_either_sign([self._omega])
            self._denominator, *entries = problem.multiplied_out([self._denominator, *self._weighted.values()], kept)
            self._weighted = dict(zip(self._weighted, entries, strict=True))
        self._inverse = 1 / self._denominator

    @cached_property
    def guards(self) -> tuple[Guard, ...]:
        """The rank of B, and D in units of the minors of B, whose own size has the first guard."""
        graph = self._graph
        scale = graph.sum(value * value * self._largest(mask) for mask, value in self._omega.items())
        delta = self._n - self._problem.r
        guard = Guard(Status.MASS_RANK, self._denominator, 1, scale=scale, directions=delta)
        return (*self._problem.guards, guard)

    def _largest(self, mask: int) -> Scalar:
        """A bound of the principal minor of G on the axes that `mask` leaves."""
        g = self._problem.mass_matrix
        axes = [i for i in range(self._n) if not mask >> i & 1]
        if self._expanded and len(axes) == 2:
            i, j = axes
            (minor,) = self._problem.multiplied_out([g[i][i] * g[j][j] - g[i][j] * g[i][j]])
            (size,) = magnitude(self._graph, [minor])
            return size
        sizes = diagonal_sizes(self._graph, g, Definite(self._problem.mechanics).adds_up)
        return self._graph.product(sizes[i] for i in axes)

    @cached_property
    def _dual(self) -> Multivector:
        """W."""
        full = (1 << self._n) - 1
        return {full & ~m: v if _sign(full & ~m, m) > 0 else -v for m, v in self._omega.items()}

    @cached_property
    def _phi(self) -> Matrix:
        """W as an antisymmetric matrix, for delta = 2."""

        def entry(i: int, j: int) -> Scalar:
            value = self._dual.get(1 << i | 1 << j, self._graph.zero) if i != j else self._graph.zero
            return value if i < j else -value

        return tuple(tuple(entry(i, j) for j in range(self._n)) for i in range(self._n))

    def _directions(self) -> Multivector:
        """p = G W."""
        graph, n, g = self._graph, self._n, self._problem.mass_matrix
        if n - self._problem.r == 1:
            w = tuple(self._dual.get(1 << i, graph.zero) for i in range(n))
            components = {1 << i: x for i, x in enumerate(matvec(graph, g, w))}
        else:
            half = matmul(graph, g, self._phi, n)
            components = {1 << i | 1 << j: dot(graph, half[i], g[j]) for i in range(n) for j in range(i + 1, n)}
        return {mask: value for mask, value in components.items() if not value.is_zero}

    def solve(self, force: Vector) -> Vector:
        """K f, the acceleration that a force causes along the constraints."""
        graph, n = self._graph, self._n
        if n - self._problem.r == 1:
            w = tuple(self._dual.get(1 << i, graph.zero) for i in range(n))
            share = dot(graph, w, force)
            return tuple(x * share * self._inverse for x in w)
        # K = Phi G Phi^T / D and Phi^T = -Phi
        turned = matvec(graph, self._phi, force)
        pushed = matvec(graph, self._phi, matvec(graph, self._problem.mass_matrix, turned))
        return tuple(-x * self._inverse for x in pushed)

    def lift(self, a: Vector) -> Vector:
        """B_G^+ a: entry i is p ^ e_i ^ (sum of (-1)^k a_k omega_k) / D."""
        combined: Multivector = {}
        for k, rest in enumerate(self._rests):
            for mask, value in rest.items():
                term = value * a[k] * (-1) ** k
                combined[mask] = combined[mask] + term if mask in combined else term
        zero = self._graph.zero
        tops = (_top(self._weighted, _before(i, combined), self._n, zero) for i in range(self._n))
        return tuple(top * self._inverse for top in tops)

    def press(self, force: Vector) -> Vector:
        """(B_G^+)^T f."""
        return self._pressed(wedge(self._weighted, force))

    def _pressed(self, joined: Multivector) -> Vector:
        """The same of p ^ f."""
        tops = (_top(joined, rest, self._n, self._graph.zero) * (-1) ** k for k, rest in enumerate(self._rests))
        return tuple(top * self._inverse for top in tops)

    @cached_property
    def pseudoinverse(self) -> Matrix:
        """B_G^+ (17), n x r."""
        return transpose(tuple(self.lift(axis) for axis in identity(self._graph, self._problem.r)), self._n)

    @cached_property
    def motion(self) -> Motion:
        """q_ddot = K f - y and lambda = (B_G^+)^T (f + G y) with y = B_G^+ a."""
        problem = self._problem
        shift = self.lift(problem.bias)
        accelerations = tuple(x - y for x, y in zip(self.solve(problem.force), shift, strict=True))
        inertial = matvec(self._graph, problem.mass_matrix, shift)
        loaded = tuple(f + x for f, x in zip(problem.force, inertial, strict=True))
        whole = wedge(self._weighted, loaded)
        multipliers = self._pressed(whole)
        if self._expanded:
            # ranks are tested beside them, and have products in common; what is made first others find in its form
            tested = [x for guard in self.guards for x in (guard.denominator, guard.scale) if x is not None]
            cancelled = self._pressed(self._cancelled(whole, inertial))
            multipliers = min((cancelled, multipliers), key=lambda one: cost((*one, *tested)).weight)
        return Motion(accelerations, multipliers, self.guards)

    def _cancelled(self, whole: Multivector, inertial: Vector) -> Multivector:
        """p ^ (f + G y) with p ^ f multiplied out beside p ^ G y where that is shorter.

        A force that presses no row cancels there exactly: in p ^ (f + G y) it takes the digits of what is smaller.
        """
        driven, moved = wedge(self._weighted, self._problem.force), wedge(self._weighted, inertial)
        shorter = self._problem.multiplied_out([*driven.values()], in_either_sign([self._omega]))
        alone, zero = dict(zip(driven, shorter, strict=True)), self._graph.zero
        apart = {mask: alone.get(mask, zero) + moved.get(mask, zero) for mask in whole}
        weights = weights_alone([*apart.values(), *whole.values()])
        pairs = zip(weights, weights[len(apart) :], strict=False)
        return {
            mask: apart[mask] if one <= other else whole[mask] for mask, (one, other) in zip(whole, pairs, strict=True)
        }


def minor_motion(problem: Problem) -> MinorMotion:
    """By minors, with p and D multiplied out where that costs little: inertias that vanish have cancelled exactly."""
    plain, expanded = (MinorMotion(problem, expanded) for expanded in (False, True))
    weights = [cost((*one.motion.accelerations, *one.motion.multipliers)).weight for one in (plain, expanded)]
    return expanded if weights[1] <= (1 + CANCELLATION_WORTH) * weights[0] else plain


def _top(a: Multivector, b: Multivector, n: int, zero: Scalar) -> Scalar:
    """a ^ b for grades that add up to n."""
    full = (1 << n) - 1
    total = zero
    for mask in sorted(a):
        if (rest := full & ~mask) in b:
            term = a[mask] * b[rest]
            total = total + (term if _sign(mask, rest) > 0 else -term)
    return total


def _before(i: int, a: Multivector) -> Multivector:
    """e_i ^ a."""
    return {
        mask | 1 << i: value if _sign(1 << i, mask) > 0 else -value
        for mask, value in a.items()
        if not mask >> i & 1 and not value.is_zero
    }


def _sign(first: int, second: int) -> int:
    """The sign of the permutation that sorts the axes of `first` before those of `second`."""
    swaps = sum((first >> (axis + 1)).bit_count() for axis in range(second.bit_length()) if second >> axis & 1)
    return -1 if swaps & 1 else 1
