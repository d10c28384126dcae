"""Mechanisms with several branches of configurations: u on the branch that moves, a status on those that do not."""

from __future__ import annotations

import math
import resource
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import pytest
import shipped
from linkages import cranks_on_one_coupler, on_two_bases, row_of_four_bars

from symgen.diagnostics import ModelError
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Status
from symgen.lowering.schedule import schedule
from symgen.mechanics.genericity import genericity, parameter_values
from symgen.mechanics.system import System
from symgen.model.configurations.assembly import ConfigurationRanks, RankedConfiguration
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.matrix import flatten
from symgen.validity.search import ZeroSearch
from symgen.verify.reference.reference import Reference


def inverse(model: Model, q: Sequence[float]) -> tuple[Status, tuple[float, ...]]:
    """The status and u at rest."""
    derived = derive_quantities(model, ["inverse_dynamics"])
    program = schedule(derived.mechanics, derived.quantities, ("float64",))["float64"]
    numbers = [*default_values(model.parameters).values()]
    zeros = [0.0] * model.n
    status, u = Interpreter(program.sincos).run(program.kernels[0], {"q": q, "qd": zeros, "qdd": zeros}, numbers)
    return status, tuple(u)


@pytest.mark.parametrize("count", [1, 2, pytest.param(4, marks=pytest.mark.mechanisms)])
@pytest.mark.parametrize("scales", [("1", "1"), ("1e-6", "1e4"), ("1e7", "1e-7")])
def test_equal_bars_hold_their_weight_on_the_branch_that_moves(count: int, scales: tuple[str, str]) -> None:
    model = load_text(row_of_four_bars(count, scales=scales), "row.yaml")
    angle = 0.8
    main = [angle] * (count + 1) + [0.0] * count
    status, u = inverse(model, main)
    # every crank counts half a bar, every coupler a whole one
    weight = 0.9 * 9.81 * 0.4 * math.cos(angle) * ((count + 1) / 2 + count)
    assert status == Status.OK
    assert u == pytest.approx([weight], rel=1e-12)
    # the driven crank lies on the ground, the others turn
    held = [0.0] + [angle] * count + [angle] + [0.0] * (count - 1)
    assert inverse(model, held)[0] == Status.ACTUATION_RANK
    # all bars in line: where the branches meet
    assert inverse(model, [0.0] * model.n)[0] != Status.OK


def test_what_turns_in_another_assembly_is_not_said_to_stand_still_for_ever() -> None:
    model = load_text(row_of_four_bars(2), "row.yaml")
    messages = [notice.message for notice in model.notices]
    assert not any(" cannot move: " in message for message in messages)
    (held,) = [message for message in messages if " cannot move in the configurations that were looked at: " in message]
    assert held.startswith("`b2` ")
    assert "hold b2 = 0 there" in held
    # the last crank and its coupler fold back on the ground, and turn with the first two
    folded = {"a0": 0.8, "a1": 0.8, "a2": math.pi, "b1": 0.0, "b2": 0.8 - math.pi}
    mechanics = System(model)
    rows = Evaluator(flatten(mechanics.constraint_jacobian))({**parameter_values(mechanics), **folded})
    motion = {"a0": 1.0, "a1": 1.0, "a2": 0.0, "b1": 0.0, "b2": 1.0}
    n = mechanics.n
    moved = [sum(rows[i * n + j] * motion[c.name] for j, c in enumerate(model.coordinates)) for i in range(mechanics.r)]
    assert moved == pytest.approx([0.0] * 4, abs=1e-12)


def test_a_singular_start_and_a_branch_of_other_ranks_are_told() -> None:
    said = [notice.message for notice in load_text(row_of_four_bars(1), "row.yaml").notices]
    begin = "the middles of the ranges lead to a singular configuration (a0 = 0, a1 = 0, b1 = 0)"
    assert any(text.startswith(begin) for text in said)
    assert any("another branch" in text and "the inputs span 0 of 1 directions, here 1" in text for text in said)
    declared = load_text(row_of_four_bars(1, tail="configuration: {a0: 0, a1: 0, b1: 0}"), "row.yaml")
    assert any("the start leads to a singular configuration" in notice.message for notice in declared.notices)
    regular = load_text(row_of_four_bars(1, tail="configuration: {a0: 1, a1: 1, b1: 0}"), "row.yaml")
    assert not any("singular" in notice.message for notice in regular.notices)


@pytest.mark.parametrize("count", [3, *(pytest.param(count, marks=pytest.mark.mechanisms) for count in (4, 5))])
@pytest.mark.parametrize("tail", ["", "configuration: {a0: 0.6, a1: 0.6, a2: 0.6, b: 0}"])
def test_more_cranks_than_needed_move(count: int, tail: str) -> None:
    model = load_text(cranks_on_one_coupler(count, tail), "cranks.yaml")
    generic = genericity(System(model))
    assert (generic.rank, generic.geometric_rank, generic.delta, generic.alpha) == (count, count, 1, 1)
    status, u = inverse(model, [0.6] * count + [0.0])
    assert status == Status.OK
    assert u == pytest.approx([2 * 9.81 * 0.5 * math.cos(0.6)], rel=1e-12)


