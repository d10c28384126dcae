"""Bodies in the lanes of vectors: the same statements on other operands, the same bits as one after the other."""

from __future__ import annotations

import ctypes
import random
import subprocess
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
import shipped

from symgen.backends.c.plain import emit_c
from symgen.ir.kernel import Local, Operand, Program, Scalar
from symgen.lowering.schedule import schedule
from symgen.mechanics.alike import Alike, alike_bodies
from symgen.mechanics.system import System
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator

QUANTITY = ("inverse_dynamics",)
ENTRIES = ("xx", "yy", "zz", "xy", "xz", "yz")


def chain(count: int, gravity: str = "g") -> Model:
    """A chain of bodies about axes in turn; `gravity` is the name of that parameter."""
    lines = ["model: chain", "joints:"]
    for k in range(count):
        parent = f"parent: f_{k - 1}, at: [0, 0, d], " if k else ""
        lines.append(f"  f_{k}: {{type: revolute, {parent}axis: {'zxy'[k % 3]}, coordinate: q_{k}}}")
    lines += ["parameters:", f"  {gravity}: {{value: 9.81, unit: m/s**2}}", "  d: {value: 0.3, unit: m}"]
    for k in range(count):
        lines += [f"  m_{k}: {{value: 2, unit: kg}}", *(f"  {x}_{k}: {{value: 0.1, unit: m}}" for x in "xyz")]
        lines += [f"  {e}_{k}: {{value: {1 if e[0] == e[1] else 0.1}, unit: kg*m**2}}" for e in ENTRIES]
    lines += [f"gravity: [0, 0, -{gravity}]", "bodies:"]
    for k in range(count):
        entries = ", ".join(f"{e}: {e}_{k}" for e in ENTRIES)
        lines.append(f"  f_{k}: {{mass: m_{k}, com: [x_{k}, y_{k}, z_{k}], inertia: {{{entries}}}}}")
    lines += ["inputs:", *(f"  u_{k}: {{unit: N*m, joint: q_{k}}}" for k in reversed(range(count)))]
    return load_text("\n".join([*lines, "outputs: [inverse_dynamics]", ""]), "chain.yaml")


@cache
def programs(name: str) -> dict[Scalar, Program]:
    model = shipped.model(name)
    derived = derive_quantities(model, QUANTITY)
    return schedule(derived.mechanics, derived.quantities, ("float64", "float32"))


def values_of(alike: Alike, state: dict[str, float]) -> list[float]:
    """u by the function, evaluated for every body."""
    state = dict(state)
    for arguments, results in zip(alike.arguments, alike.results, strict=True):
        given = dict(zip(alike.names, Evaluator(arguments)(state), strict=True))
        names = [str(symbol.payload) for symbol in results]
        state |= zip(names, Evaluator(alike.function)(given), strict=True)
    return Evaluator(alike.inputs)(state)


def place(operand: Operand, places: dict[str, int]) -> int | None:
    return places.get(operand.name) if isinstance(operand, Local) else None


@pytest.mark.parametrize("count", [5, 6])
def test_u_by_a_function_of_bodies_is_u(count: int) -> None:
    model = chain(count)
    derived = derive_quantities(model, QUANTITY)
    (u,) = derived.quantities
    alike = alike_bodies(model, u.outputs)
    assert alike is not None
    assert alike.arguments
    mechanics, source = System(model), random.Random(count)
    symbols = (*mechanics.q, *mechanics.qd, *mechanics.qdd, *mechanics.parameters)
    state = {str(symbol.payload): source.uniform(0.2, 1.5) for symbol in symbols}
    assert values_of(alike, state) == pytest.approx(Evaluator(u.outputs)(state), rel=1e-12, abs=1e-12)


def test_blocks_side_by_side_are_the_same() -> None:
    kernel = programs("arm7")["float64"].kernels[0]
    assert kernel.alike
    for numbers in kernel.alike:
        first, second = (kernel.blocks[k].statements for k in numbers)
        assert [s.operation for s in first] == [s.operation for s in second]
        places = {s.targets[0]: k for k, s in enumerate(first)}, {s.targets[0]: k for k, s in enumerate(second)}
        for one, other in zip(first, second, strict=True):
            for a, b in zip(one.operands, other.operands, strict=True):
                assert place(a, places[0]) == place(b, places[1])
                assert place(b, places[0]) is None


@pytest.mark.parametrize("name", ["delta", "chain8", "scara", "skate", "front_car_bodies"])
def test_others_stay(name: str) -> None:
    assert all(not kernel.alike for kernel in programs(name)["float64"].kernels)


def test_a_form_asked_for_by_name_stays() -> None:
    derived = derive_quantities(shipped.model("arm7"), QUANTITY, {"inverse_dynamics": "elimination"})
    assert derived.quantities[0].alike is None


def test_only_vectors_of_two_have_loops() -> None:
    model = shipped.model("arm7")
    texts = {scalar: "\n".join(emit_c(model, program).values()) for scalar, program in programs("arm7").items()}
    assert texts["float64"].count("++lane") == len(programs("arm7")["float64"].kernels[0].alike) > 0
    assert "lane" not in texts["float32"]
    both = (len(program.kernels[0].statements) for program in programs("arm7").values())
    assert next(both) > next(both)  # float64 first; float32 leaves out what vanishes and what bodies share


@pytest.mark.parametrize("name", ["lane", "given_1", "found_1"])
def test_names_of_the_user_give_way(name: str) -> None:
    model = chain(4, name)
    derived = derive_quantities(model, QUANTITY)
    program = schedule(derived.mechanics, derived.quantities, ("float64",))["float64"]
    text = emit_c(model, program)["c/chain.c"]
    assert f"const double {name} = " not in text
    assert f"const double {name}_ = " in text


@pytest.mark.toolchain
def test_lanes_have_the_bits_of_one_body_after_the_other(tool: Callable[[str], str], tmp_path: Path) -> None:
    program, model = programs("arm7")["float64"], shipped.model("arm7")
    apart = replace(program, kernels=tuple(replace(kernel, alike=()) for kernel in program.kernels))
    found = []
    for name, one in (("lanes", program), ("apart", apart)):
        for path, text in emit_c(model, one).items():
            target = tmp_path / name / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text)
        source, library = tmp_path / name / "c" / "arm7.c", tmp_path / f"{name}.so"
        flags = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Wshadow", "-Wconversion", "-Werror", "-ffp-contract=off"]
        subprocess.run([tool("gcc"), *flags, "-shared", "-fPIC", str(source), "-o", str(library), "-lm"], check=True)
        loaded, numbers, results = ctypes.CDLL(str(library)), ctypes.c_double * 7, []
        parameters = type("Parameters", (ctypes.Structure,), {"_fields_": [("all", ctypes.c_double * 75)]})
        loaded.arm7_default_params.restype = parameters
        p, draw = loaded.arm7_default_params(), random.Random(2)
        for _ in range(20):
            state = [numbers(*(draw.uniform(-2, 2) for _ in range(7))) for _ in range(3)]
            u = numbers()
            assert loaded.arm7_inverse_dynamics(*state, ctypes.byref(p), u) == 0
            results.append(bytes(u))
        found.append(results)
    assert found[0] == found[1]
