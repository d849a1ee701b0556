"""A Slurm cluster of one node for tests, in a folder of its own: its own keys, sockets and ports. Nothing of the
system's configuration is read or changed, and nothing but these processes uses it."""
import os
import pathlib
import shutil
import socket
import subprocess
import tempfile
import time

from program import wait_for

NEEDED = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "scontrol", "scancel")
PATH = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/sbin"])


def missing():
    return [name for name in NEEDED if not shutil.which(name, path=PATH)]


def free_ports(count):
    holders = [socket.socket() for _ in range(count)]
    for holder in holders:
        holder.bind(("127.0.0.1", 0))
    ports = [holder.getsockname()[1] for holder in holders]
    for holder in holders:
        holder.close()
    return ports


class Cluster:
    """@param requeue_exit whether the administrator has jobs that end with 75 queued again
    @param cores that the node says it has, however many there are; memory in MB"""

    def __init__(self, requeue_exit, cores=2, memory=2000):
        self.cores, self.memory = cores, memory
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="furrow-slurm-"))
        self.folder.chmod(0o755)
        self.processes = []
        try:
            self.begin(requeue_exit)
        except BaseException:
            self.end()
            raise

    def begin(self, requeue_exit):
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o600)
        munge = self.folder / "munge.socket"
        self.configuration = self.folder / "slurm.conf"
        self.configuration.write_text(self.text(munge, requeue_exit))
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith("SLURM_")}
        self.environment.update(SLURM_CONF=str(self.configuration), PATH=PATH)
        self.daemon("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={munge}", "--num-threads=2",
                    *(f"--{what}-file={self.folder / 'munged'}.{what}" for what in ("pid", "seed", "log")))
        wait_for(munge.exists, 20, "munged begins")
        self.daemon("slurmctld", "-D", "-f", self.configuration)
        self.daemon("slurmd", "-D", "-f", self.configuration)
        wait_for(lambda: "State=IDLE" in self.scontrol("show", "node", check=False), 60, "the node is ready")

    def text(self, munge, requeue_exit):
        host = socket.gethostname().split(".")[0]
        control, node = free_ports(2)
        user = subprocess.run(["id", "-un"], capture_output=True, text=True, check=True).stdout.strip()
        lines = ["ClusterName=test", f"SlurmctldHost={host}(127.0.0.1)", "AuthType=auth/munge",
                 f"AuthInfo=socket={munge}", f"SlurmUser={user}", f"SlurmdUser={user}",
                 f"SlurmctldPort={control}", f"SlurmdPort={node}",
                 *(f"{key}={self.folder / value}" for key, value in (
                     ("StateSaveLocation", "state"), ("SlurmdSpoolDir", "spool"), ("SlurmctldPidFile", "slurmctld.pid"),
                     ("SlurmdPidFile", "slurmd.pid"), ("SlurmctldLogFile", "slurmctld.log"),
                     ("SlurmdLogFile", "slurmd.log"))),
                 "ProctrackType=proctrack/linuxproc", "TaskPlugin=task/none", "SwitchType=switch/none",
                 "JobAcctGatherType=jobacct_gather/none", "SelectType=select/cons_tres", "SelectTypeParameters=CR_Core",
                 "MpiDefault=none", "ReturnToService=2", "KillWait=10", "JobRequeue=1",
                 "SlurmdParameters=config_overrides",
                 f"NodeName={host} NodeAddr=127.0.0.1 CPUs={self.cores} RealMemory={self.memory}",
                 "PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP"]
        if requeue_exit:
            lines.append("RequeueExit=75")
        for folder in ("state", "spool"):
            (self.folder / folder).mkdir()
        return "\n".join(lines) + "\n"

    def daemon(self, *command):
        log = open(self.folder / f"{command[0]}.out", "wb")
        self.processes.append(subprocess.Popen([shutil.which(command[0], path=PATH), *map(str, command[1:])],
                                               stdout=log, stderr=log, stdin=subprocess.DEVNULL, env=self.environment,
                                               start_new_session=True))
        log.close()

    def call(self, *command, check=True, cwd=None, env=None, timeout=120):
        return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=check, cwd=cwd,
                              timeout=timeout, stdin=subprocess.DEVNULL, env={**self.environment, **(env or {})})

    def scontrol(self, *arguments, check=True):
        return self.call("scontrol", *arguments, check=check).stdout

    @staticmethod
    def path_of(program):
        return shutil.which(program, path=PATH)

    def submit(self, script, cwd, env=None):
        return self.call("sbatch", "--parsable", script, cwd=cwd, env=env).stdout.strip()

    def job(self, number):
        """{"JobState": "RUNNING", …}"""
        text = self.scontrol("show", "job", "--oneliner", number)
        return dict(word.split("=", 1) for word in text.split() if "=" in word)

    def wait_for_state(self, number, wanted, seconds):
        """@param wanted test of the job as job() tells it"""
        def there():
            job = self.job(number)
            if not wanted(job) and job["JobState"] in ("FAILED", "CANCELLED", "COMPLETED"):
                raise AssertionError("has ended")
            return wanted(job)
        try:
            return wait_for(there, seconds, f"job {number}")
        except AssertionError as late:
            raise AssertionError(f"{late}: {self.job(number)}\n" + self.logs()) from None

    def logs(self):
        return "\n".join(f"== {path.name}\n{path.read_text(errors='replace')[-1500:]}"
                         for path in sorted(self.folder.glob("*.log")))

    def end(self):
        for process in reversed(self.processes):  # the daemons alone: jobs were waited for
            process.terminate()
        for process in self.processes:
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        time.sleep(0.2)
        shutil.rmtree(self.folder, ignore_errors=True)
