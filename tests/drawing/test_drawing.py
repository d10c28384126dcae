"""Pictures of machines: what joints let move, how they are looked at, and what of it is drawn."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import pytest

from symgen.diagnostics import ModelError
from symgen.drawing.forces import DrawnForce, drawn_forces
from symgen.drawing.lengths import drawn_lengths
from symgen.drawing.names import Bar, Box, Wanted, placed
from symgen.drawing.pose import MachinePose
from symgen.drawing.scene import IN_WORLD, scene
from symgen.drawing.sketch import NAMED_JOINTS, sketch
from symgen.drawing.svg import DRIVEN, Paper, drawing
from symgen.drawing.view import ABOVE, view_of
from symgen.model.kinematics.triples import cross
from symgen.model.load import load_model, load_text
from symgen.model.mechanism import NO_MECHANISM
from symgen.model.model import Model

MODELS = Path(__file__).parents[2] / "models"
DRAWN = [path.stem for path in sorted(MODELS.glob("*.yaml"))]
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
    turned |= {coordinate for leg in drawn_lengths(pose) for coordinate in leg.coordinates}
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


ON_BODIES = """model: pushed
parameters: {l: {value: 1, unit: m}, m: {value: 1, unit: kg}}
gravity: [0, 0, -9.81]
joints:
  cart: {type: prismatic, axis: x, coordinate: x}
  arm: {type: revolute, parent: cart, axis: y, coordinate: a}
bodies: {cart: {mass: m}, arm: {mass: m, com: [0, 0, -l/2], inertia: {yy: m*l**2/12}}}
definitions: {c: cos(a)}
points:
  tip: {frame: arm, at: [0, 0, -l]}
  wall: {at: [-1.5, 0, 0]}
inputs:
  push: {unit: N, point: tip, direction: [c, 0, sin(a)]}
  along: {unit: N, point: tip, direction: [1, 0, 0], axes: arm}
  across: {unit: N, point: tip, direction: [0, 1, 0]}
  pull: {unit: N, cable: [wall, cart]}
  turn: {unit: N*m, torque_on: arm, direction: [0, 1, 0]}
  pair: {unit: N, point: tip, direction: [0, 0, 2], reaction: cart}
configuration: {x: 0.2, a: 0.5}
"""


def test_inputs_that_act_on_bodies_are_arrows() -> None:
    """In the direction of the force on what moves; the wall that a cable ends at takes none."""
    model = load_text(ON_BODIES, "pushed.yaml")
    pose = MachinePose(model)
    c, s = math.cos(0.5), math.sin(0.5)
    tip = pose.places["tip"]
    expected = [
        ("push", tip, (c, 0, s)),
        ("along", tip, (c, 0, -s)),
        ("across", tip, (0, 1, 0)),
        ("pull", pose.places["cart"], (-1, 0, 0)),
        ("turn", pose.places["arm"], None),
        ("pair", tip, (0, 0, 1)),
        ("pair", pose.places["cart"], (0, 0, -1)),
    ]
    shown = list(drawn_forces(pose))
    assert [(force.input, force.place) for force in shown] == [(name, place) for name, place, _ in expected]
    for force, (_, _, direction) in zip(shown, expected, strict=True):
        assert force.direction == (direction and pytest.approx(direction))
    drawn = sketch(pose)
    # one of them points away from the eye
    assert [stroke.role for stroke in drawn.strokes].count("force") == 5
    assert {name for label in drawn.labels for name in label.inputs} == {one.name for one in model.inputs}
    text = drawing(model)
    assert text is not None
    assert text.count('<path d="M2 0 L-8 -4 V4 Z"') == 5


def test_legs_that_equations_speak_of_are_lines() -> None:
    """Of the Gough-Stewart platform whose legs are coordinates, with their names and forces."""
    pose = MachinePose(load_model(MODELS / "gough_stewart.yaml"))
    legs = list(drawn_lengths(pose))
    assert [leg.ends for leg in legs] == [(f"head_{k}", f"foot_{k}") for k in range(1, 7)]
    assert [(leg.coordinates, leg.inputs) for leg in legs] == [((f"s_{k}",), (f"f_{k}",)) for k in range(1, 7)]
    shown = sketch(pose)
    assert [stroke.role for stroke in shown.strokes].count("tie") == 6
    assert {name for label in shown.labels for name in label.inputs} == {f"f_{k}" for k in range(1, 7)}
    # rods of a word of the language are drawn once, points of loops meet, and other rows are about something else
    for name in ("delta", "rapkm_bodies", "gough_loops"):
        assert not list(drawn_lengths(MachinePose(load_model(MODELS / f"{name}.yaml"))))
    level = "constraints: {geometric: {level: tip.z - 2*wall.z - tip.x + wall.x}}"
    beside = ON_BODIES.replace("inputs:", f"{level}\ninputs:")
    assert not list(drawn_lengths(MachinePose(load_text(beside, "pushed.yaml"))))


POINTS = """model: car_by_energies
coordinates: {x: {unit: m}, y: {unit: m}, theta: {unit: rad}}
parameters: {L: {value: 2.6, unit: m}, m: {value: 100, unit: kg}, J: {value: 100, unit: kg*m**2}}
kinetic_energy: m/2*(x_dot**2 + y_dot**2) + J/2*theta_dot**2
definitions: {ahead: x + L*cos(theta)}
points:
  rear: {at: [x, y, 0]}
  front: {at: [ahead, y + L*sin(theta), 0]}
  post: {at: [1, 0, 0]}
