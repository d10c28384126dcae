"""What `symgen target` measured, read back for the report, and only if it was measured on the same C."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from symgen.records import dataclass

FAST, SMALL = "-O2", "-Os"


@dataclass(frozen=True, slots=True)
class TargetRow:
    """One kernel in one scalar type: instructions per call (fewest, most) at a level, bytes at -Os."""

    kernel: str
    scalar: str
    level: str
    fewest: int
    most: int
    code: int
    linked: int
    stack: int


@dataclass(frozen=True, slots=True)
class TargetCore:
    """One core, how many builds for it gave the same bits as the host, and what the kernels cost there."""

    name: str
    same_bits: int
    rows: tuple[TargetRow, ...]


def read_targets(file: Path, sources: Mapping[str, str | bytes]) -> tuple[TargetCore, ...]:
    """The cores in a target.json that passed; none where it is missing, failed, damaged or of other C.

    `sources` are the generated files by path (`c/<model>.c`, ...).
    """
    try:
        record = json.loads(file.read_text(encoding="utf-8"))
        measured: Mapping[str, str] = record["sources"]
        same = all(checksum(sources.get(f"c/{name}")) == expected for name, expected in measured.items())
        if not (record["passed"] and measured and same):
            return ()
        return tuple(_core(core, record["cells"]) for core in record["cores"])
    except (OSError, ValueError, KeyError, TypeError):
        return ()


def _core(core: Mapping[str, Any], cells: list[Mapping[str, Any]]) -> TargetCore:
    same = sum(c["where"] == core["name"] and c["trig"] == "portable" and c["different"] == 0 for c in cells)
    fast = {(c["kernel"], c["scalar"]): c for c in core["costs"] if c["level"] == FAST}
    rows = []
    for small in core["costs"]:
        if small["level"] == SMALL and small["calls"]:
            cost = fast.get((small["kernel"], small["scalar"]), small)
            size = small["footprint"]
            numbers = (cost["fewest"], cost["most"], size["code"], size["linked"], small["stack"])
            rows.append(TargetRow(small["kernel"], small["scalar"], cost["level"], *map(int, numbers)))
    return TargetCore(str(core["name"]), same, tuple(rows))


def checksum(content: str | bytes | None) -> str:
    """The checksum by which a measurement names a generated file; empty where there is no such file."""
    if content is None:
        return ""
    return hashlib.sha256(content.encode() if isinstance(content, str) else content).hexdigest()
