"""Many draws, each run and judged, one line of JSON for each; chunks of a campaign are summed up afterwards."""

from __future__ import annotations

import json
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from symgen.zoo.cases import case_of
from symgen.zoo.describe import Description
from symgen.zoo.families import draw
from symgen.zoo.run import run_command
from symgen.zoo.shrink import shrink
from symgen.zoo.verdict import FAILED, REFUSED, VERIFIED, Verdict, verdict_of, without_numbers
from symgen.zoo.witness import check

Tell = Callable[[str], None]


@dataclass(frozen=True)
class Record:
    """One draw: where it comes from, how it ended, what it took."""

    seed: int
    index: int
    family: str
    ending: str
    kind: str
    signature: str
    cpu: float
    megabytes: float
    file: str = ""

    @property
    def failed(self) -> bool:
        """Whether the draw did not end as it should."""
        return bool(self.kind)


def judge(description: Description, model: Path) -> tuple[Verdict, float, float]:
    """Writes the model file, runs the command beside it and looks at the numbers; verdict, CPU seconds, megabytes."""
    model.parent.mkdir(parents=True, exist_ok=True)
    model.write_text(description.text, encoding="utf-8")
    folder = model.with_suffix("")
    run = run_command(model, folder)
    verdict = verdict_of(run)
    if not verdict.failed and verdict.ending != REFUSED:
        checked = check(
            description.text, folder / str(description.blocks["model"]), description.start, description.text
        )
        for finding in checked.findings[:1]:
            verdict = Verdict(FAILED, finding.kind, without_numbers(finding.text))
            (folder / "stderr").write_text("\n".join(each.text for each in checked.findings) + "\n" + run.err)
        if not checked.states:
            verdict = replace(verdict, signature="no state to compare")
    return verdict, run.cpu, run.megabytes


def campaign(
    seed: int, indices: Iterable[int], folder: Path, seconds: float, family: str, shrinking: int, tell: Tell
) -> Iterator[Record]:
    """Draws until they or the seconds are used up; failing ones are made small in `shrinking` runs at most."""
    began = time.monotonic()
    for index in indices:
        if seconds and time.monotonic() - began > seconds:
            return
        description = draw(seed, index, family)
        model = folder / f"{seed}_{index}" / "zoo.yaml"
        verdict, cpu, megabytes = judge(description, model)
        record = Record(
            seed, index, description.family, verdict.ending, verdict.kind, verdict.signature, round(cpu, 1),
            round(megabytes), str(model) if verdict.failed else "",
        )  # fmt: skip
        if not verdict.failed:
            _remove(model)
        elif shrinking:
            small = shrunk(description, verdict, model.with_name("small.yaml"), tell, shrinking)
            case = case_of(small, verdict)
            model.with_name("case.yaml").write_text(case.text, encoding="utf-8")
        tell(f"{seed}:{index} {record.family}: {record.ending} {record.kind} {record.signature} ({record.cpu} s)")
        yield record


def shrunk(description: Description, verdict: Verdict, model: Path, tell: Tell, most: int) -> Description:
    """The draw made small, still with the same ending."""

    def fails(candidate: Description) -> bool:
        other = judge(candidate, model)[0]
        same = (other.kind, other.signature) == (verdict.kind, verdict.signature)
        if same:
            tell(f"  {len(candidate.text.splitlines())} lines, {len(candidate.start)} coordinates")
        # what takes too long need not stop at the same step
        return same or (verdict.kind == other.kind and verdict.kind in ("time", "memory", "no end"))

    return shrink(description, fails, most)


def _remove(model: Path) -> None:
    import shutil

    shutil.rmtree(model.parent, ignore_errors=True)


def write_record(path: Path, record: Record) -> None:
    """Adds a line."""
    with path.open("a", encoding="utf-8") as lines:
        lines.write(json.dumps(asdict(record)) + "\n")


def read_records(paths: Iterable[Path]) -> list[Record]:
    """The records of some chunks; of a draw that was run twice the later one."""
    found: dict[tuple[int, int, str], Record] = {}
    for path in paths:
        for line in path.read_text(encoding="utf-8").splitlines():
            given: dict[str, Any] = json.loads(line)
            record = Record(**given)
            found[record.seed, record.index, record.family] = record
    return list(found.values())


def summary(records: list[Record]) -> str:
    """Counts by family and ending, the failures by kind, the largest draws."""
    if not records:
        return "no draws"
    endings = [VERIFIED, *sorted({record.ending for record in records} - {VERIFIED})]
    families = sorted({record.family for record in records})
    table = Counter((record.family, record.ending) for record in records)
    wide = max(len(family) for family in families)
    lines = [f"{len(records)} draws"]
    for family in families:
        told = ", ".join(f"{table[family, ending]} {ending}" for ending in endings if table[family, ending])
        lines.append(f"  {family:{wide}}  {told}")
    failures = Counter((record.kind, record.signature) for record in records if record.failed)
    for (kind, signature), count in failures.most_common():
        lines.append(f"  {count} x {kind}: {signature}")
    slowest = max(records, key=lambda record: record.cpu)
    largest = max(records, key=lambda record: record.megabytes)
    lines.append(f"  most CPU time: {slowest.cpu} s ({slowest.seed}:{slowest.index} {slowest.family})")
    lines.append(f"  most memory: {largest.megabytes} MB ({largest.seed}:{largest.index} {largest.family})")
    return "\n".join(lines)
