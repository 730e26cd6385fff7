"""The timeline of a frame by system."""

import pytest

pytest.importorskip("imgui_bundle", reason="the panel is drawn by imgui-bundle, of the extra 'edit'")

from tallgrass.app.edit.panel import spans_of


def test_the_bars_of_a_frame_follow_one_another_and_fill_it() -> None:
    spans = spans_of([1.0, 0.0, 3.0], 4.0)
    assert spans == [(0.0, 0.125), (0.125, 0.125), (0.125, 0.5), (0.5, 1.0)]
