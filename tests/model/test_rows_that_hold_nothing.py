"""Rows whose gradients vanish up to the rounding of the file's numbers, and parameters that loops tie."""

from __future__ import annotations

import pytest

from symgen.diagnostics import ModelError
from symgen.model.load import load_text
from symgen.model.model import Model

ARM = """model: held
parameters:
  l: {value: 0.7, range: [0.5, 0.9]}
  w: {value: 0.1}
  twist: {value: 0}
joints:
  p: {type: revolute, at: [0.1, 0, 0], axis: x, coordinate: a}
  q: {type: revolute, parent: p, at: [0.2, l, 0], axis: x, coordinate: b}
  r: {type: revolute, parent: q, at: [0, 0.6, 0], axis: x, coordinate: c, rotation: [[y, {BENT}]]}
bodies:
  p: {mass: 1, com: [0, 0.3, 0], inertia: {xx: 0.1}}
  q: {mass: 1, com: [0, 0.3, 0], inertia: {xx: 0.1}}
  r: {mass: 1, com: [0, 0.2, 0], inertia: {xx: 0.1}}
gravity: [0, 0, -9.81]
frames:
  dock: {FRAME}
points:
  tip: {frame: r, at: [0, 0.5, 0]}
  knee: {frame: q, at: [0, w + 0.5, 0]}
loops:
  hold: {LOOP}
inputs:
  drive: {joint: a}
configuration: {a: 0.2, b: 0.9, c: 0.7}
"""
# parallel to x but for the rounding of the axis and the angle
TURNED = "{translation: [0.3, 0.9, 0.4], rotation: [[[0.36, 0.48, 0.8], 0.9273], [[0.36, 0.48, 0.8], -0.9273]]}"


def _model(frame: str, bent: str = "0", loop: str = "{type: revolute, between: [r, dock], axis: x}") -> Model:
    text = ARM.replace("{FRAME}", frame).replace("{BENT}", bent).replace("{LOOP}", loop)
    return load_text(text, "held.yaml")


def _rows(model: Model) -> dict[str, bool]:
    """Names of rows, and whether they are 0 = 0."""
    return {row.name: "Number(value=Fraction(0" in repr(row.expression) for row in model.constraints}


def test_a_row_that_rounding_leaves_is_the_empty_row() -> None:
    """0.1 + 0.2 - 0.3 is 5.6e-17, and so are the tilts of an axis that is turned there and back."""
    model = _model(TURNED)
    rows = _rows(model)
    assert rows["hold_x"]
    assert not rows["hold_y"]
    assert all(empty for name, empty in rows.items() if "tilt" in name)
    assert model.assembly is not None
    assert model.assembly.ranks.constraints == 2
    messages = [notice.message for notice in model.notices if "nothing" in notice.message]
    assert len(messages) == 1, "one message for a loop"
    assert "zero for all configurations" in messages[0]


def test_a_gap_that_no_motion_closes_is_a_mistake() -> None:
    """A millionth is no rounding."""
    with pytest.raises(ModelError, match="`hold_x` does not depend on the configuration: it demands 1e-06 = 0"):
        _model("{translation: [0.299999, 0.9, 0.4]}")


def test_a_row_that_holds_for_the_default_lengths_alone_ties_them() -> None:
    """Without it the machine moves as it does with it; the length is no longer free."""
    model = _model("{translation: [w + 0.2, 0.9, 0.4]}")
    assert _rows(model)["hold_x"]
    assert model.assembly is not None
    assert model.assembly.tied == ("w",), "l moves the other rows, which the angles make up for"
    assert any("hold_x` does not depend on the configuration" in notice.message for notice in model.notices)


def test_a_bend_that_no_motion_straightens_is_tied() -> None:
    """The axis of a bent link turns about the dock's, and is never parallel to it."""
    model = _model("{translation: [0.3, 0.9, 0.4]}", "twist")
    assert model.assembly is not None
    assert model.assembly.tied == ("twist",)


LATCH = """model: latch
coordinates: {{a: {{unit: rad}}, b: {{unit: rad}}, c: {{unit: rad}}}}
parameters: {{{parameters}}}
kinetic_energy: l*(a_dot**2 + b_dot**2 + J*c_dot**2)
constraints:
  geometric:
    latch: {row}
    other: sin(c) - l*cos(a)/9
inputs: {{drive: {{acts_on: {{b: J}}}}}}
paths:
  swing: {{duration: 1, definitions: {{s: J*t}}, conditions: {{one: a - s - l, two: b - s}}}}
"""


def _latch(parameters: str, row: str) -> Model:
    return load_text(LATCH.format(parameters=parameters, row=row), "latch.yaml")


