"""Winds on the graphics card: plugins' twins, winds without one, and twins that fail (D5)."""

import logging
import re
from collections.abc import Iterator
from typing import Any, ClassVar

import moderngl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Extent, Grass, Mixing, TwinValues, WindPrimitive, WindSource
from tallgrass.systems.wind.blast import Blast
from tallgrass.systems.wind.blow import Blowing, ReceiverArrays, blowing, hear, lone_receivers
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.quarantine import Quarantine
from tallgrass.systems.wind.sheets import MessageTexture, Sheets
from tallgrass.systems.wind.twin import NO_TWIN, Layout, Twin, TwinError, check_values, fit_runs, joined_twins, twin_of
from tallgrass.systems.wind.whirlwind import Whirlwind
from tallgrass.testing.trial import grass_at
from tallgrass.testing.twins import CLOSE_TWIN, CardEar

TIME = 3.0
PLACE = np.random.default_rng(5).uniform(-12.0, 12.0, (1500, 2)).astype(np.float32)


class Draught(WindPrimitive):
    """A wind without a twin that blows to the right in a square."""

    kind: str = "draught"
    priority: int = 15
    side: float = 5.0

    def extent(self, *, time: float) -> Extent:
        return Extent(-self.side, self.side, -self.side, self.side)

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.asarray(np.clip(self.side - np.abs(place).max(axis=1), 0.0, 1.0), np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        return np.full_like(place, [0.6, 0.1])


class Failing(Draught):
    """A wind without a twin whose action raises."""

    kind: str = "failing"

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        raise ZeroDivisionError


class Calmer(Whirlwind):
    """A whirlwind with an action of its own, and so without a twin."""

    kind: str = "calmer"  # type: ignore[assignment]

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        return 0.1 * super().action(place, time=time, seed=seed, grass=grass)


class Same(Whirlwind):
    """A whirlwind of another class, with the same twin."""

    kind: str = "same"  # type: ignore[assignment]


class Missing(Draught):
    """A wind whose twin's file is missing."""

    twin: ClassVar[str | None] = "nowhere.glsl"
    kind: str = "missing"


@pytest.fixture
def ear(ctx: moderngl.Context) -> Iterator[CardEar]:
    made = CardEar(ctx, grass_at(PLACE[:2]))
    yield made
    made.release()


def now_of(*winds: WindPrimitive, time: float = TIME) -> list[Blowing]:
    return blowing([WindSource(wind, wind.kind) for wind in winds], Quarantine(), time=time, seed=7)


def receivers() -> ReceiverArrays:
    return lone_receivers(PLACE, grass_at(PLACE))


def agrees(ear: CardEar, now: list[Blowing], mixing: Mixing = "weight", quarantine: Quarantine | None = None) -> None:
    """Assert that the card's messages equal numpy's."""
    found = ear.hear(now, receivers(), quarantine or Quarantine(), time=TIME, seed=7, mixing=mixing)
    due = hear(now, receivers(), quarantine or Quarantine(), time=TIME, seed=7, mixing=mixing)
    assert np.abs(found - due).max() <= CLOSE_TWIN


def written(monkeypatch: pytest.MonkeyPatch, kind: type[WindPrimitive], text: str) -> Twin:
    """Give a class of winds a twin whose text exists in memory only, and return the twin."""
    twin = Twin.of(f"{kind.__name__}.glsl", text.splitlines())
    monkeypatch.setattr("tallgrass.systems.wind.card.twin_of", lambda other: twin if other is kind else twin_of(other))
    return twin


DRAUGHT = """
float mask(vec2 place, Air air) {
    vec2 away = abs(place);
    return clamp(air.side - max(away.x, away.y), 0.0, 1.0);
}
vec2 action(vec2 place, Air air) { return vec2(0.6, 0.1); }
"""


@pytest.mark.parametrize("mixing", ["priority", "weight"])
def test_d5_a_wind_without_a_twin_is_heard_at_its_place_among_the_others(ear: CardEar, mixing: Mixing) -> None:
    winds = [Breeze(), Gust(position=[-20.0, 0.0]), Draught(), Draught(side=9.0, priority=12), Blast()]
    agrees(ear, now_of(*winds), mixing)
    agrees(ear, now_of(Breeze(), Draught(side=2.0)), mixing)
    agrees(ear, now_of(Breeze()), mixing)
    assert not ear.card.reasons


def test_where_all_winds_have_twins_no_receivers_are_asked_for(ear: CardEar) -> None:
    def never() -> ReceiverArrays:
        raise AssertionError

    assert ear.card.write(now_of(Breeze(), Blast()), time=TIME, seed=7, mixing="weight") == []
    ear.card.tell(never, Quarantine())
    (told,) = ear.card.write(now_of(Breeze(), Draught()), time=TIME, seed=7, mixing="weight")
    assert told.primitive.kind == "draught"
    with pytest.raises(AssertionError):
        ear.card.tell(never, Quarantine())


def test_receivers_may_have_numbers_of_their_own(ear: CardEar) -> None:
    now, some = now_of(Draught()), np.arange(0, 1500, 3)
    due = hear(now, receivers(), Quarantine(), time=TIME, seed=7)
    chosen = lone_receivers(PLACE[some], grass_at(PLACE).at(some))
    hearing = ear.card.tell
    ear.card.tell = lambda _, quarantine: hearing(lambda: chosen, quarantine, numbers=lambda: some)  # type: ignore[assignment,method-assign,misc]
    found = ear.hear(now, receivers(), Quarantine(), time=TIME, seed=7, mixing="priority")
    np.testing.assert_allclose(found[some], due[some], rtol=0.0, atol=CLOSE_TWIN)
    assert not np.delete(found, some, axis=0).any()


def test_a_wind_that_fails_says_nothing_in_that_very_frame(ear: CardEar) -> None:
    quarantine, now = Quarantine(), now_of(Breeze(), Failing(), Draught(side=2.0))
    found = ear.hear(now, receivers(), quarantine, time=TIME, seed=7, mixing="weight")
    assert [source.name for source in quarantine.reasons] == ["failing"]
    due = hear(
        [now[0], now[2]] if now[1].source in quarantine.reasons else now[1:],
        receivers(),
        quarantine,
        time=TIME,
        seed=7,
        mixing="weight",
    )
    assert np.abs(found - due).max() <= CLOSE_TWIN


def test_d5_a_strangers_twin_is_heard_in_place_of_numpy(ear: CardEar, monkeypatch: pytest.MonkeyPatch) -> None:
    written(monkeypatch, Draught, DRAUGHT)
    now = now_of(Breeze(), Draught(), Blast())
    assert ear.card.write(now, time=TIME, seed=7, mixing="weight") == []
    agrees(ear, now)


NAMED = """
float mask(vec2 place, Air draught) {
    vec2 away = abs(place);
    return clamp(draught.side - max(away.x, away.y), 0.0, 1.0);
}
vec2 sent(Air air) { return air.to * air.share; }  // air.nothing is no name
vec2 action(vec2 place, Air draught) { return sent(draught); }
"""


def test_d5_a_twin_reads_its_record_by_the_names_of_fields_and_of_twin_values(
    ear: CardEar, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Draught, "twin_values", lambda *_, **__: TwinValues({"share": 2.0, "to": (0.3, 0.05)}))
    twin = written(monkeypatch, Draught, NAMED)
    assert (twin.record, twin.reads) == ("Air", ("side", "to", "share"))
    now = now_of(Breeze(), Draught(), Draught(side=9.0, priority=12), Blast())
    assert ear.card.write(now, time=TIME, seed=7, mixing="weight") == []
    agrees(ear, now)


@pytest.mark.parametrize(
    ("text", "values", "why"),
    [
        (
            NAMED.replace("draught.side", "draught.sidee"),
            {},
            "it reads 'sidee', which is no .*, did you mean 'side'",
        ),
        (NAMED, {"to": (0.3, 0.05)}, r"it reads 'share', which is no field .*, as in TwinValues\(\{'share': 0.5\}\)"),
        (NAMED, (2.0,), "numbers without names"),
        (NAMED.replace("air.share", "air.stop"), {"to": (1.0, 0.0)}, "it reads 'stop', which is None and not"),
        (NAMED, {"share": "much", "to": (1.0, 0.0)}, "it reads 'share', which is 'much' and not one to four numbers"),
        (NAMED, {"share": float("inf"), "to": (1.0, 0.0)}, "numbers that are not finite"),
    ],
)
def test_d5_a_name_that_a_record_has_not_is_told_of_and_numpy_is_heard(
    ear: CardEar,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    text: str,
    values: Any,
    why: str,
) -> None:
    monkeypatch.setattr(Draught, "twin_values", lambda *_, **__: TwinValues(values))
    written(monkeypatch, Draught, text)
    agrees(ear, now_of(Breeze(), Draught(), Blast()))
    (said,) = caplog.messages
    assert re.search(why, said)


def test_d5_a_record_whose_names_have_other_sizes_later_is_told_of_and_numpy_is_heard(
    ear: CardEar, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    written(monkeypatch, Draught, NAMED)
    for to in ((0.3, 0.05), (0.3, 0.05, 0.0)):
        values = TwinValues({"share": 2.0, "to": to})
        monkeypatch.setattr(Draught, "twin_values", lambda *_, values=values, **__: values)
        agrees(ear, now_of(Breeze(), Draught()))
    assert "'to' has 3 numbers where it had 2 before" in caplog.text


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (DRAUGHT.replace("0.6", "oops"), "oops"),
        (DRAUGHT.replace("vec2 action", "vec2 deed"), "has no line that begins with 'vec2 action(vec2 place, '"),
        (DRAUGHT.replace("float mask", "float hat"), "has no line that begins with 'float mask(vec2 place, '"),
        ('#include "lib/tone.glsl"\n' + DRAUGHT, ":1 includes a file, which a twin cannot"),
        (DRAUGHT.replace("Air", "Wind"), "calls its record Wind, which is the engine's"),
        (DRAUGHT.replace("0.6", f"{' + '.join(f'air.v{k}.x' for k in range(32))}"), "65 numbers where 64 is the most"),
        (DRAUGHT + "vec4 more(Air air) { return sheet(air.wind, 1, ivec2(0)); }", "0 sheets where 2 are read"),
    ],
)
def test_d5_a_twin_that_fails_is_named_once_and_numpy_is_heard(
    ear: CardEar,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    text: str,
    why: str,
) -> None:
    named = {f"v{number}": (0.0, 0.0) for number in range(32)}
    monkeypatch.setattr(Draught, "twin_values", lambda *_, **__: TwinValues(named))
    written(monkeypatch, Draught, text)
    with caplog.at_level(logging.WARNING, "tallgrass"):
        for _ in range(3):
            agrees(ear, now_of(Breeze(), Draught(), Blast()))
    (said,) = caplog.messages
    assert said.startswith("the twin of ")
    assert ".Draught cannot be used: " in said
    assert why in said


