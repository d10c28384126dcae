"""What depends on no input is worked out once, with more digits than kernels have."""

from __future__ import annotations

from fractions import Fraction

import pytest
from flint import arb, ctx, fmpq

from symgen.ir.constants import sine_and_cosine, square_root, with_constants_evaluated
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Argument, Block, Check, Kernel, Literal, Load, Local, Statement, Status
from symgen.symbolic.scalar import PI

X = Local("x")


def digits_off(value: Fraction, meant: arb) -> float:
    return float(abs(arb(fmpq(value.numerator, value.denominator)) - meant))


@pytest.mark.parametrize("angle", [Fraction(1, 2), Fraction(-3, 10), 100_000 + Fraction(1, 7), Fraction(0), PI / 3])
def test_sines_and_roots_have_sixty_digits(angle: Fraction) -> None:
    ctx.prec = 400
    sine, cosine = sine_and_cosine(angle)
    given = arb(fmpq(angle.numerator, angle.denominator))
    assert digits_off(sine, given.sin()) < 1e-60
    assert digits_off(cosine, given.cos()) < 1e-60
    assert digits_off(square_root(abs(angle) / 3), (abs(given) / 3).sqrt()) < 1e-60


def kernel(*statements: Statement, checks: tuple[Check, ...] = (), output: str) -> Kernel:
    return Kernel(
        name="inverse_dynamics",
        arguments=(Argument("q", 1),),
        loads=(Load("x", "q", 0),),
        blocks=(Block(statements, checks),),
        outputs=(Local(output),),
        shape=(1,),
    )


def test_only_what_depends_on_an_input_is_left() -> None:
    half = Literal(Fraction(1, 2))
    before = kernel(
        Statement(("size",), "abs", (half,)),
        Statement(("s", "c"), "sincos", (half,)),
        Statement(("t",), "mul", (Local("s"), Local("c"))),
        Statement(("r",), "sqrt", (Local("t"),)),
        Statement(("e",), "exp", (half,)),
        Statement(("y",), "mul", (Local("r"), X)),
        Statement(("z",), "add", (Local("y"), Local("e"))),
        checks=(Check(Status.ANGLE_RANGE, Literal(Fraction(100)), Local("size"), inclusive=True),),
        output="z",
    )
    after = with_constants_evaluated(before)
    assert [statement.operation for statement in after.statements] == ["exp", "mul", "add"]
    assert after.blocks[0].checks == ()
    pair = Statement(("s", "c"), "sincos", (X,))
    whole = kernel(pair, Statement(("z",), "mul", (Local("s"), X)), output="z")
    assert with_constants_evaluated(whole) == whole


def test_what_cannot_be_divided_or_rooted_stays_for_run_time() -> None:
    nothing, below = Literal(Fraction(0)), Literal(Fraction(-1))
    before = kernel(
        Statement(("d",), "div", (below, nothing)),
        Statement(("r",), "sqrt", (below,)),
        Statement(("y",), "add", (Local("d"), Local("r"))),
        output="y",
    )
    assert with_constants_evaluated(before) == before


def test_numbers_are_those_of_the_statements() -> None:
    third = Literal(Fraction(1, 3))
    before = kernel(
        Statement(("a",), "div", (third, Literal(Fraction(7)))),
        Statement(("b",), "sub", (Local("a"), Literal(Fraction(5)))),
        Statement(("c",), "abs", (Local("b"),)),
        Statement(("d",), "neg", (Local("c"),)),
        Statement(("y",), "mul", (Local("d"), X)),
        output="y",
    )
    after = with_constants_evaluated(before)
    assert [statement.operation for statement in after.statements] == ["mul"]
    results = [Interpreter(None).run(one, {"q": (1.0,)}, ()) for one in (before, after)]
    assert abs(results[1][1][0] - (1 / 21 - 5)) <= 1e-15
    assert abs(results[1][1][0] - results[0][1][0]) <= 2e-15
