"""Templates: found beside the package in a checkout and inside it in a wheel; filled by Jinja2, strictly."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jinja2 import Environment


def template_folder() -> Path:
    """The folder of all templates."""
    package = Path(__file__).resolve().parent.parent
    inside = package / "templates"
    return inside if inside.is_dir() else package.parent / "templates"


@cache
def _environment() -> Environment:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    from symgen.backends.compiled import FOLDER, CompiledTemplates

    folder = template_folder()
    return Environment(
        loader=FileSystemLoader(folder),
        bytecode_cache=CompiledTemplates(folder / FOLDER),
        auto_reload=False,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )


def load() -> None:
    """Loads what fills templates: before a process is forked that fills some as well, once for both."""
    _environment()


def compile_all() -> None:
    """Compiles the templates beside them, for runs to come: called once, when symgen is built or installed."""
    from symgen.backends.compiled import compile_templates

    compile_templates(_environment(), template_folder())


def render(template: str, view: object) -> str:
    """The template (a path under the template folder) filled with one prepared view, available as `view`."""
    return _environment().get_template(template).render(view=view)
