"""Kernels with sines of values that are rounded first: told right or wrong by fingerprints, without exact values."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from symgen.diagnostics import SymgenBug
from symgen.ir import lifted
from symgen.ir.kernel import Argument, Block, Kernel, Load, Local, Operand, OperationName, Statement
from symgen.ir.lifted import Lifted, Meant, same_kernel
from symgen.symbolic.graph import Graph
from symgen.symbolic.scalar import Scalar

STATES = ("x", "y")


def kernel(*statements: tuple[tuple[str, ...], OperationName, tuple[str, ...]], output: str) -> Kernel:
    """Of x and y."""
    lines = tuple(Statement(targets, name, _locals(operands)) for targets, name, operands in statements)
    loads = tuple(Load(name, "q", k) for k, name in enumerate(STATES))
    return Kernel("f", (Argument("q", 2),), loads, (Block((), ()), Block(lines, ())), (Local(output),), (1,))


def _locals(names: Sequence[str]) -> tuple[Operand, ...]:
    return tuple(map(Local, names))


def a_step_turned() -> Scalar:
    """sin(rounded(x - sin(y)) + y): an angle that is read by what it is a sum of."""
    graph = Graph()
    x, y = map(graph.symbol, STATES)
    stepped = graph.rounded(x - graph.trig("sin", y))
    assert stepped.op == "rounded"
    return graph.trig("sin", stepped + y)


def as_written(last: OperationName) -> Kernel:
    """The statements of it, the last sum with a sign."""
    return kernel(
        (("s", "c"), "sincos", ("y",)),
        (("a",), "sub", ("x", "s")),
        (("b",), last, ("a", "y")),
        (("d", "e"), "sincos", ("b",)),
        output="d",
    )


def test_angles_are_read_by_what_stands_under_roundings(monkeypatch: pytest.MonkeyPatch) -> None:
    def exactly(*_: object, **__: object) -> None:
        raise AssertionError("fingerprints differ")

    monkeypatch.setattr(lifted, "same_values", exactly)
    meant = Meant((a_step_turned(),), (), ())
    same_kernel("writing", meant, Lifted(as_written("add")))
    with pytest.raises(AssertionError, match="fingerprints differ"):
        same_kernel("writing", meant, Lifted(as_written("sub")))


def test_a_wrong_angle_is_named() -> None:
    with pytest.raises(SymgenBug, match="writing: changes the value of 1 of 1 scalars"):
        same_kernel("writing", Meant((a_step_turned(),), (), ()), Lifted(as_written("sub")))
