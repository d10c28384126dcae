"""The box that proofs speak of: the ranges of coordinates, rates, accelerations and parameters in the model file."""

from __future__ import annotations

from fractions import Fraction

from symgen.backends.defaults import default_values
from symgen.ir.kernel import Kernel, Load, Local
from symgen.model.model import Model, Range

# Inputs, tasks, weights and directions have no range in a model file: one unit, as for all else that has none.
_UNIT: Range = (Fraction(-1), Fraction(1))


def box(model: Model) -> dict[str, tuple[Range, ...]]:
    """The range of every entry of every argument; `p` holds the parameters in their order.

    A parameter without a range is a point, its default.
    """
    values = default_values(model)
    return {
        "q": tuple(coordinate.range for coordinate in model.coordinates),
        "qd": tuple(coordinate.rate_range for coordinate in model.coordinates),
        "qdd": tuple(coordinate.acceleration_range for coordinate in model.coordinates),
        "u": (_UNIT,) * model.m,
        "q_m": tuple(model.coordinates[k].range for k in model.measured_places),
        "qd_m": tuple(model.coordinates[k].rate_range for k in model.measured_places),
        "qdd_m": tuple(model.coordinates[k].acceleration_range for k in model.measured_places),
        **{argument: (_UNIT,) * len(model.task) for argument in ("x_t", "xd_t", "xdd_t")},
        "w_u": (_UNIT,) * model.m,
        "w_qdd": (_UNIT,) * model.n,
        "v_x": (_UNIT,) * (3 * model.n),
        "p": tuple(p.range or (values[p.name], values[p.name]) for p in model.parameters),
    }


def loaded_angles(kernel: Kernel) -> tuple[Load, ...]:
    """The coordinates whose sine and cosine a kernel takes as they are."""
    reduced = {s.operands[0] for s in kernel.statements if s.operation == "sincos"}
    return tuple(load for load in kernel.loads if load.argument == "q" and Local(load.local) in reduced)
