"""The command line: `symgen MODEL.yaml...` and the commands behind it; those that measure stand in `measuring`."""

from __future__ import annotations

import argparse
import gc
import os
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from io import StringIO, TextIOWrapper
from pathlib import Path

from symgen import __version__
from symgen.cli.arguments import (
    SHELLS,
    add_generation,
    add_method,
    add_models,
    add_out,
    chosen_methods,
    make_parser,
    names,
    parts,
)
from symgen.cli.command import Command
from symgen.cli.identifying import EXCITE, IDENTIFY, explain_base_parameters
from symgen.cli.linearizing import add_linearization, explain_linear_system
from symgen.cli.measuring import BENCH, SIMULATE, STRESS, TARGET
from symgen.cli.outcome import DONE, MODEL_WRONG, WRONG_USE, check_present, check_writable, guarded
from symgen.cli.signals import EndedError, signals_end_the_run
from symgen.cli.studying import STUDY
from symgen.generation.results import ALL_PARTS, LINEARIZATION, PARTS, Options, Result, WrongUseError
from symgen.ir.kernel import Scalar
from symgen.model.expressions.names import did_you_mean
from symgen.model.quantities import BASE_PARAMETERS
from symgen.output.write import begin_writing, changed_folders, compare, recover_folders, write_files
from symgen.registered import USUAL
from symgen.runtime.processes import ToolError
from symgen.terminal import SPELLED, Progress, fitted, notice_line, summary_table, terminal_width, written_table

