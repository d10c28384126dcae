"""Base parameters: published counts, closed forms by hand, and machines that move alike."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from functools import cache

import pytest
import shipped
from flint import arb, fmpq
from machines import delta_with_rods, planar_four_bar, rusr_linkage, six_joint_arm
from regressor_machines import MACHINES

from symgen.cli.main import main
from symgen.identification.text import base_parameters_text
from symgen.ir.interpret import Interpreter
from symgen.ir.kernel import Status
from symgen.lowering.schedule import schedule
from symgen.mechanics.genericity import parameter_values
from symgen.mechanics.system import System
from symgen.model.combinations.base_parameters import BaseParameters, NoBodiesError, base_parameters
from symgen.model.combinations.coefficient_forms import recognized
from symgen.model.combinations.constrained_regressor import ConstrainedRegressor
from symgen.model.combinations.geometry import angular_parameters, geometry_values
from symgen.model.combinations.motion_states import BallSystem, motion_states
from symgen.model.combinations.taylor_balls import WideBallError, ball_precision, may_vanish
from symgen.model.configurations.mechanics import default_values
from symgen.model.expressions.walk import evaluate
from symgen.model.inertial_parameters import inertial_parameters, values
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.matrix import flatten

GENERIC = ("1", "0.4", "0.9", "0.7")
BITS = 640


@cache
def known(text: str) -> BaseParameters:
    """Those of the model in a text."""
    return base_parameters(load_text(text, "machine.yaml"))


def counted(text: str) -> tuple[int, int]:
    """As a tree, and with the loops closed."""
    return known(text).as_tree, len(known(text).base)


@pytest.mark.parametrize(
    ("gravity", "count"),
    [("[0, 0, -9.81]", 36), ("[0, -9.81, 0]", 38)],
)
@pytest.mark.campaign
def test_an_arm_of_six_joints_has_the_published_count(gravity: str, count: int) -> None:
    """36 with gravity along the first axis, 38 across: Gautier and Khalil 1990, Mayeda and others 1990."""
    assert counted(six_joint_arm(gravity)) == (count, count)


@pytest.mark.parametrize(
    ("gravity", "counts"),
    [pytest.param("[0, 0, 0]", (5, 4), marks=pytest.mark.campaign), ("[0, -9.81, 0]", (9, 8))],
)
def test_a_loop_in_the_plane_hides_one_more(gravity: str, counts: tuple[int, int]) -> None:
    """A point mass at the pin that closes the loop may count with either bar (inertia transfer)."""
    assert counted(planar_four_bar(gravity, GENERIC)) == counts


def test_a_parallelogram_is_special_and_said_to_be() -> None:
    text = planar_four_bar("[0, -9.81, 0]", ("1", "0.4", "1", "0.4"))
    text = text.replace("a: 1.1, b: -0.9, c: 1.3", "a: 1, b: -1, c: 1")
    shown = base_parameters(load_text(text, "parallelogram.yaml"))
    # the coupler does not turn: one inertia about the pins, two components of gravity
    assert len(shown.base) == 3
    assert shown.elsewhere == 8
    assert "with other lengths 8 can: this geometry is special" in base_parameters_text(shown).replace("\n  ", " ")


@pytest.mark.campaign
@pytest.mark.parametrize(
    ("gravity", "counts"), [("[0, 0, 0]", (11, 10)), ("[0, 0, -9.81]", (13, 12)), ("[1, -5, -9.81]", (15, 14))]
)
def test_a_linkage_in_space(gravity: str, counts: tuple[int, int]) -> None:
    """Crank, universal joint, ball, rocker: without gravity, with it along the axis of the crank, and anywhere."""
    assert counted(rusr_linkage(gravity)) == counts


EVENLY, AT_RIGHT_ANGLES = ("0", "2*pi/3", "4*pi/3"), ("0", "pi/2", "pi")


@pytest.mark.campaign
@pytest.mark.parametrize(
    ("gravity", "turned", "counts"),
    [
        ("[0, 0, 0]", EVENLY, (31, 28)),
        ("[0, 0, -9.81]", EVENLY, (37, 34)),
        ("[0, 0, 0]", AT_RIGHT_ANGLES, (31, 27)),
        ("[0, 0, -9.81]", AT_RIGHT_ANGLES, (37, 33)),
    ],
)
def test_a_delta_whose_rods_are_bodies(gravity: str, turned: tuple[str, ...], counts: tuple[int, int]) -> None:
    """Of 70.  As a tree: an arm shows its inertia and in gravity two first moments, a rod all but its mass, which its
    universal joint lets be the arm's, the platform its mass.  Each ball that closes a loop hides one more, as a mass
    there may count with the rod or the platform; arms at right angles hide one that no transfer explains."""
    shown = known(delta_with_rods(gravity, turned))
    assert len(shown.parameters) == 70
    assert (shown.as_tree, len(shown.base)) == counts


@pytest.mark.campaign
def test_three_arms_in_a_plane_with_gravity() -> None:
    """The 2RRR/RR upright: 18 and 16 where it has 12 and 10 lying, two first moments of each crank more."""
    lying = (shipped.ROOT / "models/rapkm_bodies.yaml").read_text(encoding="utf-8")
    upright = lying.replace("gravity: [0, 0, 0]", "gravity: [0, -9.81, 0]")
    assert upright != lying
    assert counted(upright) == (18, 16)


@pytest.mark.parametrize(
    ("name", "counts"),
    [pytest.param("rapkm_bodies", (12, 10), marks=pytest.mark.campaign), ("front_car_bodies", (8, 7))],
)
def test_shipped_machines(name: str, counts: tuple[int, int]) -> None:
    """The 2RRR/RR without gravity: 12 and 10, rotors among those of the cranks.  The car: 6, and the rotor of a
    wheelset; restricted energies would show one less."""
    shown = base_parameters(shipped.model(name))
    assert (shown.as_tree, len(shown.base)) == counts


def test_a_car_of_two_bodies() -> None:
    """6 of 8 in the plane.  Not the chassis' first moment along its heading: what it does to the traction by turning
    and what by going sideways cancels.  Nor the mass of the wheelset, which counts as the chassis' mass and inertia."""
    text = (shipped.ROOT / "models/front_car_bodies.yaml").read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("rotor_inertias")]
    shown = known("\n".join(lines).replace("wheels:  {mass: m_2}", "wheels:  {mass: m_2, inertia: {zz: Theta_2}}"))
    assert len(shown.base) == 6
    assert "chassis.mx" in {one.name for one in shown.without_effect}
    assert "wheels.m" in {one.name for entry in shown.base for one, _ in entry.added}


