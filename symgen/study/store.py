"""A study on disk: a Zarr group that xarray reads, with a note for each chunk that is whole.

While a study runs it stands in `study.partial` beside where its results will be: `study.json` says which study it is,
`done/` has the notes, `study.zarr` the arrays.  Chunks and notes are written under another name and renamed, so that
what is there is whole; a chunk without a note is worked out again and has the same bytes.
"""

from __future__ import annotations

import json
import math
import os
import shutil
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import zarr
from numpy.typing import NDArray

from symgen.study.asked.request import GRID
from symgen.study.chunks import ChunkGrid, axis_values
from symgen.study.plan import StudyPlan, VariedName
from symgen.study.reductions import TIME, ChunkResults, ResultVariable, result_variables
from symgen.study.states import NO_PATH

PARTIAL, ZARR, SETTINGS, DONE_FOLDER = "study.partial", "study.zarr", "study.json", "done"
# Written into the attributes of the results: what has it may be replaced.
MADE_BY = "symgen study"
# What stands where a chunk is missing: no number, no state, no path.
_FILLS: dict[str, float] = {"f8": math.nan, "i8": -1, "u1": NO_PATH}


@dataclass(frozen=True, slots=True)
class ChunkNote:
    """What is known of a chunk that is whole: states by status, the worst value of each channel and where it is.

    `worst` has by quantity of interest for each channel the value, the number of the point in the chunk and that of the
    state, or nothing.
    """

    statuses: Mapping[int, int]
    worst: Mapping[str, list[tuple[float, int, int] | None]]


