"""What float32 does to a kernel, measured beside the same operations in float64.

Estimates to the first order do not see it all: a pivot of which no digit is left shifts a result that does not depend
on it as soon as anything else is rounded.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from math import dist

import numpy as np

from symgen.ir.interpret import round_literal
from symgen.ir.kernel import Block, Kernel, Literal, Operand
from symgen.verify.lane_arithmetic import Lanes
from symgen.verify.many_states import run_many


def lost_in_float32(kernel: Kernel, given: Mapping[str, Lanes]) -> Lanes:
    """How far results are off at states, a row each of arguments and of parameters `p`; 0 where either is none."""
    states = in_single_precision(given)
    made = run_many(kernel, None, "float32", states)
    exact = run_many(with_numbers_of_float32(kernel), None, "float64", states)
    off = [dist(y, z) if y and z else 0.0 for (_, y), (_, z) in zip(made, exact, strict=True)]
    return np.nan_to_num(np.array(off), posinf=0.0)


def in_single_precision(given: Mapping[str, Lanes]) -> list[dict[str, list[float]]]:
    """Of each state what is given, in single precision."""
    single = {name: rows.astype(np.float32).tolist() for name, rows in given.items()}
    count = len(next(iter(given.values())))
    return [{name: rows[place] for name, rows in single.items()} for place in range(count)]


def with_numbers_of_float32(kernel: Kernel) -> Kernel:
    """The kernel with its literals in single precision, so that they make no difference between the types."""
    def of(operand: Operand) -> Operand:
        if isinstance(operand, Literal):
            return Literal(Fraction(round_literal(operand.value, "float32")))
        return operand

    def block_of(block: Block) -> Block:
        statements = (replace(s, operands=tuple(map(of, s.operands))) for s in block.statements)
        return Block(tuple(statements), tuple(replace(c, value=of(c.value), limit=of(c.limit)) for c in block.checks))

    return replace(kernel, blocks=tuple(map(block_of, kernel.blocks)), outputs=tuple(map(of, kernel.outputs)))
