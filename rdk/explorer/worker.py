"""A worker thread that answers for the newest state only."""
from __future__ import annotations

import threading


class Refresher:
    """Runs `work` in a thread when poked; pokes during a run, from any thread, lead to one more; keeps its `error`.

    Pokes by one that holds `lock` are one.
    """

    def __init__(self, work, lock=None):
        self._work, self._state, self._lock, self.error = work, threading.Condition(), lock or threading.Lock(), None
        self._wanted = self._done = self._target = 0

    def poke(self):
        """Ask for a run with the state as it is now."""
        with self._state:
            self._wanted += 1
            if self._wanted == self._done + 1:           # no thread is at work
                threading.Thread(target=self._loop).start()      # no daemon: one in compiled code at exit aborts

    @property
    def overtaken(self):
        """A newer state waits while a run is under way."""
        return self._wanted != self._target

    def _loop(self):
        more = True
        while more:
            with self._lock:
                self._target, self.error = self._wanted, None
            try:
                self._work()
            except Exception as error:                   # whatever it is, the next poke must find a worker
                self.error = error
            with self._state:
                self._done, more = self._target, self._target < self._wanted
                self._state.notify_all()

    def settle(self, timeout_s=60):
        """Wait until nothing is left to do; a TimeoutError after `timeout_s`, or what the last run raised."""
        with self._state:
            if not self._state.wait_for(lambda: self._done == self._wanted, timeout_s):
                raise TimeoutError(f"the explorer did not settle within {timeout_s} s")
        if self.error is not None:
            raise self.error
