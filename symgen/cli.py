"""The command line: `symgen MODEL.yaml...` and the commands verify, explain, schema."""

from __future__ import annotations

import argparse
import gc
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Sequence
from functools import partial
from io import StringIO, TextIOWrapper
from pathlib import Path
from types import FrameType

from symgen import __version__
from symgen.diagnostics import ModelError, SymgenBug
from symgen.ir.kernel import Scalar
from symgen.results import DEFAULT_STATES, FORMS, PARTS, TRIG, Options, Part, Result, WrongUseError
from symgen.terminal import SPELLED, Progress, notice_line, summary_table

DONE, MODEL_WRONG, WRONG_USE = 0, 1, 2
INTERRUPTED, READER_GONE, TERMINATED = 130, 141, 143  # as a shell reports these signals
_SCALARS: dict[str, tuple[Scalar, ...]] = {
    "float64": ("float64",),
    "float32": ("float32",),
    "both": ("float64", "float32"),
}
_EPILOG = """commands:
  symgen MODEL.yaml...              generate and verify
  symgen verify MODEL.yaml          verify again, write the certificate only
  symgen bench MODEL.yaml...        run time against error, beside other tools
  symgen stress MODEL.yaml...       errors near singularities, extreme values, a long run
  symgen target MODEL.yaml --cpu C  instructions, bytes and bits on emulated microcontrollers
  symgen simulate MODEL.yaml        integrates: CSV, chart, animation of frames and points
  symgen new NAME                   a commented model to start from
  symgen explain MODEL.yaml [NAME]  closed forms and structure in the terminal
  symgen schema                     JSON Schema of model files, for editors

examples:
  symgen models/front_car.yaml
  symgen models/*.yaml --out build/symgen --quiet
  symgen models/front_car.yaml --outputs inverse_dynamics,forward_dynamics --scalar float32 --only c
  symgen models/*.yaml --check
  symgen explain models/front_car.yaml nullspace_projector

exit codes: 0 done, 1 the model or its verification is wrong, 2 wrong use or a fault of symgen
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command line and returns the exit code."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    if arguments is None:
        # large graphs live until the end of a command: looking for cycles in them costs a twentieth of its time
        gc.disable()
    _prepare_streams()
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, _terminated)
    command, rest = (given[0], given[1:]) if given and given[0] in _COMMANDS else ("", given)
    try:
        code = _COMMANDS[command](rest) if command else _generate(rest)
        sys.stdout.flush()
        if arguments is None:
            # the interpreter looks for cycles once more at its end, to free what the process gives back anyway
            gc.freeze()
        return code
    except KeyboardInterrupt:
        print("\ninterrupted; earlier output is unchanged", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # no second complaint at exit
        return READER_GONE
    except WrongUseError as error:
        return _complain(str(error))
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        return _complain(f"{place}{error.strerror or error}")


def _prepare_streams() -> None:
    """Output may be closed, and a terminal may lack characters: neither is a reason to fail."""
    sys.stdout, sys.stderr = sys.stdout or StringIO(), sys.stderr or StringIO()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors=SPELLED)


def _terminated(_signal: int, _frame: FrameType | None) -> None:
    """Leaves as after any error, so that compilers, processes and temporary folders go too."""
    raise SystemExit(TERMINATED)


def _complain(message: str) -> int:
    print(f"symgen: {message}", file=sys.stderr)
    return WRONG_USE


def _generate(arguments: list[str]) -> int:
    parser = _parser("symgen", "Verified, globally valid inverse dynamics of constrained mechanical systems.", _EPILOG)
    parser.add_argument("models", metavar="MODEL.yaml", type=Path, nargs="+", help="model files")
    _add_generation_options(parser)
    parser.add_argument("--outputs", metavar="A,B", type=_names, help="quantities, or all (default: the model's list)")
    parser.add_argument(
        "--scalar", choices=tuple(_SCALARS), default="both", help="scalar types of the C (default: both)"
    )
    parser.add_argument("--only", metavar="PARTS", type=_parts, default=PARTS, help="of c,python,report,package,proof")
    parser.add_argument("--no-verify", dest="verify", action="store_false", help="write without verification")
    parser.add_argument(
        "--check",
        action="store_true",
        help="write nothing; exit 1 and list what differs from the disk (no verification)",
    )
    parser.add_argument("--version", action="version", version=f"symgen {__version__}")
    given = parser.parse_args(arguments)
    options = Options(
        outputs=given.outputs,
        scalars=_SCALARS[given.scalar],
        parts=given.only,
        verify=given.verify and not given.check,
        states=given.states,
        form=given.form,
        trig=given.trig,
        measured=given.out,
    )
    finish = _check_files if given.check else _write_files
    return _each_model(given.models, options, given.quiet, lambda result: finish(result, given.out, given.quiet))


def _verify(arguments: list[str]) -> int:
    parser = _parser(
        "symgen verify", "Compiles the C, runs C and Python against the reference, writes the certificate."
    )
    parser.add_argument("models", metavar="MODEL.yaml", type=Path, nargs="+", help="model files")
    _add_generation_options(parser)
    given = parser.parse_args(arguments)
    from symgen.verify.compile import find_compiler

    if find_compiler() is None:
        raise WrongUseError("no C compiler was found: install gcc or clang, or name one in CC")
    options = Options(parts=("c", "python"), states=given.states, form=given.form, trig=given.trig)
    return _each_model(
        given.models, options, given.quiet, lambda result: _write_certificate(result, given.out, given.quiet)
    )


def _explain(arguments: list[str]) -> int:
    parser = _parser("symgen explain", "Closed forms, structure, and what is skipped and why.")
    parser.add_argument("model", metavar="MODEL.yaml", type=Path, help="model file")
    parser.add_argument("quantity", metavar="QUANTITY", nargs="?", help="one quantity (default: an overview)")
    _add_form(parser)
    given = parser.parse_args(arguments)

    if not given.model.is_file():
        raise WrongUseError(f"no such file: {given.model}")

    def explain() -> int:
        from symgen.pipeline import explain

        progress = Progress(given.model.stem, quiet=not sys.stderr.isatty())
        text = explain(given.model, given.quantity, progress, given.form)
        progress.done()
        print(text)
        return DONE

    return _guarded(explain)


def _schema(arguments: list[str]) -> int:
    _parser("symgen schema", "Prints the JSON Schema of model files.").parse_args(arguments)
    import json

    from symgen.model.schema import json_schema

    print(json.dumps(json_schema(), indent=2, ensure_ascii=False))
    return DONE


def _bench(arguments: list[str]) -> int:
    parser = _parser("symgen bench", "Run time against error of C and Python, beside other tools on the same work.")
    parser.add_argument("models", metavar="MODEL.yaml", type=Path, nargs="+", help="model files")
    parser.add_argument(
        "--out", metavar="DIR", type=Path, default=Path("generated"), help="writes DIR/<model>/ (default: generated)"
    )
    parser.add_argument(
        "--states", metavar="N", type=_states, default=1000, help="admissible states (default: 1000)"
    )
    parser.add_argument("--quiet", action="store_true", help="print mistakes and failures only")
    given = parser.parse_args(arguments)

    def one(path: Path, progress: Progress) -> int:
        from symgen.bench.command import run_bench

        return run_bench(path, given.out, given.states, given.quiet, progress)

    return _each_file(given.models, given.quiet, one)


def _stress(arguments: list[str]) -> int:
    parser = _parser(
        "symgen stress",
        "Errors against the distance to singularities and for extreme values, statuses, other units, a long run.",
    )
    parser.add_argument("models", metavar="MODEL.yaml", type=Path, nargs="+", help="model files")
    parser.add_argument(
        "--out", metavar="DIR", type=Path, default=Path("generated"), help="writes DIR/<model>/ (default: generated)"
    )
    parser.add_argument(
        "--steps", metavar="N", type=int, default=1_000_000, help="steps of the long run, 0 for none (default: 1000000)"
    )
    parser.add_argument("--quiet", action="store_true", help="print mistakes and failures only")
    given = parser.parse_args(arguments)

    def one(path: Path, progress: Progress) -> int:
        from symgen.stress.command import run_stress

        return run_stress(path, given.out, max(0, given.steps), given.quiet, progress)

    return _each_file(given.models, given.quiet, one)


def _target(arguments: list[str]) -> int:
    from symgen.target.cores import BY_NAME, CORES

    parser = _parser(
        "symgen target",
        "Runs the generated C on emulated microcontrollers: the same bits as here, instructions per call, footprint.",
    )
    parser.add_argument("models", metavar="MODEL.yaml", type=Path, nargs="+", help="model files")
    cpus = (*BY_NAME, "all")
    parser.add_argument(
        "--cpu", metavar="CPU", choices=cpus, action="append", required=True, help=f"{', '.join(cpus)}; repeatable"
    )
    parser.add_argument(
        "--out", metavar="DIR", type=Path, default=Path("generated"), help="writes DIR/<model>/ (default: generated)"
    )
    parser.add_argument("--quiet", action="store_true", help="print mistakes and failures only")
    given = parser.parse_args(arguments)
    cores = [core for core in CORES if core.name in given.cpu or "all" in given.cpu]

    def one(path: Path, progress: Progress) -> int:
        from symgen.target.command import run_target

        return run_target(path, given.out, cores, given.quiet, progress)

    return _each_file(given.models, given.quiet, one)


def _simulate(arguments: list[str]) -> int:
    parser = _parser("symgen simulate", "Integrates a model from a consistent start: CSV, chart and animation.")
    parser.add_argument("models", metavar="MODEL.yaml", type=Path, nargs="+", help="model files")
    parser.add_argument("--duration", metavar="S", type=_positive, default=5.0, help="seconds (default: 5)")
    parser.add_argument("--frames", metavar="N", type=int, default=50, help="frames a second (default: 50)")
    parser.add_argument(
        "--start", metavar="x=1,x_dot=2", type=_values, default={}, help="coordinates and rates at the start"
    )
    parser.add_argument("--inputs", metavar="u=1", type=_values, default={}, help="constant inputs (default: 0)")
    parser.add_argument(
        "--out", metavar="DIR", type=Path, default=Path("generated"), help="writes DIR/<model>/ (default: generated)"
    )
    parser.add_argument("--quiet", action="store_true", help="print mistakes and failures only")
    given = parser.parse_args(arguments)

    def one(path: Path, progress: Progress) -> int:
        from symgen.simulate.command import Request, run_simulate

        request = Request(given.duration, max(1, given.frames), given.start, given.inputs)
        return run_simulate(path, given.out, request, given.quiet, progress)

    return _each_file(given.models, given.quiet, one)


def _positive(text: str) -> float:
    value = float(text)
    if not 0 < value < float("inf"):
        raise ValueError(text)
    return value


def _values(text: str) -> dict[str, float]:
    """`a=1,b=2` as a mapping."""
    pairs = (entry.partition("=") for entry in text.split(",") if entry.strip())
    return {name.strip(): float(value) for name, _, value in pairs}


def _new(arguments: list[str]) -> int:
    parser = _parser("symgen new", "Writes NAME.yaml, a commented model to start from.")
    parser.add_argument("name", metavar="NAME", help="the model's name, a C identifier")
    given = parser.parse_args(arguments)
    from symgen.starting_model import write_starting_model

    print(f"written: {write_starting_model(given.name, Path())}")
    return 0


_COMMANDS: dict[str, Callable[[list[str]], int]] = {
    "verify": _verify,
    "bench": _bench,
    "stress": _stress,
    "target": _target,
    "simulate": _simulate,
    "new": _new,
    "explain": _explain,
    "schema": _schema,
}


def _each_file(models: Sequence[Path], quiet: bool, work: Callable[[Path, Progress], int]) -> int:
    """Measures every model, also after one that failed; the highest exit code wins."""

    def one(path: Path) -> int:
        progress = Progress(path.stem, quiet)
        try:
            return work(path, progress)
        finally:
            progress.done()

    for path in models:
        if not path.is_file():
            raise WrongUseError(f"no such file: {path}")
    return max([_guarded(partial(one, path)) for path in models])


def _each_model(models: Sequence[Path], options: Options, quiet: bool, finish: Callable[[Result], int]) -> int:
    """Every model, also after one that failed; the highest exit code wins."""
    seen: dict[str, Path] = {}

    def one(path: Path) -> int:
        from symgen.pipeline import generate

        progress = Progress(path.stem, quiet)
        try:
            result = generate(path, options, progress)
        finally:
            progress.done()
        other = seen.setdefault(result.model.name, path)
        if other != path:
            raise WrongUseError(f"{other} and {path} are both models named {result.model.name}")
        for notice in () if quiet else result.notices:
            print(notice_line(str(path), notice), file=sys.stderr)
        if result.failures:
            print(f"{path}: verification failed, nothing is written", file=sys.stderr)
            print(*(f"  {failure}" for failure in result.failures), sep="\n", file=sys.stderr)
            return MODEL_WRONG
        return finish(result)

    for path in models:
        if not path.is_file():
            raise WrongUseError(f"no such file: {path}")
    return max([_guarded(partial(one, path)) for path in models])


def _guarded(work: Callable[[], int]) -> int:
    """A user's mistake becomes its message and a fault of symgen a report; neither stops the next model."""
    try:
        return work()
    except ModelError as error:
        print(error.render(), end="", file=sys.stderr)
        return MODEL_WRONG
    except (WrongUseError, OSError):
        raise
    except SymgenBug as error:
        print(f"symgen: internal error: {error}\nThis is a fault of symgen, not of the model.", file=sys.stderr)
    except Exception:
        traceback.print_exc()
        print("symgen: internal error: this is a fault of symgen, not of the model.", file=sys.stderr)
    return WRONG_USE


