"""Models as they are written at the first try: each has one mistake, and one answer."""

from __future__ import annotations

MOTOR = """\
model: hoist
coordinates:
  s: {unit: m, description: way of the load}
  turn: {unit: rad, description: angle of the drum}
parameters:
  load: {value: 12, unit: kg}
  r: {value: 0.2, unit: m}
  J: {value: 0.3, unit: kg*m**2}
kinetic_energy: load/2*s_dot**2 + J/2*turn_dot**2
potential_energy: 9.81*load*s
constraints: {geometric: {rope: s - r*turn}}
inputs:
  motor: {unit: N*m, joint: turn}
"""
ARM = """\
model: reach
joints:
  shoulder: {type: revolute, axis: z, coordinate: a}
  elbow: {type: revolute, parent: shoulder, at: [0.5, 0, 0], axis: z, coordinate: b}
gravity: [0, -9.81, 0]
bodies:
  shoulder: {mass: 2, com: [0.2, 0, 0], inertia: {zz: 0.1}}
  elbow: {mass: 1, com: [0.2, 0, 0], inertia: {zz: 0.1}}
inputs: {motor: {unit: N*m, joint: a}}
"""


def motor(before: str, after: str) -> str:
    """The hoist with a piece of its text replaced."""
    assert before in MOTOR
    return MOTOR.replace(before, after)


def arm(before: str, after: str) -> str:
    """The arm with a piece of its text replaced."""
    assert before in ARM
    return ARM.replace(before, after, 1)


FIRST = {
    "misspelt_block": motor("kinetic_energy", "kinetic_enery"),
    "coordinates_as_a_list": motor(
        MOTOR[MOTOR.index("coordinates") : MOTOR.index("parameters")], "coordinates: [s, turn]\n"
    ),
    "rate_in_another_spelling": motor("s_dot", "ds"),
    "not_a_number": motor("value: 12", "value: NaN"),
    "infinite": motor("value: 12", "value: -.inf"),
    "elementwise": motor("9.81*load", "9.81.*load"),
    "no_colon": motor("model: hoist", "model hoist"),
    "open_quote": motor("model: hoist", "model: 'hoist"),
    "open_bracket": motor("{rope: s - r*turn}}", "{rope: s - r*turn}"),
    "further_right": motor("  r: {value", "   r: {value"),
    "name_with_a_blank": motor("  load: {", "  my load: {"),
    "function_in_another_spelling": motor("s - r*turn", "s - r*sinus(turn)"),
    "joint_in_place_of_its_coordinate": arm("joint: a", "joint: shoulder"),
    "unknown_type_of_joint": arm("type: revolute", "type: hinge"),
    "joint_to_itself": arm("parent: shoulder", "parent: elbow"),
    "loop_to_itself": f"{ARM}loops: {{closed: {{type: revolute, between: [elbow, elbow]}}}}\n",
    "spring_to_itself": f"{ARM}springs: {{coil: {{between: [elbow, elbow], stiffness: 10}}}}\n",
    "misspelt_joints": arm("joints:", "joint:"),
    "name_of_a_point_and_a_joint": f"{ARM}points: {{elbow: {{frame: shoulder}}}}\n",
    "spring_without_stiffness": f"{ARM}springs: {{coil: {{between: [elbow, world]}}}}\n",
    "rotor_of_a_joint": f"{ARM}rotor_inertias: {{elbow: 0.1}}\n",
    "list_above_names": motor("  s: {unit: m, description: way of the load}", "- s"),
    "coordinate_that_is_none": motor("joint: turn", "joint: trun"),
    "another_thing": motor("joint: turn", "joint: load"),
    "no_mass_at_all": motor("value: 12", "value: 0").replace("value: 0.3", "value: 0").replace("constraints", "#"),
    "only_comments": "# a model\n\n# to come\n",
    "tab": motor("  s: {", "\ts: {"),
    "greek": motor("  r: {", "  ρ: {"),
    "misspelt_joint_of_an_input": arm("joint: a", "joint: sholder"),
    "no_joint_of_an_input": arm("joint: a", "joint: base"),
    "misspelt_joint_at_the_start": f"{ARM}configuration: {{elbw: 0.1}}\n",
}
