"""Kernels put into an order in which fewer values wait: the same operations, tests before what they protect."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from typing import Literal as Literally

import pytest
import shipped

from symgen.ir.kernel import Block, Check, Kernel, Literal, Load, Local, Statement, Status
from symgen.ir.order import LONGEST_REORDERED, REGISTERS, relaxed
from symgen.ir.split import names_in, names_of_check
from symgen.lowering.schedule import schedule
from symgen.quantities.select import derive_quantities

QUANTITIES = {
    "rapkm_2rrr_rr": ("inverse_dynamics", "nullspace_projector"),
    "slider_crank": ("inverse_dynamics", "forward_dynamics", "nullspace_projector_dot"),
}


def waiting(kernel: Kernel) -> int:
    """The largest number of values of statements after the pairs that are computed and still to be used."""
    steps: list[Statement | Check] = [
        step for block in kernel.blocks[2:] for step in (*block.statements, *block.checks)
    ]
    reads = [names_in(s.operands) if isinstance(s, Statement) else names_of_check(s) for s in steps]
    made = [s.targets[0] if isinstance(s, Statement) else "" for s in steps]
    last = {name: place for place, names in enumerate(reads) for name in names}
    last |= dict.fromkeys(names_in(kernel.outputs), len(steps))
    return max(sum(place <= now < last.get(name, -1) for place, name in enumerate(made)) for now in range(len(steps)))


def as_written(monkeypatch: pytest.MonkeyPatch, name: str) -> tuple[Kernel, ...]:
    monkeypatch.setattr("symgen.lowering.schedule.relaxed", lambda kernel: kernel)
    derived = derive_quantities(shipped.model(name), QUANTITIES[name])
    return schedule(derived.mechanics, derived.quantities, ("float64",))["float64"].kernels


def divisions_before_their_test(kernel: Kernel) -> list[str]:
    """Tested denominators that something is divided by before the test."""
    tested = {c.value.name for b in kernel.blocks for c in b.checks if isinstance(c.value, Local)}
    tested |= {
        name
        for s in kernel.statements
        if s.operation == "abs" and s.targets[0] in tested
        for name in names_in(s.operands)
    }
    early: list[str] = []
    passed: set[str] = set()
    for block in kernel.blocks:
        for statement in block.statements:
            if statement.operation == "div":
                early += names_in(statement.operands[1:]) & (tested - passed)
            if statement.operation == "abs" and passed.intersection(statement.targets):
                passed |= names_in(statement.operands)
        for check in block.checks:
            passed |= names_in((check.value,))
            sizes = (s for b in kernel.blocks for s in b.statements if s.operation == "abs")
            passed |= {name for s in sizes if s.targets[0] in passed for name in names_in(s.operands)}
    return early


@pytest.mark.parametrize("name", QUANTITIES)
def test_only_the_order_changes_and_tests_stay_before_what_they_protect(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    changed = 0
    for kernel in as_written(monkeypatch, name):
        ordered = relaxed(kernel)
        assert Counter(ordered.statements) == Counter(kernel.statements)
        assert [c for b in ordered.blocks for c in b.checks] == [c for b in kernel.blocks for c in b.checks]
        assert (ordered.loads, ordered.outputs, ordered.blocks[:2]) == (kernel.loads, kernel.outputs, kernel.blocks[:2])
        assert not divisions_before_their_test(ordered)
        if ordered is not kernel:
            changed += 1
            assert waiting(kernel) >= REGISTERS
            assert waiting(ordered) < waiting(kernel)
    assert changed


def test_inverse_dynamics_of_the_parallel_robot_fits_into_registers(monkeypatch: pytest.MonkeyPatch) -> None:
    (kernel,) = (k for k in as_written(monkeypatch, "rapkm_2rrr_rr") if k.name == "inverse_dynamics")
    assert waiting(kernel) >= REGISTERS > waiting(relaxed(kernel))


def legs(count: int, operation: str = "mul", argument: Literally["q", "p"] = "q") -> Kernel:
    """A sum over `count` of x_i / d, where each x_i is an expression of two values that it alone shares with y_i."""
    loads = tuple(Load(f"q{i}", argument, i) for i in range(count))
    statements = [Statement((f"a{i}",), "add", (Local(f"q{i}"), Literal(Fraction(1)))) for i in range(count)]
    statements += [Statement((f"b{i}",), "mul", (Local(f"q{i}"), Literal(Fraction(3)))) for i in range(count)]
    tested = Block(
        (Statement(("d",), "mul", (Local("q0"), Local("q1"))),), (Check(Status.MASS_RANK, Local("d"), Local("q2")),)
    )
    for i in range(count):
        statements.append(Statement((f"x{i}",), operation, (Local(f"a{i}"), Local(f"b{i}"))))  # type: ignore[arg-type]
        statements.append(Statement((f"y{i}",), "sub", (Local(f"a{i}"), Local(f"b{i}"))))
        statements.append(Statement((f"z{i}",), "div", (Local(f"x{i}"), Local("d"))))
        statements.append(Statement((f"u{i}",), "add", (Local(f"z{i}"), Local(f"y{i}"))))
    outputs = tuple(Local(f"u{i}") for i in range(count))
    head = (Block((), ()), Block((), ()))
    return Kernel("inverse_dynamics", (), loads, (*head, tested, Block(tuple(statements), ())), outputs, (count,))


def test_kernels_whose_values_fit_keep_their_order() -> None:
    kernel = legs(6)
    assert waiting(kernel) < REGISTERS
    assert relaxed(kernel) is kernel


def test_long_kernels_keep_their_order() -> None:
    """A better one is looked for among all steps that may come next: that grows with the square of their number."""
    short, long = legs(LONGEST_REORDERED // 6 - 1), legs(LONGEST_REORDERED // 6 + 1)
    assert len(short.statements) <= LONGEST_REORDERED < len(long.statements)
    assert relaxed(short) is not short
    assert relaxed(long) is long


def test_a_test_stands_late_but_before_its_division() -> None:
    kernel = relaxed(legs(12))
    assert waiting(kernel) < waiting(legs(12))
    assert not divisions_before_their_test(kernel)
    before = {target for statement in kernel.blocks[2].statements for target in statement.targets}
    assert "d" in before
    assert not before & {f"z{i}" for i in range(12)}


def test_a_quotient_by_something_untested_stays_behind_the_tests() -> None:
    quotients = {f"x{i}" for i in range(12)}
    kernel = relaxed(legs(12, "div"))
    assert waiting(kernel) < waiting(legs(12, "div"))
    assert not quotients & {target for statement in kernel.blocks[2].statements for target in statement.targets}


def test_a_quotient_of_parameters_may_stand_before_tests_of_others() -> None:
    kernel = relaxed(legs(12, "div", "p"))
    assert not divisions_before_their_test(kernel)
    before = {target for statement in kernel.blocks[2].statements for target in statement.targets}
    assert {f"x{i}" for i in range(12)} & before
    assert not {f"z{i}" for i in range(12)} & before