def _write_files(result: Result, out: Path, quiet: bool) -> int:
    from symgen.write import write_files

    written = write_files(out / result.model.name, result.files)
    if not quiet:
        print(summary_table(result.model.name, result.summary))
        print("written:", *(f"  {path}" for path in written), "", sep="\n")
    return DONE


def _write_certificate(result: Result, out: Path, quiet: bool) -> int:
    """The certificate speaks of what symgen makes now; other files on disk are a failure, not a certificate."""
    from symgen.write import compare, write_files

    folder = out / result.model.name
    certificate = {path: content for path, content in result.files.items() if path == "certificate.json"}
    sources = {path: content for path, content in result.files.items() if path.startswith(("c/", "python/"))}
    differences = compare(folder, sources)
    if differences:
        print("the files on disk are not the ones verified (run symgen again):", file=sys.stderr)
        print(*(f"  {line}" for line in differences), sep="\n", file=sys.stderr)
        return MODEL_WRONG
    written = write_files(folder, certificate)
    if not quiet:
        print(summary_table(result.model.name, result.summary))
        print("written:", *(f"  {path}" for path in written), "", sep="\n")
    return DONE


def _check_files(result: Result, out: Path, quiet: bool) -> int:
    from symgen.write import compare

    differences = compare(out / result.model.name, result.files)
    if differences:
        print(*differences, sep="\n")
        return MODEL_WRONG
    if not quiet:
        print(f"{result.model.name}: as on disk")
    return DONE


