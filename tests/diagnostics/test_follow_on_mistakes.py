"""What follows from a mistake in a declaration is not told: the mistake is the only one, wherever the name is used."""

from __future__ import annotations

import pytest

from symgen.diagnostics import ModelError
from symgen.model.load import load_text

# Every declaration is used in every block that may name it.
GOOD = """\
model: moving_arm
coordinates:
  x: {unit: m, range: [-1, 1]}
parameters:
  k: {value: 2, unit: kg, range: [1, 3]}
  J: 0.1
  g: {value: 9.81, unit: m/s**2}
  h: {value: 1, unit: N/m}
  b: {value: 1, unit: N*s/m}
definitions:
  d: 2*x
gravity: [0, 0, -9.81]
frames:
  cart: {translation: [x, 0, 0]}
joints:
  arm: {type: revolute, parent: cart, axis: y, coordinate: c}
  slide: {type: prismatic, parent: arm, axis: x, coordinate: s}
bodies:
  cart: {mass: k}
  arm: {mass: k, com: [0.5, 0, 0], inertia: {xx: J, yy: J, zz: J}}
  slide: {mass: k}
rotor_inertias: {c: J, x: J}
points:
  tip: {frame: arm, at: [1, 0, 0]}
  foot: {frame: cart, at: [1, 0, 0.1]}
potential_energy: k*g*tip.z + h*d**2 + h*J*c**2
springs:
  one: {between: [tip, foot], stiffness: 10, length: 1}
  two: {joint: c, stiffness: 1}
friction:
  c: {viscous: 0.1}
forces:
  push: {point: tip, magnitude: k*g, direction: [1, 0, 0]}
inputs:
  u: {joint: c}
  v: {acts_on: {x: 1}}
  w: {point: tip, direction: [1, 0, 0]}
  z: {acts_on: {s: 1}}
allocation: {weights: {u: 1, v: 1, w: 2, z: 1}}
applied_forces: {c: -J*c_dot, x: -b*x_dot}
independent_velocities: [x, c, s]
configuration: {c: 0.3, x: 0.1, s: 0.5}
ranges: {c: [-1, 1], x_dot: [-2, 2], c_ddot: [-3, 3], J: [0.05, 0.2]}
paths:
  p: {duration: 1, conditions: {one: x - t, two: c - t, three: s - t}, start: {x: 0, c: 0, s: 0}}
published:
  - {equation: (1), quantity: mass_matrix, independent: [x, c, s], value: [[k, 0, 0], [0, J, 0], [0, 0, 0]]}
"""
# What is written in place of what: each is one mistake in one declaration.
SPOILED = (
    ("  x: {unit: m,", "  x: {unt: m,"),
    ("  x: {unit: m,", "  2x: {unit: m,"),
    ("unit: m, range: [-1, 1]", "unit: m, range: [-1]"),
    ("unit: m, range: [-1, 1]", "unit: m, range: [1, -1]"),
    ("  x: {unit: m,", "  x: {unit: mmm,"),
    ("coordinates:\n", "coordinats:\n"),
    ("k: {value: 2,", "k: {valu: 2,"),
    ("k: {value: 2,", "k: {value: 2 +,"),
    ("k: {value: 2,", "k: {value: unknown,"),
    ("  k: {", "  2k: {"),
    ("  J: 0.1", "  J:"),
    ("  J: 0.1", "  J: [1]"),
    ("  J: 0.1", "  J: J"),
    ("  J: 0.1", "  J: 0/0"),
    ("parameters:\n", "parametrs:\n"),
    ("  d: 2*x", "  d: 2*"),
    ("  d: 2*x", "  2d: 2*x"),
    ("definitions:", "defintions:"),
    ("  cart: {tr", "  2cart: {tr"),
    ("translation: [x, 0, 0]", "translation: [x, 0]"),
    ("translation: [x, 0, 0]", "translate: [x, 0, 0]"),
    ("translation: [x, 0, 0]", "parent: nobody, translation: [x, 0, 0]"),
    ("frames:\n", "fraems:\n"),
    ("type: revolute", "type: revolut"),
    ("{type: revolute", "{tpye: revolute"),
    ("type: revolute", "type: planar"),
    ("  arm: {type", "  2arm: {type"),
    ("coordinate: c}", "coordinate: 2c}"),
    ("coordinate: c}", "coordinate: [c]}"),
    ("coordinate: c}", "cordinate: c}"),
    ("coordinate: s}", "coordinates: [s, c]}"),
    ("parent: cart", "parent: nobody"),
    ("axis: y,", "axis: up,"),
    ("axis: y,", "axis: [0, 0, 0],"),
    ("joints:\n", "jonts:\n"),
    ("  tip: {frame", "  2tip: {frame"),
    ("tip: {frame: arm", "tip: {frme: arm"),
    ("tip: {frame: arm", "tip: {frame: nobody"),
    ("at: [1, 0, 0]}", "at: [1, 0]}"),
    ("points:\n", "ponits:\n"),
    ("  arm: {mass: k", "  2arm: {mass: k"),
    ("  arm: {mass: k", "  arm: {mas: k"),
    ("  arm: {mass: k", "  arm: {mass: unknown"),
    ("  arm: {mass: k", "  nobody: {mass: k"),
    ("bodies:\n", "bodeis:\n"),
    ("zz: J}", "zy: J}"),
    ("u: {joint: c}", "u: {jont: c}"),
    ("u: {joint: c}", "u: {joint: nobody}"),
    ("u: {joint: c}", "2u: {joint: c}"),
    ("u: {joint: c}", "u: {acts_on: {c: unknown}}"),
    ("u: {joint: c}", "u:"),
    ("inputs:\n", "input:\n"),
    ("two: {joint: c,", "two: {jont: c,"),
    ("push: {point: tip", "push: {pont: tip"),
    ("push: {point: tip, magnitude: k*g, direction: [1, 0, 0]}", "push: {between: [tip, foot], stiffness: k}"),
    ("one: {between: [tip, foot], stiffness: 10, length: 1}", "one: {point: tip, direction: [1, 0, 0], magnitude: k}"),
    ("  foot: {frame: cart, at", "  foot: {parent: cart, translation"),
)