def test_a_scalar_that_vanishes_in_the_stretched_pose_alone_has_no_regular_zero() -> None:
    """Beside that pose rows are short and cross each other: their length there is no measure."""
    mechanics = System(load_text(cranks_on_one_coupler(4), "cranks.yaml"))
    graph = mechanics.graph
    a, b = (graph.trig("sin", graph.symbol(name)) for name in ("a0", "b"))
    assert ZeroSearch(mechanics, genericity(mechanics)).zero_of(a * a + b * b) is None
    zero = ZeroSearch(mechanics, genericity(mechanics)).zero_of(a - Fraction(1, 2))
    assert zero is not None
    assert math.sin(float(dict(zero.point)["a0"])) == pytest.approx(0.5)


def test_an_input_that_moves_nothing_on_the_declared_branch_gives_a_status_there() -> None:
    """A torque on the coupler of a parallelogram does no work; on the crossed branch it does."""
    text = row_of_four_bars(1, ground="0.7", tail="configuration: {a0: 0.8, a1: 0.8, b1: 0}")
    model = load_text(text.replace("acts_on: {a0: 1}", "acts_on: {b1: 1}"), "coupler.yaml")
    assert any("the inputs span 0 of 1 directions, here 1" in notice.message for notice in model.notices)
    assert inverse(model, [0.8, 0.8, 0.0])[0] == Status.ACTUATION_RANK


def test_too_few_inputs_are_still_served() -> None:
    """Two rows of bars side by side, one of them driven: u is what the inputs can do."""
    one = row_of_four_bars(1, ground="0.7")
    text = one.replace("  b1: {unit: rad}", "  b1: {unit: rad}\n  s: {unit: rad}")
    text = text.replace("kinetic_energy: ", "kinetic_energy: m*l**2/6*s_dot**2 + ")
    model = load_text(text, "side_by_side.yaml")
    generic = genericity(System(model))
    assert (generic.delta, generic.alpha) == (2, 1)
    assert inverse(model, [0.8, 0.8, 0.0, 0.3])[0] == Status.OK


GATED = """
model: gated
coordinates: {x: {}, y: {}, z: {}, w: {}, v: {}}
kinetic_energy: x_dot**2 + y_dot**2 + 2*z_dot**2 + 3*w_dot**2 + v_dot**2
potential_energy: 3*x + 2*v - z
constraints: {geometric: {first: (x - y)*w, second: 1e-3*(x - y)*z}}
inputs: {a: {acts_on: {x: 1}}, b: {acts_on: {z: 1}}, c: {acts_on: {w: 1}}, d: {acts_on: {v: 1}}}
configuration: {x: 0.3, y: 0.3, z: 0.5, w: 0.4, v: 0.1}
"""


def test_a_branch_of_greater_rank_gives_a_status() -> None:
    """Two rows that say the same while the slides stay together; when they part, both gates are shut."""
    model = load_text(GATED, "gated.yaml")
    generic = genericity(System(model))
    assert (generic.rank, generic.alpha, generic.rank_is_identical) == (1, 4, False)
    assert any("the constraints have rank 2, here 1" in notice.message for notice in model.notices)
    status, u = inverse(model, [0.3, 0.3, 0.5, 0.4, 0.1])
    assert status == Status.OK
    assert u == pytest.approx([3, -1, 0, 2], abs=1e-12)
    assert inverse(model, [0.3, 0.302, 0.5, 0.4, 0.1])[0] == Status.OK  # measured: 1e-3 off
    assert inverse(model, [0.3, -0.5, 0.0, 0.0, 0.1])[0] == Status.CONSTRAINT_RANK


@pytest.mark.parametrize("gain", ["4e-22", "1", "6e13", "3e24"])
def test_the_unit_of_an_input_is_no_measure_of_constraints(gain: str) -> None:
    text = """
model: guided
coordinates: {x: {unit: rad}, a: {unit: rad}}
kinetic_energy: x_dot**2 + 2*a_dot**2
constraints: {geometric: {guide: 2.3*x - sin(a)}}
inputs: {drive: {acts_on: {a: GAIN}}}
"""
    ranks = genericity(System(load_text(text.replace("GAIN", gain), "guided.yaml")))
    assert (ranks.rank, ranks.alpha) == (1, 1)


