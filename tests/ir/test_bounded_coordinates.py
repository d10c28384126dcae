"""Bounds of coordinates are checked when a kernel is called, before anything else."""

from __future__ import annotations

from fractions import Fraction

import pytest

from symgen.ir.bounded import Bound, bounded, bounds_of
from symgen.ir.bounded_coordinates import CoordinateBound, coordinate_bounds_of, within
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Argument, Block, Check, Kernel, Literal, Load, Local, Statement, Status

# y = m / x
ARGUMENTS = (Argument("q", 2),)
ROWS = Statement(("y",), "div", (Local("m"), Local("x")))
CHECK = Check(Status.MASS_RANK, Local("m"), Literal(Fraction(0)))
LOADS = (Load("x", "q", 0), Load("m", "p", 0, "m"))
PLAIN = Kernel("k", ARGUMENTS, LOADS, (Block((ROWS,), (CHECK,)),), (Local("y"),), (1,))
COORDINATES = ("x", "z")
BOUNDS = (CoordinateBound("x", Fraction(1, 2), Fraction(4)), CoordinateBound("z", None, Fraction(2)))


@pytest.mark.parametrize(
    ("x", "z", "status"),
    [
        (0.5, 2.0, Status.OK),
        (4.0, -9.0, Status.OK),
        (0.49999, 0.0, Status.COORDINATE_RANGE),
        (4.00001, 0.0, Status.COORDINATE_RANGE),
        (1.0, 2.00001, Status.COORDINATE_RANGE),
        (float("nan"), 0.0, Status.COORDINATE_RANGE),
        (1.0, float("nan"), Status.COORDINATE_RANGE),
    ],
)
def test_beyond_a_bound_is_a_status_of_any_coordinate(x: float, z: float, status: Status) -> None:
    made = within(PLAIN, BOUNDS, COORDINATES)
    assert Status(Interpreter(None, "float64").run(made, {"q": (x, z)}, (3.0,))[0]) is status


def test_bounds_are_read_back_beside_those_of_parameters() -> None:
    made = bounded(within(PLAIN, BOUNDS, COORDINATES), (Bound("m", None, Fraction(9)),), ("m",), {"m"})
    assert tuple(coordinate_bounds_of(made, COORDINATES)) == BOUNDS
    assert [bound.parameter for bound, _ in bounds_of(made)] == ["m"]
    assert list(coordinate_bounds_of(PLAIN, COORDINATES)) == []
    assert within(PLAIN, (), COORDINATES) is PLAIN


def test_a_coordinate_that_is_not_read_has_a_name_of_its_own() -> None:
    clash = Kernel("k", ARGUMENTS, (*LOADS, Load("place_1", "p", 1, "l")), PLAIN.blocks, PLAIN.outputs, (1,))
    made = within(clash, BOUNDS, COORDINATES)
    assert [load.local for load in made.loads] == ["x", "m", "place_1", "place_1_"]