def test_attitudes_by_quaternions() -> None:
    """A free body shows ten, one on a revolute joint seven more, and one on a ball all but its mass; turned by nothing
    at first, so that most of each quaternion is 0."""
    assert counted(MACHINES["floating"]) == (26, 26)


def test_closed_forms_of_a_four_bar() -> None:
    """By hand: the mass of the rocker's far pin is seen from the crank through the coupler."""
    shown = known(planar_four_bar("[0, -9.81, 0]", GENERIC))
    lines = base_parameters_text(shown).splitlines()
    entries = [" ".join(line.split()[1:]) for line in lines if line[:4].strip().isdigit()]
    # about the pin: 0.05 + 1.3 (0.4² + 0.04²), and 0.9²/0.7 of 0.9 · 0.3
    assert f"coupler.Izz + (l_2²/l_3) rocker.mx {0.05 + 1.3 * 0.1616 + 0.81 / 0.7 * 0.27:.6g}" in entries
    assert any(entry.startswith("crank.mx + l_1 coupler.m + (l_1/l_3) rocker.mx") for entry in entries)
    assert any(entry.startswith("rocker.Izz - l_3 rocker.mx") for entry in entries)
    assert any("no effect on the inputs: crank m mz Ixx" in line for line in lines)


def _moved(model: Model, seed: int) -> list[tuple[list[float], ...]]:
    """Admissible motions in double precision."""
    made = []
    with ball_precision(BITS):
        system = BallSystem(model, {})
        assert model.assembly is not None
        states = motion_states(system, model.assembly.places[0].q, model.assembly.ranks.constraints)
        for _, state in zip(range(seed), states, strict=False):
            made.append(tuple([float(x.c[k]) * (1, 1, 2)[k] for x in state.q] for k in range(3)))
    return made


