"""The model file: which blocks there are, what each holds and what it is for."""

from __future__ import annotations

from symgen.model.blocks.joint_forms import JOINTS
from symgen.model.blocks.loops import LOOPS
from symgen.model.file.shape import (
    Either,
    Field,
    Formula,
    JsonSchema,
    Listing,
    Record,
    Table,
    Text,
    Variants,
    Word,
    json_schema_of,
)
from symgen.model.mechanism import AXES, INERTIA_ELEMENTS
from symgen.model.quantities import QUANTITIES

_RANGE = Listing(Formula(), 2, 2)
_VECTOR = Listing(Formula(), 3, 3)
_AXIS = Either((Word(), _VECTOR))
_MAIN_AXIS = Word(AXES)
_UNIT = Field("unit", Text(), "SI unit such as m, kg*m**2, N*m, rad; a declaration, nothing is converted")
_DESCRIPTION = Field("description", Text(), "what it is, in a few words; stands in headers and reports")
_MATRIX = Listing(Either((Formula(), Listing(Formula(), 1))), 1)
_NAMES = Listing(Word())
_OUTPUT = Word(("all", *(quantity.name for quantity in QUANTITIES)))
_EQUATION = Field("equation", Text(), 'its number where it was printed, such as "(44)"', required=True)
_QUANTITY = Field("quantity", Word(), "name of a quantity, as in `outputs`", required=True)
_INDEPENDENT = Field("independent", _NAMES, "the independent velocities the formula is for")
_WHERE = Field("where", Table(Formula()), "symbols of this formula only")
_BOTH_SIDES = Listing(
    Record(
        "an equation",
        (
            Field("left", Formula(), "left-hand side", required=True),
            Field("right", Formula(), "right-hand side", required=True),
        ),
    ),
    1,
)

