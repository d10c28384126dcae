"""(3), (6)-(12), (14)-(22), (24)-(30): each holds as printed or as corrected, and the misprints are refuted.

Where a form is printed wrong, its residual on a random system is not zero while that of the corrected form is.
"""

import mpmath
import pytest
from mpmath import eye, matrix, mp, mpf
from random_system import SMALL, RandomSystem, pseudoinverse, rank, size


@pytest.fixture(autouse=True)
def digits() -> None:
    mp.dps = 45


@pytest.fixture(scope="module")
def system() -> RandomSystem:
    return RandomSystem()


def is_zero(x: matrix) -> bool:
    return bool(size(x) < SMALL)


def is_large(x: matrix) -> bool:
    return bool(size(x) > mpf(10) ** -3)


def test_3_lagrange_with_christoffel(system: RandomSystem) -> None:
    """d/dt dL/dqd - dL/dq equals G qdd + C qd + Q (differences at 90 digits)."""
    velocity, acceleration, q = system.any_velocity, system.any_acceleration, system.q
    mp.dps = 90
    h = mpf(10) ** -25

    def momentum(t: mpf) -> matrix:
        moved = [x + v * t + a * t * t / 2 for x, v, a in zip(q, velocity, acceleration, strict=True)]
        return system.mass.at(moved) * (velocity + acceleration * t)

    def lagrangian(k: int, shift: mpf) -> mpf:
        moved = [x + (shift if i == k else 0) for i, x in enumerate(q)]
        return (velocity.T * system.mass.at(moved) * velocity)[0] / 2 - system.potential(moved)

    left = (momentum(h) - momentum(-h)) / (2 * h)
    left -= matrix([(lagrangian(k, h) - lagrangian(k, -h)) / (2 * h) for k in range(system.n)])
    right = system.G * acceleration + system.C(velocity) * velocity + system.Q
    assert is_zero(left - right)


def test_3_multipliers_do_no_work_with_plus_on_the_left(system: RandomSystem) -> None:
    acceleration, multipliers = system.dynamics
    residual = system.G * acceleration + system.bias + system.B.T * multipliers - system.M * system.u
    assert is_zero(residual)
    assert is_zero(system.velocity.T * system.B.T * multipliers)


def test_6_to_8_orthogonal_complement(system: RandomSystem) -> None:
    assert is_zero(system.B * system.F)
    split = system.B[:, : system.r] * system.velocity[: system.r] + system.B[:, system.r :] * system.q2_dot
    assert is_zero(split)
    assert is_zero(system.F * system.velocity[system.r :] - system.velocity)
    assert is_large(system.F * system.any_velocity[system.r :] - system.any_velocity)  # on the manifold only


def minimal(s: RandomSystem) -> tuple[matrix, matrix, matrix, matrix]:
    """G, C, Q, M of (9)."""
    coriolis = s.F.T * (s.C(s.velocity) * s.F + s.G * s.F_dot)
    return s.F.T * s.G * s.F, coriolis, s.F.T * s.Q, s.F.T * s.M


def test_9_minimal_equations(system: RandomSystem) -> None:
    mass, coriolis, force, control = minimal(system)
    left = mass * system.q2_ddot + coriolis * system.q2_dot + force - control * system.u
    full = system.F.T * (system.G * system.acceleration + system.bias - system.M * system.u)
    assert is_zero(left - full)
    change = system.F_dot.T * system.G * system.F
    change += change.T + system.F.T * system.along(system.mass, system.velocity) * system.F
    twist = change - 2 * coriolis
    assert is_zero(twist + twist.T)


def test_10_constrained_lagrangian(system: RandomSystem) -> None:
    mass = minimal(system)[0]
    inserted = (system.velocity.T * system.G * system.velocity)[0] / 2
    assert is_zero(matrix([inserted - (system.q2_dot.T * mass * system.q2_dot)[0] / 2]))


def non_holonomy(s: RandomSystem) -> list[list[list[mpf]]]:
    """A[a1][b2][a2], first line of (12)."""
    slope = [s.F_partial(c) for c in range(s.n)]
    return [
        [
            [
                sum(s.F[c, a2] * slope[c][a1, b2] - s.F[c, b2] * slope[c][a1, a2] for c in range(s.n))
                for a2 in range(s.delta)
            ]
            for b2 in range(s.delta)
        ]
        for a1 in range(s.n)
    ]


