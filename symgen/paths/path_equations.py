"""The equations of a path, h(q, t) = [g(q); conditions(q, t)] = 0, with the derivatives Newton's method needs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symgen.diagnostics import Mistake
from symgen.model.kinematics.energy_form import energy_form
from symgen.model.model import Model, Path

Array = NDArray[np.float64]


class PathError(Exception):
    """A path of the model file that cannot be followed, with the mistake to show in the file."""

    def __init__(self, path: Path, problem: str, remedy: str) -> None:
        self.mistake = Mistake(f"path `{path.name}`: {problem}", remedy, path.span)
        super().__init__(f"{self.mistake.message}; {remedy}")


@dataclass(frozen=True, slots=True)
class PathEquations:
    """h (k) and its Jacobian ∂h/∂q (k×n), the parts of ḣ and ḧ without q̈, and the non-holonomic rows' residual."""

    path: Path
    geometric_rows: int
    _position: Any
    _rate: Any
    _acceleration: Any
    _nonholonomic: Any
    _parameters: Any

    def position(self, q: Array, t: float) -> tuple[Array, Array]:
        """h (k) and ∂h/∂q (k×n)."""
        h, jacobian = self._position(q, t, self._parameters)
        return h.full().ravel(), jacobian.full()

    def rate(self, q: Array, t: float) -> Array:
        """∂h/∂t, k."""
        return np.asarray(self._rate(q, t, self._parameters).full().ravel())

    def acceleration(self, q: Array, qd: Array, t: float) -> Array:
        """d²h/dt² at q̈ = 0, k."""
        return np.asarray(self._acceleration(q, qd, t, self._parameters).full().ravel())

    def of(self, parameters: Sequence[float]) -> PathEquations:
        """The same equations with other values of the parameters, in the order of the model."""
        return replace(self, _parameters=np.array(parameters, dtype=float))

    @property
    def parameters_used(self) -> tuple[int, ...]:
        """The numbers of the parameters that the motion depends on."""
        _, columns = self._position.jac_sparsity(0, 2).get_triplet()
        return tuple(sorted(set(columns)))

    def positions(self, q: Array, t: float, p: Array) -> tuple[Array, Array]:
        """h (c×k) and ∂h/∂q (c×k×n) of c machines with parameters p (c×...) at q (c×n)."""
        h, jacobian = self._position(q.T, t, p.T)
        count, n = q.shape
        return h.full().T, jacobian.full().reshape(-1, count, n).transpose(1, 0, 2)

    def rates(self, q: Array, t: float, p: Array) -> Array:
        """∂h/∂t of these machines, c×k."""
        return np.asarray(self._rate(q.T, t, p.T).full().T)

    def accelerations(self, q: Array, qd: Array, t: float, p: Array) -> Array:
        """d²h/dt² at q̈ = 0 of these machines, c×k."""
        return np.asarray(self._acceleration(q.T, qd.T, t, p.T).full().T)

    def nonholonomic(self, q: Array, qd: Array) -> Array:
        """What the non-holonomic rows leave of 0, r_v."""
        return np.asarray(self._nonholonomic(q, qd, self._parameters).full().ravel())


def path_equations(model: Model, path: Path) -> PathEquations:
    """The equations of one path with the model's default parameters."""
    import casadi

    from symgen.witness.translate import default_parameters, translate, with_definitions

    model = energy_form(model)
    q, qd, t = casadi.SX.sym("q", model.n), casadi.SX.sym("qd", model.n), casadi.SX.sym("t")
    p = casadi.SX.sym("p", len(model.parameters))
    positions = {coordinate.name: q[i] for i, coordinate in enumerate(model.coordinates)}
    positions |= {parameter.name: p[i] for i, parameter in enumerate(model.parameters)}
    rates = {coordinate.rate: qd[i] for i, coordinate in enumerate(model.coordinates)}
    model_scope = with_definitions(positions | rates, model.definitions)
    path_scope = with_definitions(with_definitions(positions, model.definitions) | {"t": t}, path.definitions)
    geometric = [translate(row.expression, model_scope) for row in model.constraints if row.kind == "geometric"]
    nonholonomic = [translate(row.expression, model_scope) for row in model.constraints if row.kind == "nonholonomic"]
    conditions = [translate(condition, path_scope) for _, condition in path.conditions]

    h = casadi.densify(casadi.vertcat(casadi.SX(0, 1), *geometric, *conditions))
    jacobian, h_t = casadi.jacobian(h, q), casadi.jacobian(h, t)
    h_dot = jacobian @ qd + h_t
    h_ddot = casadi.jacobian(h_dot, q) @ qd + casadi.jacobian(h_dot, t)
    rows = casadi.densify(casadi.vertcat(casadi.SX(0, 1), *nonholonomic))
    return PathEquations(
        path=path,
        geometric_rows=len(geometric),
        _position=casadi.Function("position", [q, t, p], [h, jacobian]),
        _rate=casadi.Function("rate", [q, t, p], [h_t]),
        _acceleration=casadi.Function("acceleration", [q, qd, t, p], [h_ddot]),
        _nonholonomic=casadi.Function("nonholonomic", [q, qd, p], [rows]),
        _parameters=default_parameters(model),
    )
