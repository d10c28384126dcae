"""States at which kernels are worst: estimated, looked for near those of a verification, judged like these."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from symgen.generation.draft import draft_of
from symgen.generation.results import Options
from symgen.ir.kernel import Block, Kernel, Literal, Load, Local, OperationName, Scalar, Statement
from symgen.ir.pairs.wide import widened
from symgen.model.load import load_model, load_text
from symgen.verify.expected import Expected
from symgen.verify.interpreted import outcomes
from symgen.verify.lanes.loops_in_lanes import LoopsInLanes
from symgen.verify.lanes.ranks_in_lanes import RankedPart, measures, ranked_parts
from symgen.verify.lanes.rates_in_lanes import RatesInLanes
from symgen.verify.lanes.rounding import RoundingErrors
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.nearby import Surroundings
from symgen.verify.sampling.plain_values import values_at
from symgen.verify.sampling.searched import WorstStateSearch
from symgen.verify.sampling.states import Sample, rounded, sample_states
from symgen.verify.single_precision import lost_in_float32
from symgen.verify.tolerance import FACTOR

# A ladder whose feet slide on a floor and along a wall, and a disc that is geared to its turning.
LADDER = """
model: ladder
coordinates:
  x: {unit: m}
  y: {unit: m}
  a: {unit: rad, range: [0.3, 1.2]}
  c: {unit: rad}
parameters:
  l: {value: 1.5, unit: m, range: [1, 2]}
  m: {value: 4, unit: kg}
  J: {value: 0.3, unit: kg*m**2}
kinetic_energy: m/2*(x_dot**2 + y_dot**2) + J/2*(a_dot**2 + c_dot**2)
potential_energy: 9.81*m*y/2
constraints:
  geometric: {floor: x - l*cos(a), wall: y - l*sin(a)}
  nonholonomic: {gear: c_dot - (2 + sin(a))*a_dot}
inputs:
  push: {unit: N, acts_on: {x: 1}}
configuration: {x: 1.2, y: 0.9, a: 0.6435, c: 0}
outputs: [inverse_dynamics, forward_dynamics]
"""


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Reference:
    path = tmp_path_factory.mktemp("ladder") / "ladder.yaml"
    path.write_text(LADDER, encoding="utf-8")
    return Reference(load_model(path))


def straight(*statements: Statement) -> Kernel:
    """A kernel of the coordinates x, a whose result is its last statement's."""
    loads = (Load("x", "q", 0), Load("a", "q", 1))
    return Kernel("made_up", (), loads, (Block(statements, ()),), (Local(statements[-1].targets[0]),), (1,))


X, A, BIG = Local("x"), Local("a"), Literal(Fraction(10**6))
# x + a that is worked out by way of x + 10^6 a
DETOUR = straight(
    Statement(("far",), "mul", (BIG, A)),
    Statement(("near",), "add", (X, Local("far"))),
    Statement(("less",), "mul", (Literal(Fraction(10**6 - 1)), A)),
    Statement(("sum",), "sub", (Local("near"), Local("less"))),
)
DETOUR_OF_LADDER = replace(DETOUR, loads=(Load("x", "q", 0), Load("a", "q", 2)))


def test_estimates_are_shares_of_roundings_in_units_of_what_inputs_do() -> None:
    x, a = 0.5, 0.25
    rounded = [1e6 * a, x + 1e6 * a, (1e6 - 1) * a, x + a]
    unit = (x + a) + 1.5 * (x**2 + a**2) ** 0.5
    state = {"q": np.array([[x, a], [2 * x, 2 * a]])}
    own, size = RoundingErrors(DETOUR).with_units(state)
    assert own / size == pytest.approx([np.linalg.norm(rounded) / unit] * 2)


def test_where_rows_depend_configurations_move_along_v_alone() -> None:
    """x + 10^6 (x - a) beside x = a is another function than x, and d that of a kernel a million times too large."""
    kernel = straight(
        Statement(("off",), "sub", (X, A)),
        Statement(("far",), "mul", (BIG, Local("off"))),
        Statement(("sum",), "add", (X, Local("far"))),
    )
    state = {"q": np.array([[0.7, 0.7]])}
    along = np.full((1, 2, 2), 0.5)
    (unit,), (smaller,) = (RoundingErrors(kernel).with_units(state, tangents)[1] for tangents in (None, along))
    assert unit == pytest.approx(0.7 + 1.5 * 0.7 * np.hypot(1e6 + 1, 1e6))
    assert smaller == pytest.approx(0.7 + 1.5 * 0.7 * np.hypot(0.5, 0.5))


