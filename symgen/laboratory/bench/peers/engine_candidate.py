"""A kernel that a symbolic tool writes, as a candidate: its straight lines, or its C under the signature of all."""

from __future__ import annotations

from collections.abc import Sequence

from symgen.laboratory.bench.candidate import CCandidate, CUnit, straight_candidate
from symgen.laboratory.bench.peers.engines.engine import Engine, Inputs, Symbol


def engine_candidate(engine: Engine, method: str, entry: str, inputs: Inputs, outputs: Sequence[Symbol]) -> CCandidate:
    """The outputs by a method in float64; `entry` names the function that is called."""
    if (lines := engine.straight(inputs, outputs)) is not None:
        return straight_candidate(engine.tool, method, entry, lines)
    name = f"function_of_{entry}"
    source, functions, needs_adaptor = engine.c_function(name, inputs, outputs)
    if needs_adaptor:
        from symgen.laboratory.bench.peers.engines.casadi_engine import array_adaptor

        units: tuple[CUnit, ...] = (CUnit(source), CUnit(array_adaptor(entry, name), is_adaptor=True))
    else:
        units = (CUnit(source, renamed={name: entry}),)
    return CCandidate(engine.tool, method, "float64", entry, units, functions)
