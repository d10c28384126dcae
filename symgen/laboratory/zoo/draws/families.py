"""The families of drawn systems and how often each is drawn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.draws.describe import Description
from symgen.laboratory.zoo.draws.draw_absolute import absolute_coordinates, gyroscope, points_and_rods
from symgen.laboratory.zoo.draws.draw_bodies import planar_bodies, spatial_bodies, tree_bodies
from symgen.laboratory.zoo.draws.draw_energy import planar_energies
from symgen.laboratory.zoo.draws.draw_linkages import (
    bennett,
    bricard,
    common_pin,
    double_four_bar,
    legged_platform,
    parallelogram_bodies,
    parallelogram_energies,
    sarrus,
)
from symgen.laboratory.zoo.draws.draw_mobile import cable_robot, car_with_trailers, disc, geared, wheeled_bodies
from symgen.laboratory.zoo.draws.draw_robots import robot_files

FAMILIES: dict[str, tuple[float, Callable[[Dice], Description]]] = {
    "planar_energies": (6, planar_energies),
    "tree_bodies": (4, tree_bodies),
    "planar_bodies": (4, planar_bodies),
    "spatial_bodies": (4, spatial_bodies),
    "parallelogram_energies": (1.3, parallelogram_energies),
    "parallelogram_bodies": (1, parallelogram_bodies),
    "common_pin": (0.8, common_pin),
    "double_four_bar": (1, double_four_bar),
    "bennett": (0.8, bennett),
    "bricard": (0.8, bricard),
    "sarrus": (0.8, sarrus),
    "legged_platform": (1, legged_platform),
    "car_with_trailers": (1.5, car_with_trailers),
    "wheeled_bodies": (1, wheeled_bodies),
    "disc": (0.5, disc),
    "cable_robot": (1, cable_robot),
    "geared": (1, geared),
    "absolute_coordinates": (1.5, absolute_coordinates),
    "points_and_rods": (1.5, points_and_rods),
    "gyroscope": (0.7, gyroscope),
    "robot_files": (1.5, robot_files),
}
# scalar types that are asked for alone, and how often
ALONE = {"": 8.0, "float64": 1.0, "float32": 1.0}


def draw(seed: int, index: int, family: str = "") -> Description:
    """The draw with this number of a campaign; the same on every machine."""
    choice = Dice("family", seed, index)
    name = family or choice.weighted({name: weight for name, (weight, _) in FAMILIES.items()})
    description = FAMILIES[name][1](Dice("zoo", name, seed, index))
    alone = Dice("scalar", seed, index).weighted(ALONE)
    return replace(description, options=("--scalar", alone)) if alone else description
