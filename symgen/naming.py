"""Names that compile wherever the generated C is built, and that several models can have side by side.

A name that clashes gets an ending, so the mapping is deterministic, injective and easy to guess.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable
from functools import cache

from symgen.registered import endings, hiding

# Endings by which the files of one model, and groups of functions, differ: `rob_f.h` is the float32 of `rob`.
_KINDS = r"(?:_(?:batch|prepared|sc))?(?:_f)?"
_STEM = re.compile(rf"(.*?)({_KINDS})")
_RENAMED = "_model"
# Names of letters that are shown as letters.
GREEK: dict[str, str] = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "zeta": "ζ", "eta": "η", "theta": "θ",
    "iota": "ι", "kappa": "κ", "lamda": "λ", "lambda": "λ", "lam": "λ", "mu": "μ", "nu": "ν", "xi": "ξ", "pi": "π",
    "rho": "ρ", "sigma": "σ", "tau": "τ", "upsilon": "υ", "phi": "φ", "varphi": "φ", "chi": "χ", "psi": "ψ",
    "omega": "ω", "Gamma": "Γ", "Delta": "Δ", "Theta": "Θ", "Lambda": "Λ", "Xi": "Ξ", "Pi": "Π", "Sigma": "Σ",
    "Upsilon": "Υ", "Phi": "Φ", "Psi": "Ψ", "Omega": "Ω", "vartheta": "ϑ",
}  # fmt: skip


def identifiers(
    names: Iterable[str], is_taken: Callable[[str], bool], taken: Collection[str] = frozenset()
) -> dict[str, str]:
    """Maps each name to an identifier that is neither taken in a language, nor here, nor given to another name."""
    wanted = tuple(dict.fromkeys(names))
    forbidden = frozenset(taken)
    result = {name: name for name in wanted if not (name in forbidden or is_taken(name))}
    used = set(wanted)
    for name in wanted:
        if name in result:
            continue
        candidate = name + "_"
        while candidate in forbidden or candidate in used or is_taken(candidate):
            candidate += "_"
        used.add(candidate)
        result[name] = candidate
    return {name: result[name] for name in wanted}


def c_name(model_name: str) -> str:
    """What the files, functions and types of a model are called: its own name, or that with `_model` behind it.

    The ending is for names that would hide a header, module, target or library, and for those whose files, functions
    or macros could be another model's: `rob_f.h` holds the float32 functions of `rob`, `rob_minimal_mass_matrix` is a
    function of `rob`. No two models have the same.
    """
    plain = model_name.lower()
    while plain.endswith(_RENAMED):
        plain = plain.removesuffix(_RENAMED)
    clashes = plain in hiding() or _clashing().fullmatch(model_name.lower()) is not None
    return model_name + _RENAMED if clashes else model_name


@cache
def _clashing() -> re.Pattern[str]:
    return re.compile(f".*_(?:{'|'.join(sorted(endings()))})(?:_model)*")


def macro_name(stem: str) -> str:
    """What macros and enumerators of a file or a model begin with; no two models have the same.

    `stem` is a `c_name`, or that with the ending of a file. Names in small letters are put in capitals and names in
    capitals in small letters; others stay. Endings are in capitals.
    """
    match = _STEM.fullmatch(stem)
    assert match is not None
    name, kind = match.groups()
    lower, upper = name.lower(), name.upper()
    return (upper if name == lower else lower if name == upper else name) + kind.upper()
