"""Loops closed by full joints: a free body held by a loop moves as one that hangs on the joint itself."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from symgen.diagnostics import ModelError
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.symbolic.evaluate import Evaluator
from symgen.verify.reference.reference import Reference, State
from symgen.verify.sampling.states import sample_states
from symgen.verify.tolerance import expectations

GUIDE = "guide: {translation: [0.5, -0.2, 0.1], rotation: [[x, 0.3], [y, -0.4]]}"
BODY = "{mass: 2, com: [0.1, 0.05, -0.02], inertia: {xx: 0.03, yy: 0.02, zz: 0.04, xy: 0.005}}"
PLACE = {"s": 0.2, "w": -0.3, "a": 0.5, "e": 0.6}
# joint: its coordinates, the way of the body's origin in the guide's axes, and the freedom that the loop must leave
JOINTS: dict[str, tuple[tuple[str, ...], tuple[float, float, float], int]] = {
    "revolute": (("a",), (0.0, 0.0, 0.0), 1),
    "prismatic": (("s",), (0.0, 0.0, 0.2), 1),
    "cylindrical": (("s", "a"), (0.0, 0.0, 0.2), 2),
    "planar": (("s", "w", "a"), (0.2, -0.3, 0.0), 3),
    "spherical": (("e_0", "e_1", "e_2", "e_3"), (0.0, 0.0, 0.0), 3),
}


def turned(axis: int, angle: float) -> np.ndarray:
    """Quaternion of a turn about a main axis."""
    e = np.zeros(4)
    e[0], e[axis + 1] = math.cos(angle / 2), math.sin(angle / 2)
    return e


def times(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Product of two quaternions."""
    vector = a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])
    return np.array([a[0] * b[0] - a[1:] @ b[1:], *vector])


def matrix(e: np.ndarray) -> np.ndarray:
    w, (x, y, z) = e[0], e[1:]
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(np.eye(3) + 2 * w * skew + 2 * skew @ skew)


def accelerations(model: Model, q: list[float]) -> np.ndarray:
    """q_ddot at rest under gravity alone."""
    none = (0,) * model.n
    state = State(tuple(q), none, none, (), ())
    return np.array([float(x) for x in Reference(model).matrices(state, ["forward_dynamics"])["forward_dynamics"]])


def held_by_loop(kind: str, more: str = "") -> Model:
    text = f"""\
model: held
joints: {{free: {{type: floating, child: body, coordinates: [x, y, z, e_0, e_1, e_2, e_3]}}}}
frames: {{{GUIDE}}}
bodies: {{body: {BODY}}}
gravity: [1, -2, -9]
loops: {{hold: {{type: {kind}, between: [body, guide]}}}}
{more}"""
    return load_text(text, "held.yaml")


@pytest.mark.parametrize("kind", JOINTS)
def test_a_loop_holds_what_its_joint_holds(kind: str) -> None:
    names, offset, freedom = JOINTS[kind]
    spherical = kind == "spherical"
    guide = times(turned(0, 0.3), turned(1, -0.4))
    angle = 0.5 if "a" in names else 0.0
    own = np.array([0.8, 0.2, -0.4, 0.4]) if spherical else turned(2, angle)
    place = np.array([0.5, -0.2, 0.1]) + matrix(guide) @ np.array(offset)
    q = [*place.tolist(), *times(guide, own).tolist()]

    start = dict(zip(("x", "y", "z", "e_0", "e_1", "e_2", "e_3"), q, strict=True))
    listed = ", ".join(f"{name}: {value!r}" for name, value in start.items())
    loop = held_by_loop(kind, f"configuration: {{{listed}}}\n")
    reference = Reference(loop)
    assert loop.n - reference.ranks.constraints == freedom

    tree = load_text(
        f"""\
model: tree
joints: {{hold: {{type: {kind}, parent: guide, child: body, coordinates: [{", ".join(names)}]}}}}
frames: {{{GUIDE}}}
bodies: {{body: {BODY}}}
gravity: [1, -2, -9]
""",
        "tree.yaml",
    )
    hung = accelerations(tree, list(own) if spherical else [PLACE[name] for name in names])
    qdd = accelerations(loop, q)

    along, about = np.zeros(3), np.zeros(3)
    if spherical:
        about = 2 * times(np.array([own[0], *-own[1:]]), hung)[1:]
        about = matrix(own) @ about
    else:
        by_name = dict(zip(names, hung, strict=True))
        about[2] = by_name.get("a", 0.0)
        along = np.array([by_name["s"], by_name["w"], 0]) if kind == "planar" else np.array([0, 0, by_name.get("s", 0)])
    e = np.array(q[3:])
    angular = 2 * times(qdd[3:], np.array([e[0], *-e[1:]]))[1:]
    assert qdd[:3] == pytest.approx(matrix(guide) @ along, abs=1e-12)
    assert angular == pytest.approx(matrix(guide) @ about, abs=1e-12)


