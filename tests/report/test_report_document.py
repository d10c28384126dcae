"""Whole reports: complete, deterministic, self-contained, well-formed, whatever the user wrote."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import sympy
import typst
from report_inputs import HERE, document, measured_document, measured_input, report_input

from symgen.report.compose import compose, compose_measured
from symgen.report.content import Verification
from symgen.report.document import ROOM, InlineMath, Items, Paragraph, Table
from symgen.report.html import render_html
from symgen.report.latex import drawing_file, latex_text, render_latex, render_latex_sections
from symgen.report.mathematics.measure import page_width
from symgen.report.pdf import render_drawing, render_pdf, render_typst
from symgen.report.prose import INLINE_ROOM, say
from symgen.report.sections.singular import without_parameters
from symgen.report.terminal import render_text_math
from symgen.verify.invariants import _laws

NAMES = ("skate", "front_car", "double_pendulum", "slider_crank", "delta", "rapkm_bodies", "gough_stewart", "hostile")
HTML = "{http://www.w3.org/1999/xhtml}"


@pytest.mark.parametrize("name", NAMES)
def test_html_is_well_formed_and_refers_to_nothing_outside(name: str) -> None:
    page = render_html(measured_document(name))
    root = ElementTree.fromstring(page.removeprefix("<!DOCTYPE html>\n"))
    for element in root.iter():
        assert element.tag.removeprefix(HTML) not in {"script", "link", "img", "iframe", "object", "base"}
        for attribute, value in element.attrib.items():
            assert not attribute.startswith("on")
            assert attribute not in {"src", "srcset", "data", "action"}
            assert attribute != "href" or value.startswith("#")
    assert "@import" not in page
    assert "url(" not in page


@pytest.mark.parametrize("name", NAMES)
def test_links_inside_the_page_have_targets(name: str) -> None:
    page = render_html(document(name))
    targets = set(re.findall(r' id="([^"]+)"', page))
    assert set(re.findall(r'href="#([^"]+)"', page)) <= targets


def test_user_text_is_shown_as_it_is() -> None:
    description = report_input("hostile").model.description
    root = ElementTree.fromstring(render_html(document("hostile")).removeprefix("<!DOCTYPE html>\n"))
    heading = root.find(f".//{HTML}h1")
    assert heading is not None
    assert heading.text == " ".join(description.split())


def test_latex_escapes_every_special_character() -> None:
    assert latex_text(r"\ { } $ & # % _ ~ ^") == (
        r"\textbackslash{} \{ \} \$ \& \# \% \_ \textasciitilde{} \textasciicircum{}"
    )
    assert latex_text("日α ü") == r"\texttt{U+65E5}$\alpha$ ü"


@pytest.mark.parametrize("name", NAMES)
def test_latex_has_balanced_braces_and_environments(name: str) -> None:
    source = render_latex(measured_document(name))
    bare = source.replace(r"\\", "").replace(r"\{", "").replace(r"\}", "")
    depth = 0
    for character in bare:
        depth += {"{": 1, "}": -1}.get(character, 0)
        assert depth >= 0
    assert depth == 0
    stack: list[str] = []
    for kind, environment in re.findall(r"\\(begin|end)\{([a-z*]+)\}", source.replace(r"\textbackslash{}", "")):
        if kind == "begin":
            stack.append(environment)
        else:
            assert stack.pop() == environment
    assert stack == []
    assert source.count(r"\left") == source.count(r"\right")


PAPER = r"""\documentclass{article}
\usepackage[T1]{fontenc}
\usepackage{amsmath,amssymb,array,longtable,graphicx}
\usepackage[a4paper,margin=25mm]{geometry}
\begin{document}
\section{Methods}
\input{report}
\end{document}
"""


def test_latex_has_labels_in_place_of_numbers() -> None:
    source = render_latex(document("delta"))
    assert r"\tag" not in source
    labels = re.findall(r"\\label\{([^}]*)\}", source)
    assert len(labels) == len(set(labels))
    assert set(re.findall(r"\\(?:eq)?ref\{([^}]*)\}", source)) <= set(labels)
    assert {"eq:delta:motion", "fig:delta:mechanism"} <= set(labels)


@pytest.mark.parametrize("name", ["delta", "front_car"])
def test_figures_are_numbered_and_referred_to(name: str) -> None:
    shown = measured_document(name)
    assert [*shown.figure_numbers().values()] == [str(k + 1) for k in range(len([*shown.figures()]))]
    page = render_html(shown)
    for number in shown.figure_numbers().values():
        assert f'<a href="#f{number}">Figure {number}</a>' in page
        assert f"<figcaption>Figure {number}. " in page
        assert f'link(label("f{number}"), "Figure {number}")' in render_typst(shown)


@pytest.mark.parametrize("name", ["front_car", "hostile"])
def test_what_was_measured_is_in_html_and_latex_of_its_own(name: str) -> None:
    """The last sections of the PDF: what is without them is the same on every machine."""
    measured, everything = compose_measured(measured_input(name)), measured_document(name)
    assert measured.sections == everything.sections[-len(measured.sections) :]
    assert document(name).sections == everything.sections[: -len(measured.sections)]
    page, source = render_html(measured), render_latex_sections(measured)
    for text in (page, source):
        assert "64 admissible states" in text
        assert "Charts" in text
    ElementTree.fromstring(page.removeprefix("<!DOCTYPE html>\n"))
    assert r"\begin{document}" not in source
    # one document has the labels of both
    labels = re.findall(r"\\label\{([^}]*)\}", source + render_latex(document(name)))
    assert len(labels) == len(set(labels))
    stem = measured.name
    assert rf"\IfFileExists{{{stem}.measured.tex}}{{\input{{{stem}.measured.tex}}}}{{}}" in render_latex(document(name))
    assert f"{stem}.measured.html" in document(name).colophon


@pytest.mark.toolchain
@pytest.mark.parametrize("name", ["front_car", "delta", "hostile"])
def test_latex_compiles(name: str, tmp_path: Path, tool: Callable[[str], str]) -> None:
    """By itself with what was measured, and brought into another document: references are found, nothing sticks out."""
    measured = compose_measured(measured_input(name))
    (tmp_path / "report.tex").write_text(render_latex(document(name)), encoding="utf-8")
    (tmp_path / f"{measured.name}.measured.tex").write_text(render_latex_sections(measured), encoding="utf-8")
    (tmp_path / "paper.tex").write_text(PAPER, encoding="utf-8")
    figures = (*document(name).figures(), *measured.figures())
    drawings = {drawing_file(document(name).name, figure): render_drawing(figure) for figure in figures}
    for file, drawn in drawings.items():
        (tmp_path / file).write_bytes(drawn)
    for file in ("report.tex", "paper.tex"):
        command = [tool("pdflatex"), "-interaction=nonstopmode", "-halt-on-error", file]
        for _ in range(2):
            run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, errors="replace", check=False)
            assert run.returncode == 0, run.stdout[-2000:]
        assert not re.search(r"Overfull \\hbox \((\d{2,})\.", run.stdout), run.stdout
        assert "undefined" not in run.stdout, run.stdout
        assert all(f"<./{drawn}>" in run.stdout.replace("\n", "") for drawn in drawings)


@pytest.mark.parametrize("name", ["front_car", "hostile"])
def test_pdf_is_made_and_repeats(name: str) -> None:
    first = render_pdf(measured_document(name))
    assert first.startswith(b"%PDF")
    assert first == render_pdf(measured_document(name))


@pytest.mark.parametrize("name", NAMES)
def test_no_formula_is_wider_than_the_page(name: str) -> None:
    for formula in document(name).formulas():
        for position, line in ((k, line) for rows in formula.equations for k, line in enumerate(rows)):
            assert page_width(line) + (2.0 if position else 0.0) <= ROOM


def test_measurements_stand_in_their_own_sections() -> None:
    plain, measured = document("skate"), measured_document("skate")
    assert measured.sections[: len(plain.sections)] == plain.sections
    assert len(measured.sections) == len(plain.sections) + 2
    assert "64 admissible states" in render_typst(measured)
    assert "admissible states" not in render_html(plain)
    assert "charts along paths, are in the PDF" in render_html(plain)
    assert "are in the PDF" not in render_typst(measured)


def test_report_names_what_there_is_not() -> None:
    page = render_html(document("double_pendulum"))
    assert "There are no constraints" in page
    assert "the projector is the identity" in page
    assert "The mass matrix is constant" in render_html(document("skate"))
    assert "There is no potential energy" in render_html(document("skate"))


def test_report_says_all_about_the_front_car() -> None:
    source = " ".join(render_latex(document("front_car")).split())
    for text in (
        r"a = L^{2} + (L^{2} - 1) \cos 2 \varphi + 1",
        r"L^{2} \sin 2 \theta \cos^{2} \varphi",
        r"\cos \theta \cos \varphi & \sin \theta \cos \varphi & \frac{\sin \varphi }{L} & 0",
        r"\texttt{rear\_axle} is not integrable",
        "non-redundantly full-actuated",
        "distance of the axles",
    ):
        assert text in source, text


def test_components_of_u_are_called_as_their_inputs() -> None:
    source = render_latex(document("front_car"))
    assert r"& K_{f} = \frac{" in source
    assert r"& T = \Theta _{2} \ddot{\varphi }" in source
    car = report_input("front_car")
    assert "\n  T = Θ₂ φ̈" in render_text_math(car.forms["inverse_dynamics"].matrix, car.model, "inverse_dynamics", 80)


def test_verdicts_that_are_not_identical_show_the_printed_form() -> None:
    source = render_latex(document("front_car"))
    assert "misprinted" in source
    assert r"Equation (40) prints" in source
    assert r"Equation (42) prints" not in source


def test_short_report_leaves_long_matrices_out() -> None:
    full = report_input("front_car")
    short = compose(replace(full, model=replace(full.model, report="short")))
    assert "left out of this short report" in render_latex(short)
    assert len(render_latex(short)) < 0.9 * len(render_latex(compose(full)))


def test_slots_must_match_places() -> None:
    with pytest.raises(ValueError, match="1 slots for 2 places"):
        say("{} and {}", "one")
    assert say("{}!", "{}") == ("{}", "!")


def test_inline_formulas_are_short() -> None:
    """Sentences cannot break inside a formula, so none of it may be long."""
    for section in document("front_car").sections:
        for block in section.blocks:
            texts = {
                Paragraph: lambda b: (b.text,),
                Items: lambda b: b.items,
                Table: lambda b: (cell for row in b.rows for cell in row),
            }.get(type(block), lambda _: ())(block)
            for text in texts:
                assert all(page_width(part.node) < 20 for part in text if isinstance(part, InlineMath))


SCRIPT = """
import sys
sys.path.insert(0, sys.argv[1])
from report_inputs import document
from symgen.report.html import render_html
from symgen.report.latex import render_latex
sys.stdout.reconfigure(encoding="utf-8")
for name in ("front_car", "delta", "rapkm_bodies", "gough_stewart"):
    print(render_html(document(name)), render_latex(document(name)))
