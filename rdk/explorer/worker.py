"""A worker thread that answers for the newest state only."""
from __future__ import annotations

import contextlib
from concurrent.futures import ThreadPoolExecutor


class Refresher:
    """Runs `work` in a thread when poked; pokes during a run, from any thread, lead to one more.

    Pokes by one that holds `lock` are one.
    """

    def __init__(self, work, lock):
        self._work, self._lock = work, lock
        self._pool = ThreadPoolExecutor(1)               # awaited at exit: a daemon in compiled code would abort
        self._wanted = self._target = self._last = None

    def poke(self):
        """Ask for a run with the state as it is now."""
        with self._lock, contextlib.suppress(RuntimeError):                  # the program may be ending
            self._wanted = object()
            self._last = self._pool.submit(self._run)

    @property
    def overtaken(self):
        """A newer state waits while a run is under way."""
        return self._wanted is not self._target

    def _run(self):
        with self._lock:
            answered = not self.overtaken
            self._target = self._wanted
        if not answered:
            self._work()

    def settle(self, timeout_s=60):
        """Wait until nothing is left to do; a TimeoutError after `timeout_s`, or what the last run raised."""
        if self._last is not None:
            self._last.result(timeout_s)
