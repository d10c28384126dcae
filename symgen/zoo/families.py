"""The families of drawn systems and how often each is drawn."""

from __future__ import annotations

from collections.abc import Callable

from symgen.zoo.describe import Description
from symgen.zoo.dice import Dice
from symgen.zoo.draw_bodies import planar_bodies, spatial_bodies, tree_bodies
from symgen.zoo.draw_energy import planar_energies

FAMILIES: dict[str, tuple[float, Callable[[Dice], Description]]] = {
    "planar_energies": (3, planar_energies),
    "tree_bodies": (2, tree_bodies),
    "planar_bodies": (2, planar_bodies),
    "spatial_bodies": (2, spatial_bodies),
}


def draw(seed: int, index: int, family: str = "") -> Description:
    """The draw with this number of a campaign; the same on every machine."""
    choice = Dice("family", seed, index)
    name = family or choice.weighted({name: weight for name, (weight, _) in FAMILIES.items()})
    return FAMILIES[name][1](Dice("zoo", name, seed, index))