"""


@pytest.mark.slow
def test_text_does_not_depend_on_the_hash_seed() -> None:
    texts = []
    for seed in ("1", "2"):
        environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(HERE.parent.parent)}
        command = [sys.executable, "-c", SCRIPT, str(HERE)]
        texts.append(subprocess.run(command, env=environment, capture_output=True, check=True).stdout)
    assert len(texts[0]) > 10000
    assert texts[0] == texts[1]


def test_long_matrices_are_laws_and_long_singular_sets_determinants() -> None:
    source = " ".join(render_latex(document("delta")).split())
    for text in (
        r"\mathbf{N}_{\mathbf{B}} = \mathbf{I} - \mathbf{B}^{\mathrm{T}} \mathbf{S}^{-1} \mathbf{B}",
        r"\mathbf{u} = \boldsymbol{\tau}_{a} - \mathbf{B}_{a}^{\mathrm{T}} (\mathbf{B}_{p}^{\mathrm{T}})^{-1}",
        r"-\frac{\mathbf{B}_{1, 4}}{\mathbf{B}_{1, 1}}",
        r"D_{1} = \begin{vmatrix} \mathbf{B}_{1, 4} & \mathbf{B}_{1, 5} & \mathbf{B}_{1, 6} \\",
        "There motions are possible on which no input works.",
    ):
        assert text in source, text
    for text in ("not worked out", "is not printed", r"\Phi"):
        assert text not in source, text


def test_operations_add_up_to_their_total() -> None:
    """Whatever is counted has a column."""
    counts = {"mass_matrix": {"add": 2, "mul": 5, "div": 0, "sqrt": 0, "sincos": 1, "sign": 4, "other": 0}}
    (table,) = (
        block
        for section in compose(replace(report_input("skate"), operation_counts=counts)).sections
        for block in section.blocks
        if isinstance(block, Table) and block.headings[-1] == say("Total")
    )
    headings = [str(heading[0]) for heading in table.headings[2:]]
    numbers = [int(str(cell[0])) for cell in table.rows[0][2:]]
    assert headings == ["+ −", "×", "sincos", "±", "Total"]
    assert numbers == [2, 5, 1, 4, 12]


def test_printed_singular_sets_have_no_factors_that_vanish_nowhere() -> None:
    """Of the RA-PKM's inputs: three products vanish at once, each without the square of a length before it."""
    source = " ".join(render_latex(document("rapkm_bodies")).split())
    begins, ends = "not continuous; this happens where all of these expressions vanish at once:", "What is measured"
    listed = source.partition(begins)[2].partition(ends)[0]
    assert listed.count("= 0") == 3
    assert "l_{" not in listed
    a, b, l_1 = sympy.symbols("a b l_1")
    kept = sympy.sin(a) * (l_1 + sympy.cos(b))
    assert without_parameters(-(l_1**2) * kept, [a, b]) == kept
    assert without_parameters(l_1 + sympy.cos(b), [a, b]) == l_1 + sympy.cos(b)


