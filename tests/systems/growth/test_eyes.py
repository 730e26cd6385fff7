"""Eyes of heads: a middle with a colour of its own."""

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.arrays import Doubles
from tallgrass.engine.declared.grass import GrassKind
from tallgrass.engine.declared.plant import Head
from tallgrass.engine.declared.quality import PRESETS
from tallgrass.systems.grow import organs
from tallgrass.systems.grow.bend import ribbon
from tallgrass.systems.grow.dye import eyed
from tallgrass.systems.grow.layout import layout_of
from tallgrass.systems.grow.plants import grow_patch
from tallgrass.systems.grow.postures import grow_postures
from tallgrass.systems.grow.raster import ribbon_triangles
from tallgrass.systems.grow.record import Blades
from tallgrass.systems.show.carpet.grow import grow_carpet
from tallgrass.systems.show.strips.grow import grow_strips

HIGH = PRESETS["high"]
SIZE = 0.08
DAISY = GrassKind(
    plant="flower", plants=12, leaves=0, lean=0.0, head=Head(petals=20, size=[SIZE, SIZE], open=1, eye="#f2b90f")
)
POPPY = DAISY.model_copy(update={"head": Head(petals=5, size=[SIZE, SIZE], open=0.8, eye="#1d1420")})
POSTURES = grow_postures(DAISY, variants=4, seed=2)
POINTS = 9


def grown(kind: GrassKind) -> Blades:
    return grow_patch(kind, layout_of(kind, HIGH), patch=HIGH.patch, variants=4, seed=3)


def corners(blades: Blades) -> Doubles:
    left, right = ribbon(blades, POSTURES, (0.0, 0.0), points=POINTS, taper=0.6)
    return ribbon_triangles(left.astype(np.float64), right.astype(np.float64))


def of(blades: Blades, organ: int) -> NDArray[np.bool_]:
    return np.repeat(blades.organ == organ, 2 * (POINTS - 1))


def test_a_daisys_disc_is_a_dome_a_third_as_wide_as_its_head() -> None:
    blades = grown(DAISY)
    triangles = corners(blades)
    wide = []
    for organ in (organs.DISC, organs.TWIN):
        own = triangles[of(blades, organ)].reshape(DAISY.plants or 0, -1, 3)
        wide.append(np.ptp(own[:, :, ::2], axis=1).mean())
    assert wide[0] / wide[1] == pytest.approx(0.36, abs=0.11)
    spine = triangles[of(blades, organs.DISC)].reshape(-1, POINTS - 1, 6, 3).mean(axis=2)
    assert (spine[:, :, 1].max(axis=1) > spine[:, -1, 1]).mean() > 0.7


@pytest.mark.parametrize("kind", [DAISY, POPPY], ids=["daisy", "poppy"])
def test_every_head_with_an_eye_has_what_tells_so(kind: GrassKind) -> None:
    blades = grown(kind)
    assert organs.has_eyes(blades)
    for rank in np.unique(blades.rank):
        assert np.isin(blades.organ[blades.rank == rank], (organs.DISC, organs.CAPSULE)).any()


def test_without_an_eye_no_organ_has_a_colour_of_its_own() -> None:
    for form in ("disc", "bell", "umbel"):
        blades = grown(DAISY.model_copy(update={"head": Head(form=form)}))
        assert not organs.has_eyes(blades)
        assert not eyed(blades, corners(blades), points=POINTS, toward=(0.0, 1.0, 0.0)).any()


def test_petals_are_blotched_at_their_feet_and_within_alone() -> None:
    blades = grown(POPPY)
    triangles = corners(blades)
    petal = of(blades, organs.BLOTCHED)
    above, below = (eyed(blades, triangles, points=POINTS, toward=(0.0, up, 0.0))[petal] for up in (1.0, -1.0))
    joint = np.tile(np.repeat(np.arange(POINTS - 1), 2), len(petal) // (2 * POINTS - 2))[petal]
    assert above[joint == 1].mean() > 0.8
    assert not above[joint > 0.5 * POINTS].any()
    assert not below.any()


@pytest.mark.parametrize("kind", [DAISY, POPPY], ids=["daisy", "poppy"])
def test_pictures_of_heads_from_above_have_as_much_of_an_eye_as_there_is(kind: GrassKind) -> None:
    blades = grown(kind)
    carpet = grow_carpet(blades, POSTURES, patch=HIGH.patch, texels=256, taper=kind.taper, slopes=(8.0,))
    image = carpet.texels[0].astype(np.float64).sum(axis=(0, 1, 2))
    strips = grow_strips(blades, POSTURES, patch=HIGH.patch, strips=4, texel=0.004, taper=kind.taper, margin=0.2)
    painted = strips.texels.astype(np.float64).sum(axis=(0, 1, 2, 3))
    assert 0.04 < image[2] / image[0] < 0.35
    assert 0.01 < painted[2] / painted[0] < 0.35
