"""The model file: which blocks there are, what each holds and what it is for."""

from __future__ import annotations

from symgen.model.file.listed_shapes import NAMES, RANGE, VECTOR
from symgen.model.file.mechanism_shapes import (
    ACTION,
    BODY,
    DESCRIPTION,
    FORCE,
    FRAME,
    FRICTION,
    JOINT,
    LOOP,
    PICTURE,
    POINT,
    SPRING,
    WHEEL,
)
from symgen.model.file.published_shapes import PUBLISHED
from symgen.model.file.shape import (
    Either,
    ExpressionShape,
    JsonSchema,
    Key,
    Listing,
    RecordShape,
    TableShape,
    Text,
    Word,
    json_schema_of,
)
from symgen.model.quantities import QUANTITIES

UNIT = Key("unit", Text(), "SI unit such as m, kg*m**2, N*m, rad; a declaration, nothing is converted")
_OUTPUT = Word(("all", *(quantity.name for quantity in QUANTITIES)))
_QUANTITY_NAME = Word(tuple(quantity.name for quantity in QUANTITIES))
_TOGETHER = RecordShape(
    "an output",
    (Key("together", Listing(_QUANTITY_NAME, 2), "quantities that one call is to have: C that shares", required=True),),
)
_COORDINATE = RecordShape(
    "a coordinate", (UNIT, DESCRIPTION, Key("range", RANGE, "[lower, upper], where states are sampled"))
)
_PARAMETER = RecordShape(
    "a parameter",
    (
        Key("value", ExpressionShape(), "default: a number or an expression of earlier parameters", required=True),
        UNIT,
        DESCRIPTION,
        Key("range", RANGE, "[lower, upper] of sensible values"),
    ),
)
_TENSION = RecordShape(
    "`tension`",
    (
        Key("minimum", ExpressionShape(), "what keeps the cable taut", required=True),
        Key("maximum", ExpressionShape(), "what it, or its drive, bears", required=True),
    ),
)
_INPUT = RecordShape(
    "an input",
    (
        UNIT,
        DESCRIPTION,
        Key("acts_on", TableShape(ExpressionShape(), 1), "coordinate: coefficient of the input in its equation"),
        Key("joint", Word(), "a coordinate: short for acts_on: {it: 1}"),
        *ACTION,
        Key("tension", _TENSION, "between what the tension of a `cable` stays: its `limits` under `allocation`"),
    ),
)
_PATH = RecordShape(
    "a path",
    (
        DESCRIPTION,
        Key("duration", ExpressionShape(), "length in seconds; t runs from 0 to it", required=True),
        Key("samples", ExpressionShape(), "number of points in charts and tests, 201 if absent"),
        Key("definitions", TableShape(ExpressionShape()), "named expressions of t and parameters"),
        Key("conditions", TableShape(ExpressionShape(), 1), "expressions of q, t, parameters, = 0", required=True),
        Key("start", TableShape(ExpressionShape()), "where Newton's method begins at t = 0"),
    ),
)
_ALLOCATION = RecordShape(
    "`allocation`",
    (
        Key("weights", TableShape(ExpressionShape(), 1), "input: positive weight of its square in the norm; absent: 1"),
        Key(
            "preload",
            Either((ExpressionShape(), TableShape(ExpressionShape(), 1))),
            "internal force along the one direction of m - δ = 1, or input: preferred value",
        ),
        Key("limits", TableShape(Listing(ExpressionShape(), 2, 2), 1), "input: [lower, upper]"),
        Key("scale", Word(("true", "false")), "where limits do not allow a motion, the largest share of it they do"),
    ),
)

_DESCRIBED = (
    Key("file", Text(), "its path, below the folder of this file", required=True),
    Key("coordinates", TableShape(Text()), "name of the coordinate: name of the joint, where they differ"),
    Key("frames", TableShape(Text()), "name of the frame: name of the link, where they differ"),
    Key("leave_out", Listing(Word()), "elements and attributes that symgen does not know, and may leave out"),
    Key(
        "friction_width",
        ExpressionShape(),
        "the rate at which dry friction of the joints has 76 % of its full size",
    ),
)
_URDF, _MJCF, _SDF = (RecordShape(f"`{key}`", _DESCRIBED) for key in ("urdf", "mjcf", "sdf"))

