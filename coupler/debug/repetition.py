"""A component that carries out the orders of a run again, up to a window and through it."""

import bdb
import sys
from types import TracebackType

from quintet.coupler.debug.debugger import ComponentDebugger
from quintet.coupler.debug.request import Request
from quintet.coupler.launch.acceptance import settings
from quintet.coupler.launch.order_log import Answer, Entry, OrderLog
from quintet.interfaces.errors import MessageError
from quintet.interfaces.lines.message import Message, require_finite
from quintet.interfaces.serving.failing import failure
from quintet.interfaces.serving.process import build
from quintet.interfaces.serving.serve import Server


class Repetition:
    """One component, its orders, and whether it has given the bits of the run so far."""

    def __init__(self, request: Request, log: OrderLog) -> None:
        self.request, self.log = request, log
        self.compared = 0  # windows
        self.difference = ""  # the first, as a sentence

    def run(self, debugger: ComponentDebugger | None, method: str) -> bool:
        """Repeat all orders; stop in a method in the window. Tell whether all bits are the same."""
        request = self.request
        plan = request.scene.components[request.component]
        component = build(plan.manifest, settings(request.scene, request.component))
        server = Server(component, request.component)
        reached = False
        for entry in self.log:
            order = entry.order
            if order.order == "advance" and order.header["window"] == request.window:
                if not reached:
                    self._say_reached()
                    if debugger:
                        debugger.stop_in(component, method)
                reached = True
                if not self._try(server, entry, debugger):
                    break
            else:
                self._compare(entry, _handle(server, order))
        return not self.difference

    def _try(self, server: Server, entry: Entry, debugger: ComponentDebugger | None) -> bool:
        """Step through the window that is debugged; tell whether there is more to do."""
        place = f"window {self.request.window}"
        try:
            message = _handle(server, entry.order)
            require_finite(message.fields, "what it gave")
        except bdb.BdbQuit:
            print(f"left in {place}", flush=True)
            return False
        except (Exception, SystemExit) as error:
            self._say_failure(error)
            if debugger and (trace := _within(error)):
                debugger.look_at(trace)
            return False
        finally:
            sys.settrace(None)
        before = self.difference
        self._compare(entry, message)
        if entry.answer is None:
            print(f"{place} is done; the run has no outputs of it to compare with", flush=True)
        elif self.difference == before:
            print(f"{place} is done; its outputs have the bits of the run", flush=True)
        else:
            print(f"{place} is done; not as in the run: {self.difference}", flush=True)
        return True

    def _say_reached(self) -> None:
        bits = f"have the bits of the run ({self.compared} windows compared)"
        if self.difference:
            bits = f"differ from those of the run: {self.difference}"
        print(f"window {self.request.window} reached; outputs until here {bits}", flush=True)

    def _say_failure(self, error: BaseException) -> None:
        text = str(error)
        if not isinstance(error, MessageError):
            report = failure(error)
            text = f"{report['error']}: {report['text']}"
        fault = self.request.fault
        if not fault:
            comparison = "; in the run it did not fail here"
        else:
            comparison = ", as in the run" if text == fault else f"; in the run it was: {fault}"
        name, window = self.request.component, self.request.window
        print(f"{name} failed in window {window}: {text}{comparison}", flush=True)

    def _compare(self, entry: Entry, message: Message) -> None:
        """Compare an answer with that of the run: the bits of its outputs, the stable step."""
        if entry.answer is None:
            return
        answer = Answer.of(message)
        self.compared += message.order == "done" and entry.order.order == "advance"
        if self.difference:
            return
        place = f"window {entry.order.header.get('window')}"
        for key, checksum in entry.answer.checksums.items():
            if answer.checksums.get(key) != checksum:
                self.difference = f"{place}, {key} has other bits"
                return
        if entry.answer.stable is not None and entry.answer.stable != answer.stable:
            self.difference = f"{place}, the stable step is {answer.stable!r} s, not "
            self.difference += f"{entry.answer.stable!r} s"


def _handle(server: Server, order: Message) -> Message:
    header, fields = server.handle(order)
    return Message({"order": "done", **header}, dict(fields))


def _within(error: BaseException) -> TracebackType | None:
    """Where an error was raised; None for what was found in the outputs only."""
    return None if isinstance(error, MessageError) else error.__traceback__
