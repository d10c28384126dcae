"""One model on its targets: vectors, host, every core, compiler and level; the result is plain data."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from threading import Lock

from symgen.backends.c.given_sines import emit_c_sc
from symgen.backends.c.plain import emit_c
from symgen.backends.c.prepared import emit_c_prepared
from symgen.generation.acceptance.recorded import as_recorded
from symgen.generation.results import Options
from symgen.ir.kernel import Program, Scalar
from symgen.ir.pairs.wide_functions import with_bodies, works_with_pairs
from symgen.laboratory.target.build import STACK_WATCHED, Workshop
from symgen.laboratory.target.compare import Units, compare, units_of, uses_library
from symgen.laboratory.target.cores import LEVELS, Compiler, Core
from symgen.laboratory.target.driver import (
    Results,
    driver_source,
    pack_states,
    results_file,
    states_file,
    unpack_results,
)
from symgen.laboratory.target.emulator import addresses, build_counter, count_calls, run_image, stage
from symgen.laboratory.target.entries import Entries, plain_entries, with_companions
from symgen.laboratory.target.footprint import KernelFootprint, deepest_frame, footprints
from symgen.laboratory.target.package_build import CMAKE, WITHOUT_CMAKE, has_cmake, package_of
from symgen.laboratory.target.package_run import run_package
from symgen.laboratory.target.record import Cell, CoreReport, KernelCost, TargetReport
from symgen.laboratory.target.selection import (
    ALL,
    FAST,
    LIBM,
    PORTABLE,
    SMALL,
    BuildSelection,
    Share,
    beyond_pairs,
    has_unit,
    selected,
    selection,
    share,
    small_kernels,
)
from symgen.laboratory.target.tools import EMULATOR, PREFIX, compilers, version
from symgen.laboratory.target.vectors import FEWEST, Vectors, perturbed, vectors_of
from symgen.model.model import Model
from symgen.runtime.processes import ToolError
from symgen.verify.reference.reference import Reference, State

Progress = Callable[[str], None]
SCALARS: tuple[Scalar, ...] = ("float64", "float32")
BASE: tuple[Compiler, str] = ("gcc", FAST)
BESIDE = 1024  # bytes of stack that a kernel may take beside its own frames, for functions of the libraries
CHOICES = ("ratio_or_zero", "copysign")


@dataclass(frozen=True, slots=True)
class _Build:
    """One image: where, with what, and which sines and cosines."""

    core: Core | None
    compiler: Compiler
    level: str
    trig: str
    share: Share = ALL

    @property
    def where(self) -> str:
        return "host" if self.core is None else self.core.name

    @property
    def selection(self) -> BuildSelection:
        """Which kernels it holds."""
        return selection(self.core, self.compiler, self.level, self.trig, self.share)

    @property
    def label(self) -> str:
        return f"{self.where}, {self.compiler} {self.level}, {self.trig}"


@dataclass(frozen=True, slots=True)
class _SelectedKernels:
    """What a selection of kernels is built of; `number` tells selections apart."""

    number: int
    entries: dict[Scalar, Entries]
    sources: dict[str, str]


class _Bench:
    """Sources, states and the host's results of one model in a folder."""

    def __init__(self, model: Model, out: Path | None, folder: Path, vectors: Vectors, progress: Progress) -> None:
        draft = as_recorded(model, model.outputs, Options(scalars=SCALARS, measured=out))
        programs = {scalar: program for scalar, program in draft.written.items() if program.kernels}
        self.model, self.folder, self.vectors, self.progress = model, folder, vectors, progress
        wide = (f"{one.quantity} works{one.digits.lstrip(',')}" for one in draft.derivations.choices if one.wide)
        self.programs, self.notes = programs, (*draft.notes, *wide)
        self.known: dict[BuildSelection, _SelectedKernels] = {}
        self.beyond = tuple(kernel.name for kernel in beyond_pairs(programs["float64"]))
        self.published = self._files(programs, emit_c)
        self.states = {scalar: vectors.rounded(scalar) for scalar in programs}
        self.inputs = self._written("states", self.states)
        self.counter = build_counter(folder)
        self.harnesses = Lock()  # builds run side by side and share drivers and boards
        base = {trig: _Build(None, *BASE, trig) for trig in (PORTABLE, LIBM)}
        images = {trig: self.image(build, painted=False)[1] for trig, build in base.items()}
        self.expected = {trig: self._run(build, images[trig]) for trig, build in base.items()}
        self.units = {scalar: self._units(scalar, images[PORTABLE]) for scalar in programs}

    def kernels(self, chosen: BuildSelection) -> _SelectedKernels:
        """What a selection is built of."""
        if chosen not in self.known:
            programs = selected(chosen, self.programs)
            entries = {scalar: plain_entries(self.model, program) for scalar, program in programs.items()}
            files = self._files(programs, emit_c)
            small = {scalar: small_kernels(program) for scalar, program in programs.items()}
            if chosen.companions and all(program.kernels for program in small.values()):
                entries = {scalar: with_companions(self.model, own, small[scalar]) for scalar, own in entries.items()}
                files |= {**self._files(small, emit_c_prepared), **self._files(small, emit_c_sc)}
            sources = {"driver.c": driver_source(self.model, entries), **files}
            self.known[chosen] = _SelectedKernels(len(self.known), entries, sources)
        return self.known[chosen]

    def entries(self, build: _Build) -> dict[Scalar, Entries]:
        """The functions of a build, whose image has been made."""
        return self.known[build.selection].entries

    def results(self, build: _Build) -> dict[Scalar, Results]:
        """Builds an image, runs it, and reads what it wrote."""
        return self._run(build, self.image(build, painted=False)[1])

    def image(self, build: _Build, painted: bool) -> tuple[Workshop, Path]:
        """An image with its input files beside it; where stacks are watched, more than the deepest frame is painted."""
        with self.harnesses:
            kernels = self.kernels(build.selection)
            shop = self.workshop(build, kernels)
        units = [name for name in kernels.sources if name.endswith(".c") and name != "driver.c"]
        objects = {unit: shop.compile(unit, build.level, build.compiler) for unit in units}
        watched = min(STACK_WATCHED, BESIDE + deepest_frame(objects.values())) if painted else 0
        with self.harnesses:
            harness = shop.harness("driver.c", watched)
        image = shop.link(f"{build.compiler}{build.level}-{watched}", [*harness, *objects.values()])
        stage(image, self.inputs)
        return shop, image

    def workshop(self, build: _Build, kernels: _SelectedKernels) -> Workshop:
        """A folder for one core and one set of kernels."""
        shop = Workshop(self.folder / f"{build.where} {kernels.number}".replace(" ", "-"), build.core)
        if not shop.folder.exists():
            shop.write(kernels.sources)
        return shop

    def read(
        self, image: Path, entries: Mapping[Scalar, Entries], states: Mapping[Scalar, int]
    ) -> dict[Scalar, Results]:
        """What an image wrote; raises ToolError when it is incomplete."""
        results = {}
        for scalar, known in entries.items():
            try:
                data = (image.parent / results_file(scalar)).read_bytes()
                results[scalar] = unpack_results(data, known, states[scalar])
            except (OSError, ValueError) as error:
                raise ToolError(f"{image.parent.name}: {error}") from error
        return results

    def _run(self, build: _Build, image: Path) -> dict[Scalar, Results]:
        run_image(build.core, image)
        return self.read(image, self.entries(build), {s: len(states) for s, states in self.states.items()})

    def _files(
        self, programs: Mapping[Scalar, Program], emit: Callable[[Model, Program], dict[str, str]]
    ) -> dict[str, str]:
        """Generated files by their names."""
        made = [emit(self.model, program) for program in programs.values()]
        return {path.rpartition("/")[2]: text for files in made for path, text in files.items()}

    def _written(self, folder: str, states: Mapping[Scalar, Sequence[State]]) -> list[Path]:
        (self.folder / folder).mkdir(exist_ok=True)
        paths = []
        for scalar, rows in states.items():
            paths.append(self.folder / folder / states_file(scalar))
            paths[-1].write_bytes(pack_states(rows, scalar, self.model))
        return paths

    def _units(self, scalar: Scalar, image: Path) -> Units:
        """d + eps |y| of the regular states, by the float64 kernels of an image of the host."""
        regular = self.states[scalar][: len(self.vectors.regular)]
        entries = self.entries(_Build(None, *BASE, PORTABLE))["float64"]
        made = []
        for kind, states in (("exact", regular), ("moved", perturbed(regular, scalar))):
            # both scalar types run; what float32 makes of these states is of no interest
            stage(image, self._written(f"{kind}-{scalar}", {"float64": states, "float32": states[:1]}))
            run_image(None, image)
            made.append(self.read(image, {"float64": entries}, {"float64": len(states)})["float64"])
        return units_of(entries, scalar, *made)