constraints: {nonholonomic: {axle: sin(theta)*x_dot - cos(theta)*y_dot}}
inputs: {F: {unit: N, acts_on: {x: cos(theta), y: sin(theta)}}}
configuration: {x: 0, y: 0, theta: 0.3}
"""


def test_points_of_a_model_by_energies_are_drawn() -> None:
    """They move in the world, which carries the one that stays where it is."""
    pose = MachinePose(load_text(POINTS, "car_by_energies.yaml"))
    shown = sketch(pose)
    assert shown.planar
    assert [symbol.mark for symbol in shown.symbols].count("point") == 3
    assert [symbol.place for symbol in shown.symbols if symbol.mark == "ground"] == [(1, 0)]
    assert [label.point or label.inputs for label in shown.labels] == ["rear", "front", "post", ("F",)]
    assert [stroke.role for stroke in shown.strokes if stroke.role != "axis"] == ["force"]
    assert drawing(pose.model) is not None


def test_links_that_lie_above_each_other_are_looked_at_straight_on() -> None:
    """The rods of the five-bar turn 2 cm above its cranks, and its base stands elsewhere."""
    view = view_of(MachinePose(load_model(MODELS / "five_bar.yaml")))
    assert view.planar
    assert view.near == (0, 0, 1)
    # far apart they are seen from aside, and so is what moves along the axes
    tall = crane(**{"axis: y": "axis: z", "at: [0, 0, -l]": "at: [0, 0, -2*h]"})
    assert not view_of(MachinePose(tall)).planar
    assert not view_of(MachinePose(load_model(MODELS / "scara.yaml"))).planar


@pytest.mark.parametrize("name", DRAWN)
def test_names_of_shipped_machines_do_not_cover_each_other(name: str) -> None:
    """Nor joints, where there is room beside them."""
    paper = Paper(sketch(MachinePose(load_model(MODELS / f"{name}.yaml"))))
    boxes = [one.box for one in paper.standing()]
    assert not [(a, b) for a, b in combinations(boxes, 2) if a.common(b)]


def test_a_name_gives_way_to_lines_marks_and_edges() -> None:
    place = (100.0, 100.0)
    name = Wanted(place, (0.0, 1.0), 40.0, 14.0, 12.0, 19.0)
    (alone,) = placed([name], [], [], 400)
    assert (alone.x, alone.anchor) == (100, "middle")
    assert alone.box.bottom < 100
    # a line through that place, upwards
    (beside,) = placed([name], [Bar(place, (100.0, 0.0), 6.0)], [], 400)
    assert beside.anchor != "middle"
    assert beside.box.grown(6.0).covers(place, (100.0, 0.0)) == 0
    # another name comes second
    first, second = placed([name, name], [], [], 400)
    assert first == alone
    assert first.box.common(second.box) == 0
    (moved,) = placed([name], [], [alone.box], 400)
    assert moved.box.common(alone.box) == 0
    # no room above
    high = Wanted((100.0, 8.0), (0.0, 1.0), 40.0, 14.0, 12.0, 19.0)
    (below,) = placed([high], [], [], 400)
    assert below.box.top >= 0


def test_the_length_of_a_line_inside_a_rectangle() -> None:
    box = Box(0.0, 0.0, 4.0, 3.0)
    assert box.covers((-1.0, 1.0), (10.0, 1.0)) == pytest.approx(4)
    assert box.covers((0.0, 0.0), (4.0, 3.0)) == pytest.approx(5)
    assert box.covers((1.0, 1.0), (1.0, 2.0)) == pytest.approx(1)
    assert box.covers((-1.0, 2.0), (2.0, 5.0)) == 0
    assert box.covers((5.0, 0.0), (5.0, 3.0)) == 0
    assert box.covers((2.0, 1.0), (2.0, 9.0)) == pytest.approx(2)


def test_energies_alone_have_no_picture() -> None:
    text = (MODELS / "front_car.yaml").read_text(encoding="utf-8")
    assert drawing(load_text(re.split(r"^(?:published|picture):", text, flags=re.M)[0], "front_car.yaml")) is None


def test_what_is_drawn_of_energies_is_in_no_equation() -> None:
    """The model has no frames; its picture has the car's wheels from the edge, and the force where it acts."""
    text = (MODELS / "front_car.yaml").read_text(encoding="utf-8")
    model, plain = (load_text(part, "front_car.yaml") for part in (text, text[: text.index("\npicture:")]))
    assert replace(model, picture=NO_MECHANISM, text_hash=plain.text_hash, notices=plain.notices) == plain
    pose = MachinePose(model)
    shown = sketch(pose)
    tyres = [stroke.places for stroke in shown.strokes if stroke.role == "tyre"]
    lengths = [math.dist(*ends) for ends in tyres]
    assert lengths == pytest.approx([0.6] * 4)
    ahead = [math.atan2(end[1] - start[1], end[0] - start[0]) % math.pi for start, end in tyres]
    assert ahead == pytest.approx([0.3, 0.3, 0.5, 0.5])
    (force,) = drawn_forces(pose)
    assert (force.input, force.place) == ("K_f", pose.places["front"])
    assert force.direction == pytest.approx((math.cos(0.5), math.sin(0.5), 0))
    assert [label.inputs for label in shown.labels if label.inputs] == [("T",), ("K_f",)]
    # the axes of the world stand on the chassis, which would hide them
    roles = [stroke.role for stroke in shown.strokes]
    assert roles.index("axis") > roles.index("link")


