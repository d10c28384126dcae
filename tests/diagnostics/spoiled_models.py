"""Good models spoiled in one way each; what symgen says about each stands in expected/<group>.txt."""

from __future__ import annotations

from first_models import FIRST
from rough_models import ROUGH

HEAD = """\
model: carriage
coordinates:
  x: {unit: m}
  a: {unit: rad}
parameters:
  m: {value: 2, unit: kg}
  l: {value: 0.5, unit: m}
"""
KINETIC = "kinetic_energy: m/2*x_dot**2 + m*l**2/2*a_dot**2\n"
GOOD = HEAD + KINETIC


def energy(terms: str) -> str:
    """The good model with those terms as kinetic energy."""
    return f"{HEAD}kinetic_energy: {terms}\n"


def potential(expression: str) -> str:
    """The good model with that potential energy."""
    return f"{GOOD}potential_energy: {expression}\n"


def geometric(row: str) -> str:
    """The good model with that geometric constraint."""
    return f"{GOOD}constraints: {{geometric: {{c: {row}}}}}\n"


def nonholonomic(row: str) -> str:
    """The good model with that constraint on the rates."""
    return f"{GOOD}constraints: {{nonholonomic: {{c: {row}}}}}\n"


def units(x: str, a: str, m: str, length: str) -> str:
    """The good model with those units."""
    return f"""\
model: carriage
coordinates:
  x: {{unit: {x}}}
  a: {{unit: {a}}}
parameters:
  m: {{value: 2, unit: {m}}}
  l: {{value: 0.5, unit: {length}}}
{KINETIC}"""


