"""Kernels that take sines and cosines: the same results, sums by addition, nothing left over, angles of any size."""

from __future__ import annotations

import math
import random

import handmade
import pytest
import shipped
from handmade import literal, op

from symgen.backends.defaults import default_values
from symgen.backends.locals import all_statements, used_locals
from symgen.ir.given_trig import given_trig
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Argument, Block, Check, Kernel, Local, Status

# Kernels of shipped models, with sines given and without.
pytestmark = pytest.mark.slow
QUANTITIES = ("inverse_dynamics", "forward_dynamics", "multipliers")


@pytest.mark.parametrize("name", shipped.sparing(shipped.SWEPT))
def test_same_results(name: str) -> None:
    program, model = shipped.programs(name)["float64"], shipped.model(name)
    parameters = [float(value) for value in default_values(model).values()]
    source = random.Random(7)
    interpreter = Interpreter(program.sincos)
    for kernel in (kernel for kernel in program.kernels if kernel.name in QUANTITIES):
        given = given_trig(kernel)
        assert given is not None
        assert not [s for s in all_statements(given.kernel) if s.operation == "sincos"]
        for _ in range(5):
            state = {a.name: [source.uniform(-1, 1) for _ in range(a.length)] for a in kernel.arguments}
            angles = [state["q"][load.index] for load in given.coordinates]
            trig = [half(angle) for angle in angles for half in (math.sin, math.cos)]
            status, wanted = interpreter.run(kernel, state, parameters)
            given_status, outputs = interpreter.run(given.kernel, {**state, "sc": trig}, parameters)
            assert given_status is status
            assert outputs == pytest.approx(wanted, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("name", shipped.sparing(shipped.SWEPT))
def test_every_name_has_one_value_and_a_use(name: str) -> None:
    for kernel in shipped.programs(name)["float64"].kernels:
        given = given_trig(kernel)
        if given is None:
            continue
        changed = given.kernel
        assigned = [load.local for load in changed.loads] + [t for s in all_statements(changed) for t in s.targets]
        assert len(set(assigned)) == len(assigned)
        assert all(load.local in used_locals(changed) for load in changed.loads)
        assert all(used_locals(changed).intersection(s.targets) for s in changed.statements)


def sums(factor: str = "2") -> Kernel:
    """Sines of x + theta, theta - x, -x, of a multiple of theta and of x + L, each argument tested."""
    block = Block(
        (
            op("a", "add", "x", "theta"),
            op("b", "sub", "theta", "x"),
            op("c", "neg", "x"),
            op("d", "mul", literal(factor), "theta"),
            op("e", "add", "x", "L"),
            *(op(f"size_{name}", "abs", name) for name in "abcde"),
            *(op(f"s_{name} c_{name}", "sincos", name) for name in "abcde"),
        ),
        tuple(Check(Status.ANGLE_RANGE, literal("100"), Local(f"size_{name}"), True) for name in "abcde"),
    )
    outputs = tuple(Local(f"{half}_{name}") for name in "abcde" for half in "sc")
    return Kernel("energy", (Argument("q", 2),), handmade.loads("x", "theta", "L"), (block,), outputs, (10,))


def test_sums_and_multiples_follow_by_addition() -> None:
    given = given_trig(sums())
    assert given is not None
    assert [load.local for load in given.coordinates] == ["x", "theta"]
    pairs = [statement.operands for statement in given.kernel.statements if statement.operation == "sincos"]
    assert pairs == [(Local("e"),)], "a parameter is not the caller's to know the sine of"
    x, theta, length = 0.7, -0.4, 0.3
    trig = [math.sin(x), math.cos(x), math.sin(theta), math.cos(theta)]
    status, outputs = Interpreter(None).run(given.kernel, {"q": [x, theta], "sc": trig}, [length])
    assert status is Status.OK
    angles = (x + theta, theta - x, -x, 2 * theta, x + length)
    assert outputs == pytest.approx([half(angle) for angle in angles for half in (math.sin, math.cos)], rel=1e-14)


@pytest.mark.parametrize("factor", ["1/2", "5"])
def test_fractions_and_large_multiples_stay_pairs(factor: str) -> None:
    given = given_trig(sums(factor))
    assert given is not None
    kept = {str(statement.operands[0]) for statement in given.kernel.statements if statement.operation == "sincos"}
    assert kept == {str(Local("d")), str(Local("e"))}


def test_given_angles_may_be_of_any_size() -> None:
    plain, given = sums(), given_trig(sums())
    assert given is not None
    trig = [math.sin(0.1), math.cos(0.1)] * 2
    assert Interpreter(None).run(plain, {"q": [0.1, 1e9]}, [0.0])[0] is Status.ANGLE_RANGE
    assert Interpreter(None).run(given.kernel, {"q": [0.1, 1e9], "sc": trig}, [0.0])[0] is Status.OK
    assert Interpreter(None).run(given.kernel, {"q": [0.1, 1e9], "sc": trig}, [1e9])[0] is Status.ANGLE_RANGE
    bad = [math.nan, *trig[1:]]
    assert Interpreter(None).run(given.kernel, {"q": [0.1, 0.2], "sc": bad}, [0.0])[0] is Status.NOT_FINITE


def test_no_sine_of_a_coordinate_no_kernel() -> None:
    assert given_trig(handmade.constant()) is None
