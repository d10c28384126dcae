"""The files that are made of a model from Python."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

from symgen.diagnostics import Notice
from symgen.generation.results import ALL_PARTS, Options, Result, Summary, WrongUseError
from symgen.model.expressions.names import did_you_mean
from symgen.output.write import recover_folders, write_files
from symgen.pipeline import generate
from symgen.terminal import summary_table
from symgen.verify.certificate import LeftOut


class RejectedError(Exception):
    """What was made is not what the reference says; nothing was written.  The text lists every failure."""


@dataclass(frozen=True)
class GeneratedModel:
    """What a run made: its files in `folder`, the sizes, operations and largest errors of its `summary`.

    `left_out` are quantities that verification rejects by every method, each with a remedy; `notices` are what the
    command prints.  `certificate` is None where nothing was verified.
    """

    name: str
    folder: Path
    files: tuple[Path, ...]
    summary: Summary
    notices: tuple[Notice, ...]
    left_out: tuple[LeftOut, ...]
    certificate: Mapping[str, Any] | None

    @property
    def operations(self) -> dict[str, int]:
        """By quantity."""
        return dict(self.summary.operations)

    def __repr__(self) -> str:
        lines = [summary_table(self.name, self.summary)]
        lines += [f"left out: {one.quantity} ({' and '.join(one.scalars)}): {one.remedy}" for one in self.left_out]
        lines += [f"notice: {notice.message}" for notice in self.notices]
        return "\n".join([*lines, f"{len(self.files)} files in {self.folder}"])

    def _repr_html_(self) -> str:
        return f"<pre>{escape(repr(self))}</pre>"


def made(path: Path, options: Options) -> Result:
    """The files in memory, verified; RejectedError where they are wrong, WrongUseError for parts of nothing."""
    for part in options.parts:
        if part not in ALL_PARTS:
            raise WrongUseError(f"parts: {part!r}; {did_you_mean(part, ALL_PARTS, ', '.join(ALL_PARTS))}")
    result = generate(path, options, unheard)
    if result.failures:
        raise RejectedError("\n".join(result.failures))
    return result


def generated_model(path: Path, out: Path, options: Options) -> GeneratedModel:
    """Makes the files of a model and writes them into `out`/<name>/."""
    recover_folders(out)
    result = made(path, options)
    folder, notices = out / result.model.name, list(result.notices)
    files = write_files(folder, result.files, lambda message: notices.append(Notice(message)))
    outcome = tuple(notices), result.left_out, result.certificate
    return GeneratedModel(result.model.name, folder, files, result.summary, *outcome)


def unheard(_message: str) -> None:
    """Progress that nobody watches."""
