"""`symgen new NAME`: a commented model that works, to be changed into one's own."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from symgen.backends.render import render
from symgen.generation.results import WrongUseError
from symgen.model.expressions.names import MAXIMUM_NAME, RESERVED, is_name


@dataclass(frozen=True, slots=True)
class StartingView:
    """What the template prints."""

    name: str


def write_starting_model(name: str, folder: Path) -> Path:
    """FOLDER/NAME.yaml; raises WrongUseError for a name that is no model's and for a file that exists."""
    if not is_name(name) or name in RESERVED or len(name) > MAXIMUM_NAME or name.endswith(("_dot", "_ddot")):
        raise WrongUseError(f"{name!r} is no name for a model: take letters, digits and _, a letter first, no keyword")
    path = folder / f"{name}.yaml"
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(render("model/new.yaml.jinja", StartingView(name)))
    except FileExistsError:
        raise WrongUseError(f"{path} exists; it is left as it is") from None
    return path
