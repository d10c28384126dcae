"""The nearest possible bodies by a semidefinite program, with CVXPY and Clarabel (the extra `semidefinite`)."""

from __future__ import annotations

import warnings

import numpy as np
from scipy import linalg

from symgen.identification.arrays import Array
from symgen.identification.bodies.nearest_bodies import LEAST_EIGENVALUE, NearestBodies
from symgen.identification.bodies.pseudo_inertia import DIRECTIONS


def by_semidefinite_program(problem: NearestBodies) -> Array | None:
    """x (v), or None where the solver does not get there.

    The unknowns of the program are factor (x - centre): its cost is the square of their length, however differently
    well the data know what they know.
    """
    import cvxpy

    size = len(problem.centre)
    steps = linalg.solve_triangular(problem.factor, np.eye(size))
    unknown = cvxpy.Variable(size)
    x = problem.centre + steps @ unknown
    flat = DIRECTIONS.reshape(10, 16).T
    conditions = [
        cvxpy.reshape(flat @ x[10 * k : 10 * k + 10], (4, 4), order="C") >> LEAST_EIGENVALUE * np.eye(4)
        for k in range(problem.bodies)
    ]
    if problem.rotors:
        conditions.append(x[problem.fixed_sign] >= LEAST_EIGENVALUE)
    program = cvxpy.Problem(cvxpy.Minimize(cvxpy.sum_squares(unknown)), conditions)
    try:
        with warnings.catch_warnings():
            # that it is less accurate is a status, too
            warnings.simplefilter("ignore", UserWarning)
            program.solve(solver=cvxpy.CLARABEL)
    except cvxpy.SolverError:
        return None
    if program.status != cvxpy.OPTIMAL:
        return None
    return np.asarray(problem.centre + steps @ unknown.value, dtype=np.float64)