def test_d5_twin_values_that_raise_are_no_more_than_a_twin_that_fails(
    ear: CardEar, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(Draught, "twin_values", lambda *_, **__: 1 / 0)
    written(monkeypatch, Draught, DRAUGHT)
    agrees(ear, now_of(Draught(), Breeze()))
    assert "ZeroDivisionError" in caplog.text


@pytest.mark.parametrize("values", [None, {"share": 2.0}, (5.0,)])
def test_d5_twin_values_of_another_type_are_told_of(
    ear: CardEar, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, values: object
) -> None:
    monkeypatch.setattr(Draught, "twin_values", lambda *_, **__: values)
    written(monkeypatch, Draught, DRAUGHT)
    agrees(ear, now_of(Draught(), Breeze()))
    assert f"cannot be used: twin_values returned {type(values).__name__}, not TwinValues" in caplog.text


def test_a_twin_that_is_not_there_is_named(ear: CardEar, caplog: pytest.LogCaptureFixture) -> None:
    agrees(ear, now_of(Missing(), Breeze()))
    assert "there is no file 'nowhere.glsl' beside its module" in caplog.text


def test_a_class_that_acts_otherwise_has_no_part_in_its_bases_twin() -> None:
    assert twin_of(Calmer) is None
    assert twin_of(Same) == twin_of(Whirlwind)
    assert twin_of(Draught) is None


def test_twins_that_define_the_same_names_do_not_clash(ear: CardEar, monkeypatch: pytest.MonkeyPatch) -> None:
    clashing = "const float EYE = 9.0, PULSE = 5.0;\n#define lag_of(x) x\nfloat lag(float x) { return lag_of(x); }\n"
    written(monkeypatch, Draught, clashing + DRAUGHT)
    agrees(ear, now_of(Draught(), Gust(position=[-20.0, 0.0]), Blast(), Whirlwind(), Breeze()))
    assert not ear.card.reasons


def test_d5_a_twin_may_call_its_own_what_the_program_calls_something_else(
    ear: CardEar, monkeypatch: pytest.MonkeyPatch
) -> None:
    named = "const float RINGS = 2.0, KINDS = 1.0;\n#define GROUP(x) x\nfloat OF(float x) { return GROUP(x); }\n"
    written(monkeypatch, Draught, named + DRAUGHT)
    agrees(ear, now_of(Draught()))
    assert not ear.card.reasons
    defines = {"KINDS": 2, "RINGS": 8}
    made = ear.card.program("engine/gl/fill.vert", "systems/show/strips/receivers.frag", defines=defines)
    assert "stacks" in made


def test_a_program_stays_until_a_kind_comes_that_it_has_no_room_for(ear: CardEar) -> None:
    def after(*winds: WindPrimitive) -> moderngl.Program:
        ear.card.write(now_of(*winds), time=TIME, seed=7, mixing="weight")
        return ear.card.program("systems/wind/hear.vert", None, varyings=("message",))

    ear.card.meet([Breeze(), Blast(), Gust()])
    first = after(Breeze())
    assert after(Breeze(), Blast(), Blast(position=[3.0, 1.0])) is first
    assert after(Gust()) is first
    second = after(Breeze(), Whirlwind())
    assert second is not first
    assert after(Gust(), Breeze()) is second


@given(st.lists(st.integers(-1, 4), max_size=12), st.lists(st.integers(-1, 4), max_size=12))
def test_every_wind_falls_into_a_run_of_its_own_twin(before: list[int], numbers: list[int]) -> None:
    order, ends = fit_runs(fit_runs((), before)[0], numbers)
    assert fit_runs(order, before)[0] == order, "what there was room for has room"
    starts = [1, *ends][:-1]
    runs = [order[k] for k, (start, end) in enumerate(zip(starts, ends, strict=True)) for _ in range(start, end)]
    assert runs == numbers


def test_more_winds_than_a_row_has_room_for_are_heard(ear: CardEar) -> None:
    winds = [(Whirlwind, Breeze)[k % 2](priority=k, weight=0.3) for k in range(80)]
    agrees(ear, now_of(*winds))


def test_a_table_is_sent_once_for_as_long_as_it_is_the_same_array(ctx: moderngl.Context) -> None:
    sheets = Sheets(ctx, side=4, layers=2)
    tables = [np.full((3, 2, 1 + number % 4), number, np.float32) for number in range(5)]
    for _ in range(3):
        sheets.begin()
        assert len(set(sheets.layers(tables[:2]))) == 2
    assert sheets.sent == 2
    sheets.begin()
    layers = sheets.layers([*tables, np.ones((6, 9, 4), np.float32)])
    assert len(set(layers)) == 6
    read = np.frombuffer(sheets.texture.read(), np.float32).reshape(-1, sheets.texture.height, sheets.texture.width, 4)
    for table, layer in zip(tables, layers, strict=False):
        np.testing.assert_array_equal(read[layer, :3, :2, : table.shape[2]], table)
    sheets.release()


def test_only_rows_of_told_messages_that_differ_are_sent(ctx: moderngl.Context) -> None:
    told = MessageTexture(ctx)
    told.reserve(2, 5000)
    number, message = np.array([10, 3000]), np.array([[0.1, 0.2], [0.3, 0.4]], np.float32)
    assert told.write(1, number, message, np.ones(2, np.float32)) == 3
    assert told.write(1, number, message, np.ones(2, np.float32)) == 0
    assert told.write(1, number[:1], message[:1], np.ones(1, np.float32)) == 1
    read = np.frombuffer(told.texture.read(), np.float32).reshape(-1, 4)
    assert np.flatnonzero(read.any(axis=1)).tolist() == [told.block * 1024 + 10]
    told.release()


def test_the_lines_of_twins_lead_back_to_their_files() -> None:
    twin = Twin.of("mine.glsl", DRAUGHT.splitlines())
    (lines,) = joined_twins([twin], [0, NO_TWIN], [Layout("Air", (("side", 1),))]).values()
    assert ("mine.glsl", 2, "float mask_0(vec2 place, Air_0 air) {") in lines


@pytest.mark.parametrize(
    "sheet", [np.zeros((4, 4)), np.zeros((4, 4, 1), np.float64), np.zeros((1, 3000, 2)), np.zeros((2, 2, 5))]
)
def test_a_sheet_of_another_form_is_refused(sheet: NDArray[np.generic]) -> None:
    of = np.asarray(sheet, np.float64 if sheet.shape == (4, 4, 1) else np.float32)
    with pytest.raises(TwinError, match="sheet of"):
        check_values(Twin.of("mine.glsl", []), [], [of])  # type: ignore[list-item]
