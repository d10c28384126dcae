"""What `make proof` found about u in float32, read back for the report, and only if it was found for the same C."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from symgen.records import dataclass
from symgen.report.targets import checksum


@dataclass(frozen=True, slots=True)
class ProofFacts:
    """Alarms of Eva (or why there is no number), and by entry of u Gappa's bound beside the measured error.

    `others` is what remains where it is no denominator.
    """

    unproven: str
    without: str
    rounding: tuple[tuple[int, float, float], ...]
    denominators: tuple[str, ...]
    others: tuple[str, ...]


def read_proof(file: Path, sources: Mapping[str, str | bytes]) -> ProofFacts | None:
    """What a proof.json tells; None where it is missing, damaged or of other C.

    `sources` are the generated files by path (`c/<model>.c`, ...).
    """
    try:
        record: Mapping[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        proved: Mapping[str, str] = record["sources"]
        if not proved or any(checksum(sources.get(f"c/{name}")) != expected for name, expected in proved.items()):
            return None
        measured = record["measured"]
        return ProofFacts(
            str(record["unproven"]),
            str(record["without"]),
            tuple((int(entry), float(bound), float(measured[entry])) for entry, bound in record["bounds"].items()),
            tuple(map(str, record["denominators"])),
            tuple(map(str, record["others"])),
        )
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None

