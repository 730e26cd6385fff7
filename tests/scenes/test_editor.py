"""The bundled scenes in an editor: the language server for YAML, from npm, with our schema.

If it is not on the path, npm installs it once into pytest's cache. Without npm or a network, these tests
are skipped.
"""

import json
import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

import pytest

from tallgrass.app.check import described
from tallgrass.engine.plugins import wind_kinds
from tallgrass.engine.scene import bundled_scenes

NAME = "yaml-language-server"
VERSION = "1.25.0"
FULL = Path(__file__).parent / "format-2" / "full.yaml"
HEAD = "# yaml-language-server: $schema={}\ntallgrass: 2\n"


class Editor:
    """A client of the language server: it opens texts, and gets problems, hovers and completions."""

    def __init__(self, command: list[str]) -> None:
        self._server = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._number = 0
        self.ask("initialize", {"processId": None, "rootUri": None, "capabilities": {}})
        self._send({"method": "initialized", "params": {}})

    def open(self, path: Path, text: str) -> list[str]:
        """Open a text and return its problems, each as `line: message`."""
        path.write_text(text, "utf-8")
        document = {"uri": path.as_uri(), "languageId": "yaml", "version": 1, "text": text}
        self._send({"method": "textDocument/didOpen", "params": {"textDocument": document}})
        told = self._await(lambda message: message.get("params", {}).get("uri") == path.as_uri())["params"]
        return [f"{found['range']['start']['line'] + 1}: {found['message']}" for found in told["diagnostics"]]

    def hover(self, path: Path, line: int, column: int) -> str:
        """Return the hover text at a line and column, counted from 1."""
        place = {"line": line - 1, "character": column - 1}
        shown = self.ask("textDocument/hover", {"textDocument": {"uri": path.as_uri()}, "position": place})
        return str(shown["contents"]["value"])

    def complete(self, path: Path, line: int, column: int) -> set[str]:
        """Return the completions at a line and column, counted from 1."""
        place = {"line": line - 1, "character": column - 1}
        offered = self.ask("textDocument/completion", {"textDocument": {"uri": path.as_uri()}, "position": place})
        return {item["label"] for item in offered["items"]}

    def ask(self, method: str, params: object) -> Any:
        """Send a request and return what comes back."""
        self._number += 1
        number = self._number
        self._send({"id": number, "method": method, "params": params})
        return self._await(lambda message: message.get("id") == number and "method" not in message)["result"]

    def close(self) -> None:
        self._server.kill()
        self._server.communicate()

    def _await(self, wanted: Any) -> dict[str, Any]:
        while True:
            message = self._receive()
            if wanted(message):
                return message
            if message.get("method") == "workspace/configuration":
                empty: list[dict[str, Any]] = [{} for _ in message["params"]["items"]]
                empty[0] = {"hover": True, "completion": True, "validate": True, "schemaStore": {"enable": False}}
                self._send({"id": message["id"], "result": empty})
            elif "id" in message and "method" in message:
                self._send({"id": message["id"], "result": None})

    def _send(self, message: dict[str, Any]) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        stream = self._pipe(self._server.stdin)
        stream.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        stream.flush()

    def _receive(self) -> dict[str, Any]:
        stream, size = self._pipe(self._server.stdout), 0
        while (line := stream.readline()) != b"\r\n":
            assert line, "the server has ended"
            if line.lower().startswith(b"content-length:"):
                size = int(line.split(b":")[1])
        received: dict[str, Any] = json.loads(stream.read(size))
        return received

    @staticmethod
    def _pipe(stream: IO[bytes] | None) -> IO[bytes]:
        assert stream is not None
        return stream


@pytest.fixture(scope="module")
def command(pytestconfig: pytest.Config) -> list[str]:
    """Command that starts the server."""
    found = shutil.which(NAME)
    if found:
        return [found, "--stdio"]
    npm = shutil.which("npm") if os.environ.get("TALLGRASS_NPM") == "1" else None
    if npm is None:
        pytest.skip(f"there is no {NAME}; with TALLGRASS_NPM=1, npm installs it")
    folder = pytestconfig.cache.mkdir(f"{NAME}-{VERSION}")
    program = folder / "node_modules" / ".bin" / NAME
    if not program.exists():
        options = ["--no-audit", "--no-fund", "--ignore-scripts", "--fetch-retries=0", "--fetch-timeout=20000"]
        order = [npm, "install", "--prefix", str(folder), *options, f"{NAME}@{VERSION}"]
        try:
            subprocess.run(order, capture_output=True, check=True, timeout=90)
        except (subprocess.SubprocessError, OSError) as error:
            pytest.skip(f"npm cannot install {NAME}: {error}")
    return [str(program), "--stdio"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of scenes with our schema in it."""
    made = tmp_path_factory.mktemp("editor")
    (made / "scenes.json").write_text(json.dumps(described(wind_kinds())[0]), "utf-8")
    return made


@pytest.fixture(scope="module")
def editor(command: list[str]) -> Iterator[Editor]:
    """An editor of scenes."""
    opened = Editor(command)
    yield opened
    opened.close()


def test_d4_the_language_server_finds_every_bundled_scene_right(editor: Editor, folder: Path) -> None:
    for path in (*bundled_scenes().values(), FULL):
        text = f"{path.read_text('utf-8')}\n# yaml-language-server: $schema=scenes.json\n"
        assert editor.open(folder / path.name, text) == [], path.name


def test_d4_the_language_server_tells_what_a_scene_says_wrong(editor: Editor, folder: Path) -> None:
    text = HEAD.format("scenes.json") + "grass: { lawn: { width: 9 } }\nwind:\n  - { kind: gust, radius: 4 }\nsed: 1\n"
    told = editor.open(folder / "wrong.yaml", text)
    assert sorted(line[:2] for line in told) == ["3:", "5:", "6:"]
    assert "radius" in next(line for line in told if line.startswith("5:"))


def test_d4_an_editor_shows_the_docstring_over_a_key_and_offers_the_keys_of_a_kind(
    editor: Editor, folder: Path
) -> None:
    text = HEAD.format("scenes.json") + "grass: { lawn: {} }\nlight: {}\nwind:\n  - kind: gust\n    speed: 9\n    \n"
    path = folder / "hover.yaml"
    editor.open(path, text)
    speed = editor.hover(path, 7, 6)
    assert "Speed at which it travels" in speed
    assert "m/s" in speed
    assert "Default: 8. Range: above 0.1 and at most 60." in speed
    assert "Sun, sky, clouds and haze, which light grass" in editor.hover(path, 4, 2)
    assert editor.complete(path, 8, 5) >= {"reach", "tail", "wander"}
    assert not editor.complete(path, 8, 5) & {"radius", "outline", "gustiness"}
