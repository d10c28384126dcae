"""Free bodies moved by twists: the same u with fewer operations, the coordinates' own singularity, and where not."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from functools import cache

import pytest
from flint import arb, ctx
from shipped import ROOT, sparing

from symgen.linear_algebra.guards import Guard
from symgen.mechanics.genericity import genericity
from symgen.mechanics.rigid_bodies.body_axes import BodyAxes
from symgen.mechanics.rigid_bodies.free_bodies import free_bodies
from symgen.mechanics.system import System
from symgen.methods.inverse_dynamics.forces_eliminated import elimination_candidate
from symgen.methods.method import INPUTS, Candidate
from symgen.methods.quantity import Quantity
from symgen.methods.selection import Methods
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.symbolic.calculus import gradient
from symgen.symbolic.evaluate import FUNCTIONS, Evaluator
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import cost, topological

TEXT = (ROOT / "models" / "gough_stewart.yaml").read_text("utf-8")
PLATFORM = "  platform: {translation: [x, y, z], rotation: [[z, psi], [y, theta], [x, phi]]}\n"
LEG = "leg_1: (head_1.x - foot_1.x)**2 + (head_1.y - foot_1.y)**2 + (head_1.z - foot_1.z)**2 - s_1**2"
HEAD = "head_2: {frame: platform, at: [r*cos(pi/3 - gamma), r*sin(pi/3 - gamma), 0]}"

PARAMETERS = {
    "R": 0.6,
    "r": 0.35,
    "beta": 0.2,
    "gamma": 0.25,
    "m_s": 3.0,
    "m": 40.0,
    "h": 0.05,
    "J_x": 1.6,
    "J_y": 1.7,
    "J_z": 3.0,
    "g": 9.81,
}

# what is written in another way, and what stays free
SAME = {
    "as shipped": (),
    "frames in a row": (
        (PLATFORM, "  slide: {translation: [x, 0, z]}\n  side: {parent: slide, translation: [0, y, 0]}\n"
         "  yaw: {parent: side, rotation: [[z, psi]]}\n"
         "  platform: {parent: yaw, rotation: [[y, theta], [x, phi]]}\n"),
    ),
    "other turns and another origin": (
        (PLATFORM, "  platform: {translation: [x, y, h + z], rotation: [[x, phi], [y, theta], [x, psi]]}\n"),
    ),
    "a head above the plate": ((HEAD, HEAD.replace(", 0]}", ", h]}")),),
    "a leg along an axis": ((LEG, "leg_1: head_1.y + 0.3*head_1.z - foot_1.x - s_1"),),
    "a leg measured the other way": ((LEG, LEG.replace("head_1.x - foot_1.x", "foot_1.x - head_1.x")),),
    "a mass in the middle": (("com: [0, 0, h]", "com: [0, 0, 0]"),),
}  # fmt: skip
# what the six coordinates do besides
OTHERWISE = {
    "a rotor": ("rotor_inertias: {", "rotor_inertias: {psi: J_z, "),
    "an input": ("  f_1: {unit: N, description: force of leg 1, joint: s_1}", "  f_1: {unit: N, joint: x}"),
    "damping": ("inputs:\n", "applied_forces: {z: -m*g}\ninputs:\n"),
    "an energy": ("inputs:\n", "potential_energy: m*g*x\ninputs:\n"),
    "an energy of a point": ("inputs:\n", "potential_energy: m*g*head_1.x\ninputs:\n"),
    "a force at a head": (
        "inputs:\n",
        "forces: {wind: {point: head_1, direction: [1, 0, 0], magnitude: m*g}}\ninputs:\n",
    ),
    "a row of an angle": (LEG, "leg_1: r*psi - s_1"),
    "a frame on the platform": (PLATFORM, PLATFORM + "  tool: {parent: platform, translation: [0, 0, h]}\n"),
    "a frame that moves along": (PLATFORM, PLATFORM + "  shadow: {translation: [x, 0, 0]}\n"),
    "a head that slides": (HEAD, HEAD.replace(", 0]}", ", s_1/5]}")),
    "turns along": (PLATFORM, PLATFORM.replace("[x, phi]", "[x, phi + s_1/r]")),
}


@cache
def described(*changes: tuple[str, str]) -> Model:
    text = TEXT
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return load_text(text, "platform.yaml")


@cache
def both(name: str) -> tuple[Quantity, Quantity]:
    """u by rates of coordinates and by twists."""
    model = described(*SAME[name])
    generic = genericity(System(model))
    first, second = (elimination_candidate(mechanics, generic) for mechanics in (System(model), BodyAxes(model)))
    assert first is not None
    assert second is not None
    return first.derived, second.derived


def swept(model: Model) -> Quantity:
    """u in the coordinates with rows that are differentiated as they stand, not by what they hold."""
    mechanics = System(model)
    mechanics.__dict__["geometric_jacobian"] = tuple(
        tuple(gradient(mechanics.graph, row, mechanics.q)) for row in mechanics.constraint_residual
    )
    candidate = elimination_candidate(mechanics, genericity(System(model)))
    assert candidate is not None
    return candidate.derived


def state(model: Model, seed: int, **given: float) -> dict[str, float]:
    source = random.Random(seed)
    at = dict(PARAMETERS)
    for c in model.coordinates:
        at |= {c.name: source.uniform(-0.4, 0.4), c.rate: source.uniform(-1, 1), c.acceleration: source.uniform(-3, 3)}
    at |= {f"s_{k}": source.uniform(0.7, 1.2) for k in range(1, 7)}
    return {**at, "z": source.uniform(0.8, 1), **given}


@pytest.mark.slow
@pytest.mark.parametrize("name", sparing(SAME, list(SAME)[3:]))
def test_u_is_the_same_and_shorter(name: str) -> None:
    model, (apart, twists) = described(*SAME[name]), both(name)
    for seed in range(4):
        at = state(model, seed)
        expected = Evaluator(apart.outputs)(at)
        assert Evaluator(twists.outputs)(at) == pytest.approx(expected, rel=1e-9, abs=1e-9 * max(map(abs, expected)))
    assert cost(twists.outputs).weight < cost(apart.outputs).weight
    assert cost(twists.outputs).weight < 0.85 * cost(swept(model).outputs).weight


def test_the_cheapest_elimination_is_that_in_body_axes() -> None:
    model = described()
    methods = Methods(model, genericity(System(model)))
    made = methods.candidate(INPUTS, "elimination")
    assert isinstance(made, Candidate)
    assert isinstance(made.system.mechanics, BodyAxes)
    validity = methods.validity(made)
    assert validity.admitted
    # a search for zeros would take seconds
    assert not validity.searched
    count = cost(made.derived.outputs)
    assert count.additive + count.multiplications <= 600


def test_moments_are_taken_where_they_vanish() -> None:
    mechanics = BodyAxes(described())
    moments = [[row[j].is_zero for j in (9, 10, 11)] for row in mechanics.constraint_jacobian]
    assert moments[0] == [True, True, True]
    assert sum(x for row in moments for x in row) == 4


def measure(guard: Guard, at: dict[str, float]) -> float:
    assert guard.scale is not None
    denominator, scale = Evaluator([guard.denominator, guard.scale])(at)
    return float(denominator / scale)


def test_the_angles_own_singularity_is_tested() -> None:
    model, (apart, twists) = described(), both("as shipped")
    (old,), (new,) = apart.guards, twists.guards
    assert old.status == new.status
    steep = state(model, 1, theta=math.pi / 2)
    for guard in (old, new):
        assert measure(guard, state(model, 1)) > 1e-8
        assert measure(guard, steep) < 1e-30
    # both forget the same factor on the way there
    near = [state(model, 1, theta=math.pi / 2 - turn) for turn in (1e-3, 1e-4)]
    for guard in (old, new):
        assert measure(guard, near[0]) / measure(guard, near[1]) == pytest.approx(100, rel=0.05)


def test_the_rank_of_b_is_that_in_the_coordinates() -> None:
    model, (own,) = described(), both("as shipped")[1].guards
    (guard,) = own.first
    steep = state(model, 2, theta=math.pi / 2)
    still = steep | {f"s_{k}": 0.0 for k in range(1, 7)}
    # at that pitch the rows of the angles depend on each other, those of the legs hold the rank of B
    assert guard.status != own.status
    assert measure(guard, steep) > 1e-12
    assert measure(guard, still) < 1e-30
    assert measure(guard, still | {"theta": 0.2}) > 1e-12


@pytest.mark.slow
@pytest.mark.parametrize("name", OTHERWISE)
def test_bodies_that_something_else_knows_keep_their_rates(name: str) -> None:
    assert free_bodies(System(described(OTHERWISE[name]))) == ()


def test_models_without_such_bodies() -> None:
    for name in ("arm7", "delta", "rapkm_bodies", "rolling_disc"):
        text = (ROOT / "models" / f"{name}.yaml").read_text("utf-8")
        assert free_bodies(System(load_text(text, f"{name}.yaml"))) == ()


def exactly(outputs: Sequence[Scalar], at: dict[str, float]) -> list[float]:
    """The scalars to 60 digits, rounded."""
    by_scalar: dict[Scalar, arb] = {}
    with ctx.workdps(60):
        for node in topological(outputs):
            args = [by_scalar[argument] for argument in node.args]
            match node.op:
                case "symbol":
                    by_scalar[node] = arb(at[str(node.payload)])
                case "copysign":
                    by_scalar[node] = abs(args[0]) if float(args[1]) >= 0 else -abs(args[0])
                case _ if node.constant is not None:
                    by_scalar[node] = arb(node.constant.numerator) / node.constant.denominator
                case "sin" | "cos" | "sqrt":
                    by_scalar[node] = getattr(args[0], node.op)()
                case _:
                    by_scalar[node] = FUNCTIONS[node.op](*args)
        return [float(by_scalar[output]) for output in outputs]


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("where", ["steep", "flat"])
def test_digits_are_kept_towards_singularities(where: str, gap: float) -> None:
    model, (_, twists) = described(), both("as shipped")
    for seed in range(5):
        at = state(model, seed)
        close = {"theta": math.pi / 2 - gap} if where == "steep" else {k: gap * at[k] for k in ("z", "theta", "phi")}
        expected = exactly(twists.outputs, at | close)
        values = Evaluator(twists.outputs)(at | close)
        assert values == pytest.approx(expected, rel=1e-11, abs=1e-13 * max(map(abs, expected)))
