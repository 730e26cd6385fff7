"""A crew of processes on one machine."""

import os
import signal
import sys
from pathlib import Path

import pytest

from tallgrass.app.bench import crew
from tallgrass.app.bench.crew import by_many, ticked
from tallgrass.app.studio.errors import MachineError


@pytest.fixture(autouse=True)
def _found_by_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let other processes import this module by its stem: another package may have a `tests`, too."""
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    monkeypatch.setitem(sys.modules, "test_crew", sys.modules[__name__])
    for job in (doubled, failing, ended):
        monkeypatch.setattr(job, "__module__", "test_crew")


def doubled(number: int) -> tuple[int, int, str]:
    """Return twice a number, counted in as many steps, the process's id, and Mesa's number of threads there."""
    return sum(2 for _ in ticked(range(number))), os.getpid(), os.environ["LP_NUM_THREADS"]


def failing(number: int) -> int:
    if number == 1:
        raise MachineError("no OpenGL here")
    return number


def ended(number: int) -> int:
    os.kill(os.getpid(), signal.SIGKILL)
    return number


def test_jobs_are_done_in_other_processes_and_come_back_in_their_order(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(crew, "cores", lambda: 6)
    monkeypatch.delenv("LP_NUM_THREADS", raising=False)
    seen: list[int] = []

    def counted(items: object, *, total: int, doing: str) -> object:
        assert (total, doing) == (6, "doubling")
        for item in items:  # type: ignore[attr-defined]
            seen.append(item)
            yield item

    monkeypatch.setattr(crew, "counted", counted)
    made = by_many(doubled, [(3,), (1,), (2,)], workers=2, steps=6, doing="doubling")
    assert [number for number, *_ in made] == [6, 2, 4]
    assert os.getpid() not in {who for _, who, _ in made}
    assert {threads for *_, threads in made} == {"3"}
    assert seen == [1, 2, 3, 4, 5, 6]


def test_what_a_job_raises_is_raised_here() -> None:
    with pytest.raises(MachineError, match=r"^no OpenGL here$"):
        by_many(failing, [(0,), (1,), (2,)], workers=1, steps=0, doing="failing")


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="a process is ended there in another way")
def test_a_process_that_dies_ends_the_work() -> None:
    with pytest.raises(RuntimeError):
        by_many(ended, [(0,)], workers=1, steps=0, doing="ending")
