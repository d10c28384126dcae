"""`python -m symgen.laboratory.zoo`: draws, runs, judges."""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections import Counter
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

from symgen.laboratory.zoo.campaign import Campaign, judge, one_draw, run_campaign, shrunk, usual_jobs
from symgen.laboratory.zoo.cases import case_of, read_case
from symgen.laboratory.zoo.draws.describe import Description, read_description
from symgen.laboratory.zoo.draws.families import FAMILIES, draw
from symgen.laboratory.zoo.features import ALL, features
from symgen.laboratory.zoo.records import read_records, summary, write_record
from symgen.laboratory.zoo.sweep_campaign import one_sweep, table

# how many runs a failing draw is made small in at most, unless another number is given
RUNS = 80


def main() -> int:
    """Exit code 0 when every draw ended as it should."""
    parser = argparse.ArgumentParser(prog="python -m symgen.laboratory.zoo", description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first draw")
    parser.add_argument("--draws", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=0, help="no new draw after so many seconds (0: no limit)")
    parser.add_argument("--jobs", type=int, default=usual_jobs(), help="draws at a time (default: one a processor)")
    parser.add_argument("--family", choices=sorted(FAMILIES), default="")
    parser.add_argument(
        "--shrink", type=int, default=RUNS, metavar="RUNS", help="make failing draws small in so many runs (0: do not)"
    )
    parser.add_argument(
        "--cases", type=Path, metavar="FOLDER", help="where small failing draws are kept (default: beside the draws)"
    )
    parser.add_argument("--out", type=Path, default=Path("build/zoo"))
    parser.add_argument("--show", action="store_true", help="print the model file of the first draw and run nothing")
    parser.add_argument("--count", action="store_true", help="count what the draws have, and run nothing")
    parser.add_argument("--file", type=Path, help="judge this model file, and make it small where it fails")
    parser.add_argument(
        "--store", type=Path, metavar="CASE", help="make the first draw, or the file, small and keep it"
    )
    parser.add_argument("--sum", type=Path, nargs="*", help="sum up the records of earlier chunks and run nothing")
    parser.add_argument(
        "--sweeps", action="store_true", help="the rule of statuses beside singular sets and with far apart parameters"
    )
    given = parser.parse_args()
    if given.show:
        print(draw(given.seed, given.first, given.family).text, end="")
        return 0
    if given.count:
        return _count(given.seed, range(given.first, given.first + given.draws), given.family)
    if given.file is not None:
        case = read_case(given.file)
        description = replace(read_description(case.model, case.start), options=case.options)
        return _one(description, given.file.stem, given)
    if given.store is not None:
        return _one(draw(given.seed, given.first, given.family), f"{given.seed}_{given.first}", given)
    if given.sum is not None:
        records = read_records(given.sum)
        print(summary(records))
        return int(any(record.failed for record in records))
    given.out.mkdir(parents=True, exist_ok=True)
    path = given.out / f"{given.seed}_{given.first}.jsonl"
    path.unlink(missing_ok=True)
    if find_spec("pinocchio") is None:
        _show("Pinocchio is not installed (`make robots`): trees are compared with the zoo's own witness alone")
        if os.environ.get("SYMGEN_REQUIRE_TOOLS"):
            return 1
    campaign = Campaign(given.seed, given.out, given.family, given.shrink, given.cases)
    indices = range(given.first, given.first + given.draws)
    if given.sweeps:
        return _sweep(campaign, indices, path, given)
    began = time.monotonic()
    records = []
    for record in run_campaign(one_draw, campaign, indices, given.seconds, given.jobs, _show):
        write_record(path, record)
        records.append(record)
    print(summary(records))
    print(f"  {60 * len(records) / (time.monotonic() - began):.1f} draws a minute")
    return int(any(record.failed for record in records))


def _sweep(campaign: Campaign, indices: range, path: Path, given: argparse.Namespace) -> int:
    """Sweeps the draws and prints the totals; 1 where one of them violates the rule of statuses."""
    records = []
    for record in run_campaign(one_sweep, campaign, indices, given.seconds, given.jobs, _show):
        write_record(path, record)
        records.append(record)
    print(table(records))
    return int(any(record.violations for record in records))


def _one(description: Description, name: str, given: argparse.Namespace) -> int:
    """Judges one system; where it fails it is made small, and stored or printed as a case."""
    model = given.out / name / f"{name}.yaml"
    verdict = judge(description, model).verdict
    _show(f"{name}: {verdict.ending} {verdict.kind} {verdict.signature}")
    if verdict.failed and given.shrink:
        case = case_of(shrunk(description, verdict, model.with_name("small.yaml"), given.shrink), verdict)
        if given.store:
            given.store.write_text(case.text, encoding="utf-8")
        else:
            print(case.text, end="")
    return int(verdict.failed)


def _count(seed: int, indices: range, family: str) -> int:
    """Prints how often each feature is drawn; 1 where one is not."""
    count = Counter(feature for index in indices for feature in features(draw(seed, index, family)))
    for feature in ALL:
        print(f"{count[feature]:6d}  {feature}")
    return int(any(not count[feature] for feature in ALL))


def _show(line: str) -> None:
    print(line, file=sys.stderr, flush=True)
