"""The legend."""

import numpy as np
import pytest

from tallgrass.components.wind import WindPrimitive, WindSource
from tallgrass.systems.overlay.layers import LAYERS, Layer
from tallgrass.systems.overlay.legend import entries, legend
from tallgrass.systems.overlay.masks import Masked, masked
from tallgrass.systems.overlay.paint import wind_color
from tallgrass.systems.show.representation import Representation
from tallgrass.systems.wind.blow import blowing
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.quarantine import Quarantine
from tallgrass.systems.wind.whirlwind import Whirlwind
from tallgrass.testing import little_site


def levels() -> tuple[Representation, ...]:
    return little_site().representations


def masks(*winds: WindPrimitive) -> list[Masked]:
    quarantine = Quarantine()
    acting = blowing([WindSource(wind, "w") for wind in winds], quarantine, time=1.0, seed=1)
    return masked(acting, quarantine, time=1.0, around=(0.0, 0.0), far=60.0)


def told(*parts: Layer) -> str:
    found = entries(frozenset(parts), masks(Breeze(), Whirlwind(), Whirlwind(radius=3.0)), levels())
    return "\n".join(entry.text for entry in found)


def test_n8_the_legend_tells_of_what_is_shown_and_of_nothing_else() -> None:
    assert told("masks").splitlines() == [
        "breeze: everywhere",
        "where the whirlwind acts",
        "thin line: with full weight",
    ]
    assert told("arrows") == "posture index, 0 to 1"
    assert "3D blades" in told("levels")
    assert "whirlwind" not in told("levels", "arrows", "weights")
    assert "whirlwind" in told("map")
    assert told() == ""


def test_n8_its_colours_are_those_of_the_marks() -> None:
    image = legend(tuple(entries(frozenset(LAYERS), masks(Whirlwind()), levels())), 13)
    assert image.dtype == np.uint8
    assert image.shape[2] == 4
    for color in (wind_color(Whirlwind()), *(each.color for each in levels())):
        same = (np.abs(image[..., :3].astype(int) - np.round(np.array(color) * 255)) <= 1).all(axis=-1)
        assert same.sum() > 30, color


@pytest.mark.parametrize("size", [8, 13, 26])
def test_n8_it_grows_with_its_letters(size: int) -> None:
    image = legend(tuple(entries(frozenset({"levels"}), [], levels())), size)
    assert image.shape[0] == pytest.approx(3 * 1.5 * size + 0.7 * size, abs=4)
    bright = image[:, image.shape[1] // 2 :, :3].min(axis=-1) > 140
    assert bright.any(axis=1).sum() > size, "there are letters"
