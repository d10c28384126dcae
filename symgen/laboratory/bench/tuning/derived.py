"""What a process with other constants makes of a model: counted costs, what the C says, and how long it took."""

from __future__ import annotations

import signal
import time
from hashlib import sha256
from pathlib import Path
from types import FrameType
from typing import Any

from symgen.generation.acceptance.recorded import as_recorded
from symgen.generation.files import sources_of
from symgen.generation.results import Options
from symgen.laboratory.bench.tuning.passes import costs
from symgen.laboratory.bench.tuning.tuned import ROOT
from symgen.laboratory.bench.tuning.varied import Key
from symgen.model.load import load_model

OPTIONS = Options(parts=("c",), measured=ROOT / "generated")


class _SlowError(BaseException):
    """Nothing that a derivation would catch."""


def derived(path: str, most: float, noticed: set[Key]) -> dict[str, Any]:
    """A model derived and printed as C, in so many seconds at most (0: as long as it takes)."""
    signal.signal(signal.SIGPROF, _stop)
    signal.setitimer(signal.ITIMER_PROF, most)
    before = time.process_time()
    try:
        model = load_model(Path(path))
        draft = as_recorded(model, model.outputs, OPTIONS)
        sources = sources_of(draft, OPTIONS)
        by_name = costs(draft.derivations.quantities)
    except _SlowError:
        return {"failed": "takes too long"}
    except Exception as error:  # whatever a constant breaks is a result
        return {"failed": type(error).__name__}
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    took = time.process_time() - before
    kernels = {name: [cost, _digest(repr(draft.kernels(name)))] for name, cost in by_name.items()}
    text = _digest("".join(text for _, text in sorted(sources.items())))
    return {"kernels": kernels, "c": text, "seconds": took, "noticed": sorted(noticed)}


def _stop(number: int, frame: FrameType | None) -> None:
    del number, frame
    raise _SlowError


def _digest(text: str) -> str:
    return sha256(text.encode()).hexdigest()