YAML = {
    "empty_file": "",
    "comment_only": "# nothing\n",
    "not_a_mapping": "- a\n- b\n",
    "broken_yaml": "model: m\ncoordinates: {x: }\nkinetic_energy: [x_dot**2\npotential_energy: 0\n",
    "tab_indent": "model: m\ncoordinates:\n\tx: {}\n",
    "alias_bomb": "model: m\nparameters:\n  a: &a [1, 1]\n  b: &b [*a, *a]\n",
    "alias": GOOD + "description: *other\n",
    "merge_key": GOOD + "configuration:\n  <<: {x: 0}\n",
    "tag": GOOD + "description: !!python/object/apply:os.system [ls]\n",
    "second_document": GOOD + "---\nmodel: other\n",
    "duplicate_key": GOOD + KINETIC,
    "deep_nesting": "model: " + "[" * 40 + "]" * 40 + "\n",
    "huge_file": "model: " + "a" * 1_000_001,
    "terminal_escape": 'model: m\n"\\x1b[31m": red\n',
    "control_character": "model: m\ndescription: a\x07b\n",
    "escaped_control_character": GOOD + 'description: "a\\x07b"\n',
    "reversed_text": GOOD + 'description: "a\u202eb"\n',
    "complex_key": GOOD + "? [a, b]\n: 1\n",
}
SHAPE = {
    "missing_everything": "description: nothing\n",
    "unknown_key": GOOD + "descripton: wrong\n",
    "unknown_key_without_neighbour": GOOD.replace("unit: rad", "colour: red"),
    "empty_value": GOOD + "potential_energy:\n",
    "empty_block": GOOD + "inputs:\n",
    "no_coordinates": "model: m\ncoordinates: {}\nkinetic_energy: 0\n",
    "list_for_a_mapping": GOOD + "constraints: [a, b]\n",
    "mapping_for_a_text": GOOD + "description: {a: b}\n",
    "mapping_for_an_expression": GOOD + "potential_energy: {a: 1}\n",
    "scalar_for_a_coordinate": GOOD.replace("x: {unit: m}", "x: m"),
    "urdf_without_a_file": GOOD + "urdf: absent/robot.urdf\n",
    "urdf_elsewhere": GOOD + "urdf: ../robot.urdf\n",
    "comma_in_flow": GOOD + "inputs: {T: {acts_on: {a: atan2(x, l)}}}\n",
    "comma_in_flow_text": GOOD.replace("unit: rad", "unit: rad, description: angle, from the vertical"),
    "comma_and_one_word_in_flow_text": GOOD.replace("unit: rad", "unit: rad, description: angle, absolute"),
    "report": GOOD + "report: long\n",
    "trig_range": GOOD + "trig_range: far\n",
    "model_name_is_a_path": GOOD.replace("carriage", "../../x"),
    "model_name_reserved": GOOD.replace("carriage", "while"),
    "long_name": GOOD.replace("carriage", "a" * 60),
    "range_of_three": GOOD.replace("unit: rad", "range: [1, 2, 3]"),
}
EXPRESSIONS = {
    k: potential(v)
    for k, v in {
        "caret": "m*x^2",
        "decimal_comma": "1,5*x",
        "tower": "x*9**9**9",
        "big_exponent": "x**100",
        "variable_exponent": "x**a",
        "exponent_by_zero": "x**(1/0)",
        "python": "__import__('os').system('ls')",
        "attribute": "tip.x + 1",
        "unbalanced": "(x + 1",
        "closing": "x + 1)",
        "empty_parentheses": "sin() + x",
        "unknown_function": "sinus(a)",
        "call_of_a_name": "m(x)",
        "wrong_arity": "sin(a, x)",
        "atan2_arity": "atan2(a)",
        "missing_operator": "2x",
        "missing_operator_names": "m x",
        "function_without_argument": "sin*x",
        "dangling": "x +",
        "double_operator": "x */ 2",
        "superscript": "x²",
        "minus_sign": "x − 1",
        "greek": "α*x",
        "multiplication_dot": "m·x",
        "assignment": "x = 1",
        "prime": "x' + 1",
        "brackets": "a[0]",
        "huge_number": "1e999",
        "many_digits": "1" + "0" * 60,
        "hexadecimal": "0x10",
        "floor_division": "x//2",
        "percent": "x % 2",
        "null": "null",
        "true": "true",
        "lambda": "lambda x",
    }.items()
}
EXPRESSIONS["deep_parentheses"] = potential("(" * 200 + "x" + ")" * 200)
EXPRESSIONS["deep_signs"] = potential("-" * 200 + "x")
EXPRESSIONS["long_sum"] = potential(" + ".join(["x"] * 400))
EXPRESSIONS["very_long"] = potential("x+" * 15000 + "x")
EXPRESSIONS["second_line"] = GOOD + "potential_energy: >-\n  m*x\n  + sin(b)\n"
EXPRESSIONS["double_quotes"] = GOOD + 'potential_energy: "m*x + b"\n'
NAMES = {
    "unknown": potential("m*y"),
    "near": GOOD.replace("m*l**2", "mm*l**2"),
    "rate_of_nothing": potential("y_dot"),
    "reserved": HEAD.replace("  l:", "  lambda:").replace("  a:", "  sin:") + "kinetic_energy: m/2*x_dot**2\n",
    "reserved_pi_t": GOOD + "definitions: {pi: x, t: a}\n",
    "reserved_null": GOOD + 'definitions: {null: x, "true": a}\n',
    "ending_in_dot": GOOD + "definitions: {x_dot: 2, foo_ddot: 3}\n",
    "leading_underscore": GOOD + "definitions: {_b: 2}\n",
    "umlaut": GOOD + "definitions: {Höhe: 2}\n",
    "collision": GOOD
    + "definitions: {x: 2, m: 3}\ninputs: {a: {acts_on: {x: 1}}}\nconstraints: {geometric: {l: x - l}}\n",
    "cycle": GOOD + "definitions:\n  b: c + 1\n  c: 2*b\n",
    "own_definition": GOOD + "definitions: {b: b + 1}\n",
    "forward": GOOD + "definitions:\n  b: c + 1\n  c: 2*x\n",
    "parameter_cycle": GOOD.replace("value: 2,", "value: l,").replace("value: 0.5", "value: m"),
    "parameter_forward": GOOD.replace("value: 2,", "value: 2*l,"),
    "parameter_of_a_coordinate": GOOD.replace("value: 2,", "value: 2*x,"),
    "parameter_division_by_zero": GOOD.replace("value: 2,", "value: 1/0,"),
    "parameter_outside_range": GOOD.replace("value: 2,", "value: 2, range: [3, 4],"),
    "time_in_energy": potential("m*x*sin(t)"),
    "time_in_constraint": GOOD + "constraints: {geometric: {c: x - t}}\n",
    "rate_in_potential": potential("m*x_dot"),
    "rate_in_potential_by_definition": GOOD + "potential_energy: m*v\ndefinitions: {v: x_dot}\n",
    "rate_in_geometric": GOOD + "constraints: {geometric: {c: x_dot - a_dot}}\n",
    "rate_in_control_matrix": GOOD + "inputs: {K: {acts_on: {x: x_dot}}}\n",
    "acceleration_in_force": GOOD + "applied_forces: {x: -x_ddot}\n",
    "input_in_force": GOOD + "inputs: {K: {acts_on: {x: 1}}}\napplied_forces: {x: K}\n",
    "multiplier_in_force": GOOD
    + "constraints: {nonholonomic: {c: x_dot - a_dot}}\napplied_forces: {x: multiplier_c}\n",
    "row_in_force": GOOD + "constraints: {nonholonomic: {c: x_dot - a_dot}}\napplied_forces: {x: c}\n",
    "force_on_nothing": GOOD + "applied_forces: {z: 1, x_dot: 2}\n",
    "configuration": GOOD + "configuration: {z: 1, x: l}\n",
    "independent_rate": GOOD + "independent_velocities: [x_dot, z, a, a]\n",
    "outputs": GOOD + "outputs: [mass_matrx, energy]\n",
    "one_output": GOOD + "outputs: al\n",
    "ranges": GOOD + "ranges: {z: [0, 1], x: [2, 1], x_dot: [0, 1/0], a: [0, b], m: [3, 5]}\n",
    "two_ranges": GOOD.replace("unit: rad", "unit: rad, range: [0, 1]") + "ranges: {a: [0, 2]}\n",
    "tolerance": GOOD + "tolerances: {constraint_rank: 2, actuation_rank: -1}\n",
}
STRUCTURE = {
    "linear_term": energy("m/2*x_dot**2 + m*l**2/2*a_dot**2 + 3*x_dot"),
    "potential_in_kinetic": energy("m/2*x_dot**2 + m*l**2/2*a_dot**2 - 9*m*x"),
    "cubic": energy("m/2*x_dot**2 + 7*a_dot**3"),
    "quartic": energy("m/2*x_dot**2 + 7*(a_dot**2)**2"),
    "divided_by_rate": energy("m/2*x_dot**2/a_dot"),
    "sine_of_rate": energy("m/2*x_dot**2 + sin(a_dot)"),
    "root_of_rate": energy("m/2*x_dot**2 + sqrt(a_dot**2)"),
    "half_power": energy("m/2*x_dot**2 + a_dot**(1/2)"),
    "hidden_in_definition": HEAD + "definitions: {v: 5*x_dot + 1}\nkinetic_energy: m/2*v**2 + m*l**2/2*a_dot**2\n",
    "zero": energy("0"),
    "never_defined": energy("m/2*x_dot**2 + m*l**2/2*a_dot**2/sqrt(-1 - 5*x**2)"),
    "affine_row": nonholonomic("x_dot - 3"),
    "quadratic_row": nonholonomic("x_dot*a_dot"),
    "geometric_among_nonholonomic": nonholonomic("x - l"),
    "number_row": geometric("1"),
    "parameter_row": geometric("l - 1"),
    "coordinates_cancel": geometric("x - l - (x - l) + 2*l"),
    "several_in_one_file": energy("m/2*x_dot**2 + 3*x_dot")
    + "potential_energy: m*b\nconstraints: {nonholonomic: {c: 7*x_dot**2}}\n"
    + "inputs: {K: {acts_on: {z: 1}}}\ndescripton: d\n",
}
MECHANISM = {
    "negative_mass": HEAD.replace("value: 2", "value: -2") + KINETIC,
    "indefinite": energy("m/2*x_dot**2 + m*l*x_dot*a_dot"),
    "massless": energy("m/2*x_dot**2"),
    "inconsistent": geometric("x**2 + l**2"),
    "inconsistent_pair": GOOD + "constraints: {geometric: {c: x - l, d: x - 2*l}}\n",
    "immobile": GOOD + "constraints: {geometric: {c: x - l, d: sin(a)}}\n",
    "immobile_nonholonomic": GOOD + "constraints: {geometric: {c: x - l}, nonholonomic: {d: 5*a_dot + 3*x_dot}}\n",
    "count_of_independent": geometric("x - l*sin(a)") + "independent_velocities: [x, a]\n",
    "too_few_measured": GOOD + "measured: [x]\n",
    "measured_twice": geometric("x - l*sin(a)") + "measured: [x, x]\n",
    "measured_rate": geometric("x - l*sin(a)") + "measured: [x_dot]\n",
    "dependent_independent": geometric("x - l") + "independent_velocities: [x]\n",
}
UNITS = {
    "degrees": units("m", "deg", "kg", "m"),
    "rpm": GOOD + "inputs: {K: {unit: rpm, acts_on: {x: 1}}}\n",
    "unknown_unit": units("m", "rad", "pound", "m"),
    "near_unit": units("M", "rad", "Kg", "m"),
    "no_unit": units("m + 1", "rad", "kg", "m"),
    "caret": units("m", "rad", "kg^2", "m"),
    "m_and_mm": units("m", "rad", "kg", "mm"),
    "mass_plus_length": potential("9*(m + l)"),
    "sine_of_a_length": potential("9*m*sin(x)"),
    "energies": potential("m*l"),
    "in_definition": GOOD + "definitions: {b: x + m}\n",
    "in_constraint": geometric("x + m"),
    "input": GOOD + "inputs: {K: {unit: N*m, acts_on: {x: 1}}}\n",
    "lever": GOOD + "inputs: {K: {unit: N, acts_on: {x: cos(a), a: cos(a)}}}\n",
    "applied": GOOD.replace("parameters:", "parameters:\n  d: {value: 1, unit: N*s/m}")
    + "applied_forces: {a: -d*x_dot}\n",
    "parameter_value": GOOD.replace("value: 2,", "value: 2*l,")
    .replace("  m:", "  h:")
    .replace(
        "  l: {value: 0.5, unit: m}",
        "  l: {value: 0.5, unit: m}\n  m: {value: 3*l, unit: kg}\n  k: {value: l/2, unit: kg}",
    )
    .replace("  h: {value: 2*l, unit: kg}\n", ""),
    "atan2": potential("m*atan2(x, m)"),
}
P = "published:\n  - "
DRIVEN = (
    GOOD
    + "inputs:\n  F: {unit: N, acts_on: {x: 1}}\n  T: {unit: N*m, acts_on: {a: 1}}\n"
    + "  P: {unit: N, acts_on: {x: 1, a: l}}\n"
)
TWICE = GOOD + "inputs: {F: {acts_on: {x: 1}}, P: {acts_on: {x: 2}}}\n"
ALLOCATION = {
    "unknown_inputs": DRIVEN + "allocation: {weights: {f: 1}, preload: {Q: 1}, limits: {T: [0, 1], x: [0, 1]}}\n",
    "unknown_key": DRIVEN + "allocation: {weight: {F: 1}}\n",
    "shapes": DRIVEN + "allocation: {weights: 1, preload: [1, 2], limits: {F: 3, T: [1, 2, 3], P: [1, ]}}\n",
    "list": DRIVEN + "allocation: [1]\n",
    "weight_zero": DRIVEN + "allocation: {weights: {F: 0, T: -m}}\n",
    "weight_range": DRIVEN + "allocation: {weights: {F: 1}}\nranges: {weight_F: [0, 2]}\n",
    "not_finite": DRIVEN + "allocation: {weights: {F: 1/(m - 2)}}\n",
    "limits_reversed": DRIVEN + "allocation: {limits: {F: [m, -m]}}\n",
    "coordinate_in_a_limit": DRIVEN + "allocation: {limits: {F: [-x, x]}}\n",
    "taken_names": DRIVEN.replace("m: {value: 2", "preload: {value: 1}\n  weight_F: 3\n  m: {value: 2")
    + "definitions: {limit_T_upper: x}\nallocation: {weights: {F: 1}, preload: 1, limits: {T: [0, 1]}}\n",
    "setting_in_an_expression": DRIVEN + "allocation: {preload: 1}\npotential_energy: preload*x\n",
    "units_of_limits": DRIVEN + "allocation: {limits: {F: [-l, 3*m], T: [0, 1]}}\n",
    "units_of_the_preload": DRIVEN + "allocation: {preload: 2*l}\n",
    "units_of_preferred_values": DRIVEN + "allocation: {preload: {F: l}}\n",
    "no_inputs": GOOD + "allocation: {preload: 1}\n",
    "nothing_to_allocate": GOOD
    + "inputs: {F: {acts_on: {x: 1}}, T: {acts_on: {a: 1}}}\nallocation: {weights: {F: 2}}\n",
    "too_many_directions": DRIVEN.replace("inputs:\n", "inputs:\n  E: {acts_on: {x: 1}}\n")
    + "allocation: {preload: 1, limits: {F: [-1, 1]}}\n",
    "too_many_ways": GOOD
    + f"inputs: {{{', '.join(f'F_{k}: {{acts_on: {{x: 1, a: {k}}}}}' for k in range(12))}}}\n"
    + f"allocation: {{limits: {{{', '.join(f'F_{k}: [-1, 1]' for k in range(12))}}}}}\n",
    "scale_without_limits": DRIVEN + "allocation: {scale: true, limits: {F: [-1, 1]}}\n",
    "tension_of_no_cable": DRIVEN.replace("F: {unit: N,", "F: {tension: {minimum: 1, maximum: 2}, unit: N,"),
    "under_actuated": TWICE + "allocation: {preload: 1, limits: {F: [-1, 1]}}\n",
    "dependent_rows": TWICE
    + "constraints: {nonholonomic: {b: a_dot, c: 2*a_dot}}\nallocation: {preload: 1, limits: {F: [-1, 1]}}\n",
}
PUBLISHED_AND_PATHS = {
    "quantity": GOOD + P + '{equation: "(1)", quantity: mass_matrx, value: [1]}\n',
    "ragged": GOOD + P + '{equation: "(1)", quantity: mass_matrix, value: [[1, 2], [3]]}\n',
    "unknown_name": GOOD + P + '{equation: "(1)", quantity: mass_matrix, value: [[b, 2], [3, x_ddot]]}\n',
    "where_collides": GOOD + P + '{equation: "(1)", quantity: mass_matrix, where: {m: 2}, value: [[m]]}\n',
    "time": GOOD + P + '{equation: "(1)", quantity: mass_matrix, value: [[t]]}\n',
    "neither": GOOD + P + '{equation: "(1)"}\n',
    "equation_without_side": GOOD + P + '{equation: "(1)", equations: [{left: x_ddot}]}\n',
    "independent": GOOD
    + P
    + '{equation: "(1)", singular_set: {quantity: orthogonal_complement, where_zero: cos(a), independent: [z]}}\n',
    "path_name": GOOD + "paths: {../x: {duration: 1, conditions: {c: x, d: a}}}\n",
    "path_duration": GOOD + "paths: {p: {duration: 0, samples: 1.5, conditions: {c: x, d: a}}}\n",
    "path_too_free": GOOD + "paths: {p: {duration: 1, conditions: {c: x - t}}}\n",
    "path_names": GOOD
    + "paths: {p: {duration: 1, definitions: {b: x, x: t, r: c}, conditions: {c: x - s, d: a_dot}, start: {z: 0}}}\n",
}

