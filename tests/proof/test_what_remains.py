"""What keeps Eva from a proof is named, whether it is a denominator or not."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import shipped

from symgen.backends.c.plain import emit_c
from symgen.ir.kernel import Program
from symgen.lowering.schedule import schedule
from symgen.model.model import Model
from symgen.proof.files import emit_proofs
from symgen.quantities.select import derive_quantities

HEADING = "## Angles that make intervals overflow"
EVA = """[eva:alarm] c/arm_f.c:2: Warning: \n  non-finite float value. assert \\is_finite(\\mul_float(a, b));
[eva:alarm] c/arm_f.c:3: Warning: \n  non-finite float value. assert \\is_finite(\\mul_float(t1, a));
[eva:alarm] c/arm_f.c:4: Warning: \n  accessing uninitialized left-value. assert \\initialized(&c);
[kernel:annot:missing-spec] c/arm_f.c:1: Warning: \n  Neither code nor specification for function sinhf, generating
"""
SOURCE = "const float b = sinhf(a);\nconst float t1 = a * b;\nconst float t2 = t1 * a;\nreturn c;\n"


def of_inverse_dynamics(system: Model) -> Program:
    derivations = derive_quantities(system, ("inverse_dynamics",))
    return schedule(derivations.mechanics, derivations.quantities, ("float32",))["float32"]


def test_angles_that_make_intervals_overflow_are_named() -> None:
    """Six of the arm's angles; Eva has 8 alarms there, and none where all ranges stay within one quadrant."""
    system = shipped.model("arm7")
    program = of_inverse_dynamics(system)
    page = emit_proofs(system, [program])["proof/README.md"]
    row = re.search(r"^\| inverse_dynamics\(q, qd, qdd\) \| (.*) \|$", page.partition(HEADING)[2], re.MULTILINE)
    assert row
    assert row[1].split("<br>") == [f"`q_{k}`" for k in range(2, 8)]
    narrow = (Fraction(-3, 4), Fraction(3, 4))
    within = replace(system, coordinates=tuple(replace(c, range=narrow) for c in system.coordinates))
    assert HEADING not in emit_proofs(within, [program])["proof/README.md"]


def test_front_car_has_nothing_to_name() -> None:
    system = shipped.model("front_car")
    assert HEADING not in emit_proofs(system, [shipped.programs("front_car")["float32"]])["proof/README.md"]


def test_friction_by_tanh_has_no_alarm(tool: Callable[[str], str], tmp_path: Path) -> None:
    """The analyser's own header says nothing of tanh; the driver says what every C library keeps."""
    tool("gcc")  # Frama-C's preprocessor
    system = shipped.model("scara")
    program = of_inverse_dynamics(system)
    for path, text in (emit_c(system, program) | emit_proofs(system, [program])).items():
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(text)
    command = [tool("frama-c"), "-eva", "-eva-precision", "1", "-warn-special-float", "non-finite"]
    command += [f"-cpp-extra-args=-I{tmp_path / 'c'}", "-main", "eva_inverse_dynamics"]
    files = [str(tmp_path / "proof/scara_f_eva.c"), str(tmp_path / "c/scara_f.c")]
    printed = subprocess.run([*command, *files], capture_output=True, text=True, check=True).stdout
    assert "0 alarms generated" in printed
    assert re.search(r"Assertions +1 valid +0 unknown +0 invalid", printed)


def test_alarms_are_told_by_kind_with_the_first_statement(tmp_path: Path) -> None:
    """What tools/proof_table.py shows where no denominator is in doubt."""
    (tmp_path / "c").mkdir()
    (tmp_path / "c/arm_f.c").write_text(SOURCE)
    (tmp_path / "proof").mkdir()
    rows = "| kernel | angles |\n|---|---|\n| inverse_dynamics(q, qd) | `a`<br>`b` |\n"
    (tmp_path / "proof/README.md").write_text(f"# Proofs\n\n{HEADING}\n\n{rows}\n## Rounding\n")
    script = "import sys; from pathlib import Path; import proof_table as t; "
    script += "print(*t.origins(sys.argv[1], Path(sys.argv[2])), sep='\\n')"
    tools = Path(__file__).resolve().parents[2] / "tools"
    process = subprocess.run(
        [sys.executable, "-c", script, EVA, str(tmp_path)], capture_output=True, text=True, check=True, cwd=tools
    )
    assert process.stdout.splitlines() == [
        "2 × non-finite float value, first `t1 = a * b`",
        "1 × accessing uninitialized left-value, first `return c`",
        "no bounds are known of `sinhf`",
        "sines over several quadrants: `a`, `b` (`range:`)",
    ]
