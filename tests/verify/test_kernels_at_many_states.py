"""Kernels run at all states at once give the bits and statuses of the interpreter, which takes one after the other."""

from __future__ import annotations

import math
import random
from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from symgen.ir.interpret import OPERATIONS, Interpreter
from symgen.ir.kernel import (
    Argument,
    Block,
    Check,
    Kernel,
    Literal,
    Load,
    Local,
    OperationName,
    Scalar,
    Statement,
    Status,
)
from symgen.ir.pairs.wide_functions import WIDE
from symgen.verify.lanes.many_states import run_many

SPECIAL = (0.0, -0.0, 1.0, -1.0, 0.5, 1e-40, -3e38, math.inf, -math.inf, math.nan)
UNARY = ("neg", "abs", "sqrt", "tan", "asin", "acos", "atan", "exp", "log", "sinh", "cosh", "tanh")
A, B = Local("a"), Local("b")
LOADS = (Load("a", "q", 0), Load("b", "q", 1))
ARGUMENTS = (Argument("q", 2),)


def states(scalar: Scalar) -> list[dict[str, list[float]]]:
    source = random.Random(scalar)
    pairs = [*product(SPECIAL, repeat=2), *((source.gauss(0, 2), source.gauss(0, 2)) for _ in range(40))]
    number = np.float32 if scalar == "float32" else np.float64
    with np.errstate(all="ignore"):
        return [{"q": [float(number(x)) for x in pair], "p": []} for pair in pairs]


@pytest.mark.parametrize("scalar", ["float64", "float32"])
def test_every_operation_has_the_same_bits(scalar: Scalar) -> None:
    given = states(scalar)
    for name in OPERATIONS:
        statements = [Statement(("x",), name, (A,) if name in UNARY else (A, B))]  # type: ignore[arg-type]
        statements.append(Statement(("y",), "mul", (Local("x"), Literal(Fraction(1, 3)))))
        statements.append(Statement(("s", "c"), "sincos", (Local("y"),)))
        outputs = tuple(map(Local, "xysc"))
        kernel = Kernel("k", ARGUMENTS, LOADS, (Block(tuple(statements), ()),), outputs, (4,))
        for state, (status, entries) in zip(given, run_many(kernel, None, scalar, given), strict=True):
            wanted, numbers = Interpreter(None, scalar).run(kernel, state, ())
            assert status is wanted
            assert _same(entries, numbers), (name, state)


def _same(values: list[float], wanted: list[float]) -> bool:
    """All bits but the sign of NaN, which nothing reads."""
    pairs = zip(values, wanted, strict=True)
    return all((a == b and math.copysign(1, a) == math.copysign(1, b)) or (a != a and b != b) for a, b in pairs)


@pytest.mark.parametrize("scalar", ["float64", "float32"])
def test_the_first_check_that_fails_tells_the_status(scalar: Scalar) -> None:
    zero, one = Literal(Fraction(0)), Literal(Fraction(1))
    first = Block((Statement(("t",), "sub", (one, A)),), (Check(Status.CONSTRAINT_RANK, Local("t"), zero),))
    blocks = (
        Block((Statement(("x",), "sub", (A, B)),), (Check(Status.ACTUATION_RANK, Local("x"), zero, first=first),)),
        Block((Statement(("y",), "div", (one, B)),), (Check(Status.MASS_RANK, B, zero, inclusive=True),)),
    )
    kernel = Kernel("k", ARGUMENTS, LOADS, blocks, (Local("x"), Local("y"), one), (3,))
    given, met = states(scalar), set()
    for state, (status, entries) in zip(given, run_many(kernel, None, scalar, given), strict=True):
        wanted, numbers = Interpreter(None, scalar).run(kernel, state, ())
        met.add(status)
        assert status is wanted
        assert _same(entries, numbers)
    assert met == {
        Status.OK, Status.NOT_FINITE, Status.CONSTRAINT_RANK, Status.ACTUATION_RANK, Status.MASS_RANK
    }  # fmt: skip


@pytest.mark.parametrize("scalar", ["float64", "float32"])
@pytest.mark.parametrize("operation", list(WIDE.values()))
def test_operations_on_pairs_have_the_same_bits(operation: OperationName, scalar: Scalar) -> None:
    number = np.float32 if scalar == "float32" else np.float64
    source = random.Random(operation)
    rest = number(np.finfo(number).eps)
    values = [*SPECIAL, 0.25, *(source.gauss(0, 2) for _ in range(20))]
    with np.errstate(all="ignore"):
        pairs = [(float(number(x)), float(number(number(x) * rest * number(0.3)))) for x in values]
        given = [{"q": [*one, *other], "p": []} for one, other in product(pairs, repeat=2)]
    names = ("a", "a_rest") if operation == "wide_sqrt" else ("a", "a_rest", "b", "b_rest")
    loads = tuple(Load(name, "q", place) for place, name in enumerate(names))
    statement = Statement(("x", "y"), operation, tuple(map(Local, names)))
    outputs = (Local("x"), Local("y"))
    kernel = Kernel("k", (Argument("q", 4),), loads, (Block((statement,), ()),), outputs, (2,))
    for state, (status, entries) in zip(given, run_many(kernel, None, scalar, given), strict=True):
        wanted, numbers = Interpreter(None, scalar).run(kernel, state, ())
        assert status is wanted
        assert _same(entries, numbers), state
