"""The resolved model: what the user wrote, checked and complete, as frozen data.

Names in expressions refer to coordinates `x`, rates `x_dot`, accelerations `x_ddot` (published formulas only),
parameters, definitions (kept as names, in order of use), and in paths the time `t`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction
from typing import Literal, TypeAlias

from symgen.diagnostics import Notice, Span
from symgen.model.configurations.assembly import Assembly
from symgen.model.configurations.friction_steps import FrictionSteps
from symgen.model.expressions.expression import Expression
from symgen.model.identify_choice import IdentifyChoice
from symgen.model.inertial_base import InertialBase
from symgen.model.mechanism import NO_MECHANISM, Mechanism
from symgen.model.published import Published
from symgen.model.quantities import FurtherName
from symgen.naming import c_name
from symgen.records import dataclass

Range: TypeAlias = tuple[Fraction, Fraction]


@dataclass(frozen=True, slots=True)
class Coordinate:
    """A generalized coordinate q^a, with the ranges states are sampled from."""

    name: str
    unit: str | None
    description: str
    is_angle: bool
    range: Range
    rate_range: Range
    acceleration_range: Range
    span: Span | None = None
    has_range: bool = True  # told, not taken for granted
    has_rate_range: bool = True
    has_acceleration_range: bool = True

    @property
    def rate(self) -> str:
        """The name of the rate in expressions."""
        return f"{self.name}_dot"

    @property
    def acceleration(self) -> str:
        """The name of the acceleration in expressions."""
        return f"{self.name}_ddot"


@dataclass(frozen=True, slots=True)
class Parameter:
    """A run-time parameter of the kernels; `value` is its default, an expression of earlier parameters."""

    name: str
    unit: str | None
    description: str
    value: Expression
    range: Range | None
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class Definition:
    """A named sub-expression of coordinates, rates, parameters and earlier definitions."""

    name: str
    value: Expression
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class ConstraintRow:
    """g(q) = 0 (geometric) or an expression linear in the rates, = 0 (nonholonomic)."""

    name: str
    kind: Literal["geometric", "nonholonomic"]
    expression: Expression
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class Input:
    """One control force u_i: its column of the control matrix M(q), coordinate by coordinate.

    A force at a point, along a cable or between bodies is given by `velocity` instead: the rate u_i works on (its power
    is u_i times this rate), linear in the rates; the column holds its coefficients.
    """

    name: str
    unit: str | None
    description: str
    acts_on: tuple[tuple[str, Expression], ...]
    span: Span | None = None
    velocity: Expression | None = None


@dataclass(frozen=True, slots=True)
class Limit:
    """The limits of one input, by the names of the parameters that hold them."""

    input: str
    lower: str
    upper: str


@dataclass(frozen=True, slots=True)
class Allocation:
    """How redundant inputs share the work; its numbers are the last of the model's parameters, named here.

    `weights` and `preferred` are pairs (input, parameter).  `preload` is the parameter that multiplies the one
    internal-force direction; `preferred` values are approached by all inputs together.  With `scale` the inputs are
    those of the largest share of a motion that limits of all inputs allow.
    """

    weights: tuple[tuple[str, str], ...]
    preload: str | None
    preferred: tuple[tuple[str, str], ...]
    limits: tuple[Limit, ...]
    scale: bool = False
    span: Span | None = None

    @property
    def directed(self) -> bool:
        """Whether it needs the one internal-force direction of m - delta = 1."""
        return self.preload is not None or bool(self.limits)


@dataclass(frozen=True, slots=True)
class AppliedForce:
    """A further generalized force Q_a(q, q_dot) on the right-hand side of one coordinate's equation."""

    coordinate: str
    expression: Expression
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class Force:
    """A force element: `magnitude`(q, q_dot) times the coefficients of `velocity` by the rates adds to Q_a."""

    name: str
    magnitude: Expression
    velocity: Expression
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class RoughPlace:
    """A pin or a guide whose friction grows with the reaction R that it carries (Remark 3).

    Along `velocity`, a rate (1/s in a pin, m/s in a guide), it takes coefficient * radius * |R| * tanh(velocity/width);
    the radius of a guide is 1.  The components of R are the multipliers of `rows`, or what keeps `released` coordinates
    at 0, which are not the model's (`kinematics/released.py`), and a known `load` (N) at right angles to these.
    """

    name: str
    coefficient: Expression
    radius: Expression
    width: Expression
    velocity: Expression
    rows: tuple[str, ...] = ()
    released: tuple[str, ...] = ()
    load: Expression | None = None
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class ReleasedJoint:
    """The frame of a joint, and the coordinates with the axes (0, 1, 2) along which it could leave its parent.

    `turns` is how many of the frame's last turns are the joint's own: axes are those before these.
    """

    frame: str
    coordinates: tuple[tuple[str, int], ...]
    turns: int


