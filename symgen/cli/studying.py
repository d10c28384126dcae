"""`symgen study`: quantities of a model over ranges of its parameters and places."""

from __future__ import annotations

import argparse
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from symgen.cli.arguments import add_out, add_quiet, make_parser, names
from symgen.cli.command import Command
from symgen.cli.outcome import check_present, check_writable, guarded
from symgen.generation.packages import to_install
from symgen.generation.results import WrongUseError
from symgen.terminal import Progress

if TYPE_CHECKING:
    from symgen.study.asked.request import StudyMistakes, StudyRequest

# What a study needs beside what generates; charts along paths need CasADi, Sobol's points SciPy.
_NEEDED = ("dask", "distributed", "xarray", "zarr", "casadi", "scipy", "matplotlib")
# Options that a study file has in their place.
_IN_FILE = ("over", "along", "show", "sample", "count", "seed", "quantiles", "size")
_EPILOG = """examples:
  symgen study robot.yaml --over l_1=0.2:0.5:31 --over m=0:5:11 \\
      --along circle --show utilisation
  symgen study robot.yaml --over x=0.1:0.3:81 --over y=0:0.2:81 --show reach
  symgen study STUDY.yaml --workers 2
"""


def _study_parser() -> argparse.ArgumentParser:
    """Options of studies."""
    parser = make_parser(
        "symgen study", "Quantities of a model over ranges of parameters and places: Zarr and pictures.", _EPILOG
    )
    add = parser.add_argument
    add("file", metavar="MODEL.yaml", type=Path, help="model file, or a study file that names one")
    add(
        "--over", metavar="NAME=A:B:N", action="append", default=[],
        help="N values from A to B of a parameter, a coordinate or the task (A:B in samples); repeatable",
    )  # fmt: skip
    add(
        "--along", metavar="PATH", action="append", default=[],
        help="states that are reduced at each point: those of a path of the model, or ranges as above",
    )  # fmt: skip
    add(
        "--show", metavar="NAMES", type=names,
        help="of inputs, power, sensitivity, float32, singularity, control, utilisation, reach, modes, regular; "
        "with commas",
    )  # fmt: skip
    add("--sample", metavar="KIND", help="grid, random, latin_hypercube or sobol (default: grid)")
    add("--count", metavar="N", type=int, help="points of a sample that is no grid")
    add("--seed", metavar="N", type=int, help="which of the samples it is (default: 0)")
    add("--quantiles", metavar="P,P", type=names, help="levels between 0 and 1, along the states of each point")
    add("--size", metavar="CATALOGUE.csv", type=Path, help="motors, of which those are listed that fit each drive")
    add("--workers", metavar="N", type=_workers, help="processes of a local cluster (default: threads)")
    add("--scheduler", metavar="ADDRESS", help="a Dask cluster that exists, whose workers see the same files")
    add("--yes", action="store_true", help="run more than 10^9 states")
    add_out(parser)
    add_quiet(parser)
    return parser


def _workers(text: str) -> int:
    """A whole number from 1 up."""
    count = int(text) if text.isdecimal() else 0
    if count < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number from 1 up")
    return count


def _study(given: argparse.Namespace) -> int:
    check_present([given.file, *([] if given.size is None else [given.size])])
    check_writable(given.out)
    if given.workers is not None and given.scheduler is not None:
        raise WrongUseError("--workers and --scheduler are two clusters: name one of them")
    if lacking := [name for name in _NEEDED if find_spec(name) is None]:
        raise WrongUseError(to_install(lacking, "a study"))
    progress = Progress(given.file.stem, given.quiet)

    def study() -> int:
        from symgen.study.command import StudyRun, run_study

        request, mistakes = _request(given)
        run = StudyRun(given.out, given.workers, given.scheduler, given.yes, given.quiet)
        return run_study(request, mistakes, run, progress)

    try:
        return guarded(study)
    finally:
        progress.done()


def _request(given: argparse.Namespace) -> tuple[StudyRequest, StudyMistakes]:
    """From a study file, or from options."""
    from symgen.study.asked.options import request_of
    from symgen.study.asked.study_file import is_study, read_study

    text = given.file.read_text(encoding="utf-8-sig", errors="replace")
    if not is_study(text):
        return request_of(
            given.file, given.over, given.along, given.show or (), given.sample, given.count, given.seed,
            given.quantiles or (), given.size,
        )  # fmt: skip
    if named := [name for name in _IN_FILE if getattr(given, name) not in (None, [])]:
        raise WrongUseError(f"--{named[0]}: {given.file} is a study file, which says that; change it there")
    return read_study(given.file, text)


STUDY = Command(_study_parser, _study)
