"""LaTeX for the names of a model: x_dot becomes a dotted x, theta a Greek letter, a_1 an index."""

from __future__ import annotations

_NAMES = (
    "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi chi psi "
    "omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega"
)
GREEK = frozenset(_NAMES.split(" "))


def latex_name(name: str) -> str:
    """A name as LaTeX: Greek letters, indices after underscores, dots for rates and accelerations."""
    for suffix, accent in (("_ddot", r"\ddot"), ("_dot", r"\dot")):
        if name.endswith(suffix):
            head, *indices = name.removesuffix(suffix).split("_")
            return _with_indices(f"{accent}{{{_letter(head)}}}", indices)
    head, *indices = name.split("_")
    if head == "multiplier":
        head = "lambda"
    return _with_indices(_letter(head), indices)


def _letter(text: str) -> str:
    if text in GREEK:
        return f"\\{text}"
    if len(text) <= 1:
        return text
    stem = text.rstrip("0123456789")
    if stem != text and (len(stem) == 1 or stem in GREEK):
        return f"{_letter(stem)}_{{{text[len(stem) :]}}}"
    return f"\\mathrm{{{text}}}"


def _with_indices(letter: str, indices: list[str]) -> str:
    shown = [part for part in indices if part]
    if not shown:
        return letter
    text = ",".join(part if len(part) == 1 or part.isdigit() else _letter(part) for part in shown)
    if "_{" in letter:
        return (
            f"{{{letter}}}_{{{text}}}" if letter.endswith("}") and letter.startswith("{") else f"{letter[:-1]},{text}}}"
        )
    return f"{letter}_{{{text}}}"
