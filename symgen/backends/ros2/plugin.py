"""What stands around the C: the plugin, and the three files that make a package of it.

The interface is that of the package `inverse_dynamics_solver`: vectors of joint positions, velocities and
accelerations, here the coordinates in the order of the model file; torques, here the inputs.
"""

from __future__ import annotations

from collections.abc import Sequence

from symgen import __version__
from symgen.backends.about import symbol_lines
from symgen.backends.c.identity import status_text_name
from symgen.backends.c.names import c_members, global_name
from symgen.backends.comments import c_comment_lines, one_line
from symgen.backends.locals import array_arguments
from symgen.backends.render import render
from symgen.backends.ros2.reserved import package_name
from symgen.backends.scalars import file_stem
from symgen.ir.kernel import Kernel, Program
from symgen.model.model import Model
from symgen.records import dataclass

# By function of the interface, the quantity that answers it.
ANSWERS = {
    "getInertiaMatrix": "mass_matrix",
    "getCoriolisVector": "coriolis_force",
    "getGravityVector": "potential_force",
    "getTorques": "inverse_dynamics",
}
# What friction is part of, on the right-hand side.
APPLIED = "applied_force"


@dataclass(frozen=True, slots=True)
class AnswerView:
    """A function of the interface: the quantity and its C, the arguments that this takes, and the shape."""

    quantity: str
    c_function: str
    arguments: tuple[str, ...]
    rows: int
    columns: int


@dataclass(frozen=True, slots=True)
class PluginView:
    """Everything the templates print; `fields` are parameters by name and in C.

    `friction` is what forces are applied, where that is made; whether it `depends` on more than rates is what the
    interface, which gives it these alone, has no place for.
    """

    package: str
    version: str
    description: str
    about: tuple[str, ...]
    source: str
    params: str
    defaults: str
    status: str
    status_text: str
    coordinates: int
    fields: tuple[tuple[str, str], ...]
    answers: dict[str, AnswerView]
    friction: AnswerView | None
    depends: bool


def emit_plugin(model: Model, programs: Sequence[Program]) -> dict[str, str]:
    """The package, where there are inputs to be worked out."""
    (program,) = programs
    kernels = {kernel.name: kernel for kernel in program.kernels}
    applied = kernels.get(APPLIED)
    if ANSWERS["getTorques"] not in kernels:
        return {}
    description = one_line(f"{model.name}: {model.description or 'constrained mechanical system'}")
    members = c_members(model, program)
    view = PluginView(
        package=package_name(model.c_name),
        version=__version__,
        description=description,
        about=tuple(part for line in (description, *symbol_lines(model)) for part in c_comment_lines(line)),
        source=file_stem(model.c_name, program.scalar),
        params=global_name(model.c_name, program.scalar, "params"),
        defaults=global_name(model.c_name, program.scalar, "default_params"),
        status=f"{model.c_name}_status",
        status_text=status_text_name(model),
        coordinates=model.n,
        fields=tuple((one.name, members[one.name]) for one in model.parameters),
        answers={name: _answer(model, program, kernels[of]) for name, of in ANSWERS.items() if of in kernels},
        friction=_answer(model, program, applied) if applied is not None else None,
        depends=applied is None or any(load.argument not in ("qd", "p") for load in applied.loads),
    )
    files = {
        "src/solver.cpp": "ros2/solver.cpp.jinja",
        "CMakeLists.txt": "ros2/cmake.jinja",
        "package.xml": "ros2/package.xml.jinja",
        "plugin.xml": "ros2/plugin.xml.jinja",
    }
    return {f"ros2/{path}": render(template, view) for path, template in files.items()}


def _answer(model: Model, program: Program, kernel: Kernel) -> AnswerView:
    rows, columns = (*kernel.shape, 1)[:2]
    names = tuple(argument.name for argument in array_arguments(kernel))
    return AnswerView(kernel.name, global_name(model.c_name, program.scalar, kernel.name), names, rows, columns)
