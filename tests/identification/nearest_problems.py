"""Estimates that no bodies have, of machines in the plane and in space, as problems of nearest bodies."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import numpy as np
import pytest
from identified_machines import FOUR_BAR_WITH_NAMES, WHEEL
from machines import rusr_linkage

from symgen.identification.bodies.nearest_bodies import NearestBodies
from symgen.identification.combinations import BodyCombinations, base_map, inertial_values
from symgen.identification.estimates import whole_bodies
from symgen.identification.estimates.least_squares import LinearEstimate
from symgen.identification.estimates.linear_terms import EstimatedNames
from symgen.identification.estimates.whole_bodies import WholeBodies
from symgen.model.combinations.base_parameters import BaseParameters, base_parameters
from symgen.model.configurations.mechanics import default_values
from symgen.model.load import load_text

# A flywheel with a rotor, friction beside it: what is free, what has a sign and bodies in one machine.
GEARED = WHEEL.replace("inputs:", "rotor_inertias: {a: 0.02}\ninputs:")
TEXTS = {
    "wheel": WHEEL,
    "geared": GEARED,
    "four_bar": FOUR_BAR_WITH_NAMES,
    "linkage": rusr_linkage("[1, -5, -9.81]"),
}
# Standard errors of estimates, as shares of their sizes.
KNOWN_TO = 1e-3


@cache
def base_of_text(name: str) -> BaseParameters:
    return base_parameters(load_text(TEXTS[name], "machine.yaml"))


def estimate_of(name: str, changes: Mapping[str, float]) -> LinearEstimate:
    """Base parameters of the file but for some, all known alike."""
    base = base_of_text(name)
    numbers = default_values(base.model.parameters)
    target = base_map(base) @ inertial_values(base.model, numbers)
    for parameter, value in changes.items():
        target[[one.stays.name for one in base.base].index(parameter)] += value
    count = len(target)
    root = np.diag(KNOWN_TO * (np.abs(target) + 0.01))
    return LinearEstimate(target, root, (), np.empty((count, 0)), np.ones(1), 1.0, np.zeros(count), 0.0)


def whole_of(name: str, changes: Mapping[str, float]) -> WholeBodies:
    base = base_of_text(name)
    names = EstimatedNames((), (), ())
    numbers = default_values(base.model.parameters)
    return whole_bodies.whole_bodies(base.model, BodyCombinations(base), names, numbers, estimate_of(name, changes))


def drawn_changes(name: str, seed: int) -> dict[str, float]:
    """Changes of estimates of a tenth of their sizes and more, which few bodies have."""
    generator = np.random.default_rng(seed)
    base = base_of_text(name).base
    return {one.stays.name: 0.1 * (abs(one.value) + 0.1) * generator.standard_normal() for one in base}


def impossible_changes() -> dict[str, tuple[str, Mapping[str, float]]]:
    """Estimates that no bodies have: texts and changes."""
    drawn = [("four_bar", 2), ("four_bar", 3), ("linkage", 0), ("linkage", 2), ("linkage", 3)]
    changes = {f"{name}_{seed}": (name, drawn_changes(name, seed)) for name, seed in drawn}
    return {"wheel": ("wheel", {"hub.Izz": -0.72}), "geared": ("geared", {"a.Ir": -0.9}), **changes}


IMPOSSIBLE = impossible_changes()


def problem_of(name: str, changes: Mapping[str, float]) -> NearestBodies:
    """What is solved for these."""
    kept: list[NearestBodies] = []
    with pytest.MonkeyPatch.context() as patch:
        plain = whole_bodies._solved

        def looked_at(problem: NearestBodies) -> tuple[object, str]:
            kept.append(problem)
            return plain(problem)

        patch.setattr(whole_bodies, "_solved", looked_at)
        whole_of(name, changes)
    return kept[0]
