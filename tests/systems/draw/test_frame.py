"""The frame block and the uniforms of programs."""

from collections.abc import Callable, Iterator

import moderngl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.camera import Camera, View, projection_matrix, view_matrix, view_of
from tallgrass.engine.gl import emit
from tallgrass.engine.gl.stream import Records
from tallgrass.systems.features import UNITS
from tallgrass.systems.frame.block import BODY, FRAME, KIND, FrameBlock, aim, by_kind, rays
from tallgrass.systems.show.blades.draw import MESSAGE, BladeDrawing
from tallgrass.systems.show.blades.pool import BLADE, ORGAN
from tallgrass.systems.show.blades.store import STANDING
from tallgrass.systems.show.strips.gather import PLACEMENT
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


PLAIN = [name for name in FRAME.names or () if FRAME[name].base == np.float32 and name != "clip"]
FIELDS = {
    **{name: FRAME[name] for name in PLAIN},
    **{f"kinds[int(row.x)].{name}": KIND[name] for name in KIND.names or () if KIND[name].base == np.float32},
    **{f"bodies[int(row.x)].{name}": BODY[name] for name in BODY.names or ()},
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
            {emit.record_lookup("Standing", record, "standing", per_row)}
            in float row;
            out vec3 told;
            void main() {{ Standing one = standing_of(int(row)); told = {asked}; }}"""
        told = probe(lines, numbers, np.zeros(1, FRAME), {"standing": texture.texture}, 3)
        np.testing.assert_array_equal(told, np.column_stack([rows[name] for name in field]))
    texture.release()
    with pytest.raises(ValueError, match=r"Standing\.root lies in two texels"):
        emit.record_lookup("Standing", np.dtype([("cell", "2f4"), ("root", "3f4"), ("rest", "3f4")]), "standing", 4)


def test_matrices_arrive_for_column_vectors(probe: Probe, record: NDArray[np.void]) -> None:
    rows = np.random.default_rng(0).normal(0.0, 1.0, (20, 4)).astype(np.float32)
    told = probe(TELL % "clip * row", rows, record, {}, 4)
    np.testing.assert_allclose(told, rows @ record[0]["clip"].reshape(4, 4), rtol=1e-4, atol=1e-4)


def test_the_eye_is_the_cameras(record: NDArray[np.void]) -> None:
    np.testing.assert_allclose(record[0]["eye"], [1.0, 2.0, 3.0], atol=1e-5)
    np.testing.assert_array_equal(record[0]["half_screen"], [160.0, 100.0])


def oblique(projection: NDArray[np.float64], plane: list[float]) -> NDArray[np.float64]:
    """Lengyel's projection with a near plane of its own (Oblique View Frustum Depth Projection, 2005)."""
    made, side = projection.copy(), np.array(plane)
    corner = np.linalg.inv(projection) @ [np.sign(side[0]), np.sign(side[1]), 1.0, 1.0]
    made[2] = side * (2.0 / (side @ corner)) - made[3]
    return made


def rows_of(depth: list[float]) -> NDArray[np.float64]:
    """A projection off the picture's middle with another row of depth."""
    return np.array([[1.2, 0.0, 0.3, 0.0], [0.0, 2.1, -0.2, 0.0], depth, [0.0, 0.0, -1.0, 0.0]])


USUAL = rows_of([0.0, 0.0, -1.0002, -0.20002])
PROJECTIONS = {
    "infinitely far": rows_of([0.0, 0.0, -1.0, -0.2]),
    "far over near of 1e12": rows_of([0.0, 0.0, -1.0 - 2e-12, -2e-3]),
    "depth reversed": rows_of([0.0, 0.0, 1e-4, 0.1]),
    "near plane oblique": oblique(USUAL, [0.1, 0.95, -0.2, -1.5]),
}


def sights(view: NDArray[np.float64], projection: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return unit vectors along the lines of sight at nine places of the picture, shape (9, 3)."""
    ahead, across, up = rays(View(view.astype(np.float32), projection.astype(np.float32)))
    along = np.array([ahead + x * across + y * up for x in (-1, 0, 1) for y in (-1, 0, 1)])
    return np.asarray(along / np.linalg.norm(along, axis=1, keepdims=True))


VIEWS = {"upright": np.diag([1.0, 1.0, 1.0, 1.0]), "mirrored": np.diag([1.0, -1.0, 1.0, 1.0])}


@pytest.mark.parametrize("mirror", VIEWS)
def test_lines_of_sight_are_those_to_the_far_plane_of_a_usual_projection(mirror: str) -> None:
    view = view_matrix(Camera((1.0, 2.0, 3.0), 0.4, -0.1, 0.7)).astype(float) @ VIEWS[mirror]
    back = np.linalg.inv(USUAL @ view) @ np.array([[x, y, 1.0, 1.0] for x in (-1, 0, 1) for y in (-1, 0, 1)]).T
    eye = np.linalg.inv(view)[:3, 3]
    to = (back[:3] / back[3]).T - eye
    np.testing.assert_allclose(sights(view, USUAL), to / np.linalg.norm(to, axis=1, keepdims=True), atol=1e-4)


@pytest.mark.parametrize("mirror", VIEWS)
@pytest.mark.parametrize("name", PROJECTIONS)
def test_lines_of_sight_do_not_ask_where_planes_of_depth_are(name: str, mirror: str) -> None:
    view = view_matrix(Camera((1.0, 2.0, 3.0), -2.4, 0.3, 0.7)).astype(float) @ VIEWS[mirror]
    np.testing.assert_allclose(sights(view, PROJECTIONS[name]), sights(view, USUAL), atol=1e-6)


def test_lines_of_sight_of_an_orthographic_projection_are_all_ahead() -> None:
    view = view_matrix(Camera((1.0, 2.0, 3.0), 0.4, -0.6, 0.7)).astype(float)
    flat = np.diag([0.1, 0.2, -0.01, 1.0])
    np.testing.assert_allclose(sights(view, flat), np.tile(-view[2, :3], (9, 1)), atol=1e-6)


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
    painter = BladeDrawing(ctx, block, 3, UNITS, record)
    names = {name for name in painter.program if isinstance(painter.program[name], moderngl.Attribute)}
    expected = {*(record.names or ()), *(MESSAGE.names or ())} - {"root"} - unread | {"root_at"}
    assert names - {"gl_VertexID"} == expected
    painter.release()


@pytest.mark.parametrize(
    ("record", "texels"),
    [(BLADE, 3), (ORGAN, 4), (STANDING, 3), (PLACEMENT, 2)],
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
    turning[3] = 0.0, 0.0, 0.0, 1.0  # a view has no perspective
    by_rows = view_of(turning, turning)
    by_columns = view_of(turning.T.reshape(16), tuple(turning.T.reshape(16)))
    np.testing.assert_array_equal(by_rows.view, by_columns.view)
    np.testing.assert_allclose(by_rows.clip, turning.astype(np.float64) @ turning, rtol=1e-4, atol=1e-3)
