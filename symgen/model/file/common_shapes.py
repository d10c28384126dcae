"""Shapes that several blocks of the model file share: vectors, ranges, axes, what an input acts on."""

from __future__ import annotations

from symgen.model.file.shape import Either, ExpressionShape, Key, Listing, Text, Word
from symgen.model.mechanism import AXES

RANGE = Listing(ExpressionShape(), 2, 2)
VECTOR = Listing(ExpressionShape(), 3, 3)
AXIS = Either((Word(), VECTOR))
MAIN_AXIS = Word(AXES)
UNIT = Key("unit", Text(), "SI unit such as m, kg*m**2, N*m, rad; a declaration, nothing is converted")
DESCRIPTION = Key("description", Text(), "what it is, in a few words; stands in headers and reports")
MATRIX = Listing(Either((ExpressionShape(), Listing(ExpressionShape(), 1))), 1)
NAMES = Listing(Word())
ACTION = (
    Key("point", Word(), "a point (or frame, for its origin) where a force acts, along `direction`"),
    Key("torque_on", Word(), "a frame on which a torque acts, about `direction`"),
    Key("direction", VECTOR, "unit vector of the force or torque"),
    Key("axes", Word(), "the frame whose axes the direction is given in, world if absent"),
    Key("reaction", Word(), "the point or frame on which the opposite force or torque acts"),
    Key("cable", Listing(Word(), 2), "points that a cable runs through; the force is its tension"),
)
