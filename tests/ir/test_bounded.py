"""Kernels that refuse parameters beyond bounds, before anything else is looked at."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from symgen.ir.bounded import Bound, bounded, bounds_of
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Argument, Block, Check, Kernel, Literal, Load, Local, Statement, Status

NOTHING = Literal(Fraction(0))
# y = q m / c, which has a status of its own for c that vanishes
PLAIN = Kernel(
    name="y",
    arguments=(Argument("q", 1),),
    loads=(Load("q0", "q", 0), Load("m", "p", 0, "mass"), Load("c", "p", 1, "size_of_offset")),
    blocks=(
        Block((Statement(("t1",), "abs", (Local("c"),)),), (Check(Status.MASS_RANK, Local("t1"), NOTHING),)),
        Block((Statement(("t2",), "mul", (Local("q0"), Local("m"))),), ()),
        Block((Statement(("t3",), "mul", (Local("q0"), Local("m"))),), ()),
        Block((Statement(("t4",), "div", (Local("t2"), Local("c"))),), ()),
    ),
    outputs=(Local("t4"),),
    shape=(1,),
)
PARAMETERS = ("mass", "size_of_offset", "reach")
BOUNDS = (Bound("mass", None, Fraction(40)), Bound("size_of_offset", Fraction(1, 4), Fraction(8)))


def status_of(kernel: Kernel, mass: float, offset: float) -> Status:
    return Status(Interpreter(None, "float64").run(kernel, {"q": (3.0,)}, (mass, offset))[0])


@pytest.mark.parametrize(
    ("mass", "offset", "status"),
    [
        (40.0, 8.0, Status.OK),
        (1.0, 0.25, Status.OK),
        (1.0, -0.25, Status.OK),
        (1.0, -8.0, Status.OK),
        (40.000001, 1.0, Status.PARAMETER_RANGE),
        (1.0, 8.000001, Status.PARAMETER_RANGE),
        (1.0, -8.000001, Status.PARAMETER_RANGE),
        (1.0, 0.2499999, Status.PARAMETER_RANGE),
        (1.0, 0.0, Status.PARAMETER_RANGE),
        (float("nan"), 1.0, Status.PARAMETER_RANGE),
    ],
)
def test_beyond_a_bound_is_a_status(mass: float, offset: float, status: Status) -> None:
    assert status_of(bounded(PLAIN, BOUNDS, PARAMETERS, {"mass"}), mass, offset) is status


def test_a_parameter_that_is_positive_is_compared_as_it_is() -> None:
    made = bounded(PLAIN, BOUNDS, PARAMETERS, {"mass", "size_of_offset"})
    assert not any(block.statements for block in made.blocks[: len(BOUNDS)])
    assert status_of(made, 1.0, -1.0) is Status.PARAMETER_RANGE


def test_a_parameter_that_the_kernel_does_not_read() -> None:
    made = bounded(PLAIN, (Bound("reach", None, Fraction(5)),), PARAMETERS, {"reach"})
    statuses = [Interpreter(None, "float64").run(made, {"q": (3.0,)}, (1.0, 1.0, reach))[0] for reach in (5.0, 5.1)]
    assert statuses == [Status.OK, Status.PARAMETER_RANGE]


def test_bounds_are_read_back() -> None:
    made = bounded(PLAIN, BOUNDS, PARAMETERS, {"mass"})
    assert list(bounds_of(made)) == [(BOUNDS[0], False), (BOUNDS[1], True)]
    assert list(bounds_of(PLAIN)) == []


@pytest.mark.parametrize("read", [True, False])
def test_new_names_are_new(read: bool) -> None:
    loads = (PLAIN.loads[0], PLAIN.loads[1], Load("c", "p", 1, "offset"))
    taken = replace(PLAIN, loads=(*loads, Load("size_of_c", "p", 2, "size_of_c")) if read else loads)
    bounds = (Bound("offset", None, Fraction(8)), Bound("size_of_c", None, Fraction(8)))
    made = bounded(taken, bounds, ("mass", "offset", "size_of_c"), {"size_of_c"})
    names = [target for statement in made.statements for target in statement.targets]
    names += [load.local for load in made.loads]
    assert len(names) == len(set(names))
