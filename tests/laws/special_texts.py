"""Small systems with what the shipped models have not, as a user would write them."""

# Two inputs that pull in the same direction, three degrees of freedom.
RANK_ONE = """
model: rank_one
coordinates: {x: {}, y: {}, turn: {}}
parameters: {m: 2, J: 0.3, a: 0.4}
kinetic_energy: m/2*(x_dot**2 + y_dot**2) + J/2*turn_dot**2 + a*cos(turn)*x_dot*turn_dot
potential_energy: 9.81*m*y
inputs:
  left:  {acts_on: {x: cos(turn), y: sin(turn), turn: a}}
  right: {acts_on: {x: 2*cos(turn), y: 2*sin(turn), turn: 2*a}}
"""

# A beam on three parallel cranks: six loop closures of rank five, whatever rows are chosen (theory 3.6).
CRANKS = """
model: cranks
coordinates: {a: {}, b: {}, c: {}, x: {}, y: {}, turn: {}}
parameters: {l: 0.5, m: 2, J: 0.3, g: 9.81, w: 0.7}
kinetic_energy: m/2*(x_dot**2 + y_dot**2) + J/2*(turn_dot**2 + a_dot**2) + J/3*b_dot**2 + J/5*c_dot**2
potential_energy: g*m*y
constraints:
  geometric:
    a_x: x - w*cos(turn) + w - l*cos(a)
    a_y: y - w*sin(turn) - l*sin(a)
    b_x: x - l*cos(b)
    b_y: y - l*sin(b)
    c_x: x + w*cos(turn) - w - l*cos(c)
    c_y: y + w*sin(turn) - l*sin(c)
inputs: {drive_a: {acts_on: {a: 1}}, drive_b: {acts_on: {b: 1}}}
configuration: {a: 0.8, b: 0.8, c: 0.8, x: 0.348, y: 0.359, turn: 0}
"""

# The point (x, y) has no mass of its own: G is singular, but every motion the constraints allow moves the links.
MASSLESS = """
model: massless
coordinates: {a: {}, b: {}, x: {}, y: {}}
parameters: {l: 0.6, J: 0.2, k: 3}
kinetic_energy: J/2*a_dot**2 + J*b_dot**2 + J*cos(a - b)*a_dot*b_dot
potential_energy: k/2*(x**2 + y**2)
constraints:
  geometric:
    tip_x: x - l*cos(a) - l*cos(b)
    tip_y: y - l*sin(a) - l*sin(b)
inputs: {drive: {acts_on: {a: 1}}, pull: {acts_on: {x: 1}}}
independent_velocities: [a, b]
configuration: {a: 0.3, b: 1.4}
"""

# A mass on a line: no parameter, no input, no constraint, one coordinate.
BARE = """
model: bare
coordinates: {x: {}}
kinetic_energy: x_dot**2
"""

# One coordinate with everything a single one can have.
ONE_COORDINATE = """
model: one_coordinate
coordinates: {x: {}}
kinetic_energy: (1 + x**2)*x_dot**2
potential_energy: exp(x)
inputs: {push: {acts_on: {x: 2 + tanh(x)}}}
applied_forces: {x: "-x_dot*sqrt(1 + x_dot**2)"}
"""

ONLY_NONHOLONOMIC = """
model: only_nonholonomic
coordinates: {x: {}, y: {}, z: {}}
kinetic_energy: x_dot**2 + y_dot**2/2 + z_dot**2
constraints: {nonholonomic: {contact: z_dot - y*x_dot}}
inputs: {push: {acts_on: {x: 1}}, lift: {acts_on: {y: 1}}}
independent_velocities: [x, y]
"""

ONLY_GEOMETRIC = """
model: only_geometric
coordinates: {x: {}, y: {}, z: {}}
kinetic_energy: (x_dot**2 + y_dot**2 + z_dot**2)/2
potential_energy: 9.81*z
constraints: {geometric: {sphere: x**2 + y**2 + z**2 - 1}}
inputs: {push: {acts_on: {x: 1}}, pull: {acts_on: {y: 1}}}
independent_velocities: [x, y]
configuration: {x: 0.3, y: 0.2, z: 0.933}
"""

# delta = 3: a plate on a table, held by one rod; three thrusters, one of them redundant with none.
THREE_FREEDOMS = """
model: three_freedoms
coordinates: {x: {}, y: {}, turn: {}, swing: {}}
parameters: {m: 2, J: 0.3, l: 0.8, e: 0.25}
kinetic_energy: >-
  m/2*(x_dot**2 + y_dot**2) + J/2*turn_dot**2 + J/4*(turn_dot + swing_dot)**2
  + e*cos(turn)*x_dot*turn_dot + e*sin(swing)*y_dot*swing_dot
potential_energy: m*y + cos(swing)
constraints: {geometric: {rod: (x + e*cos(turn))**2 + (y + e*sin(turn))**2 - l**2}}
inputs:
  one:   {acts_on: {x: 1}}
  two:   {acts_on: {y: cos(turn), turn: e}}
  three: {acts_on: {swing: 1}}
  four:  {acts_on: {x: sin(turn), swing: 2}}
independent_velocities: [y, turn, swing]
configuration: {x: 0.5, y: 0.2, turn: 0.3, swing: 0.1}
"""

