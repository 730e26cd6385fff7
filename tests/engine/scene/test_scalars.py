"""Plain scalars by the core schema of YAML 1.2."""

import math

import pytest

from tallgrass.engine.scene.compose import scalar


@pytest.mark.parametrize("text", ["", "~", "null", "Null", "NULL"])
def test_null_has_five_spellings(text: str) -> None:
    assert scalar(text) is None


@pytest.mark.parametrize("text", ["on", "off", "yes", "no", "Y", "1:30", "0b1", "1_000", "nil", ".", "-", "1e", "²"])
def test_what_older_yaml_took_for_something_else_is_text(text: str) -> None:
    assert scalar(text) == text


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("true", True),
        ("FALSE", False),
        ("017", 17),
        ("+12", 12),
        ("-3", -3),
        ("0o17", 15),
        ("0x1F", 31),
        ("1e3", 1000.0),
        ("-.5", -0.5),
        ("1.", 1.0),
        ("6.02E+23", 6.02e23),
        ("-.inf", -math.inf),
    ],
)
def test_numbers_and_truths_are_read_with_their_type(text: str, value: object) -> None:
    read = scalar(text)
    assert read == value
    assert type(read) is type(value)


def test_not_a_number_is_read_as_such() -> None:
    read = scalar(".NaN")
    assert isinstance(read, float)
    assert math.isnan(read)


def test_a_number_without_end_is_refused() -> None:
    with pytest.raises(ValueError, match="a number of 5000 characters is too long"):
        scalar("9" * 5000)