def voronets(s: RandomSystem, momentum: matrix, sign: int = 1) -> matrix:
    """The left-hand side of (11) with the given dL/dqd^{a1} in its third term, minus that of (9)."""
    mass, coriolis, force, _ = minimal(s)
    partial = []
    for k in range(s.n):
        slope = s.F_partial(k).T * s.G * s.F
        slope += slope.T + s.F.T * s.mass.partial(s.q, k) * s.F
        partial.append((s.q2_dot.T * slope * s.q2_dot)[0] / 2 - s.Q[k])
    change = s.F_dot.T * s.G * s.F
    change += change.T + s.F.T * s.along(s.mass, s.velocity) * s.F
    left = change * s.q2_dot + mass * s.q2_ddot - s.F.T * matrix(partial)
    curvature = non_holonomy(s)
    third = [
        sum(momentum[a1] * curvature[a1][b2][a2] * s.q2_dot[b2] for a1 in range(s.r) for b2 in range(s.delta))
        for a2 in range(s.delta)
    ]
    return left + sign * matrix(third) - (mass * s.q2_ddot + coriolis * s.q2_dot + force)


def test_11_voronets_needs_the_unconstrained_momentum(system: RandomSystem) -> None:
    momentum = system.G * system.velocity
    assert is_zero(voronets(system, momentum))
    assert is_large(voronets(system, momentum * 0))  # as printed: the constrained Lagrangian has no qd^{a1}
    assert is_large(voronets(system, momentum, sign=-1))


def test_12_object_of_non_holonomy(system: RandomSystem) -> None:
    curvature = non_holonomy(system)
    slope = [system.F_partial(c) for c in range(system.n)]
    r, n = system.r, system.n

    def second_line(a1: int, b2: int, a2: int, definition: bool) -> mpf:
        def turn(lower: int, other: int) -> mpf:
            """d/dq^{lower} of F^{a1}_{other}: the plain partial, or the definition given after (11)."""
            if definition:
                return sum(system.F[c, lower] * slope[c][a1, other] for c in range(n))
            return slope[r + lower][a1, other]

        rest = sum(system.F[c, a2] * slope[c][a1, b2] - system.F[c, b2] * slope[c][a1, a2] for c in range(r))
        return turn(a2, b2) - turn(b2, a2) + rest

    indices = [(a1, b2, a2) for a1 in range(r) for b2 in range(system.delta) for a2 in range(system.delta)]
    plain = [second_line(*i, definition=False) - curvature[i[0]][i[1]][i[2]] for i in indices]
    twice = [second_line(*i, definition=True) - curvature[i[0]][i[1]][i[2]] for i in indices]
    assert is_zero(matrix(plain))
    assert is_large(matrix(twice))
    lower = [curvature[a][b2][a2] for a in range(r, n) for b2 in range(system.delta) for a2 in range(system.delta)]
    assert is_zero(matrix(lower))  # the Lie bracket has components in a1 only
    assert is_large(matrix([curvature[a1][b2][a2] for a1, b2, a2 in indices]))
    holonomic = non_holonomy(RandomSystem(holonomic=True))
    assert is_zero(matrix([holonomic[a1][b2][a2] for a1, b2, a2 in indices]))


def test_13_connection_form(system: RandomSystem) -> None:
    inverse = system.B[:, : system.r] ** -1
    assert is_zero(system.velocity[: system.r] + inverse * system.B[:, system.r :] * system.q2_dot)


def test_14_multipliers(system: RandomSystem) -> None:
    s = system
    right = s.B_dot * s.velocity + s.B * s.G**-1 * (s.M * s.u - s.bias)
    assert is_zero((s.B * s.G**-1 * s.B.T) ** -1 * right - s.dynamics[1])
    assert is_large((s.B * s.G * s.B.T) ** -1 * right - s.dynamics[1])  # as printed


def test_15_equations_without_multipliers(system: RandomSystem) -> None:
    s = system
    right = s.B_dot * s.velocity + s.B * s.G**-1 * (s.M * s.u - s.bias)
    base = s.G * s.dynamics[0] + s.bias - s.M * s.u
    assert is_zero(base + s.B.T * (s.B * s.G**-1 * s.B.T) ** -1 * right)
    assert is_large(base + s.B.T * (s.B * s.G * s.B.T) ** -1 * right)  # as printed


def test_16_multipliers_from_the_weighted_pseudoinverse(system: RandomSystem) -> None:
    s = system
    assert is_zero(-s.B_G_plus.T * (s.G * s.dynamics[0] + s.bias - s.M * s.u) - s.dynamics[1])


def test_17_weighted_pseudoinverse(system: RandomSystem) -> None:
    s = system
    assert is_zero(s.B * s.B_G_plus - eye(s.r))
    shortest = -s.B_G_plus * s.B_dot * s.velocity
    assert is_zero(s.B * shortest + s.B_dot * s.velocity)
    assert is_zero(s.F.T * s.G * shortest)  # stationary: Gibbs-Appell, interpretation 1


