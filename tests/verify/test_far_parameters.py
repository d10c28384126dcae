"""Parameters far from their values: where a kernel loses digits there is a bound, and within it none is lost."""

from __future__ import annotations

import json
import random
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from symgen.generation.acceptance.parameter_bounds import ParameterBounds
from symgen.generation.acceptance.recorded import as_recorded
from symgen.generation.draft import draft_of
from symgen.generation.notices import notices
from symgen.generation.results import Options, Result
from symgen.ir.bounded import Bound
from symgen.ir.kernel import Block, Check, Kernel, Literal, Load, Local, Program, Scalar, Statement, Status
from symgen.ir.pairs.wide import widened
from symgen.model.load import load_model
from symgen.pipeline import generate
from symgen.verify.expected import Expected
from symgen.verify.interpreted import outcomes
from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.margins.far_errors import Far, FarErrors
from symgen.verify.margins.far_parameters import (
    BEFORE_A_LOSS,
    FAR_STATES,
    MOST,
    MOST_OF_OTHERS,
    UNITS_LOST,
    FarParameters,
    _Bounds,
)
from symgen.verify.margins.far_states import FAR_STARTS, FURTHEST, QUARTER, FarStates
from symgen.verify.reference.reference import State
from symgen.verify.sampling.plain_values import values_at
from symgen.verify.tolerance import FACTOR, expectations

# Three links whose end is stayed to a wall: of two directions the last link takes both where it is heavy.
CRANE = """
model: crane
parameters:
  l_1: {value: 0.9, unit: m}
  l_2: {value: 0.7, unit: m}
  m_1: {value: 2, unit: kg}
  m_2: {value: 1.5, unit: kg}
  m_3: {value: 0.4, unit: kg}
  d: {value: 1.1, unit: m}
gravity: [0, "-9.81", 0]
joints:
  j_1: {type: revolute, axis: z, coordinate: a}
  j_2: {type: revolute, parent: j_1, at: [l_1, 0, 0], axis: z, coordinate: b}
  j_3: {type: revolute, parent: j_2, at: [l_2, 0, 0], axis: z, coordinate: c}
bodies:
  j_1: {mass: m_1, com: [l_1/2, 0, 0], inertia: {zz: 0.1}}
  j_2: {mass: m_2, com: [l_2/2, 0, 0], inertia: {zz: 0.05}}
  j_3: {mass: m_3, com: [0.2, 0.1, 0], inertia: {zz: 0.01}}
points:
  hook: {frame: j_3, at: [0.3, 0, 0]}
  wall: {at: [1.3, 1.2, 0]}
loops:
  stay: {type: distance, between: [hook, wall], length: d}
inputs:
  u: {joint: a}
outputs: [forward_dynamics, multipliers]
configuration: {a: 0.3, b: 0.9, c: -0.4}
"""
MASS, MULTIPLIERS = "m_3", "multipliers"
SCALARS: tuple[Scalar, ...] = ("float64", "float32")


