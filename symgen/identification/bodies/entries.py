"""A body as an entry of a model file: mass, centre of mass, inertia about it."""

from __future__ import annotations

import numpy as np

from symgen.identification.arrays import Array
from symgen.identification.bodies.pseudo_inertia import about_centre
from symgen.model.mechanism import INERTIA_ELEMENTS

# Digits of what is written: fewer would move estimates of which some are known to a millionth.
BODY_DIGITS = 9
# Of a length or moment of the body, what rounding leaves of one that is 0.
ROUNDED_ENTRY = 1e-9
_PLACES = dict(zip(INERTIA_ELEMENTS, ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)), strict=True))


def body_entry(ten: Array) -> dict[str, str]:
    """`mass`, `com` and `inertia` as they stand behind these keys, for the ten parameters of a body."""
    mass, centre, tensor = about_centre(ten)
    size = float(np.trace(tensor)) or 1.0
    # what a length is beside: how far from the origin, or how large
    length = float(np.sqrt(centre @ centre + size / (mass or 1.0)))
    moments = {name: _number(float(tensor[place]), size) for name, place in _PLACES.items()}
    shown = ", ".join(f"{name}: {text}" for name, text in moments.items() if text != "0")
    return {
        "mass": _number(mass, mass),
        "com": f"[{', '.join(_number(float(x), length) for x in centre)}]",
        "inertia": f"{{{shown}}}",
    }


def in_one_line(entry: dict[str, str]) -> str:
    """The entry in braces."""
    return f"{{{', '.join(f'{key}: {value}' for key, value in entry.items())}}}"


def _number(value: float, size: float) -> str:
    return "0" if abs(value) <= ROUNDED_ENTRY * abs(size) else f"{value:.{BODY_DIGITS}g}"