def mistakes_of(text: str) -> list[tuple[int, str]]:
    """Line and message of every mistake of a model."""
    with pytest.raises(ModelError) as raised:
        load_text(text, "spoiled.yaml")
    return [(mistake.span.line, mistake.message) for mistake in raised.value.mistakes if mistake.span is not None]


def test_the_model_itself_has_no_mistake() -> None:
    assert load_text(GOOD, "moving_arm.yaml").name == "moving_arm"


@pytest.mark.parametrize(("before", "after"), SPOILED)
def test_one_mistake_is_told_once(before: str, after: str) -> None:
    line = GOOD[: GOOD.index(before) + len(before) - 1].count("\n") + 1
    mistakes = mistakes_of(GOOD.replace(before, after, 1))
    assert [place for place, _ in mistakes] == [line], mistakes


def test_an_entry_of_another_block_is_sent_there() -> None:
    spring = "push: {type: spring, between: [tip, foot], stiffness: k}"
    text = GOOD.replace("push: {point: tip, magnitude: k*g, direction: [1, 0, 0]}", spring)
    with pytest.raises(ModelError) as raised:
        load_text(text, "spoiled.yaml")
    (mistake,) = raised.value.mistakes
    assert mistake.message == "`push` has the keys of a spring, and stands under `forces`"
    assert mistake.remedy == "`springs` is a block of its own: move it there, without `type`"


def test_keys_that_two_blocks_know_send_nobody_anywhere() -> None:
    """`between` and `length` are keys of springs and of loops."""
    entry = "push: {between: [tip, foot], length: 1}"
    mistakes = mistakes_of(GOOD.replace("push: {point: tip, magnitude: k*g, direction: [1, 0, 0]}", entry))
    assert any("`between` is no key of a force" in message for _, message in mistakes)


def test_a_joint_that_takes_the_coordinate_of_another_is_one_mistake() -> None:
    mistakes = mistakes_of(GOOD.replace("coordinate: s}", "coordinate: c}"))
    assert [message for line, message in mistakes if line == 17] == [
        "`c` is a coordinate of the joint `arm` (line 16) already"
    ]


def test_a_name_that_is_taken_is_told_where_it_is_declared_again() -> None:
    mistakes = mistakes_of(GOOD.replace("u: {joint: c}", "c: {joint: c}").replace("weights: {u", "weights: {c"))
    assert [message for _, message in mistakes] == ["`c` is already an input (line 35)"]


def test_other_mistakes_are_told_beside_it() -> None:
    spoiled = GOOD.replace("type: revolute", "type: revolut").replace("configuration: {c:", "configuration: {q:")
    mistakes = mistakes_of(spoiled)
    assert [message for _, message in mistakes] == [
        "`type` is `revolut`, which is not known",
        "`q` in `configuration` is no coordinate",
    ]


def test_a_faulty_declaration_that_hangs_on_nothing_is_two_mistakes() -> None:
    """The frame that it names is declared elsewhere, or nowhere: that does not follow from its own mistake."""
    text = GOOD.replace("slide: {type: prismatic, parent: arm,", "slide: {type: prismatik, parent: armm,")
    with pytest.raises(ModelError) as raised:
        load_text(text, "model.yaml")
    messages = [mistake.message for mistake in raised.value.mistakes]
    assert len(messages) == 2
    assert "`prismatik`" in messages[0]
    assert "unknown frame `armm`" in messages[1]