class StudyStore:
    """The folder of a study that is being worked on."""

    def __init__(self, folder: Path, plan: StudyPlan, chunks: ChunkGrid) -> None:
        self.folder = folder
        self._plan, self._chunks = plan, chunks

    def begin(self, settings: Mapping[str, object], files: Mapping[str, str | bytes]) -> None:
        """Makes the folder with some `files` in it, or takes one of the same study up again.  Raises OSError."""
        if kept_settings(self.folder) != settings:
            # notes of another study would be taken for some of this one
            shutil.rmtree(self.folder, ignore_errors=True)
            (self.folder / DONE_FOLDER).mkdir(parents=True)
            self._create(settings)
            for name, content in files.items():
                (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
                (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
            _written_whole(self.folder / SETTINGS, _json(settings).encode())
        for left in self.folder.rglob("*.partial"):
            left.unlink()

    def _create(self, settings: Mapping[str, object]) -> None:
        plan = self._plan
        group = zarr.create_group(self.folder / ZARR, attributes={"made_by": MADE_BY, **settings})
        for variable in result_variables(plan):
            _create_array(
                group, variable.name, (*plan.shape, *variable.inner_shape), variable.dtype,
                (*plan.dimensions, *variable.dimensions), variable.attributes,
                (*self._chunks.sides, *variable.inner_shape),
            )  # fmt: skip
        _labels(group, result_variables(plan))
        for k, one in enumerate(plan.over):
            if plan.request.sample == GRID:
                axis = _create_array(group, one.axis.name, (plan.shape[k],), "f8", (one.axis.name,), _about(plan, one))
                axis[:] = axis_values(plan, k)
            else:
                about = _about(plan, one)
                _create_array(group, one.axis.name, plan.shape, "f8", plan.dimensions, about, self._chunks.sides)

    def is_done(self, number: int) -> bool:
        """Whether a chunk is whole."""
        return self._note(number).is_file()

    def write(self, number: int, values: Any, results: ChunkResults) -> None:
        """A chunk whose points have these values (points x names); its note comes last."""
        for variable in result_variables(self._plan):
            self._write_chunk(number, variable.name, results.arrays[variable.name], variable.inner_shape)
        if self._plan.request.sample != GRID:
            for k, one in enumerate(self._plan.over):
                self._write_chunk(number, one.axis.name, values[:, k], ())
        note = {"statuses": results.statuses, "worst": results.worst}
        _written_whole(self._note(number), _json(note).encode())

    def _write_chunk(self, number: int, name: str, entries: NDArray[Any], inner: tuple[int, ...]) -> None:
        """The file of a chunk, as the Zarr format has it without compression: all of its box, little-endian.

        Zarr's own way through an event loop takes milliseconds a file, in which a core evaluates 10^5 states.
        """
        slices = self._chunks.slices(number)
        fill, little = _FILLS[entries.dtype.str[1:]], entries.dtype.newbyteorder("<")
        box = np.full((*self._chunks.sides, *inner), fill, dtype=little)
        sizes = [part.stop - part.start for part in slices]
        box[tuple(map(slice, sizes))] = entries.reshape(*sizes, *inner)
        places = [part.start // side for part, side in zip(slices, self._chunks.sides, strict=True)]
        key = ".".join(map(str, ("c", *places, *(0 for _ in inner))))
        _written_whole(self.folder / ZARR / name / key, box.tobytes())

    @property
    def is_begun(self) -> bool:
        """Whether a chunk is whole; looking for the notes of all takes long where there are millions."""
        return any((self.folder / DONE_FOLDER).iterdir())

    def notes(self) -> Iterator[tuple[int, ChunkNote]]:
        """The notes of all whole chunks in their order."""
        for number in range(len(self._chunks)):
            if (text := _text(self._note(number))) is not None:
                note = json.loads(text)
                statuses = {int(code): int(count) for code, count in note["statuses"].items()}
                worst = {name: [one and tuple(one) for one in kept] for name, kept in note["worst"].items()}
                yield number, ChunkNote(statuses, worst)

    def finish(
        self,
        target: Path,
        attributes: Mapping[str, object],
        further: Sequence[tuple[ResultVariable, NDArray[np.float64]]] = (),
    ) -> None:
        """Puts the results, and `further` arrays that no chunk has, where they belong and removes the folder."""
        group = zarr.open_group(self.folder / ZARR, mode="r+")
        group.attrs.update(attributes)
        for one, values in further:
            _create_array(group, one.name, values.shape, one.dtype, one.dimensions, one.attributes)[:] = values
        _labels(group, [one for one, _ in further])
        with warnings.catch_warnings():
            # Zarr's third format has no word on it yet; xarray reads it, and warns where it is not there
            warnings.simplefilter("ignore", UserWarning)
            zarr.consolidate_metadata(self.folder / ZARR)
        if target.exists():
            shutil.rmtree(target)
        os.replace(self.folder / ZARR, target)
        shutil.rmtree(self.folder)

    def discard(self) -> None:
        """Removes the folder."""
        shutil.rmtree(self.folder)

    def _note(self, number: int) -> Path:
        return self.folder / DONE_FOLDER / f"{number:06d}.json"


def kept_settings(folder: Path) -> dict[str, Any]:
    """The settings of the study that a folder holds, none where it holds no whole ones."""
    try:
        settings = json.loads(_text(folder / SETTINGS) or "{}")
    except ValueError:
        return {}
    return settings if isinstance(settings, dict) else {}


def is_own(target: Path) -> bool:
    """Whether results may be replaced: there are none, or a study has made them."""
    if not target.exists():
        return True
    try:
        return bool(zarr.open_group(target, mode="r").attrs.get("made_by") == MADE_BY)
    except (OSError, ValueError, KeyError):
        return False


def _create_array(
    group: Any,
    name: str,
    shape: tuple[int, ...],
    dtype: str,
    dimensions: tuple[str, ...],
    attributes: Mapping[str, str],
    chunks: tuple[int, ...] | None = None,
) -> Any:
    """An array whose chunks are those of the study; what is not there is NaN, no place, or no path."""
    return group.create_array(
        name,
        shape=shape,
        dtype=dtype,
        chunks=chunks or shape,
        dimension_names=dimensions,
        attributes=dict(attributes),
        fill_value=_FILLS[dtype],
        compressors=None,
        chunk_key_encoding={"name": "default", "separator": "."},
    )


def _labels(group: Any, variables: Sequence[ResultVariable]) -> None:
    """Coordinates of the dimensions that are no axes of the points: names of inputs, levels of quantiles, times."""
    by_name = {
        name: labels for one in variables for name, labels in zip(one.dimensions, one.labels, strict=True)
    }
    for name, labels in by_name.items():
        if name in group:
            continue
        if isinstance(labels[0], str):
            group.create_array(name, shape=(len(labels),), dtype=str, dimension_names=(name,))[:] = list(labels)
        else:
            about = {"long_name": "time along the path", "units": "s"} if name == TIME else {"long_name": "level"}
            _create_array(group, name, (len(labels),), "f8", (name,), about)[:] = labels


def _about(plan: StudyPlan, one: VariedName) -> dict[str, str]:
    """Description and unit of a varied name."""
    described = {item.name: item.description for item in plan.model.coordinates}
    described |= {item.name: item.description for item in plan.model.parameters}
    return {"long_name": described.get(one.axis.name, "") or f"{one.kind} {one.axis.name}", "units": one.unit}


def _written_whole(path: Path, content: bytes) -> None:
    """Written under another name, then renamed."""
    beside = path.with_name(f"{path.name}.partial")
    try:
        beside.write_bytes(content)
        os.replace(beside, path)
    except OSError:
        beside.unlink(missing_ok=True)
        raise


def _text(path: Path) -> str | None:
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return None


def _json(content: object) -> str:
    return json.dumps(content, indent=1, sort_keys=True) + "\n"