def measure(
    model: Model, cores: Sequence[Core], progress: Progress = lambda _: None, out: Path | None = None
) -> TargetReport:
    """Conformance of every build, cost at -O2 and -Os, footprint at -Os.

    The kernels are those of OUT/<model>, where a run has verified some; without `out`, what derivation chooses.

    Raises ToolError when a compiler or an emulator fails, and VerificationError or ReferenceValueError where no states
    are found.
    """
    with tempfile.TemporaryDirectory(prefix="symgen-target-") as name:
        progress("looking for states and singularities")
        vectors = vectors_of(Reference(model))
        progress("the host")
        bench = _Bench(model, out, Path(name), vectors, progress)
        builds = [build for build in _builds(cores) if selected(build.selection, bench.programs)]
        progress("compiling and running")
        package = package_of(model, bench.programs) if has_cmake() else None
        packaged = () if package is None else tuple(cores)
        done = 0

        def report_done() -> None:
            nonlocal done
            done += 1
            progress(f"compiling and running, {done} of {len(builds) + len(packaged)} builds")

        def one(build: _Build) -> tuple[list[Cell], list[KernelCost], list[str]]:
            measurement = _measured(bench, build)
            report_done()
            return measurement

        def other(core: Core) -> tuple[list[Cell], list[str]]:
            assert package is not None
            measurement = run_package(
                package, core, bench.folder / f"{core.name}-package", bench.states, len(vectors.regular),
                bench.expected[PORTABLE], bench.units,
            )
            report_done()
            return measurement

        with ThreadPoolExecutor(os.cpu_count()) as pool:
            packages = pool.map(other, packaged)
            made = list(pool.map(one, builds))
            made += [(cells, [], wrong) for cells, wrong in packages]
    failures = [failure for _, _, wrong in made for failure in wrong]
    if len(vectors.regular) < FEWEST:
        failures.append(f"only {len(vectors.regular)} of {FEWEST} regular states were found")
    costs = {build: cost for build, (_, cost, _) in zip(builds, made, strict=False) if cost}
    reports = tuple(
        CoreReport(core.name, core.note, tuple(c for build, cost in costs.items() if build.core is core for c in cost))
        for core in cores
    )
    return TargetReport(
        model=model.name,
        vectors={"regular": len(vectors.regular), "singular": len(vectors.singular), "odd": len(vectors.odd)},
        statuses=_statuses(bench),
        versions=_versions(cores),
        sources={
            path: hashlib.sha256(text.encode()).hexdigest() for path, text in bench.published.items()
        },
        cells=tuple(cell for cells, _, _ in made for cell in cells),
        cores=reports,
        failures=tuple(failures),
        notes=_notes(bench, cores),
    )


