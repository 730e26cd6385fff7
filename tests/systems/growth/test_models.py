"""Growths: postures, response and patch models of a kind."""

import os
import subprocess
import sys
from dataclasses import fields, is_dataclass
from hashlib import blake2b
from threading import Event
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.declared.grass import GrassKind
from tallgrass.engine.declared.quality import PRESETS, BladeRing, Quality, StripRing
from tallgrass.systems.grow.bend import spine
from tallgrass.systems.grow.record import Growth, Response
from tallgrass.systems.grow.section import SECTIONS
from tallgrass.systems.grow.simulate import LINKS, build_chain
from tallgrass.systems.show.carpet.grow import carpet_of, grow_carpet
from tallgrass.systems.show.representation import Seedling
from tallgrass.systems.show.strips.grow import strips_of, targets_on
from tallgrass.systems.show.strips.representation import StripRepresentation
from tallgrass.systems.stock import models
from tallgrass.systems.stock.models import grow, precompute_bytes

SMALL = Quality(
    patch=1.5,
    blades=40,
    models=2,
    blade_rings=[BladeRing(to=1, segments=4)],
    strip_rings=[StripRing(to=3, strips=3, texel=0.02), StripRing(to=6, strips=1, texel=0.05)],
    carpet_to=9,
    carpet=24,
)
KIND = GrassKind(width=0.02)
ONE_OF_HIGH = PRESETS["high"].model_copy(update={"models": 1})
EVEN = np.ones((1, LINKS))


def arrays(record: Any) -> list[NDArray[Any]]:
    if isinstance(record, np.ndarray):
        return [record]
    if isinstance(record, dict):
        return [array for part in record.values() for array in arrays(part)]
    if isinstance(record, tuple):
        return [array for part in record for array in arrays(part)]
    if is_dataclass(record):
        return [array for field in fields(record) for array in arrays(getattr(record, field.name))]
    return [np.asarray(record)]


def digest(growth: Growth) -> str:
    return blake2b(b"".join(array.tobytes() for array in arrays(growth))).hexdigest()


@pytest.fixture(scope="module")
def growth() -> Growth:
    return grow(KIND, SMALL, seed=11)


@pytest.fixture(scope="module")
def high() -> Growth:
    return grow(GrassKind(), PRESETS["high"], seed=1)


def test_g5_a_growth_is_as_fine_as_its_quality_says(growth: Growth) -> None:
    assert len(growth.models) == 2
    for model in growth.models:
        assert model.blades.root.shape == (40, 2)
        assert [strips.plane.size for strips in strips_of(model)] == [3, 1]
        assert carpet_of(model).texels.shape[2:4] == (24, 24)


def test_a_kinds_own_number_of_blades_goes_before_the_qualitys() -> None:
    growth = grow(KIND.model_copy(update={"blades": 7}), SMALL, seed=1)
    assert growth.models[0].blades.root.shape == (7, 2)


def test_g1_every_blade_is_in_all_three_representations(growth: Growth) -> None:
    for model in growth.models:
        tips = spine(model.blades, growth.postures, (0.0, 0.0), points=17)
        for strips in strips_of(model):
            assert strips.slice.shape == (2, 40)
            targets = targets_on(strips, model.blades, growth.postures)
            assert targets.shape == (2, 40, 17, 2)
            np.testing.assert_allclose(targets[:, :, :, 1] * strips.height, [tips[:, :, 1]] * 2, atol=1e-5)
        carpet = carpet_of(model)
        assert carpet.height >= tips[:, :, 1].max()
        own = grow_carpet(
            model.blades, growth.postures, patch=SMALL.patch, texels=SMALL.carpet, taper=KIND.taper,
            height=carpet.height, section=SECTIONS[KIND.profile],
        )  # fmt: skip
        np.testing.assert_array_equal(carpet.texels, own.texels)


def test_g1_nothing_leans_out_of_the_textures(growth: Growth) -> None:
    for model in growth.models:
        for strips in strips_of(model):
            targets = targets_on(strips, model.blades, growth.postures)
            assert (targets >= 0.0).all()
            assert (targets <= 1.0).all()


def test_textures_of_all_models_have_one_size(growth: Growth) -> None:
    first, second = growth.models
    for one, two in zip(strips_of(first), strips_of(second), strict=True):
        assert one.texels.shape == two.texels.shape
        assert (one.height, one.margin) == (two.height, two.margin)
    assert carpet_of(first).height == carpet_of(second).height


