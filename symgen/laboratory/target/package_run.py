"""The package on a core beside the host: every function it has in common with the host's image, at a few states."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from symgen.ir.kernel import Scalar
from symgen.laboratory.target.compare import Units, compare
from symgen.laboratory.target.cores import Core
from symgen.laboratory.target.driver import Results, pack_states, results_file, states_file, unpack_results
from symgen.laboratory.target.emulator import emulate, stage
from symgen.laboratory.target.entries import Entries
from symgen.laboratory.target.package_build import LEVEL, Package, build_package
from symgen.laboratory.target.record import Cell
from symgen.runtime.processes import ToolError
from symgen.verify.reference.reference import State

REGULAR, OTHERS = 8, 8


def run_package(
    package: Package, core: Core, folder: Path, states: Mapping[Scalar, Sequence[State]], regular: int,
    expected: Mapping[Scalar, Results], units: Mapping[Scalar, Units],
) -> tuple[list[Cell], list[str]]:
    """Builds and runs the package; `states` begin with the `regular` ones, `expected` are the host's results for all.

    Returns what was compared and what is wrong; raises ToolError where it cannot be built or run.
    """
    image = build_package(package, core, folder)
    chosen = {scalar: _chosen(len(known), regular) for scalar, known in states.items()}
    inputs = []
    for scalar in package.entries:
        inputs.append(folder / states_file(scalar))
        rows = [states[scalar][k] for k in chosen[scalar]]
        inputs[-1].write_bytes(pack_states(rows, scalar, package.model))
    stage(image, inputs)
    emulate(core, image)
    cells, failures = [], []
    for scalar, entries in package.entries.items():
        places = chosen[scalar]
        try:
            results = unpack_results((image.parent / results_file(scalar)).read_bytes(), entries, len(places))
        except (OSError, ValueError) as error:
            raise ToolError(f"the package on {core.name}: {error}") from error
        known = expected[scalar].records
        common = Entries(scalar, tuple(entry for entry in entries.functions if entry.name in known), entries.given)
        host = Results({e.name: tuple(known[e.name][k] for k in places) for e in common.functions}, {})
        made = compare(common, True, host, results, units[scalar], min(regular, REGULAR))
        count = len(common.functions)
        cells.append(Cell(
            core.name, "package", LEVEL, scalar, "portable", count, count * len(places), made.different, made.distance
        ))
        failures += [f"{core.name}, package, {scalar}: {wrong}" for wrong in made.wrong]
    return cells, failures


def _chosen(count: int, regular: int) -> list[int]:
    """The first regular states, and some of the others at equal distances."""
    first = list(range(min(regular, REGULAR)))
    others = range(regular, count)
    return first + list(others[:: max(1, len(others) // OTHERS)])[:OTHERS]
