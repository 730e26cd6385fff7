"""`change_kind`: refusals, and states during a change (F4, N5)."""

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tallgrass.engine.scene import SceneError
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import watch

Load = Callable[..., Prairie]

REFUSED: list[tuple[dict[str, Any], str]] = [
    ({"tipp": "#ffffff"}, "grass.green.tipp: unknown key 'tipp', did you mean 'tip'?"),
    ({"withered": 3.0}, "grass.green.withered: withered must be between 0 and 0.6, found 3.0"),
    (
        {"height": [3.0, 2.0]},
        "grass.green.height: height must be [shortest, tallest], rising, between 0.02 and 5 m",
    ),
    ({"head": {"form": "disc"}}, "grass.green.head.form: grass bears no disc: its heads are spikes and plumes"),
    ({"place": None}, "grass.green.place: where a kind grows is changed by sow and clear"),
    ({"over": -1.0}, "a kind changes over a time of 0 s to 1e+09 s, not -1.0"),
]


@pytest.mark.parametrize(("keys", "sentence"), REFUSED, ids=[next(iter(keys)) for keys, _ in REFUSED])
def test_n5_a_kind_is_not_changed_to_what_no_scene_may_say(
    prairie: Prairie, keys: dict[str, Any], sentence: str
) -> None:
    before = prairie.scene
    with pytest.raises(ValueError, match=f"^{re.escape(sentence)}$") as caught:
        prairie.change_kind("green", root="#000000", **keys)
    assert isinstance(caught.value, SceneError) == (keys.keys().isdisjoint({"place", "over"}))
    prairie.advance(1.0)
    assert prairie.scene is before


def test_n5_what_is_no_kind_is_not_changed(prairie: Prairie) -> None:
    with pytest.raises(ValueError, match=r"unknown grass 'gren'; there are green"):
        prairie.change_kind("gren", tip="#000000")
    with pytest.raises(TypeError, match="the name of a kind of grass, not None"):
        prairie.change_kind(None, tip="#000000")  # type: ignore[arg-type]


def test_f4_values_go_evenly_and_each_takes_its_own_time(prairie: Prairie) -> None:
    prairie.change_kind("green", gloss=1.06, tip="#000000", over=4.0)
    prairie.change_kind("green", variety=0.55)
    seen = []
    for _ in range(5):
        watch(prairie)
        kind = prairie.scene.grass["green"]
        seen.append((kind.gloss, kind.tip, kind.variety))
        prairie.advance(1.0)
    glosses, tips, varieties = zip(*seen, strict=True)
    np.testing.assert_allclose(np.diff(glosses), 0.25)
    assert tips[0] == "#a8b65a"
    assert tips[2] == "#545b2d"
    assert tips[-1] == "#000000"
    assert set(varieties) == {0.55}


def test_f4_a_value_that_is_changed_again_goes_on_from_where_it_is(prairie: Prairie) -> None:
    prairie.change_kind("green", gloss=1.06, over=4.0)
    prairie.advance(2.0)
    prairie.change_kind("green", gloss=0.06, over=5.0)
    prairie.advance(1.0)
    watch(prairie)
    assert prairie.scene.grass["green"].gloss == pytest.approx(0.56 - 0.1)


def test_f4_a_state_keeps_a_kind_on_its_way(load: Load) -> None:
    played = load(live=False)
    played.advance(1.0)
    played.change_kind("green", tip="#ff0000", over=8.0)
    played.change_kind("green", understorey=0.2, height=[0.4, 0.7])
    played.advance(2.0)
    state, other = played.state(), load(live=False)
    other.restore(state)
    assert other.grass_at([(0.0, 0.0)]).height[0] > 0.5
    for _ in range(3):
        watch(played)
        watch(other)
        assert other.scene.grass == played.scene.grass
        played.advance(3.0)
        other.advance(3.0)
    assert other.scene.grass["green"].tip == "#ff0000"
    again = load(live=False)
    again.restore(other.state())
    assert again.scene.grass == other.scene.grass


def test_f4_a_state_of_a_kind_that_still_grows_shows_what_was_seen_when_it_was_saved(load: Load) -> None:
    played, other = load(), load()
    played.change_kind("green", height=[0.8, 1.0], over=8.0)
    played.advance(4.0)  # and no frame has come, let alone what grows on another thread
    other.restore(played.state())
    assert other.grass_at([(0.0, 0.0)]).height[0] == played.grass_at([(0.0, 0.0)]).height[0]


def test_f4_a_scene_that_is_read_again_has_its_own_kinds(prairie: Prairie) -> None:
    before = prairie.scene.grass
    prairie.change_kind("green", tip="#ff0000", withered=0.5, over=2.0)
    prairie.advance(1.0)
    watch(prairie)
    prairie.reload()
    prairie.advance(5.0)
    watch(prairie)
    assert prairie.scene.grass == before
