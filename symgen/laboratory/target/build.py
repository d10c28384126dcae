"""Compiling the generated C for a core or for the host, and linking it with the driver into an image."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from symgen.backends.render import render, template_folder
from symgen.laboratory.target.cores import Compiler, Core
from symgen.laboratory.target.tools import run, toolchain

# What generated build files pass; see the README of a generated folder.
FLAGS = ("-std=c99", "-ffp-contract=off", "-fno-math-errno", "-ffunction-sections", "-fdata-sections")
BOARD_FLAGS = ("-std=gnu99", "-O1")
STACK_WATCHED = 16384


@dataclass(frozen=True, slots=True)
class ScriptView:
    """What the linker script's template prints."""

    code_origin: str
    code_length: str
    data_origin: str
    data_length: str


@dataclass(frozen=True, slots=True)
class Workshop:
    """A folder with sources and objects of one core (None: the host)."""

    folder: Path
    core: Core | None

    def write(self, files: Mapping[str, str]) -> None:
        """Puts sources into the folder, and the board and the linker script beside them."""
        self.folder.mkdir(parents=True, exist_ok=True)
        templates = template_folder() / "target"
        for name in ("board.h", "board_host.c" if self.core is None else "board_bare.c"):
            (self.folder / name).write_text((templates / name).read_text(encoding="utf-8"), encoding="utf-8")
        for name, text in files.items():
            (self.folder / name).write_text(text, encoding="utf-8")
        if self.core is not None:
            code, data = self.core.code, self.core.data
            view = ScriptView(code.origin, code.length, data.origin, data.length)
            (self.folder / "link.ld").write_text(render("target/link.ld.jinja", view), encoding="utf-8")

    def compile(self, source: str, level: str, compiler: Compiler = "gcc", flags: Sequence[str] = ()) -> Path:
        """An object of generated C at one level of optimisation; gcc also writes its stack usage beside it."""
        target = self.object(source, level, compiler)
        usage = ("-fstack-usage",) if compiler == "gcc" else ()
        command = [*self._command(compiler), *FLAGS, level, *usage, *flags, "-c", "-o", str(target), source]
        run(command, self.folder)
        return target

    def object(self, source: str, level: str, compiler: Compiler = "gcc") -> Path:
        """Where `compile` puts the object of a source."""
        return self.folder / f"{Path(source).stem}_{compiler}{level}.o"

    def harness(self, driver: str, watched: int) -> tuple[Path, ...]:
        """The objects of driver and board; `watched` bytes of stack are painted before every call."""
        board = "board_host.c" if self.core is None else "board_bare.c"
        objects = []
        for source, name in ((driver, f"{Path(driver).stem}.o"), (board, f"{Path(board).stem}_{watched}.o")):
            target = self.folder / name
            if not target.exists():
                flags = [*BOARD_FLAGS, f"-DWATCHED={watched}u"]
                run([*self._command("gcc"), *flags, "-c", "-o", str(target), source], self.folder)
            objects.append(target)
        return tuple(objects)

    def link(self, name: str, objects: Sequence[Path]) -> Path:
        """An image (or a program of the host) in a folder of its own name, where it will find its files."""
        folder = self.folder / name
        folder.mkdir(exist_ok=True)
        image = folder / "image.elf"
        script = [] if self.core is None else ["-nostartfiles", "-T", str(self.folder / "link.ld")]
        command = [*self._command("gcc"), *script, "-Wl,--gc-sections", "-Wl,--no-warn-rwx-segments"]
        run([*command, "-o", str(image), *map(str, objects), "-lm"], self.folder)
        return image

    def tool(self, name: str) -> str:
        """The name of a binary tool: nm, size, ld."""
        return name if self.core is None else toolchain(self.core.family).prefix + name

    def _command(self, compiler: Compiler) -> list[str]:
        if self.core is None:
            return [compiler]
        chain = toolchain(self.core.family)
        if compiler == "clang":
            return ["clang", *self.core.clang, *chain.include]
        return [f"{chain.prefix}gcc", *chain.specs, *self.core.gcc]
