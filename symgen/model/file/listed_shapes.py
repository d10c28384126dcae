"""Lists of numbers and of names as the model file has them: ranges, vectors, axes, matrices."""

from __future__ import annotations

from symgen.model.file.shape import Either, ExpressionShape, Listing, Word
from symgen.model.mechanism import AXES

RANGE = Listing(ExpressionShape(), 2, 2)
VECTOR = Listing(ExpressionShape(), 3, 3)
MATRIX = Listing(Either((ExpressionShape(), Listing(ExpressionShape(), 1))), 1)
AXIS = Either((Word(), VECTOR))
MAIN_AXIS = Word(AXES)
NAMES = Listing(Word())
