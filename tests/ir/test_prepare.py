"""Parameters prepared once: the same bits and statuses, nothing left that depends on parameters only."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction

import handmade
import pytest
import shipped
from handmade import literal, op

from symgen.backends.defaults import default_values
from symgen.backends.literals import round_to
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Block, Check, Kernel, Local, Program, Scalar, Status
from symgen.ir.prepare import WORTHWHILE, Prepared, prepare
from symgen.ir.split import split

NAMES = ("double_pendulum", "front_car", "rapkm_2rrr_rr", "slider_crank")
QUANTITIES = ("inverse_dynamics", "forward_dynamics", "multipliers")


def values(prepared: Prepared, program: Program, parameters: list[float]) -> list[float]:
    """What a call that prepares the parameters computes; it may hold infinities, which a kernel answers for."""
    once = Kernel("prepare", (), prepared.loads, (Block(prepared.statements, ()),), (), ())
    computed = []
    for value in prepared.values:
        kernel = replace(once, outputs=(value,), shape=(1,))
        status, outputs = Interpreter(program.sincos, program.scalar).run(kernel, {}, parameters)
        computed += outputs if status is Status.OK else [float("inf")]
    return computed


@pytest.mark.parametrize("scalar", shipped.SCALARS)
@pytest.mark.parametrize("name", NAMES)
def test_same_bits_and_statuses(name: str, scalar: Scalar) -> None:
    program = shipped.programs(name)[scalar]
    prepared = prepare(program, QUANTITIES)
    assert prepared is not None
    source = random.Random(3)
    interpreter = Interpreter(program.sincos, scalar)
    plain = {kernel.name: kernel for kernel in program.kernels}
    defaults = [round_to(scalar, value) for value in default_values(shipped.model(name)).values()]
    for parameters in (defaults, [value * 1.25 for value in defaults], [0.0] * len(defaults)):
        made = values(prepared, program, parameters)
        for kernel in prepared.kernels:
            size = max(argument.length for argument in kernel.arguments)
            for hard in (None, None, 0.0, 1e30):
                numbers = [source.uniform(-1, 1) if hard is None else hard for _ in range(size)]
                state = {argument.name: numbers for argument in kernel.arguments}
                assert interpreter.run(kernel, state, made) == interpreter.run(plain[kernel.name], state, parameters)


@pytest.mark.parametrize("name", NAMES)
def test_nothing_is_left_that_parameters_determine(name: str) -> None:
    program = shipped.programs(name)["float64"]
    prepared = prepare(program, QUANTITIES)
    assert prepared is not None
    kept = {kernel.name for kernel in prepared.kernels}
    for kernel in (kernel for kernel in program.kernels if kernel.name in QUANTITIES):
        share = Fraction(len(split(kernel).fixed), len(kernel.statements))
        assert (kernel.name in kept) == (share >= WORTHWHILE)
    assert all(not split(kernel).fixed for kernel in prepared.kernels)
    operations = [(s.operation, s.operands) for s in prepared.statements]
    assert len(set(operations)) == len(operations), "an operation is done twice"
    assert len(set(prepared.values)) == len(prepared.values)


def test_values_are_shared_between_kernels_and_kept_for_failed_checks() -> None:
    first = Block((op("f", "mul", "w", "x"),), (Check(Status.CONSTRAINT_RANK, Local("f"), Local("L")),))
    block = Block(
        (op("w", "mul", "L", "L"), op("y", "mul", "w", "x"), op("z", "add", "y", literal("1"))),
        (Check(Status.ACTUATION_RANK, Local("x"), Local("w"), first=first),),
    )
    one = Kernel("inverse_dynamics", (), handmade.loads("x", "L"), (block,), (Local("z"),), (1,))
    same = Block((op("t", "mul", "L", "L"), op("u", "mul", "t", "x")), ())
    two = Kernel("forward_dynamics", (), handmade.loads("x", "L"), (same,), (Local("u"), Local("t")), (2,))
    prepared = prepare(Program("float64", None, (one, two)), QUANTITIES)
    assert prepared is not None
    assert [statement.operation for statement in prepared.statements] == ["mul"]
    assert prepared.values == (Local("L"), prepared.values[1])
    assert {load.index for kernel in prepared.kernels for load in kernel.loads if load.argument == "p"} == {0, 1}
    assert [load.local for load in prepared.kernels[0].loads] == ["x", "L", "w"]


def test_too_little_is_not_prepared() -> None:
    assert prepare(handmade.program(), QUANTITIES) is None
    assert prepare(shipped.programs("skate")["float64"], ("inverse_dynamics",)) is None
