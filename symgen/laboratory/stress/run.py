"""One model under stress: families, sweeps, statuses, units, odd numbers, a long run; the result is plain data."""

from __future__ import annotations

import json
import math
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from itertools import chain
from pathlib import Path
from typing import Any

from symgen.generation.runnable import STRESSED, RunnableKernels
from symgen.laboratory.stress.families import Family, SingularFamilies, near_redundant, search
from symgen.laboratory.stress.long_run import LongRun, complaints, long_runs
from symgen.laboratory.stress.method_kernels import MethodKernels
from symgen.laboratory.stress.odd_numbers import OddNumbers, odd_numbers
from symgen.laboratory.stress.series import Series
from symgen.laboratory.stress.statuses.rule import Held, breaches, counted
from symgen.laboratory.stress.statuses.rule_states import far_apart, towards_singular_sets
from symgen.laboratory.stress.sweep import StatusCount, Sweep, Sweeper
from symgen.laboratory.stress.variants.redundant import with_redundant_row
from symgen.laboratory.stress.variants.scaling import Scaled, scaling
from symgen.model.model import Model
from symgen.verify.reference.reference import Reference
from symgen.verify.sampling.regular import FEWEST_STATES
from symgen.verify.sampling.states import sample_states
from symgen.verify.tolerance import FACTOR

Progress = Callable[[str], None]
ODD_STATES = 2


@dataclass(frozen=True, slots=True)
class Stress:
    """Everything measured; `failures` name what is wrong with symgen's kernels, `limits` known weaknesses met."""

    model: str
    engine: str
    sizes: dict[str, int]
    searched: SingularFamilies
    series: tuple[Series, ...]
    statuses: tuple[StatusCount, ...]
    scaled: tuple[Scaled, ...]
    odd: tuple[OddNumbers, ...]
    runs: tuple[LongRun, ...]
    no_run: str
    rule: tuple[Held, ...]
    failures: tuple[str, ...]
    limits: tuple[str, ...]

    @property
    def families(self) -> tuple[Family, ...]:
        """The families, to which the series refer by position."""
        return self.searched.families

    def to_json(self) -> dict[str, Any]:
        """A JSON-able form; what is infinite is null."""
        families = [
            {
                "kind": family.kind,
                "label": family.label,
                "d": family.meaning,
                "curves": len(family.curves),
                "partitions": [list(p) for p in family.partitions],
                "inputs": [list(p) for p in family.inputs],
            }
            for family in self.families
        ]
        return {
            "model": self.model,
            "engine": self.engine,
            "passed": not self.failures,
            "failures": list(self.failures),
            "limits": list(self.limits),
            "tolerance": FACTOR,
            "sizes": self.sizes,
            "factored": self.searched.factored,
            "nowhere": list(self.searched.nowhere),
            "partitions": self.searched.partitions,
            "failing_partitions": self.searched.failing,
            "families": families,
            "series": [_series(one) for one in self.series],
            "statuses": [asdict(one) for one in self.statuses],
            "scaling": [_plain(asdict(one)) for one in self.scaled],
            "odd_numbers": [asdict(one) for one in self.odd],
            "long_runs": [_plain(asdict(run)) for run in self.runs],
            "no_long_run": self.no_run,
            "rule": [_plain(held.to_json()) for held in self.rule],
        }


def stress(
    model: Model, steps: int, progress: Progress = lambda _: None, out: Path | None = None
) -> Stress:
    """Put a model under stress; `steps` of the long run, 0 for none.

    The kernels are those of OUT/<model>, where a run has verified some; without `out`, what derivation chooses.

    Raises ReferenceValueError or VerificationError where no regular states are found.
    """
    reference = Reference(model)
    with tempfile.TemporaryDirectory(prefix="symgen-stress-") as name:
        folder = Path(name)
        progress("deriving and compiling")
        kernels = RunnableKernels(model, folder, out=out)
        progress("looking for singularities")
        searched = search(reference)
        methods = MethodKernels(model, folder, kernels.names)
        sweeper = Sweeper(reference, kernels, searched.families, methods)
        for index, family in enumerate(searched.families):
            progress(f"{family.kind}, {family.label}")
            sweeper.family(index)
        swept = sweeper.result()
        if (twin := None if reference.ranks.constraints < model.r else with_redundant_row(model)) is not None:
            progress("near-redundant constraints")
            searched, more = _near_redundant(twin, searched, folder / "redundant")
            swept = swept.joined(more)
        progress("statuses")
        pushed = chain(towards_singular_sets(searched), far_apart(reference))
        rule = counted(reference, kernels, pushed, STRESSED)
        progress("other units")
        scaled, wrong_units = scaling(reference, kernels, folder)
        progress("odd numbers")
        stressed = tuple(name for name in STRESSED if name in kernels.names)
        states = [sample.state for sample in sample_states(reference, (), FEWEST_STATES)][:ODD_STATES]
        odd, wrong_numbers = odd_numbers(kernels, stressed, states)
        runs: tuple[LongRun, ...] = ()
        no_run = "not asked for"
        if steps:
            progress("a long run")
            runs, no_run = long_runs(reference, kernels, folder, steps)
    ranks = reference.ranks
    return Stress(
        model=model.name,
        engine=kernels.engine,
        sizes={"n": model.n, "r": model.r, "delta": model.n - ranks.constraints, "m": model.m},
        searched=searched,
        series=swept.series,
        statuses=swept.statuses,
        scaled=scaled,
        odd=odd,
        runs=runs,
        no_run=no_run,
        rule=rule,
        failures=(*swept.failures, *breaches(rule), *wrong_units, *wrong_numbers, *complaints(runs)),
        limits=(*kernels.notes, *swept.limits, *methods.left_out),
    )


def _near_redundant(twin: Model, searched: SingularFamilies, folder: Path) -> tuple[SingularFamilies, Sweep]:
    """The sweep of the system with one row more, and the search with its family."""
    reference = Reference(twin)
    known = replace(searched, families=(*searched.families, near_redundant(reference)))
    folder.mkdir()
    sweeper = Sweeper(reference, RunnableKernels(twin, folder, STRESSED), known.families)
    sweeper.family(len(searched.families))
    return known, sweeper.result()


def _series(one: Series) -> dict[str, Any]:
    """Errors as rows of d, relative error, error in units."""
    errors = [(e.distance, e.relative, e.units) for e in one.errors]
    return {
        "family": one.family,
        "scalar": one.scalar,
        "quantity": one.quantity,
        "form": one.method,
        "breaks": _plain(one.breaks),
        "errors": _plain(errors),
    }


def json_text(data: Mapping[str, Any]) -> str:
    """JSON with one line for each entry of a list."""
    lines = []
    for key, value in data.items():
        text = json.dumps(value, ensure_ascii=False)
        if isinstance(value, list) and value:
            text = "[\n  " + ",\n  ".join(json.dumps(item, ensure_ascii=False) for item in value) + "\n ]"
        lines.append(f" {json.dumps(key)}: {text}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float):
        return float(f"{value:.4g}") if math.isfinite(value) else None
    return value