def test_a_fixed_loop_leaves_no_freedom() -> None:
    guide = times(turned(0, 0.3), turned(1, -0.4))
    e = ", ".join(f"e_{i}: {value!r}" for i, value in enumerate(guide.tolist()))
    with pytest.raises(ModelError, match=r"7 coordinates under 7 independent constraints \(δ = 0\)"):
        held_by_loop("fixed", f"configuration: {{x: 0.5, y: -0.2, z: 0.1, {e}}}\n")


@pytest.mark.parametrize("kind", ["cylindrical", "prismatic"])
def test_a_plane_slider_needs_two_rows(kind: str) -> None:
    """What a joint holds across the plane of a plane mechanism holds anyway."""
    text = f"""\
model: slider
joints:
  crank: {{type: revolute, axis: z, coordinate: a}}
  rod: {{type: revolute, parent: crank, axis: z, at: [0.3, 0, 0], coordinate: b}}
  block: {{type: revolute, parent: rod, axis: z, at: [0.8, 0, 0], coordinate: c}}
bodies:
  rod: {{mass: 1, inertia: {{zz: 0.1}}}}
  block: {{mass: 1, inertia: {{zz: 0.1}}}}
gravity: [0, -9.81, 0]
loops: {{guide: {{type: {kind}, between: [block, world], axis: x}}}}
configuration: {{a: 0.5, b: -0.7, c: 0.2}}
"""
    assert [row.name for row in load_text(text, "m.yaml").constraints] == ["guide_y", "guide_tilt_y"]


@pytest.mark.parametrize("axis", ["[0, 3, 4]", "[0, 0.6, 0.8]", "[0, 3*k, 4*k]", "[0, 1.5, 2]"])
@pytest.mark.parametrize("kind", ["prismatic", "cylindrical"])
def test_the_length_of_a_slide_axis_does_not_matter(kind: str, axis: str) -> None:
    names = "s, a" if kind == "cylindrical" else "s"
    model = load_text(
        f"""\
model: slide
parameters: {{k: 0.7}}
joints: {{slide: {{type: {kind}, child: body, axis: {axis}, coordinates: [{names}]}}}}
bodies: {{body: {{mass: 2, inertia: {{xx: 1, yy: 1, zz: 1}}}}}}
gravity: [0, 0, -10]
""",
        "slide.yaml",
    )
    zero = (0,) * model.n
    state = State((0.3,) * model.n, zero, zero, (), (0.7,))
    matrices = Reference(model).matrices(state, ["mass_matrix", "forward_dynamics"])
    assert float(matrices["mass_matrix"][0, 0]) == pytest.approx(2, abs=1e-14)
    assert float(matrices["forward_dynamics"][0, 0]) == pytest.approx(-8, abs=1e-13)


LOCKED = """\
model: locked
joints:
  rail: {type: prismatic, axis: [0, 3, 4], coordinate: s, rotation: [[z, 0.2]]}
  arm:  {type: revolute, parent: rail, axis: z, coordinate: a, at: [0.1, 0, 0]}
  rod:  {type: spherical, parent: arm, at: [0.5, 0, 0], coordinates: [e_0, e_1, e_2, e_3]}
frames:
  guide: {translation: [0.5, 0.5, 0.1], rotation: [[x, 0.3]]}
  end: {parent: rod, translation: [0.4, 0, 0]}
bodies: {rod: {mass: 1, inertia: {xx: 1, yy: 1, zz: 1}}, arm: {mass: 1, inertia: {xx: 1, yy: 1, zz: 1}}}
gravity: [0, 0, -9.81]
loops: {close: {type: cylindrical, between: [end, guide], axis: x}}
inputs: {f: {unit: N, joint: s}}
outputs: [forward_dynamics]
"""


def test_an_input_that_only_loads_a_loop_moves_nothing() -> None:
    """The slide is locked by the line that the arm's tip is held on; what is left is a spin of the rod."""
    ranks = Reference(load_text(LOCKED, "locked.yaml")).ranks
    assert (6 - ranks.constraints, ranks.actuation) == (1, 0)


def test_what_cannot_move_is_told() -> None:
    (notice,) = load_text(LOCKED, "locked.yaml").notices
    assert notice.message.startswith("`s`, `a` cannot move: the constraints hold s = 0.125, a = 0.7497; ")
    assert load_text(LOCKED.replace("cylindrical", "point"), "free.yaml").notices == ()


@pytest.mark.mechanisms
def test_gravity_that_the_loop_carries_leaves_no_rounding_in_a_slow_spin() -> None:
    """The spin at 1 mrad/s changes by 1e-6: a residue of gravity, eps times 10, would be all that is seen of it."""
    model = load_text(LOCKED, "locked.yaml")
    reference = Reference(model)
    (quantity,) = derive_quantities(model, model.outputs).quantities
    for sample in sample_states(reference, model.outputs, 8)[::2]:
        state = replace(sample.state, qd=tuple(1e-3 * x for x in sample.state.qd))
        coordinates = model.coordinates
        values = dict(zip((c.name for c in coordinates), state.q, strict=True))
        values |= zip((c.rate for c in coordinates), state.qd, strict=True)
        values |= {"f": state.u[0]}
        expected = expectations(reference, state, model.outputs, "float64", "spin")["forward_dynamics"]
        assert expected.in_units(expected.distance(Evaluator(quantity.outputs)(values))) < 16
