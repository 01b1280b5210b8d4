"""Lines over MPI: to one rank, polled without blocking calls."""

import functools
import os
from typing import Any

from mpi4py import MPI

from quintet.interfaces.errors import LineError
from quintet.interfaces.lines.frame_buffers import FrameBuffers
from quintet.interfaces.lines.message import Frame
from quintet.interfaces.lines.process_status import running
from quintet.interfaces.lines.transport import FramedLine, wait

TAG = 17
SENDING = 600.0  # s that a large message may take until the receiver has asked for it


@functools.cache
def world() -> Any:
    """Return a duplicate of COMM_WORLD, apart from communicators of the solvers."""
    return _with_errors(MPI.COMM_WORLD.Dup())


def _with_errors(communicator: Any) -> Any:
    """Have a communicator raise errors: a rank that dies must not end those that name it."""
    communicator.Set_errhandler(MPI.ERRORS_RETURN)
    return communicator


def communicator_of(first: int, count: int) -> Any:
    """Communicator of some ranks in a row; called by all ranks of the job, or by these alone."""
    group = world().Get_group().Range_incl([(first, first + count - 1, 1)])
    return _with_errors(world().Create_group(group))


class MpiLine(FramedLine):
    """A line to one rank of a communicator, by default that of all ranks."""

    def __init__(
        self, run: str, name: str, other: str, rank: int, pid: int = 0, communicator: Any = None
    ) -> None:
        super().__init__(run, name)
        self.other = other
        self.rank = rank
        self.pid = pid  # of the other side when it runs on this host, else 0
        self._comm = communicator or world()
        self._buffers = FrameBuffers()

    def _put(self, frame: bytearray) -> None:
        try:
            request = self._comm.Isend([frame, MPI.BYTE], self.rank, TAG)
            wait(lambda: request.Test() or None, SENDING, self._reason)
        except MPI.Exception as error:
            raise self._failure(error) from error

    def _poll(self) -> Frame | None:
        status = MPI.Status()
        try:
            message = self._comm.Improbe(self.rank, TAG, status)
            if message is None:
                return None
            frame = self._buffers.take(status.Get_count(MPI.BYTE))
            request = message.Irecv([frame, MPI.BYTE])
            wait(lambda: request.Test() or None, SENDING, self._reason)
        except MPI.Exception as error:
            raise self._failure(error) from error
        return frame

    def _failure(self, error: Exception) -> LineError:
        """MPI fails where another rank has died: its network layer may notice first."""
        text = " ".join(str(error).split())
        return LineError(f"the connection to {self.other} is broken: {text:.200}")

    def _broken(self) -> str:
        # MPI does not report a dead rank; on the same host the system does.
        return f"{self.other} is gone" if self.pid and not running(self.pid) else ""

    def close(self) -> None:
        """See `Line.close`."""


def self_check(expected: int) -> None:
    """Check that the launcher belongs to the MPI library."""
    size = MPI.COMM_WORLD.size
    if size != expected:
        raise LineError(
            f"MPI started {size} ranks where {expected} were launched: the launcher and the "
            f"library differ ({MPI.Get_library_version().splitlines()[0]}). Use the mpiexec of "
            "that library."
        )


def abort(status: int) -> None:
    """End every rank at once."""
    MPI.COMM_WORLD.Abort(status)
    os._exit(status)