def _builds(cores: Sequence[Core]) -> list[_Build]:
    """Portable sine and cosine everywhere at every level; the C library's at -O2."""
    return [
        *(_Build(None, compiler, level, PORTABLE)
          for compiler in compilers() for level in LEVELS if (compiler, level) != BASE),
        *(_Build(core, *build, PORTABLE, share(number, place, len(cores)))
          for place, core in enumerate(cores)
          for number, build in enumerate((compiler, level) for compiler in compilers() for level in LEVELS)),
        *(_Build(core, *BASE, LIBM, share(0, place, len(cores))) for place, core in enumerate(cores)),
    ]


def _measured(bench: _Bench, build: _Build) -> tuple[list[Cell], list[KernelCost], list[str]]:
    """One build beside the host's, and its cost where that is asked for."""
    if build.core is not None and build.compiler == "gcc" and build.level in (FAST, SMALL) and build.trig == PORTABLE:
        results, costs = _costed(bench, build, build.core)
    else:
        results, costs = bench.results(build), []
    cells, failures = [], []
    for scalar, entries in bench.entries(build).items():
        portable = build.trig == PORTABLE
        difference = compare(
            entries, portable, bench.expected[build.trig][scalar], results[scalar], bench.units[scalar],
            len(bench.vectors.regular),
        )
        count = len(entries.functions)
        cells.append(Cell(
            build.where, build.compiler, build.level, scalar, build.trig, count, count * len(bench.states[scalar]),
            difference.different, difference.distance,
        ))
        failures += [f"{build.label}, {scalar}: {wrong}" for wrong in difference.wrong]
    return cells, costs, [*failures, *(wrong for cost in costs for wrong in _wrong(bench, build, cost))]