def test_an_input_on_coordinates_is_a_force_where_one_of_1_does_the_same() -> None:
    def forces(acts_on: str) -> list[DrawnForce]:
        text = POINTS.replace("{x: cos(theta), y: sin(theta)}", acts_on)
        return list(drawn_forces(MachinePose(load_text(text, "car_by_energies.yaml"))))

    at_front = "{x: -sin(theta), y: cos(theta), theta: L}"
    (rear,), (front,) = forces("{x: cos(theta), y: sin(theta)}"), forces(at_front)
    assert (rear.place, rear.direction) == ((0, 0, 0), pytest.approx((math.cos(0.3), math.sin(0.3), 0)))
    assert front.place == pytest.approx((2.6 * math.cos(0.3), 2.6 * math.sin(0.3), 0))
    assert front.direction == pytest.approx((-math.sin(0.3), math.cos(0.3), 0))
    # twice the force, a force beside both points, and one coordinate alone
    assert not forces("{x: 2*cos(theta), y: 2*sin(theta)}")
    assert not forces("{x: cos(theta), y: sin(theta), theta: L}")
    assert not forces("{theta: L}")


DRAWN_CRANK = """model: crank
coordinates: {a: {unit: rad}, s: {unit: m}}
parameters: {r: {value: 0.1, unit: m}, m: {value: 1, unit: kg}}
kinetic_energy: m/2*(s_dot**2 + r**2*a_dot**2)
inputs: {T: {unit: N*m, acts_on: {a: 1}}}
configuration: {a: 1, s: 0.3}
picture:
  frames:
    slide: {translation: [s, 0, 0]}
    flange: {parent: wheel}
    wheel: {rotation: [[z, a]]}
  points: {pin: {frame: wheel, at: [r, 0, 0]}, wall: {at: [1, 0, 0]}}
  wheels: {rim: {frame: wheel, radius: 2*r, axle: z}}
  springs: {spring: [wall, slide]}
"""


