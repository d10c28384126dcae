"""Verification: every emitted quantity of every target against the reference, and the laws the results obey."""

from __future__ import annotations

import hashlib
import platform
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path, PurePosixPath

import flint

import symgen
from symgen.backends.backend import backend
from symgen.backends.c.endings import BATCH, PREPARED, SINES_GIVEN, TOGETHER
from symgen.ir.kernel import Kernel, Scalar
from symgen.model.model import Model
from symgen.runtime.activity import each, working
from symgen.verify.certificate import Certificate, ConditionRecord, ErrorRecord, Fault, InvariantRecord
from symgen.verify.comparison import VIOLATES, Results, check_laws, compare, faults_of
from symgen.verify.conditions import condition_numbers
from symgen.verify.expected import Expected, Progress
from symgen.verify.given import arrays
from symgen.verify.reference.reference import ReferenceValueError
from symgen.verify.running.batch import run_batch
from symgen.verify.running.compile import (
    CFunction,
    Compilation,
    CompilationError,
    Compiler,
    CSource,
    Outcome,
    c_array,
    find_compiler,
)
from symgen.verify.running.contracted import BATCH_FUSED, is_fused, run_contracted
from symgen.verify.running.given_trig import run_given_trig
from symgen.verify.running.prepared import run_prepared
from symgen.verify.running.python_module import PythonModule
from symgen.verify.running.several_results import run_several
from symgen.verify.sampling.states import USUAL_STATES, Sample, VerificationError

# Characters of what a compiler said that are kept in a fault.
LONGEST_EXCERPT = 2000
NO_COMPILER = "no C compiler was found, the C is not verified: install gcc or clang, or name one in CC"
NOT_FUSED = "nothing is contracted: this machine, or its compiler, has no instruction that multiplies and adds in one"


def verify(
    model: Model,
    kernels: Sequence[Kernel],
    c_sources: Mapping[Scalar, CSource],
    python_source: str | None,
    states: int = USUAL_STATES,
    progress: Progress = lambda _: None,
) -> Certificate:
    """The certificate of types that have the same kernels, at states that are looked for; see `verify_expecting`.

    Fewer than 8 admissible states found is a fault.
    """
    every: dict[Scalar, Sequence[Kernel]] = {"float64": kernels, **dict.fromkeys(c_sources, kernels)}
    progress("verifying: looking for states")
    try:
        expected = Expected(model, tuple(dict.fromkeys(kernel.name for kernel in kernels)), states, progress)
        return verify_expecting(expected, every, c_sources, python_source, progress)
    except (VerificationError, ReferenceValueError) as fault:
        compiler = find_compiler() if c_sources else None
        return replace(blank_certificate(model, compiler, c_sources, python_source), faults=(Fault(str(fault)),))


def verify_expecting(
    expected: Expected,
    kernels: Mapping[Scalar, Sequence[Kernel]],
    c_sources: Mapping[Scalar, CSource],
    python_source: str | None,
    progress: Progress,
    contract: bool = False,
) -> Certificate:
    """Run what was generated and compare it with what is expected; what goes wrong is a fault of the certificate.

    `kernels` name the emitted quantities of each type with their arguments and shapes.  No C compiler is a note, and so
    is a machine that contracts nothing where batches are to be contracted, too.
    Raises VerificationError where fewer than 8 states are left in a scalar type.
    """
    compiler = find_compiler() if c_sources else None
    blank = blank_certificate(expected.reference.model, compiler, c_sources, python_source)
    with _compilations(compiler, c_sources) as compilations:
        contracting = compiler if contract and compiler is not None and is_fused(compiler) else None
        if contract and compiler is not None and contracting is None:
            blank = replace(blank, notes=(*blank.notes, NOT_FUSED))
        return _verified(blank, expected, kernels, c_sources, compilations, python_source, progress, contracting)


def blank_certificate(
    model: Model, compiler: Compiler | None, c_sources: Mapping[Scalar, CSource], python_source: str | None
) -> Certificate:
    """What a certificate tells before anything is run."""
    return Certificate(
        model=model.name,
        states=0,
        ranks=(),
        errors=(),
        invariants=(),
        conditions=(),
        versions=_versions(compiler),
        hashes=tuple(_hashes(model, c_sources, python_source)),
        faults=(),
        notes=(NO_COMPILER,) if c_sources and compiler is None else (),
    )


