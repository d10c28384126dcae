"""The witness against known equations, and against kernels that were tampered with."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import yaml

from symgen.generation.results import Options
from symgen.laboratory.zoo.draws.families import draw
from symgen.laboratory.zoo.run import run_command
from symgen.laboratory.zoo.witness import states
from symgen.laboratory.zoo.witness.allocation import is_directed
from symgen.laboratory.zoo.witness.generated import Answer, Target
from symgen.laboratory.zoo.witness.kkt import EquationValues, GenericRanks
from symgen.laboratory.zoo.witness.numbers.fields import Balls, Floats, precision
from symgen.laboratory.zoo.witness.numbers.linear import basis
from symgen.laboratory.zoo.witness.numbers.tape import NodeProgram, NodeTape
from symgen.laboratory.zoo.witness.reading.expressions import FUNCTIONS, NotReadError, read_expression
from symgen.laboratory.zoo.witness.reading.mechanics import equations
from symgen.laboratory.zoo.witness.reading.reader import SystemReader
from symgen.laboratory.zoo.witness.states import CLOSED, FloatState
from symgen.laboratory.zoo.witness.witness import Witness
from symgen.pipeline import generate

SYSTEM = """
model: cart
coordinates: {x: {unit: m}, a: {unit: rad}}
parameters: {m: 2, l: 0.7, k: 30}
kinetic_energy: 3/2*x_dot**2 + m/2*((x_dot + l*cos(a)*a_dot)**2 + (l*sin(a)*a_dot)**2)
potential_energy: k/2*x**2 - m*9.81*l*cos(a)
constraints: {geometric: {link: x + 0.2*sin(a) - 0.1}}
inputs: {f: {acts_on: {x: 1, a: x}}, g: {acts_on: {a: 1}}}
outputs: [inverse_dynamics, forward_dynamics, multipliers]
configuration: {x: 0, a: 0.5235987755982988}
"""
BODIES = """
model: cart
joints:
  slide: {type: prismatic, axis: x, coordinate: x}
  swing: {type: revolute, axis: z, parent: slide, coordinate: a}
parameters: {m: 2, l: 0.7, k: 30}
gravity: [0, -9.81, 0]
bodies:
  slide: {mass: 3}
  swing: {mass: m, com: [0, -l, 0]}
