"""`python -m symgen.zoo`: draws, runs, judges."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from symgen.zoo.campaign import Campaign, run_campaign, usual_jobs
from symgen.zoo.families import FAMILIES, draw
from symgen.zoo.records import read_records, summary, write_record


def main() -> int:
    """Exit code 0 when every draw ended as it should."""
    parser = argparse.ArgumentParser(prog="python -m symgen.zoo", description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first draw")
    parser.add_argument("--draws", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=0, help="no new draw after so many seconds (0: no limit)")
    parser.add_argument("--jobs", type=int, default=usual_jobs(), help="draws at a time (default: one a processor)")
    parser.add_argument("--family", choices=sorted(FAMILIES), default="")
    parser.add_argument("--shrink", type=int, default=0, metavar="RUNS", help="make failing draws small")
    parser.add_argument("--out", type=Path, default=Path("build/zoo"))
    parser.add_argument("--show", action="store_true", help="print the model file of the first draw and run nothing")
    parser.add_argument("--sum", type=Path, nargs="*", help="sum up the records of earlier chunks and run nothing")
    given = parser.parse_args()
    if given.show:
        print(draw(given.seed, given.first, given.family).text, end="")
        return 0
    if given.sum is not None:
        records = read_records(given.sum)
        print(summary(records))
        return int(any(record.failed for record in records))
    given.out.mkdir(parents=True, exist_ok=True)
    path = given.out / f"{given.seed}_{given.first}.jsonl"
    path.unlink(missing_ok=True)
    campaign = Campaign(given.seed, given.out, given.family, given.shrink)
    indices = range(given.first, given.first + given.draws)
    records = []
    for record in run_campaign(campaign, indices, given.seconds, given.jobs, _tell):
        write_record(path, record)
        records.append(record)
    print(summary(records))
    return int(any(record.failed for record in records))


def _tell(line: str) -> None:
    print(line, file=sys.stderr, flush=True)
