"""Many states at once, in the terminal and on the page docs/bench/README.md."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

from symgen.laboratory.bench.batch import CACHED, CONTRACTED, CONTRACTING, FLAGS, LANES, LOOP, STREAMED, Many
from symgen.laboratory.bench.peers.engines.straight import LOOP_FLAGS
from symgen.terminal import columns

Row: TypeAlias = Mapping[str, Any]
# (against the fastest peer's C in a loop, against NumPy on the same closed form), by model.
GOALS = {"rapkm_2rrr_rr": (5.0, 6.0)}
# Against the fastest peer in lanes, of every model.
GOAL_IN_LANES = 1.25
TEXT = f"""## Many states

u of many states with one set of parameters, one core, float64 unless said otherwise; medians of passes in turns, in
million states a second. **batch** is the C over arrays of components, **compile()** the same from Python over arrays
of states; NumPy runs the same closed form on the same arrays of states. **In a loop** a peer's C is called state by
state; **in lanes** its operations, as straight lines, stand in a loop over the same arrays of components that the
compiler makes vectors of (`{" ".join(LOOP_FLAGS)}`, sine and cosine of libmvec). All C, the peers' too, is compiled
with `{" ".join(FLAGS)}`, **contracted** ones of symgen with
`{" ".join(CONTRACTING)}` behind it, and no peer so.
The first number is for {STREAMED} states, which come from memory, the one in brackets for {CACHED}, which stay in the
cache. The last columns are the ratios of times at {STREAMED} states; in brackets the goal, bold if missed.

"""


def many_lines(many: Sequence[Many]) -> str:
    """The terminal's table of one quantity."""
    head = ("many states", "", f"ns, {STREAMED}", f"ns, {CACHED}")
    cells = [
        (m.label, m.scalar, f"{m.streamed_nanoseconds:.1f}", f"{m.cached_nanoseconds:.1f}")
        for m in sorted(many, key=lambda m: m.streamed_nanoseconds)
    ]
    return columns(head, cells, "<<>>")


def many_section(results: Sequence[Row]) -> str:
    """The page's section; empty where no run measured it."""
    lines = []
    for result in results:
        rows = next((c.get("many_states") for c in result["comparisons"] if c["quantity"] == "inverse_dynamics"), None)
        if rows:
            lines.append(f"| {' | '.join([result['model'], *_cells(result['model'], rows)])} |\n")
    if not lines:
        return ""
    head = ["", "batch", "contracted", "batch, float32", "compile()", "symgen in a loop", "fastest peer in a loop"]
    head += ["fastest peer in lanes", "NumPy", "batch against the loop", "against the lanes", "contracted"]
    head += ["against NumPy"]
    return TEXT + f"| {' | '.join(head)} |\n|{'---|' * len(head)}\n" + "".join(lines)


def _cells(model: str, rows: Sequence[Row]) -> list[str]:
    double = [row for row in rows if row["scalar"] == "float64"]
    batch = next(row for row in double if row["form"] == "batch")
    contracted = next(row for row in double if row["form"] == CONTRACTED)
    single = next(row for row in rows if row["scalar"] == "float32" and row["form"] == "batch")
    compiled = next(row for row in double if row["form"] == "compile()")
    own = next((row for row in double if row["generator"] == "symgen" and row["form"].endswith(LOOP)), None)
    peers = [row for row in double if row["generator"] != "symgen"]
    loop, lanes = (
        min((row for row in peers if row["form"].endswith(way)), key=_time, default=None) for way in (LOOP, LANES)
    )
    numpy = min((row for row in double if row["form"].startswith("NumPy")), key=_time)
    wanted = GOALS.get(model, (None, None))
    return [
        *map(_speed, (batch, contracted, single, compiled, own)),
        *(f"{_speed(row)} {_named(row)}".strip() for row in (loop, lanes)),
        _speed(numpy),
        _ratio(loop, batch, wanted[0]),
        _ratio(lanes, batch, GOAL_IN_LANES),
        _ratio(lanes, contracted, None),
        _ratio(numpy, batch, wanted[1]),
    ]


def _named(row: Row | None) -> str:
    return "" if row is None else f"{row['generator']} {row['form'].removesuffix(LOOP).removesuffix(LANES)}"


def _time(row: Row) -> float:
    return float(row["streamed_nanoseconds"])


def _speed(row: Row | None) -> str:
    return "" if row is None else f"{1e3 / _time(row):.3g} ({1e3 / row['cached_nanoseconds']:.3g})"


def _ratio(other: Row | None, batch: Row, wanted: float | None) -> str:
    if other is None:
        return ""
    ratio = _time(other) / _time(batch)
    if wanted is None:
        return f"{ratio:.1f}"
    shown = f"{ratio:.1f}" if wanted == round(wanted) else f"{ratio:.2f}"
    return f"{shown} ({wanted:g})" if ratio >= wanted else f"**{shown}** ({wanted:g})"
