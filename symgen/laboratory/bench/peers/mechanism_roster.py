"""The peers of a mechanism given by bodies: every method from frames that are walked in the tool's own scalars."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from typing import Any, TypeAlias

from symgen.laboratory.bench.candidate import CCandidate, CUnit
from symgen.laboratory.bench.peers.engine_candidate import engine_candidate
from symgen.laboratory.bench.peers.engines.casadi_engine import CasadiEngine, array_adaptor, generated
from symgen.laboratory.bench.peers.engines.casadi_ssa import CasadiSsaEngine
from symgen.laboratory.bench.peers.engines.engine import Engine, Symbol
from symgen.laboratory.bench.peers.engines.ssa_engine import SsaEngine
from symgen.laboratory.bench.peers.formulas import native
from symgen.laboratory.bench.peers.formulas.algebra import DeadPivotError, ldl_solve
from symgen.laboratory.bench.peers.formulas.expert import free_multipliers, independent_coordinates
from symgen.laboratory.bench.peers.formulas.frames import lagrange_by_frames, mechanics_by_frames
from symgen.laboratory.bench.peers.formulas.mechanics import PeerSystem, mechanics
from symgen.laboratory.bench.peers.formulas.methods import elimination, lean, part, selected_rows
from symgen.laboratory.bench.peers.formulas.recursion import is_recursive, mechanics_by_recursion
from symgen.laboratory.bench.peers.householder import householder_units
from symgen.model.mechanism import WORLD
from symgen.model.model import Model
from symgen.witness.lagrange import Lagrange, differentiate

Build: TypeAlias = Callable[[Engine, PeerSystem], list[Symbol]]
Route: TypeAlias = Callable[[Engine, Model], PeerSystem]
# Tools that write sums out need minutes for more links in a row than this; CasADi stands for them.
DEEPEST_WRITTEN_OUT = 3
MOST_LEAN = 8
LONGEST_WRITTEN = 16
MOST_DENSE = 14  # coordinates, of peers whose C grows with the square of their number or faster
MOST_WITH_ENERGIES = 6
SERIAL = "AD"
SERIAL_IN_WORLD_AXES = "AD in world axes"
RECURSIVE = "recursion"
FROM_ENERGIES = " from energies"


def of_inputs(engine: Engine, s: PeerSystem) -> list[Symbol]:
    """u of a tree whose inputs drive coordinates."""
    return elimination(engine, s, ())


def mechanism_peers(model: Model, states: Any) -> tuple[tuple[CCandidate, ...], tuple[tuple[str, str], ...]]:
    """Candidates in float64, and (name, reason) of what was left out; `states` (k, 3 n + P)."""
    candidates = _as_written(model)
    left_out: list[tuple[str, str]] = []
    methods = methods_by_frames(model, states, left_out)
    engines: list[type[Engine]] = [CasadiEngine, CasadiSsaEngine]
    if _depth(model) > DEEPEST_WRITTEN_OUT:
        left_out.append(("SymPy, wrenfold", "written out, the sums of so many links in a row take minutes"))
    else:
        engines += _others(left_out)
    for engine_type in engines:
        routes: dict[str, Route] = {"": mechanics_by_frames}
        if len(engines) > 2 and model.n <= MOST_WITH_ENERGIES:
            routes[FROM_ENERGIES] = mechanics
        for route, derive in routes.items():
            for name, build in methods.items():
                try:
                    candidates.append(_candidate(engine_type(), model, f"{name}{route}", derive, build))
                except DeadPivotError:
                    left_out.append((f"{engine_type.tool} {name}{route}", "its fixed choice is singular everywhere"))
    if is_recursive(model) and selects(model):
        for engine in (CasadiEngine(), SsaEngine()):
            candidates.append(_candidate(engine, model, RECURSIVE, mechanics_by_recursion, of_inputs))
    if model.n <= MOST_DENSE:
        units, functions = householder_units(model, lagrange_by_frames(model), "c_householder_float64")
        candidates.append(CCandidate("C", "Householder QR", "float64", "c_householder_float64", units, functions))
    return tuple(candidates), tuple(left_out)


def _depth(model: Model) -> int:
    depths = {WORLD: 0}
    for frame in model.mechanism.frames:
        depths[frame.name] = depths[frame.parent] + 1
    return max(depths.values())


def _others(left_out: list[tuple[str, str]]) -> list[type[Engine]]:
    from symgen.laboratory.bench.peers.engines.sympy_engine import SympyEngine

    engines: list[type[Engine]] = [SympyEngine]
    if find_spec("wrenfold") is None:
        left_out.append(("wrenfold", "not installed"))
    else:
        from symgen.laboratory.bench.peers.engines.wrenfold_engine import WrenfoldEngine

        engines.append(WrenfoldEngine)
    return engines


def methods_by_frames(model: Model, states: Any, left_out: list[tuple[str, str]]) -> dict[str, Build]:
    """lean up to a size, part, and elimination where M selects coordinates; a serial arm has one method."""
    if not model.r:
        return {SERIAL: of_inputs} if selects(model) else {"lean": lean}
    methods: dict[str, Build] = {}
    if model.n <= MOST_LEAN or model.r > model.n // 2:
        methods["lean"] = lean
        methods["lean LDLᵀ"] = lambda engine, s: lean(engine, s, ldl_solve)
    s = lagrange_by_frames(model)
    short = model.n <= MOST_DENSE
    independent = independent_coordinates(model, s, states, mechanics_by_frames) if short else None
    free = free_multipliers(model, s, states, mechanics_by_frames)
    if independent is not None:
        methods["part"] = lambda engine, s: part(engine, s, independent, ldl_solve, direct=True)
    if free is not None:
        methods["elimination"] = lambda engine, s: elimination(engine, s, free)
    else:
        left_out.append(("method elimination", "the control matrix does not select coordinates"))
    return methods


def selects(model: Model) -> bool:
    """Whether every input drives one coordinate alone."""
    engine = CasadiEngine()
    return selected_rows(engine, mechanics_by_frames(engine, model).M) is not None


def _as_written(model: Model) -> list[CCandidate]:
    """(27) with (28): through the matrices G and C where they are short, and with tau along directions."""
    if model.n > LONGEST_WRITTEN:
        return []
    return [_matrix_candidate(model, s, method, balance) for method, s, balance in writings(model)]


def writings(model: Model) -> list[tuple[str, Lagrange, Callable[[Lagrange], Any]]]:
    """The names of what a user of CasADi writes, what it starts from, and how it makes tau."""
    routes: dict[str, Lagrange] = {"": lagrange_by_frames(model)}
    if model.n <= MOST_LEAN and model.r:
        routes[FROM_ENERGIES] = differentiate(model)
    written: list[tuple[str, Lagrange, Callable[[Lagrange], Any]]] = []
    for route, s in routes.items():
        if model.r:
            written.append((f"literal{route}", s, native.direct_balance))
        if model.n <= MOST_DENSE:
            written.append((f"native{route}", s, native.user_matrices))
    if not model.r:
        written.append((SERIAL_IN_WORLD_AXES, lagrange_by_frames(model, world_axes=True), native.direct_balance))
    return written


def _matrix_candidate(model: Model, s: Lagrange, method: str, balance: Callable[[Lagrange], Any]) -> CCandidate:
    entry = f"casadi_{method}_float64".lower().replace(" ", "_")
    name = f"function_of_{entry}"
    value = native.inverse_dynamics(model, s, balance)
    source, functions = generated(name, [s.q, s.qd, s.qdd, s.p], value)
    units = (CUnit(source), CUnit(array_adaptor(entry, name), is_adaptor=True))
    return CCandidate("CasADi", method, "float64", entry, units, functions)


def _candidate(engine: Engine, model: Model, method: str, derive: Route, build: Build) -> CCandidate:
    entry = f"{engine.tool}_{method}_float64".lower().replace(" ldlᵀ", "_ldl").replace(" ", "_")
    system = derive(engine, model)
    return engine_candidate(engine, method, entry, system.inputs, build(engine, system))
