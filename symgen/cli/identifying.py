"""Which combinations of inertial parameters count, what a log of the machine says of them, and how it should move."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from symgen.cli.arguments import add_out, add_quiet, make_parser, positive, seed
from symgen.cli.command import Command
from symgen.cli.outcome import DONE, MODEL_WRONG, each_file
from symgen.generation.results import WrongUseError
from symgen.terminal import Progress


def explain_base_parameters(path: Path) -> int:
    """Prints them; 0, or 1 where there are none.  Raises ModelError for mistakes in the file."""
    from symgen.identification.text import base_parameters_text
    from symgen.model.combinations.base_parameters import NoBodiesError, base_parameters
    from symgen.model.combinations.motion_states import NoMotionError
    from symgen.model.load import load_model

    model = load_model(path)
    try:
        text = base_parameters_text(base_parameters(model))
    except NoBodiesError:
        print(f"{path}: base parameters are those of `bodies`, of which the model has none", file=sys.stderr)
        return MODEL_WRONG
    except NoMotionError:
        print(f"{path}: no regular motion was found at which parameters could be told apart", file=sys.stderr)
        return MODEL_WRONG
    print(text)
    return DONE


def _identify_parser() -> argparse.ArgumentParser:
    parser = make_parser(
        "symgen identify",
        "Masses, inertias and friction of a machine from a log of its motion: estimates,\n"
        "a report, and the model file with them.",
        _LOG_FORMAT,
    )
    parser.add_argument("model", metavar="MODEL.yaml", type=Path, help="model file, in bodies form")
    parser.add_argument("log", metavar="LOG.csv", type=Path, help="samples of a motion")
    parser.add_argument(
        "--cutoff", metavar="HZ", type=positive, help="of the low-pass (default: 5 times what the motion has)"
    )
    parser.add_argument(
        "--whole-bodies",
        action="store_true",
        help="write masses, centres and inertias of all bodies, such as can be, as numbers into the model file",
    )
    add_out(parser)
    add_quiet(parser)
    return parser


def _identify(given: argparse.Namespace) -> int:
    if not given.log.is_file():
        raise WrongUseError(f"no such file: {given.log}")

    def one(path: Path, progress: Progress) -> int:
        from symgen.identification.estimates.command import IdentifyRequest, run_identify

        request = IdentifyRequest(given.cutoff, given.whole_bodies)
        return run_identify(path, given.log, given.out, request, given.quiet, progress)

    return each_file([given.model], given.out, given.quiet, one)


_LOG_FORMAT = """the log: a line of names, then a line for each sample, at equal steps of time
  t                  time in s
  x                  measured coordinates, by their names in the model
  x_dot, x_ddot      rates and accelerations, where they are measured
  u                  every input, by its name in the model
  a unit may stand behind a name in brackets, as in `a_1 [rad]`
"""
IDENTIFY = Command(_identify_parser, _identify)


def _excite_parser() -> argparse.ArgumentParser:
    parser = make_parser(
        "symgen excite",
        "A motion to identify by: a Fourier series within ranges, limits of drives and a\n"
        "distance from singularities, of the smallest condition number: CSV, chart, path.",
    )
    parser.add_argument("model", metavar="MODEL.yaml", type=Path, help="model file, in bodies form")
    parser.add_argument("--period", metavar="S", type=positive, default=5.0, help="seconds (default: 5)")
    parser.add_argument(
        "--distance",
        metavar="D",
        type=positive,
        help="from singularities at least, 0 to 1 (default: half of what the configuration of the model has)",
    )
    parser.add_argument("--seed", metavar="N", type=seed, default=0, help="of the motions that are drawn (default: 0)")
    add_out(parser)
    add_quiet(parser)
    return parser


def _excite(given: argparse.Namespace) -> int:
    def one(path: Path, progress: Progress) -> int:
        from symgen.identification.excitation.command import run_excite
        from symgen.identification.excitation.excitation import ExcitationRequest

        request = ExcitationRequest(given.period, given.distance, given.seed)
        return run_excite(path, given.out, request, given.quiet, progress)

    return each_file([given.model], given.out, given.quiet, one)


EXCITE = Command(_excite_parser, _excite)
