"""What a draw came to, as lines of JSON that are summed up over the chunks of a campaign."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symgen.laboratory.zoo.verdict import VERIFIED

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


@dataclass(frozen=True)
class DrawRecord:
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


def write_record(path: Path, record: DataclassInstance) -> None:
    """Adds a line, of any record."""
    with path.open("a", encoding="utf-8") as lines:
        lines.write(json.dumps(asdict(record)) + "\n")


def read_records(paths: Iterable[Path]) -> list[DrawRecord]:
    """The records of some chunks; of a draw that was run twice the later one."""
    found: dict[tuple[int, int, str], DrawRecord] = {}
    for path in paths:
        for line in path.read_text(encoding="utf-8").splitlines():
            given: dict[str, Any] = json.loads(line)
            record = DrawRecord(**given)
            found[record.seed, record.index, record.family] = record
    return list(found.values())


def summary(records: list[DrawRecord]) -> str:
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
