"""Exit codes, and what a command answers when a model or symgen itself is at fault."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable, Sequence
from difflib import get_close_matches
from functools import partial
from pathlib import Path

from symgen.diagnostics import ModelError, SymgenBug
from symgen.generation.packages import EXTRA_OF, to_install
from symgen.generation.results import WrongUseError
from symgen.runtime.processes import ToolError
from symgen.terminal import Progress, fitted

# Exit codes: all went well, a model is wrong, or the command or symgen itself is.
DONE, MODEL_WRONG, WRONG_USE = 0, 1, 2


def each_file(models: Sequence[Path], out: Path, quiet: bool, work: Callable[[Path, Progress], int]) -> int:
    """Measures every model, also after one that failed; the highest exit code wins."""

    def one(path: Path) -> int:
        progress = Progress(path.stem, quiet)
        try:
            return work(path, progress)
        finally:
            progress.done()

    check_present(models)
    check_writable(out)
    return max([guarded(partial(one, path)) for path in models])


def check_present(models: Sequence[Path]) -> None:
    """WrongUseError for the first file that is missing, before work on any of them starts."""
    for path in models:
        if not path.is_file():
            raise WrongUseError(_why_missing(path))


def check_writable(out: Path) -> None:
    """WrongUseError where no folder can stand, before work starts that takes minutes."""
    there = next(path for path in (out.absolute(), *out.absolute().parents) if path.exists())
    if not there.is_dir():
        raise WrongUseError(f"{there} is a file: name a folder with --out")
    if not os.access(there, os.W_OK | os.X_OK):
        raise WrongUseError(f"nothing may be written into {there}: name another folder with --out")


def _why_missing(path: Path) -> str:
    """That there is no file, and the model that was meant where one is near."""
    if path.is_dir():
        models = sorted(path.glob("*.yaml"))
        such = f", such as {models[0]}" if models else ""
        return f"{path} is a folder: name a model file{such}"
    if path.is_symlink():
        return f"{path} is a link that leads to no file"
    beside = [one.name for one in path.parent.glob("*.yaml")] if path.parent.is_dir() else []
    meant = f"{path.name}.yaml" if f"{path.name}.yaml" in beside else path.name
    near = meant if meant in beside else next(iter(get_close_matches(meant, sorted(beside), 1, 0.6)), "")
    return f"no such file: {path}" + (f"; did you mean {path.parent / near}?" if near else "")


def guarded(work: Callable[[], int]) -> int:
    """A user's mistake becomes its message and a fault of symgen a report; neither stops the next model."""
    try:
        return work()
    except ModelError as error:
        print(fitted(error.render(), sys.stderr), end="", file=sys.stderr)
        return MODEL_WRONG
    except (WrongUseError, OSError):
        raise
    except ToolError as error:
        print(f"symgen: {error}", file=sys.stderr)
    except SymgenBug as error:
        print(f"symgen: internal error: {error}\nThis is a fault of symgen, not of the model.", file=sys.stderr)
    except Exception as error:
        module = (error.name or "").partition(".")[0] if isinstance(error, ModuleNotFoundError) else ""
        if module in EXTRA_OF:
            raise WrongUseError(to_install((module,), "this")) from error
        traceback.print_exc()
        print("symgen: internal error: this is a fault of symgen, not of the model.", file=sys.stderr)
    return WRONG_USE
