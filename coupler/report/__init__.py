"""What is shown of a run: summary, pictures, differences, work against precision."""
