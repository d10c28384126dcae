"""float32 accelerations of chains keep to theory, section 6, item 9 where the fuzzer found them 17 units off."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping, Sequence

import shipped

from symgen.ir.interpret import Interpreter, round_float32
from symgen.ir.kernel import Program, Scalar, Status
from symgen.lowering.schedule import schedule
from symgen.quantities.select import derive_quantities

Numbers = Sequence[float]
EPS = 2.0**-24
# The chain curls up; beside its light links the forces of 200 N that the rates make are large.
CURLED = (0.652941227, 0.652941227, 0.652917385, -1.4883157, 1.48828125, 1.49995518, 1.48828149, -1.5, 1.49111962)


def result(programs: Mapping[Scalar, Program], scalar: Scalar, arguments: Mapping[str, Numbers], p: Numbers) -> Numbers:
    program = programs[scalar]
    status, values = Interpreter(program.sincos, scalar).run(program.kernels[0], arguments, p)
    assert status is Status.OK
    return values


def test_what_rates_take_of_outer_links_is_not_taken_off_again() -> None:
    """The rule allows 16 units of d + eps |y|; as a force of the coordinates bias costs 17 here, as wrenches 0.8."""
    system = shipped.model("chain16")
    derivations = derive_quantities(system, ("forward_dynamics",))
    programs = schedule(derivations.mechanics, derivations.quantities, shipped.SCALARS)
    q = [*CURLED, *([-1.5] * 7)]
    arguments = {"q": [round_float32(x) for x in q], "qd": [-1.0] * 16, "u": [-1.0] * 15}
    given = {"l": 0.3, "c": 0.1, "m": 0.5, "J": 0.005, "g": 9.81, "x_t": 1.6, "y_t": 1.6}
    p = [round_float32(given[parameter.name]) for parameter in system.parameters]
    y = result(programs, "float64", arguments, p)
    source = random.Random(1)

    def nudged(values: Numbers) -> Numbers:
        return [x * (1 + source.choice((-EPS, EPS))) for x in values]

    changes = (
        result(programs, "float64", {name: nudged(x) for name, x in arguments.items()}, nudged(p)) for _ in range(8)
    )
    d = max(math.dist(y, changed) for changed in changes)
    error = math.dist(y, result(programs, "float32", arguments, p))
    assert error < 4 * (d + EPS * math.hypot(*y))