@pytest.mark.parametrize(
    ("parameters", "row", "taken"),
    [
        ("l: 2, J: 3, k: 0", "k*(cos(a) - l*sin(b))", {"k": 0}),
        ("l: 2, J: 3, k: {value: 0, range: [-1, 1]}", "k*(cos(a) - l*sin(b))", {"k": 0}),
        ("l: 2, J: {value: l}", "(l - J)*(cos(a) - sin(b))", {"l": 2, "J": 2}),
        ("l: 2, J: 3, k: 0, e: 0", "k*e*(cos(a) - sin(b))", {"k": 0}),
        ("l: 2, J: 3, k: {value: l - J + 1}, e: 7", "k*e*(cos(a) - sin(b))", {"k": 0}),
        ("l: 2, J: 3, k: 0, e: 0", "k*sin(a) + e*sin(b)", {"k": 0, "e": 0}),
    ],
)
def test_what_would_make_an_empty_row_count_is_a_number(parameters: str, row: str, taken: dict[str, int]) -> None:
    """Kernels for one more constraint are others: no kernel can be given such a value, in whatever it stands."""
    model = _latch(parameters, row)
    assert dict(model.taken) == taken
    assert _rows(model) == {"latch": True, "other": False}
    assert not {parameter.name for parameter in model.parameters} & taken.keys()
    left = repr((model.parameters, model.kinetic_energy, model.constraints, model.inputs, model.paths))
    assert not any(f"Name(name='{name}')" in left for name in taken)
    messages = [notice.message for notice in model.notices if "taken as the number" in notice.message]
    assert len(messages) == len(taken)
    assert ("in spite of its range" in messages[0]) == ("range" in parameters)


def test_an_offset_of_nothing_in_a_plane_of_a_frame_that_cannot_turn() -> None:
    """With an offset the plane would not close at the angle that its axis asks for."""
    model = load_text(
        """model: plane
parameters: {h: {value: 0}, l: {value: 0.5}, g: {value: 9.81}}
gravity: [0, 0, -g]
frames:
  dock: {parent: lid, translation: [0, -0.4, 0], rotation: [[[0, -1, 0], 2.1]]}
joints:
  arm: {type: revolute, at: [0.2, 0, 0], axis: [1, 0, 1], coordinate: a}
  lid: {type: revolute, parent: arm, at: [h, l, 0], axis: y, coordinate: b}
bodies:
  arm: {mass: 2, com: [h/2, l/2, 0], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
  lid: {mass: 1, com: [h, 0.1, 0.1], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
loops:
  flat: {type: planar, between: [arm, dock], axis: x}
inputs: {drive: {joint: a}}
configuration: {a: 0.3, b: 2.1}
""",
        "plane.yaml",
    )
    assert dict(model.taken) == {"h": 0}
    assert [parameter.name for parameter in model.parameters] == ["l", "g"]
    assert model.assembly is not None
    assert model.assembly.ranks.constraints == 1
    assert _rows(model)["flat_x"]


def test_rows_in_any_units_are_rows() -> None:
    """A row is not taken for rounding because it is small."""
    text = """model: units
coordinates: {x: {}, y: {}, z: {}}
kinetic_energy: x_dot**2 + y_dot**2 + z_dot**2
constraints:
  geometric:
    small: 1e-17*(x - y**2)
    apart: (x + 6.4e6) - (z + 6.4e6)
    large: 1e20*(x - y**2) + 1e20*(y**2 - x)
  nonholonomic:
    none: (sin(pi/6) - 1/2)*x_dot + 1e-9*0*y_dot
"""
    model = load_text(text, "units.yaml")
    assert _rows(model) == {"small": False, "apart": False, "large": True, "none": True}


def test_a_range_that_cannot_be_used_is_told() -> None:
    """Three cranks on one coupler: each length closes for its value alone, a length they share for any."""
    cranks = "".join(
        f"    x_{i}: {length}*cos(a_{i}) - x\n    y_{i}: {length}*sin(a_{i}) - y\n"
        for i, length in enumerate(("l", "l", "l_3"))
    )
    text = f"""model: cranks
coordinates:
  x: {{unit: m}}
  y: {{unit: m}}
  a_0: {{unit: rad}}
  a_1: {{unit: rad}}
  a_2: {{unit: rad}}
parameters:
  l: {{value: 0.5, range: [0.4, 0.6]}}
  l_3: {{value: l, range: [0.4, 0.6]}}
  m: {{value: 2, range: [1, 3]}}
kinetic_energy: m/2*(x_dot**2 + y_dot**2) + (a_0_dot**2 + a_1_dot**2 + a_2_dot**2)/10
constraints:
  geometric:
{cranks}
configuration: {{a_0: 0.5, a_1: 0.5, a_2: 0.5, x: 0.4, y: 0.2}}
"""
    model = load_text(text, "cranks.yaml")
    assert model.assembly is not None
    messages = [notice.message for notice in model.notices if "in spite of" in notice.message]
    assert model.assembly.tied == ("l_3",)
    assert messages == [
        "`l_3` keeps its default in spite of its range: rows that depend on each other can be closed for no other value"
    ]