ARM = """\
model: arm
coordinates:
  a: {unit: rad}
  b: {unit: rad}
parameters:
  l: {value: 0.5, unit: m}
  m: {value: 2, unit: kg}
  J: {value: 0.1, unit: kg*m**2}
gravity: [0, -9.81, 0]
"""
FRAMES = """\
frames:
  upper: {rotation: [[z, a]]}
  lower: {parent: upper, translation: [l, 0, 0], rotation: [[z, b]]}
"""
MASSES = """\
bodies:
  upper: {mass: m, com: [l/2, 0, 0], inertia: {zz: J}}
  lower: {mass: m, com: [l/2, 0, 0], inertia: {zz: J}}
"""
JOINTS = """\
joints:
  upper: {type: revolute, coordinate: a}
  lower: {type: revolute, parent: upper, at: [l, 0, 0], coordinate: b}
"""
POINTS = """\
points:
  tip: {frame: lower, at: [l, 0, 0]}
"""


def arm(frames: str = FRAMES, bodies: str = MASSES, points: str = POINTS, more: str = "") -> str:
    """The good arm with some of its blocks replaced."""
    return f"{ARM}{frames}{bodies}{points}{more}"


def turned(rotation: str) -> str:
    """The arm with that rotation of its upper part."""
    return arm(frames=FRAMES.replace("[[z, a]]", rotation))


