"""Buffers that are filled anew every frame."""

from collections.abc import Iterator

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.gl.stream import Stream, attributes, release_all

RECORD = np.dtype([("place", "3f4"), ("size", "f4"), ("turn", "(2,2)f4")])
SOURCE = """#version 330
in float size;
in vec4 turn;
out float told;
void main() { told = size + turn.w; }"""


@pytest.fixture
def stream(ctx: moderngl.Context) -> Iterator[Stream]:
    made = Stream(ctx, RECORD)
    yield made
    made.release()


def rows(count: int, seed: int = 0) -> NDArray[np.void]:
    made = np.zeros(count, RECORD)
    random = np.random.default_rng(seed)
    for name in RECORD.names or ():
        made[name] = random.random(made[name].shape)
    return made


def told(ctx: moderngl.Context, stream: Stream) -> NDArray[np.float32]:
    """Return the numbers that a program reads from the stream, one per record."""
    program = ctx.program(vertex_shader=SOURCE, varyings=("told",))
    array = ctx.vertex_array(program, [stream.binding(program)])
    result = ctx.buffer(reserve=max(4 * stream.count, 4))
    array.transform(result, moderngl.POINTS, vertices=1, instances=stream.count)
    numbers = np.frombuffer(result.read(), np.float32)[: stream.count]
    release_all(array, program, result)
    return numbers


def test_attributes_are_the_records_fields() -> None:
    assert attributes(RECORD) == ("3f 1f 4f", ["place", "size", "turn"])


@pytest.mark.parametrize("count", [1, 7, 1024, 5000])
def test_a_program_reads_one_record_per_instance_and_skips_what_it_does_not_use(
    ctx: moderngl.Context, stream: Stream, count: int
) -> None:
    written = rows(count)
    stream.write(written)
    assert stream.count == count
    np.testing.assert_allclose(told(ctx, stream), written["size"] + written["turn"][:, 1, 1], rtol=1e-6)


def test_what_is_written_later_takes_the_place_of_what_was_there(ctx: moderngl.Context, stream: Stream) -> None:
    for count, seed in ((3000, 1), (10, 2), (2000, 3)):
        written = rows(count, seed)
        stream.write(written)
        np.testing.assert_allclose(told(ctx, stream), written["size"] + written["turn"][:, 1, 1], rtol=1e-6)


def test_a_stream_that_has_grown_keeps_its_vertex_arrays(ctx: moderngl.Context, stream: Stream) -> None:
    program = ctx.program(vertex_shader=SOURCE, varyings=("told",))
    array = ctx.vertex_array(program, [stream.binding(program)])
    written = rows(4000)
    stream.write(written)
    result = ctx.buffer(reserve=16000)
    array.transform(result, moderngl.POINTS, vertices=1, instances=4000)
    read = np.frombuffer(result.read(), np.float32)
    np.testing.assert_allclose(read, written["size"] + written["turn"][:, 1, 1], rtol=1e-6)
    release_all(array, program, result)


def test_a_slice_of_records_is_written_as_it_is_read(ctx: moderngl.Context, stream: Stream) -> None:
    written = rows(300)[::-3]
    stream.write(written)
    np.testing.assert_allclose(told(ctx, stream), written["size"] + written["turn"][:, 1, 1], rtol=1e-6)


def test_an_empty_stream_has_no_records(stream: Stream) -> None:
    stream.write(rows(5))
    stream.write(rows(0))
    assert stream.count == 0


def test_everything_is_released_in_turn() -> None:
    class Thing:
        def __init__(self, name: str) -> None:
            self.name = name

        def release(self) -> None:
            released.append(self.name)

    released: list[str] = []
    release_all(Thing("array"), Thing("buffer"))
    assert released == ["array", "buffer"]