def test_steep_functions_are_no_rounding() -> None:
    """A shake of 1e-10 changes all of such a gradient; it counts all the same, and so does the entry beside it."""
    nested = "".join(f"  d_{k}: 5*sin(5*d_{k - 1})\n" for k in range(1, 21))
    text = f"""model: steep
coordinates: {{x: {{}}, y: {{}}, z: {{}}}}
definitions:
  d_0: x
{nested}
kinetic_energy: x_dot**2 + y_dot**2 + z_dot**2
constraints:
  geometric:
    g: d_20 - y
    h: sin(x + z) - sin(x)*cos(z) - cos(x)*sin(z)
"""
    model = load_text(text, "steep.yaml")
    assert _rows(model) == {"g": False, "h": True}
    assert model.assembly is not None
    assert model.assembly.ranks.constraints == 1


def test_all_coordinates_that_cannot_move_are_named_on_the_branch_that_is_meant() -> None:
    """Five dyads between fixed pins stand still; a linkage of the same ranks elsewhere says nothing of this one."""
    dyads = "".join(
        f"    x_{k}: cos(b_{2 * k + 1}) + cos(b_{2 * k + 2}) - {1.1 + 0.1 * k}\n"
        f"    y_{k}: sin(b_{2 * k + 1}) + sin(b_{2 * k + 2})\n"
        for k in range(5)
    )
    rates = " + ".join(f"b_{i}_dot**2" for i in range(1, 11))
    names = "".join(f"  b_{i}: {{unit: rad}}\n" for i in range(1, 11))
    text = f"""model: dyads
coordinates:
  a: {{unit: rad}}
{names}
kinetic_energy: a_dot**2 + {rates}
constraints:
  geometric:
{dyads}
"""
    messages = [notice.message for notice in load_text(text, "dyads.yaml").notices]
    assert len(messages) == 1
    assert messages[0].startswith("`b_1` .. `b_10` cannot move: the constraints hold b_1 = ")


def test_a_length_that_no_motion_makes_up_for_is_tied_in_any_axes() -> None:
    """Two places on one link meet if lengths agree; else the gap turns with the link."""
    model = _model("{}", loop="{type: point, between: [knee, r]}")
    assert all(_rows(model).values())
    assert model.assembly is not None
    assert model.assembly.tied == ("w",)


def test_a_part_of_a_quaternion_that_cannot_move_is_not_to_be_left_out() -> None:
    text = """model: hinged
joints:
  ball: {type: spherical, coordinates: [e_0, e_1, e_2, e_3]}
  slide: {type: prismatic, axis: x, coordinate: s}
bodies:
  ball: {mass: 1, com: [0, 0.1, 0], inertia: {xx: 1, yy: 1, zz: 1}}
  slide: {mass: 1}
gravity: [0, 0, -9.81]
constraints: {geometric: {plane: e_3 - 0.6, still: EXPRESSION}}
configuration: {e_0: 0.8, e_3: 0.6}
"""
    for expression in ("e_3 + e_1 - 0.6", "s - 0.2"):
        messages = [x.message for x in load_text(text.replace("EXPRESSION", expression), "hinged.yaml").notices]
        assert sum("`e_3`" in x and "cannot move" in x for x in messages) == 1
        assert not any("leave the coordinate" in x for x in messages)
    alone = load_text(text.replace("plane: e_3 - 0.6, still: EXPRESSION", "still: s - 0.2"), "hinged.yaml")
    assert any("else leave the coordinate out" in notice.message for notice in alone.notices)


@pytest.mark.parametrize(("r", "h", "share"), [(0.37, 0.9, "h/3"), (0.4, 0.8, "h/2"), (0.5, 1.1, "h/2")])
def test_a_length_that_moves_a_row_of_its_own_is_not_tied(r: float, h: float, share: str) -> None:
    """A bar on three equal cranks closes for any length of all three; a slide that follows one takes no part."""
    text = f"""\
model: cranks_and_slide
parameters: {{r: {{value: {r}, range: [0.3, 0.7]}}, h: {{value: {h}}}}}
coordinates: {{a: {{unit: rad}}, b: {{unit: rad}}, c: {{unit: rad}}, p: {{unit: rad}}, w: {{}}}}
kinetic_energy: a_dot**2/5 + b_dot**2/7 + c_dot**2/9 + p_dot**2/3 + w_dot**2
constraints:
  geometric:
    x1: r*cos(a) + h*cos(p) - h - r*cos(b)
    y1: r*sin(a) + h*sin(p) - r*sin(b)
    x2: r*cos(a) + {share}*cos(p) - {share} - r*cos(c)
    y2: r*sin(a) + {share}*sin(p) - r*sin(c)
    slot: w - r*cos(a)/2
configuration: {{a: 0.9, b: 0.9, c: 0.9, p: 0, w: 0.153}}
"""
    model = load_text(text, "cranks.yaml")
    assert model.assembly is not None
    assert model.assembly.ranks.constraints == 4
    assert model.assembly.tied == ()
