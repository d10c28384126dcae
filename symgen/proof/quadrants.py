"""Angles over whose range the sine's reduction takes several multiples of pi/2, and which no driver cuts.

There one interval enters the polynomials for all quadrants. Eva's bounds of sine and cosine are then in the hundreds;
in long products, such as those of a chain of frames, they exceed every float.
"""

from __future__ import annotations

import math

from symgen.ir.kernel import Kernel, Local, Operand, Program, Scalar
from symgen.model.model import Model
from symgen.proof.box import box
from symgen.proof.eva import cut_coordinates
from symgen.proof.intervals import Interval, computed_pair, enclose, exact_pair
from symgen.proof.reach import reach

LARGEST: dict[Scalar, float] = {"float32": (2 - 2.0**-23) * 2.0**127, "float64": (2 - 2.0**-52) * 2.0**1023}


def overflowing_angles(model: Model, program: Program, kernel: Kernel) -> tuple[str, ...]:
    """The names of such angles, in a kernel whose values exceed the scalar type's for intervals because of them.

    None where sine and cosine are the library's, whose bounds Eva knows.
    """
    function, exact = program.sincos, reach(model, kernel)
    if function is None:
        return ()
    known = _of_cut_coordinates(kernel, cut_coordinates(model, program, kernel))
    loose: dict[str, None] = {}

    def is_tight(angle: Operand, bounds: Interval) -> bool:
        return not isinstance(angle, Local) or angle.name in known or _quadrants(bounds) == 1

    def pair(angle: Operand, bounds: Interval) -> tuple[Interval, ...]:
        if not isinstance(angle, Local) or is_tight(angle, bounds):
            return exact_pair(angle, bounds)
        loose[angle.name] = None
        return computed_pair(function, bounds)

    # without a loose angle nothing is wider than it is with exact pairs
    if exact.largest > (limit := LARGEST[program.scalar]) or all(is_tight(*angle) for angle in exact.angles):
        return ()
    return tuple(loose) if enclose(kernel, box(model), pair).largest > limit else ()


def _of_cut_coordinates(kernel: Kernel, cut: frozenset[int]) -> set[str]:
    """The values that depend on parameters and on coordinates that are cut alone."""
    known = {load.local for load in kernel.loads if load.argument == "p"}
    known |= {load.local for load in kernel.loads if load.argument == "q" and load.index in cut}
    for statement in kernel.statements:
        if all(operand.name in known for operand in statement.operands if isinstance(operand, Local)):
            known.update(statement.targets)
    return known


def _quadrants(angle: Interval) -> int:
    low, high = angle
    return round(high * 2 / math.pi) - round(low * 2 / math.pi) + 1 if math.isfinite(high - low) else 5
