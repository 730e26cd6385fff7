"""Sizes as people write them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.app.take import LARGEST, parse_size

sides = st.integers(1, LARGEST)


@given(sides, sides)
def test_a_size_is_width_x_height(width: int, height: int) -> None:
    assert parse_size(f"{width}x{height}") == (width, height)
    assert parse_size(f" {width}X{height} ") == (width, height)


@pytest.mark.parametrize(
    "text", ["", "abc", "640", "640x", "x480", "640x480x3", "-1x5", "1.5x2", "6e2x480", "640 x 480"]
)
def test_what_is_no_size_is_told_so(text: str) -> None:
    with pytest.raises(ValueError, match="is not a size like 1280x720"):
        parse_size(text)


@pytest.mark.parametrize("text", ["0x0", "0x5", "5x0", "16385x1", "1x999999999"])
def test_a_size_beyond_the_limits_is_told_them(text: str) -> None:
    with pytest.raises(ValueError, match="from 1 to 16384 pixels"):
        parse_size(text)
