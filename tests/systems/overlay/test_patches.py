"""Levels of detail and transition weights, patch by patch."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.declared.quality import Representation
from tallgrass.systems.field import Field
from tallgrass.systems.overlay.marks import Marks
from tallgrass.systems.overlay.paint import ring_shades
from tallgrass.systems.overlay.patches import level_marks, patch_colors, squares, weight_marks

Laid = Callable[..., Any]
Look = Callable[..., Any]


def cells_of(marks: Marks, patch: float) -> NDArray[np.int64]:
    """The cell under each square of two triangles."""
    middle = marks.shapes["place"].reshape(-1, 6, 3).mean(axis=1)[:, ::2]
    return np.asarray(np.floor(middle / patch), np.int64)


def looked_at(laid: Laid, look: Look) -> Field:
    field: Field = laid()
    look(field, 1.0, 1.0, yaw=0.3)
    return field


def test_n8_squares_stand_in_the_middle_of_their_cells() -> None:
    cells = np.array([[0, 0], [-3, 7]], np.int32)
    corners = squares(cells, patch=2.5, part=np.array([1.0, 0.5], np.float32))
    np.testing.assert_allclose(corners.mean(axis=1), (cells + 0.5) * 2.5, atol=1e-5)
    sides = np.ptp(corners, axis=1)
    assert 2.2 < sides[0, 0] < 2.5
    np.testing.assert_allclose(sides[1], sides[0] / 2, rtol=1e-5)


def test_n8_each_visible_patch_has_one_square_in_its_representations_colour(laid: Laid, look: Look) -> None:
    field = looked_at(laid, look)
    table, marks = field.table, level_marks(field)
    seen = np.flatnonzero(table.alive & table.visible)
    assert 0 < len(seen) < table.alive.sum()
    np.testing.assert_array_equal(cells_of(marks, field.quality.patch), table.cell[seen])
    colors = marks.shapes["color"].reshape(-1, 6, 4)[:, 0, :3]
    pure = {level: ring_shades(level, count) for level, count in zip(Representation, (2, 2, 1), strict=True)}
    for level in (Representation.BLADES, Representation.STRIPS):
        of_it = (table.representation[seen] == level) & (table.distance[seen] <= 5)
        assert of_it.any()
        assert all(any(np.allclose(color, shade) for shade in pure[level]) for color in colors[of_it])
    far = table.distance[seen] > field.reach[1] + 1
    np.testing.assert_allclose(colors[far], np.tile(pure[Representation.CARPET], (far.sum(), 1)))


def test_n8_rings_are_shades_from_strong_to_pale(laid: Laid, look: Look) -> None:
    field = looked_at(laid, look)
    colors, table = patch_colors(field), field.table
    near, far = (np.flatnonzero(table.visible & (table.distance == distance))[0] for distance in (1, 2))
    assert colors[far].min() > colors[near].min() + 0.1


def changing(field: Field, progress: float) -> int:
    """Let one visible patch be on its way from strips to blades; return its row."""
    table = field.table
    row = int(np.flatnonzero(table.visible & table.alive & (table.distance == 2))[0])
    table.representation[row], table.previous[row] = Representation.BLADES, Representation.STRIPS
    table.progress[row] = progress
    return row


@pytest.mark.parametrize("progress", [0.1, 0.5, 0.9])
def test_n8_a_changing_patch_is_filled_by_as_much_as_it_has_changed(laid: Laid, look: Look, progress: float) -> None:
    field = looked_at(laid, look)
    row = changing(field, progress)
    marks = weight_marks(field)
    here = np.flatnonzero((cells_of(marks, field.quality.patch) == field.table.cell[row]).all(axis=1))
    assert len(here) == 2, "the coarser one, and the finer one inside it"
    squares_here = marks.shapes.reshape(-1, 6)[here]
    outer, inner = (np.ptp(one["place"][:, 0]) * np.ptp(one["place"][:, 2]) for one in squares_here)
    assert inner / outer == pytest.approx(progress, abs=1e-3)
    for one, level in zip(squares_here, (Representation.STRIPS, Representation.BLADES), strict=True):
        np.testing.assert_allclose(one["color"][0, :3], ring_shades(level, 1)[0], atol=1e-6)
    lines = np.floor(marks.lines["a"][:, ::2] / field.quality.patch)
    assert (lines == field.table.cell[row]).all(), "it alone is outlined"


def test_n8_a_patch_with_one_representation_has_no_weight_to_show(laid: Laid, look: Look) -> None:
    field = looked_at(laid, look)
    table = field.table
    near = table.cell[table.visible & (table.distance < 2)].tolist()
    shown = cells_of(weight_marks(field), field.quality.patch).tolist()
    assert not [cell for cell in near if cell in shown]
    assert len(weight_marks(field).lines) == 0
    row = changing(field, 0.5)
    settled = cells_of(level_marks(field, settled=True), field.quality.patch).tolist()
    assert table.cell[row].tolist() not in settled
    assert all(cell in settled for cell in near)


def test_n8_a_ring_that_is_changing_has_a_shade_between(laid: Laid, look: Look) -> None:
    field = looked_at(laid, look)
    row = int(np.flatnonzero(field.table.visible & (field.table.distance == 1))[0])
    field.table.sublevel[0, row], field.table.sublevel_before[0, row] = 1, 0
    field.table.sublevel_progress[0, row] = 0.25
    near, far = ring_shades(Representation.BLADES, 2)
    np.testing.assert_allclose(patch_colors(field)[row], near + 0.25 * (far - near), atol=1e-6)
