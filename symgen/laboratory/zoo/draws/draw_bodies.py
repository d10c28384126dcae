"""Mechanisms drawn as they are built: trees of joints in the plane and in space, loops closed where the tips stand."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.draws.describe import Description
from symgen.laboratory.zoo.draws.draw_closures import closed_at, planar_loop, spatial_loop, surplus
from symgen.laboratory.zoo.draws.draw_elements import elements, inputs
from symgen.laboratory.zoo.draws.draw_parts import MAIN_AXES, Style, carried_along, grown, norms, weighted
from symgen.laboratory.zoo.draws.endings import finish
from symgen.laboratory.zoo.draws.sketch import Sketch


def tree_bodies(dice: Dice) -> Description:
    """A tree of bodies, fixed to the ground or floating."""
    sketch = Sketch(dice, "tree_bodies")
    kinds = dice.choice(
        (("revolute",), ("revolute", "revolute", "prismatic"), ("revolute", "cylindrical", "prismatic", "spherical"))
    )
    style = Style(
        plane=dice.choice(("", "", "z", "y")), skew=dice.choice((0, 0.3, 0.8)), kinds=kinds,
        massless=dice.choice((0, 0, 0, 0.3)), sparse=dice.chance(0.5),
    )  # fmt: skip
    first = dice.weighted({"": 6, "floating": 1.5, "planar": 1})
    # a single mass without inertia that turns freely moves without effort
    style = replace(style, sparse=style.sparse and first != "floating" and "spherical" not in kinds)
    parts = grown(sketch, style, dice.choice((1, 2, 4, 6, 9, 12)), first)
    weighted(sketch, style, parts, set())
    elements(sketch, parts, style.plane)
    inputs(sketch, parts, sum(len(part.coordinates) for part in parts) - norms(parts))
    return finish(sketch)


def planar_bodies(dice: Dice) -> Description:
    """Links about parallel axes with one to four loops."""
    sketch = Sketch(dice, "planar_bodies")
    plane = dice.choice(MAIN_AXES)
    style = Style(
        plane=plane,
        kinds=("revolute",) * 5 + ("prismatic",),
        branching=0.3,
        sparse=True,
        massless=dice.choice((0, 0, 0.3)),
    )
    loops = dice.weighted({1: 5, 2: 3, 3: 1.5, 4: 1})
    parts = grown(sketch, style, min(12, dice.whole(2 * loops + 1, 2 * loops + 3)), "")
    rows = 0
    for index in range(loops):
        room = len(sketch.start) - rows - 1
        if room < 1:
            break
        rows += sketch.that_moves(partial(planar_loop, sketch, parts, index, room), oddly=0.15)
    weighted(sketch, style, parts, closed_at(sketch, parts))
    if rows and dice.chance(0.15):
        surplus(sketch)
    carriage = carried_along(sketch) if rows else None
    parts += [] if carriage is None else [carriage]
    elements(sketch, parts, plane)
    inputs(sketch, parts, len(sketch.start) - rows)
    return finish(sketch)


def spatial_bodies(dice: Dice) -> Description:
    """Chains in space with one to four loops of any joint."""
    sketch = Sketch(dice, "spatial_bodies")
    kinds = dice.choice(
        (("revolute",), ("revolute", "revolute", "prismatic", "spherical"), ("revolute", "cylindrical"))
    )
    style = Style(
        skew=dice.choice((0, 0.3, 0.8)), kinds=kinds, branching=0.3, sparse=dice.chance(0.6),
        massless=dice.choice((0, 0, 0.3)),
    )  # fmt: skip
    first = dice.weighted({"": 6, "floating": 1})
    parts = grown(sketch, style, dice.whole(4, 12), first)
    free = len(sketch.start) - norms(parts)
    for index in range(dice.weighted({1: 5, 2: 3, 3: 2, 4: 1.5})):
        free -= sketch.that_moves(partial(spatial_loop, sketch, parts, index, free), oddly=0.05)
    weighted(sketch, style, parts, closed_at(sketch, parts))
    elements(sketch, parts, "")
    inputs(sketch, parts, free)
    return finish(sketch)
