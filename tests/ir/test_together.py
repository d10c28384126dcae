"""Several kernels in one: the bits and statuses that they have alone, and nothing made twice."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
import shipped
from handmade import literal, op

from symgen.backends.defaults import default_values
from symgen.backends.locals import all_statements, used_locals
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Argument, Block, Check, Kernel, Load, Local, Statement, Status
from symgen.ir.together import together

QUANTITIES = ("inverse_dynamics", "forward_dynamics", "multipliers", "mass_matrix", "projected_mass_matrix")


@pytest.mark.slow
@pytest.mark.parametrize("name", shipped.sparing(shipped.SWEPT))
def test_results_have_the_bits_that_they_have_alone(name: str) -> None:
    program, model = shipped.programs(name)["float64"], shipped.model(name)
    parameters = [float(value) for value in default_values(model).values()]
    kernels = [kernel for kernel in program.kernels if kernel.name in QUANTITIES]
    one = together(kernels).kernel
    assigned = [load.local for load in one.loads] + [t for s in all_statements(one) for t in s.targets]
    assert len(set(assigned)) == len(assigned)
    assert all(used_locals(one).intersection(s.targets) for s in one.statements)
    assert len(one.statements) < sum(len(kernel.statements) for kernel in kernels)
    source, interpreter = random.Random(7), Interpreter(program.sincos)
    for _ in range(5):
        state = {a.name: [source.uniform(-1, 1) for _ in range(a.length)] for a in one.arguments}
        alone = [interpreter.run(kernel, state, parameters) for kernel in kernels]
        assert interpreter.run(one, state, parameters) == (
            max(status for status, _ in alone), [entry for _, entries in alone for entry in entries]
        )  # fmt: skip


def kernel(name: str, *statements: Statement, output: str, check: Check | None = None) -> Kernel:
    """Of x = q[0] and y = q[1], called what this kernel likes."""
    block = Block(statements, () if check is None else (check,))
    loads = Load("x", "q", 0), Load("y", "q", 1)
    return Kernel(name, (Argument("q", 2),), loads, (block,), (Local(output),), (1,))


PRODUCT = kernel("product", op("t", "mul", "x", "y"), op("out", "add", "t", literal(1)), output="out")
# the same product the other way round, and a name that means something else in the first
QUOTIENT = kernel("quotient", op("out", "mul", "y", "x"), op("t", "div", "out", "x"), output="t")


def test_the_same_operation_is_made_once_whatever_it_is_called() -> None:
    made = together([PRODUCT, QUOTIENT]).kernel
    assert [statement.operation for statement in made.statements] == ["mul", "add", "div"]
    assert Interpreter(None).run(made, {"q": [3.0, 5.0]}, []) == (Status.OK, [16.0, 5.0])


def test_operands_that_must_not_change_places_do_not() -> None:
    other = kernel("difference", op("t", "sub", "y", "x"), output="t")
    made = together([kernel("other", op("t", "sub", "x", "y"), output="t"), other]).kernel
    assert Interpreter(None).run(made, {"q": [3.0, 5.0]}, []) == (Status.OK, [-2.0, 2.0])


def test_a_check_that_was_passed_is_not_made_again_and_the_first_that_fails_tells() -> None:
    positive = Check(Status.MASS_RANK, Local("t"), literal(0))
    first = kernel("first", op("t", "mul", "x", "y"), output="t", check=positive)
    cause = Block((op("t", "add", "x", "x"),), (Check(Status.BRANCH, Local("t"), literal(0)),))
    small = Check(Status.CONSTRAINT_RANK, Local("d"), literal(-1), first=cause)
    second = kernel("second", op("t", "mul", "y", "x"), op("d", "sub", "x", "y"), output="d", check=small)
    again = replace(first, name="again")
    made = together([first, second, again]).kernel
    assert sum(len(block.checks) for block in made.blocks) == 2
    run = Interpreter(None).run
    assert run(made, {"q": [5.0, 3.0]}, []) == (Status.OK, [15.0, 2.0, 15.0])
    assert run(made, {"q": [-5.0, 3.0]}, [])[0] is Status.MASS_RANK
    assert run(made, {"q": [1.0, 3.0]}, [])[0] is Status.CONSTRAINT_RANK
    assert run(made, {"q": [-5.0, -3.0]}, [])[0] is Status.BRANCH