def heavy(inertia: str) -> str:
    """The arm with that inertia of its lower part."""
    return arm(bodies=MASSES.replace("{zz: J}}\n", f"{{{inertia}}}}}\n"))


BODIES = {
    "loop_in_the_frame_tree": arm(frames=FRAMES.replace("{rotation", "{parent: lower, rotation")),
    "loop_in_the_frame_tree_of_a_machine": arm(
        frames=FRAMES.replace("{rotation", "{parent: lower, rotation"),
        more="loops: {cut: {type: revolute, between: [lower, upper]}}\n"
        "rolling: {tyre: {frame: lower, radius: l}}\nconstraints: {geometric: {c: tip.x - l, d: tip.u}}\n",
    ),
    "unknown_parent": arm(frames=FRAMES.replace("parent: upper", "parent: uper")),
    "frame_without_a_turn": turned("[z, a]"),
    "axis_of_zero_length": turned("[[[0, 0, 0], a]]"),
    "unknown_axis": turned("[[w, a]]"),
    "axis_that_moves": turned("[[[b, 0, 1], a]]"),
    "rate_in_a_frame": turned("[[z, a_dot]]"),
    "point_in_a_frame": arm(frames=FRAMES.replace("[l, 0, 0]", "[tip.x, 0, 0]")),
    "quaternion_of_three": turned("{quaternion: [1, 0, a]}"),
    "two_components": arm(frames=FRAMES.replace("[l, 0, 0]", "[l, 0]")),
    "world_is_taken": arm(frames=FRAMES + "  world: {}\n"),
    "body_without_mass": arm(bodies=MASSES.replace("mass: m, ", "")),
    "body_without_frame": arm(bodies=MASSES + "  loader: {mass: 1}\n"),
    "negative_mass": arm(bodies=MASSES.replace("lower: {mass: m", "lower: {mass: m - 3")),
    "mass_that_changes": arm(bodies=MASSES.replace("lower: {mass: m", "lower: {mass: m*a")),
    "negative_moment": arm(
        bodies=MASSES.replace("lower: {mass: m, com: [l/2, 0, 0], inertia: {zz: ", "lower: {mass: m, inertia: {zz: -4*")
    ),
    "unknown_element": heavy("zy: 1"),
    "massless_motion": arm(bodies="bodies: {upper: {mass: 0}, lower: {mass: m}}\n"),
    "massless_motion_seen_in_rounding_only": arm(
        frames=FRAMES.replace("[l, 0, 0]", "[1, 0, 0]"),
        bodies="bodies: {upper: {mass: m}, lower: {mass: m, com: [1, 0, 0]}}\n",
        points="points: {tip: {frame: lower, at: [1, 0, 0]}}\n",
        more="loops: {folded: {type: point, between: [tip, world]}}\n",
    ),
    "massless_motion_of_two": arm(
        frames="frames:\n  upper: {rotation: [[z, a]]}\n  lower: {parent: upper, rotation: [[z, b]]}\n",
        bodies="bodies: {lower: {mass: m, com: [l/2, 0, 0], inertia: {zz: J}}}\n",
    ),
    "rotor_on_a_frame": arm(more="rotor_inertias: {upper: J}\n"),
    "negative_rotor": arm(more="rotor_inertias: {a: -J}\n"),
    "point_in_an_unknown_frame": arm(points=POINTS.replace("lower", "hand")),
    "unknown_component": arm(more="constraints: {geometric: {c: tip.u}}\n"),
    "component_of_a_number": arm(more="constraints: {geometric: {c: l.x}}\n"),
    "component_with_a_space": arm(more="constraints: {geometric: {c: tip. x}}\n"),
    "velocity_in_geometry": arm(more="constraints: {geometric: {c: tip.vx}}\n"),
    "place_in_a_parameter": arm(more="ranges: {m: [1, tip.x]}\n"),
    "point_as_a_number": arm(more="constraints: {geometric: {c: tip - 1}}\n"),
    "wrong_units": arm(bodies=MASSES.replace("mass: m, com: [l/2", "mass: l, com: [m/2").replace("zz: J", "zz: m")),
    "gravity_in_kilograms": arm().replace("-9.81", "-m"),
    "input_without_action": arm(more="inputs: {u: {unit: N}}\n"),
    "input_with_two_actions": arm(more="inputs: {u: {joint: a, acts_on: {b: 1}}}\n"),
    "input_on_no_joint": arm(more="inputs: {u: {joint: c}}\n"),
    "force_without_direction": arm(more="inputs: {u: {point: tip}}\n"),
    "force_on_an_unknown_point": arm(more="inputs: {u: {point: tp, direction: [1, 0, 0]}}\n"),
    "torque_on_a_point": arm(more="inputs: {u: {torque_on: tip, direction: [0, 0, 1]}}\n"),
    "unknown_axes": arm(more="inputs: {u: {point: tip, direction: [1, 0, 0], axes: hand}}\n"),
    "force_in_newton_metres": arm(more="inputs: {u: {unit: N*m, point: tip, direction: [1, 0, 0]}}\n"),
    "force_in_a_revolute_joint": arm(more="inputs: {u: {unit: N, joint: a}}\n"),
    "loop_that_cannot_close": arm(more="constraints: {geometric: {far: tip.x - 3*l}}\n"),
    "no_freedom_left": arm(more="constraints: {geometric: {c: tip.x - l, d: tip.y}}\n"),
}

