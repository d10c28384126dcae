"""Remark 10: the equations of motion in velocities along the inputs, where these are as many as degrees of freedom."""

from __future__ import annotations

from symgen.methods.derivation import Derivation
from symgen.symbolic.calculus import derivative_along
from symgen.symbolic.matrix import Matrix, Vector, dot, flatten, matmul, matvec, transpose
from symgen.symbolic.traverse import substitute


def actuator_basis(d: Derivation) -> Matrix:
    """W = (M~^+)^T, n x m."""
    return transpose(d.control_pseudoinverse, d.n)


def actuator_velocity(d: Derivation) -> Vector:
    """nu = M^T q_dot."""
    return tuple(dot(d.graph, column, d.mechanics.qd) for column in d.mechanics.inputs)


def actuator_mass_matrix(d: Derivation) -> Matrix:
    """W^T G W."""
    graph, m, w = d.graph, d.m, actuator_basis(d)
    half = matmul(graph, d.mechanics.mass_matrix, w, m)
    product = matmul(graph, d.control_pseudoinverse, half, m)
    return tuple(tuple(product[min(i, j)][max(i, j)] for j in range(m)) for i in range(m))


def actuator_bias(d: Derivation) -> Vector:
    """W^T (G W_dot nu + C v + Q - Q_a) at v = W nu, with W differentiated along v."""
    graph, mechanics, w = d.graph, d.mechanics, actuator_basis(d)
    nu = actuator_velocity(d)
    v = matvec(graph, w, nu)
    turning = derivative_along(graph, flatten(w), dict(zip(mechanics.q, v, strict=True)))
    rate = tuple(dot(graph, turning[i * d.m : (i + 1) * d.m], nu) for i in range(d.n))
    here = dict(zip((*mechanics.qd, *mechanics.qdd), (*v, *rate), strict=True))
    force = substitute(graph, mechanics.balance, here)
    return matvec(graph, d.control_pseudoinverse, tuple(force))
