"""How windows are repeated until what crosses the links agrees: guesses, measures, their log."""
