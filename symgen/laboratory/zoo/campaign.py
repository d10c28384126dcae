"""Many draws, each run, judged and, where it fails, made small; several at a time where there are cores to spare."""

from __future__ import annotations

import json
import os
import shutil
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from dataclasses import dataclass, field, replace
from itertools import islice
from multiprocessing import get_context
from pathlib import Path
from typing import TypeVar

from symgen.laboratory.zoo.alone import alone, beside_others
from symgen.laboratory.zoo.cases import case_of
from symgen.laboratory.zoo.draws.describe import Description
from symgen.laboratory.zoo.draws.families import draw
from symgen.laboratory.zoo.records import DrawRecord, methods_of
from symgen.laboratory.zoo.refusals import UNREPORTED, judged
from symgen.laboratory.zoo.run import run_command
from symgen.laboratory.zoo.shrink import shrink
from symgen.laboratory.zoo.verdict import FAILED, REFUSED, DrawVerdict, verdict_of, without_numbers
from symgen.laboratory.zoo.witness.coverage import Coverage
from symgen.laboratory.zoo.witness.states import NOWHERE_SMOOTH, STUCK
from symgen.laboratory.zoo.witness.witness import check

# CPU seconds that making a failing draw small may take: one that takes too long each time would take hours
MOST_SECONDS = 300.0

Show = Callable[[str], None]
Recorded = TypeVar("Recorded")


@dataclass(frozen=True)
class Campaign:
    """Which draws, where their files go, how many runs a failing one is made small in (0: not at all).

    The small one is kept as a case in `cases`, or beside the draw's own files.
    """

    seed: int
    folder: Path
    family: str = ""
    shrinking: int = 0
    cases: Path | None = None


def write(description: Description, model: Path) -> None:
    """Writes a model file, and those that stand beside it."""
    model.parent.mkdir(parents=True, exist_ok=True)
    model.write_text(description.text, encoding="utf-8")
    for name, text in description.files.items():
        (model.parent / name).write_text(text, encoding="utf-8")


@dataclass(frozen=True)
class JudgedDraw:
    """How a draw ended, CPU seconds and megabytes of the command, what was compared, if anything was, and which
    methods compute what."""

    verdict: DrawVerdict
    cpu: float
    megabytes: float
    compared: Coverage | None = None
    methods: Mapping[str, str] = field(default_factory=dict)


def judge(description: Description, model: Path) -> JudgedDraw:
    """Writes the model file, runs the command beside it and looks at the numbers."""
    write(description, model)
    folder = model.with_suffix("")
    run = run_command(model, folder, description.options)
    verdict = judged(description, verdict_of(run))
    compared = None
    if not verdict.failed and verdict.ending != REFUSED:
        verdict, text, compared = _witnessed(description, folder, verdict)
        (folder / "stderr").write_text(text + run.err, encoding="utf-8")
    derivation = folder / str(description.blocks["model"]) / "derivation.json"
    methods = methods_of(json.loads(derivation.read_bytes())) if derivation.exists() else {}
    return JudgedDraw(verdict, run.cpu, run.megabytes, compared, methods)


def _witnessed(
    description: Description, folder: Path, verdict: DrawVerdict
) -> tuple[DrawVerdict, str, Coverage | None]:
    """What the numbers make of a verdict, what there is to say about it, and what was compared."""
    made = folder / str(description.blocks["model"])
    if not (made / "derivation.json").exists():
        return DrawVerdict(FAILED, "nothing written"), "", None
    try:
        checked = check(description, made)
    except Exception as fault:  # a draw on which the witness itself breaks must not end a campaign of a thousand
        signature = without_numbers(f"{type(fault).__name__}: {fault}")
        return DrawVerdict(FAILED, "fault of the zoo", signature), f"{fault!r}\n", None
    if checked.findings:
        first = checked.findings[0]
        text = "".join(f"{finding.text}\n" for finding in checked.findings)
        return DrawVerdict(FAILED, first.kind, without_numbers(first.text)), text, checked.coverage
    if not checked.states:
        verdict = without_states(verdict, checked.coverage.lack)
    return verdict, "", checked.coverage


def without_states(verdict: DrawVerdict, lack: str) -> DrawVerdict:
    """The verdict where nothing was compared: a failure, unless the walk cannot leave what is singular."""
    if lack in (STUCK, NOWHERE_SMOOTH):
        return replace(verdict, signature=f"no state to compare: {lack}")
    return DrawVerdict(FAILED, "no state to compare", lack)


def one_draw(campaign: Campaign, index: int) -> tuple[DrawRecord, str]:
    """A draw from its number to its record, and a line about it.

    One that takes too long beside others is run again by itself.
    """
    description = draw(campaign.seed, index, campaign.family)
    model = campaign.folder / f"{campaign.seed}_{index}" / "zoo.yaml"
    with beside_others(campaign.folder):
        ended = judge(description, model)
    if ended.verdict.kind == "time":
        with alone(campaign.folder):
            ended = judge(description, model)
    verdict = ended.verdict
    record = DrawRecord(
        campaign.seed, index, description.family, verdict.ending, verdict.kind, verdict.signature,
        round(ended.cpu, 1), round(ended.megabytes), str(model) if verdict.failed else "", ended.compared,
        ended.methods,
    )  # fmt: skip
    line = f"{record.ending} {record.kind} {record.signature} ({record.cpu} s, {record.megabytes} MB)"
    if ended.compared is not None and ended.compared.lack:
        line += f"; {ended.compared.states} states: {ended.compared.lack}"
    if not verdict.failed:
        shutil.rmtree(model.parent, ignore_errors=True)
    elif campaign.shrinking:
        small = shrunk(description, verdict, model.with_name("small.yaml"), campaign.shrinking)
        kept = campaign.cases / f"{model.parent.name}.yaml" if campaign.cases else model.with_name("case.yaml")
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text(case_of(small, verdict).text, encoding="utf-8")
        line += f"; kept as {kept}"
    return record, f"{record.seed}:{index} {record.family}: {' '.join(line.split())}"


def run_campaign(
    one: Callable[[Campaign, int], tuple[Recorded, str]],
    campaign: Campaign,
    indices: Iterable[int],
    seconds: float,
    jobs: int,
    show: Show,
) -> Iterator[Recorded]:
    """Draws until they or the seconds (0: no limit) are used up, `jobs` at a time, in the order in which they end.

    `one` makes a record and a line of one of them.
    """
    began = time.monotonic()
    waiting = iter(indices)
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        running: set[Future[tuple[Recorded, str]]] = set()
        while True:
            late = bool(seconds) and time.monotonic() - began > seconds
            for index in islice(waiting, 0 if late else jobs - len(running)):
                running.add(pool.submit(one, campaign, index))
            if not running:
                return
            done, running = wait(running, return_when=FIRST_COMPLETED)
            for future in done:
                record, line = future.result()
                show(line)
                yield record


def usual_jobs() -> int:
    """As many as there are processors."""
    return os.cpu_count() or 1


def shrunk(description: Description, verdict: DrawVerdict, model: Path, most: int) -> Description:
    """The draw made small, still with the same ending; a mistake that was not told stays as it is, lest it be lost."""
    spent = 0.0
    if verdict.kind == UNREPORTED:
        return description

    def fails(candidate: Description) -> bool:
        nonlocal spent
        if spent > MOST_SECONDS:
            return False
        ended = judge(candidate, model)
        spent += ended.cpu
        other = ended.verdict
        # what takes too long need not stop at the same step
        alike = other.signature == verdict.signature or other.kind in ("time", "memory", "no end")
        return alike and other.kind == verdict.kind

    return shrink(description, fails, most)