def test_minors_of_two_directions_are_one_matrix() -> None:
    source = " ".join(render_latex(document("rapkm_bodies")).split())
    assert r"\frac{1}{\Sigma _{\Phi }}\,\boldsymbol{\Phi} \boldsymbol{\Phi}^{\mathrm{T}}" in source
    assert r"where $\boldsymbol{\Phi}$ vanishes, that is where $\Sigma _{\Phi } = 0$" in source


def test_formulas_in_tables_break() -> None:
    """A reason that quotes a long formula, as that of a method of the Delta robot does."""
    delta = report_input("delta")
    factor = "(2*cos(a_{0})*l_1*(z + l_1*sin(a_{0})) + 2*sin(a_{0})*l_1*(x + r - (R + l_1*cos(a_{0}))))"
    reason = f"this method is singular where `{'*'.join(map(factor.format, (1, 2, 3)))}` = 0"
    shown = compose(replace(delta, skipped=(("method nullspace of u", reason), ("(B Bᵀ)⁻¹", "3 minors"))))
    table = next(block for block in shown.sections[6].blocks if isinstance(block, Table))
    pieces = [part.node for part in table.rows[0][1] if isinstance(part, InlineMath)]
    assert len(pieces) > 3
    assert all(page_width(piece) <= INLINE_ROOM for piece in pieces)
    assert r"(B B$^{\mathrm{T}}$)$^{-}$$^1$" in render_latex(shown)


