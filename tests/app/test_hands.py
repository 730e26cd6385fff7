"""Workers of a Dask scheduler: found, given work, and reported where they are missing."""

import os
import re
import shutil
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import dask
import pytest

from tallgrass.app.cli import run
from tallgrass.app.farm import dask as found_dask
from tallgrass.app.farm import hands as hands_module
from tallgrass.app.farm import hire
from tallgrass.app.farm.film import must_be_alike
from tallgrass.app.farm.hands import LostError
from tallgrass.app.farm.hire import hired
from tallgrass.app.farm.worker import Footage, in_drawing_thread
from tallgrass.app.studio.errors import MachineError
from tallgrass.app.studio.shooting import Shot

FILM = ["film", "plain", "-o", "film/", "--seconds", "1", "--size", "64x36", "--on"]


@pytest.fixture
def cluster() -> Iterator[Any]:
    """A scheduler and two workers in this process."""
    with found_dask.quiet(), _cluster(2) as made:
        yield made


def _cluster(workers: int, protocol: str = "tcp://") -> Any:
    return found_dask.need_distributed().LocalCluster(
        n_workers=workers, threads_per_worker=1, processes=False, protocol=protocol, dashboard_address=None
    )


def slow_then(number: int) -> int:
    time.sleep(0.2 if number == 0 else 0.0)
    return number


def failing(number: int) -> int:
    if number == 2:
        raise MachineError("no OpenGL here")
    return number


def test_what_workers_make_comes_in_the_order_of_asking(cluster: Any) -> None:
    with hired(cluster.scheduler_address, most=9) as hands:
        assert hands.count == 2
        assert list(hands.in_order(slow_then, ((number,) for number in range(9)))) == list(range(9))


def test_no_more_is_asked_for_than_workers_have_at_hand(cluster: Any) -> None:
    asked = []

    def pieces() -> Iterator[tuple[int]]:
        for number in range(20):
            asked.append(number)
            yield (number,)

    with hired(cluster.scheduler_address, most=20) as hands:
        made = hands.in_order(slow_then, pieces())
        assert [next(made), next(made)] == [0, 1]
        assert len(asked) <= hands_module.AHEAD * 2 + 2


def test_what_a_worker_raises_is_raised_here(cluster: Any) -> None:
    with hired(cluster.scheduler_address, most=9) as hands:
        made = hands.in_order(failing, [(1,), (2,), (3,)])
        assert next(made) == 1
        with pytest.raises(MachineError, match=r"^no OpenGL here$"):
            next(made)


def test_what_is_kept_for_workers_stands_for_itself(cluster: Any) -> None:
    with hired(cluster.scheduler_address, most=9) as hands:
        kept = hands.keep(7)
        assert list(hands.in_order(pow, [(kept, 2), (kept, 3)])) == [49, 343]


def test_a_scheduler_that_goes_away_is_told_in_one_sentence(cluster: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hire, "ANSWER", 0.5)
    with hired(cluster.scheduler_address, most=9) as hands:
        made = hands.in_order(slow_then, ((number,) for number in range(99)))
        next(made)
        cluster.close()
        with pytest.raises(LostError, match=r"^--on: tcp://[^ ]+: the scheduler is gone$"):
            list(made)


def test_workers_that_all_go_away_are_waited_for_only_so_long(cluster: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hands_module, "LISTEN", 0.1)
    monkeypatch.setattr(hands_module, "PATIENCE", 0.3)
    with hired(cluster.scheduler_address, most=9) as hands:
        client = found_dask.need_distributed().default_client()
        client.retire_workers(list(client.nthreads()))
        with pytest.raises(LostError, match=r"^--on: tcp://[^ ]+: all workers are gone$"):
            list(hands.in_order(slow_then, [(1,)]))


def test_a_scheduler_without_workers_says_how_to_start_one(capsys: pytest.CaptureFixture[str]) -> None:
    with found_dask.quiet(), _cluster(0) as cluster:
        assert run([*FILM, cluster.scheduler_address]) == 1
    told = f"this scheduler has no workers; start some: dask worker {cluster.scheduler_address}"
    assert capsys.readouterr().err == f"--on: {cluster.scheduler_address}: {told}\n"


