"""One component of a run, computed again under a debugger with the inputs that it got."""
