"""u in float32 on a Cortex-M4F beside the goals and beside CasADi's methods, compiled the same way; `make firmware`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from statistics import mean

import numpy as np
import pytest
from shipped import model

from symgen.backends.c.plain import emit_c
from symgen.laboratory.bench.candidate import CCandidate, Task
from symgen.laboratory.bench.peers.roster import in_single, peers
from symgen.laboratory.target.build import Workshop
from symgen.laboratory.target.cores import BY_NAME
from symgen.laboratory.target.driver import driver_source, pack_states, states_file
from symgen.laboratory.target.emulator import addresses, build_counter, count_calls, stage
from symgen.laboratory.target.entries import plain_entries
from symgen.laboratory.target.footprint import footprints
from symgen.laboratory.target.vectors import rounded_state
from symgen.lowering.schedule import schedule
from symgen.quantities.select import derive_quantities
from symgen.verify.reference.reference import Reference, State
from symgen.verify.sampling.states import sample_states

CORE = BY_NAME["cortex-m4f"]
STATES = 64
# model: instructions at most at -O2, bytes at most at -Os, share of CasADi's best method at -O2
GOALS = {"front_car": (165, 600, 0.35), "rapkm_2rrr_rr": (500, 1400, 0.35)}
LEVELS = ("-O2", "-Os")
# CasADi writes double's functions whatever its type is: it is given float's, which makes it 17 times cheaper here.
SINGLE = ("-include", "single.h", "-fsingle-precision-constant", "-DREAL=float", "-Dcasadi_real=REAL")
HEADER = "#include <math.h>\n" + "".join(
    f"#define {name} {name}f\n" for name in ("sin", "cos", "tan", "sqrt", "fabs", "pow", "fmin", "fmax")
)
DRIVER = """
#include "board.h"
typedef float real;
int {entry}(const real *, const real *, const real *, const real *, real *);
int main(void) {{
    static struct {{ real q[{n}], qd[{n}], qdd[{n}], u[{m}], p[{p}]; }} row;
    static real y[{m}];
    uint32_t states;
    const int in = board_open("{states}", BOARD_READ);
    board_read(in, &states, sizeof states);
    for (uint32_t k = 0; k < states; k++) {{
        board_read(in, &row, sizeof row);
        (void){entry}(row.q, row.qd, row.qdd, row.p, y);
    }}
    return 0;
}}
"""


def _states(name: str) -> list[State]:
    samples = sample_states(Reference(model(name)), (), STATES)
    return [rounded_state(sample.state, "float32") for sample in samples]


def _symgen(name: str, folder: Path) -> tuple[dict[str, int], int]:
    """Instructions of u at each level, and its bytes at -Os."""
    derivations = derive_quantities(model(name), ("inverse_dynamics",))
    program = schedule(derivations.mechanics, derivations.quantities, ("float64", "float32"))["float32"]
    entries = plain_entries(model(name), program)
    function = entries.functions[0].function
    shop = Workshop(folder / "symgen", CORE)
    files = {path.rpartition("/")[2]: text for path, text in emit_c(model(name), program).items()}
    shop.write({**files, "driver.c": driver_source(model(name), {"float32": entries})})
    inputs = folder / states_file("float32")
    inputs.write_bytes(pack_states(_states(name), "float32", model(name)))
    counter = build_counter(folder)
    counts = {}
    for level in LEVELS:
        target = shop.compile(f"{name}_f.c", level)
        image = shop.link(f"u{level}", [*shop.harness("driver.c", 0), target])
        stage(image, [inputs])
        counts[level] = max(count_calls(CORE, image, counter, addresses(shop, image, [function]))[function])
    return counts, footprints(shop, target, [function])[function].linked


def _casadi(name: str, folder: Path) -> dict[str, float]:
    """Mean instructions of u at -O2 by every method CasADi takes part in."""
    m = model(name)
    rows = np.array([(*s.q, *s.qd, *s.qdd, *s.parameters) for s in _states(name)])
    all_candidates = peers(m, Task("inverse_dynamics", "qdd", m.m), rows).candidates
    candidates = [in_single(c) for c in all_candidates if c.generator == "CasADi" and not c.flags]
    assert len(candidates) >= 3
    return {candidate.form: _counted(name, candidate, folder) for candidate in candidates}


def _counted(name: str, candidate: CCandidate, folder: Path) -> float:
    m = model(name)
    shop = Workshop(folder / candidate.entry, CORE)
    sizes = {"n": m.n, "m": m.m, "p": len(m.parameters)}
    driver = DRIVER.format(entry=candidate.entry, states=states_file("float32"), **sizes)
    units = {f"unit{k}.c": unit.source for k, unit in enumerate(candidate.units)}
    shop.write({"driver.c": driver, "single.h": HEADER, **units})
    objects = []
    for k, unit in enumerate(candidate.units):
        renamed = [f"-D{old}={new}" for old, new in unit.renamed.items()]
        objects.append(shop.compile(f"unit{k}.c", "-O2", flags=[*SINGLE, *renamed]))
    image = shop.link("casadi", [*shop.harness("driver.c", 0), *objects])
    stage(image, [folder / states_file("float32")])
    functions = addresses(shop, image, [candidate.entry])
    return mean(count_calls(CORE, image, build_counter(folder), functions)[candidate.entry])


@pytest.mark.firmware
@pytest.mark.parametrize("name", GOALS)
def test_u_on_a_cortex_m4f_meets_its_goals(tool: Callable[[str], str], tmp_path: Path, name: str) -> None:
    for needed in ("gcc", "arm-none-eabi-gcc", "qemu-system-arm"):
        tool(needed)
    instructions, size, share = GOALS[name]
    counts, code = _symgen(name, tmp_path)
    casadi = _casadi(name, tmp_path)
    message = f"{name}: {counts}, {code} bytes; CasADi {({method: round(count) for method, count in casadi.items()})}"
    assert counts["-O2"] <= share * min(casadi.values()), message
    assert counts["-O2"] <= instructions, message
    assert code <= size, message