@pytest.mark.parametrize("listens", [False, True], ids=["nobody", "somebody silent"])
def test_an_address_that_answers_nothing_is_one_sentence_within_ten_seconds(
    *, listens: bool, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert hire.ANSWER <= 5.0
    monkeypatch.setattr(hire, "ANSWER", 0.3)
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        if not listens:
            server.close()
        start = time.monotonic()
        assert run([*FILM, address]) == 1
        took = time.monotonic() - start
    assert capsys.readouterr() == ("", f"--on: {address}: no Dask scheduler answers there\n")
    assert took < 5.0


@pytest.mark.parametrize("place", ["nowhere", "local:", "local:0", "local:x", "tcp://", "host:port", "a b:1"])
def test_what_is_no_place_is_bad_input(place: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run([*FILM, place]) == 2
    told = f"--on: '{place}' is neither local, local:4 nor a scheduler's address like tcp://host:8786\n"
    assert capsys.readouterr().err == told


def test_without_dask_it_is_said_what_installs_it(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert run([*FILM, "local"]) == 1
    assert capsys.readouterr().err == "work is handed out by Dask's distributed: pip install 'tallgrass[farm]'\n"


def test_workers_of_other_versions_are_refused_by_name(cluster: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hire, "versions_at", lambda _: {"the worker tcp://b:1": "tallgrass 9.9 with numpy 2.0"})
    here = re.escape(found_dask.versions())
    said = rf"the worker tcp://b:1 has tallgrass 9\.9 with numpy 2\.0; install {here} there, as here$"
    with pytest.raises(MachineError, match=said), hired(cluster.scheduler_address, most=1):
        pass


def test_scheduler_and_workers_all_tell_their_versions(cluster: Any) -> None:
    with found_dask.need_distributed().Client(cluster) as client:
        told = hire.versions_at(client)
    assert set(told) == {"the scheduler", *(f"the worker {each.address}" for each in cluster.workers.values())}
    assert set(told.values()) == {found_dask.versions()}


def test_pictures_of_two_renderers_are_never_put_into_one_film() -> None:
    one, other = (Footage([Shot(b"", "", name)], found_dask.versions()) for name in ("card", "llvmpipe"))
    assert must_be_alike(one, one) is one
    with pytest.raises(MachineError, match="workers draw by llvmpipe and by card"):
        must_be_alike(other, one)
    with pytest.raises(MachineError, match=r"a worker has tallgrass 0\.0 with numpy 1, and this machine tallgrass"):
        must_be_alike(Footage(one.shots, "tallgrass 0.0 with numpy 1"), one)


def test_whatever_threads_a_worker_has_one_of_them_draws() -> None:
    with ThreadPoolExecutor(4) as pool:
        drew = set(pool.map(lambda _: in_drawing_thread(threading.get_ident), range(16)))
    assert len(drew) == 1
    assert threading.get_ident() not in drew


@pytest.mark.parametrize(("cores", "workers", "threads"), [(2, 2, "1"), (8, 2, "4"), (2, 4, "1")])
def test_workers_share_the_cores_out_unless_the_user_does(
    monkeypatch: pytest.MonkeyPatch, cores: int, workers: int, threads: str
) -> None:
    monkeypatch.delenv("LP_NUM_THREADS", raising=False)
    monkeypatch.setattr(hire, "cores", lambda: cores)
    assert hire.shared_cores(workers) == {"LP_NUM_THREADS": threads}
    monkeypatch.setenv("LP_NUM_THREADS", "3")
    assert hire.shared_cores(workers) == {}


def test_dasks_own_settings_of_tls_count(tmp_path: Path) -> None:
    openssl = shutil.which("openssl")
    if openssl is None:
        pytest.skip("there is no openssl to make a certificate with")
    key, certificate = tmp_path / "key.pem", tmp_path / "certificate.pem"
    words = "req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=localhost -keyout"
    made = [openssl, *words.split(), str(key), "-out", str(certificate)]
    subprocess.run(made, check=True, capture_output=True, env={**os.environ, "OPENSSL_CONF": os.devnull})
    tls: dict[str, str] = {"distributed.comm.tls.ca-file": str(certificate)}
    for role in ("scheduler", "worker", "client"):
        tls |= {f"distributed.comm.tls.{role}.key": str(key), f"distributed.comm.tls.{role}.cert": str(certificate)}
    with found_dask.quiet():
        with dask.config.set(tls):
            secured = _cluster(1, "tls://")
            with hired(secured.scheduler_address, most=1) as hands:
                assert secured.scheduler_address.startswith("tls://")
                assert hands.count == 1
        with pytest.raises(MachineError, match="TLS"), hired(secured.scheduler_address, most=1):
            pass
        secured.close()