def _forces(model: Model, motions: list[tuple[list[float], ...]]) -> list[list[float]]:
    """u by the kernel of inverse dynamics, motion by motion."""
    derived = derive_quantities(model, ["inverse_dynamics"])
    program = schedule(derived.mechanics, derived.quantities, ("float64",))["float64"]
    defaults = default_values(model.parameters)
    numbers = [defaults[p.name] for p in model.parameters]
    made = []
    for q, qd, qdd in motions:
        status, u = Interpreter(program.sincos).run(program.kernels[0], {"q": q, "qd": qd, "qdd": qdd}, numbers)
        assert status == Status.OK
        made.append([*u])
    return made


def _text(parameters: dict[str, float]) -> str:
    """A four-bar with these inertial parameters, given as the file has them: about centres of mass."""
    text = planar_four_bar("[0, -9.81, 0]", GENERIC)
    head, rest = text.split("bodies:\n")
    _, tail = rest.split("frames:\n")
    lines = []
    for body in ("crank", "coupler", "rocker"):
        m, mx, my, inertia = (parameters[f"{body}.{what}"] for what in ("m", "mx", "my", "Izz"))
        x, y = mx / m, my / m
        lines.append(
            f"  {body}: {{mass: {m!r}, com: [{x!r}, {y!r}, 0], inertia: {{zz: {inertia - m * (x * x + y * y)!r}}}}}"
        )
    return f"{head}bodies:\n" + "\n".join(lines) + f"\nframes:\n{tail}"


def _given(model: Model) -> dict[str, float]:
    numbers = default_values(model.parameters)
    made = values(model.mechanism, lambda expression: evaluate(expression, numbers))
    return {one.name: x for one, x in zip(inertial_parameters(model.mechanism), made, strict=True)}


def _least_change(shown: BaseParameters, eliminated: str, size: float) -> dict[str, float]:
    """A change of one eliminated parameter that the base parameters do not see."""
    change = {eliminated: size}
    for one in shown.base:
        for other, form in one.added:
            if other.name == eliminated:
                change[one.stays.name] = -size * form.value
    return change


@pytest.mark.parametrize("eliminated", ["coupler.m", "rocker.mx"])
def test_machines_with_the_same_base_parameters_need_the_same_inputs(eliminated: str) -> None:
    """Seen by the kernels of two models, which know nothing of regressors; a change beside it is seen."""
    text = planar_four_bar("[0, -9.81, 0]", GENERIC)
    model = load_text(text, "four_bar.yaml")
    shown, given, motions = known(text), _given(model), _moved(model, 6)
    before = _forces(model, motions)
    hidden = {name: x + _least_change(shown, eliminated, 0.2).get(name, 0.0) for name, x in given.items()}
    other = _forces(load_text(_text(hidden), "four_bar.yaml"), motions)
    size = max(abs(x) for row in before for x in row)
    assert _furthest(before, other) < 1e-11 * size
    beside_it = {**hidden, "coupler.mx": hidden["coupler.mx"] + 0.02}
    beside = _forces(load_text(_text(beside_it), "four_bar.yaml"), motions)
    assert _furthest(before, beside) > 1e-4 * size


def _furthest(one: list[list[float]], other: list[list[float]]) -> float:
    return max(math.dist(a, b) for a, b in zip(one, other, strict=True))


@pytest.mark.parametrize("name", ["rapkm_bodies", "front_car_bodies"])
def test_rows_times_parameters_are_what_inputs_do(name: str) -> None:
    """F^T Y pi = F^T M u, with u by the kernel, at motions on loops and on rolling wheels."""
    model = shipped.model(name)
    motions = _moved(model, 4)
    forces = _forces(model, motions)
    given = list(_given(model).values())
    columns = _input_columns(model)
    with ball_precision(BITS):
        system = BallSystem(model, {})
        regressor = ConstrainedRegressor(system)
        assert model.assembly is not None
        states = motion_states(system, model.assembly.places[0].q, model.assembly.ranks.constraints)
        for state, u, (q, _, _) in zip(states, forces, motions, strict=False):
            matrix = columns(q)
            for k, row in enumerate(regressor.rows(state)):
                wanted = sum(float(y) * x for y, x in zip(row, given, strict=True))
                direction = [float(state.directions[j][k]) for j in range(model.n)]
                loads = [sum(m * x for m, x in zip(entries, u, strict=True)) for entries in matrix]
                work = sum(d * load for d, load in zip(direction, loads, strict=True))
                assert wanted == pytest.approx(work, rel=1e-9, abs=1e-9)