points: {tip: {frame: swing, at: [0, -0.2, 0]}}
springs: {coil: {joint: x, stiffness: k}}
constraints: {geometric: {link: tip.x - 0.1}}
inputs: {f: {acts_on: {x: 1, a: x}}, g: {torque_on: swing, direction: [0, 0, 1], reaction: slide}}
outputs: [inverse_dynamics, forward_dynamics, multipliers]
"""
VALUES = {"x": 0.3, "a": 0.6, "x_dot": -0.4, "a_dot": 1.1, "m": 2.0, "l": 0.7, "k": 30.0}


def flat(text: str) -> list[float]:
    """All entries of the equations of motion."""
    system = SystemReader(yaml.load(text, Loader=yaml.BaseLoader))
    return system.tape.evaluate(equations(system).flat, VALUES, Floats())


def test_equations_of_a_cart_with_a_pendulum() -> None:
    x, a, _, w = (VALUES[name] for name in ("x", "a", "x_dot", "a_dot"))
    m, l_, k = VALUES["m"], VALUES["l"], VALUES["k"]
    sine, cosine = math.sin(a), math.cos(a)
    expected = [
        *(3 + m, m * l_ * cosine, m * l_ * cosine, m * l_**2),
        *(1, 0.2 * cosine),
        *(1, 0, x, 1),
        *(-m * l_ * sine * w**2 + k * x, m * 9.81 * l_ * sine),
        -0.2 * sine * w**2,
        x + 0.2 * sine - 0.1,
    ]
    assert flat(SYSTEM) == pytest.approx(expected, rel=1e-14)


def test_bodies_and_energies_give_the_same_equations() -> None:
    assert flat(BODIES) == pytest.approx(flat(SYSTEM), rel=1e-13)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_derivatives_of_every_function(name: str) -> None:
    tape = NodeTape()
    text = "atan2(z/3 + 1, z*z - 2)" if name == "atan2" else f"{name}(z/3 + 0.2*z**(3/2) - 0.1)/z"
    node = read_expression(tape, text, tape.symbol)
    (by_sweep,) = tape.gradient(node, ["z"])
    along = tape.derivative(node, {"z": tape.one}, "z")
    (second,) = tape.gradient(by_sweep, ["z"])
    with precision():
        balls = Balls()
        step, place = Fraction(1, 10**30), Fraction(7, 10)

        def at(shift: int) -> object:
            return tape.evaluate([node], {"z": balls.number(place + shift * step)}, balls)[0]

        width = balls.number(step)
        slope = (at(1) - at(-1)) / (2 * width)
        curve = (at(1) - 2 * at(0) + at(-1)) / (width * width)
        values = tape.evaluate([by_sweep, along, second], {"z": balls.number(place)}, balls)
        assert float((values[0] - slope).mid()) == pytest.approx(0, abs=1e-50)
        assert float((values[1] - slope).mid()) == pytest.approx(0, abs=1e-50)
        assert float((values[2] - curve).mid()) == pytest.approx(0, abs=1e-30)


def test_equal_numbers_of_a_file_are_rounded_each_alone() -> None:
    tape = NodeTape()
    node = read_expression(tape, "0.3*x - 0.3*y + 2*x - 2*y", tape.symbol)
    program = NodeProgram(tape, [node])
    assert [literal.value for literal in program.literals] == [Fraction(3, 10)] * 2
    first, second = program.literals
    values = {"x": 1.0, "y": 1.0}
    assert program.run(values, Floats(), {first: 0.5, second: 0.25}) == [0.25]
    assert program.run(values, Floats()) == [0.0]


def test_literals_are_exact() -> None:
    tape = NodeTape()
    node = read_expression(tape, "0.1 + 2**-1*x", tape.symbol)
    assert {each.number for each in tape.nodes} >= {Fraction(1, 10), Fraction(2)}
    assert tape.evaluate([node], {"x": 0.0}, Floats()) == [0.1]


@pytest.mark.parametrize(
    "text", ["__import__('os')", "x.__class__.y", "[x]", "x if x else x", "x**y", "open(x)", "x + 'a'"]
)
def test_other_python_is_not_read(text: str) -> None:
    tape = NodeTape()
    with pytest.raises((NotReadError, ValueError, KeyError)):
        read_expression(tape, text, {"x": tape.symbol("x"), "y": tape.symbol("y")}.__getitem__)


@pytest.fixture(scope="module")
def generated(tmp_path_factory: pytest.TempPathFactory, tool: Callable[[str], str]) -> Path:
    """The folder of the cart, verified."""
    tool("gcc")
    folder = tmp_path_factory.mktemp("cart")
    (folder / "cart.yaml").write_text(SYSTEM)
    run = run_command(folder / "cart.yaml", folder / "out")
    assert run.code == 0, run.err
    return folder / "out" / "cart"


@pytest.mark.slow
def test_generated_numbers_are_right(generated: Path) -> None:
    checked = Witness(SYSTEM).check(generated)
    assert checked.states == 20
    assert checked.findings == ()
    assert 0 < checked.largest < 1
    compared = checked.coverage
    assert compared.quantities == ("inverse_dynamics", "forward_dynamics", "multipliers")
    assert (compared.lack, compared.missing, compared.unknown) == ("", (), 0)
    # of Python and of the C of both types
    assert compared.numbers + compared.statuses == 20 * 3 * 3


@pytest.mark.slow
def test_a_wrong_number_and_a_false_status_are_found(generated: Path, tmp_path: Path) -> None:
    source = (generated / "c" / "cart.c").read_text()
    folder = tmp_path / "cart"
    (folder / "c").mkdir(parents=True)
    for name in ("c/cart.h", "derivation.json"):
        (folder / name).write_text((generated / name).read_text())
    body = source.index("cart_inverse_dynamics(")
    stored = re.compile(r"( u\[0\] = )([^;]+);")
    assert stored.search(source, body)
    for wrong, kind in (
        (r"\1(\2)*(1 + 1e-12);", "witness: number"),
        (r"return CART_ACTUATION_RANK;", "witness: status"),
    ):
        (folder / "c" / "cart.c").write_text(source[:body] + stored.sub(wrong, source[body:], count=1))
        checked = Witness(SYSTEM).check(folder)
        assert [finding.kind for finding in checked.findings] == [kind]
        assert "inverse_dynamics" in checked.findings[0].text


WHEEL = """
model: hopper
coordinates: {x: {unit: m}, z: {unit: m}, spin: {unit: rad}, swing: {unit: rad}}
gravity: [0, 0, -9.81]
frames:
  hub: {translation: [x, 0, 0.3 + z]}
  wheel: {parent: hub, rotation: [[y, spin]]}
  arm: {parent: hub, rotation: [[y, swing]]}
bodies:
  wheel: {mass: 3, inertia: {yy: 0.1}}
  arm: {mass: 1.5, com: [0, 0, -0.4], inertia: {yy: 0.02}}
