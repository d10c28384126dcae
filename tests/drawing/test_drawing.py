"""Pictures of machines: what joints let move, how they are looked at, and what of it is drawn."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from symgen.drawing.pose import MachinePose
from symgen.drawing.sketch import NAMED_JOINTS, sketch
from symgen.drawing.svg import DRIVEN, drawing
from symgen.drawing.view import view_of
from symgen.model.kinematics.triples import cross
from symgen.model.load import load_model, load_text
from symgen.model.model import Model

MODELS = Path(__file__).parents[2] / "models"
# Given by bodies; energies have no places.
BY_ENERGIES = "\nkinetic_energy:"
DRAWN = [path.stem for path in sorted(MODELS.glob("*.yaml")) if BY_ENERGIES not in path.read_text(encoding="utf-8")]
CRANE = """model: crane
parameters: {h: {value: 3, unit: m}, l: {value: 1.5, unit: m}, m: {value: 5, unit: kg}}
gravity: [0, 0, -9.81]
frames:
  rail: {translation: [0, 0, h]}
joints:
  carriage: {type: prismatic, parent: rail, axis: x, coordinate: x}
  hook: {type: revolute, parent: carriage, axis: y, coordinate: theta}
bodies:
  carriage: {mass: 2*m}
  load: {frame: hook, mass: m, com: [0, 0, -l], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
points:
  tip: {frame: hook, at: [0, 0, -l]}
inputs: {F: {joint: x}}
configuration: {x: 0.8, theta: 0.5}
"""


def crane(**changed: str) -> Model:
    text = CRANE
    for before, after in changed.items():
        text = text.replace(before, after)
    return load_text(text, "crane.yaml")


def test_joints_are_where_they_are_and_move_as_they_do() -> None:
    rail, carriage, hook = MachinePose(crane()).joints
    assert (rail.kind, carriage.kind, hook.kind) == ("fixed", "sliding", "turning")
    assert (carriage.slides, carriage.turns) == (((1, 0, 0),), ())
    assert (hook.slides, hook.turns) == ((), ((0, 1, 0),))
    assert (carriage.foot, carriage.place) == ((0, 0, 3), pytest.approx((0.8, 0, 3)))
    assert (carriage.inputs, hook.inputs) == (("F",), ())
    four = "coordinates: [e0, e1, e2, e3]"
    ball = crane(**{"type: revolute": "type: spherical", "axis: y, coordinate: theta": four, ", theta: 0.5": ""})
    assert [joint.kind for joint in MachinePose(ball).joints] == ["fixed", "sliding", "ball"]


def test_a_joint_between_absolute_angles_turns_about_one_axis() -> None:
    """The angle of the second link against the first is b - a: it has b for its own."""
    text = """model: absolute
coordinates: {a: {unit: rad}, b: {unit: rad}}
frames:
  one: {rotation: [[[1, 1, 0], a]]}
  two: {parent: one, translation: [0, 0, 1], rotation: [[[1, 1, 0], b - a]]}
bodies: {one: {mass: 1, com: [0, 0, 1]}, two: {mass: 1, com: [0, 0, 1]}}
inputs: {u: {joint: b}}
configuration: {a: 0.3, b: 1.1}
"""
    one, two = MachinePose(load_text(text, "absolute.yaml")).joints
    assert (one.kind, two.kind) == ("turning", "turning")
    assert (one.coordinates, two.coordinates, two.inputs) == (("a",), ("b",), ("u",))
    assert [abs(x) for x in two.turns[0]] == pytest.approx((0.5**0.5, 0.5**0.5, 0))


@pytest.mark.parametrize(("gravity", "up"), [("[0, 0, 9.81]", -1), ("[0, 0, -9.81]", 1), ("[0, 9.81, 0]", 1)])
def test_gravity_says_what_is_up(gravity: str, up: int) -> None:
    """In a plane and in space; gravity that is square to a plane says nothing."""
    flat = view_of(MachinePose(crane(**{"[0, 0, -9.81]": gravity})))
    assert flat.planar
    assert flat.up == (0, 0, up)
    assert cross(flat.right, flat.up) == flat.near
    aside = view_of(MachinePose(crane(**{"[0, 0, -9.81]": gravity, "axis: y": "axis: z"})))
    assert not aside.planar
    assert aside.depth((0, 0, up)) > 0 or gravity == "[0, 9.81, 0]"
    assert cross(aside.right, aside.up) == pytest.approx(aside.near)


def test_a_machine_in_a_plane_is_looked_at_straight_on() -> None:
    flat = view_of(MachinePose(crane()))
    assert flat.planar
    # x to the right, z up: the load hangs below its carriage
    assert (flat.flat((1, 5, 0)), flat.flat((0, 5, 1))) == ((1, 0), (0, 1))
    tilted = view_of(MachinePose(load_model(MODELS / "tilted_four_bar.yaml")))
    assert tilted.planar
    assert tilted.up[1] > 0.5
    for one in (tilted.right, tilted.up):
        assert sum(a * b for a, b in zip(one, tilted.near, strict=True)) == pytest.approx(0, abs=1e-12)


def test_a_machine_in_space_is_seen_from_above_and_aside() -> None:
    view = view_of(MachinePose(crane(**{"axis: y": "axis: z"})))
    assert not view.planar
    assert view.up[2] > 0.8
    assert view.depth((0, 0, 1)) > 0
    # gravity says what is up
    other = view_of(MachinePose(crane(**{"axis: y": "axis: z", "[0, 0, -9.81]": "[0, -9.81, 0]"})))
    assert other.up[1] > 0.8


@pytest.mark.parametrize("name", DRAWN)
def test_all_that_moves_or_drives_stands_in_the_picture(name: str) -> None:
    model = load_model(MODELS / f"{name}.yaml")
    pose = MachinePose(model)
    shown = sketch(pose)
    named = [coordinate for label in shown.labels for coordinate in label.coordinates]
    moving = [joint for joint in pose.joints if joint.coordinates]
    turned = {coordinate for joint in moving for coordinate in joint.coordinates}
    # of a long chain there is room for some names
    assert sorted(named) == sorted(turned) if len(moving) <= NAMED_JOINTS else set(named) < turned
    driven = [symbol for symbol in shown.symbols if "driven" in symbol.mark]
    assert len(driven) == sum(bool(joint.inputs) for joint in pose.joints if joint.kind in ("turning", "sliding"))
    text = drawing(model)
    assert text is not None
    root = ElementTree.fromstring(text)
    assert text.count(f'fill="{DRIVEN}" stroke') == len(driven)
    left, _, width, height = map(float, root.attrib["viewBox"].split())
    for x, y in re.findall(r'c[xy]="([-\d.]+)" c[xy]="([-\d.]+)"', text):
        assert left <= float(x) <= left + width
        assert 0 <= float(y) <= height
    assert drawing(model) == text


def test_loops_close_in_a_pin() -> None:
    """The three legs of the RA-PKM meet in one point, which is drawn once."""
    shown = sketch(MachinePose(load_model(MODELS / "rapkm_bodies.yaml")))
    assert [symbol.mark for symbol in shown.symbols].count("pin") == 1
    assert [symbol.mark for symbol in shown.symbols].count("ground") == 3
    assert sum(stroke.role == "link" for stroke in shown.strokes) == 6


def test_a_link_with_three_joints_is_a_plate() -> None:
    shown = sketch(MachinePose(load_model(MODELS / "three_rrr.yaml")))
    plates = [stroke for stroke in shown.strokes if stroke.role == "link" and stroke.closed]
    assert [len(plate.places) for plate in plates] == [3]


def test_names_are_letters_with_indices_and_point_names_stay() -> None:
    text = drawing(crane(**{"coordinate: x": "coordinate: x_1", "{joint: x}": "{joint: x_1}", "{x: 0.8": "{x_1: 0.8"}))
    assert text is not None
    assert ">θ<" in text
    assert re.search(r">x<tspan[^>]*>1</tspan>", text)
    assert ">tip<" in text


def test_energies_alone_have_no_picture() -> None:
    assert drawing(load_model(MODELS / "front_car.yaml")) is None


def test_definitions_that_nest_are_looked_through_once() -> None:
    """Sixty definitions that use the one before twice would be looked through 1e18 times."""
    definitions = "\n".join(["  d_0: theta", *(f"  d_{k}: (d_{k - 1} + d_{k - 1})/2" for k in range(1, 60))])
    model = load_text(
        f"""model: nested
coordinates: {{theta: {{unit: rad}}}}
definitions:
{definitions}
frames: {{arm: {{rotation: [[y, d_59]]}}}}
bodies: {{arm: {{mass: 1, com: [1, 0, 0]}}}}
""",
        "nested.yaml",
    )
    (arm,) = MachinePose(model).joints
    assert (arm.kind, arm.coordinates) == ("turning", ("theta",))


def test_a_picture_that_has_no_places_is_none() -> None:
    """A slide whose place has the reciprocal of its coordinate in it has none at 0."""
    model = load_text(
        """model: hyperbola
coordinates: {y: {unit: m, range: [1, 2]}}
frames: {slide: {translation: [0, 0, 1/y]}}
bodies: {slide: {mass: 1}}
configuration: {y: 1.5}
""",
        "hyperbola.yaml",
    )
    assert drawing(model) is None
