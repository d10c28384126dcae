"""The peers of the derivatives of u: CasADi's `jacobian` of u in every form the other pages have, and Pinocchio's."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, TypeAlias

import casadi

from symgen.laboratory.bench.candidate import CCandidate, CUnit, straight_candidate
from symgen.laboratory.bench.peers.engines.casadi_engine import CasadiEngine, array_adaptor, generated
from symgen.laboratory.bench.peers.engines.casadi_ssa import CasadiSsaEngine, straight_lines
from symgen.laboratory.bench.peers.formulas import native
from symgen.laboratory.bench.peers.formulas.algebra import DeadPivotError
from symgen.laboratory.bench.peers.formulas.frames import mechanics_by_frames
from symgen.laboratory.bench.peers.formulas.mechanics import PeerSystem, mechanics
from symgen.laboratory.bench.peers.formulas.recursion import is_recursive, mechanics_by_recursion
from symgen.laboratory.bench.peers.mechanism_roster import (
    FROM_ENERGIES,
    LONGEST_WRITTEN,
    MOST_WITH_ENERGIES,
    RECURSIVE,
    Build,
    Route,
    methods_by_frames,
    of_inputs,
    selects,
    writings,
)
from symgen.laboratory.bench.peers.pinocchio_program import pinocchio_jacobian
from symgen.laboratory.bench.peers.roster import LONGEST_LINES, expert_methods
from symgen.model.model import Model
from symgen.witness.lagrange import differentiate

Arrays: TypeAlias = Mapping[str, Any]
LeftOut: TypeAlias = list[tuple[str, str]]
PINOCCHIO = "Pinocchio"
# Where no form is short enough, the shortest one is compiled nevertheless, up to this: a peer is worth minutes.
LONGEST_ALONE = 100_000
_ARRAYS = ("q", "qd", "qdd", "p")


def jacobian_peers(model: Model, states: Any) -> tuple[tuple[CCandidate, ...], tuple[tuple[str, str], ...]]:
    """Candidates for J_u (m x 3 n, row by row) in float64, and (name, reason) of what was left out.

    `states` (k, 3 n + P) are what an expert would look at to choose coordinates.
    """
    left_out: LeftOut = []
    candidates: list[CCandidate] = []
    derived: dict[str, tuple[int, Arrays, Any]] = {}
    too_long = f"more than {LONGEST_LINES} operations, which take minutes to compile"
    for form, arrays, u in _forms(model, states, left_out):
        if _length(arrays, u) > LONGEST_LINES:
            left_out.append((f"CasADi {form}", too_long))
        else:
            slopes = casadi.jacobian(u, casadi.vertcat(*(arrays[name] for name in _ARRAYS[:3])))
            derived[form] = _length(arrays, slopes), arrays, slopes
    shortest = min((length for length, _, _ in derived.values()), default=0)
    most = max(LONGEST_LINES, min(shortest, LONGEST_ALONE))
    for form, (length, arrays, slopes) in derived.items():
        if length <= most:
            candidates += _candidates(CasadiEngine.tool, form, arrays, slopes)
        else:
            left_out.append((f"CasADi {form}", too_long))
    derivatives = pinocchio_jacobian(model)
    if isinstance(derivatives, str):
        left_out.append((PINOCCHIO, derivatives))
    else:
        arrays = {name: casadi.SX.sym(name, model.n) for name in _ARRAYS[:3]}
        arrays["p"] = casadi.SX.sym("p", len(model.parameters))
        slopes = derivatives(*(arrays[name] for name in _ARRAYS[:3]))
        candidates += _candidates(PINOCCHIO, "computeRNEADerivatives", arrays, slopes)
    return tuple(candidates), tuple(left_out)


def _forms(model: Model, states: Any, left_out: LeftOut) -> Iterator[tuple[str, Arrays, Any]]:
    """u by name: as a user of CasADi writes it, and by every method that is cheaper."""
    if not model.mechanism.bodies:
        s = differentiate(model)
        yield "native", {"q": s.q, "qd": s.qd, "qdd": s.qdd, "p": s.p}, native.inverse_dynamics(model, s)
        methods, others = expert_methods(model, s, states)
        left_out += others
        yield from _by_methods(model, methods, {"": mechanics}, left_out)
        return
    if model.n <= LONGEST_WRITTEN:
        for name, s, balance in writings(model):
            arrays = {"q": s.q, "qd": s.qd, "qdd": s.qdd, "p": s.p}
            yield name, arrays, native.inverse_dynamics(model, s, balance)
    routes: dict[str, Route] = {"": mechanics_by_frames}
    if model.n <= MOST_WITH_ENERGIES:
        routes[FROM_ENERGIES] = mechanics
    yield from _by_methods(model, methods_by_frames(model, states, left_out), routes, left_out)
    if is_recursive(model) and selects(model):
        yield from _by_methods(model, {RECURSIVE: of_inputs}, {"": mechanics_by_recursion}, left_out)


def _by_methods(
    model: Model, methods: Mapping[str, Build], routes: Mapping[str, Route], left_out: LeftOut
) -> Iterator[tuple[str, Arrays, Any]]:
    for route, derive in routes.items():
        for name, build in methods.items():
            engine = CasadiEngine()
            system: PeerSystem = derive(engine, model)
            try:
                u = build(engine, system)
            except DeadPivotError:
                left_out.append((f"CasADi {name}{route}", "its fixed choice is singular everywhere"))
                continue
            arrays = {array: casadi.vertcat(*system.inputs[array]) for array in _ARRAYS}
            yield f"{name}{route}", arrays, casadi.vertcat(*u)


def _length(arrays: Arrays, value: Any) -> int:
    return int(casadi.Function("f", [arrays[name] for name in _ARRAYS], [casadi.cse(value)]).n_instructions())


def _candidates(tool: str, form: str, arrays: Arrays, slopes: Any) -> list[CCandidate]:
    """As CasADi's code generator prints it, and its operations as straight lines; a matrix goes row by row."""
    value = casadi.vec(casadi.densify(slopes).T)
    lines = straight_lines({name: arrays[name] for name in _ARRAYS}, value)
    operations = {"operations": len(lines.values)}
    stem = f"{tool}_{form}".lower().replace(" ldlᵀ", "_ldl").replace(" ", "_")
    name = f"function_of_{stem}_float64"
    source, functions = generated(name, [arrays[array] for array in _ARRAYS], value)
    entry = f"{stem}_float64"
    units = (CUnit(source), CUnit(array_adaptor(entry, name), is_adaptor=True))
    written = straight_candidate(f"{tool}{_SSA}", form, f"{stem}_ssa_float64", lines)
    return [
        CCandidate(tool, form, "float64", entry, units, functions, operations),
        replace(written, operations=operations),
    ]


_SSA = CasadiSsaEngine.tool.removeprefix(CasadiEngine.tool)
