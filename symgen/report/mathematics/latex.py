"""Layout as LaTeX mathematics (amsmath)."""

from __future__ import annotations

from itertools import pairwise

from symgen.report.mathematics.layout import (
    CLOSING,
    Accent,
    Application,
    Array,
    Delimiter,
    Fenced,
    Fraction,
    Gap,
    Layout,
    Letter,
    Numeral,
    Product,
    Punctuation,
    Relation,
    Root,
    Row,
    Scripts,
    Sign,
    Sum,
    separator,
    tall,
)

GREEK: dict[str, str] = {
    "α": r"\alpha", "β": r"\beta", "γ": r"\gamma", "δ": r"\delta", "ε": r"\varepsilon", "ζ": r"\zeta", "η": r"\eta",
    "θ": r"\theta", "ϑ": r"\vartheta", "ι": r"\iota", "κ": r"\kappa", "λ": r"\lambda", "μ": r"\mu", "ν": r"\nu",
    "ξ": r"\xi", "π": r"\pi", "ρ": r"\rho", "σ": r"\sigma", "τ": r"\tau", "υ": r"\upsilon", "φ": r"\varphi",
    "χ": r"\chi", "ψ": r"\psi", "ω": r"\omega", "Γ": r"\Gamma", "Δ": r"\Delta", "Θ": r"\Theta", "Λ": r"\Lambda",
    "Ξ": r"\Xi", "Π": r"\Pi", "Σ": r"\Sigma", "Υ": r"\Upsilon", "Φ": r"\Phi", "Ψ": r"\Psi", "Ω": r"\Omega",
    "∂": r"\partial",
}  # fmt: skip
RELATIONS = {
    "=": "=",
    "≠": r"\neq",
    "≡": r"\equiv",
    "≤": r"\leq",
    "≥": r"\geq",
    "<": "<",
    ">": ">",
    "∈": r"\in",
    ":=": ":=",
    "×": r"\times",
}
FUNCTIONS = frozenset(
    ["sin", "cos", "tan", "arcsin", "arccos", "arctan", "sinh", "cosh", "tanh", "ln", "exp", "det", "dim", "ker"]
)
MARKS = {"dot": r"\dot", "ddot": r"\ddot", "bar": r"\bar", "tilde": r"\tilde"}
SEPARATORS = {"": " ", "thin": r"\,", "point": r" \cdot "}
SIGNS = {"+": "+", "-": "-", "·": r"\cdot"}


def latex_math(node: Layout) -> str:
    """The node in LaTeX's math mode."""
    match node:
        case Numeral(text=text):
            return text
        case Letter():
            return _letter(node)
        case Relation(text=text):
            return f" {RELATIONS[text]} "
        case Sign(text=text, prefix=prefix):
            return f"{SIGNS[text]} " if prefix else f"{{}}{SIGNS[text]} "
        case Punctuation(text=","):
            return ", "
        case Punctuation(text=text):
            return rf"\text{{{text}}}\ "
        case Gap():
            return r"\qquad "
        case Delimiter(text=text, upper=upper):
            mark = rf"\bigl{text}" if text in "([" else rf"\bigr{text}"
            return mark + ("" if upper is None else f"^{{{latex_math(upper)}}}")
        case Scripts(base=base, lower=lower, upper=upper):
            below = "" if lower is None else f"_{{{latex_math(lower)}}}"
            above = "" if upper is None else f"^{{{latex_math(upper)}}}"
            return f"{_base(base)}{below}{above}"
        case Accent(base=base, mark=mark):
            return f"{MARKS[mark]}{{{latex_math(base)}}}"
        case Fraction(numerator=numerator, denominator=denominator):
            return rf"\frac{{{latex_math(numerator)}}}{{{latex_math(denominator)}}}"
        case Root(radicand=radicand):
            return rf"\sqrt{{{latex_math(radicand)}}}"
        case Fenced(body=body, fence=fence):
            if not tall(body):
                return f"{fence}{latex_math(body)}{CLOSING[fence]}"
            return rf"\left{fence or '.'} {latex_math(body)} \right{CLOSING[fence] or '.'}"
        case Application(function=function, argument=argument):
            return f"{latex_math(function)} {latex_math(argument)}"
        case Product(factors=factors):
            parts = [latex_math(factors[0])]
            for left, right in pairwise(factors):
                kind = separator(left, right)
                parts += (
                    " " if kind == "thin" and isinstance(right, Application) else SEPARATORS[kind],
                    latex_math(right),
                )
            return "".join(parts)
        case Sum(terms=terms):
            return " ".join(_term(*term, first=k == 0) for k, term in enumerate(terms))
        case Row(pieces=pieces):
            return "".join(latex_math(piece) for piece in pieces)
        case Array(rows=rows, fence=fence):
            lines = r" \\ ".join(" & ".join(latex_math(entry) for entry in row) for row in rows)
            environment = "pmatrix" if fence == "(" else "vmatrix"
            return rf"\begin{{{environment}}} {lines} \end{{{environment}}}"


def _letter(letter: Letter) -> str:
    """A letter, Greek ones by name, words upright."""
    text = letter.text
    if text in GREEK:
        return rf"\boldsymbol{{{GREEK[text]}}}" if letter.style == "bold" else f"{GREEK[text]} "
    if letter.style == "bold":
        return rf"\mathbf{{{text}}}"
    if letter.style == "italic":
        return text
    if text in FUNCTIONS:
        return rf"\{text}"
    return rf"\mathrm{{{text.replace(' ', '~')}}}"


def _base(node: Layout) -> str:
    """What carries indices; braces keep groups together, function names keep their limits away."""
    text = latex_math(node)
    return text if isinstance(node, (Letter, Numeral, Fenced)) else f"{{{text}}}"


def _term(sign: str, term: Layout, first: bool) -> str:
    """A term of a sum with its sign; a leading plus is left out."""
    body = latex_math(term)
    return (f"-{body}" if sign == "-" else body) if first else f"{sign} {body}"