UNKNOWN: Any = None  # what laws are evaluated on, which their names do not need


@pytest.mark.parametrize("law", [name for _, (name, _, _) in _laws(UNKNOWN, admissible=True)])
def test_laws_are_set(law: str) -> None:
    verification = Verification(8, (), (("C float64", law, "0.1"),), ())
    shown = compose(replace(report_input("skate"), verification=verification))
    table = [block for block in shown.sections[-1].blocks if isinstance(block, Table)][-1]
    words = "".join(part for part in table.rows[0][0] if isinstance(part, str))
    assert not re.search(r"[=~']", words), words


def test_a_long_jacobian_is_a_product() -> None:
    source = " ".join(render_latex(document("gough_stewart")).split())
    assert r"\mathbf{B} = \mathbf{K} \mathbf{J}" in source
    assert r"\mathbf{K}_{1, 1} = 2 x_{\mathrm{head~1}} - 2 x_{\mathrm{foot~1}}" in source


def test_numbers_from_robot_files_are_short() -> None:
    source = render_latex(document("five_bar"))
    assert max(len(digits) for digits in re.findall(r"\d+", source)) <= 9
    assert "Numbers of more than 9 digits are shown with 6" in source
    assert "digits are shown" not in render_latex(document("front_car"))


def test_the_derivatives_of_a_task_are_printed() -> None:
    source = " ".join(render_latex(document("five_bar")).split())
    assert r"Their rates are $\dot{x} = \mathbf{J}_{x} \dot{\mathbf{q}}$" in source
    assert r"\label{eq:five_bar:Jx}" in source
    jacobian = report_input("five_bar").forms["task_jacobian"].matrix
    assert jacobian is not None
    assert jacobian.shape == (2, 4)
    motor, elbow = sympy.symbols("left_motor left_elbow")
    ends = [0.16 * sympy.sin(motor) + 0.22 * sympy.sin(motor + elbow), 0.22 * sympy.sin(motor + elbow)]
    values = {motor: 0.3, elbow: -1.1}
    assert [-jacobian[0, k].evalf(subs=values) for k in (0, 2)] == pytest.approx([e.subs(values) for e in ends])


def test_no_last_page_is_left_to_what_the_report_is_by() -> None:
    """It stands at the foot of the first page, once."""
    source = render_typst(measured_document("front_car"))
    by = "Derived by symgen 1.2.3."
    assert source.count(by) == 1
    assert source.index(by) < source.index("here().page() == 1") + 200 < source.index("= #")


def test_a_short_formula_stays_on_its_page() -> None:
    """Seven formulas of four lines on pages that have room for five lines: each begins where there is room for all."""
    head = render_typst(document("skate")).split("#align(center)[")[0]
    small = head.replace('paper: "a4"', "width: 120mm, height: 100mm").replace("here().page() == 1", "false")
    four = "#formula(none, " + ", ".join(["$ a = b $"] * 4) + ")"
    mark = "#context [#metadata(here().page()) <page>]"
    body = "\n\n".join(f"{four.replace('$ a = b $', f'[$ a = b $ {mark}]')}" for _ in range(7))
    pages = [one["value"] for one in json.loads(typst.query((small + body).encode(), "<page>"))]
    assert len(pages) == 28
    assert max(pages) > 1
    assert all(len(set(pages[k : k + 4])) == 1 for k in range(0, 28, 4))
