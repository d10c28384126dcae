"""All peers of a task that can do it on this machine, as C candidates, and those left out with the reason."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib.util import find_spec
from typing import Any, TypeAlias

from symgen.laboratory.bench.candidate import CCandidate, CUnit, PythonCandidate, Task, adaptor, straight_candidate
from symgen.laboratory.bench.peers.engine_candidate import engine_candidate
from symgen.laboratory.bench.peers.engines.engine import Engine, Symbol
from symgen.laboratory.bench.peers.formulas.mechanics import PeerSystem
from symgen.laboratory.bench.peers.formulas.recursion import is_recursive
from symgen.model.model import Model
from symgen.model.quantities import MAIN, ROWS
from symgen.witness.lagrange import Lagrange, differentiate

Build: TypeAlias = Callable[[Engine, PeerSystem], list[Symbol]]
# Tools that the extra `bench` installs, by module.
OPTIONAL = {"wrenfold": "wrenfold", "SymForce": "symforce", "JAX": "jax"}
# Lines of a matrix that compilers take in a minute.
LONGEST_LINES = 30_000
# Why a method that inverts G is no peer of a model with coordinates that move no mass.
LACKS_A_MASS = "it divides by a mass that is 0 at every state"
# Cheaper than Cholesky factors with roots, by about the same for every tool; the one that is cheapest takes them.
SYMPY_ONLY = ("lean LDLᵀ", "part LDLᵀ")


@dataclass(frozen=True, slots=True)
class Peers:
    """The candidates in float64, and (name, reason) of what was left out."""

    candidates: tuple[CCandidate, ...]
    left_out: tuple[tuple[str, str], ...]


def peers(model: Model, task: Task, states: Any) -> Peers:
    """Peers for full-rank B; `states` (k, 2 n + third + P) are what an expert would look at to choose coordinates."""
    s = differentiate(model)
    if task.quantity not in MAIN:
        return _of_matrix(model, s, states, task)
    if task.quantity != "inverse_dynamics":
        candidates, left_out = _motions(model, s, states, task)
        if task.quantity == "forward_dynamics" and is_recursive(model):
            candidates += _articulated(model)
        return Peers(tuple(candidates), tuple(left_out))
    methods, left_out = expert_methods(model, s, states)
    # What inlining CasADi's exported helpers is worth, which a shared library does not allow.
    inlined = replace(_native(model, s, task, "native_fpie"), form="native -fPIE", flags=("-fPIE",))
    candidates = [_native(model, s, task), inlined, _native_in_lines(model, s, task)]
    for engine_type in _engines():
        for method, build in methods.items():
            if method not in SYMPY_ONLY or engine_type.tool == "SymPy":
                candidates.append(_candidate(engine_type(), model, method, build))
    candidates.append(_householder(model, s))
    absent = [(tool, "not installed") for tool, module in OPTIONAL.items() if find_spec(module) is None]
    return Peers(tuple(candidates), (*left_out, *absent))


def _of_matrix(model: Model, s: Lagrange, states: Any, task: Task) -> Peers:
    from symgen.laboratory.bench.peers.engines.casadi_ssa import CasadiSsaEngine
    from symgen.laboratory.bench.peers.formulas.algebra import DeadPivotError
    from symgen.laboratory.bench.peers.formulas.expert import independent_of_motion
    from symgen.laboratory.bench.peers.formulas.matrices import BY_BASIS, BY_ROWS, matrix_of

    if not model.r and task.quantity in BY_ROWS:
        return Peers((), (("peers", "there are no constraints"),))
    independent = independent_of_motion(model, s, states) if task.quantity in BY_BASIS else ()
    made = None if independent is None else matrix_of(task.quantity, independent)
    if made is None:
        return Peers((), (("peers", f"none is written for {task.quantity}"),))
    engine = CasadiSsaEngine()
    try:
        lines = engine.straight(*made(engine, model))
    except DeadPivotError:
        return Peers((), (("peers", "their formula is singular everywhere: inputs span less than the motions"),))
    if len(lines.values) > LONGEST_LINES:
        return Peers((), (("peers", f"{len(lines.values)} operations, which take minutes to compile"),))
    entry, form = f"casadi_ssa_{task.quantity}_float64", task.quantity.replace("_", " ")
    # with the arguments that the matrix has, as symgen's kernel
    given = [array for array in lines.arrays if array in ROWS[task.quantity].arguments]
    own = replace(lines, arrays=(*given, "p")).function(f"{entry}_function")
    units = CUnit(own), adaptor(entry, f"{entry}_function", given)
    return Peers((CCandidate(engine.tool, form, "float64", entry, units, (f"{entry}_function",)),), ())


def _motions(
    model: Model, s: Lagrange, states: Any, task: Task
) -> tuple[list[CCandidate], list[tuple[str, str]]]:
    """q_ddot or lambda by an expert's methods, without those that divide by a mass that is not there."""
    from symgen.laboratory.bench.peers.engines.casadi_ssa import CasadiSsaEngine
    from symgen.laboratory.bench.peers.formulas.algebra import DeadPivotError
    from symgen.laboratory.bench.peers.formulas.expert import independent_of_motion
    from symgen.laboratory.bench.peers.formulas.motions import MotionSystem, along_null_space, motion_system, schur

    def in_lines(
        name: str, method: Callable[[Engine, MotionSystem], tuple[list[Symbol], list[Symbol]]]
    ) -> list[CCandidate]:
        engine = CasadiSsaEngine()
        system = motion_system(engine, model)
        outputs = method(engine, system)[task.quantity == "multipliers"]
        entry = f"casadi_ssa_{name}_float64".lower().replace(" ", "_")
        return [straight_candidate(engine.tool, name, entry, engine.straight(system.inputs, outputs))]

    ways: dict[str, Callable[[], list[CCandidate]]] = {
        "native": lambda: [_native(model, s, task), _native_in_lines(model, s, task)],
        "Schur": lambda: in_lines("Schur", schur),
    }
    independent = independent_of_motion(model, s, states)
    if independent is not None:
        ways["null space"] = lambda: in_lines(
            "null space", lambda engine, system: along_null_space(engine, system, independent)
        )
    candidates, left_out = list[CCandidate](), list[tuple[str, str]]()
    for name, way in ways.items():
        try:
            candidates += way()
        except DeadPivotError:
            left_out.append((f"CasADi {name}", LACKS_A_MASS))
    return candidates, left_out