def test_a_force_along_the_arm_it_would_turn_moves_nothing() -> None:
    """Turned frames leave 1e-17 of it, whatever numbers they are turned by."""
    text = """
model: radial
parameters: {w: {value: 0.3, unit: m}, tilt: {value: 0.47}}
joints:
  arm: {type: revolute, axis: [1, 0.4, 0], rotation: [[[1, -2, 2], pi**2], [y, -pi/2]], at: [0.1, 0, 0], coordinate: a}
  slide: {type: prismatic, parent: arm, axis: [0, 1, 1], coordinate: s}
frames: {hand: {parent: arm, translation: [0, w, 0], rotation: [[[0.3, 0.4, -1.2], tilt]]}}
bodies:
  arm: {mass: 2, inertia: {xx: 0.3, yy: 0.4, zz: 0.5}}
  slide: {mass: 1, inertia: {xx: 0.3, yy: 0.4, zz: 0.5}}
gravity: [0, 0, -9.81]
points: {tip: {frame: hand}}
inputs:
  push: {joint: s}
  idle: {point: tip, direction: [0.3, 0.12, 0], axes: arm}
"""
    model = load_text(text, "radial.yaml")
    assert genericity(System(model)).alpha == 1
    assert Reference(model).ranks.actuation == 1


def test_inputs_that_do_more_on_a_branch_nobody_found_give_a_status() -> None:
    """A torque on the coupler, as if only the parallelogram were known, where it does no work."""
    text = row_of_four_bars(1, ground="0.7").replace("acts_on: {a0: 1}", "acts_on: {b1: 1}")
    known = load_text(text, "coupler.yaml")
    assert known.assembly is not None
    place = RankedConfiguration((0.8, 0.8, 0.0), ConfigurationRanks(2, 2, 0))
    model = replace(known, assembly=replace(known.assembly, ranks=place.ranks, places=(place,)))
    assert inverse(model, [0.8, 0.8, 0.0]) == (Status.OK, (0.0,))
    crossed = next(p.q for p in known.assembly.places if p.ranks.actuation == 1)
    assert inverse(model, crossed)[0] == Status.ACTUATION_RANK


def test_ranks_that_hold_everywhere_need_no_test() -> None:
    """A loop in a tilted plane has three rows of rank two, whatever the angles."""
    four_bar = (shipped.ROOT / "models" / "tilted_four_bar.yaml").read_text(encoding="utf-8")
    model = load_text(on_two_bases(four_bar), "four_bar.yaml")
    generic = genericity(System(model))
    assert generic.rank < generic.r
    assert generic.rank_is_identical
    assert generic.actuation_is_identical


@pytest.mark.parametrize(
    ("rows", "tail"),
    [("{r: (x - y)**2}", ""), ("{r: x*x + y*y, s: x - z}", "configuration: {x: 0, y: 0, z: 0}")],
    ids=["square", "shaky"],
)
def test_rows_whose_gradient_vanishes_where_they_hold_are_refused(rows: str, tail: str) -> None:
    text = f"""
model: flat
coordinates: {{x: {{}}, y: {{}}, z: {{}}, w: {{}}}}
kinetic_energy: x_dot**2 + y_dot**2 + z_dot**2 + w_dot**2
constraints: {{geometric: {rows}}}
inputs: {{u: {{acts_on: {{w: 1}}}}}}
{tail}
"""
    with pytest.raises(ModelError, match="only singular configurations were found"):
        load_text(text, "flat.yaml")


def test_a_linkage_that_closes_stretched_alone_is_refused() -> None:
    text = row_of_four_bars(1, crank="0.2", ground="0.7").replace("w*cos(b1) - w -", "0.3*cos(b1) - w -")
    with pytest.raises(ModelError, match=r"only singular configurations were found|cannot move"):
        load_text(text.replace("w*sin(b1)", "0.3*sin(b1)"), "stretched.yaml")


@pytest.mark.parametrize("count", [1, pytest.param(12, marks=pytest.mark.mechanisms)])
def test_what_cannot_close_is_named_with_its_gap_at_once(count: int) -> None:
    """The last coupler is a metre too short for its cranks."""
    text = row_of_four_bars(count).replace(f"w*cos(b{count}) - w", f"w*cos(b{count}) - w - 1.6")
    before = resource.getrusage(resource.RUSAGE_SELF).ru_utime
    with pytest.raises(ModelError, match=rf"`x{count}` stays at -0.8\d* in the nearest one"):
        load_text(text, "gap.yaml")
    assert resource.getrusage(resource.RUSAGE_SELF).ru_utime - before < 4


@pytest.mark.mechanisms
def test_a_long_row_takes_no_dense_sums() -> None:
    before = resource.getrusage(resource.RUSAGE_SELF)
    model = load_text(row_of_four_bars(25), "long.yaml")
    generic = genericity(System(model))
    after = resource.getrusage(resource.RUSAGE_SELF)
    assert (generic.rank, generic.delta, generic.alpha) == (50, 1, 1)
    assert after.ru_utime - before.ru_utime < 10