def test_17_second_interpretation_holds_in_the_norm_of_the_inverse_mass(system: RandomSystem) -> None:
    s = system
    error = s.any_force - s.B.T * s.B_G_plus.T * s.any_force
    assert is_zero(s.B * s.G**-1 * error)
    assert is_large(s.B * error)  # as printed: the Euclidean norm


def test_18_and_19_weighted_projector(system: RandomSystem) -> None:
    s = system
    projector = eye(s.n) - s.B_G_plus * s.B
    assert is_zero(projector.T * (s.G * s.dynamics[0] + s.bias - s.M * s.u))
    assert is_zero(s.B * projector)
    assert is_zero(projector * projector - projector)
    assert is_zero(s.G * projector - projector.T * s.G)
    assert rank(projector) == s.delta
    assert is_zero(projector - s.F * (s.F.T * s.G * s.F) ** -1 * s.F.T * s.G)


def test_20_udwadia_and_kalaba(system: RandomSystem) -> None:
    s = system
    values, vectors = mpmath.eigsy(s.G)
    root = vectors * mpmath.diag([mpmath.sqrt(v) for v in values]) * vectors.T
    assert is_zero(root * root - s.G)
    force, b = s.M * s.u - s.bias, -s.B_dot * s.velocity

    def residual(d: matrix) -> matrix:
        return s.G * s.dynamics[0] - force - root * pseudoinverse(d, s.r) * (b - s.B * s.G**-1 * force)

    assert is_zero(residual(s.B * root**-1))
    assert is_large(residual(s.B * root))
    with pytest.raises(ValueError, match="dimensions"):
        root * s.B  # as printed: the dimensions clash
    corrected = root * pseudoinverse(s.B * root**-1, s.r)
    assert is_zero(corrected - s.G * s.B_G_plus)
    assert is_large(s.B.T * (s.B * s.G * s.B.T) ** -1 - s.G * s.B_G_plus)  # the middle term as printed


def test_21_projected_equations(system: RandomSystem) -> None:
    s = system
    assert is_zero(s.N * (s.G * s.dynamics[0] + s.bias) - s.N * s.M * s.u)
    assert is_zero(s.N - s.N.T)
    assert is_zero(s.N * s.N - s.N)


def test_22_aghili(system: RandomSystem) -> None:
    s = system
    acceleration, force, change = s.dynamics[0], s.M * s.u - s.bias, s.N_dot(s.velocity) * s.velocity
    coefficient = s.G + s.N * s.G - s.G * s.N
    assert is_zero(coefficient * acceleration - s.N * force - s.G * change)
    assert is_large(coefficient * acceleration - s.N * force + s.G * change)  # sign as printed
    assert is_large(coefficient - coefficient.T)  # not symmetric
    assert is_zero(coefficient + coefficient.T - 2 * s.G)  # but positive definite as a form
    rest, mu = eye(s.n) - s.N, mpf(3)
    first = s.N * s.G + s.G * s.N - s.G
    assert is_zero(first * acceleration - (s.N * force - s.G * change))
    assert mpmath.eigsy(first, eigvals_only=True)[0] < 0  # symmetric, regular, indefinite
    second = s.N * s.G * s.N + rest * s.G * rest
    assert is_zero(second * acceleration - (s.N * force + (rest - s.N) * s.G * change))
    third = s.N * s.G * s.N + mu * rest
    assert is_zero(third * acceleration - (s.N * force - s.N * s.G * change + mu * change))
    assert all(mpmath.eigsy(x, eigvals_only=True)[0] > 0 for x in (second, third))
    assert is_zero(change + s.B_plus * s.B_dot * s.velocity)


def test_24_and_25_control_system(system: RandomSystem) -> None:
    mass, coriolis, force, control = minimal(system)
    drift = -system.F * mass**-1 * (coriolis * system.q2_dot + force) + system.F_dot * system.q2_dot
    assert is_zero(drift + system.F * mass**-1 * control * system.u - system.dynamics[0])


def test_26_degree_of_actuation(system: RandomSystem) -> None:
    s = system
    joined = matrix(s.B.tolist() + s.M.T.tolist())
    assert rank(s.F.T * s.M) == rank(s.N * s.M) == rank(joined) - s.r == s.delta
    many = RandomSystem(inputs=5)  # as many inputs as local degrees of freedom: redundant, always
    assert rank(many.F.T * many.M) == many.delta < 5


