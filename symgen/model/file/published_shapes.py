"""Shapes of formulas as they were printed somewhere: matrices, equations, singular sets."""

from __future__ import annotations

from symgen.model.file.listed_shapes import MATRIX, NAMES
from symgen.model.file.shape import EitherRecord, ExpressionShape, Key, Listing, RecordShape, TableShape, Text, Word

_EQUATION = Key("equation", Text(), 'its number where it was printed, such as "(44)"', required=True)
_QUANTITY = Key("quantity", Word(), "name of a quantity, as in `outputs`", required=True)
_INDEPENDENT = Key("independent", NAMES, "the independent velocities the formula is for")
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

PUBLISHED = EitherRecord(
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
                    Key("value", MATRIX, "rows of entries as printed; a flat list is a column", required=True),
                    Key("corrected", MATRIX, "the right value, where the print is wrong"),
                    _WHERE,
                    _INDEPENDENT,
                ),
            ),
        ),
    )
)
