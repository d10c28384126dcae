"""What each tuned constant changes: every model derived with half and with twice of it, where that decides anything.

One derivation of each model tells which constants could (`bench.tuning.varied`); only these are tried.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import groupby
from math import exp, log
from pathlib import Path
from typing import Any

from symgen.laboratory.bench.tuning.altered import FACTORS
from symgen.laboratory.bench.tuning.skipping import table_line
from symgen.laboratory.bench.tuning.tuned import Constant
from symgen.laboratory.bench.tuning.varied import Key

PROCESSES = 2
# Times what a model takes with the constants as they are, and seconds more: nobody waits longer for a derivation.
PATIENCE, SECONDS_MORE = 10, 5


@dataclass(frozen=True, slots=True)
class Derived:
    """A model with certain constants: cost and digest by quantity, digest of the C, seconds; or why it failed."""

    kernels: Mapping[str, tuple[int, str]]
    c: str = ""
    seconds: float = 0
    noticed: frozenset[Key] = frozenset()
    failed: str = ""


@dataclass(frozen=True, slots=True)
class Change:
    """What half or twice a constant makes of the models that it could change, each with what it is as it stands."""

    constant: Constant
    how: str
    models: Mapping[str, tuple[Derived, Derived]]

    @property
    def failed(self) -> list[str]:
        """Models that are not derived any more, and why."""
        return [f"{name} {changed.failed}" for name, (_, changed) in self.models.items() if changed.failed]

    @property
    def printed(self) -> list[str]:
        """Models whose C is another one."""
        return [name for name, (plain, changed) in self.models.items() if not changed.failed and changed.c != plain.c]

    @property
    def ratios(self) -> dict[tuple[str, str], float]:
        """Counted cost of quantities against what it is, where it is another and none of both is 0."""
        by_kernel = {}
        for name, (plain, changed) in self.models.items():
            for quantity, (cost, _) in changed.kernels.items():
                before = plain.kernels.get(quantity, (0, ""))[0]
                if before and cost and cost != before:
                    by_kernel[name, quantity] = cost / before
        return by_kernel

    @property
    def others(self) -> int:
        """Kernels that cost the same and compute otherwise, or that come or go."""
        count = 0
        for plain, changed in self.models.values():
            if not changed.failed:
                names = {*plain.kernels, *changed.kernels}
                count += sum(plain.kernels.get(name) != changed.kernels.get(name) for name in names)
        return count - len(self.ratios)

    @property
    def slower(self) -> float:
        """CPU time of these models against what it is."""
        done = [both for both in self.models.values() if not both[1].failed]
        return sum(changed.seconds for _, changed in done) / max(sum(plain.seconds for plain, _ in done), 1e-9)

    @property
    def idle(self) -> bool:
        """Whether every model gives the same C."""
        return not self.failed and not self.printed and not self.ratios and not self.others


@dataclass(frozen=True, slots=True)
class MeasuredConstants:
    """All constants, models as they are, and what changes."""

    constants: Sequence[Constant]
    plain: Mapping[str, Derived]
    changes: Sequence[Change]


def measured(constants: Sequence[Constant], models: Sequence[Path]) -> MeasuredConstants:
    """Every constant on every model that it can change."""
    tried = [one for one in constants if not one.numerical and not one.outside]
    modules = sorted({one.module for one in tried})
    with ThreadPoolExecutor(PROCESSES) as pool:
        plain = list(pool.map(lambda model: _child([], None, {str(model): 0})[str(model)], models))
        watched = list(pool.map(lambda model: _child(modules, None, {str(model): 0})[str(model)], models))
        for model, before, seen in zip(models, plain, watched, strict=True):
            if before.failed or seen.failed or before.c != seen.c or before.kernels != seen.kernels:
                raise RuntimeError(f"{model.stem}: watched, it is another ({before.failed or seen.failed})")
        tasks = []
        for constant in tried:
            for how in FACTORS:
                places = [at for at, seen in enumerate(watched) if (constant.key, how) in seen.noticed]
                if places:
                    tasks.append((constant, how, {str(models[at]): plain[at] for at in places}))
        changes = list(pool.map(lambda task: _changed(*task), tasks))
    return MeasuredConstants(constants, {model.stem: one for model, one in zip(models, plain, strict=True)}, changes)


def _changed(constant: Constant, how: str, plain: Mapping[str, Derived]) -> Change:
    most = {path: PATIENCE * one.seconds + SECONDS_MORE for path, one in plain.items()}
    derived = _child([constant.module], (constant.key, how), most)
    return Change(constant, how, {Path(path).stem: (one, derived[path]) for path, one in plain.items()})


def _child(modules: Sequence[str], changed: Key | None, models: Mapping[str, float]) -> dict[str, Derived]:
    task = json.dumps({"modules": modules, "changed": changed, "models": models})
    command = [sys.executable, "-m", "symgen.laboratory.bench.tuning.altered"]
    done = subprocess.run(command, input=task, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{changed}: {done.stderr}")
    return {path: _derived(one) for path, one in json.loads(done.stdout).items()}


def _derived(record: Mapping[str, Any]) -> Derived:
    if "failed" in record:
        return Derived({}, failed=record["failed"])
    kernels = {name: (cost, digest) for name, (cost, digest) in record["kernels"].items()}
    return Derived(kernels, record["c"], record["seconds"], frozenset((key, how) for key, how in record["noticed"]))


def page(measurements: MeasuredConstants) -> str:
    """The page docs/constants.md."""
    count = sum(len(one.kernels) for one in measurements.plain.values())
    by_constant = {key: list(group) for key, group in groupby(measurements.changes, key=lambda one: one.constant.key)}
    busy = {key for key, group in by_constant.items() if not all(one.idle for one in group)}
    lines = list(_table(("constant", "value", "limits", "change", "kernels", "geometric mean", "most", "beside"), ()))
    for constant in measurements.constants:
        first_cells = _first_cells(constant)
        for change in by_constant[constant.key] if constant.key in busy else ():
            lines.append(table_line([*first_cells, change.how, *_cells(change, count)]))
            first_cells = ("", "", "")
    quiet = [one for one in measurements.constants if one.key not in busy]
    numerical, outside = ([one for one in quiet if one.numerical], [one for one in quiet if one.outside])
    texts = {"CHANGES": "\n".join(lines), "COUNTS": f"{len(measurements.plain)} models, {count} kernels"}
    same = [one for one in quiet if not one.numerical and not one.outside]
    for name, group in (("SAME", same), ("NUMERICAL", numerical), ("OUTSIDE", outside)):
        texts[name] = "\n".join(_table(("constant", "value", "limits"), map(_first_cells, group)))
    made = _PAGE
    for name, text in texts.items():
        made = made.replace(name, text)
    return made


def _first_cells(constant: Constant) -> tuple[str, str, str]:
    return f"`{constant.module.removeprefix('symgen.')}` `{constant.name}`", constant.value, constant.limits


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> Iterator[str]:
    yield table_line(head)
    yield table_line(["---"] * len(head))
    yield from map(table_line, rows)


def _cells(change: Change, count: int) -> tuple[str, str, str, str]:
    ratios, beside = change.ratios, []
    if change.idle:
        return "0", "", "", "the same C"
    if change.others:
        beside.append(f"{change.others} of the same cost")
    if not change.others and not ratios and change.printed:
        beside.append(f"other C of {', '.join(change.printed)}")
    beside += change.failed
    if change.slower >= 2:
        beside.append("twice the time")
    if not ratios:
        return "0", "", "", "; ".join(beside)
    mean = exp(sum(map(log, ratios.values())) / count)
    (model, quantity), most = max(ratios.items(), key=lambda item: abs(log(item[1])))
    where = f"{_percent(most)} ({quantity.replace('_', ' ')} of {model})"
    return str(len(ratios)), _percent(mean, 2), where, "; ".join(beside)


def _percent(ratio: float, places: int = 1) -> str:
    return f"{100 * (ratio - 1):+.{places}f} %"


_PAGE = """\
# What the tuned constants change

The numbers that limit or weigh something on the way from model to kernel. Each was halved and doubled, and every
shipped model derived anew (COUNTS): how many kernels count other operations, what that makes of the geometric mean over
all kernels and of the one that changes most (weights as on [the page of passes](passes.md)), and beside it kernels that
compute otherwise with the same count, models that are not derived any more, and whether the models it decides on take
twice the CPU time or more. Made by `make constants`.

CHANGES

## What no shipped model needs

Half and twice of these give the same kernels for every shipped model. They hold what models may hold, keep derivations
short, or decide on thresholds that are tested in other systems.

SAME

## Samples, steps and thresholds

Half and twice of these are not tried on models. Tests of the modules notice where a number that counts points, steps,
powers or shares changes; tolerances lie between what
rounding leaves and what counts, in gaps of several powers of ten.

NUMERICAL

## What derivation does not read

Constants of closed forms, which reports print, and of what follows from verification.

OUTSIDE
"""
