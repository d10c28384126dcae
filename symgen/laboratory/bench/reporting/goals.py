"""Goals as ratios to the peers, and the instruction counts they were set by, which the peers have to reproduce.

Before the goals were set, u of the paper's models was measured as CasADi, SymPy, SymEngine, SymForce and wrenfold
write it: the early counts.  Every one is of one call of u in float64.
"""

from __future__ import annotations

from dataclasses import dataclass

PAPER = ("skate", "front_car", "rear_car", "rapkm_2rrr_rr")
AS_WRITTEN = "CasADi as written"
BEST_VALID = "best peer valid wherever B has full rank"
BEST_ANY = "best peer by any method"
# Counted early was the parallel robot without payload, its energy written with the velocities of the mass centres.
COUNTED_EARLY = {"rapkm_2rrr_rr": "rapkm_without_payload"}
VALID_METHODS = frozenset({"native", "lean", "lean LDLᵀ"})
REPRODUCED_WITHIN = 0.05


@dataclass(frozen=True, slots=True)
class Goal:
    """symgen's instructions over the peer's, at most, by model of `PAPER`."""

    against: str
    trig: str
    ratios: tuple[float | None, ...]


GOALS = (
    Goal(AS_WRITTEN, "libm", (0.62, 0.42, 0.45, 0.30)),
    Goal(BEST_ANY, "libm", (1.00, 0.66, 0.70, 0.78)),
    Goal(BEST_ANY, "portable", (0.58, 0.36, 0.40, 0.48)),
)
# Code and stack of u over those of the best peer, at most, for two models; the library's trigonometry on both sides.
FOOTPRINT_GOALS = {"code": 0.55, "stack": 0.85}
FOOTPRINT_MODELS = ("front_car", "rapkm_2rrr_rr")
# The early counts, and the tool and method that gave them.
EARLY_COUNTS: dict[str, tuple[tuple[int, str], ...]] = {
    AS_WRITTEN: ((262, "CasADi native"), (821, "CasADi native"), (751, "CasADi native"), (3696, "CasADi native")),
    BEST_VALID: ((156, "SymPy lean"), (562, "wrenfold lean"), (530, "SymPy lean"), (1975, "wrenfold lean")),
    BEST_ANY: ((157, "SymPy part"), (519, "wrenfold part"), (482, "wrenfold part"), (1433, "wrenfold elimination")),
}
