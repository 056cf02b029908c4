#!/usr/bin/python3
"""Does a batch as a job array of a real Slurm on this machine and compares the bytes with those of a plain batch.

    check_slurm.py PROGRAM CASES WORK_FOLDER

Starts a munged, a slurmctld and a slurmd of its own, with sockets and ports of their own. Ends with 77 where Slurm
(Debian: slurm-wlm) is not installed, or this is not root, which slurmd needs to start jobs.
"""

import contextlib
import glob
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time

CONF = """ClusterName=fppg
SlurmctldHost=localhost(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SchedulerParameters=batch_sched_delay=0,sched_interval=2
NodeName=localhost NodeHostname={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory=4000 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def find(name):
    return shutil.which(name, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")


def free_ports(n):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(n)]
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


def wait_for(what, ask, seconds=300):
    end = time.monotonic() + seconds
    while not ask():
        assert time.monotonic() < end, f"{what} takes more than {seconds} s"
        time.sleep(0.2)


@contextlib.contextmanager
def slurm():
    """A cluster of this machine; gives the environment for its commands."""
    folder = tempfile.mkdtemp(prefix="fppg-slurm-")
    processes = []

    def start(*command, env=None):
        with open(os.path.join(folder, "daemons.log"), "a", encoding="utf-8") as log:
            processes.append(subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, env=env))

    try:
        os.chmod(folder, 0o755)
        for name in ("state", "spool"):
            os.mkdir(os.path.join(folder, name))
        key = os.path.join(folder, "munge.key")
        with open(key, "wb") as file:
            file.write(os.urandom(1024))
        os.chmod(key, 0o400)
        conf = os.path.join(folder, "slurm.conf")
        with open(conf, "w", encoding="utf-8") as file:
            file.write(CONF.format(folder=folder, ports=free_ports(2), host=socket.gethostname().split(".")[0],
                                   cpus=os.cpu_count()))
        env = dict(os.environ, SLURM_CONF=conf, SOURCE_DATE_EPOCH="86400")
        start(find("munged"), "--foreground", "--force", f"--key-file={key}", f"--socket={folder}/munge.socket",
              f"--pid-file={folder}/munged.pid", f"--log-file={folder}/munged.log", f"--seed-file={folder}/munged.seed")
        wait_for("munged", lambda: os.path.exists(f"{folder}/munge.socket"))
        start(find("slurmctld"), "-D", "-f", conf, env=env)
        start(find("slurmd"), "-D", "-N", "localhost", "-f", conf, env=env)
        wait_for("slurmd", lambda: "idle" in subprocess.run(["sinfo", "-h", "-o", "%T"], env=env, check=False,
                                                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                                            text=True).stdout)
        yield env
    finally:
        for process in reversed(processes):
            process.terminate()
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        shutil.rmtree(folder, ignore_errors=True)


def results(folder):
    out = {}
    for path in glob.glob(os.path.join(folder, "**"), recursive=True):
        if path.endswith((".bi4", ".xml", ".vtk")):
            with open(path, "rb") as file:
                out[os.path.relpath(path, folder)] = file.read()
    return out


def summary_of(folder):
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    return summary, {run["run"]: (run["state"], run["particles"]) for run in summary["runs"]}


def main(program, cases, work):
    missing = [name for name in ("munged", "slurmctld", "slurmd", "sbatch", "squeue") if not find(name)]
    if missing or os.geteuid() != 0:
        print(f"no Slurm to try: {', '.join(missing) or 'not root'}")
        return 77
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(work)
    for name in ("dambreak", "dambreak2d"):
        shutil.copytree(os.path.join(cases, name), os.path.join(work, "cases", name))
    with open(os.path.join(work, "cases/Broken_Def.xml"), "w", encoding="utf-8") as file:
        file.write("<case>")
    sweep = ["--set", "Dp=0.04,0.05,0.06"]
    run = dict(cwd=work, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    with slurm() as env:
        plain = subprocess.run([program, "batch", "cases", "--out", "plain", *sweep, "--", "-save:all"], env=env, **run)
        assert plain.returncode == 1, plain.stdout
        array = subprocess.run([program, "batch", "cases", "--out", "array", *sweep, "--threads", "1", "--slurm",
                                "--submit", "--", "-save:all"], env=env, **run)
        assert array.returncode == 0 and "job array" in array.stdout, array.stdout
        wait_for("the job array", lambda: subprocess.run(["squeue", "-h"], env=env, check=True, text=True,
                                                         stdout=subprocess.PIPE).stdout.strip() == "")
        wait_for("the summary", lambda: os.path.exists(os.path.join(work, "array/report.html")), 30)
    expected, found = (results(os.path.join(work, name)) for name in ("plain", "array"))
    assert expected.keys() == found.keys(), expected.keys() ^ found.keys()
    assert len([name for name in found if name.endswith(".bi4")]) == 6
    for name, data in expected.items():
        assert found[name] == data, f"{name} has other bytes"
    summary, runs = summary_of(os.path.join(work, "array"))
    assert (summary["done"], summary["failed"], summary["open"]) == (6, 3, 0)
    assert runs == summary_of(os.path.join(work, "plain"))[1]
    return 0


if __name__ == "__main__":
    sys.exit(main(*(os.path.abspath(argument) for argument in sys.argv[1:4])))
