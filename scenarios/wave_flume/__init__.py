"""Regular waves in a flume, made by a piston: scene, exact by wave theory."""
