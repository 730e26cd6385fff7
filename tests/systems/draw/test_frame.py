"""What every program knows of a frame, and what the painters tell their programs."""

import re
from collections.abc import Callable, Iterator
from importlib.resources import files

import moderngl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.camera import Camera, View, projection_matrix, view_matrix, view_of
from tallgrass.systems.features import UNITS
from tallgrass.systems.frame.block import FRAME, FrameBlock, aim, by_kind
from tallgrass.systems.show.blades.draw import MESSAGE, BladePainter
from tallgrass.systems.show.blades.pool import BLADE, ORGAN
from tallgrass.systems.show.blades.store import STANDING
from tallgrass.systems.show.strips.gather import STOOD
from tallgrass.systems.site import Site

Laid = Callable[..., Site]
RecordOf = Callable[..., NDArray[np.void]]
Probe = Callable[..., NDArray[np.float32]]

TELL = """#include "lib/frame.glsl"
in vec4 row;
out vec4 told;
void main() { told = %s; }"""


@pytest.fixture
def record(laid: Laid, record_of: RecordOf) -> NDArray[np.void]:
    site = laid()
    made = record_of(site)
    view = View(view_matrix(Camera((1.0, 2.0, 3.0), 0.4, -0.1, 0.7)), projection_matrix(0.7, 1.6))
    aim(made, view, (320, 200))
    return made


@pytest.fixture
def block(ctx: moderngl.Context) -> Iterator[FrameBlock]:
    made = FrameBlock(ctx)
    yield made
    made.release()


def test_the_shaders_block_has_the_records_fields_in_its_order() -> None:
    source = files("tallgrass.engine.shaders").joinpath("lib/frame.glsl").read_text("utf-8")
    declared = re.findall(r"^\s+(mat4|vec4) (\w+)(?:\[(\d+)\])?;", source, re.MULTILINE)
    sizes = {name: {"mat4": 64, "vec4": 16}[kind] * int(count or 1) for kind, name, count in declared}
    assert list(sizes.items()) == [(name, FRAME[name].itemsize) for name in FRAME.names or ()]


@pytest.mark.parametrize("name", [name for name in FRAME.names or () if name not in {"clip", "unclip"}])
def test_the_graphics_card_reads_every_field_as_it_was_written(
    probe: Probe, record: NDArray[np.void], name: str
) -> None:
    many = len(FRAME[name].shape) == 2
    count = FRAME[name].shape[0]
    rows = np.ones((count, 4), np.float32) * np.arange(count, dtype=np.float32)[:, None]
    told = probe(TELL % (f"{name}[int(row.x)]" if many else f"{name} * row.w"), rows, record, {}, 4)
    expected = record[0][name] if many else rows * record[0][name]
    np.testing.assert_array_equal(told, expected)


@pytest.mark.parametrize("name", ["clip", "unclip"])
def test_matrices_arrive_for_column_vectors(probe: Probe, record: NDArray[np.void], name: str) -> None:
    rows = np.random.default_rng(0).normal(0.0, 1.0, (20, 4)).astype(np.float32)
    told = probe(TELL % f"{name} * row", rows, record, {}, 4)
    np.testing.assert_allclose(told, rows @ record[0][name].reshape(4, 4), rtol=1e-4, atol=1e-4)


def test_clip_and_unclip_are_inverse_and_the_eye_is_the_cameras(record: NDArray[np.void]) -> None:
    clip, unclip = (record[0][name].reshape(4, 4).T.astype(float) for name in ("clip", "unclip"))
    np.testing.assert_allclose(clip @ unclip, np.eye(4), atol=1e-3)
    np.testing.assert_allclose(record[0]["eye"], [1.0, 2.0, 3.0, 0.0], atol=1e-5)
    np.testing.assert_array_equal(record[0]["screen"][:2], [160.0, 100.0])


def test_d6_the_block_stays_away_from_the_hosts_own_binding_points(ctx: moderngl.Context, block: FrameBlock) -> None:
    assert block.binding == ctx.info["GL_MAX_UNIFORM_BUFFER_BINDINGS"] - 1
    assert block.binding >= 35


def test_figures_by_kind_fill_vectors_of_four() -> None:
    assert by_kind([1.0, 2.0]) == (1.0, 2.0, 0.0, 0.0)
    assert by_kind([1.0, 2.0, 3.0, 4.0, 5.0]) == [(1.0, 2.0, 3.0, 4.0), (5.0, 0.0, 0.0, 0.0)]


@pytest.mark.parametrize(("record", "unread"), [(BLADE, {"organ"}), (ORGAN, set())], ids=["grass", "plants"])
def test_every_field_of_a_blade_is_an_attribute_of_its_shader(
    ctx: moderngl.Context, block: FrameBlock, record: np.dtype[np.void], unread: set[str]
) -> None:
    painter = BladePainter(ctx, block, 3, UNITS, record)
    names = {name for name in painter.program if isinstance(painter.program[name], moderngl.Attribute)}
    expected = {*(record.names or ()), *(MESSAGE.names or ())} - {"root"} - unread | {"root_at"}
    assert names - {"gl_VertexID"} == expected
    painter.release()


@pytest.mark.parametrize(
    ("record", "texels"),
    [(BLADE, 3), (ORGAN, 4), (STANDING, 3), (STOOD, 2)],
    ids=["blade", "organ", "blades", "strips"],
)
def test_a_record_of_the_stores_is_as_many_texels_as_its_shaders_read(record: np.dtype[np.void], texels: int) -> None:
    assert record.itemsize == texels * 4 * 4
    assert all(record[name].base == np.float32 for name in record.names or ())


matrices = st.lists(st.floats(-10, 10, width=32), min_size=16, max_size=16)


@given(matrices)
def test_d6_a_matrix_may_come_as_rows_or_as_pyglets_columns(numbers: list[float]) -> None:
    rows = np.array(numbers, np.float32).reshape(4, 4)
    turning = rows + 40.0 * np.eye(4, dtype=np.float32)
    by_rows = view_of(turning, turning).view
    by_columns = view_of(turning.T.reshape(16), tuple(turning.T.reshape(16))).view
    np.testing.assert_array_equal(by_rows, turning)
    np.testing.assert_array_equal(by_columns, turning)
