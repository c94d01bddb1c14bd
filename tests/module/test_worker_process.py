# SPDX-License-Identifier: GPL-3.0-or-later
"""Worker processes of the batch, here of a program without Blender: limits, retries, recycling."""

import sys
import threading
import time

import pytest
from spectral_conformal.batch import pool, worker_process
from spectral_conformal.batch.worker_process import Launcher, Limits, StartError, WorkerProcess, blender_command

PROGRAM = """
import json, os, sys, time
def send(**report):
    print("noise\\n@spectral_conformal " + json.dumps(report), flush=True)
send(status="ready")
held = []
for count, line in enumerate(sys.stdin):
    word = line.strip()
    if word == "crash":
        print("last words", file=sys.stderr, flush=True)
        os.abort()
    if word.startswith("long"):
        for phase in ("read", "solve"):
            send(status="phase", phase=phase)
            time.sleep(0.5)
    if word == "hang":
        send(status="phase", phase="solve")
        send(status="phase", phase="solve", note="it hangs")
        time.sleep(60)
    if word == "greedy":
        held = [bytearray(b"x" * (1 << 20)) for _ in range(400)]
        time.sleep(60)
    send(status="failed", failure={"kind": "error", "message": word}) if word == "bad" else send(
        status="unwrapped", pid=os.getpid(), threads=os.environ["OPENBLAS_NUM_THREADS"], word=word, count=count
    )
"""


@pytest.fixture
def launcher(tmp_path):
    made = Launcher([sys.executable, "-c", PROGRAM], tmp_path)
    yield made
    made.close()


@pytest.fixture
def worker(launcher):
    made = WorkerProcess(launcher, 0, Limits(seconds=2.0, memory=200 << 20, files=3))
    yield made
    made.close()


def test_a_worker_serves_until_it_is_recycled(worker):
    reports = [worker.run(str(k)) for k in range(7)]
    assert [report["word"] for report in reports] == [str(k) for k in range(7)]
    assert [report["count"] for report in reports] == [0, 1, 2, 0, 1, 2, 0]
    assert len({report["pid"] for report in reports}) == 3
    assert {report["attempts"] for report in reports} == {1}
    assert {report["threads"] for report in reports} == {"1"}


@pytest.mark.parametrize(("word", "kind"), [("crash", "crash"), ("hang", "time"), ("greedy", "memory")])
def test_what_ends_a_worker_is_told_after_another_try_unless_it_took_too_long(worker, word, kind):
    report = worker.run(word)
    assert report["failure"]["kind"] == kind
    assert report["attempts"] == (1 if kind == "time" else 2)
    assert worker.pid is None
    if word == "hang":
        assert report["failure"]["message"] == "more than 2 seconds, in the phase 'solve': it hangs"
    if word == "crash":
        assert report["failure"]["log"] == ["last words", "last words"]
        assert "signal 6" in report["failure"]["message"]
    assert worker.run("next")["status"] == "unwrapped"


@pytest.mark.parametrize("delay", [0.0, 0.001, 0.01, 0.3])
def test_another_thread_may_close_a_worker_that_runs_a_request(launcher, delay):
    made = WorkerProcess(launcher, 0, Limits(seconds=30.0, memory=200 << 20, retries=0))
    found = []

    def run():
        try:
            found.append(made.run("hang")["failure"]["kind"])
        except StartError:
            # It was not ready yet.
            found.append("crash")

    running = threading.Thread(target=run)
    running.start()
    while made.pid is None:
        time.sleep(0.001)
    time.sleep(delay)
    made.close()
    running.join(20.0)
    assert found == ["crash"]


def test_what_is_wrong_with_an_asset_is_not_tried_again(worker):
    report = worker.run("bad")
    assert (report["failure"], report["attempts"]) == ({"kind": "error", "message": "bad"}, 1)


def test_a_worker_that_does_not_get_ready(tmp_path):
    launcher = Launcher([sys.executable, "-c", "raise SystemExit('no module')"], tmp_path)
    with pytest.raises(StartError, match=r"(?s)exit code 1.*no module"):
        WorkerProcess(launcher, 0, Limits()).run("x")
    with pytest.raises(StartError):
        list(pool.run([("x", launcher), ("y", launcher)], Limits(), 2))
    launcher.close()


def test_a_pool_answers_every_request(launcher):
    words = ["a", "crash", "b", "bad", "hang", *map(str, range(10))]
    found = dict(pool.run([(word, launcher) for word in words], Limits(seconds=2.0), 3))
    assert sorted(found) == list(range(len(words)))
    assert {words[k] for k, report in found.items() if report["status"] == "failed"} == {"crash", "bad", "hang"}
    assert all(report["word"] == words[k] for k, report in found.items() if report["status"] == "unwrapped")


def test_requests_go_to_the_workers_that_are_for_them(launcher, tmp_path):
    other = Launcher([sys.executable, "-c", PROGRAM.replace('"unwrapped"', '"kept"')], tmp_path)
    requests = [(str(k), other if k % 3 else launcher) for k in range(9)]
    found = dict(pool.run(requests, Limits(), 2))
    assert [found[k]["status"] for k in range(9)] == ["kept" if k % 3 else "unwrapped" for k in range(9)]
    # One of each kind in each of two threads, however the requests alternate.
    assert len({report["pid"] for report in found.values()}) <= 4
    other.close()


def test_a_program_that_is_not_there_is_named():
    with pytest.raises(StartError, match="There is no program no-such-blender"):
        blender_command("no-such-blender")


def test_an_asset_that_takes_long_shows_signs_of_life(launcher, monkeypatch):
    monkeypatch.setattr(worker_process, "_BEAT_SECONDS", 0.2)
    signs = []
    requests = [(word, launcher) for word in ("short", "long")]
    found = dict(pool.run(requests, Limits(), 1, lambda *sign: signs.append(sign)))
    assert [found[k]["word"] for k in (0, 1)] == ["short", "long"]
    assert {(index, phase) for index, phase, *_ in signs} == {(1, "read"), (1, "solve")}
    assert [phase for _, phase, _, begins, _ in signs if begins] == ["read", "solve"]
    seconds = [each for _, _, each, begins, _ in signs if not begins]
    assert seconds == sorted(seconds) and 3 <= len(seconds) <= 6
