"""What the paper's Figures 4 to 7 show, for any model with a path."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from symgen.model.model import Model, Path
from symgen.paths.forces import Forces, forces_along, inverse_dynamics
from symgen.paths.path_equations import Array
from symgen.paths.printed import SwitchedInputs, switched_inverse_dynamics
from symgen.paths.trajectory import PathSolver, Trajectory, solve_path
from symgen.paths.zeros import SingularPoses

# Of the largest determinant met on the path: where (28) is repartitioned.
SWITCHING_SHARE = 0.05


@dataclass(frozen=True, slots=True)
class Curve:
    """det M̃_JᵀM̃_J (k) for the δ inputs J (indices), with its zeros: their times and configurations q (zeros×n).

    The zeros are the input singularities (Fig. 4) of the system that has the inputs J alone.
    """

    inputs: tuple[int, ...]
    values: Array
    zeros: tuple[float, ...]
    poses: Array


@dataclass(frozen=True, slots=True)
class FigureData:
    """A path and what its inputs do: coordinates (Fig. 5), curves (Fig. 6, none if m < δ), inputs u (k×m, Fig. 7).

    `u` is (WᵀM)⁺Wᵀτ; `printed` is (27) with (28), repartitioned among the curves' inputs below `threshold`; it is None
    where the formulas do not apply: under-actuated systems and constraints that depend on each other.
    """

    path: Path
    trajectory: Trajectory
    forces: Forces
    curves: tuple[Curve, ...]
    u: Array
    threshold: float
    printed: SwitchedInputs | None


def figure_data(model: Model, path: Path) -> FigureData:
    """Solves the path and works out everything the figures show; PathError if the path cannot be followed."""
    trajectory = solve_path(model, path)
    forces = forces_along(model, trajectory)
    rank, freedom = model.n - forces.W.shape[2], forces.W.shape[2]
    singular = SingularPoses(model, PathSolver(model, path), trajectory, forces)
    curves = tuple(_curve(singular, J, model.n) for J in combinations(range(model.m), freedom))
    threshold = SWITCHING_SHARE * max((float(np.max(curve.values)) for curve in curves), default=0.0)
    printed = None
    if threshold > 0 and rank == model.r > 0:
        partitions = [curve.inputs for curve in curves]
        printed = switched_inverse_dynamics(forces.B, forces.M, forces.tau, partitions, threshold)
    return FigureData(path, trajectory, forces, curves, inverse_dynamics(forces), threshold, printed)


def _curve(singular: SingularPoses, J: tuple[int, ...], n: int) -> Curve:
    zeros = singular.of(J)
    poses = np.array([q for _, q in zeros]).reshape(-1, n)
    return Curve(J, singular.determinants(J) ** 2, tuple(t for t, _ in zeros), poses)
