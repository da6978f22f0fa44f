"""A worker thread that answers for the newest state only."""
from __future__ import annotations

import threading


class Refresher:
    """Runs `work` in a thread whenever it is poked; pokes during a run lead to one more run.

    Callbacks may come from any thread: only this one computes and writes to the screen.

    Attributes
    ----------
    error : Exception or None
        What the last run raised.
    """

    def __init__(self, work):
        self._work, self._state = work, threading.Condition()
        self._wanted = self._done = self._target = 0
        self._running, self.error = False, None

    def poke(self):
        """Ask for a run with the state as it is now."""
        with self._state:
            self._wanted += 1
            if not self._running:
                self._running = True
                threading.Thread(target=self._loop).start()      # no daemon: one in compiled code at exit aborts

    @property
    def overtaken(self):
        """A newer state waits while a run is under way."""
        return self._wanted != self._target

    def _loop(self):
        while True:
            with self._state:
                self._target = target = self._wanted
                if target == self._done:
                    self._running = False
                    self._state.notify_all()
                    return
            try:
                self._work()
                self.error = None
            except Exception as error:                   # whatever it is, the next poke must find a worker
                self.error = error
            with self._state:
                self._done = target

    def settle(self, timeout_s=60):
        """Wait until nothing is left to do.

        Raises
        ------
        TimeoutError
            If that takes longer than `timeout_s`.
        Exception
            What the last run raised.
        """
        with self._state:
            if not self._state.wait_for(lambda: not self._running, timeout_s):
                raise TimeoutError(f"the explorer did not settle within {timeout_s} s")
        if self.error is not None:
            raise self.error
