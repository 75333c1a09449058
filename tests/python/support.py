# SPDX-License-Identifier: BSD-3-Clause
"""Common parts of the tests of the Python package: the package of the build, a scratch folder, their own bus.

A test is run in the root folder, by Debian's interpreter; SHOAL_BINARY_DIR is the build folder, build/ci without it.
"""
import atexit
import contextlib
import locale
import os
import shutil
import signal
import subprocess
import sys
import tempfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), '..', '..'))
BINARY_DIR = os.path.abspath(os.environ.get('SHOAL_BINARY_DIR', os.path.join(ROOT, 'build', 'ci')))
PACKAGE = os.path.join(BINARY_DIR, 'lib', 'python')
SHOAL = os.path.join(BINARY_DIR, 'bin', 'shoal')
PILOT = os.path.join(BINARY_DIR, 'bin', 'lockstep_pilot')
sys.path.insert(0, os.path.join(ROOT, 'tests'))

from own_ports import end_with_parent, own_url  # noqa: E402

LCM_URL = own_url()
SCRATCH = tempfile.mkdtemp(prefix='shoal-python-')
OWN_PID = os.getpid()

sys.path.insert(0, PACKAGE)
os.environ['PYTHONPATH'] = PACKAGE
os.environ['LCM_DEFAULT_URL'] = LCM_URL
os.environ['MPLBACKEND'] = 'Agg'
os.environ['MPLCONFIGDIR'] = SCRATCH
os.chdir(ROOT)
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell ignores it in background jobs


@atexit.register
def _clean():
    if os.getpid() == OWN_PID:
        shutil.rmtree(SCRATCH, ignore_errors=True)


def scratch(name):
    """Returns the path of a file in the scratch folder."""
    return os.path.join(SCRATCH, name)


@contextlib.contextmanager
def comma_locale():
    """In the block the process has the numbers of de_DE, as Qt and `locale.setlocale` set them: 1,5."""
    os.environ['LOCPATH'] = SCRATCH
    # localedef fails for the other categories, which are not defined.
    subprocess.run(['localedef', '-c', '-i', 'tests/comma_locale.txt', scratch('comma')], stderr=subprocess.DEVNULL,
                   check=False)
    locale.setlocale(locale.LC_NUMERIC, 'comma')
    try:
        yield
    finally:
        locale.setlocale(locale.LC_NUMERIC, 'C')
        del os.environ['LOCPATH']


class ShoalRun:
    """`shoal run` as a child process, which is killed at the latest at the end of the block."""

    def __init__(self, world, *options, speed='max'):
        with open(scratch('run.out'), 'w', encoding='utf-8') as out:
            self.child = subprocess.Popen([SHOAL, 'run', world, '--speed', speed, *options], stdout=out,
                                          stderr=subprocess.STDOUT, preexec_fn=end_with_parent)

    def wait(self):
        """Returns the exit code and the output."""
        code = self.child.wait(240)
        with open(scratch('run.out'), encoding='utf-8') as file:
            return code, file.read()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.child.poll() is None:
            self.child.kill()
        self.child.wait()


def run_python(code, *arguments):
    """Runs a program in Python with the package; returns exit code, output and errors."""
    done = subprocess.run([sys.executable, '-X', 'faulthandler', '-c', code, *arguments], capture_output=True, text=True,
                          timeout=240, check=False)
    return done.returncode, done.stdout, done.stderr


BALL = {
    'shoal': 1,
    'name': 'ball',
    'physics': {'step_s': 0.01},
    'vehicles': [{
        'name': 'ball',
        'position_m': [0, 0, 100],
        'model': {
            'shoal': 1,
            'vehicle': 'ball',
            'bodies': [{'name': 'body', 'parts': [{'shape': 'sphere', 'radius_m': 0.1, 'mass_kg': 1}]}],
            'devices': [{'name': 'imu', 'type': 'imu', 'rate_hz': 100}],
        },
    }],
}
