"""A random non-holonomic system at 40 digits with exact derivatives: what (3)-(30) are checked on."""

import random
from dataclasses import dataclass
from functools import cached_property

import mpmath
from mpmath import cos, matrix, mp, mpf, sin

mp.dps = 45
SMALL = mpf(10) ** -33


def size(x: matrix) -> mpf:
    """The Frobenius norm."""
    return mpmath.norm(matrix(x), 2) if matrix(x).cols == 1 else mpmath.mnorm(matrix(x), "f")


def rank(x: matrix) -> int:
    """The numerical rank."""
    values = mpmath.svd_r(x, compute_uv=False)
    return sum(v > mpf(10) ** -25 * values[0] for v in values)


def pseudoinverse(x: matrix, known_rank: int) -> matrix:
    """The Moore-Penrose inverse of a matrix of known rank."""
    wide = x.rows < x.cols
    u, s, v = mpmath.svd_r(x.T if wide else x)
    result = matrix(v.cols, u.rows)
    for k in range(known_rank):
        result += v[k, :].T * u[:, k].T / s[k]
    return result.T if wide else result


@dataclass(frozen=True)
class Wavy:
    """A matrix function base + sum_k sin(q_k + phase_k) slope_k with its partial derivatives."""

    base: matrix
    slopes: tuple[matrix, ...]
    phases: tuple[mpf, ...]

    def at(self, q: list[mpf]) -> matrix:
        total = self.base.copy()
        for x, phase, slope in zip(q, self.phases, self.slopes, strict=True):
            total += sin(x + phase) * slope
        return total

    def partial(self, q: list[mpf], k: int) -> matrix:
        return cos(q[k] + self.phases[k]) * self.slopes[k]


class RandomSystem:
    """n = 5 coordinates, r = 2 constraints, m inputs at a random state; dependent velocities come first."""

    n, r = 5, 2

    def __init__(self, inputs: int = 3, seed: int = 1, holonomic: bool = False) -> None:
        source = random.Random(seed)

        def draw(rows: int, columns: int, scale: float = 1.0) -> matrix:
            return matrix([[mpf(source.uniform(-scale, scale)) for _ in range(columns)] for _ in range(rows)])

        n, r = self.n, self.r
        phases = tuple(mpf(source.uniform(0, 3)) for _ in range(n))
        symmetric = [draw(n, n, 0.15) for _ in range(n)]
        factor = draw(n, n)
        self.mass = Wavy(factor * factor.T + 2 * mpmath.eye(n), tuple(a + a.T for a in symmetric), phases)
        slopes = [draw(r, n, 0.6) for _ in range(n)]
        if holonomic:
            # the gradient of a separable function: column k depends on q_k alone
            for k, slope in enumerate(slopes):
                for i in range(r):
                    for j in range(n):
                        slope[i, j] *= j == k
        self.constraint = Wavy(draw(r, n), tuple(slopes), phases)
        self.control = Wavy(draw(n, inputs), tuple(draw(n, inputs, 0.3) for _ in range(n)), phases)
        self.weights = draw(n, 1)
        self.q = [mpf(source.uniform(-1, 1)) for _ in range(n)]
        self.q2_dot = draw(n - r, 1)
        self.q2_ddot = draw(n - r, 1)
        self.u = draw(inputs, 1)
        self.any_velocity = draw(n, 1)
        self.any_acceleration = draw(n, 1)
        self.any_force = draw(n, 1)

    @property
    def delta(self) -> int:
        return self.n - self.r

    def along(self, function: Wavy, velocity: matrix) -> matrix:
        """The time derivative of a function of q along a velocity."""
        total = function.base * 0
        for k in range(self.n):
            total += function.partial(self.q, k) * velocity[k]
        return total

    def potential(self, q: list[mpf]) -> mpf:
        return sum(w * sin(x) for w, x in zip(self.weights, q, strict=True)) + cos(q[0] * q[1])

    @cached_property
    def Q(self) -> matrix:
        q = self.q
        gradient = matrix([w * cos(x) for w, x in zip(self.weights, q, strict=True)])
        gradient[0] -= q[1] * sin(q[0] * q[1])
        gradient[1] -= q[0] * sin(q[0] * q[1])
        return gradient

    @cached_property
    def G(self) -> matrix:
        return self.mass.at(self.q)

    @cached_property
    def B(self) -> matrix:
        return self.constraint.at(self.q)

    @cached_property
    def M(self) -> matrix:
        return self.control.at(self.q)

    def C(self, velocity: matrix) -> matrix:
        """Christoffel's Coriolis matrix."""
        n, slope = self.n, [self.mass.partial(self.q, k) for k in range(self.n)]
        entries = [
            [
                sum((slope[k][i, j] + slope[j][i, k] - slope[i][j, k]) * velocity[k] / 2 for k in range(n))
                for j in range(n)
            ]
            for i in range(n)
        ]
        return matrix(entries)

    # null-space basis (8)

    @cached_property
    def F(self) -> matrix:
        upper = -(self.B[:, : self.r] ** -1) * self.B[:, self.r :]
        return self._stack(upper, mpmath.eye(self.delta))

    def F_partial(self, k: int) -> matrix:
        """dF/dq_k."""
        slope = self.constraint.partial(self.q, k)
        upper = -(self.B[:, : self.r] ** -1) * (slope[:, self.r :] + slope[:, : self.r] * self.F[: self.r, :])
        return self._stack(upper, mpmath.zeros(self.delta))

    @staticmethod
    def _stack(upper: matrix, lower: matrix) -> matrix:
        return matrix(upper.tolist() + lower.tolist())

    @cached_property
    def velocity(self) -> matrix:
        """Admissible: B qd = 0."""
        return self.F * self.q2_dot

    @cached_property
    def F_dot(self) -> matrix:
        return sum((self.F_partial(k) * self.velocity[k] for k in range(self.n)), self.F * 0)

    @cached_property
    def acceleration(self) -> matrix:
        """Admissible: B qdd + Bdot qd = 0."""
        return self.F * self.q2_ddot + self.F_dot * self.q2_dot

    @cached_property
    def B_dot(self) -> matrix:
        return self.along(self.constraint, self.velocity)

    @cached_property
    def bias(self) -> matrix:
        """C qd + Q at the admissible velocity."""
        return self.C(self.velocity) * self.velocity + self.Q

    @cached_property
    def dynamics(self) -> tuple[matrix, matrix]:
        """(qdd, lambda) of G qdd + C qd + Q + B^T lambda = M u, B qdd + Bdot qd = 0."""
        n, r = self.n, self.r
        system = mpmath.zeros(n + r)
        system[:n, :n], system[:n, n:], system[n:, :n] = self.G, self.B.T, self.B
        right = matrix((self.M * self.u - self.bias).tolist() + (-self.B_dot * self.velocity).tolist())
        solution = mpmath.lu_solve(system, right)
        return solution[:n], solution[n:]

    # projectors

    @cached_property
    def B_plus(self) -> matrix:
        return self.B.T * (self.B * self.B.T) ** -1

    @cached_property
    def N(self) -> matrix:
        return mpmath.eye(self.n) - self.B_plus * self.B

    def N_dot(self, velocity: matrix) -> matrix:
        """Remark 9."""
        x = self.B_plus * self.along(self.constraint, velocity) * self.N
        return -x - x.T

    @cached_property
    def B_G_plus(self) -> matrix:
        inverse = self.G**-1
        return inverse * self.B.T * (self.B * inverse * self.B.T) ** -1
