"""Places of strips: the graphics card and numpy agree (G3, T1)."""

from collections.abc import Callable
from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.systems.grow.record import Growth
from tallgrass.systems.show.strips.pool import StripPool, is_reversed
from tallgrass.systems.show.strips.stock import stock_strips
from tallgrass.systems.site import Site

Laid = Callable[..., Site]
RecordOf = Callable[..., NDArray[np.void]]
Probe = Callable[..., NDArray[np.float32]]

ASK = """#include "lib/stack.glsl"
in vec4 row;  // quarter turns and axis; place in the stack; edge; kind
out vec4 told;
void main() {
    int turn = int(row.x) %% 4, along = int(row.x) / 4, own = (along + turn) %% 2;
    int plane = stack_place(int(row.y), %(count)d, own, along, turn);
    float margin = row.w > 0.5 ? %(second)r : %(first)r;
    vec2 foot = edge_foot(vec2(%(cell)s), turn, own, plane, %(count)d, int(row.z), %(columns)d, margin);
    told = vec4(foot, float(plane), is_reversed(own, along, turn) ? 1.0 : 0.0);
}"""


@pytest.mark.parametrize("cell", [(0, 0), (-7, 12)])
@pytest.mark.parametrize(("ring", "columns"), [(0, 2), (1, 1), (0, 5)])
def test_g3_edges_stand_in_the_same_places_on_the_card_and_in_numpy_whichever_way_a_patch_is_turned(
    laid: Laid, growths: list[Growth], record_of: RecordOf, probe: Probe, ring: int, columns: int, cell: tuple[int, int]
) -> None:
    site, strips = laid(), stock_strips(growths).strips[ring]
    record = record_of(site)
    ways = np.array(list(product((0, 1), range(4))), np.int32)
    pool = StripPool(3, strips, columns, site.quality.patch)
    slots = np.arange(len(ways))
    pool.stamp[slots, :2], pool.stamp[slots, 2], pool.model_and_turn[slots, 1] = cell, ways[:, 0], ways[:, 1]
    kinds, count, edges = pool.shape
    rows = [
        (turn + 4 * along, stack, edge, kind)
        for along, turn in ways
        for kind, stack, edge in product(range(kinds), range(count), range(edges))
    ]
    words = {
        "count": count, "columns": columns, "cell": f"{cell[0]}.0, {cell[1]}.0",
        "first": float(strips[0].margin), "second": float(strips[1].margin),
    }  # fmt: skip
    told = probe(ASK % words, np.array(rows, np.float32), record, {}, 4)
    np.testing.assert_allclose(told[:, :2], pool.places(slots).reshape(-1, 2), atol=2e-5)
    along, turn = ways.T
    backwards = np.repeat(is_reversed((along + turn) % 2, along, turn), kinds * count * edges)
    np.testing.assert_array_equal(told[:, 3], backwards)
    stack = np.array(rows)[:, 1]
    np.testing.assert_array_equal(told[:, 2], np.where(backwards, count - 1 - stack, stack))
    assert 0.0 < backwards.mean() < 1.0