def test_what_all_but_vanishes_is_given_to_a_share_of_itself() -> None:
    """Along V it moves by a share of what is tied to it: d would be that of 0.7 where it is that of 1e-6."""
    kernel = straight(
        Statement(("turned",), "add", (X, A)),
        Statement(("bend",), "sub", (Local("turned"), X)),
    )
    own, unit = RoundingErrors(kernel).with_units({"q": np.array([[0.7, 1e-6]])}, np.full((1, 2, 2), 0.5))
    assert unit == pytest.approx([2.5e-6])
    assert own == pytest.approx([0.7], rel=1e-5)


def test_tangents_are_what_rows_leave_free(reference: Reference) -> None:
    around = Surroundings(reference, sample_states(reference, ["inverse_dynamics"], 8))
    q, p = around.samples.parts["q"], around.samples.parts["p"]
    for tangent, (_, _, a, _), (length, *_) in zip(around.tangents(around.samples), q, p, strict=True):
        free = np.array([-length * np.sin(a), length * np.cos(a), 1, 2 + np.sin(a)])
        assert tangent == pytest.approx(np.outer(free, free) / (free @ free), abs=1e-12)


def test_of_doubtful_states_the_worst_are_judged() -> None:
    """Roundings cancel at some states: what they do is measured before the reference is asked."""
    model = load_text(LADDER, "ladder.yaml")
    expected = Expected(model, ["inverse_dynamics"], 24, lambda _: None)
    samples = list(expected.drawn)

    def units(sample: Sample, scalar: Scalar) -> float:
        x, a = rounded(sample, scalar).state.q[0], rounded(sample, scalar).state.q[2]
        made = outcomes(DETOUR_OF_LADDER, None, scalar, [rounded(sample, scalar).state])[0].entries[0]
        exact = Fraction(x) + Fraction(a)
        return float(abs(Fraction(made) - exact)) / (float(exact) + 1.5 * np.hypot(x, a))

    judged = WorstStateSearch(expected)._worst_of(DETOUR_OF_LADDER, RoundingErrors(DETOUR_OF_LADDER), samples)
    assert len(judged) == 8
    for scalar in ("float64", "float32"):
        ordered = sorted(samples, key=lambda sample: -units(sample, scalar))
        assert all(sample in judged for sample in ordered[:4])


def test_states_nearby_satisfy_the_constraints_as_samples_do(reference: Reference) -> None:
    surroundings = Surroundings(reference, sample_states(reference, ["inverse_dynamics"], 16))
    drawn = surroundings.drawn(64)
    further = surroundings.moved(drawn, "ladder")
    for states in (drawn, further):
        assert 32 < len(states) <= 64
        assert {bool(x) for x in states.admissible} == {False, True}
        q, p = states.parts["q"], states.parts["p"]
        assert np.abs(q[:, 0] - p[:, 0] * np.cos(q[:, 2])).max() < 1e-9
        assert np.abs(q[:, 1] - p[:, 0] * np.sin(q[:, 2])).max() < 1e-9
        assert (q[:, 2] > 0.29).all()
        assert (q[:, 2] < 1.21).all()
        on = states.only(states.admissible)
        q, qd, qdd, p = (on.parts[name] for name in ("q", "qd", "qdd", "p"))
        a, rate = q[:, 2], qd[:, 2]
        assert np.abs(qd[:, 0] + p[:, 0] * np.sin(a) * rate).max() < 1e-9
        assert np.abs(qd[:, 3] - (2 + np.sin(a)) * rate).max() < 1e-9
        expected = (2 + np.sin(a)) * qdd[:, 2] + np.cos(a) * rate**2
        assert qdd[:, 3] == pytest.approx(expected, abs=1e-4)
    again = Surroundings(reference, sample_states(reference, ["inverse_dynamics"], 16)).drawn(64)
    assert all((again.parts[name] == values).all() for name, values in drawn.parts.items())