def _articulated(model: Model) -> list[CCandidate]:
    from symgen.laboratory.bench.peers.engines.casadi_ssa import CasadiSsaEngine
    from symgen.laboratory.bench.peers.engines.ssa_engine import SsaEngine
    from symgen.laboratory.bench.peers.formulas.articulated import forward_dynamics

    candidates = []
    for engine in (CasadiSsaEngine(), SsaEngine()):
        lines = engine.straight(*forward_dynamics(engine, model))
        entry = f"{engine.tool.lower()}_articulated_float64".replace(" ", "_")
        candidates.append(straight_candidate(engine.tool, "articulated bodies", entry, lines))
    return candidates


def python_peers(model: Model, task: Task) -> list[PythonCandidate]:
    """Peers that are functions of arrays, for u and full-rank B."""
    if task.quantity != "inverse_dynamics":
        return []
    from symgen.laboratory.bench.peers.numpy_pinv import numpy_pinv

    candidates = [numpy_pinv(model)]
    if find_spec("jax") is not None:
        from symgen.laboratory.bench.peers.jax_batch import jax_batch

        candidates.append(jax_batch(model))
    return candidates


def in_single(candidate: CCandidate) -> CCandidate:
    """The same C for float32: sources differ in `REAL` and in the type that their names end in."""

    def single(text: str) -> str:
        return text.replace("_float64", "_float32")

    units = tuple(
        replace(unit, source=single(unit.source), renamed={single(a): single(b) for a, b in unit.renamed.items()})
        for unit in candidate.units
    )
    functions = tuple(map(single, candidate.functions))
    return replace(candidate, scalar="float32", entry=single(candidate.entry), units=units, functions=functions)