def _costed(bench: _Bench, build: _Build, core: Core) -> tuple[dict[Scalar, Results], list[KernelCost]]:
    shop, image = bench.image(build, painted=True)
    entries = bench.entries(build)
    functions = [entry.function for known in entries.values() for entry in known.functions]
    counts = count_calls(core, image, bench.counter, addresses(shop, image, functions))
    results = bench.read(image, entries, {scalar: len(states) for scalar, states in bench.states.items()})
    costs = []
    for scalar, known in entries.items():
        sizes = _sizes(shop, build, known) if build.level == SMALL else {}
        for entry in known.functions:
            records = results[scalar].records[entry.name]
            counted = [c for c, record in zip(counts[entry.function], records, strict=True) if record.status == 0]
            costs.append(KernelCost(
                entry.name, scalar, build.level, len(counted), min(counted, default=0), max(counted, default=0),
                results[scalar].stack[entry.name], sizes.get(entry.function),
            ))
    return results, costs


def _sizes(shop: Workshop, build: _Build, entries: Entries) -> dict[str, KernelFootprint]:
    """Footprints by function; each file has an object of its own."""
    sizes: dict[str, KernelFootprint] = {}
    for unit in dict.fromkeys(entry.unit for entry in entries.functions):
        target = shop.object(f"{unit}.c", build.level, build.compiler)
        here = [entry for entry in entries.functions if entry.unit == unit]
        deep = {entry.function for entry in here if works_with_pairs(entry.kernel)}
        sizes |= footprints(shop, target, [entry.function for entry in here], deep)
    return sizes


def _wrong(bench: _Bench, build: _Build, cost: KernelCost) -> list[str]:
    """What must hold where the FPU computes in the type: constant counts, no library; no RAM and a known stack always.

    Counts may vary where a sign is copied or a quotient is 0 for a divisor of 0: compilers make jumps of such choices.
    """
    assert build.core is not None
    entry = next(e for e in bench.entries(build)[cost.scalar].functions if e.name == cost.kernel)
    where = f"{build.label}, {cost.scalar}: {cost.kernel}"
    wrong = []
    size = cost.footprint
    if size is not None and size.ram:
        wrong.append(f"{where} has {size.ram} bytes of static data")
    if size is not None and cost.stack >= size.frame + BESIDE:
        wrong.append(f"{where} takes more than {size.frame + BESIDE} bytes of stack")
    if cost.scalar in build.core.native and not uses_library(entry, portable=True):
        chooses = any(statement.operation in CHOICES for statement in with_bodies(entry.kernel.statements))
        if cost.fewest != cost.most and not chooses:
            wrong.append(f"{where} takes {cost.fewest} to {cost.most} instructions")
        if size is not None and size.undefined:
            wrong.append(f"{where} needs {', '.join(size.undefined)}")
    return wrong


def _notes(bench: _Bench, cores: Sequence[Core]) -> tuple[str, ...]:
    """What was left out, and what is not as in the folder of the model."""
    notes = [*bench.notes]
    without = [core.name for core in cores if not has_unit(core)]
    if bench.beyond and without:
        notes.append(
            f"not built by gcc in float64 for {', '.join(without)}, for their size: {', '.join(bench.beyond)}"
        )
    if not has_cmake():
        notes.append(WITHOUT_CMAKE)
    if "clang" not in compilers():
        notes.append("clang is not installed: builds with clang are left out")
    return tuple(notes)


def _statuses(bench: _Bench) -> dict[str, dict[str, int]]:
    """How often each status was told on the singular and odd vectors, by scalar type."""
    first = len(bench.vectors.regular)
    by_scalar: dict[str, dict[str, int]] = {}
    for scalar, results in bench.expected[PORTABLE].items():
        counts = Counter(record.status for records in results.records.values() for record in records[first:])
        by_scalar[scalar] = {str(status): counts[status] for status in sorted(counts)}
    return by_scalar


def _versions(cores: Sequence[Core]) -> dict[str, str]:
    tools = [*compilers()]
    named: list[str] = list(tools)
    for core in cores:
        named += [PREFIX[core.family] + "gcc", EMULATOR[core.family]]
    named += [CMAKE] if has_cmake() else []
    return {tool: version(tool) for tool in dict.fromkeys(named)}