def test_states_with_an_angle_near_a_quarter_turn_satisfy_the_constraints(reference: Reference) -> None:
    surroundings = Surroundings(reference, sample_states(reference, ["inverse_dynamics"], 16))
    aligned = surroundings.aligned(128)
    q, p = aligned.parts["q"], aligned.parts["p"]
    assert np.abs(q[:, 0] - p[:, 0] * np.cos(q[:, 2])).max() < 1e-9
    assert np.abs(q[:, 1] - p[:, 0] * np.sin(q[:, 2])).max() < 1e-9
    off = np.abs(q[:, 3] / (np.pi / 2) - np.round(q[:, 3] / (np.pi / 2)))
    # the ladder never leans by a quarter turn, the disc is free to
    assert len(aligned) > 32
    assert np.sort(off)[len(off) // 2] < 0.02
    assert (off > 1e-7).all()


def test_ranges_that_configurations_leave_are_no_bounds(tmp_path: Path) -> None:
    """A slide without a range, whose loop closes beyond a metre: what lies beside its states is looked at, too."""
    path = tmp_path / "far.yaml"
    text = LADDER.replace("range: [0.3, 1.2]", "range: [0.2, 0.5]").replace("1.5, unit: m, range: [1, 2]", "4")
    path.write_text(text.replace("x: 1.2, y: 0.9, a: 0.6435", "x: 3.7, y: 1.5, a: 0.39"), encoding="utf-8")
    far = Reference(load_model(path))
    samples = sample_states(far, ["inverse_dynamics"], 16)
    assert min(float(sample.state.q[0]) for sample in samples) > 3
    assert len(Surroundings(far, samples).drawn(64)) > 32


CART = """
model: cart
coordinates: {x: {unit: m}, a: {unit: rad}}
kinetic_energy: 2*x_dot**2 + a_dot**2
inputs: {push: {acts_on: {x: 1}}, turn: {acts_on: {a: 1}}}
outputs: [inverse_dynamics]
"""
# x + 10 x^8 - 10 x^8, in which nothing is lost before x is large
FAR_DETOUR = straight(
    Statement(("x2",), "mul", (X, X)),
    Statement(("x4",), "mul", (Local("x2"), Local("x2"))),
    Statement(("x8",), "mul", (Local("x4"), Local("x4"))),
    Statement(("far",), "mul", (Literal(Fraction(10)), Local("x8"))),
    Statement(("near",), "add", (X, Local("far"))),
    Statement(("sum",), "sub", (Local("near"), Local("far"))),
)


@pytest.mark.parametrize(("rows", "count"), [("", 1), (", again: 3*y - 3*l*sin(a)", 2)])
def test_where_rows_depend_the_worst_states_in_either_unit_are_looked_at(rows: str, count: int) -> None:
    """x + 10^4 (l^2 - x^2 - y^2) + 10^6 l - 10^6 l at a ladder's feet: along V that is x, beside V anything."""
    model = load_text(LADDER.replace("wall: y - l*sin(a)", "wall: y - l*sin(a)" + rows), "ladder.yaml")
    x, y, length = Local("x"), Local("y"), Local("l")
    kernel = straight(
        Statement(("x2",), "mul", (x, x)),
        Statement(("y2",), "mul", (y, y)),
        Statement(("l2",), "mul", (length, length)),
        Statement(("both",), "add", (Local("x2"), Local("y2"))),
        Statement(("off",), "sub", (Local("l2"), Local("both"))),
        Statement(("far",), "mul", (Literal(Fraction(10**4)), Local("off"))),
        Statement(("farther",), "mul", (BIG, length)),
        Statement(("near",), "add", (Local("far"), Local("farther"))),
        Statement(("less",), "sub", (Local("near"), Local("farther"))),
        Statement(("sum",), "add", (x, Local("less"))),
    )
    kernel = replace(kernel, name="inverse_dynamics", loads=(*kernel.loads, Load("y", "q", 1), Load("l", "p", 0)))
    kernel = replace(kernel, loads=tuple(load for load in kernel.loads if load.local != "a"))
    search = WorstStateSearch(Expected(model, ["inverse_dynamics"], 16, lambda _: None))
    made = search._estimated(kernel, RoundingErrors(kernel))
    brought = search._brought(kernel, made.states, made.estimated, 4)
    alone = [search._brought(kernel, made.states, [units], 4) for units in made.estimated]
    assert len(alone) == len(set(map(tuple, alone))) == count
    assert list(dict.fromkeys(sample for samples in alone for sample in samples)) == brought


def test_lengths_without_a_range_are_looked_at_further_out() -> None:
    """[-1, 1] is taken for granted there, which nobody said; a range that is given is kept."""
    worst = {}
    for bounds in ("", ", range: [-1, 1]"):
        model = load_text(CART.replace("x: {unit: m", "x: {unit: m" + bounds), "cart.yaml")
        expected = Expected(model, ["inverse_dynamics"], 16, lambda _: None)
        made = WorstStateSearch(expected)._estimated(FAR_DETOUR, RoundingErrors(FAR_DETOUR))
        worst[bounds] = made.states.parts["q"][:, 0], made.estimated[0].max()
    near, largest = worst[", range: [-1, 1]"]
    assert np.abs(near).max() < 1.02
    assert largest < FACTOR
    far, largest = worst[""]
    assert far.min() < -3 < 3 < far.max() < 3.3
    assert largest > FACTOR


def test_lengths_that_loops_hold_stay_where_these_lead(reference: Reference) -> None:
    """A start far out is brought back to V: the feet of a ladder are no further than it is long."""
    nearby = Surroundings(reference, sample_states(reference, ["inverse_dynamics"], 16)).further_out(128)
    q, p = nearby.parts["q"], nearby.parts["p"]
    assert len(nearby) > 16
    assert np.abs(q[:, 0] - p[:, 0] * np.cos(q[:, 2])).max() < 1e-9
    assert np.abs(q[:, 1] - p[:, 0] * np.sin(q[:, 2])).max() < 1e-9


@pytest.mark.parametrize("weight", ["9.81*m*y/2", "0.001*m*y"])
def test_inputs_are_small_too_as_where_a_machine_coasts(tmp_path: Path, weight: str) -> None:
    """Weights move it then, or rates alone."""
    path = tmp_path / "inputs.yaml"
    path.write_text(LADDER.replace("9.81*m*y/2", weight), encoding="utf-8")
    ladder = Reference(load_model(path))
    samples = sample_states(ladder, ["forward_dynamics"], 16)
    surroundings = Surroundings(ladder, samples)
    drawn = surroundings.drawn(256)
    largest = np.array([max(map(abs, map(float, sample.state.u)), default=0.0) for sample in samples])
    shares = np.abs(drawn.parts["u"]).max(axis=1) / np.maximum(largest, 1.0)[drawn.origins]
    low, middle = np.quantile(shares, [0.1, 0.7])
    assert middle > 0.1
    assert 1e-5 < low < 1e-2
    further = surroundings.moved(drawn.only(shares < 0.01), "inputs")
    again = np.abs(further.parts["u"]).max(axis=1, initial=0.0) / np.maximum(largest, 1.0)[further.origins]
    assert (again < 0.02).all()


@pytest.mark.parametrize("name", ["five_bar", "three_rrr", "skate", "rapkm_bodies"])
def test_measures_in_lanes_are_those_of_the_reference(name: str) -> None:
    """So that what is no regular state takes no place among the worst."""
    model = load_model(Path("models") / f"{name}.yaml")
    reference = Reference(model)
    samples = sample_states(reference, ["singularity"], 8)
    around = Surroundings(reference, samples)
    for sample, measured in zip(samples, around.measures(around.samples, together=False), strict=True):
        exact = values_at(reference, sample.state, ["singularity"])["singularity"]
        assert measured == pytest.approx(exact, rel=1e-9)


@pytest.mark.campaign
def test_of_directions_that_are_lost_together_the_least_counts() -> None:
    """Rows (1, 0, 0), (c, d, 0) and (c, 0, 2 d) lose two directions with d; with (0, 0, 1) for the last, one."""
    part = RankedPart(range(3), range(3), [], 3, 0)

    def measured(d: float, both: bool, together: bool) -> float:
        rows = np.array([[1, 0, 0], [np.sqrt(1 - d * d), d, 0], [np.sqrt(1 - 4 * d * d), 0, 2 * d]])
        rows[2] = rows[2] if both else (0, 0, 1)
        blocks = [(rows[None], np.zeros((1, 3, 0)))]
        return float(measures([part], blocks, together)[0, 0])

    for d in (1e-3, 1e-4, 1e-5):
        assert measured(d / 10, True, False) / measured(d, True, False) == pytest.approx(1e-4, rel=1e-3)
        assert measured(d / 10, True, True) / measured(d, True, True) == pytest.approx(1e-2, rel=1e-3)
        assert measured(d, False, True) == measured(d, False, False)
    # nothing jumps where the second direction begins to be lost
    ratios = [measured(d, True, True) / measured(d * 0.999, True, True) for d in np.geomspace(1e-3, 0.3, 2000)]
    assert 1 < min(ratios) <= max(ratios) < 1.005


@pytest.mark.campaign
@pytest.mark.parametrize("name", ["three_rrr", "skate"])
def test_states_are_led_towards_a_drop_of_rank_and_stay_above_the_least(name: str) -> None:
    """A platform towards where its drives do not hold it; row and drives of a skate never lose rank."""
    reference = Reference(load_model(Path("models") / f"{name}.yaml"))
    around = Surroundings(reference, sample_states(reference, ["inverse_dynamics"], 16))
    least = [1e-15, 1e-15]
    led = around.towards(256, least)
    measures, usual = around.measures(led, together=False), around.measures(around.samples, together=False)
    assert len(led) > 128
    assert (measures >= 0.99e-15).all()
    # of squares: to a hundredth of what the nearest sample has
    nearer = bool(measures[:, 1].min() < 1e-4 * usual[:, 1].min())
    assert nearer == (name == "three_rrr")
    assert all((around.towards(256, least).parts[part] == rows).all() for part, rows in led.parts.items())


@pytest.mark.parametrize("name", ["five_bar", "front_car", "rapkm_bodies"])
def test_rates_in_lanes_are_those_of_the_reference(name: str) -> None:
    """As close as differences along the rates are."""
    reference = Reference(load_model(Path("models") / f"{name}.yaml"))
    samples = sample_states(reference, ["inverse_dynamics"], 8)
    around = Surroundings(reference, samples)
    parts = ranked_parts(reference.system, reference.ranks)
    loops = LoopsInLanes(reference.system, [float(x) for x in reference.literals()])
    dice = np.random.default_rng(5)
    given = dict(around.samples.parts)
    given |= {rates: dice.uniform(-1, 1, given[rates].shape) for rates in ("qd", "qdd")}
    qd, qdd, finite = RatesInLanes(reference.system, parts, loops).admissible(given)
    assert finite.all()
    for k, sample in enumerate(samples):
        state = replace(sample.state, qd=tuple(given["qd"][k]), qdd=tuple(given["qdd"][k]))
        exact = values_at(reference, state, ["admissible_velocity"])["admissible_velocity"]
        assert qd[k] == pytest.approx(exact, abs=1e-6)
        state = replace(state, qd=tuple(exact))
        exact = values_at(reference, state, ["admissible_acceleration"])["admissible_acceleration"]
        assert qdd[k] == pytest.approx(exact, abs=1e-4)


# A table on two pairs of links, at a right angle to each other, that stand straight where it is highest.
LIFT = """
model: lift
parameters: {l: {value: 0.4}, d: {value: 0.8}}
gravity: [0, 0, -9.81]
frames:
  end: {parent: side_knee, translation: [0, 0, l]}
  dock: {parent: table, translation: ["-d", d, 0]}
joints:
  foot: {type: revolute, axis: x, at: [0, "-d", 0], coordinate: a}
  knee: {type: revolute, axis: x, parent: foot, at: [0, 0, l], coordinate: b}
  table: {type: revolute, axis: x, parent: knee, at: [0, 0, l], coordinate: c}
  side_foot: {type: revolute, axis: y, at: ["-d", 0, 0], coordinate: e}
  side_knee: {type: revolute, axis: y, parent: side_foot, at: [0, 0, l], coordinate: f}
bodies:
  foot: {mass: 2, com: [0, 0, l/2], inertia: {xx: 0.03, yy: 0.03, zz: 0.01}}
  knee: {mass: 1, com: [0, 0, l/2], inertia: {xx: 0.03, yy: 0.03, zz: 0.01}}
  table: {mass: 5, com: [0, d, 0], inertia: {xx: 0.4, yy: 0.4, zz: 0.5}}
  side_knee: {mass: 1, com: [0, 0, l/2], inertia: {xx: 0.03, yy: 0.03, zz: 0.01}}
loops: {hinge: {type: revolute, between: [end, dock], axis: y}}
inputs: {drive: {joint: b}, other: {joint: f}}
configuration: {a: 0.5, b: -1, c: 0.5, e: 0.5, f: -1}
outputs: [inverse_dynamics]
"""


@pytest.mark.campaign
def test_u_is_judged_nearer_to_singular_states_than_samples_are() -> None:
    """What every method loses beside straight legs is seen though no sample comes near; twice the digits hold."""
    model = load_text(LIFT, "lift.yaml")
    program = draft_of(model, model.outputs, Options()).programs["float64"]
    expected = Expected(model, model.outputs, 16, lambda _: None)
    assert min(abs(sample.state.q[1]) for sample in expected.drawn) > 0.3
    search, (kernel,) = WorstStateSearch(expected), program.kernels
    search.look(kernel.name, "its method", lambda: kernel)
    assert search.largest(kernel, program.sincos, "float64") > FACTOR
    assert search.largest(widened(kernel, "float64"), program.sincos, "float64") < 1


# Two slides in a row that lead a tip, whose place a rod holds once more; where the slides are parallel nothing drives
# one against the other.
SLIDES = """
model: slides
gravity: [0, -9.81, 0]
joints:
  arm: {type: revolute, axis: z, coordinate: a}
  first: {type: prismatic, parent: arm, at: [0.25, 0, 0], axis: y, coordinate: s}
  bend: {type: revolute, axis: z, parent: first, at: [0, 1.1, 0], coordinate: b}
  second: {type: prismatic, parent: bend, at: [0, 0.25, 0], axis: y, coordinate: p}
bodies:
  arm: {mass: 6, inertia: {zz: 0.04}}
  first: {mass: 1, com: [0, 0.55, 0], inertia: {zz: 0.14}}
  bend: {mass: 7, com: [0, 0.12, 0], inertia: {zz: 0.2}}
  second: {mass: 4.5, com: [0.55, 0, 0], inertia: {zz: 0.26}}
points:
  tip: {frame: second, at: [1.1, 0, 0]}
  anchor: {at: [-0.74398812542616, -1.637479237644137, 0]}
  far: {at: [-0.7905584888983138, -1.094236089731962, 0]}
loops:
  place: {type: point, between: [tip, anchor]}
  rod: {type: distance, between: [tip, far], length: 0.5452356522710686}
inputs: {elbow: {joint: b}, shoulder: {joint: a}}
configuration: {a: -2.64, s: 0.43, b: -0.89, p: 0.39}
outputs: [inverse_dynamics]
"""


@pytest.mark.campaign
def test_surplus_rows_hide_no_loss_of_digits() -> None:
    """The angle between the slides is given to a share of itself, and worked out of angles that are not small."""
    model = load_text(SLIDES, "slides.yaml")
    program = draft_of(model, model.outputs, Options()).programs["float64"]
    expected = Expected(model, model.outputs, 16, lambda _: None)
    assert expected.reference.ranks.constraints < expected.reference.system.r
    search, (kernel,) = WorstStateSearch(expected), program.kernels
    search.look(kernel.name, "its method", lambda: kernel)
    assert search.largest(kernel, program.sincos, "float64") > FACTOR


# A jib without a mass on a boom, which a strong spring moves: its drive alone loads the rod.
BOOM = """
model: boom
gravity: [0, -9.81, 0]
parameters: {m: {value: 6}, light: {value: 1e-6}, l: {value: 0.25}}
joints:
  ball: {type: spherical, coordinates: [e0, e1, e2, e3]}
  boom: {type: prismatic, parent: ball, at: [0, 0, 0.6], axis: [1, 2, 3], coordinate: s}
  jib: {type: prismatic, parent: boom, at: [0, 0, l], axis: [1, 0, -1], coordinate: d}
bodies:
  ball: {mass: light, com: [0, 0, 0.3], inertia: {xx: 0.05, yy: 0.06, zz: 0.09}}
  boom: {mass: m, com: [0, 0, l/2], inertia: {xx: 0.02, yy: 0.03, zz: 0.03}}
points:
  hook: {frame: jib, at: [0, 1.2, 0]}
  ground: {at: [0.3, 0.3, -0.4]}
  far: {at: [3, 3, 3]}
loops:
  rod: {type: distance, between: [hook, ground], length: 0.9}
springs:
  rope: {between: [boom, far], stiffness: 1e4, length: 0.5}
inputs:
  winch: {joint: d}
  lift: {joint: s}
outputs: [multipliers]
"""


@pytest.mark.campaign
def test_what_float32_loses_is_measured_where_next_to_nothing_drives() -> None:
    """What the spring leaves of a force that it does not load is all there is then; no estimate tells."""
    model = load_text(BOOM, "boom.yaml")
    draft = draft_of(model, model.outputs, Options())
    programs = draft.programs
    (kernel,), (single,) = programs["float64"].kernels, programs["float32"].kernels
    expected = Expected(model, model.outputs, 16, lambda _: None)
    only = WorstStateSearch(expected)
    only.look(kernel.name, "its method", lambda: kernel)
    assert only.largest(single, programs["float32"].sincos, "float32") < FACTOR  # what the estimates alone find
    expected.values("float32")
    search = WorstStateSearch(expected)
    search.look(kernel.name, "its method", lambda: kernel)
    assert search.largest(kernel, programs["float64"].sincos, "float64") < FACTOR
    assert search.largest(single, programs["float32"].sincos, "float32") > 4 * FACTOR


def test_noise_times_noise_is_no_loss_of_the_first_order() -> None:
    """y = x + 1e10 ((x + 5) - 5 - x) ((x + 7) - 7 - x), of which both brackets are 0 but for roundings."""
    steps: list[tuple[OperationName, str | None, str | int]] = [
        ("add", "x", 5), ("sub", None, 5), ("sub", None, "x"), ("add", "x", 7), ("sub", None, 7), ("sub", None, "x"),
    ]  # fmt: skip
    statements: list[Statement] = []
    for number, (operation, left, right) in enumerate(steps):
        first = Local(f"t{number - 1}") if left is None else Local(left)
        second = Local(right) if isinstance(right, str) else Literal(Fraction(right))
        statements.append(Statement((f"t{number}",), operation, (first, second)))
    statements += [
        Statement(("noise",), "mul", (Local("t2"), Local("t5"))),
        Statement(("large",), "mul", (Local("noise"), Literal(Fraction(10) ** 10))),
        Statement(("y",), "add", (X, Local("large"))),
    ]
    kernel = straight(*statements)
    given = {"q": np.array([[1e-3, 0.0], [0.3, 0.0]])}
    own, unit = RoundingErrors(kernel).with_units(given)
    assert (own / unit).max() < 1
    assert (lost_in_float32(kernel, given) / unit).max() > 1e3 * 2.0**-24


# Nothing but inputs and rates drives it; inputs that move its heavy link hide what its light ones do.
COASTER = """
model: coaster
joints:
  base: {type: revolute, axis: z, coordinate: a}
  light: {type: revolute, parent: base, at: [0.5, 0, 0], axis: z, coordinate: b}
  heavy: {type: revolute, parent: light, at: [0.4, 0, 0], axis: z, coordinate: c}
  small: {type: revolute, parent: heavy, at: [0, 0.3, 0], axis: z, coordinate: d}
  tip: {type: revolute, parent: small, at: [0.3, 0, 0], axis: z, coordinate: e}
bodies:
  base: {mass: 5, com: [0.2, 0, 0], inertia: {zz: 0.1}}
  light: {mass: 1e-3, com: [0.2, 0, 0]}
  heavy: {mass: 1e3, com: [0, 0.1, 0], inertia: {zz: 0.2}}
  small: {mass: 1e-6, com: [0.1, 0, 0]}
  tip: {mass: 5, com: [0.3, 0, 0]}
inputs: {u: {joint: a}, v: {joint: b}, w: {joint: c}, x: {joint: d}, y: {joint: e}}
outputs: [forward_dynamics]
"""


def test_what_is_lost_of_a_machine_that_coasts_is_looked_for() -> None:
    model = load_text(COASTER, "coaster.yaml")
    options = Options(scalars=("float64",), methods={"forward_dynamics": "articulated_by_bodies"})
    program = draft_of(model, ["forward_dynamics"], options).programs["float64"]
    (kernel,) = program.kernels
    expected = Expected(model, ["forward_dynamics"], 32, lambda _: None)
    made = outcomes(kernel, program.sincos, "float64", [sample.state for sample in expected.samples("float64")])
    known = [values["forward_dynamics"] for values in expected.values("float64")]
    errors = [one.in_units(one.distance(result.entries)) for one, result in zip(known, made, strict=True)]
    search = WorstStateSearch(expected)
    search.look(kernel.name, "its method", lambda: kernel)
    assert max(errors) < 2
    assert search.largest(kernel, program.sincos, "float64") > FACTOR