@pytest.mark.parametrize("inputs", [3, 4])
def test_27_inverse_dynamics(inputs: int) -> None:
    s = RandomSystem(inputs)
    projected = s.N * s.M
    inverse = pseudoinverse(projected, s.delta)
    assert is_zero(inverse * s.N - inverse)  # the factor N_B is redundant
    load = s.G * s.acceleration + s.bias
    controls = inverse * s.N * load
    assert is_zero(s.N * (load - s.M * controls))
    if inputs == s.delta:
        assert is_zero(inverse - (projected.T * projected) ** -1 * projected.T)
        forward = inverse * s.N * (s.G * s.dynamics[0] + s.bias)
        assert is_zero(forward - s.u)
    weights = s.F * (s.F.T * s.F) ** -1  # another null-space basis
    assert is_zero(pseudoinverse(weights.T * s.M, s.delta) * weights.T - inverse)
    assert is_zero(pseudoinverse(s.F.T * s.M, s.delta) * s.F.T - inverse)


def test_28_pseudoinverse_by_partition() -> None:
    s = RandomSystem(4)
    projected = s.N * s.M
    first, second = projected[:, : s.delta], projected[:, s.delta :]
    left = (first.T * first) ** -1 * first.T
    ratio = left * second
    core = (eye(1) + ratio.T * ratio) ** -1
    printed = matrix((left * (eye(s.n) - second * core * ratio.T * left)).tolist() + (core * ratio.T * left).tolist())
    inverse = pseudoinverse(projected, s.delta)
    assert is_zero(printed - inverse)
    short = matrix(eye(s.delta).tolist() + ratio.T.tolist()) * (eye(s.delta) + ratio * ratio.T) ** -1 * left
    assert is_zero(short - inverse)


def test_29_and_30_projected_velocity_and_acceleration(system: RandomSystem) -> None:
    s = system
    velocity = s.N * s.any_velocity
    change = s.N_dot(velocity)
    acceleration = s.N * s.any_acceleration + change * velocity
    bias = s.along(s.constraint, velocity) * velocity
    assert is_zero(s.B * acceleration + bias)
    # with N-dot along the raw velocity the accelerations are not admissible
    raw = s.N * s.any_acceleration + s.N_dot(s.any_velocity) * velocity
    assert is_large(s.B * raw + bias)
    mass = s.N.T * s.G * s.N
    coriolis = s.N.T * (s.C(velocity) * s.N + s.G * change)
    # N-dot acts on the projected velocity
    left = mass * s.any_acceleration + coriolis * velocity + s.N.T * s.Q
    right = s.N * (s.G * acceleration + s.C(velocity) * velocity + s.Q)
    assert is_zero(left - right)


def test_remark_9_derivative_of_the_projector(system: RandomSystem) -> None:
    s = system
    velocity = s.any_velocity
    mp.dps = 90
    h = mpf(10) ** -22

    def projector(t: mpf) -> matrix:
        b = s.constraint.at([x + v * t for x, v in zip(s.q, velocity, strict=True)])
        return eye(s.n) - b.T * (b * b.T) ** -1 * b

    quotient = (projector(h) - projector(-h)) / (2 * h)
    assert size(quotient - s.N_dot(velocity)) < mpf(10) ** -30
    assert is_zero(s.N_dot(velocity) - s.N_dot(velocity).T)


def test_section_5_4_skewness(system: RandomSystem) -> None:
    s = system
    change = s.N_dot(s.velocity)
    mass = s.N.T * s.G * s.N
    mass_dot = change * s.G * s.N + s.N * s.along(s.mass, s.velocity) * s.N + s.N * s.G * change

    def twist(coriolis: matrix, first: matrix) -> matrix:
        projected = s.N.T * (coriolis * s.N + s.G * change)
        result = first - 2 * projected
        return result + result.T

    christoffel = s.C(s.velocity)
    assert is_zero(twist(christoffel, mass_dot))
    assert is_large(twist(christoffel, mass))  # as printed, without the time derivative
    other = christoffel + s.any_force * (matrix([0, 0, s.velocity[3], -s.velocity[2], 0])).T
    assert is_zero((other - christoffel) * s.velocity)
    assert is_large(twist(other, mass_dot))  # another C with the same C qd


def test_section_5_4_determinant_and_invariance_of_u() -> None:
    """det M1^T M1 = det^2 B1 / det B B^T for drives on coordinates; u does not depend on F."""
    s = RandomSystem()
    select = matrix(s.n, s.delta)
    for k in range(s.delta):
        select[s.r + k, k] = 1
    projected = s.N * select
    left = mpmath.det(projected.T * projected)
    right = mpmath.det(s.B[:, : s.r]) ** 2 / mpmath.det(s.B * s.B.T)
    assert abs(left - right) < SMALL
    load = s.G * s.acceleration + s.bias
    other = s.F * (eye(s.delta) + matrix([[0, 3, 1], [0, 0, -2], [0, 0, 1]]))
    controls = [(f.T * s.M) ** -1 * f.T * load for f in (s.F, other)]
    assert is_zero(controls[0] - controls[1])