@dataclass(frozen=True, slots=True)
class Path:
    """A trajectory q(t) on 0 <= t <= duration, fixed by the geometric constraints and `conditions`(q, t) = 0.

    `definitions` are named expressions of t and parameters; `start` is where Newton's method begins at t = 0;
    rates and accelerations follow by differentiating constraints and conditions.
    """

    name: str
    description: str
    duration: Fraction
    samples: int
    definitions: tuple[Definition, ...]
    conditions: tuple[tuple[str, Expression], ...]
    start: tuple[tuple[str, Fraction], ...]
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class TaskCoordinate:
    """A coordinate of the task: a function of the configuration, such as the place of a tool."""

    name: str
    expression: Expression
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class TaskLeaves:
    """How many directions a task leaves open, of admissible rates and of configurations.

    `idle` is how many of its functions follow from the others along admissible motions.
    """

    rates: int = 0
    places: int = 0
    idle: int = 0


@dataclass(frozen=True, slots=True)
class FurtherArgument:
    """An array argument of some kernels beside q, qd, qdd and u.

    `names` are those of its entries.  In trials an entry is what stands at its place: measured values at that of their
    coordinate.
    """

    name: FurtherName
    places: tuple[int, ...]
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Model:
    """A mechanical system, complete: the input of every derivation.

    T and U are the energies written in the file plus those of `mechanism`; `assembly` is what loading found out about
    its configurations.  `row_units` are set where rows stand here times 2 to these powers (`quantities/row_units.py`).
    What is `measured` leaves places open where rows hold rates alone (`measures_places`); so may a `task`.
    `taken` are parameters of the file that are numbers here (`as_numbers`).
    `together` are outputs that have a function in common as well.
    `identify` is what the file says of parameters that a log may tell.
    `inertial_base` is looked for where outputs are made of it (`combinations/inertial_base.py`).
    `released` are the joints of `rough` places whose reactions are no multipliers, `friction_steps` how their
    friction is worked out for a motion, `motion_steps` the same for inputs.
    `picture` are frames, points, wheels, springs and solids that drawings alone have.
    """

    name: str
    description: str
    source: str
    coordinates: tuple[Coordinate, ...]
    parameters: tuple[Parameter, ...]
    definitions: tuple[Definition, ...]
    kinetic_energy: Expression
    potential_energy: Expression
    constraints: tuple[ConstraintRow, ...]
    inputs: tuple[Input, ...]
    applied_forces: tuple[AppliedForce, ...]
    outputs: tuple[str, ...]
    independent_velocities: tuple[str, ...]
    configuration: tuple[tuple[str, Fraction], ...]
    constraint_rank_tolerance: Fraction | None
    actuation_rank_tolerance: Fraction | None
    published: tuple[Published, ...]
    paths: tuple[Path, ...]
    report: Literal["full", "short"]
    notices: tuple[Notice, ...]
    text_hash: str
    mechanism: Mechanism = NO_MECHANISM
    forces: tuple[Force, ...] = ()
    rough: tuple[RoughPlace, ...] = ()
    released: tuple[ReleasedJoint, ...] = ()
    friction_steps: FrictionSteps | None = None
    motion_steps: FrictionSteps | None = None
    allocation: Allocation | None = None
    trig_range: Literal["normal", "wide"] = "normal"
    derivatives: bool = False
    together: tuple[tuple[str, ...], ...] = ()
    measured: tuple[str, ...] = ()
    # standard deviations of what their encoders say, in their units; none where all count alike
    deviations: tuple[Fraction, ...] = ()
    measures_places: bool = True
    task: tuple[TaskCoordinate, ...] = ()
    task_leaves: TaskLeaves = TaskLeaves()
    assembly: Assembly | None = None
    row_units: tuple[int, ...] = ()
    taken: tuple[tuple[str, Fraction], ...] = ()
    inertial_base: InertialBase | None = None
    identify: IdentifyChoice | None = None
    picture: Mechanism = NO_MECHANISM

    @property
    def pictured(self) -> Mechanism:
        """The mechanism as drawings have it: what equations are made of, and what is drawn beside that."""
        own, drawn = self.mechanism, self.picture
        return replace(
            own,
            frames=own.frames + drawn.frames,
            points=own.points + drawn.points,
            wheels=own.wheels + drawn.wheels,
            ties=own.ties + drawn.ties,
            solids=own.solids + drawn.solids,
        )

    @property
    def c_name(self) -> str:
        """What its files, functions and types are called: its name, unless that clashes."""
        return c_name(self.name)

    @property
    def measured_places(self) -> tuple[int, ...]:
        """The numbers of the measured coordinates, in the order of the file."""
        names = [c.name for c in self.coordinates]
        return tuple(names.index(name) for name in self.measured)

    @property
    def measured_scales(self) -> tuple[Fraction, ...]:
        """What differences of the measured coordinates are multiplied by before they are squared: 1 at most."""
        return tuple(min(self.deviations) / one for one in self.deviations) or (Fraction(1),) * len(self.measured)

    @property
    def further_arguments(self) -> tuple[FurtherArgument, ...]:
        """Those of measured coordinates, the task, weights and a direction, in the order of signatures; some are empty.

        In trials rates of the task are those of coordinates: what they are multiplied with does not depend on them.
        """
        n, places, task = self.n, self.measured_places, range(len(self.task))
        coordinates, moving = [self.coordinates[k] for k in places], tuple(k % n for k in task) if n else ()
        motion = [(c.name, c.rate, c.acceleration) for c in self.coordinates]
        taken = {name for names in motion for name in names}
        taken |= {item.name for group in (self.parameters, self.definitions, self.inputs) for item in group}

        def free(name: str) -> str:
            return free(name + "_") if name in taken else name

        def one(argument: FurtherName, of: Iterable[int], names: Iterable[str]) -> FurtherArgument:
            ending = {"q": "measured", "x": "task", "w": "weight", "v": "direction"}[argument[0]]
            return FurtherArgument(argument, tuple(of), tuple(free(f"{name}_{ending}") for name in names))

        return (
            one("q_m", places, (c.name for c in coordinates)),
            one("qd_m", places, (c.rate for c in coordinates)),
            one("qdd_m", places, (c.acceleration for c in coordinates)),
            one("x_t", task, (x.name for x in self.task)),
            one("xd_t", moving, (f"{x.name}_dot" for x in self.task)),
            one("xdd_t", moving, (f"{x.name}_ddot" for x in self.task)),
            one("w_u", range(self.m), (control.name for control in self.inputs)),
            one("w_qdd", range(n), (c.acceleration for c in self.coordinates)),
            one("v_x", range(3 * n), (names[k] for k in range(3) for names in motion)),
        )

    def further_names(self, argument: FurtherName) -> tuple[str, ...]:
        """What the entries of one of these arguments are called: names that nothing else has."""
        return next(one.names for one in self.further_arguments if one.name == argument)

    @property
    def keeps_limits(self) -> bool:
        """Whether u is within the limits of its allocation, or has a status.

        Along one direction of internal force with a sign of its own it comes as near to them as it can.
        """
        if self.allocation is None or not self.allocation.limits or self.assembly is None:
            return False
        ranks = self.assembly.ranks
        directions = self.m - ranks.actuation
        return directions > 1 or (directions == 1 and ranks.constraints < self.r)

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return len(self.coordinates)

    @property
    def r(self) -> int:
        """Number of constraint rows, geometric first, then non-holonomic, in the order of the file."""
        return len(self.constraints)

    @property
    def has_applied_forces(self) -> bool:
        """Whether the file gives forces besides weight, springs and inputs."""
        return bool(self.applied_forces or self.forces)

    @property
    def m(self) -> int:
        """Number of inputs."""
        return len(self.inputs)
