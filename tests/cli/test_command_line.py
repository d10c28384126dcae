"""The command line: options, exit codes, what is printed and what is left on disk."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from symgen import pipeline
from symgen.cli import main as cli
from symgen.diagnostics import Notice, SymgenBug
from symgen.generation.results import ALL_PARTS, LargestError, Options, Result, Summary, WrongUseError
from symgen.ir.kernel import Scalar
from symgen.model.load import load_model

MODELS = Path(__file__).resolve().parents[2] / "models"
SKATE = str(MODELS / "skate.yaml")
SUMMARY = Summary(
    n=3,
    r=1,
    delta=2,
    m=2,
    skipped=(("potential forces", "the potential energy is constant"),),
    operations=(("inverse_dynamics", 8),),
    errors=(LargestError("C float32", "inverse_dynamics", 2.345, 16.0),),
)


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[Options]:
    """Replaces the pipeline by one that answers at once and remembers what it was asked for."""
    seen: list[Options] = []

    def generate(path: Path, options: Options, progress: Callable[[str], None]) -> Result:
        seen.append(options)
        progress("deriving")
        files = {"c/skate.c": "source\n", "derivation.json": "{}\n", "certificate.json": "{}\n"}
        return Result(load_model(path), files, SUMMARY, notices=(Notice("a notice"),))

    monkeypatch.setattr(pipeline, "generate", generate)
    monkeypatch.chdir(tmp_path)
    return seen


def code(*arguments: str) -> int:
    """The exit code, also where argparse leaves by itself."""
    try:
        return cli.main(arguments)
    except SystemExit as leaving:
        return int(leaving.code or 0)


def test_generates_into_generated(asked: list[Options], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert code(SKATE) == 0
    assert asked == [Options(measured=Path("generated"), usual=True)]
    assert (tmp_path / "generated/skate/c/skate.c").read_text() == "source\n"
    out, err = capsys.readouterr()
    assert "n = 3, r = 1, δ = 2, m = 2" in out
    assert "C float32          2.3        16   inverse_dynamics" in out
    assert "potential forces   the potential energy is constant" in out
    assert "written to generated/skate/:\n  c/    1  skate.c\n" in out
    assert "skate: deriving ..." in err
    assert "notice: a notice" in err


@pytest.mark.parametrize(
    ("arguments", "options"),
    [
        (["--outputs", "energy, mass_matrix"], Options(outputs=("energy", "mass_matrix"), usual=True)),
        (["--scalar", "float32"], Options(scalars=("float32",), usual=True)),
        (["--trig", "libm"], Options(trig="libm", usual=True)),
        (["--only", "python,c"], Options(parts=("c", "python"))),
        (["--only", "report,array_api,c"], Options(parts=("c", "array_api", "report"))),
        (["--no-verify", "--states", "200"], Options(verify=False, states=200, usual=True)),
    ],
)
def test_options(asked: list[Options], arguments: list[str], options: Options) -> None:
    assert code(SKATE, *arguments) == 0
    assert asked == [replace(options, measured=Path("generated"))]


def test_out_and_quiet(asked: list[Options], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert code(SKATE, "--out", str(tmp_path / "there"), "--quiet") == 0
    assert (tmp_path / "there/skate/derivation.json").exists()
    assert capsys.readouterr() == ("", "")
    assert len(asked) == 1


def test_check_compares_and_writes_nothing(
    asked: list[Options], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert code(SKATE, "--check") == 1
    assert capsys.readouterr().out == ("generated/skate/c/skate.c: missing\ngenerated/skate/derivation.json: missing\n")
    assert not (tmp_path / "generated").exists()
    assert not asked[0].verify
    assert code(SKATE) == 0
    assert code(SKATE, "--check") == 0


def test_verify_writes_the_certificate_of_what_is_on_disk(
    asked: list[Options], tmp_path: Path, capsys: pytest.CaptureFixture[str], tool: Callable[[str], str]
) -> None:
    tool("cc")
    assert code("verify", SKATE) == 1
    assert "run symgen again" in capsys.readouterr().err
    assert not (tmp_path / "generated/skate/certificate.json").exists()
    assert code(SKATE) == 0
    (tmp_path / "generated/skate/certificate.json").unlink()
    assert code("verify", SKATE) == 0
    assert (tmp_path / "generated/skate/certificate.json").exists()
    assert asked[0] == Options(parts=("c", "python"))


def test_verify_needs_a_compiler(
    asked: list[Options], monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert code("verify", SKATE) == 2
    assert "install gcc or clang" in capsys.readouterr().err
    assert not asked


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["no_such.yaml"],
        ["verify"],
        ["verify", "no_such.yaml"],
        ["explain", "no_such.yaml"],
        [SKATE, "--scalar", "float16"],
        [SKATE, "--only", "fortran"],
        [SKATE, "--states", "7"],
        [SKATE, "--outputs", ","],
        [SKATE, "--unknown"],
        [str(MODELS)],
        [SKATE, str(MODELS / "../models/skate.yaml")],
        ["schema", "extra"],
    ],
)
def test_wrong_use(asked: list[Options], arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert code(*arguments) == 2
    assert "Traceback" not in capsys.readouterr().err
    assert len(asked) <= 2


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["verfy", SKATE], "verfy is no command and no file; did you mean `symgen verify`?"),
        (["explains", SKATE, "--depth", "3"], "explains is no command and no file; did you mean `symgen explain`?"),
        ([str(MODELS / "skate")], f"no such file: {MODELS / 'skate'}; did you mean {SKATE}?"),
        ([str(MODELS / "skat.yaml")], f"did you mean {SKATE}?"),
        ([str(MODELS)], f"{MODELS} is a folder: name a model file, such as {MODELS / 'arm7.yaml'}"),
        (["a_machine_of_mine"], "no such file: a_machine_of_mine\n"),
    ],
)
def test_a_word_that_is_no_file_is_told_with_what_was_meant(
    asked: list[Options], arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert code(*arguments) == 2
    assert message in capsys.readouterr().err
    assert not asked


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--states", "many"], "'many' is no whole number from 8 up"),
        (["--only", "c,fortran"], "'fortran' is none of c, python"),
        (["--outputs", " , "], "expected names separated by commas"),
    ],
)
def test_a_wrong_option_is_told_with_its_remedy(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert code(SKATE, *arguments) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--duration", "0"], "'0' is no positive number"),
        (["--duration", "inf"], "'inf' is no positive number"),
        (["--start", "x=1,y"], "'y' is not of the form x=1"),
        (["--inputs", "a=1,b=nan"], "'b=nan' is not of the form x=1"),
    ],
)
def test_a_wrong_option_of_simulate_is_told_with_its_remedy(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert code("simulate", SKATE, *arguments) == 2
    assert message in capsys.readouterr().err


def failing(error: BaseException) -> Callable[..., Result]:
    def generate(_path: Path, _options: Options, _progress: Callable[[str], None]) -> Result:
        raise error

    return generate


@pytest.mark.parametrize(
    ("error", "expected", "message"),
    [
        (WrongUseError("no quantity named x"), 2, "symgen: no quantity named x"),
        (SymgenBug("schedule: a cycle"), 2, "internal error: schedule: a cycle"),
        (ZeroDivisionError("oops"), 2, "fault of symgen"),
        (ModuleNotFoundError("no module", name="symgen.lost"), 2, "fault of symgen"),
        (ModuleNotFoundError("no module", name="scipy.integrate"), 2, "this needs scipy, which is not installed"),
        (PermissionError(13, "Permission denied", "m.yaml"), 2, "symgen: m.yaml: Permission denied"),
        (KeyboardInterrupt(), 130, "earlier output is unchanged"),
    ],
)
def test_failures(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], error: Exception, expected: int, message: str
) -> None:
    monkeypatch.setattr(pipeline, "generate", failing(error))
    assert code(SKATE) == expected
    assert message in capsys.readouterr().err


def test_failed_verification_writes_nothing(
    asked: list[Options], monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert code(SKATE) == 0
    before = (tmp_path / "generated/skate/c/skate.c").read_text()
    failures = ("inverse_dynamics, C float32: error 1e-2",)
    result = Result(load_model(Path(SKATE)), {"c/skate.c": "bad"}, SUMMARY, failures=failures)
    monkeypatch.setattr(pipeline, "generate", lambda *_: result)
    assert code(SKATE) == 1
    assert failures[0] in capsys.readouterr().err
    assert (tmp_path / "generated/skate/c/skate.c").read_text() == before
    assert len(asked) == 1


def test_a_mistake_does_not_stop_the_next_model(
    asked: list[Options], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "bad.yaml").write_text("model: bad\ncoordinates: {x: {}}\nkinetic_energy: x_dot**2*nonsense\n")
    assert code("bad.yaml", SKATE) == 1
    err = capsys.readouterr().err
    assert "bad.yaml:3:" in err
    assert "remedy:" in err
    assert "Traceback" not in err
    assert (tmp_path / "generated/skate").exists()
    assert not (tmp_path / "generated/bad").exists()
    assert len(asked) == 2


def test_schema_is_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert code("schema") == 0
    assert "properties" in json.loads(capsys.readouterr().out)


def test_help_and_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert code("--help") == 0
    assert "examples:" in capsys.readouterr().out
    assert code("--version") == 0
    assert capsys.readouterr().out.startswith("symgen ")


@pytest.mark.parametrize("scalar", ["float64", "float32"])
def test_the_real_pipeline_to_c(tmp_path: Path, scalar: Scalar) -> None:
    assert code(SKATE, "--out", str(tmp_path), "--only", "c", "--no-verify", "--quiet", "--scalar", scalar) == 0
    suffix = "" if scalar == "float64" else "_f"
    kinds = ("", "_batch", "_prepared", "_sc")
    files = {f"skate{kind}{suffix}.{ending}" for kind in kinds for ending in "hc"}
    assert {path.name for path in (tmp_path / "skate/c").iterdir()} == files


def test_out_is_a_file(asked: list[Options], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "generated").write_text("")
    assert code(SKATE) == 2
    assert f"{tmp_path / 'generated'} is a file: name a folder with --out" in capsys.readouterr().err
    assert asked == []
    assert code(SKATE, "--out", "generated/below") == 2
    assert asked == []


def test_explain_one_quantity(capsys: pytest.CaptureFixture[str]) -> None:
    assert code("explain", SKATE, "nullspace_projector") == 0
    assert "sin" in capsys.readouterr().out
    assert code("explain", SKATE, "nonsense") == 2
    assert "unknown quantity 'nonsense'" in capsys.readouterr().err


def test_unknown_output_is_wrong_use(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert code(SKATE, "--out", str(tmp_path), "--outputs", "nonsense", "--no-verify", "--quiet") == 2
    assert "unknown quantity 'nonsense'" in capsys.readouterr().err
    assert code(SKATE, "--out", str(tmp_path), "--outputs", "mas_matrix", "--no-verify", "--quiet") == 2
    assert "did you mean `mass_matrix`?" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["", *cli._COMMANDS])
def test_help_fits_into_eighty_columns(
    command: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    with pytest.raises(SystemExit):
        cli.main([*([command] if command else []), "--help"])
    lines = capsys.readouterr().out.splitlines()
    assert lines
    assert [line for line in lines if len(line) > 80] == []
    words = set(" ".join(lines).replace(",", " ").split())
    assert command or set(ALL_PARTS) <= words  # none is broken at the end of a line


@pytest.mark.slow
@pytest.mark.parametrize(
    ("options", "remedy"), [(["--only", "report"], "; `--only c,report` measures it"), (["--no-verify"], "")]
)
def test_a_report_without_a_pdf_says_why(
    options: list[str], remedy: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main([SKATE, *options, "--outputs", "inverse_dynamics", "--out", str(tmp_path)]) == 0
    why = f"notice: the report has no PDF: that is made of what verification measures, too{remedy}\n"
    assert why in capsys.readouterr().err
    assert not (tmp_path / "skate/report/skate.pdf").exists()
    assert (tmp_path / "skate/report/skate.tex").exists()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("part", "outputs", "said"),
    [
        ("fmi", "forward_dynamics", "fmi: the plant drifts off its constraints; what brings it back comes of "
         "`--outputs admissible_velocity,forward_dynamics`"),
        ("fmi", "mass_matrix", "fmi: there are no units, only the C"),
        ("ros2", "mass_matrix", "ros2: there is no plugin, only the C"),
        ("fmi", "forward_dynamics,admissible_velocity", ""),
    ],
)  # fmt: skip
def test_files_for_other_tools_say_what_they_lack(
    part: str, outputs: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main([SKATE, "--only", part, "--no-verify", "--outputs", outputs, "--out", str(tmp_path)]) == 0
    notices = [line for line in capsys.readouterr().err.splitlines() if f"notice: {part}: " in line]
    assert [said in line for line in notices] == [True] * bool(said)