@pytest.fixture(scope="module")
def crane(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("crane") / "crane.yaml"
    path.write_text(CRANE, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def made(crane: Path) -> Result:
    return generate(crane, Options(parts=("c",)), lambda _: None)


@pytest.fixture(scope="module")
def expected(crane: Path) -> Expected:
    return Expected(load_model(crane), (MULTIPLIERS,), 16, lambda _: None)


def straight(*statements: Statement) -> Kernel:
    """A kernel of the first and the third coordinate's rates, a mass and a length."""
    loads = (Load("a", "qd", 0), Load("c", "qd", 2), Load("m", "p", 4, MASS), Load("d", "p", 5, "d"))
    return Kernel(MULTIPLIERS, (), loads, (Block(statements, ()),), (Local(statements[-1].targets[0]),), (1,))


def bounds_by_name(expected: Expected, kernel: Kernel, scalar: Scalar = "float64") -> dict[str, Bound]:
    kernels = dict.fromkeys(SCALARS, kernel)
    programs = {scalar: Program(scalar, None, (kernel,)) for scalar in SCALARS}
    return {bound.parameter: bound for bound in FarParameters(expected).bounds(kernels, programs)[scalar]}


@pytest.mark.campaign
def test_what_hides_the_rest_is_bounded_above(expected: Expected) -> None:
    """(c d + m a / 1000) - m a / 1000 loses c d when m is large."""
    small = Statement(("s",), "mul", (Local("m"), Literal(Fraction(1, 1000))))
    kernel = straight(
        small,
        Statement(("ma",), "mul", (Local("s"), Local("a"))),
        Statement(("cd",), "mul", (Local("c"), Local("d"))),
        Statement(("sum",), "add", (Local("cd"), Local("ma"))),
        Statement(("y",), "sub", (Local("sum"), Local("ma"))),
    )
    bound = bounds_by_name(expected, kernel)[MASS]
    assert bound.low is None
    assert bound.high is not None
    assert 1e2 < bound.high < 1e5


def test_other_long_kernels_share_what_three_may_take(expected: Expected, monkeypatch: pytest.MonkeyPatch) -> None:
    """And u, accelerations and multipliers are looked at in full beside them."""
    far = FarParameters(expected)
    double = Statement(("s",), "add", (Local("m"), Local("m")))
    main, long = straight(double), straight(*[replace(double, targets=(f"s{k}",)) for k in range(20_000)])
    short, other = (replace(kernel, name="mass_matrix") for kernel in (main, long))
    assert far.share([long] * 40) == far.share([short] * 40) == far.share([other] * (MOST_OF_OTHERS // MOST)) == 1
    assert far.share([other] * 12 + [long, short]) == pytest.approx(MOST_OF_OTHERS / MOST / 12, rel=1e-3)
    assert far.share([]) == 1
    afforded: list[int] = []

    def noted(search: _Bounds, _: object) -> dict[Scalar, tuple[Bound, ...]]:
        afforded.append(search._most)
        return {}

    monkeypatch.setattr(_Bounds, "of", noted)
    for kernel in (main, short):
        programs = {scalar: Program(scalar, None, (kernel,)) for scalar in SCALARS}
        far.bounds(dict.fromkeys(SCALARS, kernel), programs, share=0.25)
    assert afforded == [MOST, MOST // 4]


@pytest.mark.campaign
def test_what_is_divided_by_is_bounded_below(expected: Expected) -> None:
    """(c m + a / (1000 d)) - a / (1000 d) loses c m when d is small."""
    kernel = straight(
        Statement(("s",), "mul", (Local("d"), Literal(Fraction(1000)))),
        Statement(("ad",), "div", (Local("a"), Local("s"))),
        Statement(("cm",), "mul", (Local("c"), Local("m"))),
        Statement(("sum",), "add", (Local("cm"), Local("ad"))),
        Statement(("y",), "sub", (Local("sum"), Local("ad"))),
    )
    bound = bounds_by_name(expected, kernel)["d"]
    assert bound.high is None
    assert bound.low is not None
    names = [parameter.name for parameter in expected.reference.model.parameters]
    states, d, m = FarStates(expected), names.index("d"), names.index(MASS)

    def hidden(power: float) -> float:
        """What c m loses at most, of its own size, in roundoffs: as many times as large is what it is added to."""
        given = states.led([(d, -power)], FAR_STARTS).given
        a, c = given["qd"][:, 0], given["qd"][:, 2]
        return float(np.abs(a / (1000 * given["p"][:, d]) / (c * given["p"][:, m])).max())

    lost = next(power for power in np.arange(QUARTER, FURTHEST, QUARTER) if hidden(power) > UNITS_LOST)
    assert lost > 1
    # a power of ten before it, and no closer than that to what is in the file, in two digits upwards
    nearest = 1.1 * 10.0 ** -max(lost - BEFORE_A_LOSS, 1.0)
    assert nearest <= bound.low <= 1.1 * nearest


@pytest.mark.campaign
def test_what_few_states_lose_is_bounded(expected: Expected) -> None:
    """(c d + h) - h with h = m 1e-12 / ((a - a_13)^2 + 1e-12), which hides c d at the thirteenth state alone."""
    place = 12
    assert place >= FAR_STATES
    names = [parameter.name for parameter in expected.reference.model.parameters]
    led = FarStates(expected).led([(names.index(MASS), 3.0)], place + 1)
    there = Fraction(float(led.given["qd"][led.starts == place][0, 0]))
    tiny = Literal(Fraction(1, 10**12))
    kernel = straight(
        Statement(("e",), "sub", (Local("a"), Literal(there))),
        Statement(("ee",), "mul", (Local("e"), Local("e"))),
        Statement(("f",), "add", (Local("ee"), tiny)),
        Statement(("s",), "mul", (Local("m"), tiny)),
        Statement(("h",), "div", (Local("s"), Local("f"))),
        Statement(("cd",), "mul", (Local("c"), Local("d"))),
        Statement(("sum",), "add", (Local("cd"), Local("h"))),
        Statement(("y",), "sub", (Local("sum"), Local("h"))),
    )
    bound = bounds_by_name(expected, kernel)[MASS]
    assert bound.low is None
    assert bound.high is not None


@pytest.mark.campaign
def test_what_float32_does_not_hold_is_bounded(expected: Expected) -> None:
    """m^6 / m^5 where m^6 is no number of float32 any more."""
    powers = [Statement((f"p{k}",), "mul", (Local(f"p{k - 1}" if k > 2 else "m"), Local("m"))) for k in range(2, 7)]
    kernel = straight(*powers, Statement(("y",), "div", (Local("p6"), Local("p5"))))
    bound = bounds_by_name(expected, kernel, "float32")[MASS]
    assert bound.low is not None
    assert 1e-8 < bound.low < 1e-5
    assert bounds_by_name(expected, kernel, "float64") == {}


@pytest.mark.campaign
@pytest.mark.filterwarnings("error")
def test_a_type_may_refuse_where_nothing_is_estimated(expected: Expected) -> None:
    """The squares of errors of m^18 are no numbers of float64 any more, m^18 none of float32."""
    powers = [Statement((f"p{k}",), "mul", (Local(f"p{k - 1}" if k > 2 else "m"), Local("m"))) for k in range(2, 19)]
    bound = bounds_by_name(expected, straight(*powers), "float32")[MASS]
    assert bound.high is not None
    assert 10 < bound.high < 1e3


@pytest.mark.campaign
@pytest.mark.parametrize(
    "status", [Status.MASS_RANK, Status.CONSTRAINT_RANK, Status.ACTUATION_RANK, Status.NOT_FINITE]
)
@pytest.mark.parametrize("scalar", SCALARS)
def test_what_is_taken_for_none_beside_a_mass_is_bounded(expected: Expected, scalar: Scalar, status: Status) -> None:
    """c d is no share of m any more, although nothing is lost; neither rows nor inputs are near a drop of rank."""
    share = Statement(("share",), "mul", (Local("m"), Literal(Fraction(1, 10**6))))
    check = Check(status, Local("d"), Local("share"))
    loads = (Load("c", "qd", 2), Load("m", "p", 4, MASS), Load("d", "p", 5, "d"))
    product = Statement(("y",), "mul", (Local("c"), Local("d")))
    kernel = Kernel(MULTIPLIERS, (), loads, (Block((share,), (check,)), Block((product,), ())), (Local("y"),), (1,))
    bound = bounds_by_name(expected, kernel, scalar)[MASS]
    assert bound.low is None
    assert bound.high is not None
    assert 1e5 < bound.high < 1e7


@pytest.mark.campaign
def test_pairs_of_float32_are_bounded_by_what_plain_numbers_lose(expected: Expected) -> None:
    """(c d + m m a) - m m a has as many digits more with pairs: of float64 the last of them go with a mass of 1e9."""
    plain = straight(
        Statement(("ma",), "mul", (Local("m"), Local("a"))),
        Statement(("mma",), "mul", (Local("m"), Local("ma"))),
        Statement(("cd",), "mul", (Local("c"), Local("d"))),
        Statement(("sum",), "add", (Local("cd"), Local("mma"))),
        Statement(("y",), "sub", (Local("sum"), Local("mma"))),
    )
    kernels = {scalar: widened(plain, scalar) for scalar in SCALARS}
    programs = {scalar: Program(scalar, None, (kernels[scalar],)) for scalar in SCALARS}
    bounds = FarParameters(expected).bounds(kernels, programs, plain)
    (bound,) = bounds["float64"]
    assert bound.high is not None
    assert bound.high > 1e7
    bound = {one.parameter: one for one in bounds["float32"]}[MASS]
    assert bound.low is None
    assert bound.high is not None
    assert 1e2 < bound.high < 1e5


@pytest.mark.campaign
def test_plain_numbers_of_float32_beside_pairs_of_float64_are_bounded(expected: Expected) -> None:
    """One type alone may need twice the digits: (c d + m a) - m a in plain numbers loses a digit by each power of m."""
    plain = straight(
        Statement(("ma",), "mul", (Local("m"), Local("a"))),
        Statement(("cd",), "mul", (Local("c"), Local("d"))),
        Statement(("sum",), "add", (Local("cd"), Local("ma"))),
        Statement(("y",), "sub", (Local("sum"), Local("ma"))),
    )
    kernels: dict[Scalar, Kernel] = {"float64": widened(plain, "float64"), "float32": plain}
    programs = {scalar: Program(scalar, None, (kernels[scalar],)) for scalar in SCALARS}
    bounds = FarParameters(expected).bounds(kernels, programs, plain)
    assert bounds["float64"] == ()
    (bound,) = (one for one in bounds["float32"] if one.parameter == MASS)
    assert bound.high is not None
    assert bound.high < 1e2


@pytest.mark.campaign
def test_what_a_type_loses_further_away_does_not_move_the_bound_of_the_other(
    monkeypatch: pytest.MonkeyPatch, expected: Expected
) -> None:
    """One seems to lose from the first power of ten on, where the reference finds nothing, one from the eighth."""
    losses: dict[Scalar, float] = {"float64": 1.0, "float32": 8.0}

    def units(_: FarErrors, far: Far, _ranked: bool) -> dict[Scalar, Lanes]:
        mass = far.parameters == 4
        return {scalar: np.where(mass & (far.powers >= lost), 1e3, 0.0) for scalar, lost in losses.items()}

    monkeypatch.setattr(FarErrors, "units", units)
    monkeypatch.setattr(FarParameters, "is_lost", lambda *_: False)
    kernel = straight(Statement(("y",), "mul", (Local("c"), Local("m"))))
    most = max(float(sample.state.parameters[4]) for sample in expected.drawn)
    for scalar, power in (("float64", 1.0), ("float32", 7.0)):
        bound = bounds_by_name(expected, kernel, scalar)[MASS]
        assert bound.high is not None
        assert float(bound.high) == pytest.approx(most * 10**power, rel=0.06)


def test_where_float32_has_no_digit_the_states_are_where_float64_loses_most(expected: Expected) -> None:
    """c d + h - 49 (h / 49) with h large at one state alone; m^5 / m^5 is no number of float32 at any."""
    place = 30
    start = FarStates(expected).shifted([(0, 1.0)], place + 1)["q"][place, 0]
    tiny = Literal(Fraction(1, 10**12))
    powers = [Statement((f"p{k}",), "mul", (Local(f"p{k - 1}" if k > 2 else "m"), Local("m"))) for k in range(2, 6)]
    statements = (
        *powers,
        Statement(("one",), "div", (Local("p5"), Local("p5"))),
        Statement(("e",), "sub", (Local("q"), Literal(Fraction(float(start))))),
        Statement(("ee",), "mul", (Local("e"), Local("e"))),
        Statement(("f",), "add", (Local("ee"), tiny)),
        Statement(("m1",), "mul", (Local("m"), Local("one"))),
        Statement(("s",), "mul", (Local("m1"), tiny)),
        Statement(("h",), "div", (Local("s"), Local("f"))),
        Statement(("part",), "mul", (Local("h"), Literal(Fraction(1, 49)))),
        Statement(("whole",), "mul", (Local("part"), Literal(Fraction(49)))),
        Statement(("cd",), "mul", (Local("c"), Local("d"))),
        Statement(("sum",), "add", (Local("cd"), Local("h"))),
        Statement(("y",), "sub", (Local("sum"), Local("whole"))),
    )
    kernel = straight(*statements)
    kernel = replace(kernel, loads=(*kernel.loads, Load("q", "q", 0)))
    bound = bounds_by_name(expected, kernel)[MASS]
    assert bound.high is not None
    assert bound.high < 1e4


def test_what_loses_nothing_has_no_bound(expected: Expected) -> None:
    kernel = straight(
        Statement(("cm",), "mul", (Local("c"), Local("m"))), Statement(("y",), "div", (Local("cm"), Local("d")))
    )
    assert bounds_by_name(expected, kernel) == {}


def with_an_offset(path: Path, of: str) -> Expected:
    """Of the crane with its hook beside its last link by a parameter `k`, which comes before `d`."""
    text = CRANE.replace("  d: {", f"  k: {{{of}, unit: m}}\n  d: {{").replace("[0.3, 0, 0]", "[0.3, k, 0]")
    path.write_text(text, encoding="utf-8")
    return Expected(load_model(path), (MULTIPLIERS,), 16, lambda _: None)


def of_an_offset(*statements: Statement) -> Kernel:
    loads = (Load("a", "qd", 0), Load("k", "p", 5, "k"), Load("d", "p", 6, "d"))
    return Kernel(MULTIPLIERS, (), loads, (Block(statements, ()),), (Local(statements[-1].targets[0]),), (1,))


@pytest.mark.campaign
@pytest.mark.parametrize("ends", ["[0, 1]", "[-1, 1]"])
def test_a_range_that_includes_0_is_not_bounded_below(ends: str, tmp_path: Path) -> None:
    """(k + x - x) (d + x - x) loses what is small of both; a bound of k would refuse a part of its range."""
    small = Literal(Fraction(1, 100))
    kernel = of_an_offset(
        Statement(("k_x",), "add", (Local("k"), small)),
        Statement(("k_",), "sub", (Local("k_x"), small)),
        Statement(("d_x",), "add", (Local("d"), small)),
        Statement(("d_",), "sub", (Local("d_x"), small)),
        Statement(("y",), "mul", (Local("k_"), Local("d_"))),
    )
    expected = with_an_offset(tmp_path / "crane.yaml", f"value: 0.1, range: {ends}")
    (bound,) = bounds_by_name(expected, kernel).values()
    assert bound.parameter == "d"
    assert bound.low is not None


@pytest.mark.campaign
def test_what_is_0_at_every_state_has_no_bound(tmp_path: Path) -> None:
    """d + k + x - x loses d and k whatever they are."""
    large = Literal(Fraction(10**6))
    kernel = of_an_offset(
        Statement(("d_k",), "add", (Local("d"), Local("k"))),
        Statement(("d_x",), "add", (Local("d_k"), large)),
        Statement(("y",), "sub", (Local("d_x"), large)),
    )
    bounds = bounds_by_name(with_an_offset(tmp_path / "crane.yaml", "value: 0"), kernel)
    assert "d" in bounds
    assert "k" not in bounds


@pytest.mark.campaign
def test_status_0_means_a_result_within_the_tolerance_however_large_the_mass(made: Result, expected: Expected) -> None:
    program = made.programs["float64"]
    kernel = next(one for one in program.kernels if one.name == MULTIPLIERS)
    place = next(k for k, p in enumerate(made.model.parameters) if p.name == MASS)
    counts = {Status.OK: 0, Status.PARAMETER_RANGE: 0}
    dice = random.Random("masses")
    for sample in expected.drawn:
        parameters = list(map(float, sample.state.parameters))
        parameters[place] *= 10 ** dice.uniform(-9, 9)
        state = replace(sample.state, parameters=tuple(parameters))
        (outcome,) = outcomes(kernel, program.sincos, "float64", [state])
        counts[Status(outcome.status)] += 1
        if not outcome.status:
            truth = expectations(expected.reference, state, [MULTIPLIERS], "float64", "far")[MULTIPLIERS]
            assert truth.in_units(truth.distance(outcome.entries)) <= FACTOR
    assert min(counts.values()) > 2


# A roller whose arms, as long on both sides, are far longer than what it rolls on: rates follow from these lengths.
CART = """
model: cart
parameters: {R: {value: 0.3}, m: {value: 2}, w: {value: 0.25}}
gravity: [0, 0, -9.81]
joints:
  deck: {type: planar, at: [0, 0, R], coordinates: [x, y, theta]}
  left: {type: revolute, axis: y, parent: deck, at: [0, w, 0], coordinate: s_1}
  right: {type: revolute, axis: y, parent: deck, at: [0, "-w", 0], coordinate: s_2}
bodies:
  deck: {mass: m, inertia: {zz: 0.3}, com: [0.12, 0, 0.05]}
  left: {mass: 1.1, inertia: {xx: 0.01, yy: 0.02, zz: 0.01}}
  right: {mass: 0.6, inertia: {xx: 0.01, yy: 0.02, zz: 0.01}}
rolling:
  on_left: {frame: left, radius: R}
  on_right: {frame: right, radius: R}
inputs: {u_1: {joint: s_1}, u_2: {joint: s_2}}
outputs: [multipliers]
configuration: {theta: -1.9}
"""


def test_all_starts_that_a_length_leads_are_looked_at(expected: Expected) -> None:
    """Of a length that moves the loop nobody knows before which start is worst; of a mass a few chosen ones do."""
    names = [parameter.name for parameter in expected.reference.model.parameters]
    states = FarStates(expected)
    assert names.index("d") in states.leading
    assert MASS not in {names[k] for k in states.leading}
    led = states.led([(names.index("d"), 0.25), (names.index(MASS), 1.0)], FAR_STATES, led=FAR_STARTS)
    of_length, of_mass = (led.parameters == names.index(name) for name in ("d", MASS))
    assert of_mass.sum() == FAR_STATES
    assert of_length.sum() == states.led([(names.index("d"), 0.25)], FAR_STARTS).parameters.size > FAR_STATES


def test_states_far_away_satisfy_the_constraints_there(tmp_path: Path) -> None:
    """Rates that the rows of other lengths allow break those of this one, and what breaks hides what is lost."""
    path = tmp_path / "cart.yaml"
    path.write_text(CART, encoding="utf-8")
    expected = Expected(load_model(path), (MULTIPLIERS,), 16, lambda _: None)
    names = [p.name for p in expected.reference.model.parameters]
    far = FarStates(expected).led([(names.index("w"), 3.0)], 8)
    assert len(far) == 8
    for k in range(len(far)):
        parts = (tuple(far.given[part][k]) for part in ("q", "qd", "qdd", "u", "p"))
        state = State(*parts)
        values = values_at(expected.reference, state, ["admissible_velocity", "admissible_acceleration"])
        assert state.qd == pytest.approx(values["admissible_velocity"], abs=1e-9)
        assert state.qdd == pytest.approx(values["admissible_acceleration"], abs=1e-3)


@pytest.mark.parametrize(("lost", "bound"), [(0.25, 0.25), (1.0, 0.75), (1.5, 1.0), (2.0, 1.0), (6.25, 5.25)])
def test_a_bound_is_a_power_of_ten_before_a_loss_that_no_reference_has_judged(
    monkeypatch: pytest.MonkeyPatch, expected: Expected, lost: float, bound: float
) -> None:
    def units(_: FarErrors, far: Far, _ranked: bool) -> dict[Scalar, Lanes]:
        worse = (far.parameters == 4) & (far.powers >= lost)
        return {scalar: np.where(worse, 1e3, 0.0) for scalar in SCALARS}

    monkeypatch.setattr(FarErrors, "units", units)
    monkeypatch.setattr(FarParameters, "is_lost", lambda *_: True)
    kernel = straight(Statement(("y",), "mul", (Local("c"), Local("m"))))
    bound_of_mass = bounds_by_name(expected, kernel)[MASS]
    most = max(float(sample.state.parameters[4]) for sample in expected.drawn)
    assert bound_of_mass.high is not None
    assert float(bound_of_mass.high) == pytest.approx(most * 10**bound, rel=0.06)


def test_a_bound_is_recorded_told_and_taken_up_again(made: Result, tmp_path: Path) -> None:
    record = json.loads(made.files["derivation.json"])
    low, high = record["kernels"][MULTIPLIERS]["bounds"]["float64"][MASS]
    assert low is None
    assert "PARAMETER_RANGE" in record["kernels"][MULTIPLIERS]["statuses"]
    assert f"{MASS} <= {high:g}" in str(made.files["c/crane.h"])
    (tmp_path / "crane").mkdir()
    (tmp_path / "crane" / "derivation.json").write_text(str(made.files["derivation.json"]), encoding="utf-8")
    again = as_recorded(made.model, made.model.outputs, Options(measured=tmp_path))
    assert again.written == made.programs


@pytest.mark.campaign
def test_parameters_that_stay_those_of_the_file_have_none(crane: Path) -> None:
    fixed = generate(crane, Options(parts=("c",), states=8, fixed_parameters=True), lambda _: None)
    record = json.loads(fixed.files["derivation.json"])["kernels"][MULTIPLIERS]
    assert "bounds" not in record
    assert "PARAMETER_RANGE" not in record["statuses"]


@pytest.mark.campaign
def test_a_type_that_is_left_out_has_no_bounds(crane: Path, expected: Expected) -> None:
    bounds = ParameterBounds(expected)
    draft = bounds.of(draft_of(load_model(crane), (MULTIPLIERS,), Options()))
    rest = bounds.of(draft.without(MULTIPLIERS, ("float32",), "lost"))
    assert [list(every) for every in draft.bounds.values()] == [[MULTIPLIERS], [MULTIPLIERS]]
    assert rest.bounds == {"float64": draft.bounds["float64"], "float32": {}}


def test_a_bound_close_by_is_told(crane: Path) -> None:
    model = load_model(crane)
    draft = draft_of(model, (MULTIPLIERS,), Options())
    bounds = (Bound(MASS, Fraction(1, 1000), Fraction(3)), Bound("l_1", Fraction(1, 5), Fraction(400)))
    reported = notices(replace(draft, bounds={"float32": {MULTIPLIERS: bounds}}), Options(), None)
    assert [one.message for one in reported if MULTIPLIERS in one.message] == [
        "multipliers refuses l_1 below 0.2, m_3 above 3: it would lose digits; a `range` has it verified further"
    ]


@pytest.mark.campaign
def test_a_declared_range_lies_within_the_bounds(tmp_path: Path) -> None:
    path = tmp_path / "crane.yaml"
    path.write_text(CRANE.replace("m_3: {value: 0.4, unit: kg}", "m_3: {value: 0.4, unit: kg, range: [0.1, 500]}"))
    result = generate(path, Options(parts=("c",)), lambda _: None)
    assert not result.failures
    bounds = json.loads(result.files["derivation.json"])["kernels"][MULTIPLIERS].get("bounds", {})
    for by_parameter in bounds.values():
        assert by_parameter.get(MASS, (None, None))[1] is None or by_parameter[MASS][1] >= 500


@pytest.mark.campaign
def test_a_linkage_without_parameters_has_no_bounds(tmp_path: Path) -> None:
    values = {"l_1": "0.9", "l_2": "0.7", "m_1": "2", "m_2": "1.5", "m_3": "0.4", "length: d": "length: 1.1"}
    head, _, rest = CRANE.partition("gravity:")
    for name, value in values.items():
        rest = rest.replace(name, value)
    path = tmp_path / "crane.yaml"
    path.write_text(f"{head.partition('parameters:')[0]}gravity:{rest}", encoding="utf-8")
    result = generate(path, Options(parts=("c",), states=8), lambda _: None)
    assert not result.failures
    assert not any("bounds" in kernel for kernel in json.loads(result.files["derivation.json"])["kernels"].values())
