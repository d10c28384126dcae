"""What is wrong with a robot description is told at its place in that file, and hostile files are refused at once."""

from __future__ import annotations

import os
import random
from contextlib import suppress
from pathlib import Path

import pytest
from robots import ARM, HEAD, joint, link, load, robot
from spoiled_robots import GROUPS, HOSTILE, Case

from symgen.diagnostics import ModelError

EXPECTED = Path(__file__).parent / "expected"


def said(case: Case, folder: Path) -> str:
    """The mistakes of a spoiled robot, with the folder left out of the places."""
    with pytest.raises(ModelError) as raised:
        load(folder, *case)
    return raised.value.render().replace(f"{folder}{os.sep}", "")


@pytest.mark.parametrize("group", GROUPS)
def test_mistakes_are_told_with_place_and_remedy(group: str, tmp_path: Path) -> None:
    expected: dict[str, str] = {}
    for section in (EXPECTED / f"{group}.txt").read_text(encoding="utf-8").split("== ")[1:]:
        name, _, text = section.partition("\n")
        expected[name] = text
    assert list(expected) == list(GROUPS[group])
    for name, case in GROUPS[group].items():
        assert said(case, tmp_path) + "\n" == expected[name], f"case {name} of {group}"


@pytest.mark.parametrize("group", GROUPS)
def test_every_mistake_has_a_place_and_a_remedy(group: str, tmp_path: Path) -> None:
    for name, case in GROUPS[group].items():
        with pytest.raises(ModelError) as raised:
            load(tmp_path, *case)
        for mistake in raised.value.mistakes:
            assert mistake.remedy, name
            assert mistake.span is not None, name
            text = case[0] if mistake.span.file else case[1]
            assert 1 <= mistake.span.line <= text.count("\n") + 2, name
            assert mistake.span.end_column > mistake.span.column >= 1, name


def test_links_that_lead_elsewhere_are_refused(tmp_path: Path) -> None:
    inside = tmp_path / "model"
    inside.mkdir()
    (tmp_path / "secret.urdf").write_text(ARM, encoding="utf-8")
    (inside / "way").symlink_to(tmp_path / "secret.urdf")
    with pytest.raises(ModelError, match="`way` is a link that leads out of the folder"):
        load(inside, ARM, HEAD.replace("robot.urdf", "way"))


def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(ModelError, match="there is no file `pipe`"):
        load(tmp_path, ARM, HEAD.replace("robot.urdf", "pipe"))


def test_a_file_below_the_folder_of_the_model(tmp_path: Path) -> None:
    (tmp_path / "robots").mkdir()
    (tmp_path / "robots" / "arm.urdf").write_bytes(b"\xef\xbb\xbf" + ARM.replace("\n", "\r\n").encode())
    assert load(tmp_path, ARM, HEAD.replace("robot.urdf", "robots/arm.urdf")).n == 2


def test_a_file_that_is_not_text(tmp_path: Path) -> None:
    (tmp_path / "bytes.urdf").write_bytes(ARM.encode("utf-16"))
    with pytest.raises(ModelError, match=r"`bytes\.urdf` is not text in UTF-8"):
        load(tmp_path, ARM, HEAD.replace("robot.urdf", "bytes.urdf"))


def test_entities_are_refused_before_they_are_read() -> None:
    """Each hostile document type, also behind a comment that pretends to be harmless."""
    from symgen.diagnostics import Mistake
    from symgen.model.robots.xml import parse_xml

    for name, (text, _) in HOSTILE.items():
        if "<!DOCTYPE" in text:
            head, _, tail = text.partition("<!DOCTYPE")
            mistake = parse_xml(f"{head}<!-- a robot -->\n<!DOCTYPE{tail}", "r.urdf", "URDF")
            assert isinstance(mistake, Mistake), name
            assert mistake.message == "document types and entities are not read", name


def test_damaged_robots_are_mistakes_and_nothing_else(tmp_path: Path) -> None:
    source = random.Random(7)
    pieces = ["<", ">", '"', "/", "&", "0", "-", "e", " ", "9" * 50, "link", "\u202e", "<!--", "]]>", "1e308", "nan"]
    survived = 0
    for _ in range(250):
        text = ARM
        for _ in range(source.randrange(1, 4)):
            start = source.randrange(len(text))
            text = text[:start] + source.choice(pieces) + text[start + source.randrange(12) :]
        with suppress(ModelError):
            load(tmp_path, text)
            survived += 1
    assert survived < 200


def test_what_is_unknown_may_be_left_out_by_name(tmp_path: Path) -> None:
    text = ARM.replace('damping="0.1"', 'damping="0.1" mu="3"').replace(
        '<link name="base"/>', '<link name="base"><spring name="s"/></link>'
    )
    model = load(tmp_path, text, HEAD.replace("robot.urdf", "{file: robot.urdf, leave_out: [mu, spring]}"))
    messages = [notice.message for notice in model.notices]
    assert "`mu` of the URDF takes no part (elbow)" in messages
    assert "`spring` of the URDF takes no part (s)" in messages


def test_notices_have_their_place_in_the_robot(tmp_path: Path) -> None:
    text = robot(
        link("base", 0),
        link("a"),
        link("hook", 0.001, 1e-6).replace('ixy="0"', 'ixy="1e-5"'),
        joint("turn", "continuous", "base", "a", '<origin rpy="1.5708 0 0"/>'),
        joint("weld", "fixed", "a", "hook", '<limit effort="3"/>'),
    )
    notices = load(tmp_path, text).notices
    assert [(n.message.split(":")[0], n.span.line if n.span else 0) for n in notices] == [
        ("the angle 1.5708 is taken as written; with eight digits a quarter turn is exact", 5),
        ("`limit` of the fixed joint `weld` says nothing", 6),
        ("the inertia of `hook` has a negative principal moment, -9e-06", 4),
    ]
    assert all(notice.span is not None and notice.span.file.endswith("robot.urdf") for notice in notices)


def test_a_mistake_in_the_model_file_is_told_there(tmp_path: Path) -> None:
    with pytest.raises(ModelError) as raised:
        load(tmp_path, ARM, f"{HEAD}inputs: {{motor: {{unit: N*m, joint: sholder}}}}\n")
    assert "robot.yaml:4:36: `sholder` in `joint` of `motor` is no coordinate" in str(raised.value)
    assert "did you mean `shoulder`?" in str(raised.value)
