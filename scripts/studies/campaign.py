"""The runs of a plan, several side by side, each on one rank and in a folder of its own."""
import concurrent.futures
import fcntl
import os
import shutil
import signal
import subprocess
import sys
import threading
import time

from studies.program import PROGRAM, WITHDRAWN, quantities, read
from studies.runs_table import QUANTITIES, RunsTable

# One thread for each run; more would take the cores of its neighbours.
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}


class Progress:
    """A line on a terminal that is written over, otherwise a line now and then."""

    def __init__(self, total, present, stream, pause=30.0):
        self.total, self.present, self.stream, self.pause = total, present, stream, pause
        self.terminal = stream.isatty()
        self.start, self.last = time.monotonic(), None

    def show(self, done, failed):
        """`done` of the total are in the table, `failed` of them without a result."""
        now, made = time.monotonic(), done - self.present
        if not self.terminal and self.last is not None and now - self.last < self.pause and done < self.total:
            return
        self.last = now
        left = (now - self.start) / made * (self.total - done) if made else None
        line = f"study: {done} of {self.total} runs, {failed} failed" + (f", {duration(left)} left" if done < self.total and made else "")
        self.stream.write(f"\r\x1b[K{line}" if self.terminal else f"{line}\n")
        self.stream.flush()

    def end(self):
        if self.terminal and self.last is not None:
            self.stream.write("\n")


def duration(seconds):
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min {seconds:02} s" if minutes else f"{seconds} s"


class Runs:
    """The processes at work, so that they can be ended."""

    def __init__(self, folder, plan, keep):
        self.folder, self.plan, self.keep = folder, plan, keep
        self.processes, self.stopped, self.lock = set(), False, threading.Lock()

    def options(self, number):
        """A parameter stands last, because the last of two options counts."""
        chosen = [word for name, value in zip(self.plan.names, self.plan.runs[number - 1]) for word in (f"-{name}", value)]
        return [*WITHDRAWN, *self.plan.options, *chosen]

    def check(self):
        """Refuses a study whose very options the program does not take, before a hundred runs say the same."""
        folder = self.folder / "check"
        ended = subprocess.run([PROGRAM, *self.options(1), "-dry_run", "-overwrite", "-output_dir", str(folder)],
                               capture_output=True, text=True, check=False)
        shutil.rmtree(folder, ignore_errors=True)
        if ended.returncode != 0:
            sys.exit(f"study: the program does not take the options of the first run: {last_line(ended.stderr)}")

    def make(self, number):
        """The row of a run; None if the study was stopped meanwhile."""
        folder = self.folder / f"run-{number:04}"
        wait_for(folder / ".lock")
        # Nothing of an earlier attempt must be taken for this one's.
        shutil.rmtree(folder, ignore_errors=True)
        with self.lock:
            if self.stopped:
                return None
            command = [PROGRAM, *self.options(number), "-output_every", "0", "-overwrite", "-output_dir", str(folder)]
            # A group of its own: Ctrl-C reaches the study alone, which then ends its runs.
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                       env={**ONE_THREAD, **os.environ}, start_new_session=True)
            self.processes.add(process)
        _, said = process.communicate()
        with self.lock:
            self.processes.discard(process)
            if self.stopped:
                return None
        found = outcome(folder, process.returncode, said)
        if found["status"] == "finished" and not self.keep:
            shutil.rmtree(folder, ignore_errors=True)
        return found

    def stop(self):
        with self.lock:
            self.stopped = True
            for process in self.processes:
                process.terminate()


def wait_for(lock):
    """A study that was killed outright leaves runs behind, which still write. flock is what the program locks with."""
    try:
        with open(lock) as file:
            fcntl.flock(file, fcntl.LOCK_EX)
    except OSError:
        pass


def last_line(text):
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1] if lines else ""


def outcome(folder, code, said):
    """Status, reason, verdicts and quantities of a run that has ended."""
    try:
        summary, history = read(folder)
    except OSError:
        why = last_line(said) or (f"ended by signal {-code}" if code < 0 else f"ended with code {code}")
        return {"status": "failed", "reason": f"no summary: {why}"}
    finished = summary["status"] == "finished"
    verdicts = [verdict["verdict"] == "holds" for verdict in summary["verdicts"]]
    found = {QUANTITIES[name]: "" if value is None else repr(value) for name, value in quantities(summary, history).items()}
    return {"status": "finished" if finished else "failed",
            "reason": "" if finished else " ".join(f"{summary['status']}: {summary['reason']}".split()),
            "verdicts": "hold" if all(verdicts) else f"{sum(verdicts)} of {len(verdicts)} hold", **found}


def carry_out(plan, folder, jobs, again, keep):
    """Makes the runs that the table does not have; the table."""
    runs = Runs(folder, plan, keep)
    table = RunsTable(folder, plan)
    missing = table.missing(again)
    if missing:
        runs.check()
    progress = Progress(len(plan.runs), len(table.rows), sys.stderr)

    def stopped(*_):
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, stopped)
    if missing:
        progress.show(len(table.rows), len(table.failed()))
    adding = threading.Lock()

    def make(number):
        """A run is in the table before the next one begins, so that a kill costs no more than the runs at work."""
        found = runs.make(number)
        with adding:
            if found:
                table.add(number, found)
                progress.show(len(table.rows), len(table.failed()))

    pool = concurrent.futures.ThreadPoolExecutor(jobs)
    try:
        for future in concurrent.futures.as_completed([pool.submit(make, number) for number in missing]):
            future.result()
    except (KeyboardInterrupt, OSError) as error:
        runs.stop()
        pool.shutdown(cancel_futures=True)
        progress.end()
        why = "interrupted" if isinstance(error, KeyboardInterrupt) else f"stopped ({error})"
        print(f"study: {why} with {len(table.rows)} of {len(plan.runs)} runs in {folder}/runs.csv; the same command goes on there",
              file=sys.stderr)
        sys.exit(3)
    progress.end()
    return table