# Read by OpenBLAS and MKL where NumPy loads them, which is later.
BLAS_THREADS = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
# Exit codes, as a shell reports these signals.
INTERRUPTED, READER_GONE = 130, 141
_SCALARS: dict[str, tuple[Scalar, ...]] = {
    "float64": ("float64",),
    "float32": ("float32",),
    "both": ("float64", "float32"),
}
_EPILOG = """commands:
  symgen MODEL.yaml...              generate and verify
  symgen verify MODEL.yaml          verify again, write the certificate only
  symgen bench MODEL.yaml...        run time against error, beside other tools
  symgen stress MODEL.yaml...       errors near singularities, in long runs
  symgen target MODEL.yaml --cpu C  instructions, bytes, bits on emulated cores
  symgen simulate MODEL.yaml        integrates: CSV, chart, animation
  symgen excite MODEL.yaml          a motion to identify parameters by
  symgen identify MODEL.yaml LOG    parameters from a log of the machine
  symgen study MODEL.yaml           maps over ranges of parameters and places
  symgen new NAME                   a commented model to start from
  symgen explain MODEL.yaml [NAME]  closed forms and structure in the terminal
  symgen schema                     JSON Schema of model files, for editors
  symgen completion SHELL           what bash, zsh or fish complete words by

examples:
  symgen models/front_car.yaml
  symgen models/*.yaml --out build/symgen --quiet
  symgen models/front_car.yaml --outputs inverse_dynamics --scalar float32
  symgen models/front_car.yaml --method householder --only c
  symgen models/front_car.yaml --method multipliers=schur_qr
  symgen models/*.yaml --check
  symgen explain models/front_car.yaml nullspace_projector

exit codes: 0 done, 1 the model or its verification is wrong, 2 wrong use or a
fault of symgen
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command line and returns the exit code."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    if arguments is None:
        # small systems in thousands are shared among threads of a BLAS at several times the cost of one thread
        for threads in BLAS_THREADS:
            os.environ.setdefault(threads, "1")
        # large graphs live until the end of a command: looking for cycles in them costs a twentieth of its time
        gc.disable()
    _prepare_streams()
    begin_writing()
    command, rest = (given[0], given[1:]) if given and given[0] in _COMMANDS else ("", given)
    try:
        if given and not command:
            _check_command(given[0])
        with signals_end_the_run(process_ends=arguments is None):
            code = (_COMMANDS[command] if command else _GENERATE)(rest)
            sys.stdout.flush()
        if arguments is None:
            # the interpreter looks for cycles once more at its end, to free what the process gives back anyway
            gc.freeze()
        return code
    except (KeyboardInterrupt, EndedError) as ending:
        return _ended(ending)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # no second complaint at exit
        return READER_GONE
    except (WrongUseError, ToolError) as error:
        return _complain(str(error))
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        return _complain(f"{place}{error.strerror or error}")


def _check_command(word: str) -> None:
    """WrongUseError for a word that is neither a command nor the name of a file, but close to a command."""
    if word.isidentifier() and not Path(word).exists():
        remedy = did_you_mean(word, _COMMANDS, "")
        if remedy:
            raise WrongUseError(f"{word} is no command and no file; {remedy.replace('`', '`symgen ', 1)}")


def _prepare_streams() -> None:
    """Output may be closed, and a terminal may lack characters: neither is a reason to fail."""
    sys.stdout, sys.stderr = sys.stdout or StringIO(), sys.stderr or StringIO()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors=SPELLED)


def _ended(ending: KeyboardInterrupt | EndedError) -> int:
    """Says what became of the output, and returns the exit code."""
    word, code = "interrupted", INTERRUPTED
    if isinstance(ending, EndedError):
        word, code = ending.meaning, ending.number
    folders = ", ".join(map(str, changed_folders()))
    state = "earlier output is unchanged"
    if folders:
        state = f"new files are in {folders}, each complete; all else is unchanged"
    with suppress(OSError):  # the terminal may be gone
        print(f"\n{word}; {state}", file=sys.stderr, flush=True)
    return code


def _complain(message: str) -> int:
    print(f"symgen: {message}", file=sys.stderr)
    return WRONG_USE


def _generate_parser() -> argparse.ArgumentParser:
    purpose = "Verified, globally valid inverse dynamics of constrained mechanical systems."
    parser = make_parser("symgen", purpose, _EPILOG)
    add_models(parser)
    add_generation(parser)
    parser.add_argument("--outputs", metavar="A,B", type=names, help="quantities, or all (default: the model's list)")
    parser.add_argument(
        "--scalar", choices=tuple(_SCALARS), default="both", help="scalar types of the C (default: both)"
    )
    known = f"some of {', '.join(ALL_PARTS)}, with commas between (default: {', '.join(PARTS)})"
    parser.add_argument("--only", metavar="PARTS", type=parts, help=known)
    parser.add_argument("--no-verify", dest="verify", action="store_false", help="write without verification")
    parser.add_argument(
        "--recorded",
        metavar="DIR",
        type=Path,
        help="in place of verification, take what it led to from DIR/<model>/derivation.json",
    )
    parser.add_argument(
        "--check",
        action="store_true",
        help="write nothing; exit 1 and list what differs from the disk (no verification)",
    )
    parser.add_argument("--version", action="version", version=f"symgen {__version__}")
    return parser


def _generate(given: argparse.Namespace) -> int:
    options = Options(
        outputs=given.outputs,
        scalars=_SCALARS[given.scalar],
        parts=given.only or PARTS,
        usual=given.only is None,
        verify=given.verify and not given.check and given.recorded is None,
        states=given.states,
        methods=chosen_methods(given.methods),
        trig=given.trig,
        contract=given.contract,
        measured=given.recorded or given.out,
        as_recorded=given.check or given.recorded is not None,
    )
    finish = _check_files if given.check else _write_files
    if not given.check:
        check_writable(given.out)
    recover_folders(given.out)
    return _each_model(given.models, options, given.quiet, lambda result: finish(result, given.out, given.quiet))


def _verify_parser() -> argparse.ArgumentParser:
    parser = make_parser(
        "symgen verify", "Compiles the C, runs C and Python against the reference, writes the certificate."
    )
    add_models(parser)
    add_generation(parser)
    return parser


def _verify(given: argparse.Namespace) -> int:
    from symgen.verify.running.compile import find_compiler

    if find_compiler() is None:
        raise WrongUseError("no C compiler was found: install gcc or clang, or name one in CC")
    recover_folders(given.out)
    methods = chosen_methods(given.methods)
    options = Options(
        parts=("c", "python"), states=given.states, methods=methods, trig=given.trig, contract=given.contract
    )
    return _each_model(
        given.models, options, given.quiet, lambda result: _write_certificate(result, given.out, given.quiet)
    )


def _explain_parser() -> argparse.ArgumentParser:
    parser = make_parser("symgen explain", "Closed forms, structure, and what is skipped and why.")
    parser.add_argument("model", metavar="MODEL.yaml", type=Path, help="model file")
    parser.add_argument(
        "quantity",
        metavar="QUANTITY",
        nargs="?",
        help=f"one quantity; {LINEARIZATION}: poles and gains at rest; {BASE_PARAMETERS}: which combinations of "
        "inertial parameters count (default: an overview)",
    )
    add_linearization(parser)
    add_method(parser)
    add_out(parser, "takes what verification led to from DIR/<model>/ (default: generated)")
    return parser


def _explain(given: argparse.Namespace) -> int:
    check_present([given.model])
    if given.quantity == LINEARIZATION:
        return guarded(lambda: explain_linear_system(given.model, given.start, given.lqr))
    if given.quantity == BASE_PARAMETERS:
        return guarded(lambda: explain_base_parameters(given.model))

    def explain() -> int:
        from symgen.generation.explain import explain

        progress = Progress(given.model.stem, quiet=not sys.stderr.isatty())
        text = explain(given.model, given.quantity, progress, chosen_methods(given.methods), given.out)
        progress.done()
        print(text)
        return DONE

    return guarded(explain)


def _schema_parser() -> argparse.ArgumentParser:
    return make_parser("symgen schema", "Prints the JSON Schema of model files.")


def _schema(_: argparse.Namespace) -> int:
    import json

    from symgen.model.file.schema import json_schema

    print(json.dumps(json_schema(), indent=2, ensure_ascii=False))
    return DONE


def _new_parser() -> argparse.ArgumentParser:
    parser = make_parser("symgen new", "Writes NAME.yaml, a commented model to start from.")
    parser.add_argument("name", metavar="NAME", help="the model's name, a C identifier")
    return parser


def _new(given: argparse.Namespace) -> int:
    from symgen.cli.starting_model import write_starting_model

    print(f"written: {write_starting_model(given.name, Path())}")
    return DONE


def _completion_parser() -> argparse.ArgumentParser:
    parser = make_parser("symgen completion", "Prints a script by which a shell completes words behind symgen.")
    parser.add_argument("shell", choices=SHELLS, help=f"{', '.join(SHELLS)}")
    return parser


def _completion(given: argparse.Namespace) -> int:
    from symgen.cli.completion import script

    parsers = {name: command.parser() for name, command in {"": _GENERATE, **_COMMANDS}.items()}
    print(script(given.shell, parsers), end="")
    return DONE


_GENERATE = Command(_generate_parser, _generate)
_COMMANDS = {
    "verify": Command(_verify_parser, _verify),
    "bench": BENCH,
    "stress": STRESS,
    "target": TARGET,
    "simulate": SIMULATE,
    "excite": EXCITE,
    "identify": IDENTIFY,
    "study": STUDY,
    "new": Command(_new_parser, _new),
    "explain": Command(_explain_parser, _explain),
    "schema": Command(_schema_parser, _schema),
    "completion": Command(_completion_parser, _completion),
}


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
            print(fitted(notice_line(str(path), notice), sys.stderr), file=sys.stderr)
        if result.failures:
            print(f"{path}: verification failed, nothing is written", file=sys.stderr)
            print(*(f"  {failure}" for failure in result.failures), sep="\n", file=sys.stderr)
            _print_left_out(path, result)
            return MODEL_WRONG
        code = finish(result)
        _print_left_out(path, result)
        return MODEL_WRONG if result.left_out else code

    check_present(models)
    return max([guarded(partial(one, path)) for path in models])


def _print_left_out(path: Path, result: Result) -> None:
    for one in result.left_out:
        types = " and ".join(one.scalars)
        print(f"{path}: {one.quantity} is left out in {types}: verification rejects every method", file=sys.stderr)
        tried = (f"  {method}: {why}" for method, why in one.tried)
        print(*tried, f"  remedy: {one.remedy}", sep="\n", file=sys.stderr)


def _write_files(result: Result, out: Path, quiet: bool) -> int:
    notify = _unheard if quiet else _heard
    written = write_files(out / result.model.name, result.files, notify)
    if not quiet:
        print(summary_table(result.model.name, result.summary, terminal_width(sys.stdout)))
        folder = out / result.model.name
        print(written_table(folder, [path.relative_to(folder) for path in written]))
    return DONE


def _heard(message: str) -> None:
    print(message, file=sys.stderr)


def _unheard(_message: str) -> None:
    return


def _write_certificate(result: Result, out: Path, quiet: bool) -> int:
    """The certificate speaks of what symgen makes now; other files on disk are a failure, not a certificate."""
    folder = out / result.model.name
    certificate = {path: content for path, content in result.files.items() if path == "certificate.json"}
    sources = {path: content for path, content in result.files.items() if path.partition("/")[0] in USUAL}
    differences = compare(folder, sources)
    if differences:
        print("the files on disk are not the ones verified (run symgen again):", file=sys.stderr)
        print(*(f"  {line}" for line in differences), sep="\n", file=sys.stderr)
        return MODEL_WRONG
    written = write_files(folder, certificate)
    if not quiet:
        print(summary_table(result.model.name, result.summary, terminal_width(sys.stdout)))
        print("written:", *(f"  {path}" for path in written), "", sep="\n")
    return DONE


def _check_files(result: Result, out: Path, quiet: bool) -> int:
    differences = compare(out / result.model.name, result.files)
    if differences:
        print(*differences, sep="\n")
        return MODEL_WRONG
    if not quiet:
        print(f"{result.model.name}: as on disk")
    return DONE