MODEL = RecordShape(
    "the model",
    (
        Key("model", Word(), "its name, a C identifier; becomes file name and function prefix", required=True),
        Key("description", Text(), "what the system is, in a sentence"),
        Key("source", Text(), "where it is taken from"),
        Key(
            "coordinates",
            TableShape(_COORDINATE, 1, entries_may_be_empty=True),
            "the generalized coordinates, in the order of q; the rate of x is x_dot",
        ),
        Key("parameters", TableShape(Either((ExpressionShape(), _PARAMETER))), "run-time parameters of the kernels"),
        Key("definitions", TableShape(ExpressionShape()), "named sub-expressions, in order of use"),
        Key("kinetic_energy", ExpressionShape(), "T, quadratic in the rates; that of `bodies` is added"),
        Key("potential_energy", ExpressionShape(), "U of coordinates and parameters; absent: 0"),
        Key(
            "constraints",
            RecordShape(
                "`constraints`",
                (
                    Key("geometric", TableShape(ExpressionShape()), "g(q) = 0, one row each"),
                    Key("nonholonomic", TableShape(ExpressionShape()), "linear in the rates, = 0, one row each"),
                ),
            ),
            "constraint rows by name",
        ),
        Key("coupling", TableShape(ExpressionShape()), "coordinate: what it follows by a gear or belt, such as a: 2*b"),
        Key(
            "urdf",
            Either((Text(), _URDF)),
            "a robot description beside this file: its links become frames, its joints coordinates",
        ),
        Key("mjcf", Either((Text(), _MJCF)), "the same from a file of MuJoCo, with its loops, couplings and motors"),
        Key("sdf", Either((Text(), _SDF)), "the same from an SDF file; joints beyond a tree close loops"),
        Key("gravity", VECTOR, "acceleration of gravity in world axes, such as [0, 0, -g]; absent: 0"),
        Key("frames", TableShape(FRAME), "axes that move with the bodies: a tree that hangs on `world`"),
        Key("bodies", TableShape(BODY), "rigid bodies by name; their energies are added to those written out"),
        Key("rotor_inertias", TableShape(ExpressionShape()), "coordinate: J of a geared rotor, adds J/2*rate**2 to T"),
        Key("joints", TableShape(JOINT), "short form of frames: each brings its frame and its coordinates"),
        Key("loops", TableShape(LOOP), "what closes kinematic loops: rows of geometric constraints"),
        Key("rolling", TableShape(WHEEL), "wheels that roll without slip on the plane z = 0 of the world"),
        Key("springs", TableShape(SPRING), "springs and dampers between points or in a coordinate"),
        Key(
            "friction",
            TableShape(FRICTION),
            "coordinate: friction in it; joint or loop: friction that grows with its reaction",
        ),
        Key("forces", TableShape(FORCE), "forces and torques on points and frames that depend on the state"),
        Key(
            "points", TableShape(POINT), "places with components `.x`, `.y`, `.z`, `.vx`, `.vy`, `.vz` in expressions"
        ),
        Key("inputs", TableShape(_INPUT), "control forces: the columns of the control matrix"),
        Key("allocation", _ALLOCATION, "how redundant inputs share the work: members of the parameter struct"),
        Key(
            "applied_forces",
            TableShape(ExpressionShape()),
            "coordinate: further generalized force of q, rates, parameters",
        ),
        Key(
            "outputs",
            Either((_OUTPUT, Listing(Either((_OUTPUT, _TOGETHER))))),
            "quantities to generate, or all; {together: [...]}: these in one function as well",
        ),
        Key("independent_velocities", NAMES, "coordinates whose rates serve in F and the minimal form"),
        Key(
            "measured",
            Either((NAMES, TableShape(ExpressionShape()))),
            "coordinates that encoders say, from which the others are found; with standard deviations to weigh them",
        ),
        Key(
            "identify",
            RecordShape(
                "`identify`",
                (
                    Key("geometry", NAMES, "parameters of energies that are known from the geometry"),
                    Key("fixed", NAMES, "parameters that keep their values"),
                    Key("gains", NAMES, "factors of inputs, such as motor constants, that are estimated"),
                ),
            ),
            "what `symgen identify` takes for known, of energies where absent parameters whose unit has no mass; gains",
        ),
        Key("task", TableShape(ExpressionShape()), "what motions are planned in: functions of the configuration"),
        Key("derivatives", Word(("true", "false")), "whether `outputs: all` takes derivatives"),
        Key("configuration", TableShape(ExpressionShape()), "a start for Newton's method: the assembly mode"),
        Key("ranges", TableShape(RANGE), "[lower, upper] of coordinates, rates, accelerations, parameters"),
        Key(
            "tolerances",
            RecordShape(
                "`tolerances`",
                (
                    Key("constraint_rank", ExpressionShape(), "relative threshold of status 2"),
                    Key("actuation_rank", ExpressionShape(), "relative threshold of status 3"),
                ),
            ),
            "thresholds on denominators",
        ),
        Key("trig_range", Word(("normal", "wide")), "how far angles may go before status 4"),
        Key("published", Listing(PUBLISHED), "formulas as printed somewhere, to be decided for this model"),
        Key("paths", TableShape(_PATH), "trajectories as functions of t, for charts and tests"),
        Key("picture", PICTURE, "what drawings show beside frames and points; equations and code have nothing of it"),
        Key("report", Word(("full", "short")), "length of the report"),
    ),
)


def json_schema() -> JsonSchema:
    """The JSON Schema of a model file, for editors."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "symgen model",
        **json_schema_of(MODEL),
    }