rolling: {ground: {frame: wheel, radius: 0.25}}
inputs:
  hold: {torque_on: arm, direction: [0, 1, 0], reaction: wheel}
  push: {acts_on: {x: 1}}
  drive: {torque_on: wheel, direction: [0, 1, 0]}
allocation: {weights: {push: 2}, preload: 3, limits: {drive: [-1, 1]}}
outputs: [inverse_dynamics, forward_dynamics, multipliers]
configuration: {z: -0.05}
"""


def test_a_wheel_that_could_lift_is_held() -> None:
    """Rows in the order of the documentation: the height first, then along; nothing is said across the plane."""
    system = SystemReader(yaml.load(WHEEL, Loader=yaml.BaseLoader))
    assert [row.name for row in system.rows] == ["ground_height", "ground_along"]
    derived = equations(system)
    values = dict.fromkeys((*system.coordinates, *system.rate_names), 0.2)
    rows = [system.tape.evaluate(row, values, Floats()) for row in derived.rows]
    assert rows[0] == pytest.approx([0, 1, 0, 0])
    assert rows[1] == pytest.approx([1, 0, -0.25, 0])


@pytest.mark.campaign
def test_multipliers_of_wheels_and_limited_inputs_are_compared(tmp_path: Path, tool: Callable[[str], str]) -> None:
    tool("gcc")
    (tmp_path / "hopper.yaml").write_text(WHEEL)
    run = run_command(tmp_path / "hopper.yaml", tmp_path / "out")
    assert run.code == 0, run.err
    checked = Witness(WHEEL).check(tmp_path / "out" / "hopper", count=8)
    assert checked.states == 8
    assert checked.findings == ()


HINGE = """
model: hinge_in_ball
joints:
  ball: {type: spherical, coordinates: [e_0, e_1, e_2, e_3]}
  fold: {type: revolute, parent: ball, at: [0.4, 0, 0], axis: x, coordinate: a}
  slot: {type: prismatic, parent: ball, at: [0.4, 0, 0], axis: y, coordinate: s}
frames:
  dock: {parent: slot, translation: [0, 0.2, 0], rotation: [[x, 0.9]]}
