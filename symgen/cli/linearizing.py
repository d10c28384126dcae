"""`symgen explain MODEL.yaml linearization`: a mechanism at rest as a linear system."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping
from pathlib import Path

from symgen.cli.arguments import two_weights, values
from symgen.cli.outcome import DONE, MODEL_WRONG
from symgen.generation.results import LINEARIZATION


def add_linearization(parser: argparse.ArgumentParser) -> None:
    """--start and --lqr."""
    parser.add_argument(
        "--start", metavar="x=1", type=values, default={}, help=f"{LINEARIZATION}: coordinates near which it rests"
    )
    parser.add_argument(
        "--lqr",
        metavar="Q,R",
        type=two_weights,
        help=f"{LINEARIZATION}: gains too, for weights of states and of inputs",
    )


def explain_linear_system(path: Path, start: Mapping[str, float], weights: tuple[float, float] | None) -> int:
    """Prints it; 0, or 1 where there is none.

    Raises ModelError for mistakes in the file, and WrongUseError for coordinates that the model does not have.
    """
    from symgen.linearization.linear_system import NotLinearizedError, linearized
    from symgen.linearization.regulator import regulator
    from symgen.linearization.text import linear_system_text
    from symgen.model.load import load_model

    model = load_model(path)
    try:
        system = linearized(model, start)
        held = None if weights is None else regulator(system, *weights)
    except NotLinearizedError as reason:
        print(f"{path}: {reason}", file=sys.stderr)
        return MODEL_WRONG
    print(linear_system_text(system, held))
    return DONE
