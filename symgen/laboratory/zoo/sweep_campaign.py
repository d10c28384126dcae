"""Sweeps of many draws: each generated, swept and recorded, and what violates the rule kept with its files."""

from __future__ import annotations

import json
import shutil
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from symgen.laboratory.zoo.approach import KINDS
from symgen.laboratory.zoo.campaign import Campaign, write
from symgen.laboratory.zoo.draws.families import draw
from symgen.laboratory.zoo.run import run_command
from symgen.laboratory.zoo.sweeps import ANSWERED, BEYOND, SCALED, STATUSES, UNEXPLAINED, UNKNOWN, SweepCounts, sweep
from symgen.laboratory.zoo.verdict import NOTICED, VERIFIED, verdict_of


def one_sweep(campaign: Campaign, index: int) -> tuple[SweepRecord, str]:
    """A draw from its number to its record, and a line about it; only what ends verified is swept."""
    description = draw(campaign.seed, index, campaign.family)
    model = campaign.folder / f"{campaign.seed}_{index}" / "zoo.yaml"
    write(description, model)
    ending = verdict_of(run_command(model, model.with_suffix(""))).ending
    made = model.with_suffix("") / str(description.blocks["model"])
    swept = sweep(description, made) if ending in (VERIFIED, NOTICED) else SweepCounts({})
    if swept.violations:
        write_violations(model.with_name("violations.json"), swept)
    else:
        shutil.rmtree(model.parent)
    record = record_of(campaign.seed, index, description.family, ending, swept)
    return record, record.line


@dataclass(frozen=True)
class SweepRecord:
    """What the sweep of one draw came to, as a line of JSON."""

    seed: int
    index: int
    family: str
    ending: str
    counts: tuple[tuple[str, str, str, int], ...] = ()
    violations: tuple[str, ...] = ()

    @property
    def line(self) -> str:
        """About the draw, for a terminal."""
        swept = self.swept
        summary = f"{self.ending}, not swept"
        if self.counts:
            answered, unknown = swept.of(ANSWERED), swept.of(UNKNOWN)
            statuses = ", ".join(f"{swept.of(name)} {name}" for name in STATUSES.values() if swept.of(name))
            summary = f"{answered} answered, {statuses or 'no status'}, {unknown} without truth"
            summary += f"; {swept.of(BEYOND)} beyond the tolerance, {swept.of(UNEXPLAINED)} statuses unexplained"
        return f"{self.seed}:{self.index} {self.family}: {summary}"

    @property
    def swept(self) -> SweepCounts:
        """The counts again."""
        return SweepCounts({(kind, scalar, outcome): count for kind, scalar, outcome, count in self.counts})


def record_of(seed: int, index: int, family: str, ending: str, swept: SweepCounts) -> SweepRecord:
    """The record of a draw."""
    counts = tuple((*key, count) for key, count in sorted(swept.counts.items()))
    return SweepRecord(seed, index, family, ending, counts, tuple(one.text for one in swept.violations))


def write_violations(path: Path, swept: SweepCounts) -> None:
    """Everything that is needed to look at each once more."""
    records: list[dict[str, Any]] = [{"text": one.text, **asdict(one)} for one in swept.violations]
    path.write_text(json.dumps(records, indent=1) + "\n", encoding="utf-8")


def table(records: Sequence[SweepRecord]) -> str:
    """Totals by what was led where, and by scalar type."""
    total: Counter[tuple[str, str, str]] = Counter()
    for record in records:
        total.update(record.swept.counts)
    columns = [ANSWERED, *STATUSES.values(), UNKNOWN, BEYOND, UNEXPLAINED]
    lines = [f"{sum(bool(record.counts) for record in records)} of {len(records)} draws swept"]
    lines.append(" " * 20 + "".join(f"  {column:>7}" for column in columns))
    for kind in (*KINDS, SCALED):
        for scalar in ("float64", "float32"):
            row = "".join(f"  {total[kind, scalar, column]:>{max(7, len(column))}}" for column in columns)
            lines.append(f"{kind:<11}{scalar:<9}{row}")
    return "\n".join(lines)
