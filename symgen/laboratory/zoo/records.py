"""What a draw came to, as lines of JSON that are summed up over the chunks of a campaign."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symgen.laboratory.zoo.verdict import VERIFIED
from symgen.laboratory.zoo.witness.coverage import Coverage, coverage_of
from symgen.laboratory.zoo.witness.witness import STATES

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

# quantities whose methods are counted
CHOSEN = (
    "inverse_dynamics", "forward_dynamics", "multipliers", "nullspace_projector", "weighted_pseudoinverse",
    "weighted_nullspace_projector",
)  # fmt: skip
SYMBOLS = {"inverse_dynamics": "u", "forward_dynamics": "q̈", "multipliers": "λ"}


@dataclass(frozen=True)
class DrawRecord:
    """One draw: where it comes from, how it ended, what it took, what of it was compared (None: nothing was), and by
    which methods it computes what."""

    seed: int
    index: int
    family: str
    ending: str
    kind: str
    signature: str
    cpu: float
    megabytes: float
    file: str = ""
    compared: Coverage | None = None
    methods: Mapping[str, str] = field(default_factory=dict)

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
    by_draw: dict[tuple[int, int, str], DrawRecord] = {}
    for path in paths:
        for line in path.read_text(encoding="utf-8").splitlines():
            given: dict[str, Any] = json.loads(line)
            compared = given.pop("compared", None)
            record = DrawRecord(**given, compared=coverage_of(compared) if compared else None)
            by_draw[record.seed, record.index, record.family] = record
    return list(by_draw.values())


def summary(records: list[DrawRecord]) -> str:
    """Counts by family and ending, the failures by kind, how much was compared, the largest draws."""
    if not records:
        return "no draws"
    endings = [VERIFIED, *sorted({record.ending for record in records} - {VERIFIED})]
    families = sorted({record.family for record in records})
    table = Counter((record.family, record.ending) for record in records)
    wide = max(len(family) for family in families)
    lines = [f"{len(records)} draws"]
    for family in families:
        counts = ", ".join(f"{table[family, ending]} {ending}" for ending in endings if table[family, ending])
        lines.append(f"  {family:{wide}}  {counts}")
    failures = Counter((record.kind, record.signature) for record in records if record.failed)
    for (kind, signature), count in failures.most_common():
        lines.append(f"  {count} x {kind}: {signature}")
    lines += [f"  {line}" for line in (*_compared(records), *_methods(records))]
    slowest = max(records, key=lambda record: record.cpu)
    largest = max(records, key=lambda record: record.megabytes)
    lines.append(f"  most CPU time: {slowest.cpu} s ({slowest.seed}:{slowest.index} {slowest.family})")
    lines.append(f"  most memory: {largest.megabytes} MB ({largest.seed}:{largest.index} {largest.family})")
    return "\n".join(lines)


def methods_of(derivation: Mapping[str, Any]) -> dict[str, str]:
    """By quantity, the method that its derivation.json names."""
    kernels = derivation.get("kernels", {})
    return {name: kernels[name]["method"] for name in CHOSEN if name in kernels}


def _methods(records: list[DrawRecord]) -> Iterator[str]:
    """How many draws take which method of a quantity."""
    for name in CHOSEN:
        counts = Counter(record.methods[name] for record in records if name in record.methods)
        if counts:
            yield f"{name}: {', '.join(f'{method} {count}' for method, count in counts.most_common())}"


def _compared(records: list[DrawRecord]) -> Iterator[str]:
    """At how many states, which quantities, and what was passed over; records of earlier versions say nothing."""
    known = [record.compared for record in records if record.compared is not None]
    none, fewer = ([each for each in known if low <= each.states < high] for low, high in ((0, 1), (1, STATES)))
    phrases = [f"{len(known)} draws compared: {len(known) - len(none) - len(fewer)} at {STATES} states"]
    for draws, how in ((fewer, "at fewer"), (none, "at none")):
        reasons = Counter(each.lack for each in draws)
        why = f" ({', '.join(f'{count} x {lack}' for lack, count in reasons.most_common())})" if draws else ""
        phrases.append(f"{len(draws)} {how}{why}")
    yield ", ".join(phrases)
    for name, symbol in SYMBOLS.items():
        compared, missing = (
            sum(name in names for names in which)
            for which in ([each.quantities for each in known], [each.missing for each in known])
        )
        yield f"{symbol} compared in {compared} draws, there but not compared in {missing}"
    results = sum(each.numbers for each in known)
    statuses = [each for each in known if each.statuses]
    float64, float32 = (sum(getattr(each, f"statuses_{scalar}") for each in known) for scalar in ("float64", "float32"))
    clearest = max((each.clearest for each in statuses), default=0.0)
    phrases = [
        f"{results} results compared",
        f"{sum(each.unknown for each in known)} without truth",
        f"passed over {float64} statuses of float64 and {float32} of float32 in {len(statuses)} draws "
        f"(states determine them to {clearest:.1e} at best)",
    ]
    yield ", ".join(phrases)
    trees = [each.pinocchio for each in known if each.pinocchio]
    yield f"{sum(trees)} results of {len(trees)} draws beside Pinocchio's"