ELEMENTS = {
    "unknown_joint": arm(more="joints: {wrist: {type: hinge, parent: lower, coordinate: c}}\n"),
    "unknown_joint_without_coordinates": arm(more="joints: {wrist: {type: ball, parent: lower}}\n"),
    "joint_of_too_few_coordinates": arm(more="joints: {wrist: {type: planar, parent: lower, coordinates: [c, d]}}\n"),
    "joint_coordinates_that_are_no_names": arm(
        more="joints: {wrist: {type: planar, parent: lower, coordinates: [t, m, while]}}\n"
        "loops: {cut: {type: revolute, between: [wrist, upper]}}\n"
    ),
    "joint_without_its_coordinates_in_a_loop": arm(
        more="joints: {wrist: {type: planar, parent: lower, coordinates: [c, d]}}\n"
        "loops: {cut: {type: revolute, between: [wrist, upper]}}\n"
    ),
    "two_points_in_a_spherical_joint": arm(
        points=POINTS + "  wall: {at: [l, 0, 0]}\n",
        more="loops: {cut: {type: spherical, between: [tip, wall]}}\n",
    ),
    "a_coordinate_in_a_loop_of_points": arm(more="loops: {cut: {type: point, between: [tip, b]}}\n"),
    "joint_axis_of_zero_length": arm(
        more="joints: {wrist: {type: revolute, parent: lower, axis: [0, 0, 0], coordinate: c}}\n"
    ),
    "slide_of_zero_length": arm(
        more="joints: {wrist: {type: prismatic, parent: lower, axis: [l - 0.5, 0, 0], coordinate: c}}\n"
    ),
    "two_frames_of_one_name": arm(more="joints: {wrist: {type: revolute, child: lower, coordinate: c}}\n"),
    "joint_that_hangs_on_itself": arm(more="joints: {wrist: {type: revolute, parent: wrist, coordinate: c}}\n"),
    "quaternion_before_a_joint": arm(
        more="joints: {wrist: {type: revolute, rotation: {quaternion: [1, 0, 0, 0]}, coordinate: c}}\n"
    ),
    "unknown_loop": arm(more="loops: {cut: {type: spring, between: [tip, upper]}}\n"),
    "loop_between_three": arm(more="loops: {cut: {type: point, between: [tip, upper, lower]}}\n"),
    "loop_to_nowhere": arm(more="loops: {cut: {type: point, between: [tip, hook]}}\n"),
    "loop_of_points_with_an_axis": arm(more="loops: {cut: {type: revolute, between: [tip, upper]}}\n"),
    "slider_that_cannot_close": arm(
        frames=JOINTS + "frames: {rail: {translation: [0, 3*l, 0]}}\n",
        more="loops: {cut: {type: cylindrical, between: [lower, rail], axis: x}}\n",
    ),
    "distance_without_length": arm(more="loops: {cut: {type: distance, between: [tip, upper]}}\n"),
    "loop_that_cannot_close": arm(more="loops: {cut: {type: distance, between: [tip, upper], length: 3*l}}\n"),
    "row_of_a_taken_name": arm(
        more="inputs: {cut_x: {joint: a}}\nloops: {cut: {type: point, between: [tip, upper]}}\n"
    ),
    "wheel_without_radius": arm(more="rolling: {wheel: {frame: lower}}\n"),
    "wheel_on_a_point": arm(more="rolling: {wheel: {frame: tip, radius: l}}\n"),
    "spring_on_nothing": arm(more="springs: {s: {stiffness: 100}}\n"),
    "spring_in_kilograms": arm(more="springs: {s: {between: [tip, upper], stiffness: m, length: J}}\n"),
    "dry_friction_without_width": arm(more="friction: {a: {coulomb: 1}}\n"),
    "friction_in_a_frame": arm(more="friction: {lower: {viscous: 1}}\n"),
    "force_without_magnitude": arm(more="forces: {wind: {point: tip, direction: [1, 0, 0]}}\n"),
    "force_of_an_acceleration": arm(
        more="forces: {wind: {point: tip, direction: [1, 0, 0], magnitude: m*a_ddot}}\n"
    ),
    "cable_of_one_point": arm(more="inputs: {u: {cable: [tip]}}\n"),
    "tension_told_twice": arm(
        more="inputs: {u: {cable: [tip, world], tension: {minimum: 1, maximum: 2}}, v: {joint: a}, w: {joint: a}}\n"
        "allocation: {limits: {u: [0, 1]}}\n"
    ),
    "tension_turned_over": arm(
        more="inputs: {u: {cable: [tip, world], tension: {minimum: 2, maximum: 1}}, v: {joint: a}, w: {joint: a}}\n"
    ),
}

GROUPS = {
    "first": FIRST,
    "yaml": YAML,
    "shape": SHAPE,
    "expressions": EXPRESSIONS,
    "names": NAMES,
    "structure": STRUCTURE,
    "mechanism": MECHANISM,
    "bodies": BODIES,
    "elements": ELEMENTS,
    "rough": ROUGH,
    "units": UNITS,
    "allocation": ALLOCATION,
    "published_and_paths": PUBLISHED_AND_PATHS,
}
