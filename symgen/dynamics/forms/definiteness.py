"""Whether the mass matrix is positive definite everywhere, not only along the constraints.

The smallest pivot of G = L D L^T in units of its diagonal entry is minimised over configurations and parameters within
their ranges, from many seeded starts, by moving one number at a time (Hooke and Jeeves' pattern search).  A coordinate
without mass, or a quaternion's, shows as a pivot that vanishes somewhere.
"""

from __future__ import annotations

import math
import random
from functools import lru_cache

from symgen.dynamics.genericity import parameter_values
from symgen.dynamics.inertia import Cholesky, diagonal_sizes
from symgen.dynamics.mechanics import Mechanics
from symgen.graph.evaluate import Evaluator
from symgen.graph.scalar import Scalar
from symgen.graph.traverse import topological

SEED = 15
STARTS = 4
HALVINGS = 11
# Between what inertias of one machine differ by and what is left of a pivot that vanishes after the last halving.
SMALLEST = 1e-4


@lru_cache(maxsize=2)  # asked for q_ddot and for lambda, along each null space
def positive_definite(mechanics: Mechanics) -> bool:
    """Whether G is positive definite at every configuration, for parameters in their ranges.

    On a graph of its own, so that no kernel shares the pivots.
    """
    mechanics = Mechanics(mechanics.model)
    graph = mechanics.graph
    if any(row[i].is_zero for i, row in enumerate(mechanics.mass_matrix)):
        return False
    pivots: list[Scalar] = []
    factor = Cholesky(graph, mechanics.mass_matrix, diagonal_sizes(graph, mechanics.mass_matrix))
    for i, pivot in enumerate(factor.pivots):
        if pivot.is_zero:
            return False
        pivots.append(pivot / mechanics.mass_matrix[i][i])
    if all(pivot.constant is not None for pivot in pivots):
        return all((pivot.constant or 0) > 0 for pivot in pivots)
    return _smallest(mechanics, pivots) > SMALLEST


def _smallest(mechanics: Mechanics, pivots: list[Scalar]) -> float:
    evaluate = Evaluator(pivots)
    known = parameter_values(mechanics)
    reached = {str(node.payload) for node in topological(pivots) if node.op == "symbol"}
    ranges = {c.name: (float(c.range[0]), float(c.range[1])) for c in mechanics.model.coordinates if c.name in reached}
    for parameter in mechanics.model.parameters:
        if parameter.name in reached and parameter.range is not None:
            ranges[parameter.name] = float(parameter.range[0]), float(parameter.range[1])

    def measure(point: dict[str, float]) -> float:
        values = evaluate(point)
        return -math.inf if any(math.isnan(x) for x in values) else min(values)

    source = random.Random(SEED)
    best = math.inf
    for start in range(STARTS):
        point = known | {
            name: source.uniform(*limits) if start or name not in known else known[name]
            for name, limits in ranges.items()
        }
        least = measure(point)
        for halving in range(1, HALVINGS):
            for name, (low, high) in ranges.items():
                for step in (-1, 1):
                    moved = min(high, max(low, point[name] + step * (high - low) * 0.5**halving))
                    trial = point | {name: moved}
                    if (value := measure(trial)) < least:
                        point, least = trial, value
        best = min(best, least)
    return best