def test_models_differ(growth: Growth) -> None:
    first, second = growth.models
    assert np.abs(first.blades.root - second.blades.root).max() > 0.1


def test_growing_is_the_same_in_every_process(growth: Growth) -> None:
    code = (
        "import importlib.util, sys\n"
        f"spec = importlib.util.spec_from_file_location('growing', {__file__!r})\n"
        "growing = importlib.util.module_from_spec(spec)\n"
        "spec.loader.exec_module(growing)\n"
        "print(growing.digest(growing.grow(growing.KIND, growing.SMALL, seed=11)))\n"
    )
    environment = os.environ | {"PYTHONHASHSEED": "12345", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    assert run.stdout.strip() == digest(growth)


@pytest.mark.parametrize("threads", [1, 5])
def test_growing_is_the_same_on_any_number_of_threads(
    growth: Growth, threads: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(models, "_THREADS", threads)
    assert digest(grow(KIND, SMALL, seed=11)) == digest(growth)


def test_who_is_interrupted_while_grass_grows_waits_for_none_that_has_not_begun(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    begun, told = [], Event()

    class Slow(StripRepresentation):
        @staticmethod
        def grow(seedling: Seedling, /) -> Any:
            begun.append(seedling)
            if len(begun) == 1:
                raise KeyboardInterrupt
            return told.wait(0.1)

    monkeypatch.setattr(models, "REPRESENTATIONS", (Slow,))
    monkeypatch.setattr(models, "_THREADS", 1)
    with pytest.raises(KeyboardInterrupt):
        grow(KIND, SMALL.model_copy(update={"models": 6}), seed=11)
    assert len(begun) <= 3


def test_grass_is_simulated_again_only_where_what_bends_it_changed(
    growth: Growth, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulated: list[GrassKind] = []

    def response(kind: GrassKind) -> Response:
        simulated.append(kind)
        return growth.response

    monkeypatch.setattr("tallgrass.systems.stock.models.grow_response", response)
    monkeypatch.setattr("tallgrass.systems.stock.models.grow_give", lambda _: growth.postures.give)
    models._give_and_response.cache_clear()  # noqa: SLF001
    few = SMALL.model_copy(update={"blades": 9, "models": 1})
    grow(KIND, SMALL, seed=11)
    for same in ({"lean": 0.9}, {"tip": "#ffffff"}, {"clumping": 0.1}):
        grow(KIND.model_copy(update=same), few, seed=11)
    assert len(simulated) == 1
    for other in ({"stiffness": 2.0}, {"damping": 0.5}, {"width": 0.03}, {"taper": 0.9}, {"height": [0.2, 0.3]}):
        kind = KIND.model_copy(update=other)
        grow(kind, few, seed=11)
        assert build_chain(simulated[-1], EVEN).stiffness == pytest.approx(build_chain(kind, EVEN).stiffness, rel=1e-12)
        assert simulated[-1].damping == kind.damping
    assert len(simulated) == 6
    models._give_and_response.cache_clear()  # noqa: SLF001


def test_another_seed_is_another_field(growth: Growth) -> None:
    assert digest(grow(KIND, SMALL, seed=12)) != digest(growth)


def test_r3_the_high_preset_takes_less_than_28_megabytes_a_kind(high: Growth) -> None:
    texture = strips_of(high.models[0])[0]
    assert precompute_bytes(high) > 3 * texture.texels.nbytes
    assert precompute_bytes(high) < 28e6


def test_tall_kinds_have_coarser_texels_so_that_they_take_no_more() -> None:
    kind = GrassKind(height=[1.5, 2.5], width=0.03, blades=60)
    assert PRESETS["high"].models * precompute_bytes(grow(kind, ONE_OF_HIGH, seed=1)) < 25e6


def test_g1_blades_and_strips_cover_the_same_in_every_ring(high: Growth) -> None:
    model = high.models[0]
    area = [strips.texels[..., 3].mean() / 255.0 * strips.plane.size for strips in strips_of(model)]
    assert area[0] > area[1] > area[2] > 0.8 * area[0]


def test_arrays_are_what_the_graphics_card_takes(growth: Growth) -> None:
    for array in arrays(growth):
        assert array.ndim == 0 or array.flags.c_contiguous
        assert array.dtype in (np.float32, np.int32, np.uint8) or array.ndim == 0
