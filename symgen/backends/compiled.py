"""Templates compiled when symgen is installed, so that a run need not: reading one is a tenth of compiling it.

What is stored is used only for the very text, Jinja and Python it was made from; everything else is compiled as ever.
A run writes nothing here.
"""

from __future__ import annotations

import os
from pathlib import Path

import jinja2
from jinja2 import BytecodeCache, Environment
from jinja2.bccache import Bucket

FOLDER = "compiled"


class CompiledTemplates(BytecodeCache):
    """Reads the files of one folder, each named after its template and Jinja's version."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def get_cache_key(self, name: str, filename: str | None = None) -> str:
        """The name of the template's file, wherever the template itself lies."""
        del filename
        return f"{name.replace('/', '-')}-{jinja2.__version__}"

    def load_bytecode(self, bucket: Bucket) -> None:
        """Fills the bucket where there is a file and its text, by checksum, is that of the template."""
        try:
            with open(self._folder / bucket.key, "rb") as file:
                bucket.load_bytecode(file)
        except FileNotFoundError:
            return

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Keeps nothing."""


def compile_templates(environment: Environment, templates: Path) -> None:
    """Compiles every `*.jinja` under `templates` into its folder `compiled`; no path of this machine gets in."""
    folder = templates / FOLDER
    folder.mkdir(exist_ok=True)
    cache = CompiledTemplates(folder)
    made: set[Path] = set()
    for path in sorted(templates.rglob("*.jinja")):
        name = path.relative_to(templates).as_posix()
        source = path.read_text(encoding="utf-8")
        bucket = cache.get_bucket(environment, name, None, source)
        bucket.code = environment.compile(source, name)
        target = folder / bucket.key
        # several builds may do this at a time, each under names of its own
        staged = target.with_name(f".{target.name}.{os.getpid()}")
        staged.write_bytes(bucket.bytecode_to_string())
        os.replace(staged, target)
        made.add(target)
    for path in set(folder.glob("[!.]*")) - made:
        path.unlink(missing_ok=True)
