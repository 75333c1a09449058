#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Slurm on this machine alone, for tests: munged, slurmctld and slurmd as root, with their own key, ports and folders.

    with SlurmMachine(cpus=2) as slurm:
        subprocess.run(['sbatch', ...], env=slurm.environment)

Raises NotAvailable with the reason when Slurm is not installed or cannot start.  On leaving, all processes that it
started are ended by their process ids.
"""

import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from own_ports import own_ports  # noqa: E402


class NotAvailable(Exception):
    """Slurm cannot be used here."""


def children_of(pid):
    """Process ids of all descendants."""
    parents = {}
    for entry in pathlib.Path('/proc').glob('[0-9]*/stat'):
        try:
            fields = entry.read_text().rsplit(')', 1)[1].split()
        except OSError:
            continue
        parents.setdefault(int(fields[1]), []).append(int(entry.parent.name))
    found, todo = [], [pid]
    while todo:
        for child in parents.get(todo.pop(), []):
            found.append(child)
            todo.append(child)
    return found


def kill(pids, number=signal.SIGKILL):
    for pid in pids:
        try:
            os.kill(pid, number)
        except ProcessLookupError:
            pass


class SlurmMachine:
    def __init__(self, cpus=2, max_array_size=1001):
        if os.geteuid() != 0:
            raise NotAvailable('Slurm needs root here')
        self.programs = {}
        for name in ('munged', 'slurmctld', 'slurmd', 'sbatch', 'squeue', 'scontrol', 'sinfo'):
            self.programs[name] = shutil.which(name, path=os.environ.get('PATH', '') + ':/usr/sbin:/sbin')
            if not self.programs[name]:
                raise NotAvailable(f'{name} is not installed (packages slurm-wlm and munge)')
        # munged refuses folders that others can write to, which /tmp is: only its own one counts for it.
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix='shoal-slurm-', dir='/run'))
        self.cpus, self.max_array_size = cpus, max_array_size
        self.processes = {}
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / 'slurm.conf'))

    def __enter__(self):
        try:
            self.start()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for name in ('slurmd', 'slurmctld', 'munged'):
            self.end(name)
        shutil.rmtree(self.folder, ignore_errors=True)

    def launch(self, name, *arguments):
        log = open(self.folder / f'{name}.out', 'ab')
        self.processes[name] = subprocess.Popen([self.programs[name], *arguments], stdout=log, stderr=log,
                                                env=self.environment)
        log.close()

    def end(self, name, number=signal.SIGTERM):
        process = self.processes.pop(name, None)
        if process is None:
            return
        if name == 'slurmd':
            # Its steps leave its process group, but not its tree, as long as it lives.
            steps = children_of(process.pid) + self.steps()
            kill(steps)
        process.send_signal(number)
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def steps(self):
        """Processes of slurmstepd of this machine, and their descendants: slurmd lets go of them."""
        found = []
        for entry in pathlib.Path('/proc').glob('[0-9]*/environ'):
            try:
                if f'SLURM_CONF={self.folder}' in entry.read_bytes().decode('utf-8', 'replace'):
                    name = (entry.parent / 'comm').read_text().strip()
                    pid = int(entry.parent.name)
                    if name.startswith('slurmstepd'):
                        found += [pid, *children_of(pid)]
            except OSError:
                continue
        return found

    def start(self):
        key = self.folder / 'munge.key'
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        host = socket.gethostname().split('.')[0]
        socket_path = self.folder / 'munge.socket'
        controller = own_ports()
        node = controller + 1
        (self.folder / 'slurm.conf').write_text(f'''ClusterName=shoal
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={socket_path}
CryptoType=crypto/munge
StateSaveLocation={self.folder}/state
SlurmdSpoolDir={self.folder}/spool
SlurmctldPidFile={self.folder}/slurmctld.pid
SlurmdPidFile={self.folder}/slurmd.pid
SlurmctldLogFile={self.folder}/slurmctld.log
SlurmdLogFile={self.folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MaxArraySize={self.max_array_size}
SlurmdTimeout=10
KillWait=5
MinJobAge=10
SchedulerParameters=sched_interval=2,batch_sched_delay=0,sched_min_interval=100000
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={self.cpus} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
''')
        for name in ('state', 'spool'):
            (self.folder / name).mkdir()
        self.launch('munged', '--foreground', '--force', f'--key-file={key}', f'--socket={socket_path}',
                    f'--pid-file={self.folder}/munged.pid', f'--log-file={self.folder}/munged.log',
                    f'--seed-file={self.folder}/munged.seed')
        self.await_state(socket_path.exists, 'munged')
        self.launch('slurmctld', '-D', '-f', str(self.folder / 'slurm.conf'))
        self.start_node()

    def start_node(self):
        self.launch('slurmd', '-D', '-f', str(self.folder / 'slurm.conf'))
        self.await_state(lambda: self.node_state() in ('idle', 'mixed', 'allocated'), 'slurmd')

    def kill_node(self):
        """Ends slurmd and all that runs on the node at once, as a loss of power does."""
        process = self.processes['slurmd']
        steps = self.steps() + children_of(process.pid)
        process.kill()
        kill(steps)
        kill(self.steps())
        process.wait()
        del self.processes['slurmd']

    def node_state(self):
        done = subprocess.run([self.programs['sinfo'], '--noheader', '--format=%T'], env=self.environment,
                              capture_output=True, text=True, check=False)
        return done.stdout.strip()

    def await_state(self, reached, name, limit_s=30):
        deadline = time.monotonic() + limit_s
        while not reached():
            ended = [each for each, process in self.processes.items() if process.poll() is not None]
            if ended or time.monotonic() > deadline:
                texts = [path.read_text(errors='replace')[-800:] for path in self.folder.glob('*.out')]
                texts += [path.read_text(errors='replace')[-800:] for path in self.folder.glob('*.log')]
                raise NotAvailable(f'{name} does not start: ' + ' | '.join(texts))
            time.sleep(0.05)
