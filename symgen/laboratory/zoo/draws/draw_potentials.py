"""Springs and stranger potentials, for energies and for bodies alike."""

from __future__ import annotations

from symgen.laboratory.zoo.draws.describe import MISTAKE
from symgen.laboratory.zoo.draws.sketch import Sketch


def potentials(sketch: Sketch, angles: list[str], ways: list[str], place: tuple[str, str]) -> list[str]:
    """A few terms of angles, ways along slides and a place in the plane; every function of the language but `abs`."""
    return [_term(sketch, angles, ways, place) for _ in range(sketch.dice.weighted({0: 4, 1: 4, 2: 3}))]


def _term(sketch: Sketch, angles: list[str], ways: list[str], place: tuple[str, str]) -> str:
    dice = sketch.dice
    k = sketch.parameter("k", dice.choice(("50", "0", "1e4", "1e-5", "3", "200")))
    x, y = place
    either = dice.choice([*angles, *ways])
    if ways and (not angles or dice.chance(0.2)):
        return _of_way(sketch, k, dice.choice(ways))
    angle = dice.choice(angles)
    terms = {
        f"{k}/2*({either} - 0.3)**2": 1, f"{k}*sqrt(({x} - 3)**2 + ({y} - 4)**2)": 2, f"{k}*exp(-{angle}**2)": 1,
        f"{k}*exp({angle}/2)": 1, f"{k}*atan2({y} - 5, {x} + 6)**2": 2, f"{k}*tanh({angle})": 2,
        f"{k}*log(1 + {angle}**2)": 1.5, f"{k}*sin({angle})**2": 1, f"{k}*cosh({angle}/2)": 1.5,
        f"{k}*sinh({angle}/3)**2": 1.5, f"{k}*atan({angle})**2": 0.7, f"{k}*asin(sin({angle})/2)**2": 0.7,
        f"{k}*acos(cos({angle})/3)": 1.2, f"{k}*tan({angle}/8)**2": 0.7,
    }  # fmt: skip
    return dice.weighted(terms)


def _of_way(sketch: Sketch, k: str, way: str) -> str:
    """A potential of a way; the exponential of a length is a mistake, of a ratio of lengths it is none."""
    dice = sketch.dice
    entry = (sketch.blocks.get("coordinates") or {}).get(way) or {}
    if entry.get("unit") == "m" and dice.chance(0.15):
        sketch.mark(MISTAKE)
        return f"{k}*exp(-{way})"
    sketch.mark("exp of a length")
    return f"{k}*exp(-{way}/{sketch.parameter('l_0', '0.4')})"
