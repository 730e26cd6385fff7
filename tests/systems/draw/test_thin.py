"""Texels of strips where grass grows thinly (G3)."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.systems.frame.block import FRAME

Probe = Callable[..., NDArray[np.float32]]

ASK = """#include "lib/frame.glsl"
#include "systems/show/strips/thin.glsl"
in vec4 row;  // coverage; density; mean rank; level
out float told;
void main() { told = thinned(row.x, row.y, row.z, 4.0, row.w); }"""
TEXELS, BLADES, SAMPLES, COVERS = 1500, 6, 64, 0.15
MANY = 3.0
"""Mip level whose texels show many blades."""


@pytest.mark.parametrize("dense", [0.1, 0.25, 0.6])
def test_g3_of_many_blades_as_much_is_left_where_grass_is_thin_as_of_each_by_its_rank(
    probe: Probe, dense: float
) -> None:
    """The mean over texels is right, and each texel is nearer to its true value than the mean is."""
    random = np.random.default_rng(3)
    ranks = np.sort(random.random((TEXELS, BLADES)), axis=1)
    there = random.random((TEXELS, BLADES, SAMPLES)) < COVERS
    seen, front = there.any(axis=1), there.argmax(axis=1)  # those of lower rank lie in front
    rank = np.take_along_axis(ranks, front, 1)
    rows = np.zeros((TEXELS, 4), np.float32)
    rows[:, 0], rows[:, 1], rows[:, 3] = seen.mean(axis=1), dense, MANY
    rows[:, 2] = (rank * seen).sum(axis=1) / np.maximum(seen.sum(axis=1), 1)
    found = probe(ASK, rows, np.zeros(1, FRAME), {}, 1)[:, 0]
    due = (there & (ranks < dense)[:, :, None]).any(axis=1).mean(axis=1)
    assert found.mean() == pytest.approx(due.mean(), abs=0.02)
    assert np.sqrt(np.square(found - due).mean()) < 0.85 * due.std()
    assert found.std() > 0.5 * due.std()
