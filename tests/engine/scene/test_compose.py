"""From the bytes of a file to its values and their places."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.engine.scene.compose import MOST_BYTES, MOST_VALUES, decode, read_document
from tallgrass.engine.scene.problem import SceneError
from tallgrass.engine.scene.validate import validate


def problems(text: str) -> list[str]:
    with pytest.raises(SceneError) as refusal:
        read_document(text, file="f.yaml")
    return [f"{problem.line}:{problem.column} {problem.message}" for problem in refusal.value.problems]


def test_every_value_and_key_knows_its_place() -> None:
    root = read_document("a: 1\nb:\n  - x\n  - {ä😀: 'y', d: }\n", file="f.yaml").root
    assert root.data == {"a": 1, "b": ["x", {"ä😀": "y", "d": None}]}
    item = root.below["b"].below[1]
    assert (item.keys["d"].line, item.keys["d"].column) == (3, 14)
    assert (item.below["ä😀"].line, item.below["ä😀"].column) == (3, 9)


def test_steps_that_the_file_lacks_are_skipped_on_the_way_to_a_value() -> None:
    document = read_document("a: {b: [3]}\n", file="f.yaml")
    assert document.node(("a", "tag of a union", "b", 0)).data == 3
    assert document.problem(("a", "b", "missing"), "x").column == 8


def test_an_alias_repeats_what_its_anchor_names() -> None:
    assert read_document("a: &x {b: 1}\nc: *x\n", file="f").root.data == {"a": {"b": 1}, "c": {"b": 1}}


def test_everything_that_does_not_stop_the_reading_is_told_in_one_go() -> None:
    document = read_document("a: 1\na: 2\n<<: {}\n1: x\n[k]: y\nb: !!int 3\nc: " + "9" * 80, file="f")
    told = [f"{problem.line}:{problem.column} {problem.message}" for problem in document.problems]
    assert told == [
        "2:1 duplicate key 'a', first at 1:1",
        "3:1 merge keys ('<<') are not read; write the keys out",
        "4:1 a key must be text; write it in quotes",
        "5:1 a key must be text; write it in quotes",
        "6:4 the tag '!!int' is not read; leave it out, values are plain text and numbers",
        "7:4 a number of 80 characters is too long",
    ]


def test_of_a_key_that_is_no_text_only_what_is_wrong_with_it_is_told() -> None:
    with pytest.raises(SceneError, match=r"^f:2:9: a key must be text; write it in quotes\n[^\n]*\n *\^$"):
        validate(read_document("tallgrass: 2\ngrass: {1: {}}", file="f"))
    with pytest.raises(SceneError, match=r"(?s)a key must be text.*unknown key 'heigth', did you mean 'height'"):
        validate(read_document("tallgrass: 2\ngrass: {1: {heigth: [1, 2]}}", file="f"))


@pytest.mark.parametrize("opening", ["[", "{a: ", "- ", "[{a: ["])
def test_a_hundred_thousand_brackets_are_refused_and_crash_nothing(opening: str) -> None:
    (told,) = problems(opening * 100_000)
    assert told.endswith("nested more than 64 levels deep")


def test_nesting_by_aliases_counts_as_nesting() -> None:
    chain = "a0: &a0 [x]\n" + "".join(f"a{i}: &a{i} [*a{i - 1}]\n" for i in range(1, 100))
    (told,) = problems(chain)
    assert told.startswith("63:")
    assert told.endswith("nested more than 64 levels deep")


def test_an_alias_bomb_is_refused_before_it_goes_off() -> None:
    bomb = "a0: &a0 [x, x]\n" + "".join(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]\n" for i in range(1, 12))
    (told,) = problems(bomb)
    assert f"more than {MOST_VALUES} values" in told


def test_a_recursive_alias_is_refused() -> None:
    assert problems("a: &a [*a]") == ["1:8 the alias '*a' stands inside what it repeats"]


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"a: 1\n# caf\xe9\n", "f:2:6: byte 0xe9 is not UTF-8; save the file as UTF-8"),
        (b"\xef\xbb\xbfa: \xff", "f:1:4: byte 0xff is not UTF-8; save the file as UTF-8"),
        ("a: 1".encode("utf-16"), "f:1:1: the file is UTF-16; save it as UTF-8"),
        (b" " * (MOST_BYTES + 1), f"f:1:1: a scene file may have {MOST_BYTES} bytes at most"),
    ],
)
def test_bytes_that_are_no_scene_text_are_refused(data: bytes, told: str) -> None:
    with pytest.raises(SceneError) as refusal:
        decode(data, file="f")
    assert str(refusal.value) == told


def test_a_byte_order_mark_moves_no_column() -> None:
    document = read_document(decode(b"\xef\xbb\xbfa: 1\na: 2", file="f"), file="f")
    assert document.root.data == {"a": 1}
    assert (document.root.line, document.root.column) == (0, 0)


@pytest.mark.parametrize("character", ["\0", "\x1b", "\x7f", "\ud800", "\ufffe"])
def test_control_characters_are_refused_where_they_stand(character: str) -> None:
    (told,) = problems(f"a: 1\nb: x{character}y\n")
    assert told == f"2:5 the control character U+{ord(character):04X} cannot stand in a scene file"


@pytest.mark.parametrize("text", ["", "\n\n", "# nothing\n", "---\n...\n"])
def test_an_empty_file_says_how_a_scene_begins(text: str) -> None:
    if text.startswith("---"):
        assert read_document(text, file="f").root.data is None
    else:
        assert problems(text) == ["1:1 the file is empty; a scene begins with 'tallgrass: 2'"]


@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r", "\x85", "\u2028"])
def test_lines_are_counted_by_every_line_break_of_yaml(newline: str) -> None:
    document = read_document(newline.join(["a: 1", "b: 2", "b: 3", ""]), file="f")
    (problem,) = document.problems
    assert (problem.line, problem.column, problem.source_line) == (3, 1, "b: 3")


@given(st.text(st.sampled_from("ab1:-,#&*!|>'\"%@`[]{}?~. \n\t\\\r\ufeff\x85\u2028😀<"), max_size=60))
def test_any_text_is_a_document_or_a_list_of_problems_inside_it(text: str) -> None:
    try:
        told = read_document(text, file="f").problems
    except SceneError as error:
        told = error.problems
        assert told
    for problem in told:
        assert 1 <= problem.line <= len(text.splitlines()) + 2
        assert problem.column >= 1
        assert "\n" not in problem.message


@given(st.binary(max_size=40))
def test_any_bytes_are_text_or_one_problem(data: bytes) -> None:
    try:
        told = decode(data, file="f")
    except SceneError as error:
        (only,) = error.problems
        told = str(only)
    assert told or not data.removeprefix(b"\xef\xbb\xbf")
