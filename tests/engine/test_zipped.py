"""Arrays in one file, alike by any numpy from 2.0 on (D6)."""

from io import BytesIO
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.zipped import zipped

ARRAYS: dict[str, NDArray[Any]] = {
    "head": np.arange(5, dtype=np.uint8),
    "allow_pickle": np.eye(3, dtype=np.float32)[:, ::2],
    "file": np.array(3.0),
    "none": np.zeros((0, 4), np.bool_),
}


def test_arrays_come_back_by_their_names_and_nothing_else_does() -> None:
    with np.load(BytesIO(zipped(ARRAYS)), allow_pickle=False) as file:
        assert file.files == [*ARRAYS]
        for name, array in ARRAYS.items():
            assert file[name].dtype == array.dtype
            np.testing.assert_array_equal(file[name], array)


def test_the_same_arrays_are_the_same_bytes() -> None:
    assert zipped(ARRAYS) == zipped({name: array.copy() for name, array in ARRAYS.items()})


def test_objects_are_never_pickled() -> None:
    with pytest.raises(ValueError, match="allow_pickle=False"):
        zipped({"object": np.array([{}])})
