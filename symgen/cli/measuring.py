"""The commands that measure models: bench, stress, target, simulate."""

from __future__ import annotations

import argparse
from pathlib import Path

from symgen.cli.arguments import (
    add_models,
    add_out,
    add_quiet,
    make_parser,
    not_negative,
    number_of_states,
    positive,
    two_weights,
    values,
)
from symgen.cli.command import Command
from symgen.cli.outcome import each_file
from symgen.terminal import Progress


def _bench_parser() -> argparse.ArgumentParser:
    """Run time against error of C and Python, beside other tools."""
    parser = make_parser("symgen bench", "Run time against error of C and Python, beside other tools on the same work.")
    add_models(parser)
    add_out(parser)
    parser.add_argument(
        "--states", metavar="N", type=number_of_states, default=1000, help="admissible states (default: 1000)"
    )
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument(
        "--bodies", action="store_true", help="u alone, beside peers that walk frames; for mechanisms of any size"
    )
    kind.add_argument(
        "--derivatives", action="store_true", help="the derivatives of u alone, beside those of CasADi and Pinocchio"
    )
    add_quiet(parser)
    return parser


def _bench(given: argparse.Namespace) -> int:
    def one(path: Path, progress: Progress) -> int:
        from symgen.laboratory.bench.command import run_bench, run_derivative_bench, run_mechanism_bench

        if given.derivatives:
            return run_derivative_bench(path, given.out, given.quiet, progress)
        if given.bodies:
            return run_mechanism_bench(path, given.out, given.quiet, progress)
        return run_bench(path, given.out, given.states, given.quiet, progress)

    return each_file(given.models, given.out, given.quiet, one)


def _stress_parser() -> argparse.ArgumentParser:
    """Errors near singularities, for extreme values and over a long run."""
    parser = make_parser(
        "symgen stress",
        "Errors towards singularities, for extreme values and units, in a long run.",
    )
    add_models(parser)
    add_out(parser)
    parser.add_argument(
        "--steps", metavar="N", type=int, default=1_000_000, help="steps of the long run, 0 for none (default: 1000000)"
    )
    add_quiet(parser)
    return parser


def _stress(given: argparse.Namespace) -> int:
    def one(path: Path, progress: Progress) -> int:
        from symgen.laboratory.stress.command import run_stress

        return run_stress(path, given.out, max(0, given.steps), given.quiet, progress)

    return each_file(given.models, given.out, given.quiet, one)


def _target_parser() -> argparse.ArgumentParser:
    """The C on emulated microcontrollers."""
    from symgen.laboratory.target.cores import BY_NAME

    parser = make_parser(
        "symgen target",
        "Runs the generated C on emulated cores: its bits, instructions, footprint.",
    )
    add_models(parser)
    cpus = (*BY_NAME, "all")
    parser.add_argument(
        "--cpu", metavar="CPU", choices=cpus, action="append", required=True, help=f"{', '.join(cpus)}; repeatable"
    )
    add_out(parser)
    add_quiet(parser)
    return parser


def _target(given: argparse.Namespace) -> int:
    from symgen.laboratory.target.cores import CORES

    cores = [core for core in CORES if core.name in given.cpu or "all" in given.cpu]

    def one(path: Path, progress: Progress) -> int:
        from symgen.laboratory.target.command import run_target

        return run_target(path, given.out, cores, given.quiet, progress)

    return each_file(given.models, given.out, given.quiet, one)


def _simulate_parser() -> argparse.ArgumentParser:
    """Motion from a consistent start."""
    parser = make_parser("symgen simulate", "Integrates a model from a consistent start: CSV, chart and animation.")
    add_models(parser)
    parser.add_argument("--duration", metavar="S", type=positive, default=5.0, help="seconds (default: 5)")
    parser.add_argument("--frames", metavar="N", type=int, help="frames a second (default: 50, with --track 200)")
    parser.add_argument(
        "--start", metavar="x=1,x_dot=2", type=values, default={}, help="coordinates and rates at the start"
    )
    parser.add_argument("--inputs", metavar="u=1", type=values, default={}, help="constant inputs (default: 0)")
    _add_tracking(parser)
    add_out(parser)
    add_quiet(parser)
    return parser


def _simulate(given: argparse.Namespace) -> int:
    if given.track is not None:
        return _track(given)

    def one(path: Path, progress: Progress) -> int:
        from symgen.simulate.command import run_simulate
        from symgen.simulate.simulation import Request

        request = Request(given.duration, max(1, given.frames or 50), given.start, given.inputs)
        return run_simulate(path, given.out, request, given.quiet, progress)

    return each_file(given.models, given.out, given.quiet, one)


def _add_tracking(parser: argparse.ArgumentParser) -> None:
    from symgen.simulate.controllers import CONTROLLERS

    group = parser.add_argument_group("under control")
    add = group.add_argument
    add("--track", metavar="PATH", help="follows a path of the model, from where it begins or from --start")
    add("--controller", choices=CONTROLLERS, default=CONTROLLERS[0], help=f"(default: {CONTROLLERS[0]})")
    add("--bandwidth", metavar="W", type=positive, default=30.0, help="rad/s with which errors decay (default: 30)")
    add("--lqr", metavar="Q,R", type=two_weights, default=(1.0, 0.1), help="weights of states, inputs (default: 1,0.1)")
    add("--sample", metavar="S", type=positive, default=1e-3, help="seconds between samples (default: 0.001)")
    add("--delay", metavar="S", type=not_negative, default=0.0, help="seconds until inputs act (default: 0)")
    add("--resolution", metavar="R", type=not_negative, default=0.0, help="step of the encoders (default: none)")
    add("--noise", metavar="N", type=not_negative, default=0.0, help="standard deviation of measured coordinates")
    add("--input-noise", metavar="N", type=not_negative, default=0.0, help="standard deviation of inputs in the log")
    add("--machine", metavar="m=1.2", type=values, default={}, help="parameters that the controller does not know")


def _track(given: argparse.Namespace) -> int:
    def one(path: Path, progress: Progress) -> int:
        from symgen.simulate.command import run_tracking
        from symgen.simulate.tracking import ControlLoop

        loop = ControlLoop(
            given.track, given.controller, given.bandwidth, given.lqr, given.sample, given.delay, given.resolution,
            given.noise, given.machine, given.input_noise,
        )  # fmt: skip
        return run_tracking(path, given.out, loop, max(1, given.frames or 200), given.start, given.quiet, progress)

    return each_file(given.models, given.out, given.quiet, one)


BENCH = Command(_bench_parser, _bench)
STRESS = Command(_stress_parser, _stress)
TARGET = Command(_target_parser, _target)
SIMULATE = Command(_simulate_parser, _simulate)
