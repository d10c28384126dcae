"""CasADi's operations as straight lines of C: the same algorithm without work arrays, null pointers and helpers.

What its code generator prints keeps values in an array of work and calls small functions of its own; a user who counts
instructions writes the operations out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Any, ClassVar

import casadi

from symgen.laboratory.bench.peers.engines.casadi_engine import CasadiEngine
from symgen.laboratory.bench.peers.engines.engine import Inputs, Symbol
from symgen.laboratory.bench.peers.engines.straight import StraightLines, loaded, third_of
from symgen.laboratory.bench.peers.formulas.algebra import DeadPivotError

_WRITTEN: Mapping[int, str] = {
    casadi.OP_ASSIGN: "{0}",
    casadi.OP_ADD: "{0} + {1}",
    casadi.OP_SUB: "{0} - {1}",
    casadi.OP_MUL: "{0} * {1}",
    casadi.OP_DIV: "{0} / {1}",
    casadi.OP_NEG: "-{0}",
    casadi.OP_SQ: "{0} * {0}",
    casadi.OP_TWICE: "{0} + {0}",
    casadi.OP_INV: "(REAL)1.0 / {0}",
    casadi.OP_FABS: "fabs({0})",
    casadi.OP_FMIN: "fmin({0}, {1})",
    casadi.OP_FMAX: "fmax({0}, {1})",
    casadi.OP_COPYSIGN: "copysign({0}, {1})",
    casadi.OP_SIGN: "(REAL)(({0} > 0) - ({0} < 0))",
    casadi.OP_POW: "pow({0}, {1})",
    casadi.OP_CONSTPOW: "pow({0}, {1})",
    casadi.OP_ATAN2: "atan2({0}, {1})",
    casadi.OP_LT: "(REAL)({0} < {1})",
    casadi.OP_LE: "(REAL)({0} <= {1})",
    casadi.OP_EQ: "(REAL)({0} == {1})",
    casadi.OP_NE: "(REAL)({0} != {1})",
    casadi.OP_NOT: "(REAL)!({0} != 0)",
    casadi.OP_AND: "(REAL)({0} != 0 && {1} != 0)",
    casadi.OP_OR: "(REAL)({0} != 0 || {1} != 0)",
    casadi.OP_IF_ELSE_ZERO: "{0} != 0 ? {1} : (REAL)0.0",
    **{
        getattr(casadi, f"OP_{name.upper()}"): f"{name}({{0}})"
        for name in ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "exp", "log", "sinh", "cosh", "tanh")
    },
}


class CasadiSsaEngine(CasadiEngine):
    """CasADi derives and shares, C is written out."""

    tool: ClassVar[str] = "CasADi SSA"

    def straight(self, inputs: Inputs, outputs: Sequence[Symbol]) -> StraightLines:
        """One line for each operation."""
        arrays = {array: self._arrays[array] for array in ("q", "qd", third_of(list(inputs)), "p")}
        return straight_lines(arrays, casadi.vertcat(*outputs))


def straight_lines(arrays: Mapping[str, Any], value: Any) -> StraightLines:
    """`value` (after `cse`) as a function of q, q_dot, the third array and the parameters, by their names.

    Raises DeadPivotError where it divides by what is 0 at every state, which CasADi turns into an infinite constant,
    and NotImplementedError for an operation that scalars of mechanics do not have.
    """
    function = casadi.Function("lines", list(arrays.values()), [casadi.cse(casadi.densify(value))])
    places, values = list(arrays), list[str]()
    entries: dict[tuple[str, int], None] = {}
    known: dict[int, str] = {}
    outputs: dict[int, str] = {}
    for k in range(function.n_instructions()):
        operation, given, made = (
            function.instruction_id(k), function.instruction_input(k), function.instruction_output(k),
        )  # fmt: skip
        if operation == casadi.OP_INPUT:
            entry = places[given[0]], given[1]
            entries[entry] = None
            known[made[0]] = loaded(*entry)
        elif operation == casadi.OP_CONST:
            constant = float(function.instruction_constant(k))
            if not isfinite(constant):
                raise DeadPivotError
            known[made[0]] = f"(REAL){constant!r}"
        elif operation == casadi.OP_OUTPUT:
            outputs[made[1]] = known[given[0]]
        elif operation not in _WRITTEN:
            raise NotImplementedError(f"CasADi's operation {operation}")
        else:
            written = _WRITTEN[operation].format(*(known[place] for place in given))
            known[made[0]] = f"v{len(values)}"
            values.append(written)
    made_of = [outputs.get(place, "(REAL)0.0") for place in range(function.nnz_out(0))]
    return StraightLines(tuple(places), tuple(entries), tuple(values), tuple(made_of))
