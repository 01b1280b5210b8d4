"""The coupling itself: links, mapping, schemes, acceleration, ledger."""
