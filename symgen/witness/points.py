"""Places of the points and Jacobians of their velocities, from the formulas that expressions on them are read as."""

from __future__ import annotations

import casadi

from symgen.model.expressions.expression import Name
from symgen.model.kinematics.energy_form import points_written
from symgen.model.model import Model
from symgen.witness.lagrange import Lagrange
from symgen.witness.translate import translate, with_definitions


def point_quantities(model: Model, s: Lagrange) -> dict[str, casadi.SX]:
    """`point_position` (k×3) and `point_jacobian` (3k×n) over the symbols of `s`; nothing where there are no points."""
    if not model.mechanism.points:
        return {}
    written, places, velocities = points_written(model)
    scope = {coordinate.name: s.q[i] for i, coordinate in enumerate(model.coordinates)}
    scope |= {coordinate.rate: s.qd[i] for i, coordinate in enumerate(model.coordinates)}
    scope |= {parameter.name: s.p[i] for i, parameter in enumerate(model.parameters)}
    scope = with_definitions(scope, written.definitions)
    position = casadi.vertcat(*(translate(Name(name), scope) for name in places))
    velocity = casadi.vertcat(*(translate(Name(name), scope) for name in velocities))
    return {
        "point_position": casadi.densify(casadi.reshape(position, 3, -1).T),
        "point_jacobian": casadi.densify(casadi.jacobian(velocity, s.qd)),
    }
