"""What C calls a scalar type, and how names say which one they are made for."""

from __future__ import annotations

from typing import Final

from symgen.ir.kernel import Scalar

C_TYPE: Final[dict[Scalar, str]] = {"float64": "double", "float32": "float"}
SUFFIX: Final[dict[Scalar, str]] = {"float64": "", "float32": "_f"}
"""The end of the names of files, types and functions."""


def file_stem(model: str, scalar: Scalar, ending: str = "") -> str:
    """What the files of a variant are called before the dot; `model` is what files of the model begin with."""
    return f"{model}{ending}{SUFFIX[scalar]}"
