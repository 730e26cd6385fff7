"""Sizes and layers as people write them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.app.studio.take import LARGEST, parse_frames, parse_size
from tallgrass.systems.overlay.layers import LAYERS, parse_layers

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


@given(st.sets(st.sampled_from(LAYERS), min_size=1))
def test_n8_parts_of_the_overlay_are_named_in_any_order(parts: set[str]) -> None:
    assert parse_layers(",".join(parts)) == parts
    assert parse_layers(" , ".join(parts).upper()) == parts
    assert parse_layers(",".join([*parts, "all"])) == set(LAYERS)


@pytest.mark.parametrize("text", ["", "mask", "masks,", "masks arrows", "none", "masks,levels,card"])
def test_n8_what_is_no_part_of_the_overlay_is_told_what_there_is(text: str) -> None:
    with pytest.raises(
        ValueError, match="is no part of the overlay; there are masks, arrows, levels, weights, map, and"
    ):
        parse_layers(text)


@given(first=st.integers(0, 99999), more=st.integers(1, 9999))
def test_frames_are_read_as_they_are_written(first: int, more: int) -> None:
    assert parse_frames(f"{first}:{first + more}") == (first, first + more)
    assert parse_frames(f" {first}: ") == (first, None)
    assert parse_frames(f":{more}") == (0, more)


@pytest.mark.parametrize("text", ["", "7", "a:b", "-1:5", "1:2:3", "5:5", "9:3", ":0", "1.5:2"])
def test_what_is_no_range_of_frames_is_refused_with_a_sentence(text: str) -> None:
    with pytest.raises(ValueError, match="frame"):
        parse_frames(text)
