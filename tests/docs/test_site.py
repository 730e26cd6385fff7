"""The manual in a browser: it can be searched and read on a narrow screen, and no picture or link is broken."""

import json
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from importlib.util import find_spec
from pathlib import Path
from queue import Empty, Queue
from threading import Thread
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
NAMES = ("chromium", "chromium-browser", "google-chrome")
NARROW = 400
"""Width of the screen [pixels]."""

BUILD = """
import sys
from pathlib import Path
from PIL import Image
from docs.making import build, pictures
folder = Path(sys.argv[1])
kept = folder / "pictures"
kept.mkdir()
numbers = pictures.figures_shown()
for name in [*(picture.file for picture in pictures.PICTURES), *(f"figure-{number:02d}.png" for number in numbers)]:
    Image.new("RGB", (960, 540)).save(kept / name)
build.gather(folder / "source", kept)
build.build(folder / "mkdocs.yml")
"""
"""Builds the manual with black pictures in place of its own, which take minutes to draw."""

Told = dict[str, Any]


def browser() -> str:
    found = next(filter(None, map(shutil.which, NAMES)), None)
    if found is None:
        pytest.skip("there is no Chromium (apt-get install --no-install-recommends chromium)")
    return found


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of the built manual."""
    browser()
    if find_spec("mkdocs") is None:
        pytest.skip("there is no mkdocs (pip install 'tallgrass[docs]')")
    folder = tmp_path_factory.mktemp("manual")
    config = (ROOT / "docs" / "mkdocs.yml").read_text("utf-8")
    for key, name in (("docs_dir", "source"), ("site_dir", "site")):
        config = re.sub(f"^{key}: .*$", f"{key}: {folder / name}", config, flags=re.MULTILINE)
    (folder / "mkdocs.yml").write_text(config, "utf-8")
    subprocess.run([sys.executable, "-c", BUILD, folder], cwd=ROOT, check=True)
    return folder / "site"


class Serves(SimpleHTTPRequestHandler):
    """Serves the manual and the page that inspects it, and receives that page's report."""

    heard: "Queue[Told]" = Queue()

    def do_GET(self) -> None:
        folder = Path(self.directory)
        if self.path == "/look.html":
            self._answer(Path(__file__).with_name("look.html").read_bytes(), "text/html")
        elif self.path == "/pages":
            pages = sorted(path.name for path in folder.glob("*.html") if path.name != "404.html")
            self._answer(json.dumps(pages).encode(), "application/json")
        else:
            super().do_GET()

    def do_POST(self) -> None:
        self.heard.put(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
        self._answer(b"", "text/plain")

    def _answer(self, content: bytes, kind: str) -> None:
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *_: object) -> None:
        """Say nothing."""


@pytest.fixture(scope="module")
def told(site: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Told]:
    """Report of a browser on all pages."""
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Serves, directory=str(site))) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        command = [
            browser(), "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
            "--disable-background-networking", f"--user-data-dir={tmp_path_factory.mktemp('profile')}",
            f"http://127.0.0.1:{server.server_port}/look.html",
        ]  # fmt: skip
        with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as chromium:
            try:
                yield Serves.heard.get(timeout=90)
            except Empty:
                chromium.kill()
                assert chromium.stderr is not None
                pytest.fail(f"the browser told nothing: {chromium.stderr.read()[-2000:]}")
            finally:
                chromium.kill()
                server.shutdown()


def test_all_pages_are_opened(told: Told) -> None:
    assert told["error"] is None
    assert len(told["pages"]) == len(list((ROOT / "docs").glob("*.md"))) > 10


def test_a_search_finds_what_a_page_tells_of(told: Told) -> None:
    assert any("scene.html" in place for place in told["found"])


def test_no_picture_is_broken(told: Told) -> None:
    assert sum(page["pictures"] for page in told["pages"].values()) > 20
    assert {name: page["broken"] for name, page in told["pages"].items() if page["broken"]} == {}


def test_every_link_inside_the_manual_leads_to_a_heading_that_is_there(told: Told, site: Path) -> None:
    ids = {name: {"", *page["ids"]} for name, page in told["pages"].items()}
    links = [(name, *link) for name, page in told["pages"].items() for link in page["links"]]
    assert len(links) > 300
    assert [link for link in links if link[1] not in ids and not (site / link[1].lstrip("/")).is_file()] == []
    assert [link for link in links if link[1] in ids and link[2] not in ids[link[1]]] == []


def test_every_page_can_be_read_on_a_screen_of_400_pixels(told: Told) -> None:
    assert {name: page["wide"] for name, page in told["pages"].items() if page["width"] > NARROW} == {}