bodies:
  ball: {mass: 2, com: [0.2, 0, 0], inertia: {xx: 0.2, yy: 0.3, zz: 0.4}}
  fold: {mass: 1, com: [0, 0.3, 0.1], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
  slot: {mass: 1, inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
gravity: [0, 0, -9.81]
points:
  pin: {frame: fold, at: [0, 0.2, 0]}
loops:
  hold: {type: planar, between: [fold, dock], axis: y}
inputs:
  drive: {joint: s}
outputs: [inverse_dynamics, multipliers]
configuration: {e_0: 1, e_1: 0, e_2: 0, e_3: 0, a: 0.9, s: -0.2}
"""


def test_rows_that_hold_in_every_configuration_have_no_multipliers(tmp_path: Path) -> None:
    """Both axes of the loop are held along one x by the joints before it, wherever the ball turns."""
    assert len(SystemReader(yaml.load(HINGE, Loader=yaml.BaseLoader)).rows) == 4
    (tmp_path / "hinge.yaml").write_text(HINGE)
    made = generate(tmp_path / "hinge.yaml", Options(parts=("python",), verify=False), lambda _: None)
    for name, content in made.files.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    checked = Witness(HINGE).check(tmp_path, count=4)
    assert checked.states == 4
    assert checked.findings == ()


RADIAL = """
model: radial
joints:
  turn: {type: revolute, axis: z, coordinate: a}
  slide: {type: prismatic, axis: x, coordinate: s}
bodies: {turn: {mass: 2, com: [0.3, 0, 0], inertia: {zz: 0.1}}, slide: {mass: 1}}
points: {rim: {frame: turn, at: [0.32, 0, 0]}}
inputs:
  pull: {point: rim, direction: [1, 0, 0], axes: turn}
  push: {joint: s}
outputs: [inverse_dynamics]
"""


def test_what_rounding_leaves_of_an_idle_input_spans_nothing() -> None:
    _, ranks = Witness(RADIAL, {"a": 0.7}).walker().states({}, 6)
    assert ranks.actuation == 1


def test_what_rounding_leaves_of_a_row_that_is_zero_is_no_row() -> None:
    """Beside two rows that are nearly parallel it has all of its length left (draw 1115:253)."""
    held, shares = basis([[1.0, 0.0, 0.0], [0.0, 1e-8, 0.0], [0.999, 0.0, 0.04]], 2)
    assert [[abs(x) for x in vector] for vector in held] == [[1, 0, 0], [0, 0, 1]]
    assert shares == pytest.approx([1, 0.04], rel=1e-3)
    # a short row of its own comes before what rounding leaves of a long one that follows from others
    held, _ = basis([[1e-6, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1e3, 1e-5]], 2)
    assert [max(vector, key=abs) for vector in held] == pytest.approx([1, 1])
    assert abs(held[1][0]) == 1


LINK_AS_ROD = """
model: link_as_rod
coordinates: {a: {unit: rad}, b: {unit: rad}}
definitions: {x: 0.5*cos(a), y: 0.5*sin(a), x_tip: x + 0.18*cos(b), y_tip: y + 0.18*sin(b)}
kinetic_energy: 0.3*a_dot**2 + 0.2*b_dot**2
constraints:
  geometric:
    rod: 1e6*((x_tip - x)**2 + (y_tip - y)**2 - 0.0324)
    hold: x - 0.25
    again: (1e6*((x_tip - x)**2 + (y_tip - y)**2 - 0.0324)) + 200*(x - 0.25)
"""


def test_a_rod_between_the_ends_of_a_link_is_no_row_in_small_units() -> None:
    """Rounding leaves 1e-11 of its gradient, which is 0 (draw 2901:824)."""
    states, ranks = Witness(LINK_AS_ROD, {"a": 1.047, "b": 0.4}).walker().states({}, 6)
    assert len(states) == 6
    assert ranks.constraints == 1


def test_powers_of_what_may_be_zero() -> None:
    """The square of a speed that is 0 but for its digits is a number."""
    balls = Balls()
    with precision():
        nothing = balls.number(Fraction(1, 3)) - balls.number(Fraction(1, 3))
        assert abs(float(balls.power(nothing, Fraction(2)).mid())) < 1e-60
        for exponent in (3, -3, Fraction(1, 2), Fraction(-3, 2), Fraction(1, 3)):
            value = balls.power(balls.number(Fraction(5, 2)), Fraction(exponent))
            assert float(value.mid()) == pytest.approx(2.5 ** float(exponent), rel=1e-14)


# y is 1 or -1; only where it is 1 the input moves x
TWO = """model: two
coordinates: {x: {unit: m, range: [-1, 1]}, y: {unit: m, range: [-2, 2]}}
parameters: {m: {value: 2, unit: kg}, l: {value: 1, unit: m}}
kinetic_energy: m/2*(x_dot**2 + y_dot**2)
constraints: {geometric: {kept: y**2 - l**2}}
inputs: {u: {unit: N, acts_on: {x: 1 + y/l}}}
configuration: {x: 0.3, y: -1}
outputs: [inverse_dynamics, forward_dynamics]
"""


@pytest.mark.campaign
def test_a_branch_on_which_inputs_span_less_has_a_status(tmp_path: Path, tool: Callable[[str], str]) -> None:
    """It is told; what the kernel answers there is no false status, whether it is this one is looked at."""
    tool("gcc")
    model = tmp_path / "two.yaml"
    model.write_text(TWO, encoding="utf-8")
    run = run_command(model, tmp_path / "out")
    assert "another branch of configurations" in run.err
    witness = Witness(TWO, {"x": 0.3, "y": -1.0})
    checked = witness.check(tmp_path / "out/two")
    assert checked.states
    assert checked.findings == ()
    json_file = tmp_path / "out/two/derivation.json"
    text = json_file.read_text(encoding="utf-8")
    json_file.write_text(text.replace('"alpha": 1', '"alpha": 0'), encoding="utf-8")
    (finding, *_) = Witness(TWO, {"x": 0.3, "y": -1.0}).check(tmp_path / "out/two").findings
    assert finding.kind == "witness: status"


def test_a_walk_that_does_not_leave_a_singular_start_compares_nothing() -> None:
    """Three cranks of a parallelogram along its base: two rows vanish there, and rounding gave them a rank."""
    text = """model: cranks
joints:
  c_0: {type: revolute, axis: z, coordinate: a_0}
  c_1: {type: revolute, axis: z, at: [0.25, 0, 0], coordinate: a_1}
  c_2: {type: revolute, axis: z, at: [0.5, 0, 0], coordinate: a_2}
  bar: {type: revolute, axis: z, parent: c_0, at: [0.32, 0, 0], coordinate: b}
bodies: {c_0: {mass: 1, inertia: {zz: 0.1}}}
points:
  tip_1: {frame: c_1, at: [0.32, 0, 0]}
  end_1: {frame: bar, at: [0.25, 0, 0]}
  tip_2: {frame: c_2, at: [0.32, 0, 0]}
  end_2: {frame: bar, at: [0.5, 0, 0]}
loops:
  p_1: {type: point, between: [end_1, tip_1]}
  p_2: {type: point, between: [end_2, tip_2]}
inputs: {u: {joint: a_0}}
configuration: {a_0: 0, a_1: 0, a_2: 0, b: 0}
"""
    for start, expected in (({}, 0), ({"a_0": 0.7, "a_1": 0.7, "a_2": 0.7, "b": -0.7}, 3)):
        witness = Witness(text, start)
        walker = witness.walker()
        visited, ranks = walker.states(witness.defaults(), 5)
        assert (len(visited), ranks.constraints) == (5 if expected else 0, expected)
        assert walker.lack == ("" if expected else states.STUCK)


def test_a_walk_whose_every_step_is_lost_at_a_singular_start_compares_nothing() -> None:
    """The row holds to rounding where its gradient vanishes, and nowhere else, as that of a locked loop may."""
    text = """model: speck
coordinates: {a: {}, b: {}}
kinetic_energy: (a_dot**2 + b_dot**2)/2
constraints: {geometric: {speck: 1 - cos(a) + 1e-15}}
outputs: [forward_dynamics]
"""
    witness = Witness(text, {"a": 0.0, "b": 0.4})
    walker, defaults = witness.walker(), witness.defaults()
    assert not walker.points(defaults, 8)
    assert walker.states(defaults, 5)[0] == []
    assert walker.lack == states.STUCK


def test_a_number_that_is_0_to_all_digits_of_the_witness_is_right() -> None:
    """A wheel about its own centre of mass never speeds up; what balls leave of that is no truth to be missed."""
    text = """model: flywheel
joints: {turn: {type: revolute, axis: [0.3, 0.7, 0.9], rotation: [[y, 0.4]], coordinate: a}}
bodies: {turn: {mass: 3, inertia: {xx: 0.1, yy: 0.2, zz: 0.25}}}
gravity: [0, -9.81, 0]
outputs: [forward_dynamics]
"""
    witness = Witness(text, {"a": 0.7})
    visited, ranks = witness.walker().states(witness.defaults(), 4)

    def answering(value: float) -> Target:
        return Target("made up", "float64", ("forward_dynamics",), (), lambda *_: Answer(0, (value,)))

    for state in visited:
        judged = [witness.compare(answering(value), "forward_dynamics", state, ranks) for value in (0.0, 1e-30)]
        right, wrong = (one.units for one in judged if one is not None)
        assert right == 0
        assert wrong > 1e3


def test_what_roundings_move_by_their_squares_alone_is_held_against_squares() -> None:
    """A sum of rates that rows hold at 0 is within 13 roundings of it; an acceleration is its square."""
    text = """model: idle
coordinates: {a: {unit: rad}, b: {unit: rad}, x: {unit: m}}
kinetic_energy: (a_dot**2 + b_dot**2 + x_dot**2)/2
constraints: {geometric: {both: x - sin(a + b), still: a + b - 0.7}}
outputs: [forward_dynamics]
configuration: {a: 0.4, b: 0.3, x: 0.644217687237691}
"""
    witness = Witness(text)
    visited, ranks = witness.walker().states(witness.defaults(), 20)
    eps = 2.0**-53
    for state in visited:
        off = state.qd[0] + state.qd[1]
        rest = 13 * eps * abs(state.qd[0])
        due = -math.sin(state.q[0] + state.q[1]) * (abs(off) + rest) ** 2
        answers = (0.0, 0.0, due), (0.0, 0.0, 1e6 * due)
        units = []
        for answer in answers:
            target = Target("made up", "float64", ("forward_dynamics",), (), lambda *_, x=answer: Answer(0, x))
            judged = witness.compare(target, "forward_dynamics", state, ranks)
            assert judged is not None
            units.append(judged.units)
        right, wrong = units
        assert right <= 1 < wrong


@pytest.mark.parametrize(("off", "known"), [(0.0, ("float64", "float32")), (1e-9, ("float32",)), (1e-3, ())])
def test_where_rows_that_depend_on_v_differ_there_is_no_truth(off: float, known: tuple[str, ...]) -> None:
    """Two sheets touch along x = y = 0: beside it the second row is another one, and which is left out decides."""
    text = """model: touching
coordinates: {x: {unit: m}, y: {unit: m}, z: {unit: m}}
kinetic_energy: (x_dot**2 + y_dot**2 + z_dot**2)/2
constraints: {geometric: {floor: y, hill: y + x**2/2}}
outputs: [forward_dynamics]
configuration: {x: 0, y: 0, z: 0}
"""
    witness, ranks = Witness(text), GenericRanks(1, 0, (1.0, 1.0), 1)
    state = FloatState((off, 0.0, 0.3), (0.0, 0.0, 0.4), (), (), ())
    judged = []
    for scalar in ("float64", "float32"):
        target = Target("made up", scalar, ("forward_dynamics",), (), lambda *_: Answer(0, (0.0, 0.0, 0.0)))
        if witness.compare(target, "forward_dynamics", state, ranks) is not None:
            judged.append(scalar)
    assert tuple(judged) == known


def test_what_steps_leave_of_a_root_at_0_is_0() -> None:
    """A slide along a fixed rail never turns: what refinement leaves of a quaternion off by 1e-9 is small, not 0."""
    text = """model: slide
frames: {rail: {translation: [0.3, 0.2, 0.5], rotation: [[[1.0, 0.0, 0.0], 0.9272952180016122]]}}
joints: {j: {type: floating, coordinates: [x, y, z, e_0, e_1, e_2, e_3]}}
bodies: {j: {mass: 2, inertia: {xx: 0.1, yy: 0.2, zz: 0.25}}}
loops: {on_rail: {type: prismatic, between: [j, rail], axis: x}}
outputs: [forward_dynamics]
"""
    turned = {"e_0": 0.8944271909999159, "e_1": 0.4472135954999579, "e_2": 0.0, "e_3": 0.0}
    start = {"x": 0.3, "y": 0.2, "z": 0.5, **turned}
    witness = Witness(text, start)
    visited, _ = witness.walker().states(witness.defaults(), 6)
    assert len(visited) == 6
    assert all(x == 0 or abs(x) > 1e-30 for state in visited for x in state.q)
    off = np.array([*{**start, "e_2": 1e-9, "e_3": -2e-9}.values()])
    assert witness.walker().refined(off, witness.defaults())[5:].tolist() == [0.0, 0.0]


def test_an_internal_force_has_no_direction_where_files_have_rows_that_depend_on_each_other() -> None:
    """A row that holds nothing, 1e-17 long, is left out by the file or one of those that depend on each other."""
    rows, control = [[1.0, 0.0], [0.0, 1e-17]], [[0.0, 0.0], [1.0, 1.0]]
    at = EquationValues([[1.0, 0.0], [0.0, 1.0]], rows, control, [0.0, 0.0], [], [])
    ranks = GenericRanks(1, 1, (1.0, 1e-17))
    assert is_directed(at, ranks)
    assert is_directed(at, replace(ranks, kept=1))
    assert not is_directed(at, replace(ranks, kept=2))


# two rods that stay within 2e-3 of one line: regular, and float32 cannot tell
FLAT = """
model: flat
coordinates: {x: {unit: m}, y: {unit: m}, z: {unit: m}}
kinetic_energy: x_dot**2 + y_dot**2 + z_dot**2
constraints: {geometric: {one: x + y - 1, two: x + 1.004*y + 0.003*z - 1}}
inputs: {f: {acts_on: {x: 1}}}
outputs: [forward_dynamics]
configuration: {x: 1, y: 0, z: 0}
"""


@pytest.mark.campaign
def test_statuses_that_are_passed_over_are_counted(tmp_path: Path) -> None:
    (tmp_path / "flat.yaml").write_text(FLAT)
    run = run_command(tmp_path / "flat.yaml", tmp_path / "out")
    assert run.code == 0, run.err
    checked = Witness(FLAT).check(tmp_path / "out" / "flat", count=4)
    assert checked.findings == ()
    compared = checked.coverage
    assert (compared.states, compared.missing) == (4, ("inverse_dynamics", "multipliers"))
    assert compared.numbers + compared.statuses == 4 * 3


def test_a_walk_that_loses_its_steps_is_taken_up_again(monkeypatch) -> None:
    """A slide with little room: most steps would leave it."""
    text = """model: slide
coordinates: {x: {unit: m}, y: {unit: m}}
kinetic_energy: x_dot**2 + y_dot**2
ranges: {x: [-0.1, 0.1], y: [-0.3, 0.3]}
"""
    witness = Witness(text)
    walker = witness.walker()
    visited, _ = walker.states({}, 20)
    assert (len(visited), walker.lack) == (20, "")
    monkeypatch.setattr(states, "WALKS", 1)
    walker = witness.walker()
    visited, _ = walker.states({}, 20)
    assert 0 < len(visited) < 20
    assert walker.lack == states.LOST_STEPS


def test_the_only_input_may_move_nothing() -> None:
    """A force along the lever that it pulls at: what rounding leaves of its moment is no direction."""
    text = """model: lever
gravity: [0, -9.81, 0]
joints: {hinge: {type: revolute, axis: z, child: lever, coordinate: a}}
bodies: {lever: {mass: 2, com: [0.7, 0, 0], inertia: {zz: 0.1}}}
points: {end: {frame: lever, at: [1.3, 0, 0]}}
inputs: {pull: {point: end, direction: [1, 0, 0], axes: lever}}
"""
    witness = Witness(text, {"a": 2.66})
    _, ranks = witness.walker().states(witness.defaults(), 5)
    assert ranks.actuation == 0


def test_refinement_ends_on_the_constraints_beside_a_flat_pose() -> None:
    """Rows are as short there as the way to where they vanish: three steps leave a thousandth of it."""
    text = """model: cranks
coordinates: {a: {}, b: {}, c: {}}
parameters: {m: {value: 1}}
kinetic_energy: m/2*(a_dot**2 + b_dot**2 + c_dot**2)
constraints:
  geometric:
    along: 0.67*cos(a) + cos(c) - 1 - 0.67*cos(b)
    across: 0.67*sin(a) + sin(c) - 0.67*sin(b)
outputs: [forward_dynamics]
"""
    witness = Witness(text, {"a": -0.61, "b": -0.61, "c": 0.0})
    walker, defaults = witness.walker(), witness.defaults()
    a, b, c = walker.refined(np.array([4e-9, 5.9e-9, 1e-9]), defaults)
    assert c == 0.0
    assert abs(a - b) < 1e-22
    assert 2e-9 < a < 8e-9


def test_rows_that_all_but_vanish_are_a_reason_for_a_status() -> None:
    """1e-7 off a flat pose rows are 1e-7 as long as elsewhere: float32 may refuse them, float64 may not at 0.01."""
    text = """model: cranks
coordinates: {a: {}, b: {}, c: {}}
kinetic_energy: (a_dot**2 + b_dot**2 + c_dot**2)/2
constraints:
  geometric:
    along: 0.67*cos(a) + cos(c) - 1 - 0.67*cos(b)
    across: 0.67*sin(a) + sin(c) - 0.67*sin(b)
inputs: {u: {acts_on: {a: 1}}}
outputs: [forward_dynamics]
"""
    witness = Witness(text, {"a": -0.61, "b": -0.61, "c": 0.0})
    walker, defaults = witness.walker(), witness.defaults()
    _, ranks = walker.states(defaults, 6)
    assert ranks.lengths[0] > 0.1

    def refused(a: float, scalar: str) -> bool:
        """Whether a status there is false."""
        target = Target("made up", scalar, ("forward_dynamics",), (), lambda *_: Answer(2, ()))
        state = walker.state(walker.refined(np.array([a, a, 0.0]), defaults), defaults)
        judged = witness.compare(target, "forward_dynamics", state, ranks)
        assert judged is not None
        assert judged.clear > 0.1
        return judged.certain

    assert [refused(a, "float32") for a in (1e-7, 0.01, 0.5)] == [False, False, True]
    assert [refused(a, "float64") for a in (1e-7, 0.01, 0.5)] == [False, True, True]


def test_lengths_far_apart_are_no_singular_configuration() -> None:
    """A rod of 1e-4 between long ones: rows are less than a thousandth apart at all configurations, so at regular ones.

    Beside one of them where they are ten times nearer nothing is compared.
    """
    text = """model: rod
coordinates: {x: {unit: m}, y: {unit: m}, a: {}}
kinetic_energy: (x_dot**2 + y_dot**2 + a_dot**2)/2
constraints: {geometric: {one: x + y - 1, two: x + y + 1e-4*sin(a) - 1}}
inputs: {f: {acts_on: {x: 1}}}
"""
    walker = Witness(text, {"x": 1.0, "y": 0.0, "a": 0.0}).walker()
    visited, ranks = walker.states({}, 20)
    assert (len(visited), ranks.constraints, ranks.actuation) == (20, 2, 1)
    turned = Witness(text.replace("sin(a)", "a**2"), {"x": 1.0, "y": 0.0, "a": 0.0}).walker()
    points = [np.array([1.0, 0.0, a]) for a in (1.0, 0.5, 0.09)]
    _, regular = turned._regular(points, {})
    assert [q[2] for q in regular] == [1.0, 0.5]


def test_a_walk_from_a_flat_pose_knows_the_ranks_elsewhere() -> None:
    """The start is 0 but for rounding, which gives rows a direction there that depends on the others elsewhere."""
    text = """model: cranks
coordinates: {a: {}, b: {}, c: {}, d: {}}
kinetic_energy: (a_dot**2 + b_dot**2 + c_dot**2 + d_dot**2)/2
constraints:
  geometric:
    along: 0.85*cos(a) + cos(d) - 1 - 0.85*cos(b)
    across: 0.85*sin(a) + sin(d) - 0.85*sin(b)
    along_too: 0.85*cos(a) + 2*cos(d) - 2 - 0.85*cos(c)
    across_too: 0.85*sin(a) + 2*sin(d) - 0.85*sin(c)
inputs: {u: {acts_on: {b: 1}}}
outputs: [forward_dynamics]
"""
    walker = Witness(text, {"a": 0.0, "b": 0.0, "c": 0.0, "d": 0.0}).walker()
    flat_pose = np.array([0.0, 3e-9, -2e-9, 1e-9])
    ranks, regular = walker._regular([flat_pose, *(np.array([a, a, a, 0.0]) for a in (0.3, -0.7, 1.1))], {})
    assert (len(regular), ranks.constraints, ranks.actuation) == (3, 3, 1)


def test_rows_across_a_bar_close_to_the_last_digits_of_its_length() -> None:
    """One of two rows of a bar at rest changes by little as it turns, and by as much as the other with its length."""
    x, y = 0.8 * math.cos(1.569), 0.8 * math.sin(1.569)
    text = f"""model: bar
coordinates: {{a: {{}}, b: {{}}}}
parameters: {{l: 0.8, x: {x + 1e-17!r}, y: {y!r}}}
kinetic_energy: (a_dot**2 + b_dot**2)/2
constraints: {{geometric: {{one: l*cos(a + b) - x, two: l*sin(a + b) - y - 2e-16}}}}
inputs: {{u: {{acts_on: {{a: 1}}}}}}
outputs: [forward_dynamics]
"""
    witness = Witness(text, {"a": 1.0, "b": 0.569})
    visited, ranks = witness.walker().states(witness.defaults(), 10)
    assert (len(visited), ranks.constraints) == (10, 1)
    off = Witness(text.replace("2e-16", "1e-13"), {"a": 1.0, "b": 0.569})
    assert off.walker().states(off.defaults(), 10)[0] == []


def test_an_internal_force_of_a_loop_in_a_plane_has_one_direction(tmp_path: Path) -> None:
    """Rows of the loop across its plane hold nothing, and leave the force a sign of its own."""
    text = """model: plane
gravity: [0, -9.81, 0]
joints:
  one: {type: revolute, axis: z, coordinate: a}
  two: {type: revolute, axis: z, parent: one, at: [0.5, 0, 0], coordinate: b}
  three: {type: revolute, axis: z, parent: two, at: [0.9, 0, 0], coordinate: c}
bodies:
  one: {mass: 1, com: [0.2, 0, 0], inertia: {zz: 0.1}}
  two: {mass: 2, com: [0.3, 0, 0], inertia: {zz: 0.2}}
  three: {mass: 1, com: [0.2, 0, 0], inertia: {zz: 0.1}}
points: {tip: {frame: three, at: [0.7, 0, 0]}, anchor: {at: [0.8, 0.1, 0]}}
loops: {loop: {type: point, between: [tip, anchor]}}
inputs: {u: {joint: a}, idle: {torque_on: two, direction: [1, 0, 0]}}
allocation: {limits: {u: [20, 30]}}
outputs: [inverse_dynamics]
"""
    path = tmp_path / "plane.yaml"
    path.write_text(text, encoding="utf-8")
    result = generate(path, Options(parts=("python",), verify=False), lambda _: None)
    assert "compare u with its limits" in result.files["python/plane.py"]
    witness = Witness(text, {"a": 2.2, "b": -1.9, "c": -1.7})
    walker = witness.walker()
    visited, ranks = walker.states(witness.defaults(), 4)
    assert len(visited) == 4
    assert len(ranks.lengths) > ranks.constraints
    # u alone moves the loop, and is what it has to be, within its limits or not
    assert all(witness._known("inverse_dynamics", state, ranks) is not None for state in visited)


def test_a_step_that_closes_stays_where_it_closed_best() -> None:
    """Rows of a Bennett linkage depend on each other on V: Newton's steps there follow what rounding leaves of one."""
    bennett = draw(51001, 379, None)
    witness = Witness(bennett.text, bennett.start, bennett.text)
    walker, defaults = witness.walker(), witness.defaults()
    reached = walker.points(defaults, 66)
    assert len(reached) > 60
    assert max(np.abs(walker.numbers(q, defaults).residual).max() for q in reached) < CLOSED
