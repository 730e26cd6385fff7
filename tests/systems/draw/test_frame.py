"""What every program knows of a frame, and what the painters tell their programs."""

from collections.abc import Callable, Iterator

import moderngl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.camera import Camera, View, projection_matrix, view_matrix, view_of
from tallgrass.engine.gl import emit
from tallgrass.engine.gl.records import Records
from tallgrass.systems.features import UNITS
from tallgrass.systems.frame.block import FRAME, KIND, SHADE, FrameBlock, aim, by_kind
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


FIELDS = {
    **{name: FRAME[name] for name in FRAME.names or () if name not in {"clip", "unclip", "kinds", "shades", "padding"}},
    **{f"kinds[int(row.x)].{name}": KIND[name] for name in KIND.names or ()},
    **{f"shades[int(row.x)].{name}": SHADE[name] for name in SHADE.names or ()},
}


@pytest.mark.parametrize("name", FIELDS)
def test_the_graphics_card_reads_every_field_as_it_was_written(probe: Probe, name: str) -> None:
    record, kind = np.zeros(1, FRAME), FIELDS[name]
    record.view(np.float32)[:] = np.random.default_rng(len(name)).normal(0.0, 1.0, FRAME.itemsize // 4)
    each, _, member = name.partition("[int(row.x)].")
    written = record[0][each][member] if member else record[0][each]
    many, numbers = member or len(kind.shape) == 2, kind.shape[-1] if kind.shape else 1
    rows = np.arange(len(written) if many else 1, dtype=np.float32)[:, None] * np.ones(4, np.float32)
    asked = f"{name}[int(row.x)]" if many and not member else name
    told = probe(TELL % f"min(row.x, 0.0) + vec4({', '.join([asked, *['0.0'] * (4 - numbers)])})", rows, record, {}, 4)
    np.testing.assert_array_equal(told[:, :numbers], np.reshape(written, (-1, numbers)))


def test_a_block_that_is_laid_out_otherwise_than_std140_is_refused() -> None:
    with pytest.raises(ValueError, match=r"Frame\.sun is at 4, and std140 has it at 16"):
        emit.block("Frame", np.dtype([("tall", "f4"), ("sun", "3f4")]))


def test_records_are_looked_up_by_their_fields_names(ctx: moderngl.Context, probe: Probe) -> None:
    record, per_row = np.dtype([("cell", "2f4"), ("row", "f4"), ("fade", "f4"), ("root", "3f4"), ("growth", "f4")]), 3
    rows = np.zeros(7, record)
    rows.view(np.float32)[:] = np.random.default_rng(1).normal(0.0, 1.0, 56)
    texture = Records(ctx, record, per_row)
    texture.write(rows)
    numbers = np.arange(7, dtype=np.float32)[:, None]
    for asked, field in (("vec3(one.cell, one.fade)", ["cell", "fade"]), ("one.root", ["root"])):
        lines = f"""#include "lib/frame.glsl"
            {emit.looked_up("Standing", record, "standing", per_row)}
            in float row;
            out vec3 told;
            void main() {{ Standing one = standing_of(int(row)); told = {asked}; }}"""
        told = probe(lines, numbers, np.zeros(1, FRAME), {"standing": texture.texture}, 3)
        np.testing.assert_array_equal(told, np.column_stack([rows[name] for name in field]))
    texture.release()
    with pytest.raises(ValueError, match=r"Standing\.root lies in two texels"):
        emit.looked_up("Standing", np.dtype([("cell", "2f4"), ("root", "3f4"), ("rest", "3f4")]), "standing", 4)


@pytest.mark.parametrize("name", ["clip", "unclip"])
def test_matrices_arrive_for_column_vectors(probe: Probe, record: NDArray[np.void], name: str) -> None:
    rows = np.random.default_rng(0).normal(0.0, 1.0, (20, 4)).astype(np.float32)
    told = probe(TELL % f"{name} * row", rows, record, {}, 4)
    np.testing.assert_allclose(told, rows @ record[0][name].reshape(4, 4), rtol=1e-4, atol=1e-4)


def test_clip_and_unclip_are_inverse_and_the_eye_is_the_cameras(record: NDArray[np.void]) -> None:
    clip, unclip = (record[0][name].reshape(4, 4).T.astype(float) for name in ("clip", "unclip"))
    np.testing.assert_allclose(clip @ unclip, np.eye(4), atol=1e-3)
    np.testing.assert_allclose(record[0]["eye"], [1.0, 2.0, 3.0], atol=1e-5)
    np.testing.assert_array_equal(record[0]["half_screen"], [160.0, 100.0])


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
