"""Texts over the picture in the window."""

from tallgrass.app.overlay import HELP, statistics_lines
from tallgrass.systems.statistics import Statistics


def test_the_statistics_tell_what_the_frame_held() -> None:
    statistics = Statistics(
        systems_ms={"tile": 0.25, "wind": 1.5},
        draw_ms=2.0,
        blades_field=100000,
        blades_considered=9000,
        blades_submitted=4000,
        receivers=4321,
        draw_calls=7,
        patches={"blades": 12, "strips": 34, "carpet": 56},
    )
    text = "\n".join(statistics_lines(statistics, frame_ms=20.0, time=1.25))
    for part in (
        "20.0 ms, 50 per second", "time 1.2 s", "4000 drawn of 9000 in view, 100000 in the field", "4321",
        "12 blades, 34 strips, 56 carpet", "1.75 ms: tile 0.25, wind 1.50", "2.00 ms, 7 draw calls",
    ):  # fmt: skip
        assert part in text


def test_the_first_frame_has_statistics_too() -> None:
    assert "0 per second" in statistics_lines(Statistics(), frame_ms=0.0, time=0.0)[0]


def test_the_help_names_every_key_once() -> None:
    names = [line[:18].strip() for line in HELP]
    assert len(set(names)) == len(names)
    assert {"F", "G", "Space", "F1", "F3", "F5", "F12", "Escape"} <= set(names)
