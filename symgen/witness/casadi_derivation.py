"""A model's quantities as CasADi functions: a witness of the other derivations, and for users' optimisers."""

from __future__ import annotations

import casadi

from symgen.model.model import Model
from symgen.model.quantities import QUANTITIES, QuantityRow
from symgen.witness.lagrange import Lagrange, differentiate
from symgen.witness.points import point_quantities
from symgen.witness.quantities import derive
from symgen.witness.ranks import generic_ranks


def witness_functions(model: Model) -> dict[str, casadi.Function]:
    """One function per quantity the model has, by name.

    Inputs are the columns `q`, `qd`, `qdd`, `u` that the quantity depends on by its definition (an empty `u` is left
    out), then the parameters `p`; the output `value` is a dense matrix of the quantity's shape, vectors as columns.
    ValueError where no admissible configuration is found.
    """
    lagrange = differentiate(model)
    quantities = derive(model, lagrange, generic_ranks(model, lagrange)) | point_quantities(model, lagrange)
    return {
        quantity.name: _function(quantity, quantities[quantity.name], lagrange)
        for quantity in QUANTITIES
        if quantity.name in quantities
    }


def _function(quantity: QuantityRow, value: casadi.SX, lagrange: Lagrange) -> casadi.Function:
    symbols = {name: lagrange.further[name] if name in lagrange.further else getattr(lagrange, name)
               for name in quantity.arguments}  # fmt: skip
    names = [argument for argument in quantity.arguments if symbols[argument].shape[0]]
    inputs = [symbols[argument] for argument in names]
    return casadi.Function(quantity.name, [*inputs, lagrange.p], [value], [*names, "p"], ["value"])
