"""A refusal must be true, and a mistake must be told."""

from __future__ import annotations

import numpy as np
import pytest

from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.draws.describe import MISTAKE, Description
from symgen.laboratory.zoo.draws.drawn import DrawnEquations
from symgen.laboratory.zoo.refusals import judged
from symgen.laboratory.zoo.verdict import NOTICED, REFUSED, VERIFIED, DrawVerdict
from symgen.laboratory.zoo.witness.kkt import EquationEvaluator
from symgen.laboratory.zoo.witness.numbers.tape import NodeProgram
from symgen.laboratory.zoo.witness.reading.mechanics import equations
from symgen.laboratory.zoo.witness.states import Walker

FREE = {
    "model": "zoo",
    "coordinates": {"x": {}, "y": {}},
    "kinetic_energy": "x_dot**2 + y_dot**2",
    "constraints": {"geometric": {"line": "x - y"}},
}
MASSLESS = {**FREE, "kinetic_energy": "x_dot**2", "constraints": {"geometric": {"line": "x - 0.3"}}}
RIGID = {**FREE, "constraints": {"geometric": {"one": "x - y", "two": "x + y - 0.4"}}}
# a chain of two rods that is just as long as its ends are apart
STRETCHED = {
    **FREE,
    "coordinates": {"x": {}, "y": {}, "z": {}},
    "kinetic_energy": "x_dot**2 + y_dot**2 + z_dot**2",
    "constraints": {"geometric": {"one": "x**2 + y**2 - 1", "two": "(x - 2)**2 + y**2 - 1"}},
}
# an arm whose tip is held as far from its foot as it reaches, and a coordinate beside it
STRETCHED_ARM = {
    **FREE,
    "coordinates": {"a": {}, "b": {}, "z": {}},
    "kinetic_energy": "a_dot**2 + b_dot**2 + z_dot**2",
    "constraints": {"geometric": {"east": "0.5*cos(a) + 0.9*cos(b) - 1.4", "north": "0.5*sin(a) + 0.9*sin(b)"}},
}
ARM_STRETCHED = {"a": 0.0, "b": 0.0, "z": 0.1}
# a point mass on a ball joint whose place two rods hold: it turns about the line to itself, which rounding moves
TOP = {
    "model": "zoo",
    "parameters": {"l": {"value": "0.41"}},
    "joints": {"ball": {"type": "spherical", "coordinates": ["e", "f", "g", "h"]}},
    "bodies": {"ball": {"mass": "6.7", "com": ["0", "l/2", "0"]}},
    "points": {
        "tip": {"frame": "ball", "at": ["0", "l", "0"]},
        "one": {"at": ["0.166579892536308", "0.43273769590730166", "0.8307148228240236"]},
        "two": {"at": ["0.04989510521339002", "0.41158643192067995", "0.32925239575096976"]},
    },
    "loops": {
        "rod_1": {"type": "distance", "between": ["tip", "one"], "length": "0.5655993346961516"},
        "rod_2": {"type": "distance", "between": ["tip", "two"], "length": "0.3077536707645474"},
    },
}
TURNED = {"e": 0.8, "f": 0.6, "g": 0.0, "h": 0.0}
# two branches that cross where the file starts, and are smooth elsewhere
CROSSING = {**FREE, "constraints": {"geometric": {"both": "x**2 - y**2"}}}
HELD = {"x": 0.2, "y": 0.2}
AT_ONE = {"x": 1.0, "y": 0.0, "z": 0.1}
UNDETERMINED = "the accelerations are undetermined: no mass moves where `.` does"
IMMOBILE = "the mechanism cannot move: # coordinates under # independent constraints"
SINGULAR = "only singular configurations were found, such as x = #"


@pytest.mark.parametrize(
    ("blocks", "start", "signature", "is_true"),
    [
        (MASSLESS, {"x": 0.3, "y": 0.2}, UNDETERMINED, True),
        (FREE, HELD, UNDETERMINED, False),
        (TOP, TURNED, UNDETERMINED, True),
        (RIGID, HELD, IMMOBILE, True),
        (FREE, HELD, IMMOBILE, False),
        (STRETCHED, AT_ONE, SINGULAR, True),
        (FREE, HELD, SINGULAR, False),
        (CROSSING, {"x": 0.0, "y": 0.0}, SINGULAR, False),
        ({**FREE, "constraints": {"geometric": {"twice": "(x - y)**2"}}}, HELD, SINGULAR, True),
        (FREE, HELD, "`.` is reserved: a keyword of C", False),
    ],
)
def test_a_refusal_is_looked_at(blocks: dict, start: dict, signature: str, is_true: bool) -> None:
    verdict = judged(Description("", blocks, start), DrawVerdict(REFUSED, signature=signature))
    assert (verdict.ending == REFUSED) == is_true
    assert verdict.kind == ("" if is_true else "refused without reason")
    assert verdict.signature == signature


@pytest.mark.parametrize("ending", [VERIFIED, NOTICED])
def test_a_mistake_that_is_not_told_is_a_failure(ending: str) -> None:
    mistaken = Description("", FREE, HELD, (MISTAKE,))
    assert judged(mistaken, DrawVerdict(ending)).kind == "mistake not told"
    assert not judged(mistaken, DrawVerdict(REFUSED, signature="`.` is reserved")).failed
    assert not judged(Description("", FREE, HELD), DrawVerdict(ending)).failed


def test_no_walk_takes_a_pose_that_closes_alone_for_a_smooth_place() -> None:
    system = DrawnEquations(STRETCHED_ARM, ARM_STRETCHED).system
    system_equations = equations(system)
    evaluate = EquationEvaluator(NodeProgram(system.tape, system_equations.flat), system_equations)
    for seed in range(300):
        walker = Walker(system, evaluate, ARM_STRETCHED, Dice(str(seed)))
        assert not walker.is_regular(np.array(list(ARM_STRETCHED.values())), {})
