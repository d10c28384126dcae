"""What is asked of u of mechanisms given by bodies, and the early counts that the goals were set by."""

from __future__ import annotations

from symgen.laboratory.bench.reporting.goals import AS_WRITTEN, BEST_ANY, Goal

MECHANISMS = (
    "front_car_bodies", "rapkm_bodies", "delta", "gough_stewart", "chain8", "chain16", "chain32", "arm7",
)  # fmt: skip
CHEAPEST_WRITTEN = "CasADi as written, cheapest of its writings"
_WRITTEN = (0.42, 0.27, 0.34, 0.14, 0.19, 0.075, None, 0.47)
GOALS = (
    Goal(AS_WRITTEN, "libm", _WRITTEN),
    Goal(CHEAPEST_WRITTEN, "libm", _WRITTEN),
    Goal(BEST_ANY, "libm", (0.66, 0.68, 1.0, 1.0, 0.57, 0.56, 0.55, 0.47)),
    Goal(BEST_ANY, "portable", (0.36, 0.38, 0.8, 0.95, 0.36, 0.38, 0.39, 0.37)),
)
# What counts as "as written": G and C as matrices, (27) and (28) with `inv` and `@`; where that is too long,
# the motion equations along directions; without loops, these of energies in world axes.
AS_WRITTEN_METHODS = (
    frozenset({"AD in world axes"}),
    frozenset({"native", "native from energies"}),
    frozenset({"literal", "literal from energies"}),
)
WRITTEN = frozenset({"AD"}).union(*AS_WRITTEN_METHODS)
# Its cars, RA-PKM and chains are these, the other mechanisms were counted with other parameters.
EARLY_COUNTS: dict[str, tuple[int | None, ...]] = {
    AS_WRITTEN: (821, 3696, 1735, 11126, 9464, 51463, None, 5157),
    BEST_ANY: (519, 1433, 572, 1583, 3110, 6348, 12918, 5157),
}