_COORDINATE = Record(
    "a coordinate", (_UNIT, _DESCRIPTION, Field("range", _RANGE, "[lower, upper], where states are sampled"))
)
_PARAMETER = Record(
    "a parameter",
    (
        Field("value", Formula(), "default: a number or an expression of earlier parameters", required=True),
        _UNIT,
        _DESCRIPTION,
        Field("range", _RANGE, "[lower, upper] of sensible values"),
    ),
)
_ACTION = (
    Field("point", Word(), "a point (or frame, for its origin) where a force acts, along `direction`"),
    Field("torque_on", Word(), "a frame on which a torque acts, about `direction`"),
    Field("direction", _VECTOR, "unit vector of the force or torque"),
    Field("axes", Word(), "the frame whose axes the direction is given in, world if absent"),
    Field("reaction", Word(), "the point or frame on which the opposite force or torque acts"),
    Field("cable", Listing(Word(), 2), "points that a cable runs through; the force is its tension"),
)
_INPUT = Record(
    "an input",
    (
        _UNIT,
        _DESCRIPTION,
        Field("acts_on", Table(Formula(), 1), "coordinate: coefficient of the input in its equation"),
        Field("joint", Word(), "a coordinate: short for acts_on: {it: 1}"),
        *_ACTION,
    ),
)
_TURNS = Listing(Listing(Either((Formula(), _VECTOR)), 2, 2))
_FRAME = Record(
    "a frame",
    (
        Field("parent", Word(), "the frame it is moved and turned against, world if absent"),
        Field("translation", _VECTOR, "where its origin is, in the parent's axes; absent: 0"),
        Field(
            "rotation",
            Either(
                (
                    _TURNS,
                    Record(
                        "`rotation`",
                        (Field("quaternion", Listing(Formula(), 4, 4), "its four parts, scalar first", required=True),),
                    ),
                )
            ),
            "turns after the translation, each [axis, angle] about the axes reached so far; or {quaternion: [...]}",
        ),
        _DESCRIPTION,
    ),
)
_JOINT = Record(
    "a joint",
    (
        Field("type", Word(tuple(JOINTS)), "what it lets move", required=True),
        Field("parent", Word(), "the frame it is attached to, world if absent"),
        Field("child", Word(), "the frame that moves; absent: named like the joint"),
        Field("at", _VECTOR, "its place in the parent's axes; absent: the origin"),
        Field("rotation", _TURNS, "fixed turns before the joint, each [axis, angle]"),
        Field("axis", _AXIS, "its axis after these turns, x, y, z or three components; absent: z"),
        Field("coordinate", Word(), "the name of its coordinate, declared by this if nowhere else"),
        Field("coordinates", Listing(Word(), 1), "the names of several: lengths first, then angle or quaternion"),
        _DESCRIPTION,
    ),
)
_LOOP = Record(
    "a loop",
    (
        Field("type", Word(LOOPS), "a joint, two points that meet, or a rod of fixed length", required=True),
        Field("between", Listing(Word(), 2, 2), "the two points (point, distance) or frames that meet", required=True),
        Field("axis", _MAIN_AXIS, "the axis x, y or z of both frames, of the normal for planar; absent: z"),
        Field("length", Formula(), "of a distance loop: the distance of the points"),
    ),
)
_WHEEL = Record(
    "a wheel",
    (
        Field("frame", Word(), "the frame that turns with it, its origin in the centre", required=True),
        Field("radius", Formula(), "its radius", required=True),
        Field("axle", _MAIN_AXIS, "the axis x, y or z of the frame it turns about; absent: y"),
        Field("plane", Word(("world",)), "what it rolls on: the plane z = 0 of the world"),
    ),
)
_SPRING = Record(
    "a spring",
    (
        Field("between", Listing(Word(), 2, 2), "the two points it connects"),
        Field("joint", Word(), "or the coordinate it acts in"),
        Field("stiffness", Formula(), "force per length, or torque per angle"),
        Field("length", Formula(), "its length (or the coordinate) without force; absent: 0"),
        Field("damping", Formula(), "force per rate of its length"),
    ),
)
_FRICTION = Record(
    "friction",
    (
        Field("viscous", Formula(), "force per rate"),
        Field("coulomb", Formula(), "dry friction: c*tanh(rate/width)"),
        Field("width", Formula(), "the rate at which dry friction has 76 % of its full size"),
    ),
)
_FORCE = Record(
    "a force",
    (
        *_ACTION,
        Field("magnitude", Formula(), "its size, of coordinates, rates, parameters, points", required=True),
        _DESCRIPTION,
    ),
)
_BODY = Record(
    "a body",
    (
        Field("mass", Formula(), "its mass, of parameters; 0 for a body without mass", required=True),
        Field("com", _VECTOR, "centre of mass in the frame's axes; absent: the frame's origin"),
        Field(
            "inertia",
            Record(
                "`inertia`",
                tuple(Field(name, Formula(), f"element {name} of the tensor") for name in INERTIA_ELEMENTS),
            ),
            "inertia tensor about the centre of mass in the frame's axes; missing elements are 0",
        ),
        Field("frame", Word(), "the frame it moves with; absent: the frame of its own name"),
        _DESCRIPTION,
    ),
)
_POINT = Record(
    "a point",
    (
        Field("frame", Word(), "the frame whose axes `at` is given in, world if absent"),
        Field("at", _VECTOR, "its place; absent: the frame's origin"),
        Field("moves_with", Word(), "the frame whose material point it is, for velocities; absent: `frame`"),
        _DESCRIPTION,
    ),
)
_PUBLISHED = Variants(
    (
        (
            "singular_set",
            Record(
                "a published singular set",
                (
                    _EQUATION,
                    Field(
                        "singular_set",
                        Record(
                            "`singular_set`",
                            (
                                _QUANTITY,
                                _INDEPENDENT,
                                Field(
                                    "where_zero", Formula(), "expression that is zero on the printed set", required=True
                                ),
                                Field("corrected", Formula(), "expression that is zero on the right set"),
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
            Record(
                "published equations",
                (
                    _EQUATION,
                    Field("equations", _BOTH_SIDES, "as printed", required=True),
                    Field("corrected", _BOTH_SIDES, "the right equations, where the print is wrong"),
                    _WHERE,
                ),
            ),
        ),
        (
            "value",
            Record(
                "a published formula",
                (
                    _EQUATION,
                    _QUANTITY,
                    Field("value", _MATRIX, "rows of entries as printed; a flat list is a column", required=True),
                    Field("corrected", _MATRIX, "the right value, where the print is wrong"),
                    _WHERE,
                    _INDEPENDENT,
                ),
            ),
        ),
    )
)
_PATH = Record(
    "a path",
    (
        _DESCRIPTION,
        Field("duration", Formula(), "length in seconds; t runs from 0 to it", required=True),
        Field("samples", Formula(), "number of points in charts and tests, 201 if absent"),
        Field("definitions", Table(Formula()), "named expressions of t and parameters"),
        Field("conditions", Table(Formula(), 1), "expressions of q, t, parameters, = 0", required=True),
        Field("start", Table(Formula()), "where Newton's method begins at t = 0"),
    ),
)
_ALLOCATION = Record(
    "`allocation`",
    (
        Field("weights", Table(Formula(), 1), "input: positive weight of its square in the norm; absent: 1"),
        Field(
            "preload",
            Either((Formula(), Table(Formula(), 1))),
            "internal force along the one direction of m - δ = 1, or input: preferred value",
        ),
        Field("limits", Table(Listing(Formula(), 2, 2), 1), "input: [lower, upper]; needs m - δ = 1"),
    ),
)

_URDF = Record(
    "`urdf`",
    (
        Field("file", Text(), "its path, below the folder of this file", required=True),
        Field("coordinates", Table(Text()), "name of the coordinate: name of the joint, where they differ"),
        Field("frames", Table(Text()), "name of the frame: name of the link, where they differ"),
        Field("leave_out", Listing(Word()), "elements and attributes that symgen does not know, and may leave out"),
        Field("friction_width", Formula(), "the rate at which dry friction of the joints has 76 % of its full size"),
    ),
)

MODEL = Record(
    "the model",
    (
        Field("model", Word(), "its name, a C identifier; becomes file name and function prefix", required=True),
        Field("description", Text(), "what the system is, in a sentence"),
        Field("source", Text(), "where it is taken from"),
        Field(
            "coordinates",
            Table(_COORDINATE, 1, entries_may_be_empty=True),
            "the generalized coordinates, in the order of q; the rate of x is x_dot",
        ),
        Field("parameters", Table(Either((Formula(), _PARAMETER))), "run-time parameters of the kernels"),
        Field("definitions", Table(Formula()), "named sub-expressions, in order of use"),
        Field("kinetic_energy", Formula(), "T, quadratic in the rates; that of `bodies` is added"),
        Field("potential_energy", Formula(), "U of coordinates and parameters; absent: 0"),
        Field(
            "constraints",
            Record(
                "`constraints`",
                (
                    Field("geometric", Table(Formula()), "g(q) = 0, one row each"),
                    Field("nonholonomic", Table(Formula()), "linear in the rates, = 0, one row each"),
                ),
            ),
            "constraint rows by name",
        ),
        Field(
            "urdf",
            Either((Text(), _URDF)),
            "a robot description beside this file: its links become frames, its joints coordinates",
        ),
        Field("gravity", _VECTOR, "acceleration of gravity in world axes, such as [0, 0, -g]; absent: 0"),
        Field("frames", Table(_FRAME), "axes that move with the bodies: a tree that hangs on `world`"),
        Field("bodies", Table(_BODY), "rigid bodies by name; their energies are added to those written out"),
        Field("rotor_inertias", Table(Formula()), "coordinate: J of a geared rotor, adds J/2*rate**2 to T"),
        Field("joints", Table(_JOINT), "short form of frames: each brings its frame and its coordinates"),
        Field("loops", Table(_LOOP), "what closes kinematic loops: rows of geometric constraints"),
        Field("rolling", Table(_WHEEL), "wheels that roll without slip on the plane z = 0 of the world"),
        Field("springs", Table(_SPRING), "springs and dampers between points or in a coordinate"),
        Field("friction", Table(_FRICTION), "coordinate: friction in it"),
        Field("forces", Table(_FORCE), "forces and torques on points and frames that depend on the state"),
        Field("points", Table(_POINT), "places with components `.x`, `.y`, `.z`, `.vx`, `.vy`, `.vz` in expressions"),
        Field("inputs", Table(_INPUT), "control forces: the columns of the control matrix"),
        Field("allocation", _ALLOCATION, "how redundant inputs share the work: members of the parameter struct"),
        Field("applied_forces", Table(Formula()), "coordinate: further generalized force of q, rates, parameters"),
        Field(
            "outputs",
            Either((_OUTPUT, Listing(_OUTPUT))),
            "quantities to generate, or all",
        ),
        Field("independent_velocities", _NAMES, "coordinates whose rates serve in F and the minimal form"),
        Field("configuration", Table(Formula()), "a start for Newton's method: the assembly mode"),
        Field("ranges", Table(_RANGE), "[lower, upper] of coordinates, rates, accelerations, parameters"),
        Field(
            "tolerances",
            Record(
                "`tolerances`",
                (
                    Field("constraint_rank", Formula(), "relative threshold of status 2"),
                    Field("actuation_rank", Formula(), "relative threshold of status 3"),
                ),
            ),
            "thresholds on denominators",
        ),
        Field("trig_range", Word(("normal", "wide")), "how far angles may go before status 4"),
        Field("published", Listing(_PUBLISHED), "formulas as printed somewhere, to be decided for this model"),
        Field("paths", Table(_PATH), "trajectories as functions of t, for charts and tests"),
        Field("report", Word(("full", "short")), "length of the report"),
    ),
)


def json_schema() -> JsonSchema:
    """The JSON Schema of a model file, for editors."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "symgen model",
        **json_schema_of(MODEL),
    }
