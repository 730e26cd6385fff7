"""Numbers that underflow to 0, in a host whose numpy raises all errors (D6)."""

from collections.abc import Callable
from typing import Any

import numpy as np

from tallgrass.components.footprint import Footprint
from tallgrass.engine.schedule import Phase
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.testing import watch

Load = Callable[..., Prairie]

TINY = np.full(3, 1e-30, np.float32)


def test_d6_nothing_raises_where_numbers_end_in_zero_though_a_host_has_numpy_raise_all(load: Load) -> None:
    class Faint(Breeze):
        """A wind whose strength underflows to 0."""

        def action(self, *about: Any, **more: Any) -> Any:
            assert not (TINY * TINY).any()
            return super().action(*about, **more)

    prairie = load()
    with np.errstate(all="raise"):
        prairie.restore(prairie.state())
    prairie.add(Faint())
    asked = list[float]()
    prairie.systems.add(Phase.SEE, "faint", lambda: asked.append(float((TINY * TINY).sum())))
    with np.errstate(all="raise"):
        prairie.wind_at([(0.0, 0.0)])
        prairie.advance(0.1)
        prairie.bent_at([(0.0, 0.0)])
        watch(prairie)
        prairie.sow("green", Footprint(radius=3.0), 0.5, soft=1.0)
        prairie.time = 0.0
        assert np.geterr()["under"] == "raise", "it is the host's own again"
    assert asked
    assert not prairie.wind_failures