def _input_columns(model: Model) -> Callable[[list[float]], list[list[float]]]:
    """M at a configuration."""
    mechanics = System(model)
    matrix = Evaluator(flatten(mechanics.control_matrix))
    known = parameter_values(mechanics)

    def at(q: list[float]) -> list[list[float]]:
        entries = matrix({**known, **{c.name: x for c, x in zip(model.coordinates, q, strict=True)}})
        return [entries[j * model.m : (j + 1) * model.m] for j in range(model.n)]

    return at


def test_numbers_are_recognized_where_balls_are_narrow() -> None:
    with ball_precision(BITS):
        assert recognized(arb(fmpq(-29, 50))) == (Fraction(-29, 50), 1)
        assert recognized(arb(3).sqrt() / 2) == (Fraction(1, 2), 3)
        assert recognized(arb.pi()) is None
        with pytest.raises(WideBallError):
            may_vanish(arb(0, 1e-6))
        assert not may_vanish(arb(1, 0.5))


def test_numbers_of_the_geometry_are_those_of_the_file() -> None:
    """What is made of pi stays exact: a machine whose arms stand at 120 degrees would not be special beside them."""
    text = planar_four_bar("[0, -9.81, 0]", GENERIC)
    text = text.replace("  l_0: {value: 1}", "  l_0: {value: third*3}\n  turned: {value: 2*pi/3}\n  idle: {value: 5}")
    text = text.replace("parameters:", "parameters:\n  third: {value: 1/3}")
    text = text.replace("rocker: {type: revolute,", "rocker: {type: revolute, rotation: [[z, turned]],", 1)
    text = text.replace("c: 1.3", "c: -0.8")
    values_of_geometry = geometry_values(load_text(text, "four_bar.yaml"))
    assert values_of_geometry["third"] == Fraction(1, 3)
    assert set(values_of_geometry) == {"third", "l_1", "l_2", "l_3"}


def test_a_model_of_energies_is_told_what_is_missing(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(NoBodiesError):
        base_parameters(shipped.model("front_car"))
    assert main(["explain", str(shipped.ROOT / "models/front_car.yaml"), "base_parameters"]) == 1
    assert "base parameters are those of `bodies`" in capsys.readouterr().err


def test_the_command_fits_a_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", str(shipped.ROOT / "models/front_car_bodies.yaml"), "base_parameters"]) == 0
    text = capsys.readouterr().out
    assert max(map(len, text.splitlines())) <= 80
    assert text.startswith("base parameters of front_car_bodies\n7 of 21 inertial parameters can be told apart")


def test_what_an_angle_changes_is_no_polynomial_and_lengths_beside_it_keep_their_forms() -> None:
    """None is looked for: a parameter that stands in sines, or turns a frame, is an angle whatever its unit says."""
    text = planar_four_bar("[0, -9.81, 0]", GENERIC)
    text = text.replace("rocker: {type: revolute,", "rocker: {type: revolute, rotation: [[z, tilt]],", 1)
    text = text.replace("at: [l_1, 0, 0]", "at: [l_1*cos(bend), l_1*sin(bend), 0]", 1)
    text = text.replace("parameters:", "parameters:\n  tilt: {value: 1/3}\n  bend: {value: 1/4}")
    model = load_text(text, "bent.yaml")
    assert angular_parameters(model) == {"tilt", "bend"}
    forms = [form for one in base_parameters(model).base for _, form in one.added]
    assert any({"tilt", "bend"}.intersection(form.changed_by) for form in forms)
    assert any(name.startswith("l_") for form in forms for term in form.terms for name, _ in term.powers)
