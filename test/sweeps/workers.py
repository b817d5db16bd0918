#!/usr/bin/env python3
"""Sweeps in folders under engines of others, which fail: what is collected has the bytes of one quiet process.

    workers.py --program PROGRAM [--kills 40] [--rounds 40] [PART...]
    workers.py --self-test                                  other bytes are noticed

PART is one of workers refined stopped scheduler client_killed disk clients parallel slurm. The first two kill --kills
workers; each other part is repeated --rounds times, with its failure at another random moment.

Workers are processes `dask worker`; parts that need Dask are left out if Dask is missing. xargs replaces a missing GNU parallel.
Slurm runs only with ANHOLON_LONG, or if it is named.
"""

import argparse
import hashlib
import os
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

PATIENCE = 300  # seconds
PARTS = 24
SPINS = [round(1 + 0.01 * k, 2) for k in range(600)]
LONG = bool(os.environ.get("ANHOLON_LONG"))


class Wrong(Exception):
    pass


def must(truth, what):
    if not truth:
        raise Wrong(what)


def sweep(folder, on=None):
    """The sweep of this test; `on` is a client of Dask, an address, or None for threads of this process."""
    import anholon as an

    return an.load("disc").sweep({"phi'": SPINS, "theta": [1.2, 1.3, 1.4, 0]}, to=12, out=folder, chunk=100, on=on, threads=1)


def borders(folder, on=None):
    """A sweep whose borders are refined twice."""
    import anholon as an

    grid = {"phi'": an.grid(1, 7, 61), "theta": an.grid("0.2", "1.4", 25)}
    return an.load("disc").sweep(grid, to=6, out=folder, chunk=50, on=on, threads=1, refine=2, refine_by=("theta", 0.2))


SWEEPS = {"sweep": sweep, "borders": borders}


def hash_of(path):
    return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()


