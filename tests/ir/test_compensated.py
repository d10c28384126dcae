"""Kernels that carry along what rounding takes: accurate where plain ones lose every digit, and the same function."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction

import pytest
from flint import arb

from symgen.diagnostics import SymgenBug
from symgen.ir.adjoint import adjoints
from symgen.ir.compensated import compensated, mark, marked
from symgen.ir.given_trig import given_trig
from symgen.ir.interpret import Interpreter, round_float32
from symgen.ir.kernel import (
    UNIT_ROUNDOFF,
    Argument,
    Block,
    Check,
    Kernel,
    Literal,
    Load,
    Local,
    Operand,
    Scalar,
    Statement,
    Status,
)
from symgen.ir.lifted import Lifted, same_kernel
from symgen.ir.sincos import sincos
from symgen.verify.exactness import exact_outputs
from symgen.verify.reference import State
from symgen.verify.reference_tape import precision

SCALARS: tuple[Scalar, ...] = ("float64", "float32")


class Lines:
    """A kernel line by line; q are x and y, p is k."""

    def __init__(self) -> None:
        self.statements: list[Statement] = []

    def __call__(self, operation: str, *operands: Operand | str | Fraction | int, targets: int = 1) -> str:
        names = tuple(f"t{len(self.statements)}{'ab'[k] if targets > 1 else ''}" for k in range(targets))
        self.statements.append(Statement(names, operation, tuple(map(_operand, operands))))  # type: ignore[arg-type]
        return names[0]

    def kernel(self, *outputs: str, checks: tuple[Check, ...] = ()) -> Kernel:
        loads = (Load("x", "qd", 0), Load("y", "qd", 1), Load("a", "q", 0), Load("k", "p", 0, "k"))
        blocks = (Block((), ()), Block(tuple(self.statements), checks))
        arguments = (Argument("q", 1), Argument("qd", 2))
        return Kernel("f", arguments, loads, blocks, tuple(map(Local, outputs)), (len(outputs),))


def _operand(x: Operand | str | Fraction | int) -> Operand:
    if isinstance(x, str):
        return Local(x)
    return Literal(Fraction(x)) if isinstance(x, (int, Fraction)) else x


def squared(lines: Lines) -> str:
    """(x - y)^2 multiplied out."""
    squares = lines("add", lines("mul", "x", "x"), lines("mul", "y", "y"))
    return lines("sub", squares, lines("mul", 2, lines("mul", "x", "y")))


def quotients(lines: Lines) -> str:
    """x / y - y / x - (x^2 - y^2) / (x y) + (x - y)."""
    first = lines("sub", lines("div", "x", "y"), lines("ratio_or_zero", "y", "x"))
    squares = lines("sub", lines("mul", "x", "x"), lines("mul", "y", "y"))
    rest = lines("sub", first, lines("div", squares, lines("mul", "x", "y")))
    return lines("add", rest, lines("sub", "x", "y"))


def roots(lines: Lines) -> str:
    """sqrt(x^2) - y, by what has the sign of y."""
    root = lines("sqrt", lines("mul", "x", "x"))
    return lines("sub", lines("copysign", root, "y"), lines("abs", lines("neg", "y")))


def thirds(lines: Lines) -> str:
    """(x - y) / 3 by literals that are rounded."""
    return lines("sub", lines("mul", Fraction(1, 3), "x"), lines("mul", 7, lines("mul", "y", Fraction(1, 21))))


def functions(lines: Lines) -> str:
    """atan((x y - y^2) / 7): what enters the function has lost its digits."""
    inside = lines("sub", lines("mul", "x", "y"), lines("mul", "y", "y"))
    return lines("atan", lines("mul", Fraction(1, 7), inside))


def on_the_circle(lines: Lines) -> str:
    """1 - sin(a)^2 beside a right angle."""
    sine = lines("sincos", "a", targets=2)
    return lines("sub", 1, lines("mul", sine, sine))


def of_a_sum(lines: Lines) -> str:
    """cos(2 a + a) beside a right angle, where what rounding took of the sum counts."""
    lines("sincos", lines("add", lines("mul", 2, "a"), "a"), targets=2)
    return "t2b"


def state(scalar: Scalar) -> State:
    x, y, a = 1.3, 1.3 * (1 + 64 * float(UNIT_ROUNDOFF[scalar]) ** 0.5), 1.5707
    if scalar == "float32":
        x, y, a = map(round_float32, (x, y, a))
    return State((a,), (x, y), (), (), (1.0,))


def error(kernel: Kernel, scalar: Scalar) -> float:
    """|y - y*| / (eps |y*|)."""
    where = state(scalar)
    status, (found,) = Interpreter(sincos(scalar), scalar).run(kernel, {"q": where.q, "qd": where.qd}, where.parameters)
    assert status is Status.OK
    with precision(256):
        (exact,) = exact_outputs(kernel, where)
        return float(abs(arb(found) - exact) / abs(exact)) / float(UNIT_ROUNDOFF[scalar])


@pytest.mark.parametrize("scalar", SCALARS)
@pytest.mark.parametrize("lost", [squared, quotients, roots, thirds, on_the_circle, of_a_sum])
def test_what_cancels_keeps_its_digits(lost: Callable[[Lines], str], scalar: Scalar) -> None:
    lines = Lines()
    kernel = lines.kernel(lost(lines))
    everything = {target for statement in kernel.statements for target in statement.targets}
    made = compensated(kernel, scalar, everything)
    assert error(made, scalar) <= (20 if lost in (on_the_circle, of_a_sum) else 3)
    if lost not in (roots, thirds):
        assert error(kernel, scalar) > 30
    assert compensated(kernel, scalar, ()) == kernel


@pytest.mark.parametrize("scalar", SCALARS)
def test_functions_hand_errors_on(scalar: Scalar) -> None:
    lines = Lines()
    kernel = lines.kernel(functions(lines))
    plain, made = (error(one, scalar) for one in (kernel, compensated(kernel, scalar, {"t0", "t1", "t2", "t3"})))
    # what the function itself rounds stays
    assert made < 4
    assert plain > 20


@pytest.mark.parametrize("scalar", SCALARS)
def test_sums_of_angles_are_sums_like_all_others(scalar: Scalar) -> None:
    """A small angle beside a large one: their sum loses what the small one holds."""
    statements = (
        Statement(("sum",), "add", (Local("a"), Local("b"))),
        Statement(("s", "c"), "sincos", (Local("sum"),)),
        Statement(("sa", "ca"), "sincos", (Local("a"),)),
        Statement(("turned",), "sub", (Local("s"), Local("sa"))),
    )
    loads = (Load("a", "q", 0), Load("b", "q", 1))
    kernel = Kernel("f", (Argument("q", 2),), loads, (Block(statements, ()),), (Local("turned"),), (1,))
    where = State(tuple(map(float if scalar == "float64" else round_float32, (3.1, 1e-3))), (), (), (), ())
    off = {}
    for name, one in (("plain", kernel), ("carrying", compensated(kernel, scalar, {"sum", "s", "c", "sa", "ca"}))):
        _, (found,) = Interpreter(sincos(scalar), scalar).run(one, {"q": where.q}, ())
        with precision(256):
            (exact,) = exact_outputs(kernel, where)
            off[name] = float(abs(arb(found) - exact)) / float(UNIT_ROUNDOFF[scalar])
        # given sines would not know of that rounding: the sum keeps a pair of its own
        given = given_trig(one)
        assert given is not None
        pairs = [s.operands for s in given.kernel.statements if s.operation == "sincos"]
        assert pairs == ([] if name == "plain" else [(Local("sum"),)])
    assert off["plain"] > 0.5
    assert off["carrying"] < 0.1


def test_only_what_is_chosen_is_carried_and_checks_stay() -> None:
    lines = Lines()
    product = lines("mul", "x", "y")
    total = lines("add", product, "k")
    check = Check(Status.MASS_RANK, Local(product), Literal(Fraction(1, 10)))
    kernel = lines.kernel(total, checks=(check,))
    one, both = (compensated(kernel, "float64", chosen) for chosen in ({total}, {product, total}))
    assert len(kernel.statements) < len(one.statements) < len(both.statements)
    for made in (one, both):
        assert [c for block in made.blocks for c in block.checks] == [check]
        status, _ = Interpreter(None).run(made, {"q": [0.0], "qd": [0.1, 0.2]}, [1.0])
        assert status is Status.MASS_RANK


def test_chosen_statements_are_told_by_a_number() -> None:
    lines = Lines()
    kernel = lines.kernel(squared(lines))
    targets = [target for statement in kernel.statements for target in statement.targets]
    for chosen in (set(), set(targets), {targets[0], targets[-1]}):
        assert marked(kernel, mark(kernel, chosen)) == chosen
    assert mark(kernel, {targets[0], targets[4]}) == "11"


def test_derivatives_are_those_of_differences() -> None:
    lines = Lines()
    sine = lines("sincos", "a", targets=2)
    cosine = sine[:-1] + "b"
    terms = [lines(name, "x") for name in ("tan", "atan", "exp", "log", "sinh", "cosh", "tanh", "sqrt", "neg", "abs")]
    half = lines("mul", Fraction(1, 3), "x")
    terms += [lines("asin", half), lines("acos", half), lines("atan2", "x", "y"), lines("pow", "x", Fraction(7, 3))]
    terms += [lines(name, "x", "y") for name in ("div", "ratio_or_zero", "min", "max", "copysign", "sub")]
    terms += [lines("mul", sine, "x"), lines("mul", cosine, "y")]
    total = terms[0]
    for place, term in enumerate(terms[1:], 2):
        total = lines("add", total, lines("mul", place, term))
    kernel = lines.kernel(total, terms[0])
    interpreter = Interpreter(None)
    weights = (1.0, -2.0)

    def at(a: float, x: float, y: float) -> dict[str, float]:
        return interpreter.values(kernel, {"q": [a], "qd": [x, y]}, [1.0])

    point = {"a": 0.7, "x": 0.8, "y": 1.1}
    slopes = adjoints(kernel, at(**point), weights)
    for name in point:
        low, high = (at(**{**point, name: point[name] + step}) for step in (-1e-6, 1e-6))
        change = sum(
            weight * (high[output.name] - low[output.name])
            for weight, output in zip(weights, kernel.outputs, strict=True)
            if isinstance(output, Local)
        )
        assert math.isclose(slopes[name], change / 2e-6, rel_tol=1e-7)


@pytest.mark.parametrize("depth", [2, 4, 6])
def test_roots_of_sums_that_hold_roots_are_no_other_function(depth: int) -> None:
    lines = Lines()
    last = "x"
    for _ in range(depth):
        root = lines("sqrt", lines("add", last, "y"))
        last = lines("add", root, lines("mul", root, "k"))
    kernel = lines.kernel(last)
    compensated(kernel, "float64", {target for s in lines.statements for target in s.targets})


def test_where_the_field_has_the_roots_a_wrong_square_is_found() -> None:
    lines = Lines()
    root = lines("sqrt", lines("add", lines("mul", "x", "x"), "y"))
    square = lines("mul", root, root)
    before = lines.kernel(square)
    wrong = lines.kernel(lines("add", square, "k"))
    with pytest.raises(SymgenBug, match="squaring: changes the value of 1 of 1 scalars"):
        same_kernel("squaring", Lifted(before), Lifted(wrong), squares_roots=True)
