"""Strips as computed by the graphics card: bent edges, painted extents, and order (W1, G3, T5)."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tallgrass.components.arrays import Doubles
from tallgrass.systems.grow.bend import bending
from tallgrass.systems.light.draw import LightPart
from tallgrass.systems.show.strips.pool import is_reversed
from tallgrass.systems.show.strips.shown import StripsShown

FILTERED = 0.02
"""Tolerance of places, as cards filter heights in 256 steps between two texels [m]."""


def bent(scene: Any, kind: NDArray[np.int64], message: NDArray[np.float32]) -> Doubles:
    """Return the tips of bent edges of length 1, for kinds (n,) and messages (n, 2)."""
    postures = [growth.postures for growth in scene.prairie.site.growths]
    table = np.stack([each.shape[0, :, -1] for each in postures]).astype(float)
    bend = np.where(kind[:, None] == 0, *(bending(each, message) for each in postures))
    index = np.linalg.norm(bend, axis=1)
    row = (0.5 + 0.5 * np.minimum(index, 1.0)) * (table.shape[1] - 1)
    low = np.minimum(row.astype(int), table.shape[1] - 2)
    part = (row - low)[:, None]
    ahead, up = (table[kind, low] * (1.0 - part) + table[kind, low + 1] * part).T
    heading = bend / np.maximum(index, 1e-6)[:, None]
    return np.stack([heading[:, 0] * ahead, up, heading[:, 1] * ahead], axis=1)


def laid_back(run: Doubles, foot: Doubles, top: Doubles, height: Doubles, spacing: float, rise: Doubles) -> Doubles:
    """Return the backward lean of strips' tops, so that none is seen edge-on; `foot` (n, 3) is relative to the eye.

    The ground rises by `rise` (n, 2) along x and z.
    """
    off = np.column_stack([-run[:, 1], np.zeros(len(run)), run[:, 0]]) / np.linalg.norm(run, axis=1)[:, None]
    off *= np.sign((off * foot).sum(axis=1, keepdims=True))
    along, above = (off * foot).sum(axis=1), -foot[:, 1]
    behind = along / np.maximum(above + (rise * foot[:, ::2]).sum(axis=1), 0.01)
    drop = np.maximum(above, 0.01) / np.maximum(along, 0.01)
    least = np.minimum(2.0 * spacing, height * behind)
    reach = (top[:, 1] + (off * top).sum(axis=1) * drop) * behind
    back = np.clip((least - reach) / np.maximum(drop * behind, 1.0), 0.0, 2.0 * least)
    return np.asarray(off * back[:, None])


def put_nearer(foot: Doubles, run: Doubles, spacing: float, rise: Doubles) -> Doubles:
    """Return the displaced feet of strips with `foot` (n, 3) relative to the eye, on ground of slope `rise` (n, 2)."""
    off = np.column_stack([-run[:, 1], run[:, 0]]) / np.linalg.norm(run, axis=1)[:, None]
    nearer = np.minimum(min(0.33 * spacing, 0.2) / np.linalg.norm(foot, axis=1), 0.0125)
    way = off * (-nearer * (off * foot[:, ::2]).sum(axis=1))[:, None]
    return np.asarray(foot + np.column_stack([way[:, 0], (rise * way).sum(axis=1), way[:, 1]]))


def rise_of(scene: Any, place: Doubles) -> Doubles:
    """Return the ground's slope along x and z at places (n, 2), from the texture `lie`, shape (n, 2)."""
    texture, terrain = scene.painter.part(LightPart).lie._map.lie, scene.prairie.site.ground.terrain  # noqa: SLF001
    normals = np.frombuffer(texture.read(), np.float16).reshape(*texture.size[::-1], 4).astype(float)
    still = normals[:, : texture.width // 2, :2]
    at = (place - np.array(terrain.origin)) / terrain.size * still.shape[1::-1] - 0.5
    low = np.clip(np.floor(at).astype(int), 0, np.array(still.shape[1::-1]) - 2)
    part = np.clip(at - low, 0.0, 1.0)
    lines = [
        still[low[:, 1] + line, low[:, 0]] * (1 - part[:, :1]) + still[low[:, 1] + line, low[:, 0] + 1] * part[:, :1]
        for line in (0, 1)
    ]
    normal = lines[0] * (1 - part[:, 1:]) + lines[1] * part[:, 1:]
    return np.asarray(-normal / np.sqrt(1.0 - (normal**2).sum(axis=1, keepdims=True)))


def test_w1_a_strip_stands_between_two_edges_on_the_ground_each_bent_as_numpy_says(scene: Any) -> None:
    everything, stock, quality = scene.strips_drawn(), scene.representation.stock, scene.representation.quality
    clip = scene.painter.record[0]["clip"].reshape(4, 4).astype(float)
    pictures, kinds = scene.first_pictures, len(stock.strips[0])
    patches, kept = scene.outlook.patches, scene.outlook.kept["strips"].receiving
    for number, (receiving, ring) in enumerate(zip(kept, scene.outlook.shows(StripsShown).rings, strict=True)):
        here, count = everything.ring == number, quality.strip_rings[number].strips
        first = pictures[kinds * number :][:2]
        shown, column = everything.picture[here], everything.column[here].astype(int)
        kind = (shown >= first[1]).astype(int)
        patch = np.repeat(np.arange(len(ring.rows)), len(shown) // len(ring.rows))
        picture, plane = np.divmod(shown - first[kind], count)
        turn, along = patches.turn[ring.rows], ring.along
        own = (along + turn) % 2
        np.testing.assert_array_equal(picture, (patches.model[ring.rows] * 2 + own)[patch])
        stack = np.where(is_reversed(own, along, turn)[patch], count - 1 - plane, plane)
        places = receiving.pool.places(ring.slots)
        heard = receiving.messages.heard(ring.slots).reshape(places.shape)
        height = np.array([strips.height for strips in stock.strips[0]])[kind] * scene.appears.growth[ring.rows][patch]
        spacing, eye = quality.patch / count, np.array(scene.outlook.viewer.eye)
        ends = [places[patch, kind, stack, column + side] for side in (0, 1)]
        run, feet = ends[1] - ends[0], []
        for at in ends:
            ground = np.column_stack([at[:, 0], scene.prairie.height_at(at), at[:, 1]])
            feet.append(put_nearer(ground - eye, run, spacing, rise_of(scene, at)) + eye)
        for side in (0, 1):
            foot, message = feet[side], heard[patch, kind, stack, column + side]
            top = height[:, None] * bent(scene, kind, message)
            tip = foot + top + laid_back(run, foot - eye, top, height, spacing, rise_of(scene, foot[:, ::2]))
            for place, vertex in ((foot, side), (tip, 2 * quality.strip_rings[number].sections + side)):
                expected = np.column_stack([place, np.ones(len(place))]) @ clip
                np.testing.assert_allclose(everything.clip[here, vertex], expected, atol=FILTERED)
        assert np.linalg.norm(heard, axis=-1).mean() > 0.15
        assert len(set(turn.tolist())) == 4


def test_t5_on_each_patch_strips_are_drawn_from_its_far_side_to_its_near_one(scene: Any) -> None:
    everything, outlook, seen = scene.strips_drawn(), scene.outlook, 0
    back = np.linalg.inv(scene.painter.record[0]["clip"].reshape(4, 4).astype(float))
    off = (everything.clip[:, 0] @ back)[:, [0, 2]] - np.array(outlook.viewer.eye)[::2]
    for number, ring in enumerate(outlook.shows(StripsShown).rings):
        for row, along in zip(ring.rows, ring.along, strict=True):
            across, once = 1 - along, np.count_nonzero(ring.rows == row) == 1
            if once and outlook.patches.cell[row, across] != outlook.viewer.centre[across]:  # on one side of the eye
                away = np.abs(off[(everything.ring == number) & (everything.row == row), across])
                assert (np.diff(away) < FILTERED).all()
                seen += int(away[0] - away[-1] > 1.0)
    assert seen > 8


def test_g3_a_strip_that_ends_where_its_paint_ends_is_a_part_of_the_whole_one(scene: Any) -> None:
    texture = scene.strips.uploaded.extents
    extents = np.frombuffer(texture.read(), np.float32).reshape(*texture.size[::-1], 4)
    everything, ends = scene.strips_drawn(), scene.strips_drawn(whole=False)
    for number, ring in enumerate(scene.representation.quality.strip_rings):
        here, vertices = everything.ring == number, slice(2 * ring.sections + 2)
        whole, part = everything.clip[here, vertices], ends.clip[here, vertices]
        top = extents[everything.picture[here], everything.column[here], 2]
        below = np.arange(ring.sections) <= ring.sections * top[:, None]
        foot, run = whole[:, :-2:2, None], (whole[:, 1:-2:2] - whole[:, :-2:2])[:, :, None]
        edges = np.stack([part[:, :-2:2], part[:, 1:-2:2]], axis=2)
        across = ((edges - foot) * run).sum(axis=3) / (run * run).sum(axis=3)
        np.testing.assert_allclose(edges[below], (foot + across[..., None] * run)[below], atol=1e-3)
        assert below.mean() > 0.5
        assert (np.abs(across[below] - 0.5) < 0.5 + 1e-4).all()
        assert (across[..., 1] - across[..., 0])[below].min() < 0.95