def expert_methods(model: Model, s: Lagrange, states: Any) -> tuple[dict[str, Build], list[tuple[str, str]]]:
    """The cheap methods of u by name, and (name, reason) of those that do not apply."""
    from symgen.laboratory.bench.peers.formulas.algebra import ldl_solve
    from symgen.laboratory.bench.peers.formulas.expert import free_multipliers, independent_coordinates
    from symgen.laboratory.bench.peers.formulas.methods import elimination, lean, part

    methods: dict[str, Build] = {"lean": lean, "lean LDLᵀ": lambda engine, system: lean(engine, system, ldl_solve)}
    left_out = []
    independent = independent_coordinates(model, s, states)
    if independent is None:
        left_out.append(("method part", "fewer inputs than degrees of freedom, or too many choices of coordinates"))
    else:
        methods["part"] = lambda engine, system: part(engine, system, independent)
        methods["part LDLᵀ"] = lambda engine, system: part(engine, system, independent, ldl_solve, direct=True)
    free = free_multipliers(model, s, states)
    if free is None:
        left_out.append(("method elimination", "the control matrix does not select coordinates"))
    else:
        methods["elimination"] = lambda engine, system: elimination(engine, system, free)
    return methods, left_out


def _engines() -> list[type[Engine]]:
    from symgen.laboratory.bench.peers.engines.casadi_engine import CasadiEngine
    from symgen.laboratory.bench.peers.engines.casadi_ssa import CasadiSsaEngine
    from symgen.laboratory.bench.peers.engines.sympy_engine import SympyEngine

    engines: list[type[Engine]] = [CasadiEngine, CasadiSsaEngine, SympyEngine]
    if find_spec("wrenfold") is not None:
        from symgen.laboratory.bench.peers.engines.wrenfold_engine import WrenfoldEngine

        engines.append(WrenfoldEngine)
    if find_spec("symforce") is not None:
        from symgen.laboratory.bench.peers.engines.symforce_engine import SymforceEngine

        engines.append(SymforceEngine)
    return engines


def _candidate(engine: Engine, model: Model, method: str, build: Build) -> CCandidate:
    from symgen.laboratory.bench.peers.formulas.mechanics import mechanics

    entry = f"{engine.tool.lower()}_{method}_float64".replace(" LDLᵀ", "_ldl").replace(" ", "_")
    system = mechanics(engine, model)
    return engine_candidate(engine, method, entry, system.inputs, build(engine, system))


def _native_value(model: Model, s: Lagrange, task: Task) -> Any:
    from symgen.laboratory.bench.peers.formulas import native

    if task.quantity == "inverse_dynamics":
        return native.inverse_dynamics(model, s)
    return native.forward_dynamics(model, s)[task.quantity == "multipliers"]


def _native_in_lines(model: Model, s: Lagrange, task: Task) -> CCandidate:
    from symgen.laboratory.bench.peers.engines.casadi_ssa import CasadiSsaEngine, straight_lines

    third = s.qdd if task.third == "qdd" else s.u
    arrays = {"q": s.q, "qd": s.qd, task.third: third, "p": s.p}
    lines = straight_lines(arrays, _native_value(model, s, task))
    return straight_candidate(CasadiSsaEngine.tool, "native", "casadi_ssa_native_float64", lines)


def _native(model: Model, s: Lagrange, task: Task, name: str = "native") -> CCandidate:
    from symgen.laboratory.bench.peers.engines.casadi_engine import array_adaptor, generated

    entry = f"casadi_{name}_float64"
    name = f"casadi_{name}_function_float64"
    third = s.qdd if task.third == "qdd" else s.u
    source, functions = generated(name, [s.q, s.qd, third, s.p], _native_value(model, s, task))
    units = (CUnit(source), CUnit(array_adaptor(entry, name), is_adaptor=True))
    return CCandidate("CasADi", "native", "float64", entry, units, functions)


def _householder(model: Model, s: Lagrange) -> CCandidate:
    from symgen.laboratory.bench.peers.householder import householder_units

    entry = "c_householder_float64"
    units, functions = householder_units(model, s, entry)
    return CCandidate("C", "Householder QR", "float64", entry, units, functions)