# delta = 4, two rows of both kinds.
MIXED = """
model: mixed
coordinates: {x: {}, y: {}, z: {}, turn: {}, spin: {}, tilt: {}}
parameters: {m: 1.5, J: 0.2, R: 0.4}
kinetic_energy: >-
  m/2*(x_dot**2 + y_dot**2 + z_dot**2) + J/2*turn_dot**2 + J*spin_dot**2 + J/3*(tilt_dot + cos(turn)*spin_dot)**2
potential_energy: 9.81*m*z
constraints:
  geometric:
    surface: z - R*sin(x)*cos(y)
  nonholonomic:
    blade: sin(turn)*x_dot - cos(turn)*y_dot
    roll:  cos(turn)*x_dot + sin(turn)*y_dot - R*spin_dot
inputs: {steer: {acts_on: {turn: 1}}, drive: {acts_on: {spin: 1}}, lean: {acts_on: {tilt: 1, turn: 0.2}}}
independent_velocities: [turn, spin, tilt]
configuration: {x: 0.3, y: 0.2, z: 0.116, turn: 0.4}
"""


# A hanging chain: as many rows as bars, soon far more minors than worth building.
def chain(bars: int) -> str:
    """Bars end to end, described by the two coordinates of each far end, each held by its length."""
    places = range(1, bars + 1)
    names = [f"x_{i}" for i in places] + [f"y_{i}" for i in places]
    masses = " + ".join(f"{1 + k % 3}/2*{name}_dot**2" for k, name in enumerate(names))
    rows = ["    bar_1: x_1**2 + y_1**2 - l**2"]
    rows += [f"    bar_{i}: (x_{i} - x_{i - 1})**2 + (y_{i} - y_{i - 1})**2 - l**2" for i in places[1:]]
    start = ", ".join(f"x_{i}: {0.4 * i:.1f}, y_{i}: {-0.3 * i:.1f}" for i in places)
    return "\n".join(
        [
            "model: hanging_chain",
            f"coordinates: {{{', '.join(f'{name}: {{}}' for name in names)}}}",
            "parameters: {l: 0.5}",
            f"kinetic_energy: {masses}",
            f"potential_energy: 9.81*({' + '.join(f'y_{i}' for i in places)})",
            "constraints:",
            "  geometric:",
            *rows,
            "inputs: {pull: {acts_on: {x_1: 1}}, lift: {acts_on: {y_2: 1, x_3: 0.5}}}",
            f"configuration: {{{start}}}",
            "",
        ]
    )


# The skate on a plane inclined about the y axis.
INCLINED_SKATE = """
model: inclined_skate
coordinates: {phi: {unit: rad}, x: {unit: m}, y: {unit: m}}
parameters: {Theta: 0.05, m: 2, g: 9.81, slope: 0.3}
kinetic_energy: Theta/2*phi_dot**2 + m/2*(x_dot**2 + y_dot**2)
potential_energy: m*g*sin(slope)*x
constraints: {nonholonomic: {blade: sin(phi)*x_dot - cos(phi)*y_dot}}
inputs: {T: {acts_on: {phi: 1}}, K: {acts_on: {x: cos(phi), y: sin(phi)}}}
"""

# A two-link arm whose tip is held on a circle.
ARM_ON_CIRCLE = """
model: arm_on_circle
coordinates: {a: {unit: rad}, b: {unit: rad}}
parameters: {l_1: 0.5, l_2: 0.4, m_1: 1.2, m_2: 0.8, R: 0.3, c_x: 0.5, c_y: 0.1, g: 9.81}
definitions:
  tip_x: l_1*cos(a) + l_2*cos(a + b)
  tip_y: l_1*sin(a) + l_2*sin(a + b)
kinetic_energy: >-
  m_1*l_1**2/2*a_dot**2 + m_2/2*(l_1**2*a_dot**2 + l_2**2*(a_dot + b_dot)**2 + 2*l_1*l_2*cos(b)*a_dot*(a_dot + b_dot))
potential_energy: g*(m_1*l_1*sin(a) + m_2*tip_y)
constraints: {geometric: {circle: (tip_x - c_x)**2 + (tip_y - c_y)**2 - R**2}}
inputs: {shoulder: {acts_on: {a: 1}}, elbow: {acts_on: {b: 1}}}
independent_velocities: [a]
configuration: {a: 0.3, b: 1.2}
"""

# Slider-crank with equal links: at crank angle pi/2 the slider sits at the origin and B loses rank.
EQUAL_LINKS = """
model: equal_links
coordinates: {a: {}, b: {}, x: {}}
parameters: {l: 0.4}
kinetic_energy: a_dot**2/2 + b_dot**2/3 + x_dot**2
constraints:
  geometric:
    loop_x: l*cos(a) + l*cos(b) - x
    loop_y: l*sin(a) + l*sin(b)
inputs: {T: {acts_on: {a: 1}}}
independent_velocities: [a]
configuration: {a: 0.7, b: -0.7, x: 0.612}
"""
