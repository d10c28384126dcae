"""`python -m symgen.zoo`: draws, runs, judges."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from symgen.zoo.campaign import Campaign, judge, run_campaign, shrunk, usual_jobs
from symgen.zoo.cases import case_of, read_case
from symgen.zoo.describe import read_description
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
    parser.add_argument("--file", type=Path, help="judge this model file, and make it small where it fails")
    parser.add_argument("--sum", type=Path, nargs="*", help="sum up the records of earlier chunks and run nothing")
    given = parser.parse_args()
    if given.show:
        print(draw(given.seed, given.first, given.family).text, end="")
        return 0
    if given.file is not None:
        return _one_file(given.file, given.out, given.shrink)
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


def _one_file(path: Path, out: Path, runs: int) -> int:
    """Judges a model file or a stored case; where it fails and `runs` are given, prints the case that is left of it."""
    case = read_case(path)
    description = read_description(case.model, case.start)
    model = out / path.stem / f"{path.stem}.yaml"
    verdict = judge(description, model)[0]
    _tell(f"{path}: {verdict.ending} {verdict.kind} {verdict.signature}")
    if verdict.failed and runs:
        small = shrunk(description, verdict, model.with_name("small.yaml"), runs)
        print(case_of(small, verdict).text, end="")
    return int(verdict.failed)


def _tell(line: str) -> None:
    print(line, file=sys.stderr, flush=True)