def _verified(
    blank: Certificate,
    expected: Expected,
    kernels: Mapping[Scalar, Sequence[Kernel]],
    c_sources: Mapping[Scalar, CSource],
    compilations: Mapping[Scalar, Compilation],
    python_source: str | None,
    progress: Progress,
    contracting: Compiler | None,
) -> Certificate:
    """The certificate with everything that was found; compilers work while the reference does."""
    reference = expected.reference
    model = reference.model
    scalars: dict[Scalar, None] = dict.fromkeys((*compilations, *(("float64",) if python_source is not None else ())))
    values = {scalar: expected.values(scalar) for scalar in scalars}
    samples = {scalar: expected.samples(scalar) for scalar in scalars}
    progress("verifying: running C and Python")
    results, faults = _run_c(model, kernels, c_sources, compilations, samples, contracting)
    if python_source is not None:
        outcomes, wrong = _run_python(python_source, kernels["float64"], samples["float64"])
        results["Python float64"] = ("float64", outcomes)
        faults += wrong
    errors: list[ErrorRecord] = []
    laws: list[InvariantRecord] = []
    judged: list[str] = []
    for target in each("comparing", list(results), str):
        scalar, made = results[target]
        twin = next((t for t in judged if _same(made, results[t][1]) and results[t][0] == scalar), None)
        if twin is None:
            records = [compare(name, target, [e[name] for e in values[scalar]], made[name]) for name in made]
            invariants = check_laws(target, reference, samples[scalar], values[scalar], made)
        else:  # the same bits: C and Python usually agree
            records = [replace(r, target=target) for r in errors if r.target == twin and r.quantity in made]
            whole = len(made) == len(kernels[scalar])
            invariants = [replace(law, target=target) for law in laws if law.target == twin and whole]
        judged.append(target)
        errors += records
        laws += invariants
        for record in records:
            faults += faults_of(record, made[record.quantity], samples[scalar])
        faults += [
            Fault(f"{VIOLATES} {law.name}: {law.largest:.3g} times the allowed defect", law.quantity, target)
            for law in invariants
            if not law.largest <= 1
        ]
    return replace(
        blank,
        states=len(expected.drawn),
        searches=expected.searches,
        ranks=(
            ("constraints", reference.ranks.constraints),
            ("geometric constraints", reference.ranks.geometric),
            ("degree of actuation", reference.ranks.actuation),
        ),
        errors=tuple(errors),
        invariants=tuple(laws),
        conditions=tuple(ConditionRecord(*record) for record in condition_numbers(reference, expected.drawn)),
        faults=tuple(faults),
    )


def _same(made: Results, others: Results) -> bool:
    """Whether another target made the same of every state, for all quantities of this one."""
    return all(others.get(name) == outcomes for name, outcomes in made.items())


@contextmanager
def _compilations(
    compiler: Compiler | None, c_sources: Mapping[Scalar, CSource]
) -> Iterator[dict[Scalar, Compilation]]:
    """Compilers at work on all sources, on large ones in turn, in a folder that goes away."""
    with tempfile.TemporaryDirectory(prefix="symgen-verify-") as folder:
        started: dict[Scalar, Compilation] = {}
        try:
            if compiler is not None:
                for scalar, source in c_sources.items():
                    started[scalar] = Compilation(compiler, source, Path(folder), later=source.large and bool(started))
            yield started
        finally:
            for compilation in started.values():
                compilation.cancel()


