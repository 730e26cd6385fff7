"""Time of drawing, by the clock and by the graphics card (N11)."""

from types import SimpleNamespace

import moderngl
import pytest

from tallgrass.engine.gl import rasteriser, stopwatch
from tallgrass.engine.gl.functions import Functions
from tallgrass.engine.gl.rasteriser import early_flush, is_software
from tallgrass.engine.gl.stopwatch import MOST_UNDERWAY, Stopwatch


@pytest.mark.parametrize("waits", [True, False])
def test_each_drawing_is_told_of_once_under_its_name(ctx: moderngl.Context, waits: bool) -> None:  # noqa: FBT001
    watch = Stopwatch(ctx)
    watch.__dict__["waits"] = waits
    for number in range(2):
        with watch.timing(("main", number)):
            ctx.clear()
    ctx.finish()
    told = watch.read()
    assert [name for name, _ in told] == [("main", 0), ("main", 1)]
    assert all(0.0 <= seconds < 10.0 for _, seconds in told)
    assert watch.read() == []
    watch.release()


def test_a_card_that_is_far_behind_is_asked_no_more(ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch) -> None:
    watch = Stopwatch(ctx)
    watch.__dict__["waits"] = False
    monkeypatch.setattr(watch, "_is_over", lambda _: False)
    for number in range(MOST_UNDERWAY + 3):
        with watch.timing(("main", number)):
            ctx.clear()
        assert watch.read() == []
    monkeypatch.undo()
    ctx.finish()
    assert len(watch.read()) == MOST_UNDERWAY


@pytest.mark.parametrize("bits", [0, 30])
def test_a_card_whose_timers_have_no_bits_is_timed_by_the_clock(
    ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch, bits: int
) -> None:
    gl = Functions(ctx.mglo._context)  # noqa: SLF001
    gl.__dict__["glGetQueryiv"] = lambda _timer, _question, found: found.__setitem__(0, bits)
    monkeypatch.setattr(stopwatch, "draws_in_software", lambda _: False)
    monkeypatch.setattr(stopwatch, "functions_of", lambda _: gl)
    assert Stopwatch(ctx).waits is (bits == 0)


def test_a_drawing_that_fails_leaves_the_watch_in_order(ctx: moderngl.Context) -> None:
    watch = Stopwatch(ctx)
    watch.__dict__["waits"] = False

    def fail() -> None:
        with watch.timing(("main", 0)):
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    ctx.finish()
    assert len(watch.read()) == 1


@pytest.mark.parametrize(
    ("renderer", "software"),
    [
        ("llvmpipe (LLVM 15.0.6, 256 bits)", True),
        ("Google SwiftShader", True),
        ("GDI Generic", True),
        ("NVIDIA GeForce RTX 3070/PCIe/SSE2", False),
        ("Mesa Intel(R) UHD Graphics 620 (KBL GT2)", False),
    ],
)
def test_a_rasteriser_is_known_by_its_name(renderer: str, software: bool) -> None:  # noqa: FBT001
    assert is_software(renderer) is software


@pytest.mark.parametrize("software", [True, False])
def test_software_begins_before_a_frame_is_whole_and_a_card_is_left_alone(
    ctx: moderngl.Context,
    monkeypatch: pytest.MonkeyPatch,
    software: bool,  # noqa: FBT001
) -> None:
    begun: list[bool] = []
    monkeypatch.setattr(rasteriser, "draws_in_software", lambda _: software)
    monkeypatch.setattr(rasteriser, "functions_of", lambda _: SimpleNamespace(glFlush=lambda: begun.append(True)))
    early_flush(ctx)()
    assert begun == [True] * software


@pytest.mark.parametrize("software", [True, False])
def test_samplers_are_anisotropic_on_cards_alone(
    ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch, *, software: bool
) -> None:
    monkeypatch.setattr(rasteriser, "draws_in_software", lambda _: software)
    assert rasteriser.anisotropy(ctx) == (1.0 if software else min(rasteriser.MOST_SAMPLES, ctx.max_anisotropy))


def test_a_rasteriser_may_be_told_to_draw_as_a_card_does(
    ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(rasteriser.AS_CARD, "1")
    assert not rasteriser.draws_in_software(ctx)
    monkeypatch.setenv(rasteriser.AS_CARD, "0")
    assert rasteriser.draws_in_software(ctx) is is_software(str(ctx.info["GL_RENDERER"]))
