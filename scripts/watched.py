"""A command that is ended only where it is still for a minute, however slow the machine is."""
import os
import signal
import subprocess
import threading
import time

STILL = 60.0
# Files that grow while a run goes on.
GROWING = ["run.log", "history.csv", "results.txt"]


def grown(folder):
    """How much there is of the files that grow with a run, in any folder under this one."""
    return sum(file.stat().st_size for name in GROWING for file in folder.rglob(name) if file.is_file())


def watched(command, folder, environment=None):
    """Exit code and text of a command run in a folder; the code is a word where nothing was said or written for a minute."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=folder,
                               env={**os.environ, **(environment or {})}, start_new_session=True)
    said = []
    reader = threading.Thread(target=lambda: said.extend(iter(lambda: process.stdout.read1(65536), b"")), daemon=True)
    reader.start()
    seen, since = None, time.monotonic()
    while reader.is_alive():
        reader.join(0.1 if time.monotonic() - since < 5.0 else 1.0)
        now = (len(said), grown(folder))
        if now != seen:
            seen, since = now, time.monotonic()
        elif time.monotonic() - since > STILL:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return "still for a minute", b"".join(said).decode(errors="replace")
    return process.wait(), b"".join(said).decode(errors="replace")
