"""What is measured in a fluid; imported only by a scene that has gauges."""
