"""Kernels with twice the digits: accurate where plain ones lose every digit, and the same function."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

import pytest
from flint import arb

from symgen.diagnostics import SymgenBug
from symgen.ir.constants import sine_and_cosine
from symgen.ir.interpret import Interpreter, round_literal
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
    OperationName,
    Scalar,
    Statement,
    Status,
)
from symgen.ir.lifted import Lifted, same_kernel
from symgen.ir.pairs.sharp_thresholds import LOWERED, with_sharp_thresholds
from symgen.ir.pairs.wide import GAINED, widened
from symgen.ir.pairs.wide_angles import MOST_PARTS
from symgen.ir.pairs.wide_functions import WIDE, wide_function
from symgen.ir.sincos import sincos
from symgen.verify.exactness import EXACT, ExactFunction
from symgen.verify.lanes.many_states import run_many
from symgen.verify.reference.arithmetic.tape import precision
from symgen.verify.reference.reference import State

SCALARS: tuple[Scalar, ...] = ("float64", "float32")


class Lines:
    """A kernel line by line; q is a, q_dot are x and y, p is k."""

    def __init__(self) -> None:
        self.statements: list[Statement] = []

    def __call__(self, operation: OperationName, *operands: Operand | str | Fraction | int, targets: int = 1) -> str:
        names = tuple(f"t{len(self.statements)}{'ab'[k] if targets > 1 else ''}" for k in range(targets))
        self.statements.append(Statement(names, operation, tuple(map(_operand, operands))))
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
    """sqrt(x^2 + (x - y)) - x: a root of what is rounded."""
    under = lines("add", lines("mul", "x", "x"), lines("sub", "x", "y"))
    return lines("sub", lines("sqrt", under), "x")


def literals(lines: Lines) -> str:
    """(x / 3 + y / 7) 21 - 7 x - 3 y + (x - y): numbers that no float holds."""
    parts = lines("add", lines("mul", Fraction(1, 3), "x"), lines("div", "y", Fraction(7, 3)))
    both = lines("add", lines("mul", 7, "x"), lines("mul", 9, "y"))
    return lines("add", lines("sub", lines("mul", 21, parts), both), lines("sub", "x", "y"))


def choices(lines: Lines) -> str:
    """min(x x, y y) + max(x x, y y) - |-x x| - y y with the sign of x, + (x - y)."""
    xx, yy = lines("mul", "x", "x"), lines("mul", "y", "y")
    both = lines("add", lines("min", xx, yy), lines("max", xx, yy))
    rest = lines("sub", lines("sub", both, lines("abs", lines("neg", xx))), lines("copysign", yy, "x"))
    return lines("add", rest, lines("sub", "x", "y"))


def circle(lines: Lines) -> str:
    """(1 - cos^2 a) / sin^2 a - 1 + (x - y)."""
    lines("sincos", "a", targets=2)
    number = len(lines.statements) - 1
    sine, cosine = f"t{number}a", f"t{number}b"
    over = lines("sub", 1, lines("mul", cosine, cosine))
    quotient = lines("sub", lines("div", over, lines("mul", sine, sine)), 1)
    return lines("add", quotient, lines("sub", "x", "y"))


def turned(lines: Lines) -> str:
    """sin(a + k) - sin a cos k - cos a sin k + (x - y), the sum large beside k."""
    sine = lines("sincos", lines("add", "a", "k"), targets=2)
    lines("sincos", "a", targets=2)
    first = len(lines.statements) - 1
    lines("sincos", "k", targets=2)
    second = len(lines.statements) - 1
    left = lines("mul", f"t{first}a", f"t{second}b")
    right = lines("mul", f"t{first}b", f"t{second}a")
    return lines("add", lines("sub", sine, lines("add", left, right)), lines("sub", "x", "y"))


def bounded(lines: Lines) -> str:
    """max(x x, 1/3) - max(min(y y, 99/7), -1/3) + (x - y) - sinh(1/3) + sinh(1/3): choices beside numbers."""
    xx, yy = lines("mul", "x", "x"), lines("mul", "y", "y")
    low = lines("max", lines("min", yy, Fraction(99, 7)), Fraction(-1, 3))
    both = lines("sub", lines("max", xx, Fraction(1, 3)), low)
    same = lines("sub", lines("sinh", Fraction(1, 3)), lines("sinh", Fraction(1, 3)))
    return lines("add", lines("add", both, same), lines("sub", "x", "y"))


KERNELS: tuple[Callable[[Lines], str], ...] = (squared, quotients, roots, literals, choices, bounded, circle)


def given(scalar: Scalar) -> list[dict[str, tuple[float, ...]]]:
    """x and y that differ in the second half of their digits, and angles."""
    source = random.Random(5)
    eps = float(UNIT_ROUNDOFF[scalar])
    states = []
    for _ in range(20):
        x = round_literal(Fraction(source.uniform(1, 2)), scalar)
        y = round_literal(Fraction(x * (1 + 2 * math.sqrt(eps) * source.randint(1, 9))), scalar)
        a = round_literal(Fraction(source.uniform(0.5, 1)), scalar)
        states.append({"q": (a,), "qd": (x, y), "qdd": (), "u": (), "p": (a / 64,)})
    return states


def _state(one: Mapping[str, Sequence[float]]) -> State:
    return State(*(tuple(map(Fraction, one[part])) for part in ("q", "qd", "qdd", "u", "p")))


def assert_digits_come_back(
    build: Callable[[Lines], str], scalar: Scalar, states: Sequence[dict[str, tuple[float, ...]]]
) -> None:
    """Relative errors of a few eps, where the plain kernel has a hundred at some state."""
    lines = Lines()
    plain = lines.kernel(build(lines))
    wide = widened(plain, scalar)
    interpreter = Interpreter(sincos(scalar), scalar)
    eps = float(UNIT_ROUNDOFF[scalar])
    lost = []
    for one in states:
        with precision(200):
            (exact,) = ExactFunction(plain)(_state(one))
        relative = []
        for kernel in (plain, wide):
            status, (entry,) = interpreter.run(kernel, one, one["p"])
            assert status is Status.OK
            with precision(200):
                relative.append(float(abs(arb(entry) - exact) / abs(exact)))
        lost.append(relative[0])
        assert relative[1] < 4 * eps
    assert max(lost) > 100 * eps


@pytest.mark.parametrize("scalar", SCALARS)
@pytest.mark.parametrize("build", KERNELS, ids=lambda build: build.__name__)
def test_what_plain_kernels_lose(build: Callable[[Lines], str], scalar: Scalar) -> None:
    """The plain kernel has nothing but rounding errors."""
    assert_digits_come_back(build, scalar, given(scalar))


@pytest.mark.parametrize("build", [squared, roots], ids=lambda build: build.__name__)
def test_digits_that_a_pair_in_float32_has_more_than_one_number(build: Callable[[Lines], str]) -> None:
    """Of x and y next to each other nothing is left but what rounding takes of pairs of the size of x."""
    lines, source, eps = Lines(), random.Random(7), float(UNIT_ROUNDOFF["float32"])
    plain = lines.kernel(build(lines))
    wide, interpreter = widened(plain, "float32"), Interpreter(sincos("float32"), "float32")
    taken = []
    for _ in range(300):
        x = round_literal(Fraction(source.uniform(1, 2)), "float32")
        y = x + source.randint(1, 3) * 2 * eps
        one = {"q": (0.5,), "qd": (x, y), "qdd": (), "u": (), "p": (0.01,)}
        with precision(200):
            (exact,) = ExactFunction(plain)(_state(one))
            _, (entry,) = interpreter.run(wide, one, one["p"])
            taken.append(float(abs(arb(entry) - exact)) / x**2)
    assert 2.0 ** -(GAINED + 4) < max(taken) / eps < 2.0**-GAINED


@pytest.mark.parametrize("scalar", SCALARS)
def test_sums_of_angles(scalar: Scalar) -> None:
    """What rounding takes of a sum of angles comes back; what is left are the errors of sines, which turn angles."""
    lines = Lines()
    wide = widened(lines.kernel(turned(lines)), scalar)
    interpreter = Interpreter(sincos(scalar), scalar)
    eps = float(UNIT_ROUNDOFF[scalar])
    for one in given(scalar):
        _, (entry,) = interpreter.run(wide, one, one["p"])
        x, y = one["qd"]
        assert abs(entry - (x - y)) < 4 * eps * one["q"][0]


def stretched(lines: Lines) -> str:
    """sin(a + k) cos a - cos(a + k) sin a, which is sin k; nothing else is made of k alone."""
    lines("sincos", lines("add", "a", "k"), targets=2)
    both = len(lines.statements) - 1
    lines("sincos", "a", targets=2)
    one = len(lines.statements) - 1
    left = lines("mul", f"t{both}a", f"t{one}b")
    return lines("sub", left, lines("mul", f"t{both}b", f"t{one}a"))


def folded(lines: Lines) -> str:
    """sin(x - k - a - a) cos(x - a - a) - cos(x - k - a - a) sin(x - a - a), which is -sin k."""
    shared = lines("sub", lines("sub", "x", "a"), "a")
    lines("sincos", lines("sub", shared, "k"), targets=2)
    both = len(lines.statements) - 1
    lines("sincos", lines("neg", lines("sub", "a", lines("sub", "x", "a"))), targets=2)
    one = len(lines.statements) - 1
    left = lines("mul", f"t{both}a", f"t{one}b")
    return lines("sub", left, lines("mul", f"t{both}b", f"t{one}a"))


def offset(lines: Lines) -> str:
    """sin(a + 1/3 - k) cos(a + 1/3) - cos(a + 1/3 - k) sin(a + 1/3), which is -sin k: a number is a part, too."""
    placed = lines("add", "a", Fraction(1, 3))
    lines("sincos", lines("sub", placed, "k"), targets=2)
    both = len(lines.statements) - 1
    lines("sincos", placed, targets=2)
    one = len(lines.statements) - 1
    left = lines("mul", f"t{both}a", f"t{one}b")
    return lines("sub", left, lines("mul", f"t{both}b", f"t{one}a"))


def fixed(lines: Lines) -> str:
    """The same with sin(a + 1/3) and cos(a + 1/3) made of those of a and of numbers, as of a guide that is turned."""
    sine, cosine = sine_and_cosine(Fraction(1, 3))
    lines("sincos", lines("sub", lines("add", "a", Fraction(1, 3)), "k"), targets=2)
    both = len(lines.statements) - 1
    lines("sincos", "a", targets=2)
    one = len(lines.statements) - 1
    placed = lines("add", lines("mul", f"t{one}a", cosine), lines("mul", f"t{one}b", sine))
    across = lines("sub", lines("mul", f"t{one}b", cosine), lines("mul", f"t{one}a", sine))
    return lines("sub", lines("mul", f"t{both}a", across), lines("mul", f"t{both}b", placed))


@pytest.mark.parametrize("scalar", SCALARS)
@pytest.mark.parametrize("build", [stretched, folded, offset, fixed], ids=lambda build: build.__name__)
def test_angles_that_are_a_little_apart(build: Callable[[Lines], str], scalar: Scalar) -> None:
    """Sines of a sum and of a part of it keep what is between them, as on a leg that is all but stretched."""
    assert_digits_come_back(build, scalar, [{**one, "p": (one["p"][0] * 2.0**-9,)} for one in given(scalar)])


def test_angles_that_sums_are_made_of_have_a_range() -> None:
    """Sums of angles can be small where the angles are not."""
    lines = Lines()
    output = stretched(lines)
    limit = Check(Status.ANGLE_RANGE, Literal(Fraction(100)), Local("a"), inclusive=True)
    wide = widened(lines.kernel(output, checks=(limit,)), "float64")
    interpreter = Interpreter(sincos("float64"), "float64")
    state = {"q": (0.5,), "qd": (1.0, 1.0), "qdd": (), "u": ()}
    assert interpreter.run(wide, state, (0.25,))[0] is Status.OK
    assert interpreter.run(wide, state, (-200.0,))[0] is Status.ANGLE_RANGE


def test_sums_of_angles_of_their_own_stay_as_they_are() -> None:
    lines = Lines()
    sine = lines("sincos", lines("add", "a", "k"), targets=2)
    wide = widened(lines.kernel(sine), "float64")
    assert sum(one.operation == "sincos" for one in wide.statements) == 1


@pytest.mark.parametrize("more", [0, 1])
def test_sums_of_many_angles_are_not_made_of_their_parts(more: int) -> None:
    """Each angle turns by one more: k times an angle would be k turns, whatever a model writes for k."""
    lines = Lines()
    angle = lines("add", "a", "k")
    for _ in range(MOST_PARTS - 2 + more):
        angle = lines("add", angle, "k")
    sine = lines("sincos", angle, targets=2)
    lines("sincos", "a", targets=2)
    one = len(lines.statements) - 1
    wide = widened(lines.kernel(lines("mul", sine, f"t{one}a")), "float64")
    assert (sum(one.operation == "wide_mul" for one in wide.statements) > 4 * (MOST_PARTS - 1)) is not bool(more)


@pytest.mark.parametrize("scalar", SCALARS)
@pytest.mark.parametrize("operation", WIDE.values())
def test_operations_on_pairs(operation: OperationName, scalar: Scalar) -> None:
    """A few eps^2 of the larger operand of a sum, of the result otherwise."""
    source = random.Random(operation)
    plain = next(name for name, wide in WIDE.items() if wide == operation)
    eps = UNIT_ROUNDOFF[scalar]
    function = wide_function(operation, scalar)
    names = [Local(name) for name in function.parameters]
    statements = (Statement(("value", "rest"), operation, tuple(names)),)
    loads = tuple(Load(name.name, "q", place) for place, name in enumerate(names))
    outputs = (Local("value"), Local("rest"))
    kernel = Kernel("f", (Argument("q", len(names)),), loads, (Block(statements, ()),), outputs, (2,))
    interpreter = Interpreter(None, scalar)
    for _ in range(300):
        operands = []
        for _ in names[::2]:
            value = round_literal(Fraction(source.uniform(0.5, 1) * 2.0 ** source.randint(-6, 6)), scalar)
            sign = 1 if operation == "wide_sqrt" else source.choice((-1, 1))
            rest = round_literal(Fraction(value) * eps * Fraction(source.uniform(-0.9, 0.9)), scalar)
            operands += [sign * value, rest]
        _, (value, rest) = interpreter.run(kernel, {"q": operands}, ())
        assert abs(rest) <= 2 * eps * abs(value)
        with precision(300):
            sums = [arb(a) + arb(b) for a, b in zip(operands[::2], operands[1::2], strict=True)]
            exact = EXACT[plain](*sums)
            size = max(map(abs, sums)) if plain in ("add", "sub") else abs(exact)
            assert abs(arb(value) + arb(rest) - exact) < 16 * float(eps) ** 2 * size


def test_nothing_over_nothing_is_zero() -> None:
    interpreter = Interpreter(None, "float64")
    zero = Literal(Fraction(0))
    statement = Statement(("value", "rest"), "wide_ratio_or_zero", (Local("x"), zero, Local("y"), zero))
    loads = (Load("x", "qd", 0), Load("y", "qd", 1))
    kernel = Kernel("f", (Argument("qd", 2),), loads, (Block((statement,), ()),), (Local("value"), Local("rest")), (2,))
    assert interpreter.run(kernel, {"qd": (3.0, 0.0)}, ()) == (Status.OK, [0.0, 0.0])


def test_a_pair_that_is_not_the_same_is_found() -> None:
    """Exactly, a rest is 0 and a value what plain operations give: anything else is refused."""
    lines = Lines()
    plain = lines.kernel(squared(lines))
    wide = widened(plain, "float64")
    statements = list(wide.blocks[1].statements)
    place = next(k for k, one in enumerate(statements) if one.operation == "wide_sub")
    statements[place] = Statement(statements[place].targets, "wide_add", statements[place].operands)
    wrong = replace(wide, blocks=(wide.blocks[0], Block(tuple(statements), ())))
    with pytest.raises(SymgenBug, match="a sign"):
        same_kernel("a sign", Lifted(plain), Lifted(wrong), squares_roots=True)


@pytest.mark.parametrize("scalar", SCALARS)
@pytest.mark.parametrize("build", [*KERNELS, turned, stretched, folded], ids=lambda build: build.__name__)
def test_many_states_have_the_bits_of_one(build: Callable[[Lines], str], scalar: Scalar) -> None:
    lines = Lines()
    last = build(lines)
    limit = Check(Status.CONSTRAINT_RANK, Local(last), Literal(Fraction(0)), first=Block((), (_inner(last),)))
    for kernel in (lines.kernel(last, checks=(limit,)), widened(lines.kernel(last, checks=(limit,)), scalar)):
        for function in (sincos(scalar), None):
            states = [*given(scalar), {"q": (math.nan,), "qd": (math.inf, 0.0), "qdd": (), "u": (), "p": (1.0,)}]
            results = run_many(kernel, function, scalar, states)
            interpreter = Interpreter(function, scalar)
            assert results == [interpreter.run(kernel, one, one["p"]) for one in states]


def _inner(last: str) -> Check:
    return Check(Status.MASS_RANK, Local(last), Literal(Fraction(-1, 10**6)))


def test_sharp_thresholds() -> None:
    """Of multiples of eps and eps^2 as many digits are taken off as pairs of float32 gain; angles keep their range."""
    def kernel(eps: Fraction, largest: int) -> Kernel:
        lines = Lines()
        scaled = lines("mul", 8 * eps, lines("mul", "x", "x"))
        tests = (
            Check(Status.CONSTRAINT_RANK, Local("y"), Literal(24 * eps**2)),
            Check(Status.MASS_RANK, Local("y"), Local(scaled)),
            Check(Status.ANGLE_RANGE, Literal(Fraction(largest)), Local("a"), inclusive=True),
        )
        return lines.kernel(scaled, checks=tests)

    single, double = (kernel(UNIT_ROUNDOFF[s], largest) for s, largest in (("float32", 100), ("float64", 100_000)))
    sharp = with_sharp_thresholds(single, double)
    gained = Fraction(1, 2**LOWERED)
    eps = UNIT_ROUNDOFF["float32"]
    assert sharp.blocks[1].statements[1].operands[0] == Literal(8 * eps * gained)
    first, second, third = sharp.blocks[1].checks
    assert first.limit == Literal(24 * eps**2 * gained**2)
    assert (second, third) == single.blocks[1].checks[1:]


def test_closing_rows_keep_their_thresholds() -> None:
    """Sines of pairs turn an iterate by eps of itself, each time anew: neither rows nor steps get smaller than that."""
    def kernel(eps: Fraction) -> Kernel:
        lines = Lines()
        left, lost = (lines("mul", 64 * eps**2, size) for size in ("x", "y"))
        tests = (
            Check(Status.NOT_CLOSED, Local(left), Local("y")),
            Check(Status.CONSTRAINT_RANK, Local("y"), Local(lost)),
            Check(Status.NOT_CLOSED, Literal(eps / 2), Local("y")),
        )
        return lines.kernel(left, checks=tests)

    single, double = (kernel(UNIT_ROUNDOFF[scalar]) for scalar in ("float32", "float64"))
    sharp = with_sharp_thresholds(single, double)
    eps = UNIT_ROUNDOFF["float32"]
    assert [one.operands[0] for one in sharp.blocks[1].statements] == [
        Literal(64 * eps**2),
        Literal(64 * (eps / 2**LOWERED) ** 2),
    ]
    assert sharp.blocks[1].checks == single.blocks[1].checks
