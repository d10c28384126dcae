"""Masses, lengths and moments of inertia need no range to be positive; G is shown definite frame by frame."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import pytest

from symgen.diagnostics import Mistake, Span
from symgen.mechanics.genericity import genericity
from symgen.mechanics.never_zero import Definite
from symgen.mechanics.system import System
from symgen.methods.forward_dynamics.articulated import articulated
from symgen.model.checks.signs import nonnegative_parameters, positive_parameters
from symgen.model.expressions.parser import parse_expression
from symgen.model.file.source import ScalarNode
from symgen.model.load import load_text
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.symbolic.translate import translate
from symgen.symbolic.traverse import cost

SWING = """model: swing
coordinates: {{{coordinates}}}
parameters:
  l: {{value: 0.35, unit: cm{length}}}
  m: {{value: 800, unit: g{mass}}}
  J: {{value: {inertia}, unit: g*cm**2{mass}}}
gravity: [0, -981, 0]
frames:
{frames}
bodies:
{bodies}
points: {{hand: {{frame: f_{links}, at: [l, 0, l]}}}}
constraints: {{geometric: {{plane: hand.x - 1.3*l}}}}
configuration: {{a_1: 0.3, a_2: -0.4, a_3: 0.5}}
"""


def swing(links: int, ranges: bool, inertia: float = 0.03) -> Model:
    """Links that turn about y and z by turns, the hand of the last one in a plane."""
    names = [f"a_{k}" for k in range(1, links + 1)]
    hung = ["", *(f"parent: f_{k}, translation: [l, 0, 0], " for k in range(1, links))]
    frames = [f"  f_{k}: {{{hung[k - 1]}rotation: [[{'zy'[k % 2]}, a_{k}]]}}" for k in range(1, links + 1)]
    bodies = [
        f"  f_{k}: {{mass: m, com: [l/2, 0, l/3], inertia: {{xx: J, yy: J, zz: 2*J}}}}" for k in range(1, links + 1)
    ]
    text = SWING.format(
        coordinates=", ".join(f"{name}: {{unit: rad, range: [-1, 1]}}" for name in names),
        length=", range: [0.2, 0.6]" if ranges else "",
        mass=", range: [1e-6, 1000]" if ranges else "",
        inertia=inertia,
        frames="\n".join(frames),
        bodies="\n".join(bodies),
        links=links,
    )
    return load_text(text, "swing.yaml")


@cache
def weights(links: int, ranges: bool = False, inertia: float = 0.03) -> dict[str, int]:
    derivations = derive_quantities(swing(links, ranges, inertia), ["forward_dynamics", "multipliers"])
    return {q.name: cost((*q.outputs, *(g.denominator for g in q.guards))).weight for q in derivations.quantities}


def test_an_unstated_range_costs_nothing() -> None:
    assert weights(7) == weights(7, ranges=True)


def test_nor_do_point_masses() -> None:
    assert weights(7, inertia=0)["forward_dynamics"] <= weights(7)["forward_dynamics"]


@pytest.mark.slow
@pytest.mark.campaign
def test_a_link_more_costs_as_much_as_the_one_before() -> None:
    counts = [weights(links)["forward_dynamics"] for links in (7, 9, 11, 13)]
    steps = [after - before for before, after in pairwise(counts)]
    assert max(steps) <= 1.25 * min(steps)


SIGNS = """model: signs
coordinates: {a: {unit: rad}, b: {unit: rad}}
parameters:
  m: 2
  M: {value: 3, unit: kg}
  l: {value: 0.5, unit: m}
  e: {value: 0, unit: m}
  d: {value: -0.1, unit: m}
  k: {value: 4, unit: N*m/rad}
  w: {value: 0.2, unit: m, range: [-1, 1]}
  I: {value: 0, unit: kg*m**2}
  P: {value: 0.01, unit: kg*m**2}
  R: 0.004
  other: 5
frames:
  f: {rotation: [[z, a]]}
  g: {parent: f, translation: [l/1, 0, 0], rotation: [[x, b]]}
bodies:
  f: {mass: m, com: [0.3, other, 0], inertia: {xx: 1, yy: 1, zz: 1, xy: P}}
  g: {mass: 1, com: [0.3, 0, 0], inertia: {xx: 1 + I, yy: 1, zz: 1}}
