"""Comparing pictures with recorded ones: it finds a missing thing, and tolerates a blade that is a pixel aside."""

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from tallgrass.testing import same_picture

Levels = NDArray[np.float64]


@pytest.fixture
def grass() -> Levels:
    """Return a picture of noise like grass, 100 by 60 pixels."""
    return np.random.default_rng(1).integers(60, 200, (60, 100, 3)).astype(np.float64)


@pytest.fixture
def recorded(grass: Levels, tmp_path: Path) -> Path:
    path = tmp_path / "golden" / "grass.png"
    same_picture(grass, path, tolerance=0.0, record=True)
    return path


def test_the_same_picture_is_the_same(grass: Levels, recorded: Path) -> None:
    same_picture(grass, recorded, tolerance=0.0)
    same_picture(grass.astype(np.uint8), str(recorded), tolerance=0.0)
    assert [file.name for file in recorded.parent.iterdir()] == ["grass.png"]


def test_a_thing_that_is_missing_is_named_by_its_place_and_kept_beside_the_recorded_picture(
    grass: Levels, recorded: Path
) -> None:
    grass[32:40, 88:96] = 250.0
    with pytest.raises(AssertionError, match=r"at column 88, row 32, over 8, .* in grass\.png; .*grass\.differs\.png$"):
        same_picture(grass, recorded, tolerance=8.0)
    with Image.open(recorded.with_name("grass.differs.png")) as image:
        np.testing.assert_array_equal(np.asarray(image), grass)
    same_picture(np.asarray(Image.open(recorded)), recorded, tolerance=8.0)
    assert not recorded.with_name("grass.differs.png").exists()


def test_single_pixels_elsewhere_are_borne_by_a_tolerance_and_not_without(grass: Levels, recorded: Path) -> None:
    grass[10, 20] += 40.0
    same_picture(grass, recorded, tolerance=1.0)
    with pytest.raises(AssertionError, match="differs by 40 of 255 at column 20, row 10, over 0"):
        same_picture(grass, recorded, tolerance=0.0)


def test_the_narrow_squares_at_the_edges_count_for_themselves(grass: Levels, recorded: Path) -> None:
    grass[56:, 96:] += 30.0
    with pytest.raises(AssertionError, match="differs by 30 of 255 at column 96, row 56"):
        same_picture(grass, recorded, tolerance=20.0)


def test_nothing_is_recorded_unless_it_is_said(grass: Levels, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "new.png"
    with pytest.raises(AssertionError, match=r"no picture is recorded in .*new\.png.*\(TALLGRASS_RECORD=1\)"):
        same_picture(grass, path, tolerance=1.0)
    assert not path.exists()
    monkeypatch.setenv("TALLGRASS_RECORD", "1")
    same_picture(grass, path, tolerance=1.0)
    monkeypatch.delenv("TALLGRASS_RECORD")
    same_picture(grass, path, tolerance=0.0)


def test_another_size_is_told(grass: Levels, recorded: Path) -> None:
    with pytest.raises(AssertionError, match="the picture is 99 by 60 pixels, not 100 by 60 as in"):
        same_picture(grass[:, :99], recorded, tolerance=1.0)


@pytest.mark.parametrize(
    "wrong", [np.zeros((4, 4)), np.full((2, 2, 3), 256.0), np.full((2, 2, 3), np.nan), np.zeros((2, 2, 4))]
)
def test_what_is_no_picture_is_refused(wrong: NDArray[np.float64], recorded: Path) -> None:
    with pytest.raises(ValueError, match="a picture"):
        same_picture(wrong, recorded, tolerance=1.0)
