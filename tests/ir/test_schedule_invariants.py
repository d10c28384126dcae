"""What every scheduled kernel keeps: one assignment each, no use before it, checks in the order of statuses."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from laws_harness import shipped_system

from symgen.ir.kernel import UNIT_ROUNDOFF, Block, Check, Kernel, Literal, Local, Operand, Scalar, Status
from symgen.ir.sincos import ANGLE_LIMIT, sincos
from symgen.verify.reference.quantities import ITERATED

# Every kernel of five models is made.
pytestmark = pytest.mark.slow
MODELS = ("skate", "rear_car", "rapkm_2rrr_rr", "slider_crank", "double_pendulum")
ORDER = (
    Status.ANGLE_RANGE, Status.CONSTRAINT_RANK, Status.MASS_RANK, Status.ACTUATION_RANK, Status.MEASURED_RANK,
    Status.TASK_RANK,
)  # fmt: skip


def kernels(scalar: Scalar = "float64", iterated: bool = True) -> Iterator[Kernel]:
    for model in MODELS:
        for kernel in shipped_system(model).program(scalar).kernels:
            if iterated or kernel.name not in ITERATED:
                yield kernel


def names(*operands: Operand) -> set[str]:
    return {operand.name for operand in operands if isinstance(operand, Local)}


def walk(block: Block, known: set[str]) -> None:
    """Asserts that a block assigns each name once and uses only what is known; adds its targets."""
    for statement in block.statements:
        assert names(*statement.operands) <= known
        assert len(statement.targets) == (2 if statement.operation == "sincos" else 1)
        for target in statement.targets:
            assert target not in known
            known.add(target)
    for check in block.checks:
        # what only a failure needs sees the values so far, and leaves nothing behind
        inner = set(known)
        assert names(check.value, check.limit) <= known
        if check.first is not None:
            walk(check.first, inner)


def used(block: Block) -> set[str]:
    used_names = {name for statement in block.statements for name in names(*statement.operands)}
    for check in block.checks:
        used_names |= names(check.value, check.limit)
        if check.first is not None:
            used_names |= used(check.first)
    return used_names


@pytest.mark.parametrize("scalar", ["float64", "float32"])
def test_each_name_is_assigned_once_before_its_use(scalar: Scalar) -> None:
    for kernel in kernels(scalar):
        known = {load.local for load in kernel.loads}
        assert len(known) == len(kernel.loads)
        assert len({(load.argument, load.index) for load in kernel.loads}) == len(kernel.loads)
        for block in kernel.blocks:
            walk(block, known)
        assert names(*kernel.outputs) <= known


def test_nothing_is_computed_in_vain() -> None:
    for kernel in kernels():
        wanted = names(*kernel.outputs).union(*map(used, kernel.blocks))
        for statement in kernel.statements:
            assert wanted & set(statement.targets), (kernel.name, statement)
        for load in kernel.loads:
            assert load.local in wanted, (kernel.name, load)


def test_no_operation_is_done_twice() -> None:
    for kernel in kernels():
        operations = [(statement.operation, statement.operands) for statement in kernel.statements]
        assert len(set(operations)) == len(operations), kernel.name


def divisors_of(kernel: Kernel, check: Check) -> set[str]:
    """The names that are divided by on the way to what a check compares."""
    by_target = {target: statement for statement in kernel.statements for target in statement.targets}
    left, divisors, seen = [*names(check.value, check.limit)], set[str](), set[str]()
    while left:
        name = left.pop()
        if name in seen or name not in by_target:
            continue
        seen.add(name)
        statement = by_target[name]
        left += names(*statement.operands)
        divisors |= names(statement.operands[1]) if statement.operation == "div" else set()
    return divisors


def test_checks_stand_in_the_order_in_which_statuses_are_reported() -> None:
    seen = set()
    # Newton's method is tested where it starts and ends: the same statuses come twice
    for kernel in kernels(iterated=False):
        first, *later = kernel.blocks
        assert {check.status for check in first.checks} <= {Status.ANGLE_RANGE}
        # an angle that comes out of a division is tested after its denominator
        checks = [check for block in later for check in block.checks if check.status is not Status.ANGLE_RANGE]
        for place, check in enumerate(checks):
            # one that stands before an earlier status asks for that status itself when it fails, or looks at what is
            # divided by on the way there
            divisors = divisors_of(kernel, check)
            for late in (c for c in checks[:place] if ORDER.index(c.status) > ORDER.index(check.status)):
                asked = late.first is not None and check.status in {f.status for f in late.first.checks}
                assert asked or names(late.value) & divisors, kernel
        seen |= {check.status for check in (*first.checks, *checks)}
    assert seen == set(ORDER)


def test_a_denominator_is_tested_before_it_divides() -> None:
    """Otherwise a singular state divides by zero on its way to the status.

    Newton's method for measured coordinates is tested where it starts and ends, not at what lies between.
    """
    seen = 0
    for kernel in kernels(iterated=False):
        tested = {name for block in kernel.blocks for check in block.checks for name in names(check.value)}
        sizes = {s.targets[0]: s.operands[0] for s in kernel.statements if s.operation == "abs"}
        waiting = tested | {o.name for name in tested if isinstance(o := sizes.get(name), Local)}
        for block in kernel.blocks:
            divisors = {s.operands[1] for s in block.statements if s.operation == "div"}
            assert not names(*divisors) & waiting, kernel.name
            for check in block.checks:
                passed = names(check.value)
                passed |= {o.name for name in passed if isinstance(o := sizes.get(name), Local)}
                seen += len(passed & waiting)
                waiting -= passed
    assert seen > 0


def test_every_reduced_angle_is_tested() -> None:
    for scalar in ("float64", "float32"):
        for kernel in kernels(scalar):
            angles = sum(statement.operation == "sincos" for statement in kernel.statements)
            checks = [
                check for block in kernel.blocks for check in block.checks if check.status is Status.ANGLE_RANGE
            ]
            assert len(checks) == angles, kernel.name
            limits = {check.value for check in checks if check.inclusive}
            assert limits <= {Literal(ANGLE_LIMIT[scalar])}


def test_sizes_are_those_of_the_shape() -> None:
    for kernel in kernels():
        count = 1
        for size in kernel.shape:
            count *= size
        assert len(kernel.outputs) == count > 0


def test_constant_quantities_cannot_fail() -> None:
    pendulum = shipped_system("double_pendulum")
    kernel = pendulum.kernel("nullspace_projector")
    assert [operand.value for operand in kernel.outputs if isinstance(operand, Literal)] == [1, 0, 0, 1]
    assert not kernel.statements
    assert not any(block.checks for block in kernel.blocks)


def test_thresholds_follow_the_scalar_type() -> None:
    """8 eps squared enters the limit of the sum of squared determinants of two rows."""
    for scalar in ("float64", "float32"):
        kernel = shipped_system("slider_crank").kernel("nullspace_projector", scalar)
        literals = {o.value for s in kernel.statements for o in s.operands if isinstance(o, Literal)}
        assert (8 * UNIT_ROUNDOFF[scalar]) ** 2 in literals


def test_the_sine_and_cosine_are_straight_lines() -> None:
    for scalar in ("float64", "float32"):
        function = sincos(scalar)
        known = set(function.parameters)
        for statement in function.statements:
            assert statement.operation in ("add", "sub", "mul", "abs")
            assert names(*statement.operands) <= known
            assert not known & set(statement.targets)
            known |= set(statement.targets)
        assert set(function.results) <= known
