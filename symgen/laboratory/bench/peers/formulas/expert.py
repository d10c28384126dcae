"""The choices an expert makes by hand for the methods `part` and `elimination`: cheap, and far from singular.

Among all choices those count whose determinant never falls below a ten-thousandth of the best choice's at the same
state (if none does, the one that comes closest); of these the one with the fewest operations in CasADi.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import combinations
from math import comb
from typing import Any

import casadi

from symgen.laboratory.bench.peers.engines.casadi_engine import CasadiEngine
from symgen.laboratory.bench.peers.engines.engine import Symbol
from symgen.laboratory.bench.peers.formulas.algebra import DeadPivotError
from symgen.laboratory.bench.peers.formulas.mechanics import PeerSystem, mechanics
from symgen.laboratory.bench.peers.formulas.methods import elimination, part, selected_rows
from symgen.laboratory.bench.peers.formulas.motions import along_null_space, motion_system
from symgen.model.model import Model
from symgen.witness.lagrange import Lagrange

FAR_ENOUGH = 1e-4
MOST_CHOICES = 3000
MOST_COUNTED = 30
Choice = tuple[int, ...]
Route = Callable[[CasadiEngine, Model], PeerSystem]


def independent_coordinates(model: Model, s: Lagrange, states: Any, derive: Route = mechanics) -> Choice | None:
    """The δ coordinates F of the method `part` is made from; None where the method does not apply."""
    n, r = model.n, model.r
    if model.m < n - r or comb(n, r) > MOST_CHOICES:
        return None
    jacobians = _jacobians(model, s, states)
    choices = list(combinations(range(n), n - r))
    dependent = [[i for i in range(n) if i not in choice] for choice in choices]
    squares = [jacobians[:, :, rows] for rows in dependent]
    return _best(choices, squares, lambda choice: part(*_fresh(derive, model), choice))


def independent_of_motion(model: Model, s: Lagrange, states: Any) -> Choice | None:
    """The delta coordinates that a null space of accelerations is made from; None where choices are too many."""
    n, r = model.n, model.r
    if not r or comb(n, r) > MOST_CHOICES:
        return None
    jacobians = _jacobians(model, s, states)
    choices = list(combinations(range(n), n - r))
    dependent = [[i for i in range(n) if i not in choice] for choice in choices]

    def outputs(choice: Choice) -> list[Symbol]:
        engine = CasadiEngine()
        accelerations, multipliers = along_null_space(engine, motion_system(engine, model), choice)
        return [*accelerations, *multipliers]

    return _best(choices, [jacobians[:, :, rows] for rows in dependent], outputs)


def free_multipliers(model: Model, s: Lagrange, states: Any, derive: Route = mechanics) -> Choice | None:
    """The m − δ multipliers the method `elimination` leaves for last; None where the method does not apply."""
    engine = CasadiEngine()
    active = selected_rows(engine, derive(engine, model).M)
    free = model.m - (model.n - model.r)
    if active is None or free < 0 or comb(model.r, free) > MOST_CHOICES:
        return None
    passive = [i for i in range(model.n) if i not in active]
    jacobians = _jacobians(model, s, states)[:, :, passive]
    choices = list(combinations(range(model.r), free))
    bound = [[k for k in range(model.r) if k not in choice] for choice in choices]
    squares = [jacobians[:, rows, :] for rows in bound]
    return _best(choices, squares, lambda choice: elimination(*_fresh(derive, model), choice))


def _fresh(derive: Route, model: Model) -> tuple[CasadiEngine, PeerSystem]:
    engine = CasadiEngine()
    return engine, derive(engine, model)


def _jacobians(model: Model, s: Lagrange, states: Any) -> Any:
    """B at every state, (k, r, n)."""
    import numpy as np

    function = casadi.Function("jacobian", [s.q, s.p], [casadi.densify(s.jacobian)])
    n, parameters = model.n, len(model.parameters)
    return np.array([function(row[:n], row[len(row) - parameters :]).full() for row in states])


def _best(
    choices: list[Choice], squares: Iterable[Any], outputs: Callable[[Choice], list[Symbol]]
) -> Choice | None:
    import numpy as np

    sizes = np.array([np.abs(np.linalg.det(square)) for square in squares])
    best = sizes.max(axis=0)
    distances = (sizes / np.where(best > 0, best, 1.0)).min(axis=1)
    order = sorted(range(len(choices)), key=lambda k: -distances[k])
    far = [k for k in order if distances[k] >= FAR_ENOUGH][:MOST_COUNTED] or order[:1]
    costs: dict[int, int] = {}
    for k in far:
        try:
            costs[k] = casadi.n_nodes(casadi.cse(casadi.vertcat(*outputs(choices[k]))))
        except DeadPivotError:
            continue
    return choices[min(costs, key=lambda k: costs[k])] if costs else None
