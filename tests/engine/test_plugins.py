"""The registry of wind kinds, against distributions as pip leaves them on disk."""

import subprocess
import sys
from collections.abc import Iterator
from importlib.metadata import EntryPoint, distributions, entry_points
from pathlib import Path

import numpy as np
import pytest

from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Grass, WindPrimitive
from tallgrass.engine.installed import OURS, Provided
from tallgrass.engine.plugins import GROUP, PluginError, WindKinds, wind, wind_kinds
from tallgrass.engine.scene import parse_scene

VORTEX = """
from tallgrass.components.wind import WindPrimitive

class Vortex(WindPrimitive):
    radius: float = 3.0
    def mask(self, place, /, *, time): return place[:, 0] * 0 + 1
    def action(self, place, /, *, time, seed, grass): return place * 0
"""


class Calm(WindPrimitive):
    """A wind that hardly moves anything."""

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.full(len(place), time >= self.start, np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        return np.full_like(place, 0.01 * np.cos(time + seed))


@pytest.fixture(autouse=True)
def _kinds_of_this_test() -> Iterator[None]:
    wind_kinds.cache_clear()
    yield
    wind_kinds.cache_clear()


def install(folder: Path, name: str, kinds: dict[str, str], modules: dict[str, str]) -> list[EntryPoint]:
    """Install a distribution into a folder, as pip would leave it there, and return its entry points."""
    info = folder / name / f"{name.replace('-', '_')}-0.3.1.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 0.3.1\n")
    lines = [f"[{GROUP}]", *(f"{kind} = {value}" for kind, value in kinds.items())]
    (info / "entry_points.txt").write_text("\n".join(lines) + "\n")
    for module, text in modules.items():
        (info.parent / f"{module}.py").write_text(text)
    return [entry for found in distributions(path=[str(info.parent)]) for entry in found.entry_points]


