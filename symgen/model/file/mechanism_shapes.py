"""Shapes of a mechanism in the model file: frames, joints, loops, wheels, force elements, bodies, points, pictures."""

from __future__ import annotations

from symgen.model.blocks.joint_forms import JOINTS
from symgen.model.blocks.loops import LOOPS
from symgen.model.file.listed_shapes import AXIS, MAIN_AXIS, VECTOR
from symgen.model.file.shape import Either, ExpressionShape, Key, Listing, RecordShape, TableShape, Text, Word
from symgen.model.mechanism import INERTIA_ELEMENTS

DESCRIPTION = Key("description", Text(), "what it is, in a few words; stands in headers and reports")
# Where a force or a torque acts, of force elements and of inputs.
ACTION = (
    Key("point", Word(), "a point (or frame, for its origin) where a force acts, along `direction`"),
    Key("torque_on", Word(), "a frame on which a torque acts, about `direction`"),
    Key("direction", VECTOR, "unit vector of the force or torque"),
    Key("axes", Word(), "the frame whose axes the direction is given in, world if absent"),
    Key("reaction", Word(), "the point or frame on which the opposite force or torque acts"),
    Key("cable", Listing(Word(), 2), "points that a cable runs through; the force is its tension"),
)
TURNS = Listing(Listing(Either((ExpressionShape(), VECTOR)), 2, 2))
FRAME = RecordShape(
    "a frame",
    (
        Key("parent", Word(), "the frame it is moved and turned against, world if absent"),
        Key("translation", VECTOR, "where its origin is, in the parent's axes; absent: 0"),
        Key(
            "rotation",
            Either(
                (
                    TURNS,
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
        DESCRIPTION,
    ),
)
JOINT = RecordShape(
    "a joint",
    (
        Key("type", Word(tuple(JOINTS)), "what it lets move", required=True),
        Key("parent", Word(), "the frame it is attached to, world if absent"),
        Key("child", Word(), "the frame that moves; absent: named like the joint"),
        Key("at", VECTOR, "its place in the parent's axes; absent: the origin"),
        Key("rotation", TURNS, "fixed turns before the joint, each [axis, angle]"),
        Key("axis", AXIS, "its axis after these turns, x, y, z or three components; absent: z"),
        Key("coordinate", Word(), "the name of its coordinate, declared by this if nowhere else"),
        Key("coordinates", Listing(Word(), 1), "the names of several: lengths first, then angle or quaternion"),
        DESCRIPTION,
    ),
)
LOOP = RecordShape(
    "a loop",
    (
        Key("type", Word(LOOPS), "a joint, two points that meet, or a rod of fixed length", required=True),
        Key("between", Listing(Word(), 2, 2), "the two points (point, distance) or frames that meet", required=True),
        Key("axis", MAIN_AXIS, "the axis x, y or z of both frames, of the normal for planar; absent: z"),
        Key("length", ExpressionShape(), "of a distance loop: the distance of the points"),
    ),
)
WHEEL = RecordShape(
    "a wheel",
    (
        Key("frame", Word(), "the frame that turns with it, its origin in the centre", required=True),
        Key("radius", ExpressionShape(), "its radius", required=True),
        Key("axle", MAIN_AXIS, "the axis x, y or z of the frame it turns about; absent: y"),
        Key("plane", Word(("world",)), "what it rolls on: the plane z = 0 of the world"),
    ),
)
SPRING = RecordShape(
    "a spring",
    (
        Key("between", Listing(Word(), 2, 2), "the two points it connects"),
        Key("joint", Word(), "or the coordinate it acts in"),
        Key("stiffness", ExpressionShape(), "force per length, or torque per angle"),
        Key("length", ExpressionShape(), "its length (or the coordinate) without force; absent: 0"),
        Key("damping", ExpressionShape(), "force per rate of its length"),
    ),
)
FRICTION = RecordShape(
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
FORCE = RecordShape(
    "a force",
    (
        *ACTION,
        Key("magnitude", ExpressionShape(), "its size, of coordinates, rates, parameters, points", required=True),
        DESCRIPTION,
    ),
)
BODY = RecordShape(
    "a body",
    (
        Key("mass", ExpressionShape(), "its mass, of parameters; 0 for a body without mass", required=True),
        Key("com", VECTOR, "centre of mass in the frame's axes; absent: the frame's origin"),
        Key(
            "inertia",
            RecordShape(
                "`inertia`",
                tuple(Key(name, ExpressionShape(), f"element {name} of the tensor") for name in INERTIA_ELEMENTS),
            ),
            "inertia tensor about the centre of mass in the frame's axes; missing elements are 0",
        ),
        Key("frame", Word(), "the frame it moves with; absent: the frame of its own name"),
        DESCRIPTION,
    ),
)
POINT = RecordShape(
    "a point",
    (
        Key("frame", Word(), "the frame whose axes `at` is given in, world if absent"),
        Key("at", VECTOR, "its place; absent: the frame's origin"),
        Key("moves_with", Word(), "the frame whose material point it is, for velocities; absent: `frame`"),
        DESCRIPTION,
    ),
)
PICTURE = RecordShape(
    "`picture`",
    (
        Key("frames", TableShape(FRAME), "axes that move with what is drawn, as under `frames`"),
        Key(
            "points",
            TableShape(RecordShape("a drawn point", tuple(key for key in POINT.fields if key.key != "moves_with"))),
            "places by name: ends of links",
        ),
        Key(
            "wheels",
            TableShape(RecordShape("a drawn wheel", tuple(key for key in WHEEL.fields if key.key != "plane"))),
            "discs about the origins of frames",
        ),
        Key("springs", TableShape(Listing(Word(), 2, 2)), "name: the two points or frames between which it is drawn"),
    ),
)
