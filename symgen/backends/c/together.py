"""C99 of quantities that are wanted in one call: functions that store several results, and make once what is shared."""

from __future__ import annotations

from dataclasses import replace

from symgen.backends.about import count_lines, shape_text
from symgen.backends.c.bodies.functions import Results, kernel_function
from symgen.backends.c.endings import TOGETHER
from symgen.backends.c.file import file_view, files
from symgen.backends.c.names import global_name, variant_names
from symgen.backends.locals import array_arguments, user_names
from symgen.backends.quantities import meaning, output_argument
from symgen.backends.scalars import file_stem
from symgen.ir.kernel import Program
from symgen.ir.together import Together, together_of
from symgen.model.model import Model

_ABOUT = (
    "Kernels of {header} in one call. Results have the bits that they have alone. The status is the first that",
    "any of them would report; all results are untouched on another than 0.",
)


def emit_c_together(model: Model, program: Program) -> dict[str, str]:
    """`c/<model>_together.h`, `.c` (float32: `_together_f`), or nothing where nothing is wanted in one call."""
    made = together_of(model.together, program)
    if not made:
        return {}
    kernels = tuple(one.kernel for one in made)
    results = [results_of(model, one) for one in made]
    own = {name for arrays in results for name, _ in arrays}
    names = variant_names(model, program, kernels, TOGETHER, own)
    given = {"p": f"const {global_name(model.c_name, program.scalar, 'params')} *p"}
    joined = replace(program, kernels=kernels)
    functions = (
        kernel_function(model, joined, one.kernel, names, _about_results(one, arrays), given, TOGETHER, arrays)
        for one, arrays in zip(made, results, strict=True)
    )
    about = [line.format(header=f"{file_stem(model.c_name, program.scalar)}.h") for line in _ABOUT]
    return files(file_view(model, joined, TOGETHER, (*about, "", *count_lines(joined)), tuple(functions)))


def results_of(model: Model, one: Together) -> Results:
    """The arrays of the results, by names that none of the arguments or of the model's own numbers has."""
    taken = {*user_names(model), *(argument.name for argument in array_arguments(one.kernel))}
    arrays: dict[str, int] = {}
    for part in one.parts:
        name = output_argument(part.name)
        while name in taken or name in arrays:
            name += "_out"
        arrays[name] = len(part.outputs)
    return tuple(arrays.items())


def _about_results(one: Together, arrays: Results) -> str:
    """What each array is for."""
    named = zip(one.parts, arrays, strict=True)
    return "; ".join(f"{name} is {meaning(part)}; {shape_text(part)}" for part, (name, _) in named)
