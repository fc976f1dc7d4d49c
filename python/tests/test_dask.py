"""Tests a sweep on a Dask cluster of two workers, one of which is killed during the run. The merged table must equal
that of a single machine, byte by byte."""

import os
import signal
import subprocess
import sys
import time

import pytest

distributed = pytest.importorskip("dask.distributed")
eomgen_dask = pytest.importorskip("eomgen.dask")

SPECIFICATION = """
[model]
name = "oscillator"
[parameters]
m = { value = 1, unit = "kg" }
c = { value = 0.5, unit = "N s/m" }
k = { value = 4, unit = "N/m" }
F = { value = 3, unit = "N" }
omega = { value = 2, unit = "rad/s" }
[coordinates]
x = { unit = "m" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[dissipation]
damper = "1/2*c*dot(x)^2"
[forces]
drive = { on = "x", value = "F*sin(omega*t)" }
"""

# A point takes some hundredths of a second, so the worker is killed between the first and the last point.
VARIED = ["--vary", "c=0.4:1:5", "--vary", "omega=1:3:8", "--measure", "poincare"]
SPAN = ["--transient", "20000", "--periods", "8"]


@pytest.fixture
def cluster(tmp_path):
    """Starts a scheduler and two workers as processes. Yields the address and the workers."""
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": tmp_path}
    file = tmp_path / "scheduler.json"
    scheduler = subprocess.Popen(
        [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1"]
        + ["--port", "0", "--no-dashboard", "--scheduler-file", str(file)],
        **quiet,
    )
    deadline = time.monotonic() + 60
    while not file.exists() or not file.read_text():
        assert scheduler.poll() is None and time.monotonic() < deadline
        time.sleep(0.05)
    workers = [
        subprocess.Popen(
            [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", str(file)]
            + ["--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", str(tmp_path)],
            **quiet,
        )
        for _ in range(2)
    ]
    client = distributed.Client(scheduler_file=str(file), timeout="60s")
    client.wait_for_workers(2, timeout=60)
    yield client, workers
    client.close()
    for process in [*workers, scheduler]:
        process.kill()
        process.wait()


def finished(folder):
    return [part for part in folder.glob("parts/*.part")]


def test_lost_worker_does_not_change_the_sweep(cluster, program, tmp_path):
    client, workers = cluster
    (tmp_path / "oscillator.toml").write_text(SPECIFICATION)
    spec = str(tmp_path / "oscillator.toml")
    alone, spread = tmp_path / "alone", tmp_path / "spread"
    command = [program, "sweep", spec, *VARIED, *SPAN, "--out", str(alone)]
    subprocess.run(command, check=True, capture_output=True)
    killed = []

    def kill(done, whole):
        if done >= 2 and not killed:
            assert len(finished(spread)) < len(finished(alone))
            killed.append(whole)
            workers[0].send_signal(signal.SIGKILL)

    said = eomgen_dask.sweep(
        client, [spec, *VARIED, *SPAN, "--out", str(spread)], 10, program=program, progress=kill
    )
    assert killed == [10] and "40 points" in said
    assert workers[0].wait() == -signal.SIGKILL
    for name in ["sweep.json", "sweep.parquet", "map_poincare.png"]:
        assert (alone / name).read_bytes() == (spread / name).read_bytes(), name
    # The same sweep by the command line, on the remaining worker, into the existing folder.
    address = client.scheduler.address
    command = [program, "sweep", spec, *VARIED, *SPAN, "--out", str(spread), "--engine", "dask"]
    environment = dict(os.environ, DASK_SCHEDULER_ADDRESS=address)
    done = subprocess.run([*command, "--shards", "3"], env=environment, capture_output=True, text=True)
    assert done.returncode == 0 and "3 shards, merged" in done.stdout, done.stderr
    assert (alone / "sweep.parquet").read_bytes() == (spread / "sweep.parquet").read_bytes()


def test_failed_sweeps_report_the_reason(cluster, program, tmp_path):
    client, _ = cluster
    (tmp_path / "oscillator.toml").write_text(SPECIFICATION)
    wrong = [str(tmp_path / "oscillator.toml"), "--vary", "d=1:2:3", "--measure", "poincare"]
    with pytest.raises(eomgen_dask.SweepError, match="d"):
        eomgen_dask.sweep(client, [*wrong, "--out", str(tmp_path / "a")], 2, program=program)
    with pytest.raises(ValueError, match="--out"):
        eomgen_dask.sweep(client, wrong, 2)
    with pytest.raises(ValueError, match="whole number"):
        eomgen_dask.sweep(client, [*wrong, "--out", "a"], 0)
    with pytest.raises(eomgen_dask.SweepError, match="cannot be run"):
        eomgen_dask.sweep(client, [*wrong, "--out", "a"], 1, program=str(tmp_path / "none"))