def _run_c(
    model: Model,
    every: Mapping[Scalar, Sequence[Kernel]],
    sources: Mapping[Scalar, CSource],
    compilations: Mapping[Scalar, Compilation],
    samples: Mapping[Scalar, Sequence[Sample]],
    contracting: Compiler | None,
) -> tuple[dict[str, tuple[Scalar, Results]], list[Fault]]:
    """Outcomes of every kernel at every state by target, and what did not compile."""
    results: dict[str, tuple[Scalar, Results]] = {}
    faults = []
    for scalar, compilation in compilations.items():
        target, kernels = f"C {scalar}", every[scalar]
        try:
            library = compilation.library()
        except CompilationError as refusal:
            faults.append(Fault(f"{target} does not compile: {str(refusal)[:LONGEST_EXCERPT]}"))
            continue
        functions = [CFunction(library, model.c_name, kernel, scalar) for kernel in kernels]
        outcomes: dict[str, list[Outcome]] = {kernel.name: [] for kernel in kernels}
        for sample in each(target, samples[scalar]):
            state = sample.state
            read = {name: c_array(scalar, values) for name, values in arrays(state, kernels).items()}
            parameters = c_array(scalar, state.parameters)
            for kernel, function in zip(kernels, functions, strict=True):
                outcomes[kernel.name].append(function(read, parameters))
        results[target] = (scalar, outcomes)
        companions = dict(sources[scalar].companions)
        given = library, model.c_name, kernels, scalar, samples[scalar], outcomes
        others = {}
        if companions.get(_header(model, scalar, BATCH)) is not None:
            others["batch"] = run_batch(*given)
            if contracting is not None:
                batches = compilation.target.with_name(_source(model, scalar, BATCH))
                beside = contracting, batches, compilation.target
                try:
                    made = run_contracted(*beside, model.c_name, kernels, scalar, samples[scalar])
                    others[BATCH_FUSED] = made, []
                except CompilationError as refusal:
                    faults.append(Fault(f"{target} {BATCH_FUSED} does not compile: {str(refusal)[:LONGEST_EXCERPT]}"))
        if (header := companions.get(_header(model, scalar, PREPARED))) is not None:
            others["prepared"] = run_prepared(*given, header)
        if (header := companions.get(_header(model, scalar, SINES_GIVEN))) is not None:
            made = run_given_trig(library, model, kernels, scalar, samples[scalar], header)
            others["sines given"] = made, []
        if (header := companions.get(_header(model, scalar, TOGETHER))) is not None:
            others["together"] = run_several(library, model, kernels, scalar, samples[scalar], outcomes, header)
        for kind, (made, differing) in others.items():
            faults += differing
            if made:
                results[f"{target} {kind}"] = (scalar, made)
    return results, faults


def _header(model: Model, scalar: Scalar, ending: str) -> str:
    """What the header of a variant is called."""
    return PurePosixPath(backend("c").paths(model, scalar, ending)[0]).name


def _source(model: Model, scalar: Scalar, ending: str) -> str:
    """What the source of a variant is called."""
    return PurePosixPath(backend("c").paths(model, scalar, ending)[1]).name


def _run_python(
    source: str, kernels: Sequence[Kernel], samples: Sequence[Sample]
) -> tuple[dict[str, list[Outcome]], list[Fault]]:
    """Outcomes of every kernel over all states; the first state must give the same bits alone as in the batch."""
    with working("loading Python"):
        module = PythonModule(source)
    states = [sample.state for sample in samples]
    outcomes = {kernel.name: module.run(kernel, states) for kernel in each("Python", kernels, lambda one: one.name)}
    faults = [
        Fault("one state alone and the same state in a batch differ", kernel.name, "Python float64")
        for kernel in kernels
        if module.run_single(kernel, states[0]).entries != outcomes[kernel.name][0].entries
        and outcomes[kernel.name][0].valid
    ]
    module.unload()
    return outcomes, faults


def _versions(compiler: Compiler | None) -> tuple[tuple[str, str], ...]:
    import numpy as np

    return (
        ("symgen", symgen.__version__),
        ("python", platform.python_version()),
        ("numpy", np.__version__),
        ("python-flint", flint.__version__),
        ("compiler", "none" if compiler is None else compiler.version),
        ("machine", platform.machine()),
    )


def _hashes(model: Model, c_sources: Mapping[Scalar, CSource], python_source: str | None) -> Iterator[tuple[str, str]]:
    """SHA-256 of the model's text and of every text that was run."""
    yield "model", model.text_hash
    made = backend("c")
    for scalar, source in c_sources.items():
        header, body = made.paths(model, scalar)
        yield header, _hash(source.header)
        yield body, _hash(source.source)
        for name, text in source.companions:
            yield f"{made.name}/{name}", _hash(text)
    if python_source is not None:
        (module,) = backend("python").paths(model, "float64")
        yield module, _hash(python_source)


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
