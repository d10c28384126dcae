"""Words that shells complete behind `symgen`, asked of the shells themselves."""

from __future__ import annotations

import os
import pty
import select
import subprocess
import time
from collections.abc import Callable, Iterable
from pathlib import Path

import pytest

from symgen.cli import main as cli


@pytest.fixture
def folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Path:
    """With a model, another file, a folder, and the scripts of all shells."""
    for name in ("car.yaml", "arm.urdf", "notes.txt", "motion.csv"):
        (tmp_path / name).touch()
    (tmp_path / "out").mkdir()
    for shell in ("bash", "zsh", "fish"):
        assert cli.main(["completion", shell]) == 0
        (tmp_path / f"script.{shell}").write_text(capsys.readouterr().out)
    return tmp_path


def in_bash(folder: Path, *words: str) -> set[str]:
    """What is offered for the last of the words, as bash cuts them: at = as well."""
    script = (
        'source script.bash; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _symgen; printf "%s\\n" "${COMPREPLY[@]}"'
    )
    made = subprocess.run(
        ["bash", "-u", "-c", script, "bash", "symgen", *words], cwd=folder, capture_output=True, text=True, check=True
    )
    assert made.stderr == ""
    return set(made.stdout.split())


def in_fish(folder: Path, line: str) -> set[str]:
    """What is offered at the end of a line."""
    made = subprocess.run(
        ["fish", "--no-config", "-c", "source script.fish; complete -C $argv[1]", line],
        cwd=folder, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert made.stderr == ""
    return {offered.partition("\t")[0] for offered in made.stdout.splitlines()}


def in_zsh(folder: Path, lines: Iterable[str]) -> list[str]:
    """What each line becomes when the tabulator is hit, which completes what is common to all that fits."""
    process, terminal = pty.fork()
    if process == 0:
        os.chdir(folder)
        os.execvpe("zsh", ["zsh", "-f", "-i"], {**os.environ, "TERM": "dumb", "PS1": ""})
    begin = "autoload -Uz compinit; compinit -u -D; source script.zsh; unsetopt zle_bracketed_paste; echo rea''dy\n"
    os.write(terminal, begin.encode())
    _read_until(terminal, "ready")
    # a line is completed by one key, and then taken as it is, printed and let go
    take = "take() { zle expand-or-complete; print -r -- \"<$BUFFER>\"; BUFFER= }; zle -N take; bindkey '^X' take"
    os.write(terminal, f"{take}; echo se''t\n".encode())
    _read_until(terminal, "set")
    try:
        made = []
        for line in lines:
            os.write(terminal, f"{line}\x18".encode())
            made.append(_read_until(terminal, ">").rpartition("<")[2].partition(">")[0])
        return made
    finally:
        os.close(terminal)
        os.waitpid(process, 0)


def _read_until(terminal: int, end: str) -> str:
    text, limit = "", time.monotonic() + 20
    while end not in text and time.monotonic() < limit:
        if select.select([terminal], [], [], 0.1)[0]:
            text += os.read(terminal, 4096).decode(errors="replace")
    assert end in text, text
    return text


def test_bash_offers_commands_options_values_and_models(folder: Path) -> None:
    assert {"verify", "simulate", "completion", "car.yaml", "arm.urdf", "out"} <= in_bash(folder, "")
    assert "notes.txt" not in in_bash(folder, "")
    assert in_bash(folder, "ver") == {"verify"}
    assert in_bash(folder, "verify", "") == {"car.yaml", "arm.urdf", "out"}
    assert in_bash(folder, "identify", "car.yaml", "") == {"motion.csv", "out"}
    assert in_bash(folder, "verify", "--tr") == {"--trig"}
    assert in_bash(folder, "verify", "--trig", "") == {"portable", "libm"}
    assert in_bash(folder, "--trig", "=", "l") == {"libm"}
    assert in_bash(folder, "car.yaml", "--out", "") == {"out"}
    assert in_bash(folder, "car.yaml", "--only", "c,py") == {"c,python"}
    assert in_bash(folder, "target", "--cpu", "rv32imaf") == {"rv32imafc"}
    assert in_bash(folder, "explain", "car.yaml", "nullspace_projector_d") == {"nullspace_projector_dot"}
    # bash replaces what stands behind the = alone
    assert in_bash(folder, "car.yaml", "--method", "multipliers", "=", "schur_qr_r") == {"schur_qr_refined"}
    assert in_bash(folder, "car.yaml", "--states", "") == set()
    assert in_bash(folder, "completion", "") == {"bash", "zsh", "fish"}


def test_fish_offers_the_same(folder: Path, tool: Callable[[str], str]) -> None:
    tool("fish")
    assert {"verify", "simulate", "car.yaml", "arm.urdf"} <= in_fish(folder, "symgen ")
    assert "notes.txt" not in in_fish(folder, "symgen verify ")
    assert in_fish(folder, "symgen verify --tr") == {"--trig"}
    assert in_fish(folder, "symgen verify --trig ") == {"portable", "libm"}
    assert in_fish(folder, "symgen car.yaml --only c,py") == {"c,python"}
    assert in_fish(folder, "symgen car.yaml --method multipliers=schur_qr_r") == {"multipliers=schur_qr_refined"}
    assert "out/" in in_fish(folder, "symgen car.yaml --out ")


def test_zsh_offers_the_same(folder: Path, tool: Callable[[str], str]) -> None:
    tool("zsh")
    completed = {
        "symgen verify --tr": "symgen verify --trig ",
        "symgen verify --trig l": "symgen verify --trig libm ",
        "symgen simu": "symgen simulate ",
        "symgen verify c": "symgen verify car.yaml ",
        # another one may follow
        "symgen car.yaml --only c,py": "symgen car.yaml --only c,python,",
        "symgen explain car.yaml nullspace_projector_d": "symgen explain car.yaml nullspace_projector_dot ",
    }
    assert dict(zip(completed, in_zsh(folder, completed), strict=True)) == completed


def test_every_command_and_option_is_there(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What `--help` of a command tells is offered."""
    for command in in_bash(folder, "") - {"car.yaml", "arm.urdf", "out"}:
        with pytest.raises(SystemExit):
            cli.main([command, "--help"])
        text = capsys.readouterr().out
        options = {word.strip("[,]") for word in text.split() if word.strip("[,]").startswith("--")}
        assert options <= in_bash(folder, command, "--"), command