rotor_inertias: {b: R}
"""


def test_what_is_positive_by_nature() -> None:
    text = SIGNS
    model = load_text(text, "signs.yaml")
    assert positive_parameters(model) == {"m", "M", "l", "R"}
    assert nonnegative_parameters(model) == {"m", "M", "I", "R"}


@pytest.mark.parametrize(
    ("holds", "text"),
    [
        (True, "m"), (True, "m*l*l + I"), (True, "M/(m + M)"), (True, "m*(e*e + l*l)"), (True, "(m*d)*d + m*l*l"),
        (False, "m - M"), (False, "e"), (False, "d"), (False, "m*e*e + I"), (False, "m*d*e + I*l"), (False, "I"),
    ],
)  # fmt: skip
def test_which_sums_cannot_vanish(holds: bool, text: str) -> None:
    source = SIGNS
    mechanics = System(load_text(source, "signs.yaml"))
    names = {name: mechanics.graph.symbol(name) for name in ("m", "M", "l", "e", "d", "I")}
    expression = parse_expression(ScalarNode(text, Span(1, 1, 1), text, quoted=False))
    assert not isinstance(expression, Mistake)
    assert Definite(mechanics).holds(translate(mechanics.graph, expression, names)) is holds


PLANE = """model: plate
coordinates: {x: {unit: m}, y: {unit: m}, a: {unit: rad}}
parameters: {m: {value: 2, unit: kg}, J: {value: INERTIA, unit: kg*m**2}, c: {value: 0.3, unit: m}}
frames: {plate: {translation: [x, y, 0], rotation: [[z, a]]}}
bodies: {plate: {mass: m, com: [c, 0, 0], inertia: {zz: J}}}
constraints: {geometric: {guide: c*a - x/2}}
inputs: {f: {unit: N, acts_on: {y: 1}}, push: {unit: N, acts_on: {x: 1}}}
"""


@pytest.mark.parametrize(("inertia", "exists"), [("0.1", True), ("0", False)])
def test_a_point_mass_does_not_resist_turns_about_itself(inertia: str, exists: bool) -> None:
    # along each coordinate alone it does: the pivots after x and y decide
    model = load_text(PLANE.replace("INERTIA", inertia), "plate.yaml")
    assert (articulated(model, genericity(System(model))) is not None) is exists


UNIVERSAL = """model: universal
coordinates: {a: {unit: rad, range: [-1, 1]}, b: {unit: rad, range: [-1, 1]}}
parameters: {m: {value: 2, unit: kg}, J: {value: 0.2, unit: kg*m**2}}
frames:
  cross: {rotation: [[x, a]]}
  rod: {parent: cross, rotation: [[AXIS, b]]}
bodies: {rod: {mass: m, com: [0, 0, 0.4], inertia: {xx: J, yy: J, zz: J/9}}}
inputs: {drive: {unit: N*m, joint: a}}
"""


@pytest.mark.parametrize(("axis", "exists"), [("y", True), ("[1, 2, 0]", True), ("x", False)])
def test_a_middle_without_mass_is_looked_at_with_what_it_carries(axis: str, exists: bool) -> None:
    text = UNIVERSAL.replace("AXIS", axis)
    if not exists:
        # two turns about one axis: the system itself is regular only where one of them is held
        text += "constraints: {geometric: {hold: a}}\n"
    model = load_text(text, "universal.yaml")
    mechanics = System(model)
    assert (articulated(model, genericity(mechanics)) is not None) is exists


LEVERS = """model: levers
gravity: [0, -9.81, 0]
joints:
  a: {{type: revolute, axis: z, coordinate: q_a}}
  b: {{type: revolute, parent: a, at: [0.4, 0, 0], axis: z, coordinate: q_b}}
  c: {{type: revolute, parent: b, at: [{arm}, 0, 0], axis: z, coordinate: q_c}}
  d: {{type: prismatic, parent: c, at: [0.2, 0, 0], axis: y, coordinate: q_d}}
bodies:
  a: {{mass: 1, inertia: {{zz: 0.05}}}}
  d: {{mass: 4, com: [0.1, 0, 0], inertia: {{zz: 0.2}}}}
rotor_inertias: {{q_c: {rotor}}}
points: {{tip: {{frame: d, at: [0.1, 0, 0]}}}}
{held}
inputs: {{u: {{joint: q_a}}}}
"""


def levers(held: str = "", rotor: float = 0.03) -> Model:
    """A carriage on two massless levers, and a rotor between."""
    return load_text(LEVERS.format(arm=0.5, rotor=rotor, held=held), "levers.yaml")


def test_a_joint_that_a_rotor_resists_hands_on_what_it_carries() -> None:
    """The lever before it has the inertia of the carriage behind it; 0 it was taken for."""
    model = levers("constraints: {geometric: {height: tip.y - 0.3*q_a}}", rotor=2)
    assert articulated(model, genericity(System(model))) is not None


def test_what_moves_freely_has_that_method_wherever_its_motion_is_determined() -> None:
    """Beside straight levers the pivots are small, and zero where the motion is not determined without the rotor."""
    model = levers(rotor=1e-6)
    assert articulated(model, genericity(System(model))) is not None
    # a row between the carriage and the root leaves the levers as free as they were, one at their own joint does not
    for row, exists in (("height: tip.y - 0.3*q_a", True), ("bend: q_c - 0.5*q_a", False)):
        held = levers(f"constraints: {{geometric: {{{row}}}}}", rotor=1e-6)
        assert (articulated(held, genericity(System(held))) is not None) is exists