def _parser(program: str, description: str, epilog: str | None = None) -> argparse.ArgumentParser:
    form = argparse.RawDescriptionHelpFormatter
    return argparse.ArgumentParser(
        program, description=description, epilog=epilog, formatter_class=form, allow_abbrev=False
    )


def _add_generation_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--out", metavar="DIR", type=Path, default=Path("generated"), help="writes DIR/<model>/ (default: generated)"
    )
    parser.add_argument(
        "--states",
        metavar="N",
        type=_states,
        default=DEFAULT_STATES,
        help=f"states to verify (default: {DEFAULT_STATES})",
    )
    _add_form(parser)
    parser.add_argument(
        "--trig",
        choices=TRIG,
        default="portable",
        help="sine and cosine: portable has the same bits everywhere, libm calls the library's (default: portable)",
    )
    parser.add_argument("--quiet", action="store_true", help="print mistakes and failures only")


def _add_form(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--form",
        choices=FORMS,
        default="auto",
        help="how the inverse dynamics are computed (default: auto, the cheapest valid at every regular state)",
    )


def _names(text: str) -> tuple[str, ...]:
    names = tuple(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))
    if not names:
        raise argparse.ArgumentTypeError("expected names separated by commas")
    return names


def _parts(text: str) -> tuple[Part, ...]:
    names = _names(text)
    if unknown := [name for name in names if name not in PARTS]:
        raise argparse.ArgumentTypeError(f"{unknown[0]!r} is none of {', '.join(PARTS)}")
    return tuple(part for part in PARTS if part in names)


def _states(text: str) -> int:
    try:
        count = int(text)
    except ValueError:
        count = 0
    if count < 8:
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number from 8 up")
    return count