def test_a_picture_has_frames_points_wheels_and_springs() -> None:
    model = load_text(DRAWN_CRANK, "crank.yaml")
    assert [frame.name for frame in model.picture.frames] == ["slide", "wheel", "flange"]
    shown = sketch(MachinePose(model))
    round_or_stretched = [stroke.role for stroke in shown.strokes if stroke.role in ("wheel", "tyre", "spring")]
    assert round_or_stretched == ["wheel", "spring"]
    assert math.dist(shown.strokes[2].places[0], (0, 0)) == pytest.approx(0.2)
    # a slider of the world has a guide where it is, and no stand where it would be at 0
    marks = [symbol.mark for symbol in shown.symbols]
    assert (marks.count("ground"), marks.count("guide"), marks.count("driven")) == (2, 1, 1)
    played = scene(model, {"r": 0.1, "m": 1.0}, [(1.0, 0.3), (1.5, 0.4)])
    assert played is not None
    assert (played.names[:3], len(played.hoops), len(played.ties)) == (("slide", "wheel", "flange"), 1, 1)


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ("pin: {frame", "r: {frame", "`r` is already a parameter (line 3)"),
        ("[s, 0, 0]", "[z, 0, 0]", "unknown name `z` in the translation of the frame `slide`"),
        ("[s, 0, 0]", "[s_dot, 0, 0]", "is a rate, which the translation of the frame `slide` must not contain"),
        ("[s, 0, 0]", "[m, 0, 0]", "the translation of `slide`"),
        ("parent: wheel", "parent: weel", "unknown frame `weel` in `parent` of the frame `flange`"),
        ("radius: 2*r", "radius: -r", "the radius of the wheel `rim` is -0.1: it has no sign"),
        ("radius: 2*r", "radius: a", "`a` is a coordinate, which the radius of the wheel `rim` must not contain"),
        ("axle: z", "axle: w", "`w`"),
        ("{frame: wheel, radius", "{frame: pin, radius", "is a point, but `frame` of the wheel `rim` names a frame"),
        ("[wall, slide]", "[wall, slid]", "unknown point `slid` in the spring `spring`"),
        ("[wall, slide]", "[wall]", "spring"),
        ("{frame: wheel, at", "{moves_with: wheel, at", "`moves_with` is no key of a drawn point"),
        ("r**2*a_dot**2", "r**2*a_dot**2 + pin.vx**2", "unknown point or frame `pin` in the kinetic energy"),
    ],
)
def test_mistakes_in_a_picture_have_their_places(before: str, after: str, said: str) -> None:
    assert before in DRAWN_CRANK
    text = DRAWN_CRANK.replace(before, after, 1)
    with pytest.raises(ModelError) as error:
        load_text(text, "crank.yaml")
    (mistake,) = error.value.mistakes
    assert said in mistake.message
    line = next(k for k, written in enumerate(text.split("\n"), 1) if after in written)
    assert mistake.span is not None
    assert mistake.span.line == line


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


def test_a_slide_without_a_place_at_zero_has_no_rail() -> None:
    """Its place has the reciprocal of its coordinate in it."""
    model = load_text(
        """model: hyperbola
coordinates: {y: {unit: m, range: [1, 2]}}
frames: {slide: {translation: [0, 0, 1/y]}}
bodies: {slide: {mass: 1}}
configuration: {y: 1.5}
""",
        "hyperbola.yaml",
    )
    (slide,) = MachinePose(model).joints
    assert slide.foot == slide.place == pytest.approx((0, 0, 1 / 1.5))
    assert not [stroke for stroke in sketch(MachinePose(model)).strokes if stroke.role == "rail"]
    assert drawing(model) is not None


def test_links_move_with_their_frames() -> None:
    """In the animation: the hook of a crane turns about its carriage, which slides from the end of its rail."""
    model = crane()
    values = {"h": 3.0, "l": 2.0, "m": 5.0}
    shown = scene(model, values, [(0.8, 0.0), (1.8, math.pi / 2)])
    assert shown is not None
    assert shown.names == ("rail", "carriage", "hook", "tip")
    assert (shown.points, shown.stand.planar) == (1, True)
    hook = next(link for link in shown.links if link.frame == 2)
    # the length is that of the run, not that of the file
    assert list(hook.places) == [(0, 0, 0), pytest.approx((0, 0, -2))]
    rows = shown.axes[1][shown.turned.index(2)]
    end = [sum(a * b for a, b in zip(rows[k : k + 3], hook.places[1], strict=True)) for k in (0, 3, 6)]
    assert [a + b for a, b in zip(shown.places[1][2], end, strict=True)] == pytest.approx(shown.places[1][3])
    slide, turn = shown.joints
    assert (slide.kind, slide.driven, slide.carrier) == ("sliding", True, 0)
    assert (slide.foot, slide.along) == (pytest.approx((0, 0, 0)), pytest.approx((1, 0, 0)))
    assert (turn.kind, turn.driven) == ("turning", False)
    assert [tuple(link.places) for link in shown.links if link.frame == IN_WORLD] == [(pytest.approx((0, 0, 3)),)]
    assert scene(load_text(POINTS, "car_by_energies.yaml"), {"L": 2.6, "m": 1.0, "J": 1.0}, [(0, 0, 0)]) is None


def test_an_animation_starts_as_the_machine_is_drawn() -> None:
    """The directions of the stand, with the eye above them, are those of the picture."""
    model = crane(**{"axis: y": "axis: z"})
    shown, view = scene(model, {"h": 3.0, "l": 1.5, "m": 5.0}, [(0.8, 0.5)]), view_of(MachinePose(model))
    assert shown is not None
    stand = shown.stand
    assert (stand.planar, stand.above) == (False, ABOVE)
    assert stand.up == pytest.approx((0, 0, 1))
    seen = [
        math.cos(ABOVE) * u - math.sin(ABOVE) * n for u, n in zip(stand.up, stand.near, strict=True)
    ]
    assert seen == pytest.approx(view.up)
    assert stand.right == view.right
