"""The doctor names what is missing, and the exact line that installs it."""

import os
import re
import sys
from importlib.metadata import EntryPoint, distributions, entry_points, version
from pathlib import Path

import moderngl
import pytest

from tallgrass.app.doctor import Finding, cure, diagnose, drawing, packages, tell, window, winds
from tallgrass.engine.plugins import GROUP, WindKinds

NO_DISPLAY = "(standalone) XOpenDisplay: cannot open display"
LLVMPIPE = {"version": "4.5", "renderer": "llvmpipe (LLVM 15.0.6, 256 bits)", "vendor": "Mesa/X.org"}


@pytest.mark.parametrize(
    ("complaint", "names"),
    [
        ("RuntimeError: Cannot find OpenGL support library libGL", "libegl1 libgl1"),
        ("Exception: libGL.so not found in /lib, /usr/lib or LD_LIBRARY_PATH", "libegl1 libgl1"),
        ("Exception: libGL.so not loaded", "libegl1 libgl1"),
        ('ImportError: Library "GL" not found.', "libegl1 libgl1"),
        (f"no OpenGL 3.3 without a window: libEGL.so not loaded; {NO_DISPLAY}", "libegl1"),
        ('ImportError: Library "EGL" not found.', "libegl1"),
        (f"requested device index 0, but found 0 devices; {NO_DISPLAY}", "libegl-mesa0 libgl1-mesa-dri"),
        ("NoSuchConfigException: No standard config is available.", "libgl1-mesa-dri"),
        (f"eglInitialize failed (0x3001); {NO_DISPLAY}", "libgl1-mesa-dri"),
        ('ImportError: Library "freetype" not found.', "libfontconfig1 libfreetype6"),
        ('ImportError: Library "fontconfig" not found.', "libfontconfig1 libfreetype6"),
        ("AttributeError: 'NoneType' object has no attribute 'XRenderFindVisualFormat'", "libxrender1"),
        ('NoSuchDisplayException: Cannot connect to "None"', "xvfb xauth"),
        ("The virtual environment was not created because ensurepip is not available.", "python3-venv"),
    ],
)
def test_each_complaint_of_a_loader_is_cured_by_its_debian_packages(
    complaint: str, names: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("shutil.which", lambda _: "/usr/bin/apt-get")
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    assert cure(complaint) == f"sudo apt-get install -y --no-install-recommends {names}"


def test_root_needs_no_sudo_and_other_systems_get_the_names(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    monkeypatch.setattr("shutil.which", lambda _: "/usr/bin/apt-get")
    assert cure("libEGL.so not loaded") == "apt-get install -y --no-install-recommends libegl1"
    monkeypatch.setattr("shutil.which", lambda _: None)
    assert cure("libEGL.so not loaded") == "install what Debian calls libegl1"


def test_a_driver_that_is_too_old_is_not_cured_by_a_display() -> None:
    line = cure(f"eglCreateContext failed (0x3009); {NO_DISPLAY}")
    assert line is not None
    assert "update the graphics driver" in line


def test_a_managed_python_is_cured_by_an_environment_of_ones_own() -> None:
    assert (
        cure("error: externally-managed-environment") == "python3 -m venv .venv && .venv/bin/pip install '.[commands]'"
    )


def test_an_unknown_complaint_has_no_cure() -> None:
    assert cure("KeyError: 'grass'") is None


def test_a_missing_requirement_is_told_with_its_line_and_an_optional_one_only_noted() -> None:
    found = packages(["numpy>=2", "no-such-grass[fast]>=1.2", 'no-such-film; extra == "video"', 'x; extra == "dev"'])
    assert [(each.part, each.level) for each in found] == [
        ("numpy", "ok"),
        ("no-such-grass", "missing"),
        ("no-such-film", "note"),
    ]
    assert (found[1].cure or "").endswith("-m pip install --upgrade 'no-such-grass[fast]>=1.2'")


def test_on_windows_a_line_is_quoted_as_its_own_terminal_reads_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setattr(sys, "executable", r"C:\Program Files\Python\python.exe")
    (found,) = packages(["no-such-grass[fast]>=1.2"])
    assert found.cure == (r'"C:\Program Files\Python\python.exe" -m pip install --upgrade "no-such-grass[fast]>=1.2"')


@pytest.mark.parametrize("platform", ["win32", "darwin"])
def test_nobody_is_told_of_packages_where_there_are_none(platform: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", platform)
    for complaint in ("Cannot find OpenGL support library libGL", f"libEGL.so not loaded; {NO_DISPLAY}"):
        assert cure(complaint) == "update the graphics driver"
    assert cure("KeyError: 'grass'") is None


def test_of_what_is_optional_it_is_told_what_needs_it() -> None:
    extras = re.findall(r"\(with the extra `(\w+)`\)", (Path(__file__).parents[2] / "README.md").read_text("utf-8"))
    assert set(extras) >= {"bench", "figures"}
    for extra in {*extras, "video"}:
        (found,) = packages([f'no-such-thing>=1; extra == "{extra}"'])
        assert found.level == "note"
        assert found.text.startswith("not installed; only ")
        assert found.text.endswith(" need it")


def test_a_software_rasteriser_is_noted_but_suffices() -> None:
    found = drawing(LLVMPIPE)
    assert found.level == "note"
    assert "llvmpipe" in found.text
    assert drawing(LLVMPIPE | {"renderer": "NVIDIA H200"}).level == "ok"


def test_a_window_is_missed_only_where_there_is_a_display() -> None:
    failed = {"error": 'ImportError: Library "freetype" not found.'}
    assert window(failed, has_display=True).level == "missing"
    assert window(failed, has_display=False).level == "note"


def test_a_broken_plugin_is_noted_and_the_others_are_found() -> None:
    entries = [
        EntryPoint("breeze", "tallgrass.systems.wind.breeze:Breeze", GROUP),
        EntryPoint("dust", "tallgrass_dust.no_such_module:Dust", GROUP),
    ]
    found = {each.part: each for each in winds(WindKinds(entries), entries)}
    assert found["wind breeze"].level == "ok"
    assert found["wind dust"].level == "note"
    assert "ModuleNotFoundError" in found["wind dust"].text


def test_no_newer_package_is_named_for_a_plugin_that_lacks_another_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    info = tmp_path / "tallgrass_dry-0.1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: tallgrass-dry\nVersion: 0.1\n")
    names = "lacking = tallgrass_lacking:A\nnew = tallgrass_new:C\nold = tallgrass_old:B\n"
    (info / "entry_points.txt").write_text(f"[{GROUP}]\n{names}")
    (tmp_path / "tallgrass_new.py").write_text("from tallgrass import Breeze\nclass C(Breeze): interface = 99\n")
    (tmp_path / "tallgrass_lacking.py").write_text("import no_such_module_anywhere\n")
    (tmp_path / "tallgrass_old.py").write_text("")
    monkeypatch.syspath_prepend(str(tmp_path))
    entries = [entry for entry in entry_points(group=GROUP) if entry.dist and entry.dist.name == "tallgrass-dry"]
    lacking, new, old = winds(WindKinds(entries), entries)
    assert lacking.text.endswith("ModuleNotFoundError: No module named 'no_such_module_anywhere'")
    assert lacking.cure is None
    assert (old.cure or "").endswith("--upgrade tallgrass-dry")
    assert (new.cure or "").endswith("--upgrade tallgrass"), "it is written for a newer one"


def test_a_kind_whose_module_ends_python_is_one_note(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "tallgrass_leaving.py").write_text("import sys; sys.exit(7)")
    monkeypatch.syspath_prepend(str(tmp_path))
    entries = [EntryPoint("leaving", "tallgrass_leaving:Leaving", GROUP)]
    (found,) = winds(WindKinds(entries), entries)
    assert (found.level, found.text.endswith("cannot be loaded: SystemExit: 7")) == ("note", True)


def test_a_built_in_kind_is_ok_and_from_here_whoever_else_claims_it(tmp_path: Path) -> None:
    info = tmp_path / "tallgrass_storm-0.3.1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: tallgrass-storm\nVersion: 0.3.1\n")
    (info / "entry_points.txt").write_text(f"[{GROUP}]\ngust = storm:Gust\n")
    (theirs,) = next(iter(distributions(path=[str(tmp_path)]))).entry_points
    for entries in ([*entry_points(group=GROUP), theirs], [theirs, *entry_points(group=GROUP)]):
        found = {each.part: each for each in winds(WindKinds(entries), entries)}
        assert found["wind gust"] == Finding("wind gust", "ok", "from tallgrass")


def test_what_is_missing_decides_the_exit_status(capsys: pytest.CaptureFixture[str]) -> None:
    note = Finding("window", "note", "there is no display")
    assert tell([note]) == 0
    assert tell([note, Finding("OpenGL", "missing", "libGL.so not loaded", "apt-get install libgl1")]) == 1
    printed = capsys.readouterr().out.splitlines()
    assert "        -> apt-get install libgl1" in printed
    assert printed[-1] == "missing: OpenGL"


@pytest.mark.gl
@pytest.mark.usefixtures("ctx")
def test_this_machine_draws_and_the_context_in_use_stays_current(ctx: moderngl.Context) -> None:
    found = {each.part: each for each in diagnose()}
    assert found["OpenGL"].level != "missing"
    assert found["moderngl"].text == version("moderngl")
    assert found["wind breeze"].level == "ok"
    assert ctx.buffer(b"grass").read() == b"grass"


def test_without_the_gl_library_the_doctor_names_its_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GLCONTEXT_LINUX_LIBGL", "libGL.so.99")
    found = {each.part: each for each in diagnose()}
    assert found["OpenGL"].level == "missing"
    assert "libegl1 libgl1" in (found["OpenGL"].cure or "")
