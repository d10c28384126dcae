"""Words of ROS 2: none beside those of C, since no name of a model file becomes one there but that of the package."""

from __future__ import annotations

from symgen.registered import Words

WORDS = Words({}, lambda _: False)


def package_name(stem: str) -> str:
    """What a model's package is called, whose files are called `stem`: small letters, digits and single underscores."""
    words = [word for word in stem.lower().split("_") if word]
    return "_".join((*words, "inverse_dynamics_solver"))
