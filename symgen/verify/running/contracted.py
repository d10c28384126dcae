"""Batch kernels whose products and sums the compiler contracts: other bits, held against the same expectations.

Only the file of the batches is compiled so, into a library beside the one that holds the kernels for one state, which
tell statuses: numbers with twice the digits stand there, and contraction would take their digits away.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Sequence
from pathlib import Path

from symgen.ir.kernel import Kernel, Scalar
from symgen.runtime.activity import working
from symgen.runtime.processes import ToolError, run
from symgen.verify.running.batch import outcomes_of_batches
from symgen.verify.running.compile import (
    LONGEST_ANSWER,
    LONGEST_COMPILATION,
    LONGEST_FOR_A_MEGABYTE,
    REMEDY,
    CompilationError,
    Compiler,
    Outcome,
)
from symgen.verify.sampling.states import Sample

# One of its words stands in a narrow column of reports.
BATCH_FUSED = "batch fused"
# gcc contracts from -O2 on.
FLAGS = ("-std=c99", "-O2", "-march=native", "-ffp-contract=fast", "-DSYMGEN_CONTRACT", "-fPIC", "-shared")
# One of these is defined where the processor multiplies and adds in one.
FUSED = ("__FP_FAST_FMA", "__FMA__", "__ARM_FEATURE_FMA")


def is_fused(compiler: Compiler) -> bool:
    """Whether this machine has such an instruction, and the compiler makes use of it."""
    answer = run([*compiler.command, "-march=native", "-dM", "-E", "-x", "c", os.devnull], LONGEST_ANSWER)
    defined = {words[1] for line in answer.stdout.splitlines() if len(words := line.split()) > 1}
    return answer.returncode == 0 and not defined.isdisjoint(FUSED)


def run_contracted(
    compiler: Compiler,
    source: Path,
    beside: Path,
    model: str,
    kernels: Sequence[Kernel],
    scalar: Scalar,
    samples: Sequence[Sample],
) -> dict[str, list[Outcome]]:
    """Outcomes of every batch kernel of a source at every state; `beside` is the library it calls.

    Raises CompilationError with the compiler's message.
    """
    target = source.with_suffix(".contracted.so")
    command = [*compiler.command, *FLAGS, "-o", str(target), str(source), str(beside), "-lm"]
    limit = LONGEST_COMPILATION + LONGEST_FOR_A_MEGABYTE * source.stat().st_size / 1e6
    try:
        with working("contracting batches"):
            made = run(command, limit)
    except ToolError as error:
        raise CompilationError(f"{error}; {REMEDY}") from error
    if made.returncode != 0 or not target.is_file():
        raise CompilationError(made.stderr.strip() or f"{compiler.command[0]} made no library of {source.name}")
    library = ctypes.CDLL(str(target))
    return {name: many for name, (many, _) in outcomes_of_batches(library, model, kernels, scalar, samples).items()}