class Cluster:
    """A scheduler and workers, each a separate process."""

    def __init__(self, place, workers=2):
        self.place = place
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.address = f"tcp://127.0.0.1:{probe.getsockname()[1]}"
        self.log = open(place / "dask.log", "ab")
        self.scheduler = self.begin("scheduler", "--host", self.address, "--no-dashboard")
        self.workers = [self.worker() for _ in range(workers)]

    def begin(self, kind, *words):
        return subprocess.Popen([sys.executable, "-m", "distributed.cli.dask_" + kind, *words], stdout=self.log, stderr=self.log, cwd=self.place)

    def worker(self):
        # Workers have no nanny, so a killed worker is gone, as the machine of a cluster would be.
        return self.begin("worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard", "--death-timeout", "60")

    def close(self):
        for process in [*self.workers, self.scheduler]:
            process.kill()
            process.wait()
        self.log.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class Workers:
    def __init__(self, program, place, kills):
        self.program, self.place, self.kills = program, pathlib.Path(place), kills
        self.folder = self.place / "falls"
        sweep(self.folder)
        self.expected = self.collected()
        shutil.rmtree(self.folder)

    def run(self, *words, status=0):
        done = subprocess.run([self.program, *words], capture_output=True, text=True, timeout=PATIENCE, check=False)
        must(done.returncode == status, f"{' '.join(words)}: {done.returncode}: {done.stderr}")
        return done.stderr

    def collected(self):
        out = self.place / "all.csv"
        self.run("sweep", "collect", str(self.folder), "--quiet", "-o", str(out))
        return hash_of(out)

    def check(self):
        """The folder holds the whole sweep and nothing else, with the right numbers."""
        names = sorted(name for name in os.listdir(self.folder) if name != "_judgement.json")
        must(names == ["_sweep.json"] + [f"part-{k:06}.parquet" for k in range(PARTS)], f"in the folder: {names}")
        must(self.collected() == self.expected, "what was collected has other bytes")
        shutil.rmtree(self.folder)

    def present(self):
        return len(list(self.folder.glob("part-*.parquet"))) if self.folder.exists() else 0

    def client(self, address, name="sweep"):
        """A client in a separate process, which requests one of SWEEPS."""
        return subprocess.Popen(
            [sys.executable, __file__, "--client", name, str(self.folder), address], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )

    def finish(self, client, status=0):
        _, error = client.communicate(timeout=PATIENCE)
        must(client.returncode == status, f"the client: {client.returncode}: {error[-2000:]}")
        return error

    def wait_for(self, parts, client):
        """Waits for the folder, a little longer, and for `parts` parts in it. Returns the number of parts."""
        end = time.monotonic() + PATIENCE
        while (not self.folder.exists() or self.present() < parts) and client.poll() is None:
            must(time.monotonic() < end, "nothing happens")
            time.sleep(0.01)
        time.sleep(random.uniform(0, 0.05))
        return self.present()

    def clear(self):
        """A killed process leaves an unfinished file, which the next one that opens the folder removes."""
        must(sweep(self.folder).complete, "parts are missing")

    def workers(self):
        """kill -9 of workers at random moments; others begin in their place."""

        def whole():
            self.clear()
            self.check()

        self.kill_workers("sweep", whole)

    def refined(self):
        """The same while borders are refined, generation after generation."""
        borders(self.folder)
        quiet, expected = len(borders(self.folder).generations), self.collected()
        must(quiet == 3, f"{quiet} generations")
        shutil.rmtree(self.folder)

        def whole():
            must(borders(self.folder).complete and self.collected() == expected, "what was collected has other bytes")
            shutil.rmtree(self.folder)

        self.kill_workers("borders", whole)

    def kill_workers(self, name, whole):
        """Kills workers of clients, one client after the other; `whole` checks the folder of each."""
        with Cluster(self.place) as cluster:
            killed = 0
            while killed < self.kills:
                client = self.client(cluster.address, name)
                while client.poll() is None and killed < self.kills:
                    time.sleep(random.uniform(0.1, 0.7))
                    victim = random.randrange(len(cluster.workers))
                    cluster.workers[victim].kill()
                    cluster.workers[victim].wait()
                    cluster.workers[victim] = cluster.worker()
                    killed += 1
                self.finish(client)
                whole()

    def stopped(self):
        """A worker that is stopped until others have computed its part: its late commit does no harm."""
        with Cluster(self.place) as cluster:
            client = self.client(cluster.address)
            self.wait_for(random.randint(0, PARTS - 6), client)
            late = random.choice(cluster.workers)
            late.send_signal(signal.SIGSTOP)
            # The scheduler waits for a stopped worker as long as its connection lives; another process computes its
            # part.
            sweep(self.folder)
            late.send_signal(signal.SIGCONT)
            self.finish(client)
            must(late.poll() is None, "the late worker ended")
            self.check()

    def scheduler(self):
        """The scheduler dies: the client reports it, and the same call continues with another scheduler."""
        with Cluster(self.place) as cluster:
            client = self.client(cluster.address)
            parts = self.wait_for(random.randint(0, PARTS - 6), client)
            cluster.scheduler.kill()
            error = self.finish(client, status=1)
            must("the same call goes on" in error, error)
        before = self.present()
        must(parts <= before < PARTS, f"{before} parts")
        with Cluster(self.place) as cluster:
            self.finish(self.client(cluster.address))
        self.clear()
        self.check()

    def client_killed(self):
        """The client dies: its parts are kept, and another client continues."""
        with Cluster(self.place) as cluster:
            client = self.client(cluster.address)
            parts = self.wait_for(random.randint(0, PARTS - 1), client)
            client.kill()
            client.communicate()
            must(self.present() >= parts, "parts are lost")
            self.finish(self.client(cluster.address))
            self.clear()
            self.check()

    def disk(self):
        """A full disk, made by a limit on the size of the workers' files: the client reports it. Then there is room again."""
        self.folder.mkdir()
        with Cluster(self.place, workers=0) as cluster:
            limited = ["bash", "-c", 'trap "" XFSZ; ulimit -f 8; exec "$0" "$@"', sys.executable, "-m", "distributed.cli.dask_worker"]
            words = [cluster.address, "--nthreads", "1", "--no-nanny", "--no-dashboard"]
            cluster.workers.append(subprocess.Popen([*limited, *words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=self.place))
            error = self.finish(self.client(cluster.address), status=1)
            must("cannot write" in error and "File too large" in error, error)
            must(self.present() == 0, "a part that is not whole")
        with Cluster(self.place) as cluster:
            self.finish(self.client(cluster.address))
        self.clear()
        self.check()

    def clients(self):
        """Two clients share one folder."""
        with Cluster(self.place) as cluster:
            both = [self.client(cluster.address) for _ in range(2)]
            for client in both:
                self.finish(client)
            self.check()

    def shares(self, *extra):
        words = ["sweep", "disc", "--vary", "phi'=1:6.99:600", "--vary", "theta=1.2,1.3,1.4,0", "--to", "12", "--quiet", "--threads", "1"]
        return [*words, "--chunk", "100", "-o", str(self.folder) + "/", *extra]

    def by_command(self):
        """The hash of the file that one quiet command computes."""
        self.run(*self.shares(), status=1)
        expected = self.collected()
        shutil.rmtree(self.folder)
        return expected

    def parallel(self):
        """GNU parallel, or xargs, begins the shares; one is killed and begun anew."""
        expected = self.by_command()
        numbers = [str(k) for k in (1, 2, 3, 4)]
        # Each share writes its process id, so that one can be killed. xargs ends if a signal ends its command, so the
        # shell outlives the share.
        command = " ".join(f'"{w}"' for w in [self.program, *self.shares("--shard")])
        share = f'{command} "$1/4" & echo $! > {self.place}/share-$1; wait $!'
        script = self.place / "share.sh"
        script.write_text(share)
        if not shutil.which("parallel"):
            print("parallel: GNU parallel is missing, xargs takes its place")
        if shutil.which("parallel"):
            begun = subprocess.Popen(["parallel", "-j2", "bash", str(script), ":::", *numbers], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        else:
            begun = subprocess.Popen(["xargs", "-P2", "-n1", "bash", str(script)], stdin=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
            begun.stdin.write("\n".join(numbers))
            begun.stdin.close()
        number = random.choice(numbers)
        victim = self.place / f"share-{number}"
        while not victim.exists() or not victim.read_text():
            time.sleep(0.01)
        time.sleep(random.uniform(0, 0.6))
        try:
            os.kill(int(victim.read_text()), signal.SIGKILL)
        except ProcessLookupError:
            pass  # it was faster
        begun.wait(PATIENCE)
        self.run(*self.shares("--shard", f"{number}/4"), status=1)
        for name in numbers:
            (self.place / f"share-{name}").unlink()
        self.expected, kept = expected, self.expected
        self.check()
        self.expected = kept

    def slurm(self):
        """An array of Slurm on one node; two of its tasks are cancelled, and submitted anew."""
        expected = self.by_command()
        with Slurm(self.place) as slurm:
            script = self.place / "array.sh"
            script.write_text(f"#!/bin/bash\nexec {self.program} " + " ".join(f'"{w}"' for w in self.shares("--shard")) + ' "$SLURM_ARRAY_TASK_ID/8"\n')
            job = slurm.submit("--array=1-8", str(script))
            time.sleep(random.uniform(0.5, 1.5))
            for task in random.sample(range(1, 9), 2):
                slurm.call("scancel", f"{job}_{task}")
            slurm.wait(job)
            missing = PARTS - self.present()
            again = slurm.submit("--array=1-8", str(script))
            slurm.wait(again)
            print(f"slurm: {missing} parts were missing after two tasks were cancelled")
        self.expected, kept = expected, self.expected
        self.check()
        self.expected = kept


class Slurm:
    """slurmctld, slurmd and munged of this user, on one node."""

    def __init__(self, place):
        self.place = place / "slurm"
        self.place.mkdir(exist_ok=True)
        host = socket.gethostname().partition(".")[0]
        key = self.place / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        self.place.chmod(0o755)
        self.processes = []
        names = ["spool", "state", "munge"]
        for name in names:
            (self.place / name).mkdir(exist_ok=True)
            (self.place / name).chmod(0o755)
        munge = self.place / "munge"
        self.socket = munge / "munge.socket"
        words = ["--foreground", "--force", f"--key-file={key}", f"--socket={self.socket}", f"--pid-file={munge}/pid", f"--log-file={munge}/log"]
        self.begin("munged", *words, f"--seed-file={munge}/seed")
        self.until(self.socket.exists, "munged does not answer")
        conf = self.place / "slurm.conf"
        ports = []
        for _ in range(2):
            with socket.socket() as probe:
                probe.bind(("127.0.0.1", 0))
                ports.append(probe.getsockname()[1])
        conf.write_text(
            f"""ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
AuthType=auth/munge
AuthInfo=socket={self.socket}
StateSaveLocation={self.place}/state
SlurmdSpoolDir={self.place}/spool
SlurmctldPidFile={self.place}/slurmctld.pid
SlurmdPidFile={self.place}/slurmd.pid
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SchedulerParameters=sched_interval=1,bf_interval=1
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MailProg=/bin/true
NodeName={host} NodeAddr=127.0.0.1 CPUs={os.cpu_count()} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""
        )
        self.environment = {**os.environ, "SLURM_CONF": str(conf)}
        self.begin("slurmctld", "-D", "-i", "-f", str(conf))
        self.begin("slurmd", "-D", "-f", str(conf), "-N", host)
        self.until(lambda: "idle" in self.call("sinfo", "-h", "-o", "%t", fails=True), "the node does not come up")

    def begin(self, program, *words):
        path = shutil.which(program) or f"/usr/sbin/{program}"
        with open(self.place / f"{program}.out", "wb") as log:
            environment = getattr(self, "environment", os.environ)
            self.processes.append(subprocess.Popen([path, *words], stdout=log, stderr=log, env=environment))

    def call(self, *words, fails=False):
        done = subprocess.run(words, capture_output=True, text=True, env=self.environment, timeout=60, check=False)
        must(fails or done.returncode == 0, f"{' '.join(words)}: {done.stderr}")
        return done.stdout

    def until(self, truth, what):
        end = time.monotonic() + 60
        while not truth():
            logs = "".join(log.read_text(errors="replace")[-800:] for log in self.place.glob("*.out"))
            must(time.monotonic() < end, f"{what}\n{logs}")
            time.sleep(0.2)

    def submit(self, *words):
        return self.call("sbatch", "--parsable", f"--output={self.place}/%A_%a.txt", f"--chdir={self.place}", *words).strip()

    def wait(self, job):
        end = time.monotonic() + PATIENCE
        while self.call("squeue", "-h", "-j", job, fails=True).strip():
            must(time.monotonic() < end, "the array does not end")
            time.sleep(0.2)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in reversed(self.processes):
            process.terminate()
        for process in self.processes:
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()


def has_dask():
    try:
        import distributed  # noqa: F401
    except ImportError:
        return False
    return True


def slurm_lacks():
    """The reason why the part `slurm` cannot run here, or an empty text."""
    missing = [p for p in ("slurmctld", "slurmd", "munged", "sbatch") if not shutil.which(p) and not os.path.exists(f"/usr/sbin/{p}")]
    if missing:
        return f"missing: {', '.join(missing)}"
    return "" if os.geteuid() == 0 else "it needs the rights of root"


DASK = ["workers", "refined", "stopped", "scheduler", "client_killed", "disk", "clients"]
ALL = [*DASK, "parallel", "slurm"]
KILLS = ["workers", "refined"]  # these parts count their kills themselves


def run_parts(arguments):
    with tempfile.TemporaryDirectory() as place:
        os.chmod(place, 0o755)
        test = Workers(os.path.abspath(arguments.program), place, arguments.kills)
        for name in arguments.parts or ALL:
            if name in DASK and not has_dask():
                print(f"{name}: left out, the Python package distributed is missing")
                continue
            if name == "slurm" and not (not slurm_lacks() and (LONG or arguments.parts)):
                print("slurm: left out, " + (slurm_lacks() or "it needs ANHOLON_LONG"))
                continue
            begun = time.monotonic()
            rounds = 1 if name in KILLS else arguments.rounds
            try:
                for _ in range(rounds):
                    getattr(test, name)()
            except Wrong as wrong:
                print(f"{name}: {wrong}")
                return 1
            times = f"{arguments.kills} kills" if name in KILLS else f"{rounds} times"
            print(f"{name}: as expected, {times}, {time.monotonic() - begun:.1f} s", flush=True)
    return 0


def self_test(arguments):
    """Other bytes have to be found."""
    with tempfile.TemporaryDirectory() as place:
        test = Workers(os.path.abspath(arguments.program), place, 1)
        sweep(test.folder)
        test.expected = "0" * 64
        try:
            test.check()
        except Wrong as wrong:
            print(f"found: {wrong}")
            return 0 if "other bytes" in str(wrong) else 1
    return 1


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program")
    parser.add_argument("--kills", type=int, default=40 if LONG else 3)
    parser.add_argument("--rounds", type=int, default=40 if LONG else 1)
    parser.add_argument("--self-test", action="store_true")
    parser.add_argument("--client", nargs=3, metavar=("SWEEP", "FOLDER", "ADDRESS"))
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(ALL))
    arguments = parser.parse_args()
    if unknown := set(arguments.parts) - set(ALL):
        parser.error(f"there is no part {', '.join(sorted(unknown))}; parts: {' '.join(ALL)}")
    if arguments.client:
        name, folder, address = arguments.client
        SWEEPS[name](folder, address)
        return 0
    return self_test(arguments) if arguments.self_test else run_parts(arguments)


if __name__ == "__main__":
    sys.exit(main())
