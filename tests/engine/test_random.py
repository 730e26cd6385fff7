"""Counter-based random numbers, in numpy and in GLSL."""

import moderngl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.gl.shaders import compose
from tallgrass.engine.random import hash3, scramble, stream, unit

SIDE = 256
signed = st.integers(-(2**31), 2**31 - 1)
seeds = st.integers(0, 2**31 - 1)


def grid(seed: int) -> NDArray[np.uint32]:
    """Return the hashes of a square of cells around the origin."""
    line = np.arange(-SIDE // 2, SIDE // 2, dtype=np.int32)
    return hash3(seed, line[None, :], line[:, None])


def correlation(a: NDArray[np.uint32], b: NDArray[np.uint32]) -> float:
    return float(np.corrcoef(unit(a).ravel(), unit(b).ravel())[0, 1])


@pytest.mark.parametrize(
    ("place", "number"),
    [
        ((0, 0, 0), 0x00E15A61),
        ((1, 0, 0), 0x3F2607FD),
        ((1, -1, 0), 0x81BD6F5F),
        ((1, 0, -1), 0x0CF6CC15),
        ((7, 123, -456), 0xE05606A7),
        ((2**31 - 1, -(2**31), 2**31 - 1), 0xECC70988),
    ],
)
def test_the_numbers_of_a_place_never_change_between_releases(place: tuple[int, int, int], number: int) -> None:
    assert int(hash3(*place)) == number


def test_scrambling_and_streams_never_change_between_releases() -> None:
    assert [int(scramble(value)) for value in (0, 1, -1)] == [0x01FCE552, 0x9F505634, 0xA4F7896C]
    assert int(stream(hash3(1, 2, 3), 1)) == 0x78BEF4FD


@given(seed=seeds, a=signed, b=signed)
def test_one_cell_and_an_array_of_cells_agree(seed: int, a: int, b: int) -> None:
    alone = hash3(seed, a, b)
    many = hash3(seed, np.array([5, a, -5], np.int32), np.array([6, b, -6], np.int32))
    assert many.dtype == np.uint32
    assert many[1] == alone
    assert unit(many)[1] == unit(alone)
    assert stream(many, 3)[1] == stream(alone, 3)


def test_cells_broadcast_against_each_other() -> None:
    assert hash3(1, np.arange(3)[None, :], np.arange(-2, 2)[:, None]).shape == (4, 3)
    assert hash3(1, np.arange(3)[None, :], np.arange(-2, 2)[:, None])[3, 2] == hash3(1, 2, 1)


def test_scrambling_is_one_to_one_and_moves_zero() -> None:
    drawn = scramble(np.arange(-(2**18), 2**18))
    assert len(np.unique(drawn)) == len(drawn)
    assert drawn[2**18] != 0


def test_every_bit_is_set_in_half_of_the_cells() -> None:
    bits = (grid(3)[..., None] >> np.arange(32, dtype=np.uint32)) & 1
    share = bits.mean(axis=(0, 1))
    assert np.abs(share - 0.5).max() < 5 * 0.5 / SIDE


@pytest.mark.parametrize("argument", ["seed", "a", "b"])
def test_changing_any_bit_of_any_argument_changes_half_of_the_result(argument: str) -> None:
    cells = np.arange(-1000, 1000, dtype=np.int64)
    flipped = []
    for bit in range(31):
        changed = {"seed": 9, "a": cells, "b": -3 * cells, argument: (9 if argument == "seed" else cells) ^ (1 << bit)}
        plain = {"seed": 9, "a": cells, "b": -3 * cells, argument: 9 if argument == "seed" else cells}
        difference = hash3(*plain.values()) ^ hash3(*changed.values())  # type: ignore[arg-type]
        flipped.append(((difference[:, None] >> np.arange(32, dtype=np.uint32)) & 1).mean(axis=0))
    assert np.abs(np.mean(flipped) - 0.5) < 0.005
    assert np.abs(np.array(flipped) - 0.5).max() < 0.1


@pytest.mark.parametrize("step", [(0, 1), (1, 0), (1, 1), (1, -1), (0, 2), (7, 0)])
def test_neighbouring_cells_are_not_correlated(step: tuple[int, int]) -> None:
    numbers = grid(1)
    assert abs(correlation(numbers, np.roll(numbers, step, axis=(0, 1)))) < 5 / SIDE


def test_seeds_and_streams_are_not_correlated() -> None:
    one = grid(1)
    others = [grid(0), grid(2), grid(2**31 - 1), stream(one, 0), stream(one, 1), stream(one, 2), one.T]
    for i, first in enumerate([one, *others]):
        for second in others[i:]:
            assert abs(correlation(first, second)) < 5 / SIDE


def test_units_fill_the_range_from_0_to_1_evenly_and_never_reach_1() -> None:
    values = unit(grid(5))
    assert values.dtype == np.float32
    counts = np.histogram(values, bins=SIDE, range=(0.0, 1.0))[0]
    chi_square = float(((counts - SIDE) ** 2 / SIDE).sum())
    assert SIDE - 5 * np.sqrt(2 * SIDE) < chi_square < SIDE + 5 * np.sqrt(2 * SIDE)
    assert unit(np.array([0, 2**32 - 1], np.uint32)).tolist() == [0.0, 1.0 - 2.0**-24]


def test_glsl_and_numpy_agree_to_the_last_bit(ctx: moderngl.Context) -> None:
    source, _ = compose("lib/random.glsl")
    program = ctx.program(
        vertex_shader=source
        + """
        in ivec3 place;
        flat out uint hashed;
        flat out uint streamed;
        flat out uint scrambled;
        flat out float fraction;
        void main() {
            hashed = hash3(place.x, place.y, place.z);
            streamed = stream(hashed, place.y);
            scrambled = scramble(hashed);
            fraction = unit(hashed);
        }
        """,
        varyings=("hashed", "streamed", "scrambled", "fraction"),
    )
    rng = np.random.default_rng(4)
    places = rng.integers(-(2**31), 2**31, (4000, 3)).astype(np.int32)
    places[:27] = np.stack(np.meshgrid([-1, 0, 1], [-1, 0, 1], [-1, 0, 1]), -1).reshape(-1, 3)
    given_places, answers = ctx.buffer(places.tobytes()), ctx.buffer(reserve=len(places) * 16)
    array = ctx.vertex_array(program, [(given_places, "3i", "place")])
    target = ctx.simple_framebuffer((1, 1))  # without a screen there is none, and even this needs one
    target.use()
    array.transform(answers, moderngl.POINTS, vertices=len(places))
    got = np.frombuffer(answers.read(), np.uint32).reshape(-1, 4)
    for resource in (array, given_places, answers, target, program):
        resource.release()

    seed, a, b = places.T
    hashed = np.array([int(hash3(int(s), i, j)) for s, i, j in zip(seed, a, b, strict=True)], np.uint32)
    streamed = np.array([int(stream(h, int(i))) for h, i in zip(hashed, a, strict=True)], np.uint32)
    np.testing.assert_array_equal(got[:, 0], hashed)
    np.testing.assert_array_equal(got[:, 1], streamed)
    np.testing.assert_array_equal(got[:, 2], scramble(hashed))
    np.testing.assert_array_equal(got[:, 3].copy().view(np.float32), unit(hashed))
