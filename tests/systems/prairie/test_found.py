"""`finding`: a scene's site is found on another thread, while the prairie goes on unchanged."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import esper
import numpy as np
import pytest

from tallgrass.components.footprint import Footprint
from tallgrass.components.receivers import Receivers
from tallgrass.engine.declared.quality import PRESETS
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import watch

PLACES = np.random.default_rng(2).uniform(-25.0, 25.0, (50, 2)).astype(np.float32)


def test_a_site_that_another_thread_has_found_comes_with_the_scene_that_it_was_found_for(
    load: Callable[..., Prairie],
) -> None:
    prairie, other = load(), load()
    assert prairie.path is not None
    text = prairie.path.read_text("utf-8")
    prairie.path.write_text(text.replace("height: [0.3, 0.5]", "height: [0.2, 0.3]"), "utf-8")
    find = prairie.finding()
    prairie.path.write_text("tallgrass: nothing that could be read", "utf-8")
    with ThreadPoolExecutor(1) as hand:
        site = hand.submit(find).result()
    assert prairie.scene.grass["green"].height == [0.3, 0.5]
    with pytest.raises(TypeError, match=r"^site is what finding\(\.\.\.\)\(\) of this prairie returned, and"):
        other.reload(site=site)
    prairie.reload(site=site)
    assert prairie.site is site
    assert prairie.scene.grass["green"].height == [0.2, 0.3]


def test_another_preset_comes_with_the_next_reload_and_what_a_game_did_stays(
    load: Callable[..., Prairie], monkeypatch: pytest.MonkeyPatch
) -> None:
    prairie = load()
    own = prairie.scene.quality
    monkeypatch.setitem(PRESETS, "low", own.model_copy(update={"blades": 40}))  # type: ignore[union-attr]
    prairie.cut(Footprint(radius=5.0), 0.1)
    prairie.advance(1.5)
    sparse = prairie.statistics.blades_field
    felt, dense = prairie.wind_at(PLACES), prairie.grass_at(PLACES).density
    prairie.preset = "low"
    prairie.reload(site=prairie.finding()())
    assert prairie.statistics.blades_field == 2 * sparse
    np.testing.assert_array_equal(prairie.wind_at(PLACES), felt)
    np.testing.assert_array_equal(prairie.grass_at(PLACES).density, dense)
    assert (prairie.time, prairie.grass_at([(0.0, 0.0)]).height[0] <= 0.1) == (1.5, True)
    with pytest.raises(ValueError, match="unknown preset 'lowest'; there are minimal, low"):
        prairie.preset = "lowest"
    assert prairie.preset == "low"


def test_what_was_sown_stays_where_a_scene_that_is_read_again_has_another_kind_first(
    load: Callable[..., Prairie],
) -> None:
    prairie = load()
    prairie.sow("green", Footprint(radius=3.0), 0.8)
    assert prairie.path is not None
    text = prairie.path.read_text("utf-8")
    dry = "dry: { height: [0.4, 0.6] }"
    prairie.path.write_text(text.replace("grass: {", f"grass: {{ {dry},"), "utf-8")
    prairie.reload()
    assert list(prairie.scene.grass) == ["dry", "green"]
    sown, else_where = prairie.grass_at([(0.0, 0.0), (0.0, 5.0)]).density
    assert sown.tolist() == pytest.approx([0.0, 0.8])
    assert else_where.tolist() == pytest.approx([0.5, 0.5], abs=0.01)


def test_a_patch_that_a_game_has_deleted_is_not_missed_when_the_scene_gets_another_kind(prairie: Prairie) -> None:
    watch(prairie)
    patch, stays = prairie.patch_at([(0, 0), (5, 5)]).tolist()
    esper.delete_entity(patch, immediate=True)
    assert prairie.path is not None
    text = prairie.path.read_text("utf-8")
    prairie.path.write_text(text.replace("grass: { green", "grass: { brown: {}, green"), "utf-8")
    prairie.reload()
    assert not esper.entity_exists(patch)
    assert esper.component_for_entity(stays, Receivers).representation == "carpet"
