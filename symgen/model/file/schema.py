"""The model file: which blocks there are, what each holds and what it is for."""

from __future__ import annotations

from symgen.model.blocks.joint_forms import JOINTS
from symgen.model.blocks.loops import LOOPS
from symgen.model.file.shape import (
    Either,
    EitherRecord,
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
from symgen.model.mechanism import AXES, INERTIA_ELEMENTS
from symgen.model.quantities import QUANTITIES

_RANGE = Listing(ExpressionShape(), 2, 2)
_VECTOR = Listing(ExpressionShape(), 3, 3)
_AXIS = Either((Word(), _VECTOR))
_MAIN_AXIS = Word(AXES)
_UNIT = Key("unit", Text(), "SI unit such as m, kg*m**2, N*m, rad; a declaration, nothing is converted")
_DESCRIPTION = Key("description", Text(), "what it is, in a few words; stands in headers and reports")
_MATRIX = Listing(Either((ExpressionShape(), Listing(ExpressionShape(), 1))), 1)
_NAMES = Listing(Word())
_OUTPUT = Word(("all", *(quantity.name for quantity in QUANTITIES)))
_QUANTITY_NAME = Word(tuple(quantity.name for quantity in QUANTITIES))
_TOGETHER = RecordShape(
    "an output",
    (Key("together", Listing(_QUANTITY_NAME, 2), "quantities that one call is to have: C that shares", required=True),),
)
_EQUATION = Key("equation", Text(), 'its number where it was printed, such as "(44)"', required=True)
_QUANTITY = Key("quantity", Word(), "name of a quantity, as in `outputs`", required=True)
_INDEPENDENT = Key("independent", _NAMES, "the independent velocities the formula is for")
_WHERE = Key("where", TableShape(ExpressionShape()), "symbols of this formula only")
_BOTH_SIDES = Listing(
    RecordShape(
        "an equation",
        (
            Key("left", ExpressionShape(), "left-hand side", required=True),
            Key("right", ExpressionShape(), "right-hand side", required=True),
        ),
    ),
    1,
)

_COORDINATE = RecordShape(
    "a coordinate", (_UNIT, _DESCRIPTION, Key("range", _RANGE, "[lower, upper], where states are sampled"))
)
_PARAMETER = RecordShape(
    "a parameter",
    (
        Key("value", ExpressionShape(), "default: a number or an expression of earlier parameters", required=True),
        _UNIT,
        _DESCRIPTION,
        Key("range", _RANGE, "[lower, upper] of sensible values"),
    ),
)
_ACTION = (
    Key("point", Word(), "a point (or frame, for its origin) where a force acts, along `direction`"),
    Key("torque_on", Word(), "a frame on which a torque acts, about `direction`"),
    Key("direction", _VECTOR, "unit vector of the force or torque"),
    Key("axes", Word(), "the frame whose axes the direction is given in, world if absent"),
    Key("reaction", Word(), "the point or frame on which the opposite force or torque acts"),
    Key("cable", Listing(Word(), 2), "points that a cable runs through; the force is its tension"),
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
        _UNIT,
        _DESCRIPTION,
        Key("acts_on", TableShape(ExpressionShape(), 1), "coordinate: coefficient of the input in its equation"),
        Key("joint", Word(), "a coordinate: short for acts_on: {it: 1}"),
        *_ACTION,
        Key("tension", _TENSION, "between what the tension of a `cable` stays: its `limits` under `allocation`"),
    ),
)
_TURNS = Listing(Listing(Either((ExpressionShape(), _VECTOR)), 2, 2))
_FRAME = RecordShape(
    "a frame",
    (
        Key("parent", Word(), "the frame it is moved and turned against, world if absent"),
        Key("translation", _VECTOR, "where its origin is, in the parent's axes; absent: 0"),
        Key(
            "rotation",
            Either(
                (
                    _TURNS,
                    RecordShape(
                        "`rotation`",
                        (
                            Key(
                                "quaternion",
                                Listing(ExpressionShape(), 4, 4),
                                "its four parts, scalar first",
                                required=True,
                            ),
                        ),
                    ),
                )
            ),
            "turns after the translation, each [axis, angle] about the axes reached so far; or {quaternion: [...]}",
        ),
        _DESCRIPTION,
    ),
)
_JOINT = RecordShape(
    "a joint",
    (
        Key("type", Word(tuple(JOINTS)), "what it lets move", required=True),
        Key("parent", Word(), "the frame it is attached to, world if absent"),
        Key("child", Word(), "the frame that moves; absent: named like the joint"),
        Key("at", _VECTOR, "its place in the parent's axes; absent: the origin"),
        Key("rotation", _TURNS, "fixed turns before the joint, each [axis, angle]"),
        Key("axis", _AXIS, "its axis after these turns, x, y, z or three components; absent: z"),
        Key("coordinate", Word(), "the name of its coordinate, declared by this if nowhere else"),
        Key("coordinates", Listing(Word(), 1), "the names of several: lengths first, then angle or quaternion"),
        _DESCRIPTION,
    ),
)
_LOOP = RecordShape(
    "a loop",
    (
        Key("type", Word(LOOPS), "a joint, two points that meet, or a rod of fixed length", required=True),
        Key("between", Listing(Word(), 2, 2), "the two points (point, distance) or frames that meet", required=True),
        Key("axis", _MAIN_AXIS, "the axis x, y or z of both frames, of the normal for planar; absent: z"),
        Key("length", ExpressionShape(), "of a distance loop: the distance of the points"),
    ),
)
_WHEEL = RecordShape(
    "a wheel",
    (
        Key("frame", Word(), "the frame that turns with it, its origin in the centre", required=True),
        Key("radius", ExpressionShape(), "its radius", required=True),
        Key("axle", _MAIN_AXIS, "the axis x, y or z of the frame it turns about; absent: y"),
        Key("plane", Word(("world",)), "what it rolls on: the plane z = 0 of the world"),
    ),
)
_SPRING = RecordShape(
    "a spring",
    (
        Key("between", Listing(Word(), 2, 2), "the two points it connects"),
        Key("joint", Word(), "or the coordinate it acts in"),
        Key("stiffness", ExpressionShape(), "force per length, or torque per angle"),
        Key("length", ExpressionShape(), "its length (or the coordinate) without force; absent: 0"),
        Key("damping", ExpressionShape(), "force per rate of its length"),
    ),
)
_FRICTION = RecordShape(
    "friction",
    (
        Key("viscous", ExpressionShape(), "force per rate"),
        Key("coulomb", ExpressionShape(), "dry friction: c*tanh(rate/width); of a joint or loop its coefficient"),
        Key("width", ExpressionShape(), "the rate at which dry friction has 76 % of its full size"),
        Key("radius", ExpressionShape(), "of the pin of a joint or loop: friction is coulomb*radius*reaction"),
        Key("reaction", Listing(Word(), 1), "rows of `constraints` whose multipliers are the force it carries"),
        Key("rate", ExpressionShape(), "the rate that friction of a `reaction` works on"),
        Key("load", ExpressionShape(), "a known force at right angles to the reaction, such as a weight"),
    ),
)
_FORCE = RecordShape(
    "a force",
    (
        *_ACTION,
        Key("magnitude", ExpressionShape(), "its size, of coordinates, rates, parameters, points", required=True),
        _DESCRIPTION,
    ),
)
_BODY = RecordShape(
    "a body",
    (
        Key("mass", ExpressionShape(), "its mass, of parameters; 0 for a body without mass", required=True),
        Key("com", _VECTOR, "centre of mass in the frame's axes; absent: the frame's origin"),
        Key(
            "inertia",
            RecordShape(
                "`inertia`",
                tuple(Key(name, ExpressionShape(), f"element {name} of the tensor") for name in INERTIA_ELEMENTS),
            ),
            "inertia tensor about the centre of mass in the frame's axes; missing elements are 0",
        ),
        Key("frame", Word(), "the frame it moves with; absent: the frame of its own name"),
        _DESCRIPTION,
    ),
)
_POINT = RecordShape(
    "a point",
    (
        Key("frame", Word(), "the frame whose axes `at` is given in, world if absent"),
        Key("at", _VECTOR, "its place; absent: the frame's origin"),
        Key("moves_with", Word(), "the frame whose material point it is, for velocities; absent: `frame`"),
        _DESCRIPTION,
    ),
)
_PICTURE = RecordShape(
    "`picture`",
    (
        Key("frames", TableShape(_FRAME), "axes that move with what is drawn, as under `frames`"),
        Key(
            "points",
            TableShape(RecordShape("a drawn point", tuple(key for key in _POINT.fields if key.key != "moves_with"))),
            "places by name: ends of links",
        ),
        Key(
            "wheels",
            TableShape(RecordShape("a drawn wheel", tuple(key for key in _WHEEL.fields if key.key != "plane"))),
            "discs about the origins of frames",
        ),
        Key("springs", TableShape(Listing(Word(), 2, 2)), "name: the two points or frames between which it is drawn"),
    ),
)
_PUBLISHED = EitherRecord(
    (
        (
            "singular_set",
            RecordShape(
                "a published singular set",
                (
                    _EQUATION,
                    Key(
                        "singular_set",
                        RecordShape(
                            "`singular_set`",
                            (
                                _QUANTITY,
                                _INDEPENDENT,
                                Key(
                                    "where_zero",
                                    ExpressionShape(),
                                    "expression that is zero on the printed set",
                                    required=True,
                                ),
                                Key("corrected", ExpressionShape(), "expression that is zero on the right set"),
                            ),
                        ),
                        "where a quantity does not exist, as printed",
                        required=True,
                    ),
                ),
            ),
        ),
        (
            "equations",
            RecordShape(
                "published equations",
                (
                    _EQUATION,
                    Key("equations", _BOTH_SIDES, "as printed", required=True),
                    Key("corrected", _BOTH_SIDES, "the right equations, where the print is wrong"),
                    _WHERE,
                ),
            ),
        ),
        (
            "value",
            RecordShape(
                "a published formula",
                (
                    _EQUATION,
                    _QUANTITY,
                    Key("value", _MATRIX, "rows of entries as printed; a flat list is a column", required=True),
                    Key("corrected", _MATRIX, "the right value, where the print is wrong"),
                    _WHERE,
                    _INDEPENDENT,
                ),
            ),
        ),
    )
)
_PATH = RecordShape(
    "a path",
    (
        _DESCRIPTION,
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
        Key("gravity", _VECTOR, "acceleration of gravity in world axes, such as [0, 0, -g]; absent: 0"),
        Key("frames", TableShape(_FRAME), "axes that move with the bodies: a tree that hangs on `world`"),
        Key("bodies", TableShape(_BODY), "rigid bodies by name; their energies are added to those written out"),
        Key("rotor_inertias", TableShape(ExpressionShape()), "coordinate: J of a geared rotor, adds J/2*rate**2 to T"),
        Key("joints", TableShape(_JOINT), "short form of frames: each brings its frame and its coordinates"),
        Key("loops", TableShape(_LOOP), "what closes kinematic loops: rows of geometric constraints"),
        Key("rolling", TableShape(_WHEEL), "wheels that roll without slip on the plane z = 0 of the world"),
        Key("springs", TableShape(_SPRING), "springs and dampers between points or in a coordinate"),
        Key(
            "friction",
            TableShape(_FRICTION),
            "coordinate: friction in it; joint or loop: friction that grows with its reaction",
        ),
        Key("forces", TableShape(_FORCE), "forces and torques on points and frames that depend on the state"),
        Key(
            "points", TableShape(_POINT), "places with components `.x`, `.y`, `.z`, `.vx`, `.vy`, `.vz` in expressions"
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
        Key("independent_velocities", _NAMES, "coordinates whose rates serve in F and the minimal form"),
        Key(
            "measured",
            Either((_NAMES, TableShape(ExpressionShape()))),
            "coordinates that encoders say, from which the others are found; with standard deviations to weigh them",
        ),
        Key(
            "identify",
            RecordShape(
                "`identify`",
                (
                    Key("geometry", _NAMES, "parameters of energies that are known from the geometry"),
                    Key("fixed", _NAMES, "parameters that keep their values"),
                ),
            ),
            "what `symgen identify` takes for known of energies; absent: parameters whose unit has no mass",
        ),
        Key("task", TableShape(ExpressionShape()), "what motions are planned in: functions of the configuration"),
        Key("derivatives", Word(("true", "false")), "whether `outputs: all` takes derivatives"),
        Key("configuration", TableShape(ExpressionShape()), "a start for Newton's method: the assembly mode"),
        Key("ranges", TableShape(_RANGE), "[lower, upper] of coordinates, rates, accelerations, parameters"),
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
        Key("published", Listing(_PUBLISHED), "formulas as printed somewhere, to be decided for this model"),
        Key("paths", TableShape(_PATH), "trajectories as functions of t, for charts and tests"),
        Key("picture", _PICTURE, "what drawings show beside frames and points; equations and code have nothing of it"),
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
