"""Trees of all streams share buffers, each stream in a segment that moves when it grows."""

from collections.abc import Iterator

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.gl.stream import release_all
from tallgrass.systems.trees.segments import SPARE_TREES, Segment, Segments
from tallgrass.systems.trees.standing import INSTANCE

SOURCE = """#version 330
in vec3 root;
in float hertz;
out float told;
void main() { told = root.y + hertz; }"""


@pytest.fixture
def segments(ctx: moderngl.Context) -> Iterator[Segments]:
    made = Segments(ctx)
    yield made
    made.release()


class Reader:
    """A program that reads some segments, each by a vertex array that is made once."""

    def __init__(self, ctx: moderngl.Context, segments: list[Segment]) -> None:
        self.program = ctx.program(vertex_shader=SOURCE, varyings=("told",))
        self.result = ctx.buffer(reserve=40000)
        self.arrays = {}
        for each in segments:
            contents = [content for content in each.bindings(self.program) if len(content) > 2]
            self.arrays[each] = ctx.vertex_array(self.program, contents)
            each.lead(self.arrays[each])

    def read(self, segment: Segment) -> NDArray[np.float32]:
        self.arrays[segment].transform(self.result, moderngl.POINTS, vertices=1, instances=segment.count)
        return np.frombuffer(self.result.read(4 * segment.count), np.float32)


def test_each_stream_reads_its_own_trees_however_many_come_and_go(ctx: moderngl.Context, segments: Segments) -> None:
    draw, streams = np.random.default_rng(1), [segments.segment() for _ in range(6)]
    reader, moved, sizes = Reader(ctx, streams), 0, list[int]()
    for step in range(40):
        filled = [each for each in streams if draw.random() < 0.7]
        count = [int(draw.integers(1, 20 * (1 + step % 9))) for _ in filled]
        trees, before = np.zeros(sum(count), INSTANCE), [each.first for each in filled]
        trees["root"][:, 1], trees["hertz"] = np.arange(len(trees)), step
        one_by_one = np.split(trees, np.cumsum(count)[:-1]) if count else []
        segments.write(filled, [np.split(each, [step % (1 + len(each))]) for each in one_by_one])
        segments.upload()
        moved += sum(each.first != first for each, first in zip(filled, before, strict=True))
        told = np.concatenate([np.zeros(0, np.float32), *(reader.read(each) for each in filled)])
        assert np.array_equal(told, trees["root"][:, 1] + trees["hertz"])
        assert all(each.count == 0 for each in streams if each not in filled)
        sizes.append(segments.instances.count - 2 * len(trees))
    assert moved > 10
    assert max(sizes) <= 2 * SPARE_TREES * len(streams)  # room to spare is bounded
    release_all(*reader.arrays.values(), reader.program, reader.result)


def test_a_stream_that_hardly_changes_stays_where_it_is(segments: Segments) -> None:
    streams = [segments.segment() for _ in range(3)]
    segments.write(streams, [[np.zeros(count, INSTANCE)] for count in (100, 50, 20)])
    before = [each.first for each in streams]
    segments.write(streams, [[np.zeros(count, INSTANCE)] for count in (105, 40, 22)])
    assert [each.first for each in streams] == before


def test_what_has_changed_in_the_trees_is_written_again(ctx: moderngl.Context, segments: Segments) -> None:
    streams, trees = [segments.segment() for _ in range(2)], np.zeros(30, INSTANCE)
    reader = Reader(ctx, streams)
    segments.write(streams, [[trees[:10]], [trees[10:20], trees[20:]]])
    trees["hertz"] = np.arange(30)
    streams[0].count = 4
    segments.overwrite([(streams[0], 0, trees[6:10]), (streams[1], 10, trees[20:])])
    segments.upload()
    assert np.concatenate([*map(reader.read, streams)]).tolist() == [6, 7, 8, 9, *[0] * 10, *range(20, 30)]
    release_all(*reader.arrays.values(), reader.program, reader.result)
