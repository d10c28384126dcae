"""The shape of the C text that no compiler checks."""

from __future__ import annotations

import re

import handmade
import pytest

from symgen.backends.c.plain import emit_c
from symgen.backends.python.module import emit_python


def kernel_body(text: str, name: str) -> list[str]:
    start = text.index(f"{name}(", text.index(".h"))
    return [line.strip() for line in text[start : text.index("\n}", start)].splitlines()[1:]]


def test_files_of_each_scalar_type() -> None:
    model = handmade.model()
    assert list(emit_c(model, handmade.program())) == ["c/toy.h", "c/toy.c"]
    assert list(emit_c(model, handmade.program("float32"))) == ["c/toy_f.h", "c/toy_f.c"]
    assert list(emit_python(model, handmade.program())) == ["python/toy.py"]


def test_every_load_comes_before_every_store() -> None:
    body = kernel_body(emit_c(handmade.model(), handmade.program())["c/toy.c"], "toy_inverse_dynamics")
    loads = [k for k, line in enumerate(body) if re.search(r"= (q|qd|qdd)\[|p->", line)]
    stores = [k for k, line in enumerate(body) if line.startswith("u[")]
    assert max(loads) < min(stores)
    assert body[max(stores) + 1 :] == ["return TOY_OK;"]


def test_signature_follows_the_quantity_and_unused_arguments_stay() -> None:
    header = emit_c(handmade.model(), handmade.program("float32"))["c/toy_f.h"]
    assert (
        "toy_status toy_inverse_dynamics_f(const float q[2], const float qd[2], const float qdd[2], "
        "const toy_params_f *p, float u[2]);" in header
    )
    assert "toy_status toy_control_matrix_f(const float q[2], const toy_params_f *p, float M[4]);" in header


def test_header_tells_symbols_units_renaming_and_operations() -> None:
    header = emit_c(handmade.model(), handmade.program())["c/toy.h"]
    assert " *   q[1] theta [rad] heading\n" in header
    assert " *   I is I_\n" in header
    assert re.search(r"\* inverse_dynamics +2 +3 +2 +1 +1 +0\n", header)
    assert "double I_; /**< [kg*m^2] a name that complex.h defines; default 0.26 */" in header


def test_no_parameter_gives_one_unused_member() -> None:
    toy = handmade.model(parameters=())
    program = handmade.Program("float64", None, (handmade.constant(),))
    assert "double unused;" in emit_c(toy, program)["c/toy.h"]


def test_constants_need_neither_library_nor_test() -> None:
    program = handmade.Program("float64", None, (handmade.constant(),))
    text = emit_c(handmade.model(), program)["c/toy.c"]
    assert "math.h" not in text
    assert "NOT_FINITE" not in text


def test_output_gives_way_to_a_name_of_the_user() -> None:
    toy = handmade.model(parameters=(*handmade.model().parameters, handmade.parameter("G", handmade.number("1"))))
    assert "double G_out[4])" in emit_c(toy, handmade.program())["c/toy.h"]


@pytest.mark.parametrize("description", ["*/ #error", "??/", "ends \\", "{{ 7*7 }} {% endif %}"])
def test_description_stays_in_its_comment(description: str) -> None:
    toy = handmade.model(description=description, source=description)
    header = emit_c(toy, handmade.program())["c/toy.h"]
    comment = header[: header.index("#ifndef")]
    assert comment.count("*/") == 1
    assert comment.rstrip().endswith("*/")
    assert "49" not in comment


def test_text_is_the_same_every_time() -> None:
    assert emit_c(handmade.model(), handmade.program()) == emit_c(handmade.model(), handmade.program())