@pytest.fixture
def dust(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> WindKinds:
    """Kinds of wind of a distribution: `vortex` is right, all others are wrong."""
    kinds = {
        "vortex": "dust_vortex:Vortex",
        "gone": "dust_gone:Gone",
        "faulty": "dust_faulty:Faulty",
        "text": "dust_vortex:__name__",
        "half": "tallgrass.components.wind:WindPrimitive",
        "later": "dust_later:Vortex",
        "worded": "dust_worded:Vortex",
        "leaving": "dust_leaving:Vortex",
    }
    later = f"{VORTEX}    interface = 2\n"
    worded = f"{VORTEX}    interface = 'two'\n"
    modules = {
        "dust_vortex": VORTEX,
        "dust_faulty": "1 / 0",
        "dust_later": later,
        "dust_worded": worded,
        "dust_leaving": "raise SystemExit(7)",
    }
    entries = install(tmp_path, "tallgrass-dust", kinds, modules)
    monkeypatch.syspath_prepend(str(tmp_path / "tallgrass-dust"))
    for module in modules:
        monkeypatch.delitem(sys.modules, module, raising=False)
    return WindKinds(entries)


def test_a_wind_that_does_not_say_its_kind_is_of_the_one_that_it_is_registered_as() -> None:
    @wind("hush")
    class Hush(Calm):
        """A wind without a `kind` of its own."""

    assert Hush().kind == "hush"  # type: ignore[call-arg]
    (made,) = parse_scene("tallgrass: 2\ngrass: { lawn: {} }\nwind: [{ kind: hush }]").wind
    assert type(made) is Hush
    with pytest.raises(ValueError, match=r"^Calm: the key 'kind' is missing$"):
        Calm()  # type: ignore[call-arg]


def test_d5_the_built_in_breeze_comes_through_its_entry_point() -> None:
    assert [entry.dist.name for entry in entry_points(group=GROUP) if entry.dist and entry.name == "breeze"] == [
        "tallgrass"
    ]
    assert wind_kinds().find("breeze").__module__ == "tallgrass.systems.wind.breeze"


def test_the_winds_that_come_along_are_known_from_all_others(dust: WindKinds) -> None:
    kinds = wind_kinds()
    found = [kinds.find(row.name) for row in kinds.provided() if row.distribution == OURS]
    assert len(found) >= 4
    assert all(kinds.is_ours(one) for one in found)
    own = type("Breeze", (kinds.find("breeze"),), {"__module__": __name__})
    assert not any(kinds.is_ours(one) for one in (own, Calm, WindPrimitive, dust.find("vortex")))
    assert not any(dust.is_ours(one) for one in (*found, dust.find("vortex")))


def test_the_registry_imports_no_system_until_a_kind_is_asked_for() -> None:
    code = (
        "import sys; from tallgrass.engine.plugins import wind_kinds; names = wind_kinds().names(); "
        "assert 'breeze' in names, names; assert 'tallgrass.systems' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_d5_an_installed_kind_is_imported_when_first_asked_for(dust: WindKinds) -> None:
    assert "vortex" in dust.names()
    assert "dust_vortex" not in sys.modules
    primitive = dust.find("vortex")
    assert primitive.model_validate({"kind": "vortex", "radius": 2.0}).kind == "vortex"
    assert dust.find("vortex") is primitive


def test_an_unknown_kind_names_the_one_it_resembles(dust: WindKinds) -> None:
    with pytest.raises(PluginError) as refusal:
        dust.find("vortx")
    known = "faulty, gone, half, later, leaving, text, vortex, worded"
    assert str(refusal.value) == f"unknown kind 'vortx', did you mean 'vortex'? known: {known}"
    with pytest.raises(PluginError, match="unknown kind 'zzz'; known: faulty, gone"):
        dust.find("zzz")


@pytest.mark.parametrize(
    ("kind", "why"),
    [
        ("gone", "cannot be loaded: ModuleNotFoundError: No module named 'dust_gone'"),
        ("faulty", "cannot be loaded: ZeroDivisionError: division by zero"),
        ("leaving", "cannot be loaded: SystemExit: 7"),
        ("text", "must be a class that derives from WindPrimitive"),
        ("half", "lacks action and mask"),
        ("worded", "has the interface 'two', which is no whole number"),
        ("later", "is written for interface 2 of winds; this tallgrass has 1"),
    ],
)
def test_a_broken_plugin_is_named_with_its_distribution(dust: WindKinds, kind: str, why: str) -> None:
    with pytest.raises(PluginError) as refusal:
        dust.find(kind)
    assert str(refusal.value) == f"kind '{kind}' of tallgrass-dust 0.3.1 {why}"


def test_whoever_stops_python_while_a_plugin_is_imported_stops_it(dust: WindKinds, tmp_path: Path) -> None:
    (tmp_path / "tallgrass-dust" / "dust_faulty.py").write_text("raise KeyboardInterrupt")
    with pytest.raises(KeyboardInterrupt):
        dust.find("faulty")


def test_a_broken_plugin_costs_no_other_kind(dust: WindKinds) -> None:
    with pytest.raises(PluginError):
        dust.find("faulty")
    assert dust.find("vortex").__name__ == "Vortex"


@pytest.mark.usefixtures("dust")
def test_two_distributions_with_one_kind_are_both_named(tmp_path: Path) -> None:
    twice = [
        *install(tmp_path, "tallgrass-storm", {"vortex": "dust_vortex:Vortex"}, {}),
        *install(tmp_path, "other-winds", {"vortex": "dust_vortex:Vortex", "calm": "dust_vortex:Vortex"}, {}),
    ]
    kinds = WindKinds(twice)
    with pytest.raises(PluginError, match=r"'vortex' is claimed by tallgrass-storm 0\.3\.1 and other-winds 0\.3\.1"):
        kinds.find("vortex")
    assert kinds.find("calm").__name__ == "Vortex"
    assert [(row.distribution, row.status) for row in kinds.provided() if row.name == "vortex"] == [
        ("other-winds", "claimed twice"),
        ("tallgrass-storm", "claimed twice"),
    ]


@pytest.mark.usefixtures("dust")
@pytest.mark.parametrize("chosen", ["tallgrass-storm", "Tallgrass_Storm"])
def test_a_kind_of_two_distributions_works_where_one_is_chosen(tmp_path: Path, chosen: str) -> None:
    twice = [
        *install(tmp_path, "tallgrass-storm", {"vortex": "dust_vortex:Vortex"}, {}),
        *install(tmp_path, "other-winds", {"vortex": "dust_vortex:Vortex"}, {}),
    ]
    kinds = WindKinds(twice, chosen=[chosen])
    assert kinds.find("vortex").__name__ == "Vortex"
    assert [(row.distribution, row.status) for row in kinds.provided()] == [
        ("other-winds", "left out"),
        ("tallgrass-storm", "ready"),
    ]


@pytest.mark.usefixtures("dust")
@pytest.mark.parametrize("chosen", [None, ["gust"], ["tallgrass-storm"]])
def test_a_built_in_kind_wins_whoever_else_claims_it_and_the_other_is_named_once(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, chosen: list[str] | None
) -> None:
    theirs = install(tmp_path, "tallgrass-storm", {"gust": "dust_vortex:Vortex", "vortex": "dust_vortex:Vortex"}, {})
    kinds = WindKinds([*theirs, *entry_points(group=GROUP)], chosen=chosen)
    assert not caplog.messages, "nobody has asked for a gust yet"
    for _ in range(2):
        assert kinds.find("gust").__module__ == "tallgrass.systems.wind.gust"
    (told,) = caplog.messages
    choice = "uninstall tallgrass-storm, or leave it out by TALLGRASS_PLUGINS, which names what to use"
    assert told == f"kind 'gust' is built in, and the one of tallgrass-storm 0.3.1 is not used; {choice}"
    rows = [(row.distribution, row.status) for row in kinds.provided() if row.name == "gust"]
    assert rows == [("tallgrass-storm", "name taken"), (OURS, "ready")]


@pytest.mark.usefixtures("dust")
def test_what_the_warning_on_a_built_in_kind_advises_helps(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    theirs = install(tmp_path, "tallgrass-storm", {"gust": "dust_vortex:Vortex", "squall": "dust_vortex:Vortex"}, {})
    kinds = WindKinds([*theirs, *entry_points(group=GROUP)], chosen=["squall"])
    assert kinds.find("gust").__module__ == "tallgrass.systems.wind.gust"
    assert kinds.find("squall").__module__ == "dust_vortex"
    assert not caplog.messages
    assert [row.status for row in kinds.provided() if row.name == "gust"] == ["left out", "ready"]


def test_what_is_installed_is_listed_without_importing_it(dust: WindKinds) -> None:
    rows = {row.name: row for row in dust.provided()}
    assert sorted(rows) == dust.names()
    assert rows["faulty"] == Provided("faulty", "tallgrass-dust", "0.3.1", "ready")
    assert "dust_vortex" not in sys.modules
    dust.add("calm", Calm)
    assert Provided("calm", f"{__name__}.Calm", "", "ready") in dust.provided()


@pytest.mark.usefixtures("dust")
@pytest.mark.parametrize(
    ("value", "left"), [(None, {"breeze", "vortex"}), ("", {"breeze"}), (" vortex ,", {"breeze", "vortex"})]
)
def test_the_environment_chooses_among_installed_kinds_but_built_in_ones_stay(
    monkeypatch: pytest.MonkeyPatch, value: str | None, left: set[str]
) -> None:
    if value is None:
        monkeypatch.delenv("TALLGRASS_PLUGINS", raising=False)
    else:
        monkeypatch.setenv("TALLGRASS_PLUGINS", value)
    kinds = wind_kinds()
    assert {"breeze", "vortex"} & set(kinds.names()) == left
    if "vortex" not in left:
        with pytest.raises(PluginError) as refusal:
            kinds.find("vortex")
        why = "kind 'vortex' of tallgrass-dust 0.3.1 is left out: TALLGRASS_PLUGINS does not name it"
        assert str(refusal.value) == why


def test_a_chosen_name_that_is_not_installed_is_one_warning(caplog: pytest.LogCaptureFixture) -> None:
    WindKinds([], chosen=["vortx"])
    (told,) = caplog.messages
    assert told == "TALLGRASS_PLUGINS names 'vortx', but no such kind, system or distribution is installed"


def test_a_wind_is_traced_to_who_brought_it(dust: WindKinds) -> None:
    assert dust.origin(dust.find("vortex")(kind="vortex")) == "tallgrass-dust 0.3.1"
    assert dust.origin(Calm(kind="vortex")) == f"{__name__}.Calm"


def test_d5_a_games_own_class_becomes_a_kind_of_scene_files() -> None:
    assert wind("test-calm")(Calm) is Calm
    scene = parse_scene("tallgrass: 2\ngrass: { lawn: {} }\nwind: [{ kind: test-calm, stop: 4 }]")
    assert type(scene.wind[0]) is Calm
    assert scene.wind[0].stop == 4


def test_a_reloaded_module_may_replace_its_own_kind_but_no_other() -> None:
    kinds = WindKinds([])
    kinds.add("calm", Calm)
    again = type("Calm", (Calm,), {"__module__": Calm.__module__, "__qualname__": "Calm"})
    kinds.add("calm", again)
    assert kinds.find("calm") is again
    with pytest.raises(PluginError, match=r"claimed by both .*Calm and .*Other"):
        kinds.add("calm", type("Other", (Calm,), {"__module__": "game", "__qualname__": "Other"}))


def test_what_is_installed_cannot_be_shadowed() -> None:
    with pytest.raises(PluginError, match="kind 'breeze' already comes with tallgrass "):
        wind("breeze")(Calm)


def test_wind_without_a_kind_is_refused_at_once() -> None:
    with pytest.raises(PluginError, match=r"as @wind\('ripple'\), not by @wind alone"):
        wind(Calm)  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", ["", "Calm", "two words", "os.path:join", "1st"])
def test_a_malformed_kind_is_refused(kind: str) -> None:
    with pytest.raises(PluginError, match="lower-case letters"):
        WindKinds([]).add(kind, Calm)


def test_an_incomplete_class_is_refused_where_it_is_added() -> None:
    class Half(WindPrimitive):
        pass

    with pytest.raises(PluginError, match="the class for kind 'half' lacks action and mask"):
        WindKinds([]).add("half", Half)  # type: ignore[type-abstract]
