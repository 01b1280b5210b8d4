"""What came to a fluid and what left it, and why."""
