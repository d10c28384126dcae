"""Mechanisms for the tests of the witness that no shipped model covers."""

# A beam on three parallel cranks: six loop closures of rank five, whatever rows are chosen.
CRANKS = """
model: cranks
coordinates: {a: {}, b: {}, c: {}, x: {}, y: {}, turn: {}}
parameters: {l: 0.5, m: 2, J: 0.3, g: 9.81}
kinetic_energy: m/2*(x_dot**2 + y_dot**2) + J/2*(turn_dot**2 + a_dot**2) + J/3*b_dot**2 + J/5*c_dot**2
potential_energy: g*m*y
constraints:
  geometric:
    ax: l*cos(a) - x
    ay: l*sin(a) - y
    bx: l*cos(b) + 1 - x - cos(turn)
    by: l*sin(b) - y - sin(turn)
    cx: l*cos(c) + 2 - x - 2*cos(turn)
    cy: l*sin(c) - y - 2*sin(turn)
inputs: {drive: {acts_on: {a: 1}}}
configuration: {a: 1.5, b: 1.5, c: 1.5, x: 0.035, y: 0.499, turn: 0}
measured: [b]
task: {reach: x + y/2}
outputs: all
"""

# Two inputs that pull in the same direction, three degrees of freedom.
UNDER_ACTUATED = """
model: under_actuated
coordinates: {x: {}, y: {}, z: {}}
kinetic_energy: x_dot**2 + (2 + cos(y))*y_dot**2 + z_dot**2 + x_dot*y_dot*sin(z)
potential_energy: x*z
inputs: {pull: {acts_on: {x: 1, y: cos(z)}}, push: {acts_on: {x: 2, y: 2*cos(z)}}}
applied_forces: {x: -y*x_dot}
task: {first: x + sin(y), second: y - z*z, third: x*y + z}
outputs: all
"""

# A turning crane whose jib slides: places and Jacobians of points, one of them on a part that others move along.
CRANE = """
model: crane
joints:
  tower: {type: revolute, axis: z, coordinate: a}
  jib: {type: revolute, parent: tower, axis: y, at: [0.1, 0, 0.6], rotation: [[x, 0.3]], coordinate: b}
  trolley: {type: prismatic, parent: jib, axis: x, coordinate: s}
parameters: {l: 0.5, m: 2, J: 0.05}
gravity: [0, 0, -9.81]
bodies:
  tower: {mass: m, com: [0.02, 0, 0.3], inertia: {xx: J, yy: J, zz: J}}
  jib: {mass: m, com: [l/2, 0, 0], inertia: {xx: J, yy: J, zz: J, xy: 0.001}}
  trolley: {mass: m, inertia: {xx: J, yy: J, zz: J}}
points:
  hook: {frame: trolley, at: [0, 0.1, -l]}
  below: {frame: jib, at: [s, 0, -0.1], moves_with: trolley}
constraints: {geometric: {level: hook.z - 0.2}}
inputs: {turn: {joint: a}, slide: {joint: s}}
configuration: {a: 0.3, b: 0.1, s: 0.4}
measured: [a, s, b]
task: {x: hook.x, y: hook.y, turn: a}
outputs: all
"""

# A ruler that turns about the foot of two links: of its task two directions stay open.
RULER = """
model: ruler
coordinates: {x: {}, y: {}, a: {}, b: {}, c: {}}
parameters: {l: 0.5, h: 0.3}
kinetic_energy: (x_dot**2 + y_dot**2 + a_dot**2 + b_dot**2 + c_dot**2)/2
constraints: {geometric: {across: x - l*cos(a) - h*cos(a + b), up: y - l*sin(a) - h*sin(a + b)}}
inputs: {u: {acts_on: {a: 1}}}
task: {reach: x*cos(c) + y*sin(c)}
configuration: {x: 0.5691, y: 0.4743, a: 0.4, b: 0.8, c: 0.5}
outputs: all
"""

EXTRA = {"crane": CRANE, "cranks": CRANKS, "ruler": RULER, "under_actuated": UNDER_ACTUATED}
